"""What makes the names of a robosc model mean something, as linking sees to it in a text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.metamodel import robosc
from robosc.semantics.typing import UNKNOWN, ObjectType, access_types, declared_type, provided_data_type, value_type

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

Fault = tuple[Any, str]


def robosc_faults(elements: Sequence[Any]) -> Iterator[Fault]:
    """What references of these elements can't mean: another component's state, a property of another object."""
    imports = [element for element in elements if isinstance(element, robosc.ImportedComponent)]
    broken = [fault for imported in imports for fault in _import_faults(imported)]
    if broken:
        yield from broken
        return
    for element in elements:
        match element:
            case robosc.Transition() if element.target is not None:
                if element.target.eContainer() is not _around(element, robosc.Automaton):
                    yield element, f"the target '{element.target.name}' is another component's state"
            case robosc.CommunicationReference():
                yield from _communication_faults(element)
            case robosc.ComplexDataTypeReference():
                yield from _type_faults(element)
            case robosc.Access():
                yield from _access_faults(element)
            case robosc.ObjectPropertyValue():
                yield from _property_faults(element)


def _import_faults(imported: robosc.ImportedComponent) -> Iterator[Fault]:
    if imported.definition.eContainer() is not imported.library:
        yield imported, f"'{imported.definition.name}' is no component of {imported.library.name}"
        return
    seen, component = {_around(imported, robosc.Component)}, imported.definition
    while isinstance(component.type, robosc.ImportedComponent):
        if component in seen:
            yield imported, f"'{component.name}' is imported from itself"
            return
        seen.add(component)
        component = component.type.definition
    own = _definitions(imported.definition)
    for remapping in imported.remappings:
        if remapping.communicationType not in own:
            yield remapping, f"'{remapping.communicationType.name}' is no communication of {imported.definition.name}"


def _communication_faults(reference: robosc.CommunicationReference) -> Iterator[Fault]:
    component = _owner(reference)
    if component is None:
        yield reference, f"it does not say whose '{reference.communicationType.name}' is meant"
    elif reference.communicationType not in _definitions(component):
        yield reference, f"'{reference.communicationType.name}' is no communication of '{component.name}'"


def _type_faults(reference: robosc.ComplexDataTypeReference) -> Iterator[Fault]:
    home = reference.type.eContainer()
    if isinstance(reference, robosc.InterfaceTypeReference):
        if reference.type is not reference.definition:
            yield reference, f"it is to name the object that stands for {reference.package}/{reference.rosType}"
    elif not isinstance(home, robosc.Base):
        yield reference, f"'{reference.type.name}' is no data type of a robot or library"


def _access_faults(access: robosc.Access) -> Iterator[Fault]:
    item = access.item
    if isinstance(item, (robosc.State, robosc.Variable)):
        component = _owner(access)
        if component is None:
            yield access, f"it does not say whose '{item.name}' is meant"
            return
        automata = [
            definition.automaton
            for definition in _definitions(component)
            if isinstance(definition, robosc.ComponentBehaviour)
        ]
        if item.eContainer() not in automata:
            yield access, f"'{item.name}' is no state or variable of '{component.name}'"
            return
    elif access.component is not None:
        yield access, "only a state or a variable is one of a component"
        return
    types = access_types(access, value_type(access))
    for before, segment in zip(types, access.segments, strict=False):
        if isinstance(segment, robosc.PropertySegment):
            yield from _member_faults(segment, before)


def _property_faults(element: robosc.ObjectPropertyValue) -> Iterator[Fault]:
    around: Any = element.eContainer()
    around = around.eContainer()
    if isinstance(around, robosc.ProvideStatement):
        yield from _member_faults(element, provided_data_type(around.communicationType.communicationType))
    elif isinstance(around, robosc.ObjectPropertyValue):
        yield from _member_faults(element, declared_type(around.property.type))


def _member_faults(element: Any, of: Any) -> Iterator[Fault]:
    if of is not UNKNOWN and not (isinstance(of, ObjectType) and element.property in of.definition.properties):
        yield element, f"'{element.property.name}' is no property of {of}"


def _owner(reference: robosc.CommunicationReference | robosc.Access) -> robosc.Component | None:
    """The component of which a reference speaks; None where it can't: a library's text speaks of its own one only."""
    around: robosc.Component | None = _around(reference, robosc.Component)
    base = _around(reference, robosc.Base)
    component = reference.component or around
    if component is None or component.eContainer() is not base:
        return None
    return component if component is around or isinstance(base, robosc.Robot) else None


def _definitions(component: robosc.Component) -> Sequence[Any]:
    """What a component's text defines, wherever that is; imports go round in no circle."""
    kind = component.type
    while isinstance(kind, robosc.ImportedComponent):
        kind = kind.definition.type
    return kind.definitions if isinstance(kind, robosc.LocalComponent) else ()


def _around(element: Any, kind: type) -> Any:
    """The nearest element of a kind around another; None where there is none."""
    around = element.eContainer()
    while around is not None and not isinstance(around, kind):
        around = around.eContainer()
    return around
