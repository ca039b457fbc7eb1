"""Answers as text for users; `at` returns the place of an element: `file:line:column`."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

from robosc.analysis.blocking_in_words import counterexample_in_words, describe_blocking, way_out
from robosc.analysis.explain.answers import Emptiness, Explanation, Possibility, Reach
from robosc.analysis.system import format_count
from robosc.analysis.wording import in_words, join_with_and, name, what_is, words
from robosc.engine import Blocked
from robosc.model import sct
from robosc.model.semantics.roles import Roles, event_name
from robosc.synthesis.decoding import value

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator
    from typing import Any

    from robosc.analysis.explain.answers import Answer, Loosening, Note, Situation
    from robosc.analysis.paths import TraceStep
    from robosc.synthesis.encoding import Element

    At: TypeAlias = Callable[[Any], str]

_BY = {
    Blocked.PLANT: "the robot is not ready for it",
    Blocked.ASSUMPTION: "an assumption excludes it",
    Blocked.REQUIREMENT: "its requirements forbid it",
    Blocked.SYNTHESIS: "no requirement forbids it, but synthesis does, because of what could follow",
}
#: Plants of the communications that components send, call and start.
_COMMUNICATIONS = {sct.PlantKind.message, sct.PlantKind.service, sct.PlantKind.action}
#: For a supervisor from another tool.
NEEDLESS = "only this supervisor forbids it; the robot, the requirements and synthesis allow it"
_ELSE = "Without requirements, it does after"


def _because(explanation: Explanation) -> str:
    return NEEDLESS if explanation.needless else _BY[explanation.by] if explanation.by else ""


class Renderer:
    """Text renderer for answers about one model."""

    def __init__(self, model: sct.SupervisoryControlModel, at: At) -> None:
        self._model = model
        self._at = at
        self._events = {event_name(event): event for event in Roles(model).events}

    def answer(self, answer: Answer | None) -> str:
        """Return the text of an answer, without a line end; None is the answer for a nonempty supervisor."""
        match answer:
            case Explanation():
                lines = self._explained(answer)
            case Possibility():
                lines = self._possible(answer)
            case Emptiness():
                lines = self._empty(answer)
            case None:
                return "The supervisor is not empty."
        return "\n".join(lines)

    # An event in a state

    def _explained(self, explanation: Explanation) -> Iterator[str]:
        event = words(explanation.event)
        if explanation.allowed:
            limits = ", with some data" if explanation.data else ""
            limits = limits if explanation.event.controllable else ", and nothing prevents it"
            yield f"The {event} can happen here{limits}."
        elif explanation.by is None:
            allows = f"Neither the robot nor a requirement forbids the {event} here"
            yield f"{allows}, but the robot never reaches this state."
        else:
            yield f"The {event} cannot happen here: {_because(explanation)}."
        yield from self._situation(explanation.situation)
        yield from self._refused(explanation.refusal)
        yield from self._obstacles(explanation)
        if explanation.data:
            yield from self._section("Requirements on its data:", self._notes(explanation.data))
        if explanation.changes:
            yield from self._section("Events that make it possible at once:", self._notes(explanation.changes))
        if explanation.situation.reach is Reach.SUPERVISED and not explanation.allowed:
            yield from self._way(explanation)

    def _situation(self, situation: Situation) -> Iterator[str]:
        yield ""
        trace = self._steps(situation.trace)
        if situation.reach is Reach.NEVER:
            yield "The robot never reaches this state, with or without requirements:"
        elif situation.reach is Reach.UNSUPERVISED:
            yield f"The supervised robot never reaches this state. {_ELSE} {trace}:"
        else:
            yield f"The state after {trace}:" if trace else "The initial state:"
        yield from self._state(situation)

    def _state(self, situation: Situation) -> Iterator[str]:
        """Yield the state: components and requirement automata first, idle services and actions last in one line."""
        others, idle = [], []
        for plant in self._model.plants:
            if plant.kind == sct.PlantKind.data:
                continue
            elements: list[Element] = [plant] if len(plant.locations) > 1 else []
            elements += plant.variables
            values = [what_is(element, value(element, situation.codes[element])) for element in elements]
            if plant.kind not in _COMMUNICATIONS:
                yield from [f"  {join_with_and(values)}"] if values else []
            elif elements == [plant] and plant.locations[situation.codes[plant]].initial:
                idle.append((str(plant.locations[situation.codes[plant]].name), f"`{name(plant)}`"))
            elif values:
                others.append(f"  {join_with_and(values)}")
        yield from others
        for location in dict.fromkeys(location for location, _ in idle):
            names = [plant for where, plant in idle if where == location]
            yield f"  {join_with_and(names)} {'is' if len(names) == 1 else 'are'} in `{location}`"

    def _refused(self, refusal: Explanation | None) -> Iterator[str]:
        if refusal is None:
            return
        after = self._steps(refusal.situation.trace)
        because = _because(refusal)
        yield from [
            "",
            f"On this way the {words(refusal.event)} cannot happen{f' after {after}' if after else ''}: {because}.",
        ]
        yield from self._obstacles(refusal)

    def _obstacles(self, explanation: Explanation) -> Iterator[str]:
        if explanation.plants:
            yield from self._section("The robot:", self._notes(explanation.plants))
        if explanation.requirements:
            yield from self._section("Requirements:", self._notes(explanation.requirements))
        if explanation.counterexample:
            lines = [
                f"{self._at(explanation.event)}: {counterexample_in_words(explanation.counterexample, self._model)}"
            ]
            if explanation.counterexample.onwards:
                last = self._events[explanation.counterexample.onwards[-1].event]
                lines.append(f"{self._at(last)}: synthesis guards against the {words(last)}")
            for plant in explanation.counterexample.unmarked:
                here = plant.locations[explanation.counterexample.codes[plant]]
                lines.append(f"{self._at(here)}: `{name(plant)}` is then in `{here.name}`")
            yield from self._section("If it happened here:", lines)
            if explanation.blamed:
                notes = self._notes(explanation.blamed)
                yield from self._section("Requirements that forbid events from there on:", notes)
            yield from ["", f"To allow it, {way_out(explanation.counterexample)}."]

    def _way(self, explanation: Explanation) -> Iterator[str]:
        yield ""
        if explanation.way is None:
            yield "From here, the robot reaches no state where it can happen."
        else:
            yield f"A shortest way to a state where it can happen: {self._steps(explanation.way)}."

    # An event that may never happen

    def _possible(self, possibility: Possibility) -> Iterator[str]:
        event, nearest = words(possibility.event), possibility.nearest
        if possibility.possible and nearest:
            after = self._steps(nearest.situation.trace)
            yield f"The {event} can happen{f', first after {after}' if after else ' from the start'}."
            yield from self._situation(nearest.situation)
            return
        yield f"The {event} can never happen."
        if nearest is None:
            yield from self._section(
                "The robot is never ready for it, with or without requirements:", self._notes(possibility.plants)
            )
            return
        yield from ["", *self._nearest(nearest)]
        if possibility.beyond:
            after = self._steps(possibility.beyond.situation.trace)
            yield from ["", f"The supervised robot reaches no state where they allow it. {_ELSE} {after}:"]
            yield from self._state(possibility.beyond.situation)
            yield from self._refused(possibility.beyond.refusal)
        elif possibility.conflict:
            all_of = "This allows it in" if len(possibility.conflict) == 1 else "Together, these allow it in"
            yield from self._section(f"{all_of} no state that the robot can reach:", self._notes(possibility.conflict))
        if not nearest.needless:
            yield from self._loosened(possibility.loosenings)

    def _nearest(self, nearest: Explanation) -> Iterator[str]:
        after = self._steps(nearest.situation.trace)
        where = f"after {after}" if after else "the initial one"
        if nearest.situation.reach is Reach.UNSUPERVISED:
            yield f"The supervised robot reaches no state where it is ready for it. {_ELSE} {after}:"
        elif nearest.needless:
            yield f"The nearest state where {NEEDLESS}, {where}:"
        elif nearest.by is Blocked.SYNTHESIS:
            yield f"The nearest state where neither the robot nor a requirement forbids it, {where}:"
        else:
            yield f"The nearest state where the robot is ready for it, {where}:"
        yield from self._state(nearest.situation)
        yield from self._refused(nearest.refusal)
        yield from self._obstacles(nearest)

    # No supervisor

    def _empty(self, emptiness: Emptiness) -> Iterator[str]:
        yield f"The supervisor is empty: {describe_blocking(emptiness.reason)}."
        if emptiness.reason.trace:
            steps = [
                f"{self._at(self._events[step.event])}: {in_words([step], self._model)}"
                for step in emptiness.reason.trace
            ]
            yield from self._section("A shortest trace:", steps)
        if emptiness.stuck:
            yield from self._section("The state at its end:", self._notes(emptiness.stuck))
        if emptiness.blamed:
            yield from self._section("Requirements that forbid events from there on:", self._notes(emptiness.blamed))
        yield from self._loosened(emptiness.loosenings)

    # Shared parts

    def _loosened(self, loosenings: tuple[Loosening, ...] | None) -> Iterator[str]:
        if loosenings is None:
            yield from ["", "Without requirements, the result is the same: change the components."]
        elif not loosenings:
            yield from ["", "Removing one requirement is not enough; removing all of them is."]
        else:
            lines = []
            for loosening in loosenings:
                first = loosening.requirements[0]
                text = join_with_and(list(dict.fromkeys(own.text or "a requirement" for own in loosening.requirements)))
                lines.append(f"{self._at(first)}: {text} ({format_count(loosening.states, 'state')} without it)")
            yield from self._section("Loosen or remove one of these:", lines)

    def _notes(self, notes: Iterable[Note]) -> Iterator[str]:
        for note in notes:
            yield f"{self._at(note.element)}: {note.text}"
            yield from (f"  {detail}" for detail in note.details)

    @staticmethod
    def _section(heading: str, lines: Iterable[str]) -> Iterator[str]:
        yield from ["", heading]
        yield from (f"  {line}" for line in lines)

    def _steps(self, steps: Iterable[TraceStep]) -> str:
        return in_words(list(steps), self._model)
