"""Rules for robots that are driven by velocities."""

from __future__ import annotations

from typing import Any

from .judging import Fault, RuleBook, first_fault, velocity

HALT = velocity(0.0, 0.0)
#: Seconds after which a lidar or a camera-based sensor counts as silent.
PATIENCE = 0.5


class LineFollower(RuleBook):
    """Moves along the line while the way is clear; otherwise halts."""

    silences = {"LineDetector": ("correction", PATIENCE), "Lidar": ("scan", PATIENCE)}  # noqa: RUF012  # never changed

    def __init__(self) -> None:
        super().__init__()
        self.correction: float | None = None
        self.clear = False

    def heard(self, name: str, value: Any) -> None:
        if name == "correction":
            self.correction = value
        elif name == "no_line":
            self.correction = None
            self.awaits_no("correction")
        elif name == "scan":
            self.clear = value == "clear"

    def fell_silent(self, name: str) -> None:
        if name == "correction":
            self.correction = None
        elif name == "scan":
            self.clear = False

    def sent(self, name: str, value: Any) -> Fault:
        may_move = self.correction is not None and self.clear and not self.stopped
        if name == "halt":
            return first_fault((may_move, "nothing keeps it from moving"), (value != HALT, "that is no halt"))
        wanted = velocity(0.2, -(self.correction or 0.0) / 100)
        return first_fault((not may_move, "it may not move"), (value != wanted, f"not {wanted}"))


class ObjectFinder(RuleBook):
    """Drives on a clear way, turns to clear sides of a blocked one, and does neither after it has found the sign."""

    silences = {"Lidar": ("scan_front", PATIENCE)}  # noqa: RUF012

    def __init__(self) -> None:
        super().__init__()
        self.front: Any = None
        self.left_clear = self.right_clear = False
        self.count = 0
        self.sign_in_boxes = False
        self.driving = self.turning = self.looking = False
        #: Number of received views of the current scan, which has three.
        self.views = 0

    @property
    def found(self) -> bool:
        return self.count > 0 and self.sign_in_boxes

    def heard(self, name: str, value: Any) -> None:
        match name:
            case "scan_front":
                self.front, self.views = value, 1
                self.looking = False
            case "scan_left":
                self.left_clear, self.views = value == "left_clear", self.views + 1
            case "scan_right":
                self.right_clear, self.views = value == "right_clear", self.views + 1
            case "object_count":
                self.count = value["count"] if isinstance(value, dict) else value
            case "objects":
                self.sign_in_boxes = value == "stop_sign"
            case "rotate_done" | "continue":
                self.looking = self.looking or self.turning
                self.turning = False

    def fell_silent(self, name: str) -> None:
        if name == "scan_front":
            self.front = None

    def sent(self, name: str, value: Any) -> Fault:
        half = (self.views % 3 != 0, "half of a scan has been heard")
        if name == "halt":
            self.driving = False
            idle = not self.stopped and not self.found and not self.looking
            return first_fault(
                half,
                (idle and self.front == "front_clear", "nothing keeps it from moving"),
                (idle and self.turning, "the robot turns"),
                (value != HALT, "that is no halt"),
            )
        faults = [
            half,
            (self.stopped, "stop is pressed"),
            (self.found, "the sign is found"),
            (self.turning, "it turns already"),
            (self.looking, "it has not looked since it turned"),
        ]
        if name == "move":
            self.driving = True
            faults += [
                (self.front != "front_clear", "the way is not clear"),
                (value != velocity(0.2, 0.0), "how fast?"),
            ]
        else:
            sides = {"rotate_left": self.left_clear or not self.right_clear, "rotate_right": self.right_clear}
            faults += [
                (self.driving, "it has not halted"),
                (self.front != "front_blocked", "the way is not blocked"),
                (not sides[name], "that side is not free"),
            ]
            self.turning = True
        return first_fault(*faults)


class MazeSolver(RuleBook):
    """Keeps its right hand on the wall. It decides on whole scans with three views each."""

    silences = {"Lidar": ("scan_front", PATIENCE)}  # noqa: RUF012

    def __init__(self) -> None:
        super().__init__()
        self.front = "nothing_known"
        self.right = self.back_right = False
        self.views = 0
        self.driving = self.looking = self.rounding = False
        self.turning: str | None = None
        self.turned: str | None = None

    def heard(self, name: str, value: Any) -> None:
        match name:
            case "scan_front":
                self.front, self.views = value, 1
                if self.looking:
                    self.rounding = self.turned == "rotate_right"
                self.looking = False
            case "scan_right":
                self.right, self.views = value == "wall_right", self.views + 1
            case "scan_back_right":
                self.back_right, self.views = value == "wall_back_right", self.views + 1
                self.rounding = self.rounding and not self.right
            case "rotate_done" | "continue":
                if self.turning:
                    self.turned = self.turning if name == "rotate_done" else None
                    self.turning, self.looking = None, True

    def fell_silent(self, name: str) -> None:
        if name == "scan_front":
            self.front = "nothing_known"

    def sent(self, name: str, value: Any) -> Fault:
        half = (self.views % 3 != 0, "half of a scan has been heard")
        corner = not self.right and self.back_right and not self.rounding
        if name == "halt":
            self.driving = False
            goes_on = self.front == "way_ahead" and not corner
            return first_fault(
                half,
                (not self.stopped and self.turning is not None, "the robot turns"),
                (not self.stopped and not self.looking and goes_on, "nothing keeps it from moving"),
                (value != HALT, "that is no halt"),
            )
        faults = [
            half,
            (self.stopped, "stop is pressed"),
            (self.turning is not None, "it turns already"),
            (self.looking, "it has not looked since it turned"),
        ]
        if name == "move":
            self.driving = True
            faults += [
                (self.front != "way_ahead", "no way ahead"),
                (corner, "the wall has come to an end"),
                (value != velocity(0.2, 0.0), "how fast?"),
            ]
        else:
            faults += [(self.driving, "it has not halted"), (value != 90, "not a quarter")]
            if name == "rotate_left":
                faults += [(self.front != "wall_ahead", "no wall ahead"), (corner, "the wall has come to an end")]
            else:
                faults += [(self.front == "nothing_known", "nothing is known"), (not corner, "no corner there")]
            self.turning = name
        return first_fault(*faults)


