"""Links every name to the element that it refers to, and reports names without an element."""

from __future__ import annotations

from collections import ChainMap
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeVar

from robosc.base.diagnostics import Related, Repair
from robosc.base.interruption import checkpoint
from robosc.language.access_linking import OWN_MEMBERS, AccessLinker
from robosc.language.failures import expects_failure
from robosc.language.interface_types import declare, link_interface
from robosc.language.name_findings import IMPORT, RULE, first_few, first_instance
from robosc.language.scopes import File, NameKind, Scope, by_name
from robosc.language.spellings import NEGATION, WRONG_FOLDER, wrong_folder
from robosc.language.syntax_messages import BASIC_TYPES, did_you_mean
from robosc.model import expression as ex
from robosc.model import robosc as rsc
from robosc.model.semantics.communication import ros_kind, section_of
from robosc.model.semantics.expansion import constant_value
from robosc.model.semantics.failures import FAILURE, FAILURES
from robosc.model.semantics.naming import TEXT_FUNCTION, enumeration, escape_keyword
from robosc.model.semantics.operators import FUNCTIONS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from robosc.base.diagnostics import Diagnostic
    from robosc.base.ros_types import RosTypes
    from robosc.language.builder import Name

_Element = TypeVar("_Element")
#: Hint for a call of an unknown function.
_FUNCTION = (
    f"there is {enumeration(f'`{name}`' for name in sorted(FUNCTIONS))}; others are declared, such as "
    "`function half(d: double): double = d / 2`"
)
_OWN_TEXT = "write its content directly"


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
        key = finding.hint if finding.hint is not None and finding.hint.startswith(IMPORT) else finding
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


