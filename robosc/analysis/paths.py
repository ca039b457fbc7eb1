"""Shortest paths through the state space, event by event."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from robosc.model.semantics.roles import event_name
from robosc.synthesis.decoding import Value, text, value
from robosc.synthesis.encoding import pick

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from robosc.model import sct
    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Element, Encoding
    from robosc.synthesis.relation import EventRelation, SymbolicStep

    Move = tuple[EventRelation, SymbolicStep]


@dataclass(frozen=True)
class TraceStep:
    """One event of a trace: its name, with its plant, and the values of the inputs that its effect depends on."""

    event: str
    inputs: Mapping[str, Value] = field(default_factory=dict)

    def __str__(self) -> str:
        """Return the event as text, such as `message_level.u_response(i_response = 3)`."""
        values = ", ".join(f"{name} = {text(chosen)}" for name, chosen in self.inputs.items())
        return f"{self.event}({values})" if values else self.event


def trace_data(steps: Iterable[TraceStep]) -> list[dict[str, Any]]:
    """Return a trace as JSON data: events with their inputs."""
    return [{"event": step.event, "inputs": dict(step.inputs)} for step in steps]


@dataclass(frozen=True)
class Path:
    """A path: its states, both ends included, and the events between them."""

    states: list[dict[Element, int]]
    moves: list[Move]


class Layers:
    """States that moves reach from a start, by the least number of steps, computed on demand."""

    def __init__(self, encoding: Encoding, moves: Sequence[Move], start: Diagram, within: Diagram) -> None:
        """Begin at `start`; a path stays `within` until it is at its goal."""
        self._encoding = encoding
        self._moves = moves
        self._within = within
        self._layers = [start]
        self._seen = start
        self._effort = 0

    @property
    def seen(self) -> Diagram:
        """The states of all layers computed so far."""
        return self._seen

    def path_to(self, goal: Diagram, effort: int | None = None) -> Path | None:
        """Return a shortest path to a state of `goal`; None if there is none or the effort is exceeded.

        The effort counts the nodes that every move visits. The choice among several paths is fixed: by the order
        of the moves, then by the codes of the states.
        """
        steps = 0
        while not (self._layers[steps] & goal).satisfiable():
            steps += 1
            if steps == len(self._layers) and not self._grow(effort):
                return None
        return self._back(steps, goal)

    def _grow(self, most: int | None) -> bool:
        effort = self._effort + self._layers[-1].node_count() * len(self._moves)
        if most is not None and effort > most:
            return False
        self._effort = effort
        reached = self._encoding.diagrams.false
        for _, step in self._moves:
            reached |= step.image(self._layers[-1] & self._within)
            self._encoding.diagrams.tidy()
        reached &= ~self._seen
        if not reached.satisfiable():
            return False
        self._layers.append(reached)
        self._seen |= reached
        return True

    def _back(self, steps: int, goal: Diagram) -> Path:
        state = pick(self._layers[steps] & goal, self._encoding.layout.state)
        states, taken = [state], []
        for layer in reversed(self._layers[:steps]):
            here = self._encoding.state(state)
            allowed = layer & self._within
            move, before = next(
                (move, before)
                for move in self._moves
                if move[0].may_lead_to(state) and (before := move[1].preimage(here) & allowed).satisfiable()
            )
            state = pick(before, self._encoding.layout.state)
            states.append(state)
            taken.append(move)
        return Path(states[::-1], taken[::-1])


def shortest_path(
    encoding: Encoding, moves: Sequence[Move], start: Diagram, goal: Diagram, within: Diagram
) -> Path | None:
    """Return a shortest path from a state of `start` to one of `goal`, as `Layers` computes it."""
    return Layers(encoding, moves, start, within).path_to(goal)


def deciding(moves: Sequence[Move], elements: Iterable[Element]) -> list[Move]:
    """Return the moves that influence the elements: those that change them or an element they depend on."""
    changing: dict[Element, list[int]] = {}
    for number, (relation, _) in enumerate(moves):
        for element in relation.changed:
            changing.setdefault(element, []).append(number)
    influencing: set[int] = set()
    pending = list(elements)
    while pending:
        added = set(changing.pop(pending.pop(), ())) - influencing
        influencing |= added
        pending += (element for number in added for element in moves[number][0].concerned)
    return [moves[number] for number in sorted(influencing)]


def trace(encoding: Encoding, path: Path, permitted: Callable[[sct.Event], Diagram] | None = None) -> list[TraceStep]:
    """Return the events of a path with the input values that take it.

    `permitted` returns the states and inputs in which a command is permitted. Its inputs are among these, unless the
    path is not permitted.
    """
    return [
        TraceStep(event_name(relation.event), _inputs(encoding, relation, before, after, permitted))
        for (relation, _), before, after in zip(path.moves, path.states[:-1], path.states[1:], strict=True)
    ]


def _inputs(
    encoding: Encoding,
    relation: EventRelation,
    before: Mapping[Element, int],
    after: Mapping[Element, int],
    permitted: Callable[[sct.Event], Diagram] | None,
) -> dict[str, Value]:
    """Return input values that lead from one state to the next, without inputs that do not matter."""
    if not relation.event.inputs:
        return {}
    fitting = relation.between(before, after)
    if permitted is not None and relation.has_data:
        restricted = relation.between(before, after, permitted(relation.event))
        fitting = restricted if restricted.satisfiable() else fitting
    chosen = {}
    for parameter in relation.event.inputs:
        domain = encoding.layout.domains[parameter]
        anything = fitting.exists(encoding.diagrams.cube(domain.levels)) & encoding.in_domain(parameter)
        if anything != fitting:
            code = pick(fitting, [domain])[parameter]
            chosen[parameter.name] = value(parameter, code)
            fitting &= encoding.has_code(parameter, code)
    return chosen
