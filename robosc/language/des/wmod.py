"""Modules of Supremica and Waters: a `.wmod` file with automata, and with variables that their edges read and write.

A module's automata may all write any variable. In CIF, an automaton writes its own variables only. A variable that one
plant writes becomes part of it. Any other variable becomes an automaton that follows the edges of all writers.

The transition relation of Waters has no edge to a value out of range. The edge therefore gets a guard.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field, replace
from itertools import product
from math import prod
from typing import TYPE_CHECKING, Any

from robosc.base.diagnostics import Severity
from robosc.language.des.automata import Automaton, Edge, Event, FaultError, State, System, construct
from robosc.language.des.files import attribute
from robosc.language.des.wmod_expressions import EXPRESSIONS, Enumeration, Names, Value, Variable, compared, number

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from robosc.language.des.files import Source
    from robosc.language.des.wmod_expressions import Bindings, Constant
    from robosc.model.xmi.markup import Element

_ACCEPTING, _FORBIDDEN = ":accepting", ":forbidden"
_CONTROLLABLE = {"CONTROLLABLE": True, "UNCONTROLLABLE": False}
_REQUIREMENT = {"PLANT": False, "SPEC": True, "SUPERVISOR": True}
_ASSIGNMENTS = {"+=": "+", "-=": "-", "*=": "*", "/=": "/", "%=": "%", "&=": "&", "|=": "|"}
_NAMES = ("SimpleIdentifier", "IndexedIdentifier", "QualifiedIdentifier")
#: Maximum number of automata after `foreach` is expanded, of edges, of values that are tried for an initial value, and
#: of loops inside each other.
_MOST, _MOST_EDGES, _MOST_TRIED, _DEEPEST = 20_000, 1_000_000, 100_000, 50


@dataclass(eq=False)
class _Component:
    """An automaton or a variable: its element, and the values of the loops around it."""

    name: str
    node: Element
    bindings: dict[str, Constant]
    #: Values that edges assign, by edge.
    automaton: Automaton | None = None
    writes: dict[Edge, dict[Variable, Value]] = field(default_factory=dict)


def read(source: Source, system: System) -> None:
    """Fill a system from a module. Raises FaultError or ModelError if the module is unusable."""
    _Module(source, system).run(source.root("Module"))


class _Module:
    def __init__(self, source: Source, system: System) -> None:
        self._source = source
        self._system = system
        self._names = Names(source)
        #: Elements of arrays of events, and the events of aliases, by name.
        self._groups: dict[str, list[str]] = {}
        self._propositions: set[str] = set()
        #: Groups of states by name, of each graph that has edges or propositions of groups.
        self._group_nodes: dict[Element, dict[str, Element]] = {}
        self._markings: list[tuple[Variable, Element, dict[str, Constant]]] = []
        self._writers: dict[Variable, dict[_Component, None]] = {}
        self._count = 0

    def run(self, module: Element) -> None:
        system, place = self._system, self._source.place
        self._check_loops(module)
        for parameter in _in_lists(module, "ParameterList"):
            with system.reporting():
                raise construct(place(parameter), "a module with parameters", "write the module without them")
        for alias in _in_lists(module, "ConstantAliasList"):
            with system.reporting():
                expression = next(_expressions(alias, "ConstantAliasExpression"), None)
                if expression is None:
                    raise FaultError(place(alias), "syntax", "the constant has no value")
                self._names.constants[attribute(alias, "Name", self._source)] = expression
        self._names.compute()
        for declaration in _in_lists(module, "EventDeclList"):
            with system.reporting():
                self._event(declaration)
        for alias in _in_lists(module, "EventAliasList"):
            with system.reporting():
                self._alias(alias, {})
        components = list(self._components(_in_lists(module, "ComponentList"), {}))
        automata = [component for component in components if component.node.name == "SimpleComponent"]
        for component in automata:
            with system.reporting():
                self._automaton(component)
        self._variables([component for component in components if component.node.name == "VariableComponent"])
        self._owners([component for component in automata if component.automaton is not None])
        system.name_states()
        for component in automata:
            if component.automaton is not None:
                with system.reporting():
                    self._edges(component, component.automaton)
        self._assignments()
        for variable, node, bindings in self._markings:
            with system.reporting():
                text = self._names.condition(node, bindings).text
                system.predicates.append((f"marked {text};", variable.place))

    def _check_loops(self, module: Element) -> None:
        """Raise FaultError if too many loops are inside each other."""
        pending = [(module, 0)]
        while pending:
            node, depth = pending.pop()
            depth += node.name.startswith("Foreach")
            if depth > _DEEPEST:
                what = f"more than {_DEEPEST} loops inside each other"
                raise construct(self._source.place(node), what, "write fewer loops")
            pending += [(child, depth) for child in node.children]

    # Events

    def _event(self, node: Element) -> None:
        name, kind = attribute(node, "Name", self._source), attribute(node, "Kind", self._source).upper()
        place = self._source.place(node)
        if kind == "PROPOSITION":
            self._propositions.add(name)
            if name not in (_ACCEPTING, _FORBIDDEN):
                hint = f"synthesis reads `{_ACCEPTING}` and `{_FORBIDDEN}`"
                fault = FaultError(place, "automata-construct", f"synthesis ignores the proposition `{name}`", hint)
                self._system.findings.append(fault.finding(Severity.WARNING))
            return
        if kind not in _CONTROLLABLE:
            raise FaultError(self._source.place(node, "Kind"), "syntax", f"`{kind}` is not a kind of events")
        ranges = [self._names.values(expression, {}) for expression in _expressions(node, "RangeList")]
        if prod(map(len, ranges)) > _MOST:
            raise construct(place, f"an array of more than {_MOST} events", "make its ranges smaller")
        for indexes in product(*ranges):
            element = name + "".join(f"[{index}]" for index in indexes)
            event = self._system.event(element, place, controllable=_CONTROLLABLE[kind])
            for cut in range(len(indexes)):
                prefix = name + "".join(f"[{index}]" for index in indexes[:cut])
                self._groups.setdefault(prefix, []).append(element)
            if node.attributes.get(("", "Observable"), "true") == "false":
                self._system.hidden(event.name, place)

    def _alias(self, node: Element, bindings: Bindings) -> None:
        if node.name.startswith("Foreach"):
            for inner, body in self._repeated(node, bindings):
                for child in body:
                    self._alias(child, inner)
            return
        body = [child for part in node.children if part.name == "EventAliasExpression" for child in part.children]
        labels = [
            label
            for child in body
            for part in (child.children if child.name == "EventList" else [child])
            for label in self._labels(part, bindings)
        ]
        self._groups[self._own_name(node, bindings)] = list(dict.fromkeys(labels))

    def _labels(self, node: Element, bindings: Bindings) -> Iterator[str]:
        """Yield the names of the events and propositions that a label stands for."""
        if node.name.startswith("Foreach"):
            for inner, body in self._repeated(node, bindings):
                for child in body:
                    yield from self._labels(child, inner)
        elif node.name in _NAMES:
            name = self._names.name(node, bindings)
            if name in self._system.events or name in self._propositions:
                yield name
            elif name in self._groups:
                self._names.count(node, len(self._groups[name]))
                yield from self._groups[name]
            else:
                raise FaultError(self._source.place(node), "unresolved-reference", f"there is no event `{name}`")

    def _repeated(self, node: Element, bindings: Bindings) -> Iterator[tuple[dict[str, Constant], list[Element]]]:
        """Yield the values of a loop's variable, each with the contents of the loop."""
        variable = attribute(node, "Name", self._source)
        ranges = [child for child in node.children if child.name in EXPRESSIONS]
        guards = list(_expressions(node, "Guards"))
        body = [child for part in node.children if part.name.endswith("List") for child in part.children]
        if not body:
            body = ranges[1:]
        if not ranges:
            raise FaultError(self._source.place(node), "syntax", "the loop has no range")
        for value in self._names.values(ranges[0], bindings):
            self._names.count(node)
            inner = {**bindings, variable: value}
            if all(self._names.constant(guard, inner) for guard in guards):
                yield inner, body

    # Components

    def _components(self, nodes: Iterable[Element], bindings: dict[str, Constant]) -> Iterator[_Component]:
        for node in nodes:
            with self._system.reporting():
                if node.name.startswith("Foreach"):
                    for inner, body in self._repeated(node, bindings):
                        yield from self._components(body, inner)
                elif node.name in ("SimpleComponent", "VariableComponent"):
                    self._count += 1
                    if self._count > _MOST:
                        raise construct(self._source.place(node), f"more than {_MOST} components", "use fewer")
                    yield _Component(self._own_name(node, bindings), node, bindings)
                elif node.name == "Instance":
                    hint = "save the module without instances: write their automata into it"
                    raise construct(self._source.place(node), "instances of other modules", hint)
                else:
                    raise construct(self._source.place(node), f"the component `{node.name}`", "leave it out")

    def _own_name(self, node: Element, bindings: Bindings) -> str:
        """Return the name of a component: an attribute, or an identifier with indexes."""
        if ("", "Name") in node.attributes:
            return node.attributes["", "Name"]
        named = next((child for child in node.children if child.name in _NAMES), None)
        if named is None:
            raise FaultError(self._source.place(node), "syntax", f"the element `{node.name}` has no name")
        return self._names.name(named, bindings)

    def _automaton(self, component: _Component) -> None:
        """Create an automaton with its states."""
        node, place = component.node, self._source.place(component.node)
        kind = attribute(node, "Kind", self._source).upper()
        if kind == "PROPERTY":
            message = f"synthesis ignores the property `{component.name}`"
            fault = FaultError(place, "automata-construct", message, "make it a specification if it is to hold")
            self._system.findings.append(fault.finding(Severity.WARNING))
            return
        if kind not in _REQUIREMENT:
            raise FaultError(self._source.place(node, "Kind"), "syntax", f"`{kind}` is not a kind of automata")
        if component.name in self._names.automata:
            raise FaultError(place, "automata-declaration", f"there are two automata `{component.name}`", "rename one")
        automaton = self._system.automaton(component.name, place, requirement=_REQUIREMENT[kind])
        component.automaton = self._names.automata[component.name] = automaton
        graph = _child(node, "Graph", self._source)
        labels = {}
        for state in (child for part in graph.children if part.name == "NodeList" for child in part.children):
            with self._system.reporting():
                labels[state] = set(self._state(state, component, automaton))
        for state, names in labels.items():
            for inner in self._inside(attribute(state, "Name", self._source), graph, automaton):
                inner.marked |= _ACCEPTING in names
                inner.forbidden |= _FORBIDDEN in names
        if not any(_ACCEPTING in names for names in labels.values()):
            # An automaton without the proposition accepts everywhere.
            for inner in automaton.states.values():
                inner.marked = True

    def _state(self, node: Element, component: _Component, automaton: Automaton) -> Iterator[str]:
        """Create a state, unless the element is a group; yield its propositions."""
        self._names.count(node)
        name = attribute(node, "Name", self._source)
        if node.name == "SimpleNode":
            if name in automaton.states:
                raise FaultError(self._source.place(node), "unique-state", f"there are two states `{name}`")
            initial = node.attributes.get(("", "Initial")) == "true"
            automaton.states[name] = State(name, self._source.place(node), initial=initial)
        for child in _in_lists(node, "EventList"):
            yield from self._labels(child, component.bindings)

    def _inside(self, name: str, graph: Element, automaton: Automaton) -> Iterator[State]:
        """Yield the state of this name, or the states in the group of this name."""
        if name in automaton.states:
            yield automaton.states[name]
            return
        groups = self._group_nodes.get(graph)
        if groups is None:
            nodes = (node for node in _in_lists(graph, "NodeList") if node.name == "GroupNode")
            groups = self._group_nodes[graph] = {node.attributes.get(("", "Name"), ""): node for node in nodes}
        pending, seen = [name], set[str]()
        while pending:
            here = pending.pop()
            if here in seen:
                continue
            seen.add(here)
            if here in automaton.states:
                yield automaton.states[here]
            elif here in groups:
                children = (
                    child
                    for part in groups[here].children
                    for child in (part, *part.children)
                    if child.name in _NAMES and part.name != "EventList"
                )
                pending += [attribute(child, "Name", self._source) for child in children]

    # Variables

    def _variables(self, components: list[_Component]) -> None:
        """Create the variables, with joint enumerations for sets that share atoms."""
        sets: list[set[str]] = []
        known: list[tuple[_Component, Variable]] = []
        for component in components:
            with self._system.reporting():
                variable = self._variable(component)
                known.append((component, variable))
                joint = set(variable.atoms)
                for other in [other for other in sets if other & joint]:
                    joint |= other
                    sets.remove(other)
                if joint:
                    sets.append(joint)
        for index, atoms in enumerate(sets):
            enumeration = Enumeration(self._system.fresh(f"Values{index}", "E"), {})
            ordered = dict.fromkeys(atom for _, variable in known for atom in variable.atoms if atom in atoms)
            for atom in ordered:
                enumeration.literals[atom] = self._system.fresh(atom, "v")
                self._names.enumerations[atom] = enumeration
            names = ", ".join(enumeration.literals.values())
            place = next(variable.place for _, variable in known if variable.atoms and variable.atoms[0] in atoms)
            self._system.enumerations.append((f"enum {enumeration.cif} = {names};", place))
        for component, variable in known:
            with self._system.reporting():
                variable.enumeration = self._names.enumerations[variable.atoms[0]] if variable.atoms else None
                variable.initial = self._initial(component, variable)

    def _variable(self, component: _Component) -> Variable:
        node, names = component.node, self._names
        place = self._source.place(node)
        if component.name in names.variables or component.name in names.automata:
            raise FaultError(
                place, "automata-declaration", f"there are two components `{component.name}`", "rename one"
            )
        kind = next(_expressions(node, "VariableRange"), None)
        if kind is None:
            raise FaultError(place, "syntax", f"the variable `{component.name}` has no range")
        values = names.constant(kind, component.bindings)
        if isinstance(values, range) and len(values):
            variable = Variable(component.name, place, values)
        elif isinstance(values, tuple) and values:
            variable = Variable(component.name, place, None, values)
        else:
            raise FaultError(self._source.place(kind), "type", "expected a range of numbers, or a set of values")
        names.variables[component.name] = variable
        for marking in (child for child in node.children if child.name == "VariableMarking"):
            if any(child.attributes.get(("", "Name")) == _ACCEPTING for child in marking.children):
                predicate = [child for child in marking.children if child.name in EXPRESSIONS][1:]
                self._markings += [(variable, child, component.bindings) for child in predicate]
        return variable

    def _initial(self, component: _Component, variable: Variable) -> int | str:
        """Return the one value with which a variable can start."""
        predicate = next(_expressions(component.node, "VariableInitial"), None)
        possible: Any = variable.atoms or variable.values
        direct = None if predicate is None else self._equal(predicate, variable, component.bindings)
        if direct is not None:
            possible = [direct] if direct in possible else []
        elif predicate is not None and len(possible) <= _MOST_TRIED:
            del self._names.variables[variable.name]  # It has a value in the predicate.
            try:
                possible = [
                    value
                    for value in possible
                    if self._names.constant(predicate, {**component.bindings, variable.name: value})
                ]
            finally:
                self._names.variables[variable.name] = variable
        if len(possible) != 1:
            place = variable.place if predicate is None else self._source.place(predicate)
            count = len(possible) or "no"
            message = f"`{variable.name}` can start with {count} values, expected one"
            raise FaultError(place, "initial-state", message, f"write `{variable.name} == …` with one value")
        value: int | str = possible[0]
        return value

    def _equal(self, predicate: Element, variable: Variable, bindings: Bindings) -> Constant | None:
        """Return the constant of a predicate `x == constant` of a variable x, or None if it has another form."""
        operands = list(_operands(predicate))
        if predicate.attributes.get(("", "Operator")) == "==" and len(operands) == 2 and operands[0].name in _NAMES:
            with suppress(FaultError):
                if self._names.name(operands[0], bindings) == variable.name:
                    return self._names.constant(operands[1], bindings)
        return None

    # Edges

    def _edges(self, component: _Component, automaton: Automaton) -> None:
        graph = _child(component.node, "Graph", self._source)
        for child in _in_lists(graph, "LabelBlock"):
            automaton.alphabet |= dict.fromkeys(self._events(child, component))
        leaving: dict[tuple[State, Event], list[tuple[int, Edge, dict[Variable, Value]]]] = {}
        for node in (node for node in _in_lists(graph, "EdgeList") if node.name == "Edge"):
            with self._system.reporting():
                self._names.count(node)
                sources, target = self._ends(node, graph, automaton)
                guards, writes = self._step(node, component.bindings)
                events = [event for child in _in_lists(node, "LabelBlock") for event in self._events(child, component)]
                self._count += len(events) * len(sources)
                if self._count > _MOST_EDGES:
                    raise construct(self._source.place(node), f"more than {_MOST_EDGES} edges", "use fewer")
                for source, event in product(sources, dict.fromkeys(events)):
                    edge = Edge(source, event, target, self._source.place(node), list(guards))
                    leaving.setdefault((source, event), []).append((len(sources), edge, writes))
        for alternatives in leaving.values():
            # The edges of an inner group, or of the state itself, take precedence over those of the groups around it.
            innermost = min(size for size, _, _ in alternatives)
            for size, edge, writes in alternatives:
                if size == innermost:
                    automaton.edges.append(edge)
                    automaton.alphabet[edge.event] = None
                    component.writes[edge] = writes

    def _ends(self, node: Element, graph: Element, automaton: Automaton) -> tuple[list[State], State]:
        """Return the states from which an edge leads, and the state to which it leads."""
        ends = []
        for role in ("Source", "Target"):
            name = attribute(node, role, self._source)
            ends.append(list(self._inside(name, graph, automaton)))
            if not ends[-1]:
                raise FaultError(self._source.place(node, role), "unresolved-reference", f"there is no state `{name}`")
        sources, targets = ends
        if len(targets) > 1:
            raise construct(self._source.place(node), "edges to a group of states", "write one for each state")
        return sources, targets[0]

    def _events(self, node: Element, component: _Component) -> Iterator[Event]:
        """Yield the events of a label. Propositions on edges have no meaning."""
        for name in self._labels(node, component.bindings):
            if name in self._system.events:
                yield self._system.events[name]

    def _step(self, node: Element, bindings: Bindings) -> tuple[list[str], dict[Variable, Value]]:
        """Return the guards of an edge, and the values that it assigns."""
        guards: list[str] = []
        writes: dict[Variable, Value] = {}
        for block in (child for child in node.children if child.name == "GuardActionBlock"):
            for guard in _expressions(block, "Guards"):
                guards += [
                    self._names.condition(part, bindings).text
                    for part in self._conjuncts(guard)
                    if not self._next_value(part, bindings, writes)
                ]
            for action in _expressions(block, "Actions"):
                self._action(action, bindings, writes)
        return guards, writes

    def _conjuncts(self, node: Element) -> Iterator[Element]:
        pending = [node]
        while pending:
            here = pending.pop()
            if here.name == "BinaryExpression" and here.attributes.get(("", "Operator")) == "&":
                pending += reversed([child for child in here.children if child.name in EXPRESSIONS])
            else:
                yield here

    def _next_value(self, node: Element, bindings: Bindings, writes: dict[Variable, Value]) -> bool:
        """Take a condition `x' == value` as an assignment; return whether it is one."""
        operands = [child for child in node.children if child.name in EXPRESSIONS]
        if node.name != "BinaryExpression" or node.attributes.get(("", "Operator")) != "==" or len(operands) != 2:
            return False
        for primed, value in (operands, operands[::-1]):
            if primed.name == "UnaryExpression" and primed.attributes.get(("", "Operator")) == "'":
                inner = [child for child in primed.children if child.name in EXPRESSIONS]
                if len(inner) == 1:
                    self._assign(inner[0], value, self._names.value(value, bindings), bindings, writes)
                    return True
        return False

    def _action(self, node: Element, bindings: Bindings, writes: dict[Variable, Value]) -> None:
        operands = [child for child in node.children if child.name in EXPRESSIONS]
        operator = node.attributes.get(("", "Operator"))
        if node.name != "BinaryExpression" or len(operands) != 2:
            raise construct(self._source.place(node), "this action", "write `x = …`")
        target, right = operands
        if operator == "=":
            value = self._names.value(right, bindings)
        elif operator in _ASSIGNMENTS:
            value = self._names.value(_with_operator(node, _ASSIGNMENTS[operator]), bindings)
        else:
            raise construct(self._source.place(node), f"the action `{operator}`", "write `x = …`")
        self._assign(target, right, value, bindings, writes)

    def _assign(
        self, target: Element, node: Element, value: Value, bindings: Bindings, writes: dict[Variable, Value]
    ) -> None:
        name = self._names.name(target, bindings)
        variable = self._names.variables.get(name)
        if variable is None:
            raise FaultError(self._source.place(target), "unresolved-reference", f"there is no variable `{name}`")
        if variable in writes:
            message = f"`{name}` is assigned twice"
            raise FaultError(self._source.place(target), "repeated-assignment", message, "assign it once")
        if variable.values is not None:
            value = self._names.as_number(node, value)
        elif value.type is not variable.enumeration:
            message = f"`{name}` has no value `{value.text}`"
            raise FaultError(self._source.place(node), "type", message)
        writes[variable] = value

    # Owners of variables

    def _owners(self, components: list[_Component]) -> None:
        """Declare each variable in the one plant that writes it, or in an automaton of its own."""
        for component in components:
            for name in self._targets(component):
                if name in self._names.variables:
                    self._writers.setdefault(self._names.variables[name], {})[component] = None
        value = self._system.fresh("value", "v")
        for variable in self._names.variables.values():
            writing = [component.automaton for component in self._writers.get(variable, ())]
            if len(writing) == 1 and writing[0] is not None and not writing[0].requirement:
                variable.owner = writing[0]
                variable.cif = self._system.fresh(variable.name, "v")
            else:
                variable.owner = self._system.automaton(variable.name, variable.place, requirement=False)
                variable.owner.states[""] = State("S", variable.place, initial=True, marked=True)
                variable.cif = value
            kind = variable.enumeration.cif if variable.enumeration is not None else ""
            if variable.values is not None:
                kind = f"int[{variable.values.start}..{variable.values.stop - 1}]"
            initial = variable.initial
            if variable.enumeration is not None:
                initial = variable.enumeration.literals[str(initial)]
            variable.owner.declarations.append((f"disc {kind} {variable.cif} = {initial};", variable.place))

    def _targets(self, component: _Component) -> Iterator[str]:
        """Yield the names of the variables that an automaton's edges write."""
        for block in _below(component.node, "GuardActionBlock"):
            targets = [next(_operands(action), None) for action in _expressions(block, "Actions")]
            for guard in _expressions(block, "Guards"):
                for part in self._conjuncts(guard):
                    targets += [
                        next(_operands(operand), None)
                        for operand in _operands(part)
                        if operand.attributes.get(("", "Operator")) == "'"
                    ]
            for target in targets:
                if target is not None and target.name in _NAMES:
                    with suppress(FaultError):
                        yield self._names.name(target, component.bindings)

    def _assignments(self) -> None:
        """Add the values that edges assign: to the edges of a plant, or to those of the variable's automaton."""
        for variable, components in self._writers.items():
            with self._system.reporting():
                [first, *_] = components
                if variable.owner is not first.automaton:
                    self._joint(variable, list(components))
                    continue
                for edge, writes in first.writes.items():
                    if variable in writes:
                        edge.guards += _fitting(variable, writes[variable])
                        edge.updates.append(f"{variable.cif} := {writes[variable].text}")

    def _joint(self, variable: Variable, components: list[_Component]) -> None:
        """Create the edges of a variable's own automaton: for each joint step of its writers, their value.

        Writers must agree on the value. If a requirement forbids the step, the variable's automaton does not.
        """
        owner = variable.owner
        assert owner is not None
        [only] = owner.states.values()
        events = dict.fromkeys(
            edge.event for component in components for edge, writes in component.writes.items() if variable in writes
        )
        for event in events:
            owner.alphabet[event] = None
            alternatives = []
            permissive = False
            for component in components:
                steps = [
                    (edge, writes.get(variable)) for edge, writes in component.writes.items() if edge.event is event
                ]
                if all(value is None for _, value in steps):
                    continue
                sources = [edge.source for edge, _ in steps]
                if not event.controllable and len(set(sources)) < len(sources):
                    what = f"several edges of `{event.name}` from one state that write `{variable.name}`"
                    raise construct(steps[0][0].place, what, "write the variable in one plant only")
                assert component.automaton is not None
                permissive = permissive or component.automaton.requirement
                alternatives.append([(component.automaton, edge, value) for edge, value in steps])
            if prod(map(len, alternatives)) > _MOST:
                what = f"more than {_MOST} joint steps of `{event.name}` that write `{variable.name}`"
                raise construct(variable.place, what, "write the variable in one plant only")
            premises = []
            for joint in product(*alternatives):
                premise = [part for automaton, edge, _ in joint for part in (*automaton.at(edge.source), *edge.guards)]
                premises.append(" and ".join(f"({part})" for part in premise) or "true")
                edge = Edge(only, event, only, joint[0][1].place, premise)
                values = [value for _, _, value in joint if value is not None]
                if values:
                    edge.guards += [compared(values[0], "=", other).text for other in values[1:]]
                    edge.guards += _fitting(variable, values[0])
                    edge.updates.append(f"{variable.cif} := {values[0].text}")
                owner.edges.append(edge)
            if permissive:
                otherwise = " and ".join(f"not ({premise})" for premise in premises)
                owner.edges.append(Edge(only, event, only, variable.place, [otherwise]))


