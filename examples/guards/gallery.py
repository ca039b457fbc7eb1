"""The twelve guards of the gallery: for each a small world, and a judge that does not know the model."""

from __future__ import annotations

import math

from ..simulator.judge import STOP, Button, Judge, both, either, finite, opposite
from ..simulator.random_data import destination, nothing, stamp, stamped_twist, twist
from .world import Base, SmallWorld

WHEELS, NAVIGATE, FOLLOW = "/cmd_vel", "/navigate_to_pose", "/arm_controller/follow_joint_trajectory"
DOCK, UNDOCK = "/dock_robot", "/undock_robot"
#: Seconds until the effects of a report must have arrived at the wheels: the patience of a sensor, the timeout of the
#: base or the end of a canceled goal, and the way to brake.
REACTION = 2.0


class SpeedWorld(SmallWorld):
    """A base, and a detector of people."""

    def __init__(self, seed=0):
        super().__init__(seed)
        self.nearest = 5.0

    def live(self):
        """Let people come and go."""
        super().live()
        self.nearest = max(0.2, min(self.nearest + self.random.uniform(-0.2, 0.2), 6.0))
        if self.every(0.1):
            self.say("/people/nearest", {"data": math.nan if self.happens(0.5) else self.nearest})

    def danger(self):
        """Return whether the base is fast although somebody has been near for a while."""
        near = self.lasts("near", self.nearest < 3.0, REACTION)
        return "fast near people" if near and abs(self.base.speed) > 0.31 else None


class SpeedJudge(Judge):
    """At most 1 m/s, and 0.3 m/s while somebody is near."""

    commands = {WHEELS: twist}
    replaced = {WHEELS: STOP}

    def __init__(self, time=0.0):
        super().__init__(time)
        self.far = False

    def heard(self, topic, data):
        """Note the distance."""
        del topic
        self.far = data["data"] >= 3.0

    def permits(self, name, data):
        """Return whether the speed is a number."""
        del name
        return finite(data["linear"]["x"])

    def limited(self, name, data):
        """Return the velocity with its limit."""
        del name
        far = both(self.far, self.fresh("/people/nearest", 0.5))
        limits = [1.0] if far else [1.0, 0.3] if far is None else [0.3]
        return [
            {**data, "linear": {**data["linear"], "x": max(-limit, min(data["linear"]["x"], limit))}}
            for limit in limits
        ]


class StopWorld(SmallWorld):
    """A base, Nav2 and an arm, with a button that somebody presses, releases and acknowledges."""

    serves = (NAVIGATE, FOLLOW)

    def __init__(self, seed=0):
        super().__init__(seed)
        self.pressed = False

    def live(self):
        """Press and release the button."""
        super().live()
        if self.happens(0.3):
            self.pressed = not self.pressed
        if self.every(0.1):
            self.say("/emergency_stop", {"data": self.pressed})
        if self.happens(0.6):
            self.say("/continue", {})

    def danger(self):
        """Return what still moves a while after the button was pressed."""
        stopped = self.lasts("stopped", self.pressed, REACTION)
        moves = self.base.moves or any(server.moves and not server.ghost for server in self.servers.values())
        return "something moves although stop is pressed" if stopped and moves else None


class StopJudge(Judge):
    """Nothing begins or goes on while the button is pressed or silent, and until somebody agrees."""

    commands = {WHEELS: twist, NAVIGATE: destination(5.0, 5.0), FOLLOW: nothing}
    replaced = {WHEELS: STOP}

    def __init__(self, time=0.0):
        super().__init__(time)
        self.button = Button(self)

    def heard(self, topic, data):
        """Note a message of the button."""
        self.button.heard(topic, data)

    def permits(self, name, data):
        """Return whether the robot is in service."""
        del name, data
        return self.button.in_service


TELEOP, AUTONOMY = "/teleop/cmd_vel", "/autonomy/cmd_vel"


class TeleopJudge(Judge):
    """A person has priority until a second after the last velocity."""

    commands = {TELEOP: twist, AUTONOMY: twist}

    def permits(self, name, data):
        """Return whether nobody steers, for the program."""
        del data
        return True if name == TELEOP else opposite(self.fresh(TELEOP, 1.0))

    def sent(self, name, data):
        """Note the time."""
        del data
        self.note(name)


