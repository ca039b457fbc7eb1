"""Scenarios whose people and devices act at random, and the judges of their guards. Needs no robosc."""

from __future__ import annotations

import math
import random
from dataclasses import dataclass
from pathlib import Path

from .devices import GO_ON
from .devices import STOP as BUTTON
from .geometry import Disc
from .judge import STOP, Button, Judge, both, either, finite, opposite
from .random_data import destination, nothing, number, twist
from .scenarios import SCENARIOS
from .simulation import Message, Simulation

EXAMPLES = Path(__file__).resolve().parents[1]
WHEELS, STEP, NAVIGATE = "/cmd_vel", "/simple_movement", "/navigate_to_pose"
LEFT, RIGHT = "/rotate_left", "/rotate_right"


class RestlessSimulation(Simulation):
    """A scenario without its script: people press buttons, things appear, and devices fall silent, all at random."""

    def __init__(self, scenario, seed=0):
        self._random = random.Random(f"incidents/{scenario.name}/{seed}")  # noqa: S311  # not used for security
        #: Topics that are silent, with the time until which they are.
        self._silent = {}
        super().__init__(_without_script(scenario), seed)

    def advance(self):
        """Run one step of time. Return what is sent after it, without the messages of silent topics."""
        if self._due(0.2):
            self._random.choice(INCIDENTS[self.scenario.name] + COMMON)(self, self._random)
        return [
            item
            for item in super().advance()
            if not isinstance(item, Message) or self.time > self._silent.get(item.topic, 0.0)
        ]

    def silence(self, topic, seconds):
        """Let a topic be silent."""
        self._silent[topic] = self.time + seconds

    def danger(self):
        """Return None: the judge of the guard covers all hazards that a guard can prevent."""


def _without_script(scenario):
    class Restless(type(scenario)):
        patience = math.inf

        def script(self, simulation):
            del simulation
            yield lambda: False

        def reached(self, simulation):
            del simulation
            return False

    return Restless()


# Incidents: functions of the simulation and random numbers.


def _press(simulation, numbers):
    if numbers.random() < 0.3:
        simulation.press()


def _release(simulation, _):
    if simulation.button.pressed:
        simulation.release()


def _go_on(simulation, _):
    simulation.say(GO_ON, {})


def _fall_silent(simulation, numbers):
    if numbers.random() < 0.5:
        topics = sorted(topic for topic in simulation.says if topic not in simulation.scenario.people)
        # No silence ends at the moment of a patience.
        simulation.silence(numbers.choice(topics), numbers.choice((0.25, 0.65, 1.35)))


def _put_pillar(simulation, numbers):
    simulation.world.pillars[:] = [Disc(*simulation.world.pose.ahead(numbers.uniform(0.4, 0.8)), 0.12)]


def _clear(simulation, _):
    simulation.world.pillars.clear()


def _carry_back(simulation, _):
    simulation.world.drive.pose = simulation.world.start


def _locate(simulation, _):
    simulation.scenario.locate(simulation)


def _click(simulation, numbers):
    if numbers.random() < 0.3:
        simulation.scenario.click(simulation, numbers.uniform(0.3, 4.0), numbers.uniform(0.3, 2.7))


def _set(kind, name, *values):
    """Return an incident that sets an attribute of a device."""

    def incident(simulation, numbers):
        for device in simulation.devices:
            if type(device).__name__ == kind:
                setattr(device, name, numbers.choice(values))

    return incident


def _bump(simulation, numbers):
    for device in simulation.devices:
        if type(device).__name__ == "Bumpers":
            device.pressed = {numbers.choice(sorted(device.says))} if numbers.random() < 0.15 else set()


def _move_sprayer(simulation, numbers):
    pose = simulation.world.start
    simulation.world.drive.pose = type(pose)(numbers.choice((90.0, 99.0, 102.0)), 36.5, pose.heading)


