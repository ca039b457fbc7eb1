"""Checks of the names in a robosc model, which linking ensures in a text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.model import robosc
from robosc.model.semantics.typing import (
    UNKNOWN,
    ObjectType,
    access_types,
    object_value_type,
    value_type,
)
from robosc.model.validity.model_checks import around, demand

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from robosc.model.validity.model_checks import Checks, Fault, Model


def _check_instance(
    instantiation: robosc.InstantiatedComponent | robosc.ImportedComponent, _model: Model
) -> Iterator[Fault]:
    user = around(instantiation, robosc.Component)
    if user is not None and user.parameters:
        yield instantiation, f"the template '{user.name}' has no content of its own"
        return
    seen, component = {user}, instantiation.definition
    while isinstance(component.type, robosc.InstantiatedComponent | robosc.ImportedComponent):
        if component in seen:
            yield instantiation, f"'{component.name}' contains itself"
            return
        seen.add(component)
        component = component.type.definition
    if isinstance(instantiation, robosc.ImportedComponent):
        yield from _import(instantiation)
    elif not instantiation.definition.parameters:
        yield instantiation, f"'{instantiation.definition.name}' is not a template"


def _import(imported: robosc.ImportedComponent) -> Iterator[Fault]:
    if imported.definition.eContainer() is not imported.library:
        yield imported, f"'{imported.definition.name}' is not a component of {imported.library.name}"
        return
    own = _definitions(imported.definition)
    for remapping in imported.remappings:
        if remapping.communicationType not in own:
            yield (
                remapping,
                f"'{remapping.communicationType.name}' is not a communication of {imported.definition.name}",
            )


def _communication(reference: robosc.CommunicationReference, _model: Model) -> Iterator[Fault]:
    component = _owner(reference)
    if component is None:
        yield reference, f"the component of '{reference.communicationType.name}' is missing"
    elif reference.communicationType not in _definitions(component):
        yield reference, f"'{reference.communicationType.name}' is not a communication of '{component.name}'"
    yield from _index(reference)


def _index(reference: robosc.CommunicationReference | robosc.Access) -> Iterator[Fault]:
    """Check that a fleet has an index, and any other component none."""
    item = reference.item if isinstance(reference, robosc.Access) else None
    if isinstance(item, robosc.RequirementState):
        return
    component = reference.component or item
    is_fleet = isinstance(component, robosc.Component) and component.first is not None
    if is_fleet != (reference.index is not None):
        yield reference, "an index follows the name of a fleet, and only that"


def _fleet(component: robosc.Component, _model: Model) -> Iterator[Fault]:
    parts = (component.first, component.last, component.number)
    if len({part is None for part in parts}) > 1:
        yield component, f"the fleet '{component.name}' lacks its first or last instance or its number"
    elif component.first is not None and (component.parameters or isinstance(component.type, robosc.LocalComponent)):
        yield component, f"the fleet '{component.name}' has a text or parameters of its own"


def _each(definition: robosc.StatedDefinition, _model: Model) -> Iterator[Fault]:
    template = definition.template
    if template is None or template.parameters:
        return
    if template.eContainer() is around(definition, robosc.Base):
        yield definition, f"'{template.name}' is not a template"


def _running(access: robosc.Access, item: robosc.CommunicationType) -> Iterator[Fault]:
    component = _owner(access)
    if component is None:
        yield access, f"the component of '{item.name}' is missing"
    elif item not in _definitions(component):
        yield access, f"'{item.name}' is not a communication of '{component.name}'"
    elif isinstance(item, robosc.Message):
        yield access, f"'{item.name}' is a message: only a service or an action is running"


def _access(access: robosc.Access, _model: Model) -> Iterator[Fault]:
    item = access.item
    yield from _index(access)
    if isinstance(item, (robosc.State, robosc.Variable)):
        component = _owner(access)
        if component is None:
            yield access, f"the component of '{item.name}' is missing"
            return
        behaviours = [part for part in _definitions(component) if isinstance(part, robosc.ComponentBehaviour)]
        if item.eContainer() not in [behaviour.automaton for behaviour in behaviours]:
            yield access, f"'{item.name}' is not a state or variable of '{component.name}'"
            return
    elif isinstance(item, robosc.CommunicationType):
        yield from _running(access, item)
        return
    elif access.component is not None and item not in _definitions(access.component):
        yield access, "only a state, a variable, a constant or a condition is one of a component"
        return
    types = access_types(access, value_type(access))
    for before, segment in zip(types, access.segments, strict=False):
        if isinstance(segment, robosc.PropertySegment):
            yield from _member(segment, before)


def _property(element: robosc.ObjectPropertyValue, _model: Model) -> Iterator[Fault]:
    owner: Any = element.eContainer()
    yield from _member(element, object_value_type(owner))


def _member(element: Any, of: Any) -> Iterator[Fault]:
    if of is not UNKNOWN and not (isinstance(of, ObjectType) and element.property in of.definition.properties):
        yield element, f"'{element.property.name}' is not a property of {of}"


def _owner(reference: robosc.CommunicationReference | robosc.Access) -> robosc.Component | None:
    """Return the component that a reference refers to. None if it is not allowed.

    A library's text refers only to its own component.
    """
    own: robosc.Component | None = around(reference, robosc.Component)
    base = around(reference, robosc.Base)
    component = reference.component or own
    if component is not None and _stands_for_an_instance(component, reference):
        return component
    if component is None or component.eContainer() is not base:
        return None
    named = isinstance(base, robosc.Robot) and not component.parameters
    return component if component is own or named else None


def _stands_for_an_instance(component: robosc.Component, reference: Any) -> bool:
    """Return whether a component stands for its instances: in an `all`, `any` or `count`, or a text with `each`."""
    definition: Any = around(reference, robosc.StatedDefinition)
    if definition is not None and definition.template is component:
        return True
    quantifier: Any = around(reference, robosc.InstanceQuantifier)
    while quantifier is not None and quantifier.template is not component:
        quantifier = around(quantifier, robosc.InstanceQuantifier)
    return quantifier is not None


def _definitions(component: robosc.Component) -> Sequence[Any]:
    """Return the definitions in a component's text. Precondition: imports are not circular."""
    kind = component.type
    while isinstance(kind, robosc.InstantiatedComponent | robosc.ImportedComponent):
        kind = kind.definition.type
    return kind.definitions if isinstance(kind, robosc.LocalComponent) else ()


_OWN_TARGET = demand(
    lambda transition: (
        transition.target is None or transition.target.eContainer() is around(transition, robosc.Automaton)
    ),
    "the target '{0.target.name}' is another component's state",
)
_DATA_TYPE = demand(
    lambda reference: (
        isinstance(reference, robosc.InterfaceTypeReference) or isinstance(reference.type.eContainer(), robosc.Base)
    ),
    "'{0.type.name}' is not a data type of a robot or library",
)
_OWN_OBJECT = demand(
    lambda reference: reference.type is reference.definition,
    "it must name the object for {0.package}/{0.rosType}",
)

#: The other checks follow imports. They are skipped if an import is broken.
IMPORT_CHECKS: Checks = {robosc.InstantiatedComponent: [_check_instance], robosc.ImportedComponent: [_check_instance]}
CHECKS: Checks = {
    robosc.Component: [_fleet],
    robosc.StatedDefinition: [_each],
    robosc.Transition: [_OWN_TARGET],
    robosc.CommunicationReference: [_communication],
    robosc.ComplexDataTypeReference: [_DATA_TYPE],
    robosc.InterfaceTypeReference: [_OWN_OBJECT],
    robosc.Access: [_access],
    robosc.ObjectPropertyValue: [_property],
}
