"""Rules on unique names (thesis 4.5.7 and 4.5.12).

The rules are `unique-component`, `unique-datatype`, `unique-state`, `unique-variable`, `unique-property` and
`single-behaviour`.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from robosc.language.checks.definitions import behaviours, components, of_kind, statements, states, variables
from robosc.language.checks.edits import Choice, Removal, Renaming
from robosc.language.checks.fleets import member_names
from robosc.language.checks.rule import Finding, on_line, rule
from robosc.model import robosc as rsc
from robosc.model.reflection import tree
from robosc.model.semantics.failures import FAILURE, is_failure
from robosc.model.semantics.typing import EnumType, declared_type

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from robosc.model import expression as ex

    #: Scopes of a text: the description of each scope, and the elements that need unique names in it.
    Scopes = Callable[[rsc.Base], Iterable[tuple[str, Iterable[ex.NamedElement]]]]


def _components(base: rsc.Base) -> Iterator[tuple[str, list[Any]]]:
    named: list[Any] = [
        *of_kind((rsc.Component, rsc.NamedExpression), base.definitions),
        *of_kind(rsc.StatedDefinition, base.definitions),
    ]
    yield f"`{base.name}`", named


def _data_types(base: rsc.Base) -> Iterator[tuple[str, list[rsc.ComplexDataType]]]:
    yield f"`{base.name}`", of_kind(rsc.ComplexDataType, base.definitions)


def _states(base: rsc.Base) -> Iterator[tuple[str, list[Any]]]:
    for component, behaviour in behaviours(base):
        yield f"component `{component.name}`", states(behaviour.automaton)
    for requirement in statements(rsc.AutomatonRequirement, base):
        yield f"requirement `{requirement.name}`" if requirement.name else "the requirement", list(requirement.states)


#: Names for the kinds of elements of a component in findings.
_KINDS = {
    rsc.State: "state",
    rsc.Constant: "constant",
    rsc.Parameter: "parameter",
    rsc.Condition: "condition",
    rsc.Function: "function",
    rsc.Variable: "variable",
    rsc.Requirement: "requirement",
    rsc.Property: "property",
    rsc.Assumption: "assumption",
}
#: Rules for unique names: the rule, the kind of element in words, and the scopes.
_UNIQUE: tuple[tuple[str, str, Scopes], ...] = (
    ("unique-component", "component", _components),
    ("unique-datatype", "data type", _data_types),
    ("unique-state", "state", _states),
)


def _repeated_names(kind: str, scopes: Scopes, base: rsc.Base) -> Iterator[Finding]:
    for where, elements in scopes(base):
        for second, first in _repeated(elements):
            yield _declared_again(kind, second, first, where)
    if scopes is _components:
        yield from member_names(base)


for _identifier, _kind, _scopes in _UNIQUE:
    rule(_identifier)(partial(_repeated_names, _kind, _scopes))


@rule("unique-variable")
def unique_variable(base: rsc.Base) -> Iterator[Finding]:
    """No variable of a component has the name of another one or of a state: `Component.name` reaches both.

    No variable, constant or parameter of the predefined enum has the name of one of its values.
    """
    yield from _parameters(base)
    owners: list[Any] = [*statements(rsc.Function, base)]
    owners += of_kind((rsc.Component, rsc.EnumDataType), base.definitions)
    named: list[Any] = [*variables(base), *statements(rsc.Constant, base), *statements(rsc.Parameter, base)]
    named += (parameter for owner in owners for parameter in owner.parameters)
    for declared in named:
        kind = declared_type(declared.type)
        reasons = kind.definition if isinstance(kind, EnumType) and is_failure(kind.definition) else None
        if reasons is not None and declared.name in {known.value.name for known in reasons.rules}:
            word = type(declared).__name__.removeprefix("Formal").lower()
            yield Finding(
                declared,
                f"{word} `{declared.name}` is named like a value of its type `{FAILURE}`, expected another name:"
                f" in `error = {declared.name}` the name is the value",
                "choose another name, such as `why`",
            )
    for component, local in components(base):
        where = f"component `{component.name}`"
        first: dict[str, Any] = {}
        known = set()
        members: list[Any] = [
            *of_kind(rsc.NamedExpression, local.definitions),
            *of_kind(rsc.StatedDefinition, local.definitions),
        ]
        for behaviour in of_kind(rsc.ComponentBehaviour, local.definitions):
            members += of_kind(rsc.AccessibleItem, behaviour.automaton.definitions if behaviour.automaton else ())
        for definition in members:
            is_state = isinstance(definition, rsc.State)
            # `unique-state` reports two states with one name.
            if definition.name is None:
                continue
            if definition.name in first and not (is_state and definition.name in known):
                yield _declared_again("variable", definition, first[definition.name], where)
            if is_state:
                known.add(definition.name)
            first.setdefault(definition.name, definition)


def _parameters(base: rsc.Base) -> Iterator[Finding]:
    owners: list[Any] = of_kind((rsc.Component, rsc.EnumDataType), base.definitions)
    for owner in (*statements(rsc.Function, base), *owners):
        for second, first in _repeated(owner.parameters):
            yield _declared_again("parameter", second, first, f"`{owner.name}`")


@rule("unique-property")
def unique_property(base: rsc.Base) -> Iterator[Finding]:
    """No object has two properties of one name, and a provided object names each property once."""
    for definition in of_kind(rsc.ObjectDataType, base.definitions):
        for second, first in _repeated(definition.properties):
            yield _declared_again("property", second, first, f"object `{definition.name}`")
    for statement in statements(rsc.DataStatement, base):
        for _, value in tree(statement):
            if isinstance(value, rsc.ObjectValue):
                yield from _provided_again(value)


def _provided_again(value: rsc.ObjectValue) -> Iterator[Finding]:
    named: dict[rsc.ObjectProperty, rsc.ObjectPropertyValue] = {}
    for field in value.properties:
        first = named.setdefault(field.property, field)
        if field.property is not None and first is not field:
            ways = Removal("leave the first one out", first), Removal("leave the last one out", field)
            yield Finding(
                field,
                f"property `{field.property.name}` has a value already, expected one for each property",
                Choice("leave one of the two out", ways),
            )


@rule("single-behaviour")
def single_behaviour(base: rsc.Base) -> Iterator[Finding]:
    """Every component has at most one behavior."""
    for component, local in components(base):
        every = of_kind(rsc.ComponentBehaviour, local.definitions)
        for other in every[1:]:
            yield Finding(
                other,
                f"`{component.name}` has another behaviour already{on_line(every[0])}, expected one",
                "move its states, variables and transitions to the first one, or to a new component",
                related=every[0],
            )


def _repeated(elements: Iterable[ex.NamedElement]) -> Iterator[tuple[ex.NamedElement, ex.NamedElement]]:
    """Yield each element whose name an earlier one has, with the first that has it."""
    first: dict[str, ex.NamedElement] = {}
    for element in elements:
        if element.name and first.setdefault(element.name, element) is not element:
            yield element, first[element.name]


def _called(element: Any, otherwise: str) -> str:
    return next((word for kind, word in _KINDS.items() if isinstance(element, kind)), otherwise)


def _declared_again(kind: str, second: ex.NamedElement, first: ex.NamedElement, where: str) -> Finding:
    kind, of_first = _called(second, kind), _called(first, kind)
    other = f"another {kind}" if kind == of_first else f"a {of_first}"
    return Finding(
        second,
        f"{kind} `{second.name}` has the name of {other}{on_line(first)}, expected a name of its own in {where}",
        Renaming(f"rename one of the two, such as `{second.name}_2`", second, f"{second.name}_2"),
        related=first,
    )
