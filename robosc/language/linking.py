"""Links every name to the element that it refers to, and reports names without an element."""

from __future__ import annotations

from collections import ChainMap
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeVar

from robosc.base.diagnostics import Related, Repair
from robosc.base.interruption import checkpoint
from robosc.base.ros_types.wire import FOLDERS
from robosc.language.failures import expects_failure
from robosc.language.interface_types import declare, is_made, link_interface, ros_properties, ros_property
from robosc.language.ros_constants import constants_of, literal, used_types
from robosc.language.scopes import File, NameKind, Names, Scope, by_name
from robosc.language.spellings import NEGATION, folder
from robosc.language.syntax_messages import BASIC_TYPES, CONSTRUCTS, did_you_mean
from robosc.model import expression as ex
from robosc.model import robosc as rsc
from robosc.model.reflection import tree
from robosc.model.semantics.communication import RUNNING_WORD, section_of
from robosc.model.semantics.expansion import constant_value
from robosc.model.semantics.failures import FAILURE, FAILURES
from robosc.model.semantics.naming import NUMBER, TEXT_FUNCTION, enumeration, escape_keyword, instance_text
from robosc.model.semantics.operators import FUNCTIONS
from robosc.model.semantics.typing import (
    UNKNOWN,
    ArrayType,
    EnumType,
    ObjectType,
    Type,
    object_value_type,
    segment_type,
    start_type,
    value_type,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from robosc.base.diagnostics import Diagnostic
    from robosc.base.ros_types import RosTypes
    from robosc.language.builder import Name
    from robosc.language.tokens import Token
    from robosc.model.places import Place

_Element = TypeVar("_Element")
RULE = "unresolved-reference"
#: Maximum number of names that a hint lists.
_FEW = 6
#: Hint for a call of an unknown function.
_FUNCTION = (
    f"there is {enumeration(f'`{name}`' for name in sorted(FUNCTIONS))}; others are declared, such as "
    "`function half(d: double): double = d / 2`"
)
_OWN_TEXT = "write its content directly"
_IMPORT = "import it: "
_OWN_CONSTANT = "declare a `constant` with the value"
#: Minimum length of a name for the import hint: shorter names are parts of too many others.
_SHORTEST = 4
OWN_MEMBERS = "a component of a library reads only its own members"
#: Hint for conditions and functions outside the components of a library.
_ANY_NUMBER = "a robot may import a component several times or never: write this in the component"


def link(file: File, interfaces: RosTypes, importable: Callable[[], Mapping[str, str]]) -> list[Diagnostic]:
    """Link the names of a file whose libraries are linked, and return a finding for each name that has no element.

    `interfaces` has the ROS types that can take the place of objects. `importable` returns the components that can be
    imported, with their libraries.

    The feature of an unlinked name stays unset. There is no finding for a name that depends on another unlinked name,
    or that text with a syntax error may declare.
    """
    if file.base is None:
        return []
    linker = Linker(file, interfaces, importable)
    linker.imports()
    linker.link(Scope(file, file.base))
    return _by_cause(linker.findings)


def _by_cause(findings: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Merge the findings of each missing import into the first one, with the other uses as related places."""
    by_cause: dict[Any, Diagnostic] = {}
    for finding in findings:
        key = finding.hint if finding.hint is not None and finding.hint.startswith(_IMPORT) else finding
        if key in by_cause:
            other = Related(finding.file, finding.span, "this is the same name")
            by_cause[key] = replace(by_cause[key], related=(*by_cause[key].related, other))
        else:
            by_cause[key] = finding
    return list(by_cause.values())


def _basic_type(name: str) -> Repair | None:
    """Return the repair that writes the basic type for a type of another language; None if there is none.

    A type with a size, such as `uint8`, is only offered: it states the type in ROS, which may differ.
    """
    basic = BASIC_TYPES.get(name)
    if basic is None:
        return None
    hint = f"write `{basic}`"
    return Repair(hint, choices=(basic,)) if name[-1].isdigit() else Repair(hint, basic)


class Linker:
    """Links one file whose libraries are linked, and looks up the names that are usable in it.

    `scope` has the names of the file's base.
    """

    def __init__(
        self, file: File, interfaces: RosTypes, importable: Callable[[], Mapping[str, str]] = dict[str, str]
    ) -> None:
        self.findings: list[Diagnostic] = []
        self.interfaces = interfaces
        self._importable = importable
        self._file = file
        self.scope: Scope
        self._definitions: dict[ex.Located, ex.Located] = {}
        self._types: dict[rsc.Access, list[Type]] = {}
        self._properties: dict[rsc.ObjectDataType, Names] = {}
        self._is_library = isinstance(file.base, rsc.Library)
        self._present: set[type] = {type(element) for element in (*file.references, *file.declared_names)}
        if any(isinstance(element, rsc.StatedDefinition) for element in file.references):
            self._present.add(rsc.StatedDefinition)
        #: Elements in the index of an instance, which is linked before the instance.
        self._linked: set[ex.Located] = set()
        self._nearests: dict[type, dict[ex.Located, Any]] = {}
        self._quantifiers: dict[ex.Located, rsc.ArrayQuantifier | None] = {}

    def open_scope(self) -> None:
        """Set the scope of a file that is already linked."""
        assert self._file.base is not None
        self.scope = Scope(self._file, self._file.base)

    def imports(self) -> None:
        """Link the imported and instantiated components, which all other names may need."""
        for element, names in self._file.references.items():
            if isinstance(element, rsc.ComponentType) and element.eContainer().parameters:
                template = escape_keyword(element.eContainer().name)
                message = f"template `{template}` is an instance of `{names['definition'].text}`, expected its own text"
                self._report(names["definition"], message, _OWN_TEXT, rule="argument")
            elif isinstance(element, rsc.ImportedComponent):
                self._import(element, names)
            elif isinstance(element, rsc.InstantiatedComponent):
                self._instantiation(element, names["definition"])

    def link(self, scope: Scope) -> None:
        """Link the names in declarations, then those in uses, in the order of the text.

        A name may need the names before it.
        """
        self.scope = scope
        for element, names in self._file.references.items():
            self._declaration(element, names)
        for component in self._file.base.definitions if self._file.base is not None else ():
            # A component with a duplicate name is linked too; the duplicate is a finding of its own.
            if isinstance(component, rsc.Component) and isinstance(component.type, rsc.LocalComponent):
                for definition in component.type.definitions:
                    linked = "interface" in self._file.references.get(definition, ())
                    if isinstance(definition, rsc.CommunicationType) and not linked:
                        link_interface(definition)
        self._uses()
        for declared in self._file.bounded:
            low, high = constant_value(declared.lower), constant_value(declared.upper)
            if type(low) is int and type(high) is int:
                declared.minimum, declared.maximum = low, high

    def _uses(self) -> None:
        """Link the names that use declarations; bare reasons last: they depend on the other names."""
        reasons: dict[rsc.Access, Mapping[str, Name]] = {}
        for element, names in list(self._file.references.items()):
            checkpoint()
            if isinstance(element, rsc.Access) and self._may_be_reason(element):
                reasons[element] = names
            elif element in self._file.references and element not in self._linked:  # `.running` is not a property
                self._use(element, names)
        for access, bare in reasons.items():
            self._reason(access, bare)

    def _may_be_reason(self, element: ex.Located) -> bool:
        """Return whether a bare name is a value of `Failure` if the text expects one there."""
        is_bare = self._file.predefined is not None and self._is_bare(element)
        return is_bare and self._file.references[element]["item"].text in FAILURES

    def expects_failure(self, element: ex.Expression) -> bool:
        """Return whether the text expects a reason of an error at the position of an expression."""
        return self._file.predefined is not None and expects_failure(element, self._is_bare)

    def _is_bare(self, element: ex.Located) -> bool:
        if not isinstance(element, rsc.Access) or element.value or element.segments:
            return False
        return "component" not in self._file.references.get(element, {})

    def _reason(self, access: rsc.Access, names: Mapping[str, Name]) -> None:
        """Link a bare name that is equal to a value of `Failure`."""
        if not expects_failure(access, self._is_bare):
            self._access(access, names)
            return
        assert self._file.predefined is not None
        access.item = self._file.predefined.declared[rsc.EnumValue][names["item"].text]

    def _declaration(self, element: ex.Located, names: Mapping[str, Name]) -> None:
        match element:
            case rsc.CommunicationType():
                name = names["interface"]
                element.interface = self._definition(rsc.Interface, "interface", NameKind.INTERFACE, name)
                if element.interface is not None:
                    self._folder(element.interface.source, type(element).__name__.lower(), name)
            case rsc.InterfaceTypeReference():
                unknown = declare(element, self.interfaces)
                if unknown is not None:
                    self._report(names["type"], *unknown)
                else:
                    self._folder(element.source, section_of(element).kind, names["type"])
            case rsc.ErrorReason():
                assert self._file.predefined is not None
                element.enumeration = self._file.predefined.declared[rsc.ComplexDataType][FAILURE]
            case rsc.ComplexDataTypeReference():
                name = names["type"]
                definition = self._definition(rsc.ComplexDataType, "object or enum", NameKind.DATA_TYPE, name)
                if definition is not None:
                    element.type = definition

    def _folder(self, source: Place | None, kind: str, name: Name) -> None:
        """Report a folder in the name of a ROS type, such as `msg`, that is not the one of its kind."""
        if source is None:
            return
        text, span = self._file.text, source.span
        if source.file is not text.source_file and source.file is not None:
            text = source.file.parsed.text
        start, end = text.offset(span.line, span.column), text.offset(span.end_line, span.end_column)
        written = folder(text.tokens, start, end)
        if written is not None and written.text != FOLDERS[kind]:
            message = f"`{written.text}` holds no types of the kind {kind}, expected `{FOLDERS[kind]}`"
            self._report(name, message, "leave the folder out, or name another type")

    def _use(self, element: ex.Located, names: Mapping[str, Name]) -> None:
        match element:
            case rsc.TopicRemapping():
                self._remapping(element, names["communicationType"])
            case rsc.CommunicationReference():
                self._communication(element, names)
            case rsc.Transition() | rsc.RequirementTransition():
                self._target(element, names["target"])
            case rsc.Access():
                self._access(element, names)
            case rsc.Argument():
                self._argument(element, names["parameter"])
            case rsc.Call():
                self._call(element, names["function"])
            case rsc.InstanceQuantifier() | rsc.StatedDefinition():
                self._template(element, names["template"])
            case rsc.PropertySegment():
                self._segment(element, names["property"])
            case rsc.ObjectPropertyValue():
                self._property_value(element, names["property"])

    # Imports and definitions

    def _import(self, element: rsc.ImportedComponent, names: Mapping[str, Name]) -> None:
        library = self._file.libraries.get(names["library"].text)
        if library is None or not isinstance(library.base, rsc.Library):
            return  # The search for the library has reported it.
        element.library = library.base
        components, name = library.declared[rsc.Component], names["definition"]
        if name.text in components and components[name.text].first is not None:
            message = f"`{name.text}` is a fleet: only its template or component can be imported"
            definition = components[name.text].type.definition
            hint = None if definition is None else f"import `{escape_keyword(definition.name)}` as a fleet"
            self._report(name, message, hint, rule="argument")
        elif name.text in components:
            element.definition = components[name.text]
        elif not library.may_declare(name.text, NameKind.COMPONENT, imported=False):
            self._missing(name, f"library `{library.base.name}` has no component", components)

    def _instantiation(self, element: rsc.InstantiatedComponent, name: Name) -> None:
        components = self._file.declared[rsc.Component]
        template = components.get(name.text)
        if template is not None and template.parameters:
            element.definition = template
        elif template is not None:
            message = f"component `{name.text}` is not a template: it has no parameters"
            self._report(name, message, _OWN_TEXT, rule="argument")
        elif not self._file.may_declare(name.text, NameKind.COMPONENT, imported=False):
            templates = [component.name for component in components.values() if component.parameters]
            self._missing(name, "there is no template", templates)

    def _argument(self, argument: rsc.Argument, name: Name) -> None:
        user = argument.eContainer()
        made_of = user.type if isinstance(user, rsc.ComplexDataTypeReference) else user.definition
        if not isinstance(made_of, rsc.Component | rsc.EnumDataType):
            return
        parameters = by_name(made_of.parameters)
        if name.text in parameters:
            argument.parameter = parameters[name.text]
        else:
            repair = did_you_mean(name.text, parameters, cutoff=0.6)
            texts = tuple(escape_keyword(other) for other in parameters)
            named = Repair(f"its parameters are {enumeration(f'`{text}`' for text in texts)}", choices=texts)
            self._report(name, f"`{made_of.name}` has no parameter `{name.text}`", repair or named, rule="argument")

    def _call(self, call: rsc.Call, name: Name) -> None:
        own = self.around(call, rsc.Component)
        functions = self.scope.functions(own) if own is not None else {}
        if name.text in functions:
            call.function = functions[name.text]
            return
        matches = self.scope.find(rsc.Function, name.text)
        if len(matches) > 1:
            self._ambiguous("function", name, [file for file, _ in matches])
        elif matches:
            call.function = matches[0][1]
        elif name.text == NEGATION and len(call.arguments) == 1:
            self._substitute(call, ex.Negation(operand=call.arguments[0], source=call.source))
        elif name.text in FUNCTIONS and not self._file.may_declare(name.text, NameKind.NAMED):
            arguments = list(call.arguments)
            self._substitute(call, ex.FunctionCall(function=name.text, arguments=arguments, source=call.source))
        elif name.text == TEXT_FUNCTION and not self._file.may_declare(name.text, NameKind.NAMED):
            self._text(call, name)
        elif not self._file.may_declare(name.text, NameKind.NAMED):
            known = [*functions, *self.scope.usable(rsc.Function), *FUNCTIONS]
            self._missing(name, "there is no function", known, did_you_mean(name.text, known, cutoff=0.6) or _FUNCTION)

    def _substitute(self, element: Any, instead: ex.Expression) -> None:
        """Replace an expression of the model by another one."""
        container, feature = element.eContainer(), element.eContainmentFeature()
        if feature.many:
            siblings = getattr(container, feature.name)
            at = siblings.index(element)
            siblings.remove(element)
            siblings.insert(at, instead)
        else:
            setattr(container, feature.name, instead)
        del self._file.references[element]

    def _text(self, call: rsc.Call, name: Name) -> None:
        """Replace a call of `text` by the digits of its argument."""
        if len(call.arguments) == 1:
            self._substitute(call, rsc.IntegerText(operand=call.arguments[0], source=call.source))
            return
        message = f"`{TEXT_FUNCTION}` has 1 argument, found {len(call.arguments)}"
        self._report(name, message, f"write `{TEXT_FUNCTION}(i)` with an integer `i`", rule="argument")

    def _template(self, user: rsc.InstanceQuantifier | rsc.StatedDefinition, name: Name) -> None:
        """Link the template, or the component of a library, in whose instances a text holds."""
        rule = "argument" if isinstance(user, rsc.StatedDefinition) else RULE
        own = self._file.declared[rsc.Component]
        components = (
            [own[name.text]] if name.text in own else [other for _, other in self.scope.find(rsc.Component, name.text)]
        )
        templates = [component for component in components if component.parameters or name.text not in own]
        if len(templates) == 1:
            user.template = templates[0]
        elif components and not templates:
            hint = f"write the condition with `{escape_keyword(name.text)}` itself"
            origin = self.scope.origin(components[0]).name
            if components[0].first is not None:
                hint = "rename the fleet" if origin == name.text else f"write its template, `{escape_keyword(origin)}`"
            message = f"component `{name.text}` is a component, expected a template or a component of a library"
            self._report(name, message, hint, rule=rule)
        elif not components and not self._file.may_declare(name.text, NameKind.COMPONENT):
            self._missing(
                name, "there is no template", [component.name for component in own.values() if component.parameters]
            )

    def _definition(self, kind: type[_Element], what: str, declared: NameKind, name: Name) -> _Element | None:
        definitions = self.scope.find(kind, name.text)
        if len(definitions) > 1:
            self._ambiguous(what, name, [file for file, _ in definitions])
        elif not definitions and not self._file.may_declare(name.text, declared):
            hint = _basic_type(name.text)
            self._missing(name, f"there is no {what}", self.scope.usable(kind), hint)
        return definitions[0][1] if len(definitions) == 1 else None

    def _ambiguous(self, what: str, name: Name, files: Iterable[File]) -> None:
        libraries = " and ".join(f"`{file.base.name}`" for file in files if file.base)
        message = f"{what} `{name.text}` is declared by the libraries {libraries}"
        self._report(name, message, f"declare `{name.text}` in this file")

    def _remapping(self, remapping: rsc.TopicRemapping, name: Name) -> None:
        component = self.around(remapping, rsc.Component)
        if component is not None:
            remapping.communicationType = self._communication_of(component, name)

    def _communication_of(self, component: rsc.Component, name: Name) -> Any:
        communications = self.scope.communications(component)
        return None if communications is None else self._member(communications, name, component, NameKind.COMMUNICATION)

    # Communication

    def _communication(self, reference: rsc.CommunicationReference, names: Mapping[str, Name]) -> None:
        name = names["communicationType"]
        if "component" in names:
            component = self._component(reference, names["component"])
            if component is not None:
                reference.component = component
                self._indexed(component, reference.index, names["component"], name)
                reference.communicationType = self._communication_of(component, name)
            return
        port = self._bare_communication(reference, name)
        if port is not None:
            reference.component, reference.communicationType = port

    def _bare_communication(
        self, reference: rsc.CommunicationReference, name: Name
    ) -> tuple[rsc.Component, rsc.CommunicationType] | None:
        own = self.around(reference, rsc.Component)
        if own is not None:
            communications = self.scope.communications(own) or {}
            if name.text in communications:
                return own, communications[name.text]
            if self._is_library:
                if not self._file.may_declare(name.text, NameKind.COMMUNICATION, imported=False):
                    self._missing(name, f"component `{own.name}` has no communication", communications, OWN_MEMBERS)
                return None
        ports = self.scope.communicating(name.text)
        if not ports:
            if not self.scope.incomplete and not self._file.may_declare(name.text, NameKind.COMMUNICATION):
                self._missing(name, "there is no communication", self.scope.all_communications())
            return None
        # Duplicate component names are a finding of their own, and a qualified name would stay ambiguous.
        several = len({communication for _, communication in ports}) < len({component.name for component, _ in ports})
        if several or ports[0][0].first is not None:
            candidates, texts = _first_few(
                f"{first_instance(component)}.{escape_keyword(name.text)}" for component, _ in ports
            )
            hint = Repair(f"write {candidates}", choices=texts)
            self._report(name, f"`{name.text}` is ambiguous: it may be {candidates}", hint)
            return None
        return ports[0]

    def _component(self, reference: rsc.CommunicationReference, name: Name) -> rsc.Component | None:
        components = ChainMap(dict(self.templates(reference)), dict(self.components(reference)))
        component: rsc.Component | None = components.get(name.text)
        if component is None and not self._file.may_declare(name.text, NameKind.COMPONENT, imported=False):
            hint = OWN_MEMBERS if name.text in self.scope.components else None
            repair = self._member_text(name) or self._made_of(name) or hint or self._import_of(name, components)
            self._missing(name, "there is no component", components, repair)
        return component

    def _indexed(self, component: rsc.Component, index: ex.Expression | None, name: Name, member: Name) -> None:
        """Report a fleet without an index, and an index between the name of another component and its member."""
        if component.first is not None and index is None:
            choice = first_instance(component)
            hint = Repair(f"write `{choice}`", choices=(choice,))
            message = f"`{name.text}` is a fleet, expected the number of an instance"
            self._report(name, message, hint, rule="argument")
        elif component.first is None and index is not None:
            message = f"`{name.text}` is a component without numbers, expected a fleet before an index"
            tokens = self._file.text.tokens
            first, last = tokens[tokens.index_at(name.start) + 1], tokens[tokens.index_at(member.start) - 2]
            repair = Repair("leave the index out", elsewhere=((first.start, last.end, ""),))
            self._report(name, message, repair, rule="argument")

    def _member_text(self, name: Name) -> Repair | None:
        """Return the repair that writes `Cell[2]` for `Cell2`, if `Cell` is a fleet."""
        fleet = self.scope.components.get(name.text.rstrip("0123456789"))
        if self._is_library or fleet is None or fleet.first is None or fleet.name == name.text:
            return None
        text = instance_text(fleet, int(name.text[len(fleet.name) :]))
        return Repair(f"write `{text}`", text)

    def components(self, element: ex.Located) -> Names:
        """Return the components that an element can mention.

        In a library a component can only mention itself; assumptions outside of components can mention all. A template
        can also mention itself; other components can only mention its instances.
        """
        own = self.around(element, rsc.Component)
        if self._is_library:
            if own is None and self.around(element, rsc.Assumption) is not None:
                return self._parts
            return {} if own is None else {own.name: own}
        return ChainMap({own.name: own}, self._parts) if own is not None and own.parameters else self._parts

    @cached_property
    def _parts(self) -> dict[str, rsc.Component]:
        """Components of the robot that are not templates."""
        return {name: component for name, component in self.scope.components.items() if not component.parameters}

    def _made_of(self, name: Name) -> Repair | None:
        """Return the repair that replaces the name of a template of the robot by the name of an instance."""
        template = None if self._is_library else self.scope.components.get(name.text)
        if template is None:
            return None
        choice, texts = self._instances_text(template)
        return Repair(f"`{escape_keyword(template.name)}` is a template: write {choice}", choices=texts)

    def _import_of(self, name: Name, known: Iterable[str]) -> str | None:
        """Return the import that may be missing; None if a known name is close or no library has the component."""
        if self._is_library or len(name.text) < _SHORTEST or did_you_mean(name.text, known, cutoff=0.6):
            return None
        word, importable = name.text.lower(), self._importable()
        like = [component for component in importable if word in component.lower() or component.lower() in word]
        component = min(like, key=lambda other: (abs(len(other) - len(word)), other), default=None)
        if component is None:
            return None
        library = escape_keyword(importable[component])
        return f"{_IMPORT}`component {escape_keyword(name.text)} from {library} import {escape_keyword(component)}`"

    def _member(self, members: Names, name: Name, component: rsc.Component, declared: NameKind) -> Any:
        member = members.get(name.text)
        if member is None and not self._file.may_declare_within(self.scope.origin(component), name.text, declared):
            what = "communication" if declared is NameKind.COMMUNICATION else "variable or state"
            values = [] if declared is NameKind.COMMUNICATION else self.scope.values(name.text)
            hint = self._value_of_enum(name, values[0]) if values else None
            self._missing(name, f"component `{component.name}` has no {what}", members, hint)
        return member

    def _value_of_enum(self, name: Name, value: rsc.EnumValue) -> Repair:
        enum = value.eContainer().eContainer()
        hint_text = (
            f"`{escape_keyword(name.text)}` is a value of `{escape_keyword(enum.name)}`: write it without a component"
        )
        tokens = self._file.text.tokens
        at = tokens.index_at(name.start)
        return Repair(hint_text, elsewhere=((tokens[at - 2].start, tokens[at - 1].end, ""),), is_offered=True)

    def _target(self, transition: rsc.Transition | rsc.RequirementTransition, name: Name) -> None:
        if isinstance(transition, rsc.RequirementTransition):
            own_states = by_name(transition.eContainer().eContainer().states)
            transition.target = own_states.get(name.text)
            if transition.target is None:
                self._missing(name, "the requirement has no state", own_states)
            return
        own = self.around(transition, rsc.Component)
        states = self.scope.states(own) if own is not None else {}
        if name.text in states:
            transition.target = states[name.text]
        elif own is not None and not self._file.may_declare_within(own, name.text, NameKind.MEMBER):
            self._missing(name, f"component `{own.name}` has no state", states)

    # Expressions

    def _access(self, access: rsc.Access, names: Mapping[str, Name]) -> None:
        first = names.get("component", names["item"])
        qualifies = "component" in names
        parameter = self.parameters(access).get(first.text)
        templates = self.templates(access)
        components = self.components(access)
        bound = self.elements(access).get(first.text)
        is_free = bound is None and parameter is None and self.around(access, rsc.EnumDataType) is None
        if is_free and not qualifies and self._instance_access(access, first):
            return
        if bound is not None or parameter is not None:
            access.item = bound or parameter
        elif qualifies and first.text in templates:
            self._qualified(access, templates[first.text], names["item"])
            return
        elif qualifies and first.text in components and self.around(access, rsc.EnumDataType) is None:
            self._indexed(components[first.text], access.index, first, names["item"])
            self._qualified(access, components[first.text], names["item"])
            return
        elif qualifies and first.text in (automata := self.automata(access)):
            self._requirement_state(access, automata[first.text], names["item"])
            return
        elif qualifies and (
            self._value_of(access, first, names["item"]) or self._ros_constant(access, first, names["item"])
        ):
            return
        elif self.around(access, rsc.EnumDataType) is not None:
            self._in_enum(access, first)
        elif qualifies and self._own_running(access, first, names["item"]):
            return
        else:
            self._bare(access, first, qualifies=qualifies)
        if qualifies:
            self._read_as_property(access, names["item"])

    def _instance_access(self, access: rsc.Access, name: Name) -> bool:
        """Link a name with an index as an instance, or its member, and return whether it is one.

        `Cell[2].free` reads a member of an instance, `Turns[Cell[2]].mine` the state of a requirement automaton.
        """
        index = access.segments[0] if access.segments else None
        if not isinstance(index, rsc.IndexSegment):
            return False
        component = self.components(access).get(name.text)
        own = self.around(access, rsc.Component)
        members = (self.scope.members(own) if own is not None else None) or {}
        automaton = None if component or name.text in members else self.automata(access).get(name.text)
        if component is not None and component.first is not None:
            self._fleet_access(access, index, name, component)
        elif automaton is not None and automaton.template is not None:
            self._automaton_access(access, index, name, automaton)
        else:
            return False
        return True

    def _fleet_access(self, access: rsc.Access, index: rsc.IndexSegment, name: Name, fleet: rsc.Component) -> None:
        member = self._move_index(access, index, name)
        if member is not None:
            self._qualified(access, fleet, member)
        else:
            access.item = fleet

    def _automaton_access(
        self, access: rsc.Access, index: rsc.IndexSegment, name: Name, automaton: rsc.AutomatonRequirement
    ) -> None:
        template = automaton.template
        state = self._move_index(access, index, name)
        assert template is not None
        if not self._is_instance_of(access.index, template, self.templates(access)):
            choice, _ = self._instances_text(template)
            message = f"`{name.text}` belongs to each instance of `{template.name}`, expected one of them in brackets"
            self._report(name, message, Repair(f"write {choice} in the brackets"), rule="argument")
        elif state is not None:
            self._requirement_state(access, automaton, state)
        else:
            states = enumeration(f"`{state.name}`" for state in automaton.states)
            message = f"requirement `{name.text}` has no value of its own, expected one of its states"
            self._report(name, message, f"write {states} behind the brackets")

    def _move_index(self, access: rsc.Access, index: rsc.IndexSegment, name: Name) -> Name | None:
        """Move the index behind a name from the segments to the access, and return the name behind it, if any."""
        number = index.first or ex.IntegerLiteral(value=index.index, source=index.source)
        for _, part in tree(number):
            names = self._file.references.get(part)
            if names is not None and part not in self._linked:
                self._linked.add(part)
                self._use(part, names)
        if index.last is not None:
            message = f"`{name.text}` has a range in brackets, expected one instance"
            self._report(name, message, "write one instance in the brackets", rule="argument")
        access.segments.remove(index)
        access.index = number
        behind = access.segments[0] if access.segments else None
        if not isinstance(behind, rsc.PropertySegment):
            return None
        access.segments.remove(behind)
        member = self._file.references.pop(behind)["property"]
        self._file.references[access] = {"component": name, "item": member}
        return member

    def _is_instance_of(self, expression: ex.Expression | None, template: rsc.Component, current: Names) -> bool:
        if not isinstance(expression, rsc.Access) or not isinstance(expression.item, rsc.Component):
            return False
        component = expression.item
        if component.first is not None and expression.index is None:
            return False
        return component in current.values() if component is template else self.scope.origin(component) is template

    def _instances_text(self, template: rsc.Component) -> tuple[str, tuple[str, ...]]:
        """Return the instances of a template, or of a new component, as a phrase and as texts."""
        texts = [first_instance(part) for part in self._parts.values() if self.scope.origin(part) is template]
        choice, choices = _first_few(texts or [f"component other is {escape_keyword(template.name)}(…)"])
        return choice, choices if texts else ()

    def automata(self, element: ex.Located) -> Names:
        """Return the requirement automata that an expression can read: of its component, then of the robot."""
        own = self.around(element, rsc.Component)
        local = own.type.definitions if own is not None and isinstance(own.type, rsc.LocalComponent) else ()
        outer = self._file.base.definitions if self._file.base is not None else ()
        return by_name(
            requirement for requirement in (*local, *outer) if isinstance(requirement, rsc.AutomatonRequirement)
        )

    def _requirement_state(self, access: rsc.Access, automaton: rsc.AutomatonRequirement, name: Name) -> None:
        states = by_name(automaton.states)
        template = automaton.template if access.index is None else None
        if template is not None and template not in self.templates(access).values():
            start = self._file.references[access]["component"]
            choice, _ = self._instances_text(template)
            message = f"`{start.text}` belongs to each instance of `{template.name}`, expected one of them in brackets"
            self._report(start, message, f"write {choice} in brackets behind it", rule="argument")
        elif name.text in states:
            access.item = states[name.text]
        else:
            self._missing(name, f"requirement `{automaton.name}` has no state", states)

    def _in_enum(self, access: rsc.Access, name: Name) -> None:
        if self._named_value(access, name) or self._enum_value(access, name):
            return
        if not self._file.may_declare(name.text, NameKind.ENUM_VALUE, NameKind.NAMED):
            hint = (
                "the rules of an enum read only `value`, literals, constants, functions, its parameters and enum values"
            )
            known = [*self.scope.usable(rsc.EnumValue), *self.scope.usable(rsc.NamedExpression)]
            self._missing(name, "there is no enum value", known, hint)

    def _value_of(self, access: rsc.Access, enum: Name, value: Name) -> bool:
        """Link `a.b` as a value `b` of an enum `a`, and return whether `a` is an enum.

        Components of this name take precedence.
        """
        definitions = self.scope.find(rsc.ComplexDataType, enum.text)
        if len(definitions) != 1 or not isinstance(definitions[0][1], rsc.EnumDataType):
            return False
        definition = definitions[0][1]
        access.enumeration = definition
        values = by_name(rule.value for rule in definition.rules if rule.value)
        if value.text in values:
            access.item = values[value.text]
        elif not self._file.may_declare_within(definition, value.text, NameKind.ENUM_VALUE):
            self._missing(value, f"enum `{definition.name}` has no value", values)
        return True

    def _ros_constant(self, access: rsc.Access, type_name: Name, name: Name) -> bool:
        """Replace `Type.NAME` by the value of a constant of a ROS type; return whether the text uses such a type.

        Names of the text take precedence.
        """
        types = used_types(self._file, type_name.text)
        if access.segments or not types or self._is_declared(access, type_name.text):
            return False
        known = constants_of(types, type_name.text, self.interfaces)
        by_package = known.get(name.text, {})
        values = {value for values in by_package.values() for value in values}
        if len(by_package) > 1:
            types_having = enumeration(f"`{package}/{type_name.text}`" for package in by_package)
            self._report(name, f"`{name.text}` is a constant of {types_having}", _OWN_CONSTANT)
        elif not values:
            self._missing(name, f"the ROS type `{type_name.text}` has no constant", known)
        elif len(values) > 1:
            message = f"`{name.text}` has other values in ROS 1 and in ROS 2"
            self._report(name, message, _OWN_CONSTANT, rule="interface-type")
        else:
            self._substitute(access, literal(values.pop(), access.source))
        return True

    def _is_declared(self, access: rsc.Access, name: str) -> bool:
        """Return whether a bare name has an element, other than a component or an object."""
        own = self.around(access, rsc.Component)
        members = (self.scope.members(own) if own is not None else None) or {}
        return name in members or bool(self.scope.find(rsc.NamedExpression, name) or self.scope.values(name))

    def parameters(self, element: ex.Located) -> Names:
        """Return the parameters that an expression can read: of its function, and of its enum or template."""
        function = self._nearest(element, rsc.Function)
        around = self._outermost(element)
        by_parameter_name: dict[str, Any] = {}
        if isinstance(around, rsc.Component | rsc.EnumDataType):
            by_parameter_name |= by_name(around.parameters)
        if isinstance(around, rsc.Component) and around.number is not None and not _is_bound(element, around):
            by_parameter_name[NUMBER] = around.number
        return by_parameter_name | by_name(function.parameters) if function is not None else by_parameter_name

    def elements(self, element: ex.Located) -> Names:
        """Return the array elements that an expression can read: those of the quantifiers around it."""
        by_element_name: dict[str, rsc.ArrayElement] = {}
        around: ex.Located | None = element if rsc.ArrayElement in self._present else None
        while around is not None:
            around = self._quantifier(around)
            if around is not None:
                by_element_name.setdefault(around.element.name, around.element)
        return by_element_name

    def _quantifier(self, element: ex.Located) -> rsc.ArrayQuantifier | None:
        """Return the innermost quantifier over an array whose condition contains an element."""
        path: list[ex.Located] = []
        quantifier: rsc.ArrayQuantifier | None = None
        around: ex.Located | None = element
        while around is not None and quantifier is None:
            if around in self._quantifiers:
                quantifier = self._quantifiers[around]
                break
            path.append(around)
            outer = around.eContainer()
            if isinstance(outer, rsc.ArrayQuantifier) and outer.body is around:
                quantifier = outer
            around = None if isinstance(outer, rsc.Definition) else outer
        self._quantifiers.update(dict.fromkeys(path, quantifier))
        return quantifier

    def templates(self, element: ex.Located) -> Names:
        """Return the templates whose instances a name can mean: those of the quantifiers and of `each` around it."""
        by_template_name: dict[str, rsc.Component] = {}
        quantifier = self._nearest(element, rsc.InstanceQuantifier)
        while quantifier is not None:
            if quantifier.template is not None:
                by_template_name.setdefault(quantifier.template.name, quantifier.template)
            quantifier = self._nearest(quantifier.eContainer(), rsc.InstanceQuantifier)
        around = self._nearest(element, rsc.StatedDefinition)
        if around is not None and around.template is not None:
            by_template_name.setdefault(around.template.name, around.template)
        return by_template_name

    def _qualified(self, access: rsc.Access, component: rsc.Component, name: Name) -> None:
        access.component = component
        members = self.scope.members(component)
        if members is not None and name.text not in members:
            behind = [self._file.references.get(segment, {}).get("property") for segment in access.segments]
            if self._running(access, component, name) or self._call_misread(component, name, behind):
                return
            if (
                behind
                and behind[0] is not None
                and behind[0].text == RUNNING_WORD
                and self._misspelled(component, name)
            ):
                return
        if members is not None:
            access.item = self._member(members, name, component, NameKind.MEMBER)

    def _call_misread(self, component: rsc.Component, name: Name, behind: Sequence[Name | None]) -> bool:
        """Report a communication that is read without `running`, and return whether the name is one.

        `behind` are the names behind it in the text.
        """
        communication = (self.scope.communications(component) or {}).get(name.text)
        if communication is None or self._file.may_declare_within(
            self.scope.origin(component), name.text, NameKind.MEMBER
        ):
            return False
        word = behind[0] if behind else None
        if not isinstance(communication, rsc.Service | rsc.Action):
            self._report(
                name,
                f"`{name.text}` is a message: it has no state",
                "store in a variable that it was sent",
            )
        elif word is None:
            call = f"{escape_keyword(name.text)}.{RUNNING_WORD}"
            self._report(
                name, f"`{name.text}` can be read as `{call}` only", Repair(f"write `{call}`", choices=(call,))
            )
        elif word.text == RUNNING_WORD:
            other = behind[1] if len(behind) > 1 and behind[1] is not None else word
            rest = (self._point_before(other).start, other.end, "")
            message = f"`{escape_keyword(name.text)}.{RUNNING_WORD}` has no members"
            self._report(other, message, Repair(f"leave `.{other.text}` out", elsewhere=(rest,), is_offered=True))
        else:
            repair = did_you_mean(word.text, [RUNNING_WORD], cutoff=0.6)
            message = f"only `{RUNNING_WORD}` of `{name.text}` can be read, not `{word.text}`"
            self._report(word, message, repair or Repair(f"write `{RUNNING_WORD}`", choices=(RUNNING_WORD,)))
        return True

    def _misspelled(self, component: rsc.Component, name: Name) -> bool:
        """Report a name before `running` that is close to a service or action, and return whether it is."""
        calls = self._calls(component)
        repair = did_you_mean(name.text, calls, cutoff=0.6)
        if repair is None or self._file.may_declare_within(
            self.scope.origin(component), name.text, NameKind.COMMUNICATION
        ):
            return False
        self._report(name, f"component `{component.name}` has no service or action `{name.text}`", repair)
        return True

    def _calls(self, component: rsc.Component) -> Names:
        communications = self.scope.communications(component) or {}
        return {
            called: communication
            for called, communication in communications.items()
            if isinstance(communication, rsc.Service | rsc.Action)
        }

    def _own_running(self, access: rsc.Access, name: Name, word: Name) -> bool:
        """Link `a.running` to a service or action of the own component, and return whether this succeeds.

        Any other meaning of `a` takes precedence.
        """
        own = self.around(access, rsc.Component)
        if own is None or word.text != RUNNING_WORD or access.segments or name.text in (self.scope.members(own) or {}):
            return False
        if self.scope.find(rsc.NamedExpression, name.text):
            return False
        communication = (self.scope.communications(own) or {}).get(name.text)
        if not isinstance(communication, rsc.Service | rsc.Action):
            return False
        access.component, access.item = own, communication
        self._file.references[access] = {"item": name}
        return True

    def _running(self, access: rsc.Access, component: rsc.Component, name: Name) -> bool:
        """Link `A.b.running` to a service or action `b` of a component, and return whether this succeeds."""
        communication = (self.scope.communications(component) or {}).get(name.text)
        if not isinstance(communication, rsc.Service | rsc.Action) or len(access.segments) != 1:
            return False
        (segment,) = access.segments
        word = self._file.references.get(segment, {}).get("property")
        if word is None or word.text != RUNNING_WORD:
            return False
        access.item = communication
        access.segments.remove(segment)
        del self._file.references[segment]
        return True

    def _bare(self, access: rsc.Access, name: Name, *, qualifies: bool) -> None:
        """Link a bare name.

        It is a component, else a member of the own component, else a name of the robot or library, else an enum value.
        """
        own = self.around(access, rsc.Component)
        members = (self.scope.members(own) if own is not None else None) or {}
        components = self.components(access)
        if name.text in components:
            access.item = components[name.text]
            return
        if name.text in members:
            access.component, access.item = own, members[name.text]
            return
        own_text = NameKind.COMPONENT, NameKind.MEMBER, NameKind.NAMED
        if self._named_value(access, name) or self._enum_value(access, name):
            return
        if self._file.may_declare(name.text, *own_text, imported=False):
            return
        if qualifies and self._file.may_declare(name.text, NameKind.DATA_TYPE):
            return
        word = self._file.references[access]["item"] if qualifies else None
        if own is not None and self._call_misread(own, name, [word] if word is not None else []):
            return
        is_call = word is not None and word.text == RUNNING_WORD
        if own is not None and is_call and self._misspelled(own, name):
            return
        if qualifies:
            hint = (_ANY_NUMBER if own is None else OWN_MEMBERS) if name.text in self.scope.components else None
            known = [*components, *members]
            called = self._elsewhere(name, self._calls) if is_call else None
            repair = self._member_text(name) or self._made_of(name) or hint or called or self._import_of(name, known)
            self._missing(name, "there is no component or variable", known, repair)
        elif not self._file.may_declare(name.text, NameKind.ENUM_VALUE, NameKind.NAMED):
            named = self.scope.usable(rsc.NamedExpression)
            known = [*components, *members, *named, *self.scope.usable(rsc.EnumValue)]
            elsewhere = self._made_of(name) or self._elsewhere(name)
            instead = OWN_MEMBERS if self._is_library and elsewhere else elsewhere or CONSTRUCTS.get(name.text)
            self._missing(name, "there is no component, variable, state or enum value", known, instead, listed=False)

    def _named_value(self, access: rsc.Access, name: Name) -> bool:
        """Link a constant, parameter or condition of the robot or library, and return whether there is one.

        A name that several libraries declare is reported.
        """
        definitions = self.scope.find(rsc.NamedExpression, name.text)
        if len(definitions) > 1:
            self._ambiguous("name", name, [file for file, _ in definitions])
        elif definitions:
            access.item = definitions[0][1]
        return bool(definitions)

    def _elsewhere(
        self, name: Name, having_it: Callable[[rsc.Component], Names | None] | None = None
    ) -> Repair | str | None:
        """Return the qualified name for a bare name that other components have as a member, or by `having_it`."""
        members = having_it or self.scope.members
        having = [
            f"{first_instance(component)}.{escape_keyword(name.text)}"
            for component in (self.scope.components if self._is_library else self._parts).values()
            if name.text in (members(component) or {})
        ]
        if len(having) == 1:
            return Repair(f"write `{having[0]}`", choices=(having[0],))
        if not having:
            return None
        hint, texts = _first_few(having)
        return Repair(f"write {hint}", choices=texts)

    def _enum_value(self, access: rsc.Access, name: Name) -> bool:
        """Link an enum value, or report several with the same name, and return whether there is one."""
        values = self.scope.values(name.text)
        if len(values) == 1:
            access.item = values[0]
        elif values:
            enums = [value.eContainer().eContainer().name for value in values]
            choice, texts = _first_few(f"{escape_keyword(enum)}.{escape_keyword(name.text)}" for enum in enums)
            message = f"`{name.text}` is a value of several enums"
            hint = Repair(f"write {choice}", choices=texts) if len(texts) > 1 else "declare an enum in this file"
            self._report(name, message, hint, rule="unique-enum-value")
        return bool(values)

    def _read_as_property(self, access: rsc.Access, name: Name) -> None:
        """Read `a.b` as the property `b` of `a`, which is not a component."""
        start = self._point_before(name).start
        segment = rsc.PropertySegment(source=self._file.text.source(start, name.end))
        access.segments.insert(0, segment)
        names = self._file.references
        names[access], names[segment] = {"item": names[access]["component"]}, {"property": name}
        self._segment(segment, name)

    # Properties

    def _segment(self, segment: rsc.PropertySegment, name: Name) -> None:
        access = segment.eContainer()
        # The segments of an access come in order, and each continues from the type of the previous one.
        if access not in self._types:
            self._types[access] = [start_type(access, value_type(access))]
        types = self._types[access]
        while access.segments[len(types) - 1] is not segment:
            types.append(segment_type(types[-1], access.segments[len(types) - 1]))
        prop = self._property(types[-1], name)
        if prop is not None:
            segment.property = prop

    def _property_value(self, element: rsc.ObjectPropertyValue, name: Name) -> None:
        expected = object_value_type(element.eContainer())
        # The type rules check whether an object is allowed here.
        prop = self._property(expected, name) if isinstance(expected, ObjectType) else None
        if prop is not None:
            element.property = prop

    def _property(self, of: Type, name: Name) -> rsc.ObjectProperty | None:
        if of == UNKNOWN:
            return None
        if not isinstance(of, ObjectType):
            what = (
                "an enum" if isinstance(of, EnumType) else "an array" if isinstance(of, ArrayType) else f"of type {of}"
            )
            hint = self._index_before(name) if isinstance(of, ArrayType) else None
            self._report(name, f"there is no property `{name.text}`: its operand is {what}", hint)
            return None
        if is_made(of.definition):
            ros_prop = ros_property(of.definition, name.text, self.interfaces)
            if ros_prop is None:
                known = ros_properties(of.definition, self.interfaces)
                self._missing(
                    name, f"the ROS type `{of.definition.name}` has no field that a model can use named", known
                )
            return ros_prop
        if of.definition not in self._properties:
            self._properties[of.definition] = by_name(of.definition.properties)
        properties = self._properties[of.definition]
        if name.text in properties:
            prop: rsc.ObjectProperty = properties[name.text]
            return prop
        if not self._file.may_declare_within(of.definition, name.text, NameKind.PROPERTY):
            self._missing(name, f"object `{of.definition.name}` has no property", properties)
        return None

    def _index_before(self, name: Name) -> Repair:
        point = self._point_before(name).start
        hint = f"write an index before it: `[0].{name.text}`"
        return Repair(hint, elsewhere=((point, point, "[0]"),), is_offered=True)

    def _point_before(self, name: Name) -> Token:
        tokens = self._file.text.tokens
        return tokens[tokens.index_at(name.start) - 1]

    def around(self, element: ex.Located, kind: type[_Element]) -> _Element | None:
        """Return the component or enum that contains the element if it is of that kind, or None.

        The arguments of an instantiated or imported component are outside of it.
        """
        definition = self._outermost(element)
        is_instance = isinstance(definition, rsc.Component) and not isinstance(definition.type, rsc.LocalComponent)
        is_argument = is_instance and isinstance(element, ex.Expression)
        return definition if isinstance(definition, kind) and not is_argument else None

    def _outermost(self, element: ex.Located) -> ex.Located | None:
        """Return the definition of the robot or library that contains an element."""
        path: list[ex.Located] = []
        around = element
        # Cached per element: each part of the path between two names of a long expression is climbed only once.
        while around not in self._definitions and not isinstance(around.eContainer(), rsc.Base):
            path.append(around)
            around = around.eContainer()
            if around is None:
                return None
        definition = self._definitions.get(around, around)
        self._definitions.update(dict.fromkeys(path, definition))
        return definition

    def _nearest(self, element: ex.Located, kind: type[_Element]) -> _Element | None:
        """Return the innermost element of a kind that contains an expression, within its definition."""
        if kind not in self._present:
            return None
        known = self._nearests.setdefault(kind, {})
        path: list[ex.Located] = []
        around: ex.Located | None = element
        while around is not None and around not in known and not isinstance(around, kind | rsc.Definition):
            path.append(around)
            around = around.eContainer()
        nearest = known.get(around, around if isinstance(around, kind) else None) if around is not None else None
        known.update(dict.fromkeys(path, nearest))
        return nearest

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
            texts = tuple(escape_keyword(other) for other in names)
            repair = Repair(f"there is {enumeration(f'`{text}`' for text in texts)}", choices=texts)
        self._report(name, f"{message} `{name.text}`", repair)

    def _report(self, name: Name, message: str, repair: Repair | str | None = None, rule: str = RULE) -> None:
        if not self._file.regions.is_uncertain(name.start):
            self.findings.append(self._file.text.error(rule, name.start, name.end, message, repair))


def first_instance(component: rsc.Component) -> str:
    """Return the text that names a component, or the first instance of a fleet."""
    first = constant_value(component.first)
    return instance_text(component, max(first, 0) if type(first) is int else None)


def _is_bound(element: ex.Located, fleet: rsc.Component) -> bool:
    """Return whether an element is in the bounds of a fleet."""
    around = element
    while around.eContainer() is not None and around.eContainer() is not fleet:
        around = around.eContainer()
    return around is fleet.first or around is fleet.last


def _first_few(texts: Iterable[str]) -> tuple[str, tuple[str, ...]]:
    """Return the possible replacements of a name, as a phrase and as texts, at most `_FEW` of them."""
    texts = tuple(dict.fromkeys(texts))
    shown = [f"`{text}`" for text in texts[:_FEW]]
    others = len(texts) - len(shown)
    return enumeration([*shown, *([f"that of {others} more"] if others else [])]), texts[:_FEW]
