"""A plane with a yellow line, an obstacle and a robot: what its sensors see, and where its commands take it.

Pure Python and deterministic: the same commands at the same times give the same world. `world_ros1.py` and
`world_ros2.py` connect it to real topics; `python3 world.py` drives it without ROS, with the law that the model gives
its controller, and prints where the robot got to. Lengths are metres, angles radians, times seconds.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

STEP = 0.01
CAMERA_PERIOD = 0.05
LIDAR_PERIOD = 0.1
POSE_PERIOD = 0.1

#: The limits of a TurtleBot3 Waffle Pi, and its radius.
MAX_LINEAR, MAX_ANGULAR, ROBOT_RADIUS = 0.26, 1.82, 0.14

#: The camera looks at the floor this far ahead; an image is 640 pixels wide and shows one metre.
LOOK_AHEAD, HALF_WIDTH_PIXELS, HALF_WIDTH = 0.2, 320, 0.5

RAYS, RANGE_MIN, RANGE_MAX = 360, 0.12, 3.5


class Track:
    """A yellow line: two straights joined by two half circles, driven counter-clockwise."""

    straight, radius = 3.0, 1.0

    @property
    def length(self) -> float:
        """Once around."""
        return 2 * self.straight + 2 * math.pi * self.radius

    def point(self, way: float) -> tuple[float, float, float]:
        """x, y and direction of the line after that way from its start, the left end of the lower straight."""
        way %= self.length
        half = self.length / 2
        turned = way >= half
        way -= half if turned else 0.0
        if way <= self.straight:
            x, y, heading = way - self.straight / 2, -self.radius, 0.0
        else:
            heading = (way - self.straight) / self.radius
            x = self.straight / 2 + self.radius * math.sin(heading)
            y = -self.radius * math.cos(heading)
        return (-x, -y, heading + math.pi) if turned else (x, y, heading)

    def nearest(self, x: float, y: float) -> tuple[float, float, float]:
        """The way along the line to its point nearest to (x, y), and that point."""
        half = self.straight / 2
        if abs(x) <= half:
            way = x + half if y < 0 else self.length / 2 + half - x
        else:
            side = math.copysign(1.0, x)
            angle = math.atan2(side * y, side * x - half) + math.pi / 2
            way = self.straight + self.radius * angle + (0.0 if side > 0 else self.length / 2)
        return (way % self.length, *self.point(way)[:2])


@dataclass
class Obstacle:
    """Something round on the floor."""

    x: float
    y: float
    radius: float = 0.12


@dataclass
class World:
    """The robot on the plane; it starts beside the line and looks along it."""

    track: Track = field(default_factory=Track)
    obstacle: Obstacle | None = None
    x: float = 0.0
    y: float = 0.06 - Track.radius
    heading: float = 0.0
    linear: float = 0.0
    angular: float = 0.0
    travelled: float = 0.0
    line_covered: bool = False

    def command(self, linear: float, angular: float) -> None:
        """The speeds to hold from now on, within what the motors can."""
        self.linear = max(-MAX_LINEAR, min(MAX_LINEAR, linear))
        self.angular = max(-MAX_ANGULAR, min(MAX_ANGULAR, angular))

    def step(self) -> None:
        """One time step. An obstacle is solid: the robot does not enter it."""
        before = self.track.nearest(self.x, self.y)[0]
        middle = self.heading + self.angular * STEP / 2
        x = self.x + self.linear * STEP * math.cos(middle)
        y = self.y + self.linear * STEP * math.sin(middle)
        self.heading += self.angular * STEP
        if self.obstacle is None or math.hypot(x - self.obstacle.x, y - self.obstacle.y) > self.contact:
            self.x, self.y = x, y
        way = self.track.nearest(self.x, self.y)[0] - before
        self.travelled += (way + self.track.length / 2) % self.track.length - self.track.length / 2

    @property
    def contact(self) -> float:
        """The distance of the centres at which robot and obstacle touch."""
        return ROBOT_RADIUS + (self.obstacle.radius if self.obstacle else 0.0)

    @property
    def gap(self) -> float:
        """The free distance between robot and obstacle; infinite where there is none."""
        if self.obstacle is None:
            return math.inf
        return math.hypot(self.x - self.obstacle.x, self.y - self.obstacle.y) - self.contact

    @property
    def offset(self) -> float:
        """The distance of the robot from the line."""
        _, x, y = self.track.nearest(self.x, self.y)
        return math.hypot(self.x - x, self.y - y)

    def place_obstacle(self, ahead: float) -> None:
        """Puts an obstacle on the line, that far ahead of the robot."""
        x, y, _ = self.track.point(self.track.nearest(self.x, self.y)[0] + ahead)
        self.obstacle = Obstacle(x, y)

    def correction(self) -> float | None:
        """How many pixels the line lies to the right of the image's centre; None where it can't be seen."""
        if self.line_covered:
            return None
        x = self.x + LOOK_AHEAD * math.cos(self.heading)
        y = self.y + LOOK_AHEAD * math.sin(self.heading)
        _, line_x, line_y = self.track.nearest(x, y)
        right = (line_x - x) * math.sin(self.heading) - (line_y - y) * math.cos(self.heading)
        away = math.hypot(line_x - x, line_y - y)
        return right / HALF_WIDTH * HALF_WIDTH_PIXELS if away <= HALF_WIDTH else None

    def scan(self) -> list[float]:
        """The distance seen by each ray, one a degree, counter-clockwise from straight ahead; infinite: nothing."""
        return [self._ray(self.heading + math.radians(degree)) for degree in range(RAYS)]

    def _ray(self, angle: float) -> float:
        if self.obstacle is None:
            return math.inf
        dx, dy = self.obstacle.x - self.x, self.obstacle.y - self.y
        along = dx * math.cos(angle) + dy * math.sin(angle)
        aside = dx * math.sin(angle) - dy * math.cos(angle)
        if along <= 0 or abs(aside) > self.obstacle.radius:
            return math.inf
        seen = along - math.sqrt(self.obstacle.radius**2 - aside**2)
        return seen if RANGE_MIN <= seen <= RANGE_MAX else math.inf


#: What happens to the robot, and when: half a minute of line, an obstacle that goes away again, a stop button, a
#: line that can't be seen for a while.
DEMONSTRATION = (
    (30.0, "obstacle"),
    (36.0, "clear"),
    (39.0, "/stop"),
    (42.0, "/continue"),
    (45.0, "cover"),
    (47.0, "uncover"),
    (50.0, "end"),
)


class Simulation:
    """A world in which a scenario takes place; it says what its sensors and its people send.

    The scenario is a sequence of times and happenings: `obstacle`, `clear`, `cover` and `uncover` (the line), `end`, or
    a topic for an empty message.
    """

    def __init__(self, scenario: tuple[tuple[float, str], ...] = DEMONSTRATION) -> None:
        self.world = World()
        self.steps = 0
        self.ended = False
        #: What happened in the last step.
        self.happened: list[str] = []
        self._scenario = list(scenario)
        buttons = [happening for _, happening in scenario if happening.startswith("/")]
        #: All topics that something may be sent to.
        self.topics = [*dict.fromkeys(["/correction", "/no_line", "/scan", *buttons])]

    @property
    def time(self) -> float:
        """Seconds since the start."""
        return self.steps * STEP

    def due(self, period: float) -> bool:
        """Whether something that happens once a period happens now."""
        return self.steps % round(period / STEP) == 0

    def advance(self) -> list[tuple[str, object]]:
        """One time step; what is sent after it, as topics and data: a number, a list of ranges, or None."""
        self.world.step()
        self.steps += 1
        self.happened = []
        messages: list[tuple[str, object]] = []
        while self._scenario and self._scenario[0][0] <= self.time:
            happening = self._scenario.pop(0)[1]
            self.happened.append(happening)
            if happening.startswith("/"):
                messages.append((happening, None))
            else:
                self._happen(happening)
        return messages + self._sensed()

    def pose(self) -> dict[str, float | None]:
        """Where the robot is: how far it came, how far it is from the line and from the obstacle, if there is one."""
        gap = self.world.gap
        return {
            "travelled": self.world.travelled,
            "offset": self.world.offset,
            "gap": None if math.isinf(gap) else gap,
        }

    def _happen(self, happening: str) -> None:
        if happening == "obstacle":
            self.world.place_obstacle(ahead=1.0)
        elif happening == "clear":
            self.world.obstacle = None
        elif happening in ("cover", "uncover"):
            self.world.line_covered = happening == "cover"
        elif happening == "end":
            self.ended = True
        else:
            raise ValueError(f"nothing is called {happening}")

    def _sensed(self) -> list[tuple[str, object]]:
        messages: list[tuple[str, object]] = []
        if self.due(CAMERA_PERIOD):
            correction = self.world.correction()
            messages.append(("/no_line", None) if correction is None else ("/correction", correction))
        if self.due(LIDAR_PERIOD):
            messages.append(("/scan", self.world.scan()))
        return messages


def main() -> None:
    """The demonstration without ROS, driven by the law of the model, ten times a second."""
    simulation = Simulation()
    world = simulation.world
    correction, blocked, stopped = None, False, False
    while not simulation.ended:
        for topic, data in simulation.advance():
            if topic in ("/correction", "/no_line"):
                correction = data
            elif topic == "/scan":
                blocked = min(data[:21] + data[-20:]) < 0.5
            else:
                stopped = topic == "/stop"
        if simulation.steps % 10 == 0:
            halted = correction is None or blocked or stopped
            world.command(0.0 if halted else 0.2, 0.0 if halted else -correction / 100)
        if simulation.steps % 100 == 0:
            print(  # noqa: T201
                f"{simulation.time:4.0f} s  travelled {world.travelled:5.2f} m  off the line {world.offset:.3f} m"
                f"  speed {world.linear:.1f} m/s"
            )


if __name__ == "__main__":
    main()