class DockingWorld(SmallWorld):
    """Nav2 and its docking server, which both move the base."""

    serves = (NAVIGATE, DOCK, UNDOCK)

    def start(self, action, goal, data):
        """Accept a goal. Docking and undocking share a server, which leaves a goal that it had lost."""
        accepted = super().start(action, goal, data)
        if accepted and action != NAVIGATE:
            self.servers[UNDOCK if action == DOCK else DOCK].forget()
        return accepted

    def danger(self):
        """Return whether both move the base."""
        docking = self.servers[DOCK].moves or self.servers[UNDOCK].moves
        return "two servers move the base" if docking and self.servers[NAVIGATE].moves else None


class DockingJudge(Judge):
    """One server at a time moves the base. A lost goal may go on until a goal of the same server succeeds."""

    commands = {NAVIGATE: destination(5.0, 5.0), DOCK: nothing, UNDOCK: nothing}
    groups = ({NAVIGATE}, {DOCK, UNDOCK})

    def __init__(self, time=0.0):
        super().__init__(time)
        self.lost = set()

    def permits(self, name, data):
        """Return whether nothing else moves the base, or may move it."""
        del data
        own, other = self.groups if name == NAVIGATE else self.groups[::-1]
        return not (own | other) & {*self.running} and not other & self.lost

    def ended(self, name, what, data):
        """Note a goal that may go on."""
        del data
        group = self.groups[name != NAVIGATE]
        if what == "lost":
            self.lost |= group
        elif what == "succeeded":
            self.lost -= group

    def goes_on(self, action, data):
        """Return True: nothing else begins."""
        del action, data
        return True


class ArmWorld(SmallWorld):
    """A base with odometry, and an arm."""

    serves = (FOLLOW,)

    def live(self):
        """Move, and report the speed."""
        super().live()
        if self.every(0.1):
            twist = {"linear": {"x": self.base.speed}, "angular": {"z": self.base.turn}}
            self.say("/odom", {"twist": {"twist": twist}})

    def danger(self):
        """Return whether both move."""
        return "arm and base move" if self.base.moves and self.servers[FOLLOW].moves else None


class ArmJudge(Judge):
    """The arm begins after half a second without velocities and a report that the base stands."""

    commands = {WHEELS: twist, FOLLOW: nothing}
    replaced = {WHEELS: STOP}

    def __init__(self, time=0.0):
        super().__init__(time)
        self.stands, self.lost = False, False
        self.note(WHEELS)

    def heard(self, topic, data):
        """Note the speed."""
        del topic
        speed = data["twist"]["twist"]
        driven = self.fresh(WHEELS, 0.5)
        still = math.hypot(speed["linear"]["x"], speed["angular"]["z"]) < 0.01
        self.stands = either(self.stands, both(still, opposite(driven)))

    def permits(self, name, data):
        """Return whether the other one rests."""
        del data
        return self.stands if name == FOLLOW else FOLLOW not in self.running and not self.lost

    def sent(self, name, data):
        """Note a velocity."""
        del data
        if name == WHEELS:
            self.stands = False
            self.note(name)

    def ended(self, name, what, data):
        """Note a goal that may go on."""
        del name, data
        self.lost = what != "succeeded" if self.lost else what == "lost"


class FenceWorld(SmallWorld):
    """Nav2 in a place with a fence, and a localization. Somebody carries the robot back over the fence."""

    serves = (NAVIGATE,)

    def __init__(self, seed=0):
        super().__init__(seed)
        self.x = self.y = 0.0

    def live(self):
        """Drive to the goal, now and then with a detour."""
        server = self.servers[NAVIGATE]
        if server.moves:
            there = server.data["pose"]["pose"]["position"]
            self.x += max(-0.2, min(there["x"] - self.x, 0.2)) + self.random.uniform(-0.02, 0.1)
            self.y += max(-0.2, min(there["y"] - self.y, 0.2))
        elif self.lasts("outside", not self.inside(0.0), 5.0):
            self.x = self.y = 0.0
        if self.every(0.1):
            position = {"x": math.nan if self.happens(0.2) else self.x, "y": self.y, "z": 0.0}
            frame = "odom" if self.happens(0.2) else "map"
            self.say("/odometry/global", {"header": {"frame_id": frame}, "pose": {"pose": {"position": position}}})

    def inside(self, allowance):
        """Return whether the robot is inside the fence."""
        return abs(self.x) < 20.0 + allowance and abs(self.y) < 10.0 + allowance

    def danger(self):
        """Return whether Nav2 drives outside of the fence for a while."""
        server = self.servers[NAVIGATE]
        drives = server.moves and not server.ghost and not self.inside(0.0)
        return "outside of the fence" if self.lasts("drives", drives, REACTION) else None


