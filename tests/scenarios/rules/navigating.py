"""Rules for robots that are driven by Nav2."""

from __future__ import annotations

from typing import Any

from .judging import Fault, RuleBook, first_fault


class SimpleNavigation(RuleBook):
    """Drives to the last clicked point after the robot knows its place; cancels a journey that must not go on."""

    #: Number of recoveries of Nav2 permitted on one journey.
    recoveries_allowed: int | None = None

    def __init__(self) -> None:
        super().__init__()
        self.located = self.called = self.under_way = self.recalled = False
        self.point: Any = None
        self.recoveries = 0

    def heard(self, name: str, value: Any) -> None:
        match name:
            case "initial_pose":
                self.located = True
            case "clicked_point":
                # A click has no effect before the robot knows its place.
                if self.located:
                    self.point = value
                    self.recalled = self.under_way
                    self.called = not self.under_way
            case "navigate" | "navigate.u_error":
                self._end()
            case "navigate.u_feedback":
                if self.under_way and value is not None:
                    self.recoveries = value["number_of_recoveries"] if isinstance(value, dict) else value
            case "continue":
                self.called = False

    def _end(self) -> None:
        self.called, self.under_way, self.recalled = self.recalled, False, False

    @property
    def must_end(self) -> bool:
        too_many = self.recoveries_allowed is not None and self.recoveries > self.recoveries_allowed
        return self.stopped or self.recalled or (self.under_way and too_many)

    def overdue(self) -> Fault:
        return first_fault((self.under_way and self.must_end, "the journey has not been cancelled"))

    def sent(self, name: str, value: Any) -> Fault:
        if name == "navigate.c_cancel":
            fault = first_fault((not self.under_way, "there is no journey"), (not self.must_end, "it may go on"))
            self._end()
            return fault
        fault = first_fault(
            (name != "navigate", "nobody knows that"),
            (self.stopped, "stop is pressed"),
            (self.under_way, "there is a journey already"),
            (not self.located, "nobody has said where the robot is"),
            (not self.called, "nobody has clicked since"),
            (self._destination(value) != self._clicked(), "that is not where the click was"),
        )
        self.called, self.under_way, self.recoveries = False, True, 0
        return fault

    @staticmethod
    def _destination(value: Any) -> tuple[Any, ...]:
        pose = value["pose"]
        position = pose["pose"]["position"]
        return (pose["header"]["frame_id"], position["x"], position["y"], position["z"])

    def _clicked(self) -> tuple[Any, ...]:
        point = self.point["point"]
        return (self.point["header"]["frame_id"], point["x"], point["y"], point["z"])


class ObstacleNavigation(SimpleNavigation):
    """As `SimpleNavigation`, and gives up after too many recoveries of Nav2."""

    recoveries_allowed = 5
