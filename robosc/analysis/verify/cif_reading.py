"""Reader of generated CIF by CIF's language reference: grammar, names, types, and rules of synthesis.

The grammar is not that of the importer. It rejects everything that is never generated, keeps the texts of annotations,
and needs no recursion for parentheses.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, reduce
from typing import TYPE_CHECKING, Any, NoReturn

import textx

from robosc.analysis.verify.cif_expressions import ExpressionError, ExpressionReader, TypedExpression
from robosc.base.files.resources import locate
from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics import cif_types as types
from robosc.model.semantics.walks import copy_tree

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence


class CifError(ValueError):
    """Text that is not a valid specification; the message has the place and the reason."""


@dataclass(frozen=True)
class Specification:
    """Content of a specification, with CIF's own names and numbers.

    `model` holds enumerations, plants, and requirements on events, on states and about reachable states. CIF has no
    kinds of plants and events except requirement automata, and does not relate inputs to events. `supervisor` is the
    automaton with the conditions that synthesis added, in one location; None if there is none. `alphabet` are its
    events. `invariants` are the other conditions under the supervisor.
    """

    model: sct.SupervisoryControlModel
    invariants: Sequence[sct.Requirement]
    supervisor: sct.Plant | None
    alphabet: Sequence[sct.Event]


@cache
def _grammar() -> Any:
    return textx.metamodel_from_file(str(locate("grammar/generated_cif.tx")), autokwd=True)


def read(text: str) -> Specification:
    """Return the specification of a text. Raises CifError."""
    strange = next((place for place, character in enumerate(text) if not character.isascii()), None)
    if strange is not None:
        raise CifError(f"{_place(text, strange)}: {text[strange]!a} is not ASCII")
    try:
        return _GrammarConversion(_grammar().model_from_str(text), text).specification()
    except textx.TextXSyntaxError as fault:
        raise CifError(f"line {fault.line}, column {fault.col}: {fault.message}") from None


class _GrammarConversion:
    """Conversion of grammar objects to metamodel objects."""

    def __init__(self, node: Any, text: str) -> None:
        self._node = node
        self._text = text
        #: Declarations outside of automata, and in each automaton.
        self._outer: dict[str, Any] = {}
        self._inner: dict[sct.Plant, dict[str, Any]] = {}
        self._types: dict[sct.DiscreteVariable | sct.Input, types.Type] = {}

    def specification(self) -> Specification:
        """Return the whole specification. Raises CifError."""
        model = sct.SupervisoryControlModel(name="")
        required = [node for node in self._node.annotations if type(node).__name__ == "Reachable"]
        self._check_annotations(annotation for annotation in self._node.annotations if annotation not in required)
        automata: list[tuple[Any, sct.Plant]] = []
        for enumeration in self._of("Enumeration"):
            model.enumerations.append(self._enumeration(enumeration))
        for declaration in self._of("Automaton"):
            self._annotated(declaration)
            automata.append((declaration, self._define(_automaton(declaration), declaration.name, self._outer)))
        for declaration, automaton in automata:
            self._declare(declaration, automaton)
        alphabets = [
            (declaration, automaton, self._fill(declaration, automaton)) for declaration, automaton in automata
        ]
        supervisor = automata[-1][0] if automata and automata[-1][0].kind == "supervisor" else None
        model.plants.extend(automaton for declaration, automaton in automata if declaration is not supervisor)
        if not model.plants:
            self._fail(self._node, "there is no plant")
        invariants: dict[str, list[sct.Requirement]] = {"plant": [], "requirement": [], "supervisor": []}
        for invariant in self._of("Invariant"):
            if type(self._annotated(invariant).restriction).__name__ == "Condition":
                model.invariants.append(self._state_invariant(invariant))
            else:
                invariants[invariant.kind].append(self._exclusion(invariant.restriction))
        model.requirements.extend(invariants["requirement"])
        model.reachabilityRequirements.extend(map(self._reachability_requirement, required))
        supervisors = [alphabet for alphabet in alphabets if alphabet[0] is supervisor]
        self._check_kinds([declaration for declaration, _ in automata], supervisor)
        for declaration, automaton, _ in supervisors:
            if len(automaton.locations) != 1 or not automaton.locations[0].marked:
                self._fail(declaration, "a supervisor has one location, and that is marked")
        return Specification(
            model,
            [*invariants["plant"], *invariants["supervisor"]],
            supervisors[0][1] if supervisors else None,
            supervisors[0][2] if supervisors else [],
        )

    def _check_kinds(self, automata: Sequence[Any], supervisor: Any) -> None:
        """Raise CifError if a supervisor is in the wrong place, or a requirement automaton occurs beside one."""
        for declaration in automata:
            if supervisor is not None and declaration.kind == "requirement":
                self._fail(declaration, "the specification has a requirement automaton and a supervisor")
            has_alphabet = any(type(part).__name__ == "Alphabet" for part in declaration.declarations)
            if declaration.kind == "supervisor" and has_alphabet != (declaration is supervisor):
                self._fail(declaration, "the automaton that synthesis adds is the last one and has an alphabet")

    def _of(self, rule: str) -> list[Any]:
        return [declaration for declaration in self._node.declarations if type(declaration).__name__ == rule]

    def _fail(self, node: Any, reason: str) -> NoReturn:
        raise CifError(f"{_place(self._text, node._tx_position)}: {reason}")  # noqa: SLF001 - textX stores it there

    def _annotated(self, node: Any) -> Any:
        """Check the annotations of an object and return it."""
        self._check_annotations(node.annotations)
        return node

    def _check_annotations(self, annotations: Iterable[Any]) -> None:
        for annotation in annotations:
            if annotation.name.lstrip("@") != "doc":
                self._fail(annotation, f"there is no annotation {annotation.name}")
            if not annotation.texts:
                self._fail(annotation, f"{annotation.name} says nothing")

    # Declarations

    def _define(self, element: Any, node: Any, scope: dict[str, Any]) -> Any:
        if element.name in scope:
            self._fail(node, f"the name '{element.name}' is declared twice")
        scope[element.name] = element
        return element

    def _enumeration(self, node: Any) -> ex.Enumeration:
        self._annotated(node)
        enumeration: ex.Enumeration = self._define(ex.Enumeration(name=_plain(node.name)), node.name, self._outer)
        for literal in node.literals:
            self._annotated(literal)
            enumeration.literals.append(
                self._define(ex.EnumerationLiteral(name=_plain(literal.name)), literal, self._outer)
            )
        return enumeration

    def _declare(self, node: Any, automaton: sct.Plant) -> None:
        """Read the declarations of an automaton that refer to nothing else."""
        self._inner[automaton] = {}
        for declaration in node.declarations:
            match type(declaration).__name__:
                case "Events":
                    for name in self._annotated(declaration).names:
                        event = sct.Event(name=_plain(name), controllable=declaration.controllable)
                        automaton.events.append(self._define(event, name, self._inner[automaton]))
                case "Inputs":
                    for name in self._annotated(declaration).names:
                        automaton.inputs.append(self._valued(sct.Input, name, declaration, automaton))
                case "Variables":
                    for variable in self._annotated(declaration).variables:
                        variable_element = self._valued(sct.DiscreteVariable, variable.name, declaration, automaton)
                        automaton.variables.append(variable_element)
        for location in node.locations:
            self._location(location, automaton, alone=len(node.locations) == 1)
        if not any(location.initial for location in automaton.locations):
            self._fail(node, f"'{automaton.name}' has no initial location")

    def _valued(self, kind: Any, name: Any, node: Any, automaton: sct.Plant) -> Any:
        """Return a variable or input with the type of its declaration."""
        element = kind(name=_plain(name), type=self._type(node.type, automaton))
        self._types[element] = _values(element.type)
        return self._define(element, name, self._inner[automaton])

    def _location(self, node: Any, automaton: sct.Plant, *, alone: bool) -> None:
        self._annotated(node)
        words = [getattr(element, "word", None) for element in node.elements]
        location = sct.Location(
            name=_plain(node.name) if node.name else "", initial="initial" in words, marked="marked" in words
        )
        if node.name:
            self._define(location, node.name, self._inner[automaton])
        elif not alone:
            self._fail(node, "a location without a name is the only one")
        if location.initial and any(location.initial for location in automaton.locations):
            self._fail(node, f"'{automaton.name}' has another initial location before this one")
        automaton.locations.append(location)

    def _type(self, node: Any, automaton: sct.Plant) -> ex.Type:
        match type(node).__name__:
            case "Boolean":
                return ex.BooleanType()
            case "Range":
                low, high = (self._number(bound, node) for bound in (node.low, node.high))
                if low > high:
                    self._fail(node, f"the range int[{low}..{high}] is empty")
                return ex.IntegerType(minimum=low, maximum=high)
        enumeration = self._find(node.enumeration, automaton)
        if not isinstance(enumeration, ex.Enumeration):
            self._fail(node, f"'{node.enumeration.text}' is not an enumeration")
        return ex.EnumerationType(enumeration=enumeration)

    def _number(self, digits: str, node: Any) -> int:
        if int(digits) > types.LARGEST:
            self._fail(node, f"{digits} does not fit 32 bits")
        return int(digits)

    # References

    def _fill(self, node: Any, automaton: sct.Plant) -> list[sct.Event]:
        """Read initial values and edges; return the automaton's alphabet."""
        variables = [
            variable
            for declaration in node.declarations
            if type(declaration).__name__ == "Variables"
            for variable in declaration.variables
        ]
        for variable, declaration in zip(automaton.variables, variables, strict=True):
            value, kind = self._expression(declaration.initial, automaton, constant=True)
            if not types.contains(self._types[variable], kind):
                self._fail(
                    declaration,
                    f"'{variable.name}' is {self._shown(variable)} and its initial value {types.format_type(kind)}",
                )
            variable.initial = value
        for location, declaration in zip(automaton.locations, node.locations, strict=True):
            for edge in declaration.elements:
                if type(edge).__name__ == "Edge":
                    location.edges.append(self._edge(edge, location, automaton))
        return self._alphabet(node, automaton)

    def _alphabet(self, node: Any, automaton: sct.Plant) -> list[sct.Event]:
        declared = self._events(node, "Alphabet", automaton)
        edges = [
            element for location in node.locations for element in location.elements if type(element).__name__ == "Edge"
        ]
        used = [self._event(edge.event, automaton) for edge in edges]
        if declared is not None:
            for edge, event in zip(edges, used, strict=True):
                if event not in declared:
                    self._fail(edge, f"'{edge.event.text}' is not in the alphabet of '{automaton.name}'")
            if node.kind != "supervisor" and set(declared) != set(used):
                self._fail(node, f"an event in the alphabet of '{automaton.name}' has no edge")
        alphabet = list(dict.fromkeys(used)) if declared is None else declared
        monitored = self._events(node, "Monitor", automaton)
        for event in (monitored or alphabet) if monitored is not None else ():
            if event not in alphabet:
                self._fail(node, f"'{event.name}' is monitored and not in the alphabet of '{automaton.name}'")
            for location in automaton.locations:
                _monitor(event, location)
        return alphabet

    def _events(self, node: Any, rule: str, automaton: sct.Plant) -> list[sct.Event] | None:
        """Return the events of the declaration of this kind; None if there is none."""
        declarations = [declaration for declaration in node.declarations if type(declaration).__name__ == rule]
        for another in declarations[1:]:
            self._fail(another, f"'{automaton.name}' has another {rule.lower()} before this one")
        return [self._event(event, automaton) for event in declarations[0].events] if declarations else None

    def _edge(self, node: Any, location: sct.Location, automaton: sct.Plant) -> sct.Edge:
        self._annotated(node)
        target = self._find(node.target, automaton) if node.target else location
        if not isinstance(target, sct.Location) or target.eContainer() is not automaton:
            self._fail(node.target, f"'{node.target.text}' is not a location of '{automaton.name}'")
        edge = sct.Edge(event=self._event(node.event, automaton), target=target)
        if node.guard:
            edge.guard = self._condition(node.guard, automaton)
        for update in node.updates:
            variable = self._find(update.variable, automaton)
            if not isinstance(variable, sct.DiscreteVariable):
                self._fail(update, f"'{update.variable.text}' is not a variable")
            if variable.eContainer() is not automaton:
                self._fail(update, f"'{update.variable.text}' is not a variable of '{automaton.name}'")
            if any(variable is other.variable for other in edge.updates):
                self._fail(update, f"'{update.variable.text}' is assigned twice")
            value, kind = self._expression(update.value, automaton, assigned=True)
            if not types.overlap(self._types[variable], kind):
                self._fail(
                    update,
                    f"'{variable.name}' is {self._shown(variable)} and its new value {types.format_type(kind)}",
                )
            edge.updates.append(sct.Update(variable=variable, value=value))
        return edge

    def _shown(self, variable: sct.DiscreteVariable) -> str:
        return types.format_type(self._types[variable])

    def _state_invariant(self, node: Any) -> sct.StateInvariant:
        if node.kind != "requirement":
            self._fail(node, f"an invariant of states is a requirement, not of a {node.kind}")
        invariant = sct.StateInvariant(condition=self._condition(node.restriction.condition, None))
        if node.name:
            invariant.name = _plain(node.name)
            self._define(invariant, node.name, self._outer)
        return invariant

    def _reachability_requirement(self, node: Any) -> sct.ReachabilityRequirement:
        last = node.bound or node.pathCondition or node.premise or node.condition
        closings = (last.others[-1].operand if last.others else last.first).closings
        if [closing.token for closing in closings][-1:] != [")"]:
            self._fail(node, "the annotation has no closing parenthesis")
        del closings[-1]
        return sct.ReachabilityRequirement(
            condition=self._condition(node.condition, None),
            premise=self._condition(node.premise, None) if node.premise else None,
            pathCondition=self._condition(node.pathCondition, None) if node.pathCondition else None,
            bound=self._bound(node.bound) if node.bound else None,
        )

    def _bound(self, node: Any) -> int:
        value = node.first.value
        if node.others or type(value).__name__ != "Literal":
            self._fail(node, "a bound is a number")
        return int(value.value)

    def _exclusion(self, node: Any) -> sct.Requirement:
        return sct.Requirement(
            event=self._event(node.event, None),
            kind=getattr(sct.RequirementKind, type(node).__name__.lower()),
            condition=self._condition(node.condition, None),
        )

    def _event(self, node: Any, automaton: sct.Plant | None) -> sct.Event:
        event = self._find(node, automaton)
        if not isinstance(event, sct.Event):
            self._fail(node, f"'{node.text}' is not an event")
        return event

    def _find(self, node: Any, automaton: sct.Plant | None) -> Any:
        """Return the element of a name inside an automaton: the nearest first identifier, then its members."""
        first, *others = node.text.replace("$", "").split(".")
        inner = {} if automaton is None else self._inner[automaton]
        element = inner.get(first) or self._outer.get(first)
        for part in others:
            if element is not None and element not in self._inner:
                self._fail(node, f"'{element.name}' has no members, so no '{node.text}'")
            element = None if element is None else self._inner[element].get(part)
        if element is None:
            self._fail(node, f"there is no '{node.text}'")
        return element

    # Expressions

    def _condition(self, node: Any, automaton: sct.Plant | None) -> ex.Expression:
        expression, kind = self._expression(node, automaton)
        if kind != types.BOOLEAN:
            self._fail(node, f"a condition is bool and this is {types.format_type(kind)}")
        return expression

    def _expression(
        self, node: Any, automaton: sct.Plant | None, *, constant: bool = False, assigned: bool = False
    ) -> tuple[ex.Expression, types.Type]:
        """Return an expression and its type; `constant` and `assigned` restrict the syntax.

        `automaton` is the scope of names, None outside of automata.
        """

        def value_of(operand: Any) -> TypedExpression:
            position = operand._tx_position  # noqa: SLF001
            match type(operand).__name__:
                case "Truth":
                    return TypedExpression(position, ex.BooleanLiteral(value=operand.value == "true"), types.BOOLEAN)
                case "Literal":
                    number = self._number(operand.value, operand)
                    return TypedExpression(position, ex.IntegerLiteral(value=number), range(number, number + 1))
            return TypedExpression(position, *self._reference(operand, automaton, constant=constant))

        try:
            _, expression, kind = ExpressionReader(node, value_of, difference=assigned).result
        except ExpressionError as fault:
            raise CifError(f"{_place(self._text, fault.position)}: {fault}") from None
        return expression, kind

    def _reference(self, node: Any, automaton: sct.Plant | None, *, constant: bool) -> tuple[ex.Expression, types.Type]:
        element = self._find(node.name, automaton)
        if constant and not isinstance(element, ex.EnumerationLiteral):
            self._fail(node, f"'{node.name.text}' is not a constant")
        match element:
            case sct.DiscreteVariable():
                return sct.VariableReference(variable=element), self._types[element]
            case sct.Input():
                return sct.InputReference(input=element), self._types[element]
            case sct.Location():
                return sct.LocationReference(location=element), types.BOOLEAN
            case ex.EnumerationLiteral():
                return ex.EnumerationLiteralReference(literal=element), element.eContainer()
        return self._fail(node, f"'{node.name.text}' has no value")


