"""Rules for the two showcases. The times of the log determine silence, from the last message of each sensor."""

from __future__ import annotations

from typing import Any

from .judging import SLACK, Fault, RuleBook, first_fault

NEVER = float("-inf")


class WarehouseRobot(RuleBook):
    """Drives below a shelf, lifts it away from people, returns home and docks; takes nothing from the shelf."""

    clearance, foresight, silence = 0.5, 1.5, 0.5
    slow, fast = 0.3, 1.0
    #: Seconds before the next attempt to dock, by the number of failures, and before the next attempt to drive.
    pauses = {1: 5.0, 2: 30.0}  # noqa: RUF012  # a table, never changed
    pause = 5.0

    def __init__(self) -> None:
        super().__init__()
        self.touched = {"Front", "Rear", "Left", "Right"}
        self.zones = {"Ahead": "obstructed", "Behind": "obstructed"}
        self.scanned = {"Ahead": NEVER, "Behind": NEVER}
        self.charged = self.lifted = self.in_aisle = self.asks_aisle = False
        self.docked, self.asks_dock = True, False
        self.refused, self.refused_at = 0, NEVER
        self.phase = "idle"
        #: True until the end of the goal, also while the goal is being canceled.
        self.under_way, self.canceling, self.failed_at = False, False, NEVER
        #: True while a movement at the dock has not ended, and while it is being canceled.
        self.leaves_dock = self.stops_dock = False
        #: True from the first request to leave the dock, or the aisle, until it has succeeded or was refused.
        self.undocking = self.leaving = False
        self.limit: float | None = None
        #: Whether a shelf is known, whether the present one was served, and whether its order was canceled.
        self.known_shelf = self.delivered = self.halted = False
        #: Whether a goal is open, was accepted too much, and whether the fleet manager's call began a mission.
        self.goal = self.busy = self.granted = False

    def heard(self, name: str, value: Any) -> None:
        self._take_order(name)
        done = isinstance(value, dict) and value.get("success") is True
        self._sense(name, value)
        self._hear_answer(name, done=done)
        self._go_on(name, done=done)

    def _take_order(self, name: str) -> None:
        """Process an order of a client, or its cancel."""
        if name in ("order", "fetch.u_request", "again.u_request"):
            self.granted = self.phase == "idle" and (self.known_shelf or name != "again.u_request")
            if self.granted:
                self.phase, self.known_shelf, self.delivered, self.halted = "outbound", True, False, False
        if name == "fetch.u_request":
            self.busy, self.goal = not self.granted or self.goal, True
        elif name == "fetch.u_cancel":
            self.halted = self.phase == "outbound"

    def _sense(self, name: str, value: Any) -> None:
        """Process a message of a sensor."""
        device, _, what = name.partition("_")
        if what == "touched":
            (self.touched.add if value else self.touched.discard)(device)
        elif what == "scan":
            self.scanned[device], self.zones[device] = self.time, self.zone(value["ranges"])
        elif name == "charge":
            self.charged = value["percentage"] >= 0.2 if self.charged else value["percentage"] > 0.3

    def _hear_answer(self, name: str, *, done: bool) -> None:
        """Process the answer to a command, or the confirmation of a person."""
        match name:
            case "undock":
                self.docked, self.undocking = self.docked and not done, False
                self.leaves_dock = self.stops_dock = False
            case "undock.u_error" | "undock.u_canceled":
                self.leaves_dock = self.stops_dock = False
            case "dock.u_canceled":
                self.asks_dock = self.stops_dock = False
            case "dock" | "dock.u_error":
                self.docked, self.asks_dock, self.stops_dock = done, False, False
                self.refused, self.refused_at = 0 if done else self.refused + 1, self.time
            case "try_again":
                self.refused = self.refused % 3
            case "enter" | "enter.u_error":
                self.in_aisle, self.asks_aisle = done, False
            case "leave":
                self.in_aisle, self.leaving = self.in_aisle and not done, False
            case "lower":
                self.lifted = self.lifted and not done
            case "navigate" | "navigate.u_error" | "navigate.u_canceled":
                self.under_way = self.canceling = False
                self.failed_at = self.time if name == "navigate.u_error" else NEVER

    def _go_on(self, name: str, *, done: bool) -> None:
        """Update the phase of the robot's task after an input."""
        match self.phase, name:
            case "outbound", "navigate":
                self.phase = "homebound" if self.halted else "at shelf"
            case "at shelf", "raise" | "raise.u_error":
                self.phase = "serving" if done else "served"
            case "serving", "served":
                self.phase, self.delivered = "served", True
            case "served", "lower" if done:
                self.phase = "homebound"
            case "homebound", "navigate":
                self.phase = "at home"
            case "at home", "dock" if done:
                self.phase = "idle"
        self._turn_back()

    def _turn_back(self) -> None:
        paused = self.time - self.failed_at < self.pause
        due = self.halted or not self.charged
        if self.phase == "outbound" and due and not (self.docked or self.under_way or paused):
            self.phase = "homebound"

    def zone(self, ranges: list[float | None]) -> str:
        """Return the zone of a scan; a ray without an obstacle is None in the log."""
        nearest = min((3.5 if away is None else away for away in ranges), default=0.0)
        return "obstructed" if nearest < self.clearance else "near" if nearest < self.foresight else "free"

    @property
    def silent(self) -> bool:
        """Whether the robot must have noticed a silent lidar."""
        return self.time - min(self.scanned.values()) > self.silence + SLACK

    @property
    def obstacles(self) -> list[tuple[bool, str]]:
        """Return the conditions that end a journey."""
        return [
            (self.stopped, "stop is pressed"),
            (bool(self.touched), "a bumper is touched"),
            ("obstructed" in self.zones.values(), "something is in the way"),
            (self.silent, "a lidar is silent"),
            (self.phase == "outbound" and not self.charged, "out with little power"),
            (self.phase == "outbound" and self.halted, "the order is canceled"),
        ]

    def overdue(self) -> Fault:
        wrong = first_fault(*self.obstacles)
        free = all(zone == "free" for zone in self.zones.values())
        return first_fault(
            (self.under_way and not self.canceling and wrong is not None, "the journey has not been cancelled"),
            ((self.leaves_dock or self.asks_dock) and self.stopped and not self.stops_dock, "the dock moves it on"),
            (self.limit == self.fast and not free, "the limit is too high"),
            (self.busy, "a goal was accepted during another mission"),
        )

    def sent(self, name: str, value: Any) -> Fault:
        fault = getattr(self, "_" + name.replace(".c_", "_"))(value)
        self._turn_back()
        return fault

    def _navigate(self, value: Any) -> Fault:
        fault = first_fault(
            *self.obstacles,
            (self.under_way, "there is a journey already"),
            (not self.in_aisle or self.leaving, "nobody has let it into the aisle"),
            (self.docked or self.asks_dock, "it is in its dock"),
            (self.phase not in ("outbound", "homebound"), "it has nowhere to go"),
            (self.lifted, "the shelf is lifted"),
            (self.time - self.failed_at < self.pause, "it has just failed"),
            (self.phase == "homebound" and value["pose"]["header"]["frame_id"] != "map", "that is not home"),
        )
        self.under_way = True
        return fault

    def _navigate_cancel(self, _: Any) -> Fault:
        blind = self.time - min(self.scanned.values()) >= self.silence
        may_go_on = not blind and first_fault(*self.obstacles) is None
        fault = first_fault((not self.under_way or self.canceling, "there is no journey"), (may_go_on, "it may go on"))
        self.canceling = True
        return fault

    def _enter(self, _: Any) -> Fault:
        fault = first_fault(
            (self.docked, "it is still in its dock"),
            (self.phase not in ("outbound", "homebound"), "it has nothing to do there"),
            (self.lifted, "people are there"),
            (self.in_aisle or self.asks_aisle, "it is there already"),
        )
        self.asks_aisle = True
        return fault

    def _leave(self, _: Any) -> Fault:
        fault = first_fault(
            (not self.in_aisle, "it is not there"),
            (self.under_way, "it drives there"),
            (self.phase in ("outbound", "homebound") and not self.leaving, "it is not yet done there"),
        )
        self.leaving = True
        return fault

    def _raise(self, _: Any) -> Fault:
        fault = first_fault(
            (self.stopped, "the lift is stopped"),
            (self.in_aisle or self.asks_aisle, "it is among people"),
            (self.phase != "at shelf", "it is not below the shelf"),
            (self.lifted, "it is up"),
        )
        self.lifted = True
        return fault

    def _lower(self, _: Any) -> Fault:
        return first_fault(
            (self.stopped, "the lift is stopped"),
            (not self.lifted and self.phase == "served", "it is down"),
            (self.phase != "served", "somebody takes something"),
        )

    def _undock(self, _: Any) -> Fault:
        fault = first_fault(
            (self.stopped, "the dock is stopped"),
            (not self.docked, "it is off its dock"),
            (self.phase != "outbound", "nothing is ordered"),
            (self.halted and not self.undocking, "the order is canceled"),
            (not self.charged and not self.undocking, "little power"),
            (self.leaves_dock, "it leaves its dock already"),
        )
        self.undocking = self.leaves_dock = True
        return fault

    def _undock_cancel(self, _: Any) -> Fault:
        return self._stop_at_dock(moves=self.leaves_dock)

    def _dock_cancel(self, _: Any) -> Fault:
        return self._stop_at_dock(moves=self.asks_dock)

    def _stop_at_dock(self, *, moves: bool) -> Fault:
        fault = first_fault(
            (not moves or self.stops_dock, "it does not move at its dock"),
            (not self.stopped, "it may go on"),
        )
        self.stops_dock = True
        return fault

    def _dock(self, _: Any) -> Fault:
        fault = first_fault(
            (self.stopped, "the dock is stopped"),
            (self.phase != "at home", "it is not at home"),
            (self.docked or self.asks_dock, "it docks already"),
            (self.refused == 3, "nobody was asked"),
            (self.time - self.refused_at < self.pauses.get(self.refused, 0.0), "it was refused just now"),
        )
        self.asks_dock = True
        return fault

    def _again_response(self, value: Any) -> Fault:
        granted, self.granted = self.granted, False
        return first_fault((value["success"] is not granted, "the answer is wrong"))

    def _fetch_response(self, _: Any) -> Fault:
        return self._end((not self.delivered, "nobody was served"))

    def _fetch_error(self, _: Any) -> Fault:
        return self._end((self.delivered, "the shelf was served"), (self.halted, "the order was canceled"))

    def _fetch_canceled(self, _: Any) -> Fault:
        return self._end((not self.halted, "the order was not canceled"))

    def _end(self, *claims: tuple[bool, str]) -> Fault:
        """Judge the end of a goal. A canceled order may end in the dock, before the robot has left it."""
        if self.phase == "outbound" and self.halted and self.docked:
            self.phase = "idle"
        fault = first_fault(
            (not self.goal, "there is no goal"),
            (not self.docked or self.phase != "idle", "it is not at home"),
            *claims,
        )
        self.goal = False
        return fault

    def _speed_limit(self, value: Any) -> Fault:
        free = all(zone == "free" for zone in self.zones.values())
        self.limit = round(value["speed_limit"], 3)
        return first_fault(
            (self.limit not in (self.slow, self.fast), "that is no limit"),
            (self.limit == self.fast and not free, "too fast for what is near"),
            (
                self.limit == self.slow and free and self.time - min(self.scanned.values()) < self.silence,
                "nothing is near",
            ),
        )