class FenceJudge(Judge):
    """Goals lie half a meter inside the fence, and the robot is inside it."""

    commands = {NAVIGATE: destination(22.0, 12.0)}

    def __init__(self, time=0.0):
        super().__init__(time)
        self.inside = False

    def heard(self, topic, data):
        """Note the place."""
        del topic
        self.inside = self._within(data["header"], data["pose"]["pose"], 20.0, 10.0)

    def permits(self, name, data):
        """Return whether robot and goal are inside."""
        del name
        goal = self._within(data["pose"]["header"], data["pose"]["pose"], 19.5, 9.5)
        return both(goal, self.inside, self.fresh("/odometry/global", 0.5))

    @staticmethod
    def _within(header, pose, width, height):
        x, y = pose["position"]["x"], pose["position"]["y"]
        return header["frame_id"] == "map" and -width < x < width and -height < y < height


class LocalizationWorld(SmallWorld):
    """A base, Nav2, and a localization that is sometimes unsure."""

    serves = (NAVIGATE,)

    def __init__(self, seed=0):
        super().__init__(seed)
        #: The localization reports only while the robot moves. Its silence means nothing.
        self.variance = self.reported = 1.0

    def live(self):
        """Turn to find the place, and lose it again."""
        super().live()
        if self.happens(0.3):
            self.variance = self.random.choice((0.01, 0.1, 0.3, 2.0, math.nan))
        if self.happens(2.0):
            covariance = [0.0] * 36
            covariance[0], covariance[7] = self.random.sample([self.variance, min(self.variance, 0.2)], 2)
            if self.say("/amcl_pose", {"pose": {"covariance": covariance}}):
                self.reported = self.variance

    def danger(self):
        """Return whether the robot drives although it has reported for a while that it does not know its place."""
        lost = self.lasts("lost", not self.reported < 0.25, REACTION)
        server = self.servers[NAVIGATE]
        moves = abs(self.base.speed) > 0.01 or (server.moves and not server.ghost)
        return "it drives without its place" if lost and moves else None


class LocalizationJudge(Judge):
    """Nav2 drives only with a known place. Velocities without one may only turn."""

    commands = {WHEELS: twist, NAVIGATE: destination(5.0, 5.0)}
    replaced = {WHEELS: STOP}

    def __init__(self, time=0.0):
        super().__init__(time)
        self.known_place = False

    def heard(self, topic, data):
        """Note the variances."""
        del topic
        covariance = data["pose"]["covariance"]
        self.known_place = covariance[0] < 0.25 and covariance[7] < 0.25

    def permits(self, name, data):
        """Return whether the place is known, or the robot only turns."""
        if name == NAVIGATE:
            return self.known_place
        x, y = data["linear"]["x"], data["linear"]["y"]
        return finite(x, y) and (self.known_place or x == y == 0.0)


NAVIGATION, FOLLOWER = "/navigation/cmd_vel", "/follower/cmd_vel"


class PublisherJudge(Judge):
    """One of two programs has the wheels until half a second after its last velocity."""

    commands = {NAVIGATION: twist, FOLLOWER: twist}

    def permits(self, name, data):
        """Return whether the other one is silent."""
        del data
        return opposite(self.fresh(FOLLOWER if name == NAVIGATION else NAVIGATION, 0.5))

    def sent(self, name, data):
        """Note the time."""
        del data
        self.note(name)


class StaleWorld(SmallWorld):
    """A base with odometry that bears stamps."""

    def live(self):
        """Report the odometry."""
        super().live()
        self.say("/odom", {"header": {"stamp": stamp(self.time), "frame_id": "odom"}})

    def receive(self, topic, data):
        """Drive."""
        super().receive(topic, data["twist"])