COMMON = [_press, _release, _release, _go_on, _go_on, _fall_silent]
DRIVING = [_put_pillar, _clear, _clear, _carry_back]
NAVIGATING = [_locate, _click, _click, _clear]
INCIDENTS = {
    "line_follower": DRIVING,
    "simple_navigation": NAVIGATING,
    "obstacle_navigation": [*NAVIGATING, _put_pillar, _set("Navigation", "recoveries", 5, 6)],
    "object_finder": DRIVING,
    "maze_solver": DRIVING,
    "push_ball": DRIVING,
    "person_follower": DRIVING,
    "supervised_line_follower": DRIVING,
    "warehouse_robot": [
        _bump,
        _set("AisleManager", "crowded", True, False),
        _set("Lift", "jams", 0, 1),
        _set("Docking", "refusals", 0, 0, 1),
        _clear,
        _put_pillar,
    ],
    "sprayer": [
        _set("Radio", "in_reach", True, True, False),
        _set("Remote", "automatic", True, False),
        _set("Receiver", "in_view", True, True, False),
        _set("Boom", "level", 0.01, 0.05, 0.5),
        _set("Driver", "trouble", True),
        _move_sprayer,
    ],
}


# Judges


class ButtonJudge(Judge):
    """The knowledge of a guard with an emergency stop."""

    def __init__(self, time=0.0):
        super().__init__(time)
        self.button = Button(self)

    def heard(self, topic, data):
        """Note a message of the button."""
        if topic in (BUTTON, GO_ON):
            self.button.heard(topic, data)


class WheelsJudge(ButtonJudge):
    """Velocities pass in service, and ahead only on a free way. They are limited."""

    commands = {WHEELS: twist}
    replaced = {WHEELS: STOP}

    def __init__(self, time=0.0):
        super().__init__(time)
        self.clear = False

    def heard(self, topic, data):
        """Note what is ahead."""
        super().heard(topic, data)
        if topic == "/scan":
            ranges = data["ranges"]
            self.clear = len(ranges) == 360 and all(ray >= 0.5 for ray in ranges[:21] + ranges[340:])

    def permits(self, name, data):
        """Return whether a velocity may pass."""
        del name
        if not finite(data["linear"]["x"], data["angular"]["z"]):
            return False
        way = both(self.clear, self.fresh("/scan", 0.5))
        return both(self.button.in_service, either(way, data["linear"]["x"] <= 0.0))

    def limited(self, name, data):
        """Return the velocity within its limits."""
        if name != WHEELS:
            return [data]
        ahead = {**data["linear"], "x": max(-0.1, min(data["linear"]["x"], 0.22))}
        turn = {**data["angular"], "z": max(-1.0, min(data["angular"]["z"], 1.0))}
        return [{"linear": ahead, "angular": turn}]


class TurnJudge(WheelsJudge):
    """While a device turns the robot, no other command passes."""

    commands = {WHEELS: twist, LEFT: nothing, RIGHT: nothing}

    def __init__(self, time=0.0):
        super().__init__(time)
        self.turning = False

    def heard(self, topic, data):
        """Note the end of a turn."""
        super().heard(topic, data)
        self.turning = self.turning and topic not in ("/rotate_done", GO_ON)

    def permits(self, name, data):
        """Return whether a command may pass."""
        moves = super().permits(name, data) if name == WHEELS else self.button.in_service
        return both(not self.turning, moves)

    def sent(self, name, data):
        """Note the beginning of a turn."""
        del data
        self.turning = self.turning or name != WHEELS


def quarter(numbers, time):
    """Return an angle, often a quarter."""
    del time
    return {"data": numbers.choice((90, 90, 90, 45, -90, 0, 32767))}


class QuarterJudge(TurnJudge):
    """As `TurnJudge`, and turns are quarters."""

    commands = {WHEELS: twist, LEFT: quarter, RIGHT: quarter}

    def permits(self, name, data):
        """Return whether a command may pass."""
        return both(name == WHEELS or data["data"] == 90, super().permits(name, data))


class StepsJudge(ButtonJudge):
    """Steps pass while the line is in view, the way is clear and the robot is in service."""

    commands = {STEP: twist}
    replaced = {STEP: STOP}

    def __init__(self, time=0.0):
        super().__init__(time)
        self.line = self.clear = False

    def heard(self, topic, data):
        """Note the line and the way."""
        super().heard(topic, data)
        if topic == "/scan":
            self.clear = all(data["ranges"][ray] >= 0.5 for ray in (0, 10, 20, 340, 350))
        elif topic in ("/correction", "/no_line"):
            self.line = topic == "/correction"

    def permits(self, name, data):
        """Return whether a step may pass."""
        del name, data
        line = both(self.line, self.fresh("/correction", 0.5))
        return both(line, self.clear, self.fresh("/scan", 0.5), self.button.in_service)


