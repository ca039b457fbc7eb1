"""Gives every name the element that it stands for, or says that there is none."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

from robosc.language.explaining import BASIC_TYPES, did_you_mean
from robosc.language.interface_types import declare, is_made, link_interface, ros_properties, ros_property
from robosc.language.scopes import Declared, File, Names, Scope, by_name
from robosc.language.text import Repair
from robosc.metamodel import expression as ex
from robosc.metamodel import robosc as rsc
from robosc.semantics.naming import enumeration, written
from robosc.semantics.typing import (
    UNKNOWN,
    ArrayType,
    EnumType,
    ObjectType,
    Type,
    declared_type,
    provided_data_type,
    segment_type,
    start_type,
    value_type,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from robosc.diagnostics import Diagnostic
    from robosc.language.building import Name
    from robosc.ros_types import RosTypes
    from robosc.semantics.instances import Resolved

_Element = TypeVar("_Element")
RULE = "unresolved-reference"
#: So many names are listed where none of them is close to the one that is not there.
_FEW = 6
OWN_MEMBERS = "a library's component speaks of its own members only"


def link(file: File, interfaces: RosTypes, resolved: Resolved) -> list[Diagnostic]:
    """Resolves the names of a file, whose libraries are read and linked; returns a finding for each that can't be.

    `interfaces` is what is known of the ROS types that take the place of objects, `resolved` what is known of the
    components of the libraries; it is added to.

    A name without element leaves its feature unset. A name that stands or falls with another one that is not
    resolved, or that text with a syntax error may declare, draws no finding of its own.
    """
    if file.base is None:
        return []
    linker = _Linker(file, interfaces)
    linker.imports()
    linker.link(Scope(file, file.base, resolved))
    return linker.findings


class _Linker:
    def __init__(self, file: File, interfaces: RosTypes) -> None:
        self.findings: list[Diagnostic] = []
        self._interfaces = interfaces
        self._file = file
        self._scope: Scope
        self._definitions: dict[ex.Located, ex.Located] = {}
        self._types: dict[rsc.Access, list[Type]] = {}
        self._properties: dict[rsc.ObjectDataType, Names] = {}
        self._is_library = isinstance(file.base, rsc.Library)

    def imports(self) -> None:
        """The components that are imported: all other names may look into them."""
        for element, names in self._file.references.items():
            if isinstance(element, rsc.ImportedComponent):
                self._import(element, names)

    def link(self, scope: Scope) -> None:
        """What declarations name, then what uses them, in the order of the text: each looks at what stands before."""
        self._scope = scope
        for element, names in self._file.references.items():
            self._declaration(element, names)
        for component in self._file.declared[rsc.Component].values():
            if isinstance(component.type, rsc.LocalComponent):
                for definition in component.type.definitions:
                    linked = "interface" in self._file.references.get(definition, ())
                    if isinstance(definition, rsc.CommunicationType) and not linked:
                        link_interface(definition)
        for element, names in list(self._file.references.items()):
            self._use(element, names)

    def _declaration(self, element: ex.Located, names: Mapping[str, Name]) -> None:
        match element:
            case rsc.CommunicationType():
                name = names["interface"]
                element.interface = self._definition(rsc.Interface, "interface", Declared.INTERFACE, name)
            case rsc.InterfaceTypeReference():
                unknown = declare(element, self._interfaces)
                if unknown is not None:
                    self._report(names["type"], *unknown)
            case rsc.ComplexDataTypeReference():
                name = names["type"]
                found = self._definition(rsc.ComplexDataType, "object or enum", Declared.DATA_TYPE, name)
                if found is not None:
                    element.type = found

    def _use(self, element: ex.Located, names: Mapping[str, Name]) -> None:
        match element:
            case rsc.TopicRemapping():
                self._remapping(element, names["communicationType"])
            case rsc.CommunicationReference():
                self._communication(element, names)
            case rsc.Transition():
                self._target(element, names["target"])
            case rsc.Access():
                self._access(element, names)
            case rsc.PropertySegment():
                self._segment(element, names["property"])
            case rsc.ObjectPropertyValue():
                self._property_value(element, names["property"])

    # Imports and definitions

    def _import(self, element: rsc.ImportedComponent, names: Mapping[str, Name]) -> None:
        library = self._file.libraries.get(names["library"].text)
        if library is None or not isinstance(library.base, rsc.Library):
            return  # Whoever looked for the library has said why there is none.
        element.library = library.base
        components, name = library.declared[rsc.Component], names["definition"]
        if name.text in components:
            element.definition = components[name.text]
        elif not library.may_declare(name.text, Declared.COMPONENT, imported=False):
            self._missing(name, f"library `{library.base.name}` has no component", components)

    def _definition(self, kind: type[_Element], what: str, declared: Declared, name: Name) -> _Element | None:
        found = self._scope.find(kind, name.text)
        if len(found) > 1:
            self._ambiguous(what, name, [file for file, _ in found])
        elif not found and not self._file.may_declare(name.text, declared):
            basic = BASIC_TYPES.get(name.text)
            hint = Repair(f"write `{basic}`", basic) if basic else None
            self._missing(name, f"there is no {what}", self._scope.usable(kind), hint)
        return found[0][1] if len(found) == 1 else None

    def _ambiguous(self, what: str, name: Name, files: Iterable[File]) -> None:
        libraries = " and ".join(f"`{file.base.name}`" for file in files if file.base)
        message = f"{what} `{name.text}` is declared by the libraries {libraries}"
        self._report(name, message, f"declare `{name.text}` in this file")

    def _remapping(self, remapping: rsc.TopicRemapping, name: Name) -> None:
        component = self._around(remapping, rsc.Component)
        if component is not None:
            remapping.communicationType = self._communication_of(component, name)

    def _communication_of(self, component: rsc.Component, name: Name) -> Any:
        communications = self._scope.communications(component)
        return None if communications is None else self._member(communications, name, component, Declared.COMMUNICATION)

    # Communication

    def _communication(self, reference: rsc.CommunicationReference, names: Mapping[str, Name]) -> None:
        name = names["communicationType"]
        if "component" in names:
            component = self._component(reference, names["component"])
            if component is not None:
                reference.component = component
                reference.communicationType = self._communication_of(component, name)
            return
        found = self._bare_communication(reference, name)
        if found is not None:
            reference.component, reference.communicationType = found

    def _bare_communication(
        self, reference: rsc.CommunicationReference, name: Name
    ) -> tuple[rsc.Component, rsc.CommunicationType] | None:
        own = self._around(reference, rsc.Component)
        if own is not None:
            communications = self._scope.communications(own) or {}
            if name.text in communications:
                return own, communications[name.text]
            if self._is_library:
                if not self._file.may_declare(name.text, Declared.COMMUNICATION, imported=False):
                    self._missing(name, f"component `{own.name}` has no communication", communications, OWN_MEMBERS)
                return None
        found = self._scope.communicating(name.text)
        if not found:
            if not self._scope.incomplete and not self._file.may_declare(name.text, Declared.COMMUNICATION):
                self._missing(name, "there is no communication", self._scope.all_communications())
            return None
        if len({communication for _, communication in found}) < len(found):
            candidates = " or ".join(f"`{written(component.name)}.{written(name.text)}`" for component, _ in found)
            self._report(name, f"`{name.text}` is ambiguous: it may be {candidates}", f"write {candidates}")
            return None
        return found[0]

    def _component(self, reference: rsc.CommunicationReference, name: Name) -> rsc.Component | None:
        components = self._components(reference)
        component: rsc.Component | None = components.get(name.text)
        if component is None and not self._file.may_declare(name.text, Declared.COMPONENT, imported=False):
            hint = OWN_MEMBERS if name.text in self._scope.components else None
            self._missing(name, "there is no component", components, hint)
        return component

    def _components(self, element: ex.Located) -> Names:
        """The components that can be mentioned where an element stands: in a library each mentions itself only."""
        own = self._around(element, rsc.Component)
        return {own.name: own} if own is not None and self._is_library else self._scope.components

    def _member(self, members: Names, name: Name, component: rsc.Component, declared: Declared) -> Any:
        found = members.get(name.text)
        if found is None and not self._file.may_declare_within(self._scope.origin(component), name.text, declared):
            what = "communication" if declared is Declared.COMMUNICATION else "variable or state"
            values = [] if declared is Declared.COMMUNICATION else self._scope.find(rsc.EnumValue, name.text)
            hint = self._value_of_enum(name, values[0][1]) if values else None
            self._missing(name, f"component `{component.name}` has no {what}", members, hint)
        return found

    @staticmethod
    def _value_of_enum(name: Name, value: rsc.EnumValue) -> str:
        enum = value.eContainer().eContainer()
        return f"`{written(name.text)}` is a value of `{written(enum.name)}`: write it without a component"

    def _target(self, transition: rsc.Transition, name: Name) -> None:
        own = self._around(transition, rsc.Component)
        states = self._scope.states(own) if own is not None else {}
        if name.text in states:
            transition.target = states[name.text]
        elif own is not None and not self._file.may_declare_within(own, name.text, Declared.MEMBER):
            self._missing(name, f"component `{own.name}` has no state", states)

    # Expressions

    def _access(self, access: rsc.Access, names: Mapping[str, Name]) -> None:
        first = names.get("component", names["item"])
        components = self._components(access)
        if self._around(access, rsc.EnumDataType) is not None:
            if not self._enum_value(access, first) and not self._file.may_declare(first.text, Declared.ENUM_VALUE):
                hint = "an enum's rules see only `value`, literals and enum values"
                self._missing(first, "there is no enum value", self._scope.usable(rsc.EnumValue), hint)
        elif "component" in names and first.text in components:
            self._qualified(access, components[first.text], names["item"])
            return
        else:
            self._bare(access, first, qualifies="component" in names)
        if "component" in names:
            self._read_as_property(access, names["item"])

    def _qualified(self, access: rsc.Access, component: rsc.Component, name: Name) -> None:
        access.component = component
        members = self._scope.members(component)
        if members is not None:
            access.item = self._member(members, name, component, Declared.MEMBER)

    def _bare(self, access: rsc.Access, name: Name, *, qualifies: bool) -> None:
        """A component, a variable of the own component, a state of the own component, an enum value, in this order."""
        own = self._around(access, rsc.Component)
        members = (self._scope.members(own) if own is not None else None) or {}
        components = self._components(access)
        if name.text in components:
            access.item = components[name.text]
            return
        if name.text in members:
            access.component, access.item = own, members[name.text]
            return
        own_text = Declared.COMPONENT, Declared.MEMBER
        if self._enum_value(access, name) or self._file.may_declare(name.text, *own_text, imported=False):
            return
        if qualifies:
            hint = OWN_MEMBERS if name.text in self._scope.components else None
            self._missing(name, "there is no component or variable", [*components, *members], hint)
        elif not self._file.may_declare(name.text, Declared.ENUM_VALUE):
            known = [*components, *members, *self._scope.usable(rsc.EnumValue)]
            hint = OWN_MEMBERS if self._is_library and self._elsewhere(name) else self._elsewhere(name)
            self._missing(name, "there is no component, variable, state or enum value", known, hint, listed=False)

    def _elsewhere(self, name: Name) -> str | None:
        """What to write for a bare name that some component has as a variable or a state."""
        having = [
            f"`{written(component.name)}.{written(name.text)}`"
            for component in self._scope.components.values()
            if name.text in (self._scope.members(component) or {})
        ]
        return f"write {' or '.join(having)}" if having else None

    def _enum_value(self, access: rsc.Access, name: Name) -> bool:
        """Whether a name is that of an enum value, or of several, which is a finding."""
        values = self._scope.find(rsc.EnumValue, name.text)
        if len(values) > 1:
            self._ambiguous("enum value", name, [file for file, _ in values])
        elif values:
            access.item = values[0][1]
        return bool(values)

    def _read_as_property(self, access: rsc.Access, name: Name) -> None:
        """`a.b`, where `a` turned out to be no component: then `b` is a property of it."""
        start = self._file.text.content.rfind(".", 0, name.start)
        segment = rsc.PropertySegment(source=self._file.text.source(start, name.end))
        access.segments.insert(0, segment)
        names = self._file.references
        names[access], names[segment] = {"item": names[access]["component"]}, {"property": name}
        self._segment(segment, name)

    # Properties

    def _segment(self, segment: rsc.PropertySegment, name: Name) -> None:
        access = segment.eContainer()
        # The segments of an access come in their order: each goes on from the one before.
        if access not in self._types:
            self._types[access] = [start_type(access, value_type(access))]
        types = self._types[access]
        while access.segments[len(types) - 1] is not segment:
            types.append(segment_type(types[-1], access.segments[len(types) - 1]))
        found = self._property(types[-1], name)
        if found is not None:
            segment.property = found

    def _property_value(self, element: rsc.ObjectPropertyValue, name: Name) -> None:
        around = element.eContainer().eContainer()
        if isinstance(around, rsc.ProvideStatement):
            expected = provided_data_type(around.communicationType.communicationType)
        else:
            expected = declared_type(around.property.type) if around.property else UNKNOWN
        # Whether an object fits here at all is a question of types, not of names.
        found = self._property(expected, name) if isinstance(expected, ObjectType) else None
        if found is not None:
            element.property = found

    def _property(self, of: Type, name: Name) -> rsc.ObjectProperty | None:
        if of == UNKNOWN:
            return None
        if not isinstance(of, ObjectType):
            what = (
                "an enum" if isinstance(of, EnumType) else "an array" if isinstance(of, ArrayType) else f"of type {of}"
            )
            hint = f"write an index before it: `[0].{name.text}`" if isinstance(of, ArrayType) else None
            self._report(name, f"there is no property `{name.text}`: what stands before it is {what}", hint)
            return None
        if is_made(of.definition):
            made = ros_property(of.definition, name.text, self._interfaces)
            if made is None:
                known = ros_properties(of.definition, self._interfaces)
                self._missing(
                    name, f"the ROS type `{of.definition.name}` has no field that a model can use named", known
                )
            return made
        if of.definition not in self._properties:
            self._properties[of.definition] = by_name(of.definition.properties)
        properties = self._properties[of.definition]
        if name.text in properties:
            found: rsc.ObjectProperty = properties[name.text]
            return found
        if not self._file.may_declare_within(of.definition, name.text, Declared.PROPERTY):
            self._missing(name, f"object `{of.definition.name}` has no property", properties)
        return None

    def _around(self, element: ex.Located, kind: type[_Element]) -> _Element | None:
        """The component or enum that contains the element, if it is of that kind."""
        path: list[ex.Located] = []
        around = element
        # What is between two names of a long expression is climbed once.
        while around is not None and around not in self._definitions and not isinstance(around, rsc.Definition):
            path.append(around)
            around = around.eContainer()
        definition = self._definitions.get(around, around)
        self._definitions.update(dict.fromkeys(path, definition))
        return definition if isinstance(definition, kind) else None

    # Findings

    def _missing(
        self,
        name: Name,
        message: str,
        known: Iterable[str],
        hint: Repair | str | None = None,
        *,
        listed: bool = True,
    ) -> None:
        names = list(dict.fromkeys(known))
        repair = hint or did_you_mean(name.text, names, cutoff=0.6)
        if repair is None and listed and 0 < len(names) <= _FEW:
            repair = f"there is {enumeration(f'`{written(other)}`' for other in names)}"
        self._report(name, f"{message} `{name.text}`", repair)

    def _report(self, name: Name, message: str, repair: Repair | str | None = None) -> None:
        if not self._file.regions.is_uncertain(name.start):
            self.findings.append(self._file.text.error(RULE, name.start, name.end, message, repair))
