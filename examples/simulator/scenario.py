"""What a scenario is: a place, what is in it, what happens, and a goal.

What happens is a script: a generator that yields for how many seconds, or until what, it waits before it goes on.
"""

from __future__ import annotations

from .devices import RANGE_MAX, Lidar, Odometry

#: Seconds until a person presses the next button.
REACTION = 0.5


class Scenario:
    """A place, its devices, a script and a goal; the base of all."""

    #: The example's, too.
    name = ""
    #: The model of the controller behind the supervisory layer, where there is one, in the example's folder.
    controller: str | None = None
    #: What people send beside pressing buttons: topics and types.
    people: dict[str, str] = {}  # noqa: RUF012  # a table, never changed
    #: A topic on which the controller shows at each of its ticks that it is alive, where its commands do not.
    alive: str | None = None
    #: Pixels of a metre in the picture.
    scale = 110
    #: Topics that a controller need not listen to.
    unheard: tuple[str, ...] = ("/odom",)
    #: Seconds after which nobody hopes any longer.
    patience = 150.0

    def world(self):
        """The place, as it is at the start."""
        raise NotImplementedError

    def sensors(self, noise):
        """What every robot has: a lidar and encoders."""
        return [Lidar(noise.up_to(0.005)), Odometry()]

    def devices(self, world, noise):
        """What is there beside these."""
        raise NotImplementedError

    def script(self, simulation):
        """What people do, and what befalls the robot."""
        raise NotImplementedError

    def reached(self, simulation):
        """Whether the goal is reached."""
        raise NotImplementedError

    def pose(self, world):
        """Where the robot is, and what else is of interest about it, for the record."""
        # JSON knows nothing infinite.
        gap = min(world.gap, RANGE_MAX)
        return {"x": world.pose.x, "y": world.pose.y, "heading": world.pose.heading, "gap": gap}


def set_going(simulation):
    """Someone sets the robot going, which begins stopped."""
    yield REACTION
    simulation.go_on("the robot is set going")


def stop_and_continue(simulation, seconds):
    """Someone presses stop, releases it after a while, and then presses continue."""
    simulation.press()
    yield seconds
    simulation.release()
    yield REACTION
    simulation.go_on("continue is pressed")