def both(*claims: bool | None) -> bool | None:
    """Conjunction in three-valued logic; None means unknown."""
    return False if False in claims else None if None in claims else True


class Sprayer(RuleBook):
    """Drives along a route by itself, or follows a stick; sprays the sections that are due."""

    half_length, half_width = 100.0, 40.0
    #: Seconds of silence after which a source has no effect, and seconds before the next attempt to drive.
    patiences = {"radio": 1.0, "odometry": 0.5, "stick": 0.3}  # noqa: RUF012
    pause = 5.0

    def __init__(self) -> None:
        super().__init__()
        self.heard_at = dict.fromkeys(self.patiences, NEVER)
        self.within = self.filled = self.automatic = False
        #: True until the end of the goal, also while the goal is being canceled.
        self.driving = self.canceling = False
        #: Whether the held stick was first pushed while it had an effect; None means unknown.
        self.pushed: bool | None = False
        self.left, self.failed_at = 0, NEVER
        self.due = dict.fromkeys(("Left", "Middle", "Right"), False)

    def speaks(self, what: str) -> bool | None:
        """Whether a source sends messages; None if it may just have timed out."""
        silent = self.time - self.heard_at[what]
        return True if silent < self.patiences[what] else False if silent > self.patiences[what] + SLACK else None

    @property
    def may_steer(self) -> bool | None:
        """Whether the stick has an effect."""
        return both(not self.stopped, self.speaks("radio"), not self.automatic, not self.driving)

    @property
    def safe(self) -> bool | None:
        """Whether the robot may drive by itself in automatic mode."""
        return both(not self.stopped, self.speaks("radio"), both(self.within, self.speaks("odometry")))

    @property
    def by_hand(self) -> bool | None:
        """Whether the robot follows the stick."""
        self._let_go()
        return both(self.may_steer, self.pushed, self.speaks("stick"))

    def sprays(self, section: str) -> bool | None:
        """Whether the valve of a section is open."""
        driven = True if self.driving else self.by_hand
        return both(self.safe, self.filled, driven, self.due[section])

    def _let_go(self) -> None:
        """Stop the effect of the stick as soon as it must not have one."""
        if self.may_steer is False:
            self.pushed = False
        elif self.may_steer is None and self.pushed:
            self.pushed = None

    def heard(self, name: str, value: Any) -> None:
        self._let_go()
        match name:
            case "heartbeat":
                self.heard_at["radio"] = self.time
            case "odometry":
                place = value["pose"]["pose"]["position"]
                self.within = abs(place["x"]) <= self.half_length and abs(place["y"]) <= self.half_width
                self.heard_at["odometry"] = self.time
            case "wish":
                held = self.speaks("stick")
                if held is not True:
                    self.pushed = self.may_steer if held is False or self.may_steer is self.pushed else None
                self.heard_at["stick"] = self.time
            case "level":
                self.filled = value > 0.02 if self.filled else value > 0.1
            case "automatic":
                self.automatic = value
            case "route":
                self.left = self.left if self.driving else len(value["poses"])
            case "drive" | "drive.u_error" | "drive.u_canceled":
                self.driving = self.canceling = False
                self.failed_at = self.time if name == "drive.u_error" else NEVER
                self.left -= name == "drive"
            case _ if name.endswith("_sprayed"):
                self.due[name.partition("_")[0]] = not value
        self._let_go()

    def overdue(self) -> Fault:
        must_end = self.driving and not self.canceling and both(self.safe, self.automatic) is False
        return first_fault((must_end, "the journey has not been cancelled"))

    def sent(self, name: str, value: Any) -> Fault:
        section, _, valve = name.partition("_")
        if valve in ("open", "shut"):
            return first_fault(
                (value is not (valve == "open"), "that is not what the valve is told"),
                (valve == "open" and self.sprays(section) is False, "nothing is to be sprayed"),
                (valve == "shut" and self.sprays(section) is True, "that is to be sprayed"),
            )
        match name:
            case "obey":
                return first_fault(
                    (self.driving, "it drives by itself"),
                    (self.may_steer is False, "the stick does not count"),
                    (self.by_hand is False, "nobody holds the stick"),
                )
            case "halt":
                return first_fault(
                    (self.driving, "the wheels are not its own"), (self.by_hand is True, "the stick is held")
                )
            case "drive.c_cancel":
                may_go_on = both(self.safe, self.automatic) is True
                fault = first_fault(
                    (not self.driving or self.canceling, "there is no journey"), (may_go_on, "it may go on")
                )
                self.canceling = True
                return fault
        fault = first_fault(
            (self.driving, "there is a journey already"),
            (not self.automatic, "it is driven by hand"),
            (self.safe is False, "it may not drive there"),
            (self.left <= 0, "the route is at its end"),
            (self.time - self.failed_at < self.pause, "it has just failed"),
        )
        self.driving = True
        return fault