class PushBall(RuleBook):
    """Searches for the ball, drives up to it, pushes it to the goal; halts before walls, except while it only turns."""

    silences = {"Lidar": ("scan", PATIENCE), "BallDetector": ("image", PATIENCE)}  # noqa: RUF012

    def __init__(self) -> None:
        super().__init__()
        self.sees = self.free = False
        #: Knowledge about the ball: none, away, in view, in front, or slipping aside.
        self.ball = "unknown"
        self.offset = self.goal_offset = 0.0
        self.goal = False

    def heard(self, name: str, value: Any) -> None:
        if name in ("ball_correction", "no_ball"):
            self.awaits("image")
        match name, self.ball:
            case "scan", _:
                self.sees, self.free = True, value == "free"
            case "ball_correction", _:
                self.offset = value
                self.ball = "view" if self.ball in ("unknown", "away") else self.ball
            case "no_ball", _:
                self.ball = "away"
            case "ball_front_check", "view":
                self.ball = "front"
            case "needs_adjustment", "front":
                self.ball = "aside"
            case "no_adjustment", "aside":
                self.ball = "front"
            case "goal_correction", _:
                self.goal, self.goal_offset = True, value
            case "no_goal", _:
                self.goal = False

    def fell_silent(self, name: str) -> None:
        if name == "scan":
            self.sees = False
        elif name == "image":
            self.ball = "unknown"

    def sent(self, name: str, value: Any) -> Fault:
        may_move = not self.stopped and self.sees and self.ball != "unknown" and (self.free or self.ball == "away")
        if name == "halt":
            return first_fault((may_move, "nothing keeps it from moving"), (value != HALT, "that is no halt"))
        wanted = {
            "away": velocity(0.0, 0.4),
            "view": velocity(0.15, -self.offset / 200),
            "aside": velocity(0.05, -self.offset / 100),
            "front": velocity(0.15, -self.goal_offset / 400) if self.goal else velocity(0.05, 0.1),
        }.get(self.ball)
        return first_fault((not may_move, "it may not move"), (value != wanted, f"not {wanted}"))


class PersonFollower(RuleBook):
    """Turns to a person, and drives there while nothing is near."""

    silences = {"Lidar": ("scan", PATIENCE), "PersonDetector": ("who", PATIENCE)}  # noqa: RUF012

    def __init__(self) -> None:
        super().__init__()
        self.sees = self.far = self.person = False
        self.left = self.right = self.width = 0

    def heard(self, name: str, value: Any) -> None:
        if name == "scan":
            self.sees, self.far = True, value == "far"
        elif name == "who":
            self.person = value == "person"
        elif name == "place" and value is not None:
            box = value["bounding_boxes"]["0"]
            self.left, self.right, self.width = box["xmin"], box["xmax"], box["img_width"]

    def fell_silent(self, name: str) -> None:
        if name == "scan":
            self.sees = False
        elif name == "who":
            self.person = False

    def sent(self, name: str, value: Any) -> Fault:
        may_move = self.person and self.sees and not self.stopped
        if name == "halt":
            return first_fault((may_move, "nothing keeps it from moving"), (value != HALT, "that is no halt"))
        wanted = velocity(0.2 if self.far else 0.0, (self.width - self.left - self.right) / 1000)
        return first_fault((not may_move, "it may not move"), (value != wanted, f"not {wanted}"))


class Stepper(RuleBook):
    """The layer before a line follower: a step passes only along the line, on a clear way, with no stop pressed."""

    replaced = frozenset({"step"})
    silences = LineFollower.silences

    def __init__(self) -> None:
        super().__init__()
        self.line = self.clear = False

    def heard(self, name: str, value: Any) -> None:
        if name in ("correction", "no_line"):
            self.line = name == "correction"
            if not self.line:
                self.awaits_no("correction")
        elif name == "scan":
            self.clear = value == "clear"

    def fell_silent(self, name: str) -> None:
        if name == "correction":
            self.line = False
        elif name == "scan":
            self.clear = False

    def sent(self, name: str, value: Any) -> Fault:
        del value
        return first_fault(
            (name != "step", "nobody knows that"),
            (not self.line, "no line is in view"),
            (not self.clear, "something is in the way"),
            (self.stopped, "stop is pressed"),
        )
