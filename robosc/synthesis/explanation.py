"""Why there is no supervisor."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from robosc.semantics.roles import event_name
from robosc.synthesis.decoding import Value, value
from robosc.synthesis.fixpoint import reachable
from robosc.synthesis.paths import Path, TraceStep, shortest_path, trace

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from robosc.metamodel import sct
    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Element, Encoding
    from robosc.synthesis.fixpoint import SupervisedStates
    from robosc.synthesis.paths import Move
    from robosc.synthesis.relation import EventRelation

#: How many plants a sentence names.
_NAMED = 4


@dataclass(frozen=True)
class Reason:
    """Why a supervisor is empty.

    `message` says it in a sentence. `event` is at fault: an uncontrollable event that no supervisor can prevent, or a
    controllable one whose requirement stands between the robot and its marked states; None where the plants alone reach
    no marked state. `unmarked` are the plants that can't be in a marked location any more once the event happened, or
    at all; none if each can be but never all at once. `trace` is a shortest one from the initial state, the event
    last; `state` is where it ends, before an event that a requirement forbids: the location of every plant with several
    of them, and the value of every variable. `codes` are those of that state. `requirements` forbid the event at fault
    there, or else something from there on.
    """

    message: str
    event: sct.Event | None
    unmarked: tuple[sct.Plant, ...]
    trace: tuple[TraceStep, ...]
    state: Mapping[str, Value]
    codes: Mapping[Element, int] = field(repr=False)
    requirements: tuple[sct.Requirement, ...] = ()


class EmptySupervisor:
    """Finds the reason in what the fixpoint left behind."""

    def __init__(
        self, encoding: Encoding, moves: Sequence[Move], plant_moves: Sequence[Move], found: SupervisedStates
    ) -> None:
        """`moves` are all events under the requirements, `plant_moves` without them."""
        self._encoding = encoding
        self._moves = moves
        self._plant_moves = plant_moves
        self._found = found

    def reason(self) -> Reason:
        """What keeps the initial state from being controlled."""
        blocked = not (self._encoding.initial & self._found.alive[0]).satisfiable()
        return self._blocked_from_the_start() if blocked else self._uncontrollable()

    def _uncontrollable(self) -> Reason:
        slide = unavoidable(self._encoding, self._moves, self._found, self._encoding.initial_codes)
        before = self._encoding.state(slide.states[-2])
        uncontrollable = [each for each in self._moves if not each[0].event.controllable]
        everything = self._encoding.diagrams.true
        blocked = self._found.rounds[0] & ~self._found.alive[0]
        first = self._path(self._moves, self._encoding.initial, before, everything)
        last = self._path(uncontrollable, before, blocked, everything)
        event = last.moves[0][0].event
        unmarked = never_marked(self._encoding, self._moves, last.states[-1])
        reason = self._described(
            f"{event_name(event)} can't be prevented, and after it no marked state can be reached",
            event,
            unmarked,
            trace(self._encoding, first) + trace(self._encoding, last),
            last.states[-1],
        )
        relations = [each for each, _ in self._plant_moves]
        at_fault = forbidden_from(self._encoding, self._moves, relations, last.states[-1])
        return replace(reason, requirements=tuple(at_fault))

    def _blocked_from_the_start(self) -> Reason:
        path = shortest_path(
            self._encoding,
            self._plant_moves,
            self._encoding.initial,
            self._encoding.all_marked,
            self._encoding.diagrams.true,
        )
        unmarked = never_marked(self._encoding, self._moves, self._encoding.initial_codes)
        problem = "no marked state can be reached"
        if path is None:
            return self._described(f"{problem} at all", None, unmarked, [], self._encoding.initial_codes)
        steps = trace(self._encoding, path)
        for index, ((relation, _), state) in enumerate(zip(path.moves, path.states, strict=False)):
            here = self._encoding.state(state)
            if not (here & relation.requirement).satisfiable():
                reason = self._described(
                    f"{problem}: the shortest way to one needs {event_name(relation.event)} where its requirement"
                    " forbids it",
                    relation.event,
                    unmarked,
                    steps[: index + 1],
                    path.states[index],
                )
                at_fault = [each for each, asked in relation.asked.items() if not (here & asked).satisfiable()]
                return replace(reason, requirements=tuple(at_fault))
        raise AssertionError("the requirements forbid nothing on the way")

    def _path(self, moves: Sequence[Move], start: Diagram, goal: Diagram, within: Diagram) -> Path:
        path = shortest_path(self._encoding, moves, start, goal, within)
        assert path is not None
        return path

    def _described(
        self,
        problem: str,
        event: sct.Event | None,
        unmarked: Sequence[sct.Plant],
        steps: Sequence[TraceStep],
        codes: Mapping[Element, int],
    ) -> Reason:
        """The reason with its sentence completed by who is in the way, and the state by name."""
        named = [
            f"{plant.name} (in {plant.locations[codes[plant]].name})" if len(plant.locations) > 1 else plant.name
            for plant in unmarked[:_NAMED]
        ]
        if len(unmarked) > _NAMED:
            named.append(f"and {len(unmarked) - _NAMED} more")
        who = "each plant can be marked, but never all at once"
        if named:
            who = f"never in a marked location: {', '.join(named)}"
        state: dict[str, Value] = {}
        for plant in self._encoding.layout.plants:
            if len(plant.locations) > 1:
                state[plant.name] = value(plant, codes[plant])
            for variable in plant.variables:
                state[f"{plant.name}.{variable.name}"] = value(variable, codes[variable])
        return Reason(f"{problem}; {who}", event, tuple(unmarked), tuple(steps), state, codes)


def forbidden_from(
    encoding: Encoding, moves: Sequence[Move], relations: Iterable[EventRelation], codes: Mapping[Element, int]
) -> list[sct.Requirement]:
    """The requirements that forbid something which the plants would do from a state on, in the order of the events."""
    steps = [step for _, step in moves]
    onwards = reachable(encoding.diagrams, steps, encoding.state(codes), encoding.diagrams.true)
    return [
        requirement
        for relation in relations
        for requirement, asked in relation.asked.items()
        if (onwards & relation.enabled & ~asked).satisfiable()
    ]


def unavoidable(
    encoding: Encoding, moves: Sequence[Move], found: SupervisedStates, start: Mapping[Element, int]
) -> Path:
    """A way from a state that was given up to where no marked state can be reached, because of what nothing prevents.

    Round by round, backwards: uncontrollable events lead from the state to one that, without the states given up in
    earlier rounds, reaches no marked state; its nearest way there leads through one of those, and so on. So the last
    event is uncontrollable; there is none where already the start reaches no marked state.
    """
    uncontrollable = [each for each in moves if not each[0].event.controllable]
    rounds, alive = found.rounds, found.alive
    index = max(each for each, good in enumerate(rounds) if (encoding.state(start) & good).satisfiable())
    whole = Path([dict(start)], [])

    def go(possible: Sequence[Move], goal: Diagram, within: Diagram) -> None:
        part = shortest_path(encoding, possible, encoding.state(whole.states[-1]), goal, within)
        assert part is not None
        whole.states.extend(part.states[1:])
        whole.moves.extend(part.moves)

    go(uncontrollable, rounds[index] & ~alive[index], rounds[index])
    for earlier in reversed(range(index)):
        go(moves, alive[earlier] & ~rounds[earlier + 1], alive[earlier])
        go(uncontrollable, rounds[earlier] & ~alive[earlier], rounds[earlier])
    return whole


def never_marked(encoding: Encoding, moves: Sequence[Move], codes: Mapping[Element, int]) -> list[sct.Plant]:
    """The plants that are in no marked location in any state that can follow the given one."""
    steps = [step for _, step in moves]
    states = reachable(encoding.diagrams, steps, encoding.state(codes), encoding.diagrams.true)
    return [each for each in encoding.layout.plants if not (states & encoding.marked(each)).satisfiable()]
