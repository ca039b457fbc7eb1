"""Scenarios: a place, its contents, a script and a goal.

A script is a generator. It yields a number of seconds, or a condition, to wait for before it continues.
"""

from __future__ import annotations

from .devices import RANGE_MAX, Lidar, Odometry

#: Seconds until a person presses the next button.
REACTION = 0.5


class Scenario:
    """A place, its devices, a script and a goal: the base class of all scenarios."""

    #: The name of the scenario and of its example.
    name = ""
    #: The model of the controller behind the supervisory layer, if there is one, in the example's folder.
    controller: str | None = None
    #: Topics on which people send messages, apart from buttons, with their types.
    people: dict[str, str] = {}
    #: Services and actions of the controller that people and programs call, with their types.
    calls: dict[str, str] = {}
    goals: dict[str, str] = {}
    #: A topic on which the controller reports at each tick that it is alive, if its commands do not show that.
    alive: str | None = None
    #: Pixels per meter in the picture.
    scale = 110
    #: Topics that a controller need not subscribe to.
    unheard: tuple[str, ...] = ("/odom",)
    #: The longest run in seconds.
    patience = 150.0

    def world(self):
        """Return the place in its initial state."""
        raise NotImplementedError

    def sensors(self, noise):
        """Return the sensors of each robot: a lidar and encoders."""
        return [Lidar(noise.up_to(0.005)), Odometry()]

    def devices(self, world, noise):
        """Return the other devices."""
        raise NotImplementedError

    def script(self, simulation):
        """Yield the actions of people, and the incidents of the robot."""
        raise NotImplementedError

    def reached(self, simulation):
        """Return whether the goal is reached."""
        raise NotImplementedError

    def pose(self, world):
        """Return the robot's pose and related data, for the record."""
        # JSON has no infinity.
        gap = min(world.gap, RANGE_MAX)
        return {"x": world.pose.x, "y": world.pose.y, "heading": world.pose.heading, "gap": gap}


def set_going(simulation):
    """Start the robot, which begins stopped."""
    yield REACTION
    simulation.go_on("the robot is set going")


def stop_and_continue(simulation, seconds):
    """Press stop, release it after a while, and then press continue."""
    simulation.press()
    yield seconds
    simulation.release()
    yield REACTION
    simulation.go_on("continue is pressed")
