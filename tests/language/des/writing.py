"""Systems of automata with variables, their files in each format, and their synthesis by the definition.

A guard or a value is a pair of its Python text and its elements in a `.wmod` file.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Iterator

#: The state of each automaton, and the value of each variable.
State: TypeAlias = "tuple[tuple[str, ...], tuple[int, ...]]"
_OPERATORS = {"and": "&amp;", "<": "&lt;", "<=": "&lt;=", ">": "&gt;", ">=": "&gt;=", "==": "==", "+": "+", "-": "-"}


@dataclass
class Edge:
    """An edge; `guard` is Python text of the form `left operator right`, `updates` such text by variable."""

    source: str
    event: str
    target: str
    guard: str = ""
    updates: dict[str, str] = field(default_factory=dict)


@dataclass
class Automaton:
    """An automaton; the first state is initial. `alphabet` is the events of the edges if it is None."""

    name: str
    requirement: bool
    states: list[str]
    marked: list[str]
    edges: list[Edge]
    forbidden: list[str] = field(default_factory=list)

    @property
    def alphabet(self) -> list[str]:
        """The events of the edges."""
        return list(dict.fromkeys(edge.event for edge in self.edges))


@dataclass
class System:
    """A system: its events with their controllability, its automata, and the last value of each variable from 0."""

    events: dict[str, bool]
    automata: list[Automaton]
    variables: dict[str, int] = field(default_factory=dict)

    # Files

    def gen(self, automaton: Automaton) -> str:
        """Return the file of an automaton for libFAUDES."""
        events = (f'"{event}"{" +C+" if self.events[event] else ""}' for event in automaton.alphabet)
        sections = {
            "Alphabet": events,
            "States": (f'"{state}"' for state in automaton.states),
            "TransRel": (f'"{edge.source}" "{edge.event}" "{edge.target}"' for edge in automaton.edges),
            "InitStates": [f'"{automaton.states[0]}"'],
            "MarkedStates": (f'"{state}"' for state in automaton.marked),
        }
        body = "".join(f"<{name}>\n" + "\n".join(lines) + f"\n</{name}>\n" for name, lines in sections.items())
        return f'% {automaton.name}\n<Generator>\n"{automaton.name}"\n{body}</Generator>\n'

    def xmd(self, automaton: Automaton) -> str:
        """Return the file of an automaton for IDES."""
        lines = ['<?xml version="1.0" encoding="UTF-8"?>', '<model version="2.1" type="FSA" id="model">', "<data>"]
        for number, state in enumerate(automaton.states):
            marks = "<initial/>" * (number == 0) + "<marked/>" * (state in automaton.marked)
            lines.append(f'<state id="{number}"><properties>{marks}</properties><name>{state}</name></state>')
        for number, event in enumerate(automaton.alphabet):
            marks = "<controllable/>" * self.events[event] + "<observable/>"
            lines.append(f'<event id="{number}"><properties>{marks}</properties><name>{event}</name></event>')
        for number, edge in enumerate(automaton.edges):
            source, target = (automaton.states.index(state) for state in (edge.source, edge.target))
            event = automaton.alphabet.index(edge.event)
            lines.append(f'<transition id="{number}" source="{source}" target="{target}" event="{event}"/>')
        return "\n".join([*lines, "</data>", "</model>", ""])

    def roles(self, suffix: str) -> str:
        """Return the list of the automata's files."""
        return "".join(
            f"{'requirement' if automaton.requirement else 'plant'} {automaton.name}{suffix}\n"
            for automaton in self.automata
        )

    def wmod(self) -> str:
        """Return the file for Supremica."""
        return module(self.events, "".join([*self._variables(), *map(self._component, self.automata)]))

    def _variables(self) -> Iterator[str]:
        for name, last in self.variables.items():
            bounds = f'<BinaryExpression Operator="..">{_operand("0")}{_operand(str(last))}</BinaryExpression>'
            initial = f'<BinaryExpression Operator="==">{_operand(name)}{_operand("0")}</BinaryExpression>'
            yield f'<VariableComponent Name="{name}">\n<VariableRange>{bounds}</VariableRange>\n'
            yield f"<VariableInitial>{initial}</VariableInitial>\n</VariableComponent>\n"

    def _component(self, automaton: Automaton) -> str:
        states, edges = "", ""
        for number, state in enumerate(automaton.states):
            names = [":accepting"] * (state in automaton.marked) + [":forbidden"] * (state in automaton.forbidden)
            inside = f"<EventList>{''.join(map(_operand, names))}</EventList>" if names else ""
            initial = ' Initial="true"' * (number == 0)
            states += f'<SimpleNode Name="{state}"{initial}>{inside}</SimpleNode>\n'
        for edge in automaton.edges:
            guard = f"<Guards>{expression(edge.guard)}</Guards>" if edge.guard else ""
            actions = "".join(
                f'<BinaryExpression Operator="=">{_operand(name)}{expression(value)}</BinaryExpression>'
                for name, value in edge.updates.items()
            )
            actions = f"<Actions>{actions}</Actions>" if actions else ""
            block = f"<GuardActionBlock>{guard}{actions}</GuardActionBlock>" if guard or actions else ""
            edges += f'<Edge Source="{edge.source}" Target="{edge.target}"><LabelBlock>{_operand(edge.event)}'
            edges += f"</LabelBlock>{block}</Edge>\n"
        return component(automaton.name, "SPEC" if automaton.requirement else "PLANT", states, edges)

    # Synthesis by the definition

    def controlled_states(self) -> int:
        """Return the number of reachable states under the supervisor."""
        start: State = (tuple(automaton.states[0] for automaton in self.automata), (0,) * len(self.variables))
        steps, bad = self._explored(start)
        good = set(steps) - bad
        before = -1
        while len(good) != before:
            before = len(good)
            back = _grown(good, {state for state in good if self._is_marked(state)}, _reversed(steps))
            good = {
                state for state in back if all(target in back or self.events[event] for event, target in steps[state])
            }
        onwards = {state: {target for _, target in steps[state]} for state in good}
        return len(_grown(good, {start} & good, onwards))

    def _explored(self, start: State) -> tuple[dict[State, list[tuple[str, State]]], set[State]]:
        """Return the permitted steps of each reachable state, and the states that break a requirement."""
        steps: dict[State, list[tuple[str, State]]] = {}
        bad: set[State] = set()
        pending = [start]
        while pending:
            state = pending.pop()
            if state in steps:
                continue
            steps[state] = []
            if any(name in automaton.forbidden for name, automaton in zip(state[0], self.automata, strict=True)):
                bad.add(state)
            for event in self.events:
                possible, permitted, target = self._step(state, event)
                if possible and permitted:
                    steps[state].append((event, target))
                    pending.append(target)
                elif possible and not self.events[event]:
                    bad.add(state)
        return steps, bad

    def _is_marked(self, state: State) -> bool:
        return all(name in automaton.marked for name, automaton in zip(state[0], self.automata, strict=True))

    def _step(self, state: State, event: str) -> tuple[bool, bool, State]:
        """Return whether the plants make an event possible, whether the requirements permit it, and the next state.

        A variable makes an event impossible if the automata that write it disagree, or if its value leaves the range.
        """
        values = dict(zip(self.variables, state[1], strict=True))
        taken: dict[str, Edge | None] = {}
        for name, automaton in zip(state[0], self.automata, strict=True):
            if event in automaton.alphabet:
                edges = [edge for edge in automaton.edges if edge.source == name and edge.event == event]
                taken[automaton.name] = next(
                    (edge for edge in edges if not edge.guard or _value(edge.guard, values)), None
                )
        plants = {automaton.name for automaton in self.automata if not automaton.requirement}
        possible = bool(taken) and all(taken[name] for name in taken.keys() & plants)
        permitted = all(taken.values())
        following = dict(values)
        for variable, last in self.variables.items():
            writers = [
                automaton.name
                for automaton in self.automata
                if any(edge.event == event and variable in edge.updates for edge in automaton.edges)
            ]
            edges = [taken[name] for name in writers]
            if all(edges):
                new = {_value(edge.updates[variable], values) for edge in edges if edge and variable in edge.updates}
                possible = possible and len(new) <= 1 and all(0 <= value <= last for value in new)
                following[variable] = next(iter(new), values[variable])
        targets = (taken.get(automaton.name) for automaton in self.automata)
        locations = tuple(edge.target if edge else name for edge, name in zip(targets, state[0], strict=True))
        return possible, permitted, (locations, tuple(following.values()))