class StaleJudge(Judge):
    """A velocity with an old stamp, or one of the future, becomes a stop. Without odometry, nothing passes."""

    commands = {WHEELS: stamped_twist}
    replaced = {WHEELS: {"header": {"stamp": stamp(0.0), "frame_id": ""}, "twist": STOP}}

    def __init__(self, time=0.0):
        super().__init__(time)
        self.now = 0.0

    def heard(self, topic, data):
        """Note the time."""
        del topic
        self.now = self._seconds(data["header"]["stamp"])

    def permits(self, name, data):
        """Return whether the time is known."""
        del name, data
        return self.fresh("/odom", 0.2)

    def limited(self, name, data):
        """Return a stop in place of a stale velocity."""
        del name
        if abs(self.now - self._seconds(data["header"]["stamp"])) <= 0.3:
            return [data]
        linear, angular = ({**data["twist"][part]} for part in ("linear", "angular"))
        linear["x"] = angular["z"] = 0.0
        return [{**data, "twist": {"linear": linear, "angular": angular}}]

    @staticmethod
    def _seconds(stamp):
        return stamp["sec"] + stamp["nanosec"] / 1e9


class BatteryWorld(DockingWorld):
    """Nav2, its docking server, and a battery."""

    def __init__(self, seed=0):
        super().__init__(seed)
        self.charge = 0.5

    def live(self):
        """Discharge and charge."""
        self.charge = max(0.05, min(self.charge + self.random.uniform(-0.02, 0.02), 0.6))
        if self.every(0.5):
            wrong = self.happens(0.5)
            self.say("/battery_state", {"percentage": math.nan if wrong else self.charge})

    def danger(self):
        """Return whether Nav2 drives on with a low battery."""
        server = self.servers[NAVIGATE]
        low = self.lasts("low", self.charge < 0.2, 3 * REACTION + 2.5)
        return "it drives with a low battery" if low and server.moves and not server.ghost else None


class BatteryJudge(DockingJudge):
    """Nav2 drives from a charge of 0.3 on, until it falls below 0.2. The way to the dock stays open."""

    def __init__(self, time=0.0):
        super().__init__(time)
        self.charged = False

    def heard(self, topic, data):
        """Note the charge."""
        known = self.fresh(topic, 5.0) is not False
        self.charged = data["percentage"] >= (0.2 if self.charged and known else 0.3)

    def permits(self, name, data):
        """Return whether the battery is charged, or the robot docks."""
        del data
        if name == NAVIGATE:
            return both(self.charged, self.fresh("/battery_state", 5.0))
        return not {DOCK, UNDOCK} & {*self.running}

    def goes_on(self, action, data):
        """Return whether a goal may go on."""
        return self.permits(action, data) if action == NAVIGATE else True


GRIP, PLACE = "/gripper/gripper_cmd", "/place/below"


def grip(numbers, time):
    """Return a goal of a gripper, sometimes without a position."""
    del time
    positions = [] if numbers.random() < 0.03 else [numbers.choice((0.0, 0.005, 0.02, 0.08, math.nan))]
    return {"command": {"name": [], "position": positions}}


class GripperWorld(SmallWorld):
    """A gripper that takes and drops things, and a sensor for the place below it."""

    serves = (GRIP,)

    def __init__(self, seed=0):
        super().__init__(seed)
        self.below, self.holds = False, True

    def live(self):
        """Move to the place and away from it."""
        if self.happens(0.4):
            self.below = not self.below
        if self.every(0.1):
            self.say(PLACE, {"data": self.below})

    def result(self, action, what):
        """Return whether the fingers met something."""
        closes = self.servers[action].data["command"]["position"][0] < 0.01
        if what == "succeeded":
            self.holds = closes and (self.holds or self.random.random() < 0.5)
        return {"stalled": self.holds and what == "succeeded"}

    def danger(self):
        """Return whether the gripper opens elsewhere, although it has been away from the place for a while."""
        server = self.servers[GRIP]
        opens = server.moves and not server.ghost and server.data["command"]["position"][0] >= 0.01
        return "it drops the thing" if self.lasts("away", opens and self.holds and not self.below, 1.2) else None