class Linker(AccessLinker):
    """Links one file whose libraries are linked."""

    def imports(self) -> None:
        """Link the imported and instantiated components, which all other names may need."""
        for element, names in self.file.references.items():
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
        for element, names in self.file.references.items():
            self._declaration(element, names)
        for component in self.file.base.definitions if self.file.base is not None else ():
            # A component with a duplicate name is linked too; the duplicate is a finding of its own.
            if isinstance(component, rsc.Component) and isinstance(component.type, rsc.LocalComponent):
                for definition in component.type.definitions:
                    linked = "interface" in self.file.references.get(definition, ())
                    if isinstance(definition, rsc.CommunicationType) and not linked:
                        link_interface(definition)
        self._uses()
        for declared in self.file.bounded:
            low, high = constant_value(declared.lower), constant_value(declared.upper)
            if type(low) is int and type(high) is int:
                declared.minimum, declared.maximum = low, high

    def _uses(self) -> None:
        """Link the names that use declarations; bare reasons last: they depend on the other names."""
        reasons: dict[rsc.Access, Mapping[str, Name]] = {}
        for element, names in list(self.file.references.items()):
            checkpoint()
            if isinstance(element, rsc.Access) and self._may_be_reason(element):
                reasons[element] = names
            elif element in self.file.references and element not in self._linked:  # `.running` is not a property
                self._use(element, names)
        for access, bare in reasons.items():
            self._reason(access, bare)

    def _may_be_reason(self, element: ex.Located) -> bool:
        """Return whether a bare name is a value of `Failure` if the text expects one there."""
        is_bare = self.file.predefined is not None and self._is_bare(element)
        return is_bare and self.file.references[element]["item"].text in FAILURES

    def _reason(self, access: rsc.Access, names: Mapping[str, Name]) -> None:
        """Link a bare name that is equal to a value of `Failure`."""
        if not expects_failure(access, self._is_bare):
            self._access(access, names)
            return
        assert self.file.predefined is not None
        access.item = self.file.predefined.declared[rsc.EnumValue][names["item"].text]

    def _declaration(self, element: ex.Located, names: Mapping[str, Name]) -> None:
        match element:
            case rsc.CommunicationType():
                name = names["interface"]
                element.interface = self._definition(rsc.Interface, "interface", NameKind.INTERFACE, name)
                if element.interface is not None:
                    self._folder(element.interface, ros_kind(element), name)
            case rsc.InterfaceTypeReference():
                unknown = declare(element, self.interfaces)
                if unknown is not None:
                    self._report(names["type"], *unknown)
                else:
                    self._folder(element, section_of(element).kind, names["type"])
            case rsc.ErrorReason():
                assert self.file.predefined is not None
                element.enumeration = self.file.predefined.declared[rsc.ComplexDataType][FAILURE]
            case rsc.ComplexDataTypeReference():
                name = names["type"]
                definition = self._definition(rsc.ComplexDataType, "object or enum", NameKind.DATA_TYPE, name)
                if definition is not None:
                    element.type = definition

    def _folder(self, element: ex.Located, kind: str, name: Name) -> None:
        """Report a folder in the name of a ROS type, such as `msg`, that is not the one of its kind."""
        file = None if element.source is None else element.source.file
        text = self.file.text if file is None or file.parsed is None else file.parsed.text
        message = None if element.source is None else wrong_folder(text, element, kind)
        if message is not None:
            self._report(name, message, WRONG_FOLDER)

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
        library = self.file.libraries.get(names["library"].text)
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
        components = self.file.declared[rsc.Component]
        template = components.get(name.text)
        if template is not None and template.parameters:
            element.definition = template
        elif template is not None:
            message = f"component `{name.text}` is not a template: it has no parameters"
            self._report(name, message, _OWN_TEXT, rule="argument")
        elif not self.file.may_declare(name.text, NameKind.COMPONENT, imported=False):
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
        elif (
            name.text == NEGATION and len(call.arguments) == 1 and not self.file.may_declare(name.text, NameKind.NAMED)
        ):
            self._substitute(call, ex.Negation(operand=call.arguments[0], source=call.source))
        elif name.text in FUNCTIONS and not self.file.may_declare(name.text, NameKind.NAMED):
            arguments = list(call.arguments)
            self._substitute(call, ex.FunctionCall(function=name.text, arguments=arguments, source=call.source))
        elif name.text == TEXT_FUNCTION and not self.file.may_declare(name.text, NameKind.NAMED):
            self._text(call, name)
        elif not self.file.may_declare(name.text, NameKind.NAMED):
            known = [*functions, *self.scope.usable(rsc.Function), *FUNCTIONS]
            self._missing(name, "there is no function", known, did_you_mean(name.text, known, cutoff=0.6) or _FUNCTION)

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
        own = self.file.declared[rsc.Component]
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
        elif not components and not self.file.may_declare(name.text, NameKind.COMPONENT):
            self._missing(
                name, "there is no template", [component.name for component in own.values() if component.parameters]
            )

    def _definition(self, kind: type[_Element], what: str, declared: NameKind, name: Name) -> _Element | None:
        definitions = self.scope.find(kind, name.text)
        if len(definitions) > 1:
            self._ambiguous(what, name, [file for file, _ in definitions])
        elif not definitions and not self.file.may_declare(name.text, declared):
            hint = _basic_type(name.text)
            self._missing(name, f"there is no {what}", self.scope.usable(kind), hint)
        return definitions[0][1] if len(definitions) == 1 else None

    # Communication

    def _remapping(self, remapping: rsc.TopicRemapping, name: Name) -> None:
        component = self.around(remapping, rsc.Component)
        if component is not None:
            remapping.communicationType = self._communication_of(component, name)

    def _communication_of(self, component: rsc.Component, name: Name) -> Any:
        communications = self.scope.communications(component)
        return None if communications is None else self._member(communications, name, component, NameKind.COMMUNICATION)

    def _communication(self, reference: rsc.CommunicationReference, names: Mapping[str, Name]) -> None:
        name = names["communicationType"]
        if "component" in names:
            component = self._component(reference, names["component"])
            if component is not None:
                reference.component = component
                self._indexed(reference, component, names["component"], name)
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
                if not self.file.may_declare(name.text, NameKind.COMMUNICATION, imported=False):
                    self._missing(name, f"component `{own.name}` has no communication", communications, OWN_MEMBERS)
                return None
        ports = self.scope.communicating(name.text)
        if not ports:
            if not self.scope.incomplete and not self.file.may_declare(name.text, NameKind.COMMUNICATION):
                self._missing(name, "there is no communication", self.scope.all_communications())
            return None
        # Duplicate component names are a finding of their own, and a qualified name would stay ambiguous.
        several = len({communication for _, communication in ports}) < len({component.name for component, _ in ports})
        if several or ports[0][0].first is not None:
            candidates, texts = first_few(
                f"{first_instance(component)}.{escape_keyword(name.text)}" for component, _ in ports
            )
            hint = Repair(f"write {candidates}", choices=texts)
            self._report(name, f"`{name.text}` is ambiguous: it may be {candidates}", hint)
            return None
        return ports[0]

    def _component(self, reference: rsc.CommunicationReference, name: Name) -> rsc.Component | None:
        components = ChainMap(dict(self.templates(reference)), dict(self.components(reference)))
        component: rsc.Component | None = components.get(name.text)
        if component is None and not self.file.may_declare(name.text, NameKind.COMPONENT, imported=False):
            hint = OWN_MEMBERS if name.text in self.scope.components else None
            repair = self._member_text(name) or self._made_of(name) or hint or self._import_of(name, components)
            self._missing(name, "there is no component", components, repair)
        return component

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
        elif own is not None and not self.file.may_declare_within(own, name.text, NameKind.MEMBER):
            self._missing(name, f"component `{own.name}` has no state", states)
