"""`unique-component`, `unique-datatype`, `unique-state`, `unique-variable`, `unique-property` (thesis 4.5.12)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.checks.automata import behaviours
from robosc.checks.rule import Finding, rule
from robosc.metamodel import robosc as rsc

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from robosc.metamodel import expression as ex


@rule("unique-component")
def unique_component(base: rsc.Base) -> Iterator[Finding]:
    """No two components have one name, defined here or imported."""
    for second, first in repeated(
        definition for definition in base.definitions if isinstance(definition, rsc.Component)
    ):
        yield declared_again("component", second, first, f"`{base.name}`")


@rule("unique-datatype")
def unique_datatype(base: rsc.Base) -> Iterator[Finding]:
    """No two objects or enums of one file have one name."""
    for second, first in repeated(
        definition for definition in base.definitions if isinstance(definition, rsc.ComplexDataType)
    ):
        yield declared_again("data type", second, first, f"`{base.name}`")


@rule("unique-state")
def unique_state(base: rsc.Base) -> Iterator[Finding]:
    """No two states of a component have one name."""
    for component, behaviour in behaviours(base):
        states = (definition for definition in behaviour.automaton.definitions if isinstance(definition, rsc.State))
        for second, first in repeated(states):
            yield declared_again("state", second, first, f"component `{component.name}`")


@rule("unique-variable")
def unique_variable(base: rsc.Base) -> Iterator[Finding]:
    """No variable of a component has the name of another one, or of a state: `Component.name` reaches both."""
    for component, behaviour in behaviours(base):
        where = f"component `{component.name}`"
        first: dict[str, rsc.AccessibleItem] = {}
        states = set()
        for definition in behaviour.automaton.definitions:
            if isinstance(definition, rsc.Variable) and definition.name in first:
                yield declared_again("variable", definition, first[definition.name], where)
            elif isinstance(definition, rsc.State) and definition.name not in states:
                states.add(definition.name)
                if definition.name in first:
                    yield declared_again("state", definition, first[definition.name], where)
            if isinstance(definition, (rsc.Variable, rsc.State)):
                first.setdefault(definition.name, definition)


@rule("unique-property")
def unique_property(base: rsc.Base) -> Iterator[Finding]:
    """No object has two properties of one name, and a provided object names each property once."""
    for definition in base.definitions:
        if isinstance(definition, rsc.ObjectDataType):
            for second, first in repeated(definition.properties):
                yield declared_again("property", second, first, f"object `{definition.name}`")
        elif isinstance(definition, rsc.ProvideStatement):
            yield from _provided_again(definition.data)


def _provided_again(value: ex.Expression) -> Iterator[Finding]:
    if not isinstance(value, rsc.ObjectValue):
        return
    named = set()
    for given in value.properties:
        if given.property is not None and given.property in named:
            yield Finding(
                given,
                f"property `{given.property.name}` has a value already, expected one for each property",
                "leave one of the two out",
            )
        named.add(given.property)
        yield from _provided_again(given.value)


def repeated(elements: Iterable[ex.NamedElement]) -> Iterator[tuple[ex.NamedElement, ex.NamedElement]]:
    """Each element whose name an earlier one has, with the first that has it."""
    first: dict[str, ex.NamedElement] = {}
    for element in elements:
        if element.name and first.setdefault(element.name, element) is not element:
            yield element, first[element.name]


def declared_again(kind: str, second: ex.NamedElement, first: ex.NamedElement, where: str) -> Finding:
    """The finding at a declaration whose name is taken."""
    named_types = (rsc.State, rsc.Variable)
    same = not isinstance(first, named_types) or type(first) is type(second)
    other = f"another {kind}" if same else f"a {type(first).__name__.lower()}"
    return Finding(
        second,
        f"{kind} `{second.name}` has the name of {other}{on_line(first)}, expected a name of its own in {where}",
        f"rename one of the two, such as `{second.name}_2`",
    )


def on_line(element: ex.Located) -> str:
    """` (line 12)`, or nothing where the element comes from no text."""
    return f" (line {element.source.span.line})" if element.source else ""
