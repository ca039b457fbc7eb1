"""The breakpoints that a client has set, by kind, and the test whether a step hits one."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from robosc.analysis.explain import NamingError
from robosc.tools.debugger.breakpoints import Targets, Watcher, real
from robosc.tools.debugger.views import format_value

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from robosc.run.simulation.replay import Moment, Replay
    from robosc.tools.debugger.breakpoints import Target
    from robosc.tools.debugger.views import Views

REFUSED, FORBIDDEN, STUCK = "refused", "forbidden", "stuck"
#: Reasons other than breakpoints for which a run can stop.
FILTERS = [
    {
        "filter": REFUSED,
        "label": "An event that cannot happen",
        "description": "Stops when the script requests an event that the robot or the supervisor does not allow.",
        "default": True,
    },
    {
        "filter": FORBIDDEN,
        "label": "A command becomes forbidden",
        "description": "Stops when the supervisor begins to forbid a command.",
        "default": False,
        "supportsCondition": True,
        "conditionDescription": "commands, such as: move, Platform.halt",
    },
    {
        "filter": STUCK,
        "label": "No event can happen",
        "description": "Stops when no event can happen any more.",
        "default": True,
    },
]


@dataclass
class Stop:
    """The reason for which a run has stopped."""

    reason: str
    description: str
    breakpoints: list[int] = field(default_factory=list)


@dataclass(frozen=True)
class _Breakpoint:
    identifier: int
    targets: Sequence[Target]


class Stops:
    """The breakpoints of a run. Methods that set them return answers of the protocol, with lines from 1."""

    def __init__(self, replay: Replay, views: Views, script: str | None) -> None:
        self._replay = replay
        self._views = views
        self._script = None if script is None else real(script)
        self._script_lines = {step.line for step in replay.steps or ()}
        self._targets = Targets(replay)
        self._watcher = Watcher(replay)
        self._numbered = 0
        self._by_line: dict[str, list[_Breakpoint]] = {}
        self._in_script: dict[int, int] = {}
        self._by_name: list[_Breakpoint] = []
        self._by_value: dict[str, int] = {}
        self._filters: dict[str, list[Target]] = {REFUSED: [], STUCK: []}

    def look(self) -> None:
        """Compare states; must be called after each step, forwards or backwards."""
        self._watcher.look()

    def hit(self, moment: Moment) -> Stop | None:
        """Return the reason for which the last step stops the run, or None if it does not."""
        if moment.by is not None and REFUSED in self._filters:
            return Stop("exception", self._views.describe(moment))
        for reason, points in (("breakpoint", self._in_files), ("function breakpoint", self._by_name)):
            hit = [
                (point.identifier, description) for point in points for description in self._hit(point.targets, moment)
            ]
            if hit:
                return Stop(reason, hit[0][1], list(dict.fromkeys(number for number, _ in hit)))
        changed = [name for name in self._by_value if moment.before[name] != moment.after[name]]
        if changed:
            change = f"{changed[0]} is {format_value(moment.after[changed[0]])}"
            return Stop("data breakpoint", change, [self._by_value[name] for name in changed])
        forbidden = self._hit(self._filters.get(FORBIDDEN, ()), moment)
        return Stop("exception", forbidden[0]) if forbidden else None

    def before_line(self, line: int | None) -> Stop | None:
        """Return the reason to stop before a line of the script, or None if there is none."""
        if line not in self._in_script:
            return None
        return Stop("breakpoint", f"line {line} of the script", [self._in_script[line]])

    @property
    def stuck(self) -> Stop:
        """Stop of a run in which no event can happen any more, whether or not its filter is set."""
        return Stop("exception" if STUCK in self._filters else "pause", "no event can happen any more")

    @property
    def _in_files(self) -> list[_Breakpoint]:
        return [point for points in self._by_line.values() for point in points]

    def _hit(self, targets: Iterable[Target], moment: Moment) -> list[str]:
        return [target.what for target in targets if target.hit(moment, self._watcher)]

    # Set by the client, each kind as a whole

    def in_file(self, path: str, lines: Sequence[int]) -> list[dict[str, Any]]:
        """Set breakpoints in lines of a model or of the script."""
        if real(path) == self._script:
            return self._set_in_script(lines)
        points, answers = [], []
        for line in lines:
            targets = self._targets.at(path, line)
            answers.append(self._answer(targets, "this line has no element at which a robot can stop"))
            answers[-1]["line"] = min((target.span.line for target in targets if target.span), default=line)
            points.append(_Breakpoint(answers[-1]["id"], targets))
        self._by_line[real(path)] = points
        self._watch()
        return answers

    def _set_in_script(self, lines: Sequence[int]) -> list[dict[str, Any]]:
        self._in_script.clear()
        answers = []
        for line in lines:
            answers.append(self._answer([], "this line has no event") | {"line": line})
            if line in self._script_lines:
                self._in_script[line] = answers[-1]["id"]
                answers[-1] |= {"verified": True, "message": "stops before this event"}
        return answers

    def by_name(self, names: Iterable[str]) -> list[dict[str, Any]]:
        """Set breakpoints at events, requirements and components by their names."""
        self._by_name.clear()
        answers = []
        for name in names:
            try:
                targets, fault = self._targets.targets_of(name.strip()), ""
            except NamingError as error:
                targets, fault = [], str(error)
            answers.append(self._answer(targets, fault))
            self._by_name.append(_Breakpoint(answers[-1]["id"], targets))
        self._watch()
        return answers

    def by_value(self, names: Iterable[str]) -> list[dict[str, Any]]:
        """Set breakpoints at changes of parts of the state."""
        self._by_value.clear()
        answers = []
        for name in names:
            answers.append(self._answer([], f"{name} is not part of the state that changes"))
            if name in self._replay.engine.state:
                self._by_value[name] = answers[-1]["id"]
                answers[-1] |= {"verified": True, "message": f"{name} changes"}
        return answers

    def filters(self, requests: Iterable[Mapping[str, Any]]) -> list[dict[str, Any]]:
        """Set the filters that also stop the run.

        Each has a `filterId`, and optionally a `condition`: the commands to which it applies.
        """
        self._filters = {}
        answers: list[dict[str, Any]] = []
        for requested in requests:
            name, condition = str(requested.get("filterId")), str(requested.get("condition") or "")
            if name not in {known["filter"] for known in FILTERS}:
                answers.append({"verified": False, "message": f"there is no filter `{name}`"})
                continue
            try:
                self._filters[name] = self._targets.forbidding(condition) if name == FORBIDDEN else []
                answers.append({"verified": True})
            except NamingError as error:
                answers.append({"verified": False, "message": str(error)})
        self._watch()
        return answers

    def lines(self, path: str) -> list[int]:
        """Return the lines of a file at which a run can stop."""
        return sorted(self._script_lines) if real(path) == self._script else self._targets.lines(path)

    def _answer(self, targets: Sequence[Target], fault: str) -> dict[str, Any]:
        self._numbered += 1
        message = "; ".join(dict.fromkeys(target.what for target in targets)) if targets else fault
        return {"id": self._numbered, "verified": bool(targets), "message": message}

    def _watch(self) -> None:
        points = [*self._in_files, *self._by_name]
        targets = [target for point in points for target in point.targets]
        targets += [target for filter_targets in self._filters.values() for target in filter_targets]
        self._watcher.watch({event for target in targets for event in target.events})