class NavigationJudge(ButtonJudge):
    """One goal for each click, after the robot was located. A new click or a pressed button ends it."""

    commands = {NAVIGATE: destination(4.0, 3.0)}
    most_recoveries = math.inf

    def __init__(self, time=0.0):
        super().__init__(time)
        self.located = self.called = self.recalled = False
        self.recoveries = 0

    def heard(self, topic, data):
        """Note a click."""
        super().heard(topic, data)
        if topic == "/initialpose":
            self.located = True
        elif topic == "/clicked_point" and self.located:
            self.recalled = bool(self.running)
            self.called = not self.running
        elif topic == GO_ON:
            self.called = False

    def fed_back(self, data):
        """Note the recoveries."""
        self.recoveries = data["number_of_recoveries"]

    def permits(self, name, data):
        """Return whether a goal may begin."""
        del name, data
        return both(self.called, self.button.in_service)

    def goes_on(self, action, data):
        """Return whether a goal may go on."""
        del action, data
        return both(not self.recalled, self.recoveries <= self.most_recoveries, self.button.in_service)

    def sent(self, name, data):
        """Note the beginning of a goal."""
        del name, data
        self.called, self.recoveries = False, 0

    def ended(self, name, what, data):
        """Note the end of a goal."""
        del name, what, data
        self.called, self.recalled = self.recalled, False


class ObstacleJudge(NavigationJudge):
    """As `NavigationJudge`, with at most five recoveries."""

    most_recoveries = 5


LIMIT, DOCK, UNDOCK = "/speed_limit", "/dock_robot", "/undock_robot"
RAISE, LOWER, ENTER, LEAVE = "/lift/raise", "/lift/lower", "/aisle/enter", "/aisle/leave"


def speed_limit(numbers, time):
    """Return a limit, sometimes a percentage."""
    del time
    return {"percentage": numbers.random() < 0.2, "speed_limit": number(numbers, 3.0)}


def home(numbers, time):
    """Return a goal of docking, sometimes to an unknown dock."""
    return {"dock_id": numbers.choice(("home", "home", "moon")), **nothing(numbers, time)}


class WarehouseJudge(ButtonJudge):
    """No shelf among people, one movement at a time, slow where something is near."""

    commands = {
        NAVIGATE: destination(8.0, 3.0),
        LIMIT: speed_limit,
        DOCK: home,
        UNDOCK: nothing,
        **dict.fromkeys((RAISE, LOWER, ENTER, LEAVE), nothing),
    }
    weights = {LIMIT: 0.1, NAVIGATE: 2.0, DOCK: 0.1, LEAVE: 0.3, RAISE: 0.3}
    views = ("/front/scan", "/rear/scan")

    def __init__(self, time=0.0):
        super().__init__(time)
        self.touched = {"/front/bumper", "/rear/bumper", "/left/bumper", "/right/bumper"}
        self.nearest = dict.fromkeys(self.views, 0.0)
        self.lift_down, self.in_aisle = True, False
        #: The place of the robot: in the dock, away from it, or between.
        self.at = "docked"

    def heard(self, topic, data):
        """Note a message of a sensor."""
        super().heard(topic, data)
        if topic.endswith("/bumper"):
            (self.touched.add if data["data"] else self.touched.discard)(topic)
        elif topic in self.views:
            self.nearest[topic] = min(data["ranges"])

    def _clear(self, distance):
        return both(*(both(self.nearest[view] >= distance, self.fresh(view, 0.5)) for view in self.views))

    def permits(self, name, data):
        """Return whether a command may pass."""
        drives = NAVIGATE in self.running
        aisle = not {ENTER, LEAVE} & {*self.running}
        match name:
            case "/speed_limit":
                return finite(data["speed_limit"]) and not data["percentage"]
            case "/navigate_to_pose":
                there = self.in_aisle and aisle and self.at == "away"
                return both(there, not self.touched, self._clear(0.5), self.button.in_service)
            case "/lift/raise":
                lift = self.lift_down and not self.in_aisle
                return both(lift, not drives, LOWER not in self.running, self.button.in_service)
            case "/lift/lower":
                return both(not self.lift_down, not drives, RAISE not in self.running, self.button.in_service)
            case "/aisle/enter":
                return not self.in_aisle and self.lift_down
            case "/aisle/leave":
                return self.in_aisle and aisle and not drives
            case "/dock_robot":
                return both(self.at == "away", not drives, self.button.in_service)
        return both(self.at in ("docked", "undocking"), self.button.in_service)

    def goes_on(self, action, data):
        """Return whether a goal may go on."""
        if action == NAVIGATE:
            return self.permits(action, data)
        return both(self.button.in_service, action == UNDOCK or NAVIGATE not in self.running)

    def limited(self, name, data):
        """Return a limit within the limits of the guard."""
        if name != LIMIT:
            return [data]
        free = self._clear(1.5)
        most = [1.0] if free else [1.0, 0.3] if free is None else [0.3]
        return [{**data, "speed_limit": max(0.05, min(data["speed_limit"], limit))} for limit in most]

    def sent(self, name, data):
        """Note the beginning of a movement."""
        del data
        self.lift_down = self.lift_down and name != RAISE
        self.in_aisle = self.in_aisle or name == ENTER
        self.at = {DOCK: "docking", UNDOCK: "undocking"}.get(name, self.at)

    def ended(self, name, what, data):
        """Note the end of a movement."""
        done = data.get("success", False)
        if name == LOWER:
            self.lift_down = done
        elif name in (ENTER, LEAVE):
            self.in_aisle = done if name == ENTER else not done
        elif name == DOCK:
            self.at = "docked" if what == "succeeded" else "away"
        elif name == UNDOCK and what == "succeeded":
            self.at = "away"