def _fitting(variable: Variable, value: Value) -> list[str]:
    """Return the conditions for a value to be one of its variable."""
    if variable.values is None or not isinstance(value.type, range):
        assert variable.enumeration is not None
        if set(value.atoms) <= set(variable.atoms):
            return []
        return [" or ".join(f"{value.text} = {variable.enumeration.literals[atom]}" for atom in variable.atoms)]
    bounds = []
    if value.type.start < variable.values.start:
        bounds.append((">=", variable.values.start))
    if value.type.stop > variable.values.stop:
        bounds.append(("<=", variable.values.stop - 1))
    return [compared(value, comparison, number(bound)).text for comparison, bound in bounds]


def _expressions(node: Element, part: str) -> Iterator[Element]:
    """Yield the expressions in a part of an element."""
    for child in node.children:
        if child.name == part:
            yield from _operands(child)


def _operands(node: Element) -> Iterator[Element]:
    return (child for child in node.children if child.name in EXPRESSIONS)


def _in_lists(node: Element, name: str) -> list[Element]:
    """Return the elements in the lists of this name."""
    return [child for part in node.children if part.name == name for child in part.children]


def _below(node: Element, name: str) -> Iterator[Element]:
    """Yield the elements of a name in an element, at any depth."""
    pending = [node]
    while pending:
        here = pending.pop()
        if here.name == name:
            yield here
        pending += reversed(here.children)


def _child(node: Element, name: str, source: Source) -> Element:
    child = next((child for child in node.children if child.name == name), None)
    if child is None:
        raise FaultError(source.place(node), "syntax", f"the element `{node.name}` has no element `{name}`")
    return child


def _with_operator(node: Element, operator: str) -> Element:
    return replace(node, attributes={**node.attributes, ("", "Operator"): operator})