def _automaton(node: Any) -> sct.Plant:
    expression = sct.Plant(name=_plain(node.name))
    if node.kind != "plant":
        expression.kind = sct.PlantKind.requirement
    return expression


def _place(text: str, position: int) -> str:
    """Return a position in a text as line and column, counted from 1."""
    return f"line {text.count(chr(10), 0, position) + 1}, column {position - text.rfind(chr(10), 0, position)}"


def _monitor(event: sct.Event, location: sct.Location) -> None:
    """Allow an event also where no edge of the location does: CIF's monitors never block."""
    guards = [edge.guard for edge in location.edges if edge.event is event]
    if any(guard is None for guard in guards):
        return
    otherwise: list[ex.Expression] = [ex.Negation(operand=copy_tree(guard)) for guard in guards if guard is not None]
    guard = reduce(lambda left, right: ex.Conjunction(left=left, right=right), otherwise) if otherwise else None
    location.edges.append(sct.Edge(event=event, target=location, guard=guard))


def _values(kind: ex.Type) -> types.Type:
    match kind:
        case ex.IntegerType():
            assert kind.minimum is not None
            assert kind.maximum is not None
            return range(kind.minimum, kind.maximum + 1)
        case ex.EnumerationType():
            return kind.enumeration
    return types.BOOLEAN


def _plain(node: Any) -> str:
    return (node if isinstance(node, str) else node.text).removeprefix("$")