VALVES = tuple(f"/nozzles/{section}/valve" for section in ("left", "middle", "right"))


def valve(numbers, time):
    """Return a position of a valve. A number marks it."""
    return {"data": numbers.random() < 0.7, **nothing(numbers, time)}


class SprayerJudge(ButtonJudge):
    """By itself within the field, by hand in manual mode, and spray only in the field."""

    commands = {WHEELS: twist, NAVIGATE: destination(110.0, 50.0), **dict.fromkeys(VALVES, valve)}
    replaced = {WHEELS: STOP, **{name: {"data": False} for name in VALVES}}

    def __init__(self, time=0.0):
        super().__init__(time)
        self.within = self.filled = self.automatic = False

    def heard(self, topic, data):
        """Note a message of a device."""
        super().heard(topic, data)
        if topic == "/odom":
            position = data["pose"]["pose"]["position"]
            self.within = abs(position["x"]) <= 100.0 and abs(position["y"]) <= 40.0
        elif topic == "/tank/level":
            self.filled = data["data"] > (0.02 if self.filled else 0.1)
        elif topic == "/mode/automatic":
            self.automatic = data["data"]

    def permits(self, name, data):
        """Return whether a command may pass."""
        safe = both(self.button.in_service, self.fresh("/radio/heartbeat", 1.0))
        inside = both(self.within, self.fresh("/odom", 0.5))
        automatic = both(self.automatic, self.fresh("/mode/automatic", 0.5))
        if name == WHEELS:
            return both(safe, opposite(automatic), NAVIGATE not in self.running)
        if name == NAVIGATE:
            return both(safe, inside, automatic)
        return either(not data["data"], both(safe, inside, self.filled))


def _own(name):
    return EXAMPLES / name / f"{name}.rscd"


def _guard(folder, name):
    return Path(__file__).parent / "guards" / folder / f"{name}_guard.rscd"


@dataclass(frozen=True)
class Guarded:
    """The guard of a scenario: its model and its judge."""

    model: Path
    judge: type


#: Models of controllers that are layers guard their own scenario.
GUARDED = {
    "line_follower": Guarded(_guard("driving", "wheels"), WheelsJudge),
    "simple_navigation": Guarded(_own("simple_navigation"), NavigationJudge),
    "obstacle_navigation": Guarded(_own("obstacle_navigation"), ObstacleJudge),
    "object_finder": Guarded(_guard("driving", "object_finder"), TurnJudge),
    "maze_solver": Guarded(_guard("driving", "maze_solver"), QuarterJudge),
    "push_ball": Guarded(_guard("driving", "wheels"), WheelsJudge),
    "person_follower": Guarded(_guard("driving", "wheels"), WheelsJudge),
    "supervised_line_follower": Guarded(_own("supervised_line_follower"), StepsJudge),
    "warehouse_robot": Guarded(_guard("warehouse_robot", "warehouse_robot"), WarehouseJudge),
    "sprayer": Guarded(_guard("sprayer", "sprayer"), SprayerJudge),
}


def restless(name, seed=0):
    """Return a scenario whose people and devices act at random, and the judge of its guard."""
    return RestlessSimulation(SCENARIOS[name], seed), GUARDED[name].judge()