class GripperJudge(Judge):
    """A gripper that may hold something opens only above the place."""

    commands = {GRIP: grip}

    def __init__(self, time=0.0):
        super().__init__(time)
        self.holds, self.below = True, False

    def heard(self, topic, data):
        """Note the place."""
        del topic
        self.below = data["data"]

    def permits(self, name, data):
        """Return whether the goal closes, or the gripper may open."""
        del name
        position = data["command"]["position"]
        if not position or not finite(position[0]):
            return False
        return either(position[0] < 0.01, not self.holds, both(self.below, self.fresh(PLACE, 0.5)))

    def ended(self, name, what, data):
        """Note whether something is between the fingers."""
        del name
        self.holds = what != "succeeded" or data["stalled"]


ROBOTS = ("/robot1", "/robot2")


class CorridorWorld(SmallWorld):
    """Two robots drive to and fro on a line with a corridor."""

    def __init__(self, seed=0):
        super().__init__(seed)
        self.bases = {robot: Base(self) for robot in ROBOTS}
        self.places = dict(zip(ROBOTS, (-8.0, 8.0), strict=True))
        self.headings = dict(zip(ROBOTS, (1.0, -1.0), strict=True))

    def live(self):
        """Drive, turn around at the ends, and report the places."""
        for robot, base in self.bases.items():
            self.places[robot] += base.act() * self.headings[robot]
            if abs(self.places[robot]) > 9.0 and self.places[robot] * self.headings[robot] > 0.0:
                self.headings[robot] *= -1.0
            if self.every(0.1):
                self.say(robot + "/pose", {"pose": {"position": {"x": self.places[robot]}}})

    def receive(self, topic, data):
        """Drive."""
        self.bases[topic.removesuffix(WHEELS)].obey(data)

    def danger(self):
        """Return whether both robots are in the corridor."""
        return "two robots in the corridor" if all(abs(place) < 4.0 for place in self.places.values()) else None


class CorridorJudge(Judge):
    """A robot before the corridor drives on only if no other one is in it, or may be in it."""

    commands = {robot + WHEELS: twist for robot in ROBOTS}
    replaced = {robot + WHEELS: STOP for robot in ROBOTS}

    def __init__(self, time=0.0):
        super().__init__(time)
        self.zones = dict.fromkeys(ROBOTS)

    def heard(self, topic, data):
        """Note a place."""
        robot, x = topic.removesuffix("/pose"), abs(data["pose"]["position"]["x"])
        entered = self.zones[robot] == "inside" and self.fresh(topic, 0.5) is not False
        self.zones[robot] = "away" if x > 6.0 else "inside" if x < 4.0 or entered else "near"

    def permits(self, name, data):
        """Return whether the place of the robot is known, and the corridor free if it stands before it."""
        del data
        robot = name.removesuffix(WHEELS)
        outside = [both(self.zones[other] in ("away", "near"), self._reports(other)) for other in ROBOTS]
        return both(self._reports(robot), either(self.zones[robot] != "near", both(*outside)))

    def _reports(self, robot):
        return self.fresh(robot + "/pose", 0.5)

    def sent(self, name, data):
        """Note a robot that may enter."""
        del data
        robot = name.removesuffix(WHEELS)
        if self.zones[robot] == "near":
            self.zones[robot] = "inside"


#: World and judge of each guard.
GALLERY = {
    "speed_near_people": (SpeedWorld, SpeedJudge),
    "stop_button": (StopWorld, StopJudge),
    "teleop_over_autonomy": (SmallWorld, TeleopJudge),
    "dock_or_navigate": (DockingWorld, DockingJudge),
    "arm_or_base": (ArmWorld, ArmJudge),
    "geofence": (FenceWorld, FenceJudge),
    "localized_first": (LocalizationWorld, LocalizationJudge),
    "one_publisher": (SmallWorld, PublisherJudge),
    "stale_command": (StaleWorld, StaleJudge),
    "low_battery": (BatteryWorld, BatteryJudge),
    "full_gripper": (GripperWorld, GripperJudge),
    "shared_corridor": (CorridorWorld, CorridorJudge),
}