def _grown(within: set[State], first: set[State], onwards: dict[State, set[State]]) -> set[State]:
    """Return the states that the first ones reach without leaving a set."""
    reached, pending = set(first), list(first)
    while pending:
        more = onwards.get(pending.pop(), set()) & within - reached
        reached |= more
        pending += more
    return reached


def _reversed(steps: dict[State, list[tuple[str, State]]]) -> dict[State, set[State]]:
    sources: dict[State, set[State]] = {}
    for state, following in steps.items():
        for _, target in following:
            sources.setdefault(target, set()).add(state)
    return sources


def _value(text: str, values: dict[str, int]) -> int:
    """Return the value of an expression."""
    return int(eval(text, {}, values))  # noqa: S307 - the texts are those of the tests


def module(events: dict[str, bool], components: str, more: str = "") -> str:
    """Return a `.wmod` file."""
    declared = "".join(
        f'<EventDecl Kind="{"CONTROLLABLE" if controllable else "UNCONTROLLABLE"}" Name="{name}"/>\n'
        for name, controllable in events.items()
    )
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        '<Module xmlns="http://waters.sourceforge.net/xsd/module" Name="module">\n'
        f'{more}<EventDeclList>\n<EventDecl Kind="PROPOSITION" Name=":accepting"/>\n'
        f'<EventDecl Kind="PROPOSITION" Name=":forbidden"/>\n{declared}</EventDeclList>\n'
        f"<ComponentList>\n{components}</ComponentList>\n</Module>\n"
    )


def component(name: str, kind: str, states: str, edges: str) -> str:
    """Return an automaton of a `.wmod` file."""
    graph = f"<Graph>\n<NodeList>\n{states}</NodeList>\n<EdgeList>\n{edges}</EdgeList>\n</Graph>"
    return f'<SimpleComponent Kind="{kind}" Name="{name}">\n{graph}\n</SimpleComponent>\n'


def _operand(word: str) -> str:
    return f'<IntConstant Value="{word}"/>' if word.isdecimal() else f'<SimpleIdentifier Name="{word}"/>'


def expression(text: str) -> str:
    """Return the elements of an expression: operands and operators in turns, all operators left-associative."""
    if " and " in text:
        parts = text.split(" and ")
        result = expression(parts[0])
        for part in parts[1:]:
            result = f'<BinaryExpression Operator="&amp;">{result}{expression(part)}</BinaryExpression>'
        return result
    first, *others = text.split()
    result = _operand(first)
    for operator, operand in zip(others[::2], others[1::2], strict=True):
        result = f'<BinaryExpression Operator="{_OPERATORS[operator]}">{result}{_operand(operand)}</BinaryExpression>'
    return result
