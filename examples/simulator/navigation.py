"""A small Nav2: an action server that plans a way, drives it, and recovers when it is stuck."""

from __future__ import annotations

import math

from .devices import RANGE_MAX, Device, as_pose, header
from .geometry import Pose, cast, turned
from .planning import Grid

ACTION = "/navigate_to_pose"
#: The distance that the robot's center keeps from obstacles; the distance that counts as arrived.
CLEARANCE, TOLERANCE = 0.28, 0.1
SPEED, TURN_SPEED = 0.22, 1.0
#: The distance ahead to steer for; the times between plans and for backing up; the most recoveries for one goal.
LOOK_AHEAD, REPLAN, BACK_UP, GIVE_UP = 0.3, 0.5, 1.5, 8
#: The lidar's rays; the range of remembered hits; the rays to each side that look ahead; the distance to recover at.
RAYS, IN_SIGHT, AHEAD, TOO_NEAR = 120, 1.5, 8, 0.24


class Navigation(Device):
    """A server that drives to a pose. It needs the robot's initial pose first, and rejects goals before.

    It adds the events of goals to `events`, as (goal, what, data): `feedback`, `succeeded`, `canceled`, `aborted`.
    There is one goal at a time: a new one ends the previous one.
    """

    serves = {ACTION: "nav2_msgs/NavigateToPose"}
    hears = {"/initialpose": "geometry_msgs/PoseWithCovarianceStamped"}
    period = 0.2
    clearance = CLEARANCE

    def __init__(self, known_walls):
        """Create the server. `known_walls` is the map. It detects other obstacles by lidar."""
        self._map = Grid(self.clearance)
        for wall in known_walls:
            self._map.block_wall(wall)
        self._origin = None
        self._odometry_then = None
        self._goal = None
        self._destination = None
        self._way = None
        self._planned = -math.inf
        self._backing_until = None
        #: Squares in which the lidar has hit something.
        self._seen = set()
        self.recoveries = 0
        self.arrived = 0
        self.events = []
        self._news = []

    def hear(self, world, topic, data):
        """Set the initial pose: the robot's pose on the map, as a person sees it."""
        del topic
        pose = data["pose"]["pose"]
        orientation = pose["orientation"]
        heading = 2 * math.atan2(orientation["z"], orientation["w"])
        self._origin = Pose(pose["position"]["x"], pose["position"]["y"], heading)
        self._odometry_then = world.drive.odometry

    def accept(self, world, goal, data):
        """Begin a journey. Return whether that is possible."""
        position = data["pose"]["pose"]["position"]
        destination = position["x"], position["y"]
        known = self._origin is not None and data["pose"]["header"]["frame_id"] == "map"
        if not known or not all(map(math.isfinite, destination)):
            self._news.append("a goal is rejected")
            return False
        if self._goal is not None:
            self._end(world, "aborted", "gives way to a newer goal")
        self._goal, self._destination = goal, destination
        self._way, self.recoveries, self._backing_until, self._planned = None, 0, None, -math.inf
        self._seen.clear()
        self._news.append("sets off")
        return True

    def cancel(self, world, goal):
        """End a journey. Return whether it was under way."""
        if goal != self._goal:
            return False
        self._end(world, "canceled", "the journey is cancelled")
        return True

    def act(self, world):
        """Continue the journey."""
        if self._goal is None:
            return
        pose = self._pose(world)
        if math.hypot(self._destination[0] - pose.x, self._destination[1] - pose.y) < TOLERANCE:
            self.arrived += 1
            self._end(world, "succeeded", "arrives")
        elif self._backing_until is not None:
            self._back_up(world)
        else:
            too_near = world.steps % 5 == 0 and self._look(world, pose)
            if world.time - self._planned >= REPLAN:
                self._plan(world, pose)
            if too_near or self._way is None:
                self._recover(world)
            else:
                self._steer(world, pose)

    def say(self, world):
        """Add feedback on the progress of the goal."""
        if self._goal is not None:
            pose = self._pose(world)
            stamped = {"header": header(world, "map"), "pose": as_pose(pose)}
            left = math.hypot(self._destination[0] - pose.x, self._destination[1] - pose.y)
            data = {"current_pose": stamped, "number_of_recoveries": self.recoveries, "distance_remaining": left}
            self.events.append((self._goal, "feedback", data))
        return []

    def news(self):
        """Return descriptions of the ends of journeys."""
        news, self._news = self._news, []
        return news

    def _pose(self, world):
        """Return the robot's pose on the map: the initial pose, continued by odometry."""
        then, now = self._odometry_then, world.drive.odometry
        x, y = self._origin.ahead(*then.towards(now.x, now.y))
        return Pose(x, y, self._origin.heading + now.heading - then.heading)

    def _look(self, world, pose):
        """Record the hits of the lidar. Return whether one is right before the robot."""
        hits = cast(world.pose, world.seen_by_lidar, RAYS, RANGE_MAX)
        for ray, away in enumerate(hits):
            if away < IN_SIGHT:
                angle = pose.heading + ray * 2 * math.pi / RAYS
                self._seen.add(Grid.cell(pose.x + away * math.cos(angle), pose.y + away * math.sin(angle)))
        return min(hits[-AHEAD:] + hits[: AHEAD + 1]) < TOO_NEAR

    def _plan(self, world, pose):
        self._planned = world.time
        grid = Grid(self.clearance, self._map.blocked)
        for cell in sorted(self._seen):
            grid.block(*grid.centre(cell))
        self._way = grid.way((pose.x, pose.y), self._destination)

    def _recover(self, world):
        self.recoveries += 1
        if self.recoveries > GIVE_UP:
            self._end(world, "aborted", "finds no way")
        else:
            self._news.append("is stuck and backs up")
            self._backing_until = world.time + BACK_UP

    def _back_up(self, world):
        if world.time < self._backing_until:
            world.drive.command(-0.1, 0.0)
            return
        world.drive.command(0.0, 0.0)
        self._backing_until, self._planned = None, -math.inf
        self._seen.clear()

    def _steer(self, world, pose):
        """Steer to the first point of the way that is far enough ahead. Turn on the spot if it is not ahead."""
        while len(self._way) > 1 and math.hypot(self._way[0][0] - pose.x, self._way[0][1] - pose.y) < LOOK_AHEAD:
            self._way.pop(0)
        x, y = self._way[0]
        off = turned(math.atan2(y - pose.y, x - pose.x) - pose.heading)
        turn = max(-TURN_SPEED, min(TURN_SPEED, 2.5 * off))
        world.drive.command(0.0 if abs(off) > 0.7 else self._speed(pose) * (1 - abs(off)), turn)

    def _speed(self, pose):
        """Return the speed for straight ahead."""
        del pose
        return SPEED

    def _end(self, world, how, words):
        world.drive.command(0.0, 0.0)
        self.events.append((self._goal, how, {}))
        self._goal = self._way = self._backing_until = None
        self._news.append(words)
