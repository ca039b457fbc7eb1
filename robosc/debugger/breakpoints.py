"""Where a run stops: at transitions, states, requirements and communications by line, at events by name, at values."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

from robosc.analysis.explain import NamingError, event_named
from robosc.analysis.wording import name, words
from robosc.engine import Blocked
from robosc.metamodel import sct
from robosc.metamodel.places import place
from robosc.semantics.edges import edges_of
from robosc.semantics.roles import event_name

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.diagnostics import Span
    from robosc.simulation.replay import Moment, Replay

#: Of events: what keeps each from happening, and which requirements on it fail.
_Seen: TypeAlias = dict[str, "tuple[Blocked | None, tuple[sct.Requirement, ...]]"]
#: What forbids a command that the robot is ready for.
_SUPERVISOR = (Blocked.REQUIREMENT, Blocked.SYNTHESIS)
#: What a name of a function breakpoint may begin with.
_FORBIDDEN, _ALLOWED = "forbidden ", "allowed "


class Watcher:
    """Which events the supervisor forbids, and which requirements do so: before the last step and after it."""

    def __init__(self, replay: Replay) -> None:
        self._replay = replay
        self._events: set[str] = set()
        self._before: _Seen = {}
        self._now: _Seen = {}

    def look(self) -> None:
        """Looks at the present state; what was seen last is what was before."""
        engine = self._replay.engine
        self._before = self._now
        self._now = {event: (engine.blocked_by(event), tuple(engine.failing(event))) for event in self._events}

    def watch(self, events: set[str]) -> None:
        """From now on these events are looked at."""
        self._events = events
        self.look()
        self._before = self._now

    def forbidden(self, event: str) -> bool:
        """Whether the supervisor forbids an event that it allowed, or that the robot was not ready for, before."""
        return self._now[event][0] in _SUPERVISOR and self._before[event][0] not in _SUPERVISOR

    def allowed(self, event: str) -> bool:
        """Whether an event can happen that could not before."""
        return self._now[event][0] is None and self._before[event][0] is not None

    def fails(self, requirement: sct.Requirement) -> bool:
        """Whether a requirement forbids its event, and did not before."""
        event = event_name(requirement.event)
        return requirement in self._now[event][1] and requirement not in self._before[event][1]


#: Whether a step that was just made is one to stop at.
_Hit = Callable[["Moment", Watcher], bool]


@dataclass(frozen=True)
class Target:
    """Something to stop at: in words, where it stands, and when it is hit; `events` are those to be watched for it."""

    what: str
    span: Span | None
    hit: _Hit
    events: frozenset[str] = frozenset()


class Targets:
    """What of a model a run can stop at."""

    def __init__(self, replay: Replay) -> None:
        self._replay = replay
        self.model = replay.engine.model
        self._by_file: dict[str, list[Target]] = {}
        for element, target in self._all():
            file, span = place(element)
            if getattr(element, "source", None) is not None:
                self._by_file.setdefault(real(file), []).append(Target(target.what, span, target.hit, target.events))

    def at(self, file: str, line: int) -> list[Target]:
        """What stands in a line: what begins there, else the innermost around it; from the text's inside outwards."""
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
        """The lines of a file in which something begins."""
        return sorted({target.span.line for target in self._by_file.get(real(file), ()) if target.span is not None})

    def named(self, text: str) -> list[Target]:
        """What a name stands for: `move`, `forbidden move`, `allowed move`, or a requirement. Raises NamingError."""
        for prefix, make in ((_FORBIDDEN, self._becomes_forbidden), (_ALLOWED, self._becomes_allowed)):
            if text.startswith(prefix):
                return [make(event_named(self.model, text.removeprefix(prefix).strip()))]
        named = [requirement for requirement in self.model.requirements if requirement.name == text]
        if named:
            return [self._requirement(requirement) for requirement in named]
        try:
            return [self._event(event_named(self.model, text))]
        except NamingError as error:
            plants = [plant for plant in self.model.plants if text in (name(plant), plant.name)]
            if plants:
                return [self._any_state(plant) for plant in plants]
            raise NamingError(str(error), "") from None

    def forbidding(self, text: str = "") -> list[Target]:
        """That a command becomes forbidden: those named, with commas between, or any. Raises NamingError."""
        if text.strip():
            return [self._becomes_forbidden(event_named(self.model, name.strip())) for name in text.split(",")]
        kinds = (sct.EventKind.trigger, sct.EventKind.plain)
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
        wanted = event_name(event)
        return Target(words(event), None, lambda moment, _: moment.happened and moment.event == wanted)

    @staticmethod
    def _requirement(requirement: sct.Requirement) -> Target:
        event = event_name(requirement.event)
        told = requirement.text or requirement.name or "a requirement"
        what = f"`{told}` begins to forbid the {words(requirement.event)}"
        return Target(what, None, lambda _, watcher: watcher.fails(requirement), frozenset([event]))

    @staticmethod
    def _becomes_forbidden(event: sct.Event) -> Target:
        wanted = event_name(event)
        what = f"the {words(event)} becomes forbidden"
        return Target(what, None, lambda _, watcher: watcher.forbidden(wanted), frozenset([wanted]))

    @staticmethod
    def _becomes_allowed(event: sct.Event) -> Target:
        wanted = event_name(event)
        what = f"the {words(event)} becomes possible"
        return Target(what, None, lambda _, watcher: watcher.allowed(wanted), frozenset([wanted]))


def real(file: str) -> str:
    """The same name for a file, by whatever path it is named."""
    try:
        return os.path.normcase(os.path.realpath(file))
    except ValueError:  # a null character: no file has that name
        return file
