"""Places at which a run can stop: elements of the text by line, events by name, values."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

from robosc.analysis.explain import NamingError, find_event
from robosc.analysis.wording import name, words
from robosc.engine import Blocked
from robosc.model import sct
from robosc.model.places import place
from robosc.model.semantics.communication import ANSWERS
from robosc.model.semantics.edges import edges_of
from robosc.model.semantics.roles import event_name

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.base.diagnostics import Span
    from robosc.run.simulation.replay import Moment, Replay

#: For each event: the reason that it is blocked, and the requirements on it that fail.
_Seen: TypeAlias = dict[str, "tuple[Blocked | None, tuple[sct.Requirement, ...]]"]
#: Reasons by which the supervisor, not the robot, blocks an event.
_SUPERVISOR = (Blocked.REQUIREMENT, Blocked.SYNTHESIS)
#: Prefixes of the name of a function breakpoint.
_FORBIDDEN, _ALLOWED = "forbidden ", "allowed "


class Watcher:
    """Compares, before and after the last step, which events the supervisor forbids and by which requirements."""

    def __init__(self, replay: Replay) -> None:
        self._replay = replay
        self._events: set[str] = set()
        self._before: _Seen = {}
        self._now: _Seen = {}

    def look(self) -> None:
        """Read the present state, after moving the previous reading to the state before."""
        engine = self._replay.engine
        self._before = self._now
        self._now = {
            event: (engine.blocked_by(event), tuple(engine.failing_requirements(event))) for event in self._events
        }

    def watch(self, events: set[str]) -> None:
        """Watch these events from now on."""
        self._events = events
        self.look()
        self._before = self._now

    def forbidden(self, event: str) -> bool:
        """Return whether the supervisor has begun to forbid an event.

        Before the step, the supervisor allowed the event, or the robot was not ready for it.
        """
        return self._now[event][0] in _SUPERVISOR and self._before[event][0] not in _SUPERVISOR

    def allowed(self, event: str) -> bool:
        """Return whether an event has become possible."""
        return self._now[event][0] is None and self._before[event][0] is not None

    def fails(self, requirement: sct.Requirement) -> bool:
        """Return whether a requirement has begun to forbid its event."""
        event = event_name(requirement.event)
        return requirement in self._now[event][1] and requirement not in self._before[event][1]


#: Returns whether the last step is one to stop at.
_Hit = Callable[["Moment", Watcher], bool]


@dataclass(frozen=True)
class Target:
    """A place to stop: its description, its span, the test of a step (`hit`), and the events to watch for it."""

    what: str
    span: Span | None
    hit: _Hit
    events: frozenset[str] = frozenset()


class Targets:
    """All targets of a model at which a run can stop."""

    def __init__(self, replay: Replay) -> None:
        self._replay = replay
        self.model = replay.engine.model
        self._by_file: dict[str, list[Target]] = {}
        for element, target in self._all():
            file, span = place(element)
            if getattr(element, "source", None) is not None:
                self._by_file.setdefault(real(file), []).append(Target(target.what, span, target.hit, target.events))

    def at(self, file: str, line: int) -> list[Target]:
        """Return the targets in a line, from the inside outwards.

        These are the targets that begin in the line, else those that span it and begin last.
        """
        targets = [target for target in self._by_file.get(real(file), ()) if target.span is not None]
        begun = [target for target in targets if target.span is not None and target.span.line == line]
        if begun:
            return begun
        around = [target for target in targets if target.span and target.span.line <= line <= target.span.end_line]
        if not around:
            return []
        innermost = max((target.span.line, target.span.column) for target in around if target.span)
        return [target for target in around if target.span and (target.span.line, target.span.column) == innermost]

    def lines(self, file: str) -> list[int]:
        """Return the lines of a file in which a target begins."""
        return sorted({target.span.line for target in self._by_file.get(real(file), ()) if target.span is not None})

    def targets_of(self, text: str) -> list[Target]:
        """Return the targets of `move`, `forbidden move`, `allowed move`, or a requirement.

        Raises NamingError.
        """
        for prefix, make in ((_FORBIDDEN, self._becomes_forbidden), (_ALLOWED, self._becomes_allowed)):
            if text.startswith(prefix):
                return [make(find_event(self.model, text.removeprefix(prefix).strip()))]
        named = [requirement for requirement in self.model.requirements if requirement.name == text]
        if named:
            return [self._requirement(requirement) for requirement in named]
        try:
            return [self._event(find_event(self.model, text))]
        except NamingError as error:
            plants = [plant for plant in self.model.plants if text in (name(plant), plant.name)]
            if plants:
                return [self._any_state(plant) for plant in plants]
            raise NamingError(str(error), "") from None

    def forbidding(self, text: str = "") -> list[Target]:
        """Return targets for commands that become forbidden: those in a comma-separated list, or any.

        Raises NamingError.
        """
        if text.strip():
            return [self._becomes_forbidden(find_event(self.model, name.strip())) for name in text.split(",")]
        kinds = (sct.EventKind.trigger, sct.EventKind.plain, *ANSWERS)
        events = [event for plant in self.model.plants for event in plant.events]
        return [self._becomes_forbidden(event) for event in events if event.controllable and event.kind in kinds]

    def _all(self) -> Iterator[tuple[Any, Target]]:
        for plant in self.model.plants:
            for edge in edges_of(plant):
                yield edge, self._edge(edge)
            if plant.kind in (sct.PlantKind.behaviour, sct.PlantKind.requirement):
                yield plant, self._any_state(plant)
                for location in plant.locations:
                    yield location, self._location(plant, location)
            for event in plant.events:
                yield event, self._event(event)
        for requirement in self.model.requirements:
            yield requirement, self._requirement(requirement)

    def _edge(self, edge: sct.Edge) -> Target:
        return Target(f"the {words(edge.event)} is taken here", None, lambda moment, _: edge in moment.edges)

    def _location(self, plant: sct.Plant, location: sct.Location) -> Target:
        def entered(moment: Moment, _: Watcher) -> bool:
            before, after = (state.get(plant.name) for state in (moment.before, moment.after))
            return before != after and after == location.name

        return Target(f"`{name(plant)}` enters `{location.name}`", None, entered)

    @staticmethod
    def _any_state(plant: sct.Plant) -> Target:
        return Target(
            f"`{name(plant)}` enters another state",
            None,
            lambda moment, _: moment.before.get(plant.name) != moment.after.get(plant.name),
        )

    @staticmethod
    def _event(event: sct.Event) -> Target:
        target_name = event_name(event)
        return Target(words(event), None, lambda moment, _: moment.happened and moment.event == target_name)

    @staticmethod
    def _requirement(requirement: sct.Requirement) -> Target:
        event = event_name(requirement.event)
        text = requirement.text or requirement.name or "a requirement"
        what = f"`{text}` begins to forbid the {words(requirement.event)}"
        return Target(what, None, lambda _, watcher: watcher.fails(requirement), frozenset([event]))

    @staticmethod
    def _becomes_forbidden(event: sct.Event) -> Target:
        target_name = event_name(event)
        what = f"the {words(event)} becomes forbidden"
        return Target(what, None, lambda _, watcher: watcher.forbidden(target_name), frozenset([target_name]))

    @staticmethod
    def _becomes_allowed(event: sct.Event) -> Target:
        target_name = event_name(event)
        what = f"the {words(event)} becomes possible"
        return Target(what, None, lambda _, watcher: watcher.allowed(target_name), frozenset([target_name]))


def real(file: str) -> str:
    """Return a canonical path, equal for all paths of the same file."""
    try:
        return os.path.normcase(os.path.realpath(file))
    except ValueError:  # A null character, which no path has.
        return file
