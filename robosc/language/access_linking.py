"""Links names in expressions: accesses to members, values, requirement automata and properties."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Any

from robosc.base.diagnostics import Repair
from robosc.language.interface_types import is_made, ros_properties, ros_property
from robosc.language.name_findings import NameFindings, first_few, first_instance
from robosc.language.ros_constants import constants_of, literal, used_types
from robosc.language.scopes import File, NameKind, Names, by_name
from robosc.language.syntax_messages import CONSTRUCTS, did_you_mean
from robosc.model import expression as ex
from robosc.model import robosc as rsc
from robosc.model.reflection import tree
from robosc.model.semantics.communication import LASTING, RUNNING_WORD
from robosc.model.semantics.naming import enumeration, escape_keyword
from robosc.model.semantics.typing import (
    UNKNOWN,
    ArrayType,
    EnumType,
    ObjectType,
    Type,
    declared_type,
    object_value_type,
    segment_type,
    start_type,
    value_type,
    value_types,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.base.ros_types import RosTypes
    from robosc.language.builder import Name
    from robosc.language.tokens import Token

_OWN_CONSTANT = "declare a `constant` with the value"
OWN_MEMBERS = "a component of a library reads only its own members"
#: Hint for conditions and functions outside the components of a library.
_ANY_NUMBER = "a robot may import a component several times or never: write this in the component"


class AccessLinker(NameFindings):
    """Links the accesses of one file: names of components, members, values and properties in expressions."""

    def __init__(self, file: File, interfaces: RosTypes, importable: Callable[[], Mapping[str, str]]) -> None:
        super().__init__(file, importable)
        self.interfaces = interfaces
        self._types: dict[rsc.Access, list[Type]] = {}
        #: For each access in a requirement on several commands, the types along it for the data of each further one.
        self._others: dict[rsc.Access, list[list[Type]]] = {}
        self._properties: dict[rsc.ObjectDataType, Names] = {}
        #: Elements that are linked before their turn: in the index of an instance, or the command after `disables`.
        self._linked: set[ex.Located] = set()

    @abstractmethod
    def _use(self, element: ex.Located, names: Mapping[str, Name]) -> None:
        """Link the names in an element that uses declarations."""

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
            self._indexed(access, components[first.text], first, names["item"])
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

    def _indexed(
        self, element: rsc.Access | rsc.CommunicationReference, component: rsc.Component, name: Name, member: Name
    ) -> None:
        """Report a fleet without an index, and an index between the name of another component and its member."""
        index = element.index
        each = self._nearest(element, rsc.StatedDefinition)
        template = None if each is None else self.file.references.get(each, {}).get("template")
        if template is not None and each is not None and each.template is None and template.text == name.text:
            return  # The name behind `each` is reported.
        if component.first is not None and index is None:
            choice = first_instance(component)
            hint = Repair(f"write `{choice}`", choices=(choice,))
            message = f"`{name.text}` is a fleet, expected the number of an instance"
            self._report(name, message, hint, rule="argument")
        elif component.first is None and index is not None:
            message = f"`{name.text}` is a component without numbers, expected a fleet before an index"
            tokens = self.file.text.tokens
            first, last = tokens[tokens.index_at(name.start) + 1], tokens[tokens.index_at(member.start) - 2]
            repair = Repair("leave the index out", elsewhere=((first.start, last.end, ""),))
            self._report(name, message, repair, rule="argument")

    def _move_index(self, access: rsc.Access, index: rsc.IndexSegment, name: Name) -> Name | None:
        """Move the index behind a name from the segments to the access, and return the name behind it, if any."""
        number = index.first or ex.IntegerLiteral(value=index.index, source=index.source)
        for _, part in tree(number):
            names = self.file.references.get(part)
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
        member = self.file.references.pop(behind)["property"]
        self.file.references[access] = {"component": name, "item": member}
        return member

    def _is_instance_of(self, expression: ex.Expression | None, template: rsc.Component, current: Names) -> bool:
        if not isinstance(expression, rsc.Access) or not isinstance(expression.item, rsc.Component):
            return False
        component = expression.item
        if component.first is not None and expression.index is None:
            return False
        return component in current.values() if component is template else self.scope.origin(component) is template

    def _requirement_state(self, access: rsc.Access, automaton: rsc.AutomatonRequirement, name: Name) -> None:
        states = by_name(automaton.states)
        template = automaton.template if access.index is None else None
        if template is not None and template not in self.templates(access).values():
            start = self.file.references[access]["component"]
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
        if not self.file.may_declare(name.text, NameKind.ENUM_VALUE, NameKind.NAMED):
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
        elif not self.file.may_declare_within(definition, value.text, NameKind.ENUM_VALUE):
            self._missing(value, f"enum `{definition.name}` has no value", values)
        return True

    def _ros_constant(self, access: rsc.Access, type_name: Name, name: Name) -> bool:
        """Replace `Type.NAME` by the value of a constant of a ROS type; return whether the text uses such a type.

        Names of the text take precedence.
        """
        types = used_types(self.file, type_name.text)
        if access.segments or not types or self._is_declared(access, type_name.text):
            return False
        known = constants_of(types, type_name.text, self.interfaces)
        by_type = known.get(name.text, {})
        values = {value for values in by_type.values() for value in values}
        if len(by_type) > 1:
            types_having = enumeration(f"`{whole_name}`" for whole_name in by_type)
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

    def _qualified(self, access: rsc.Access, component: rsc.Component, name: Name) -> None:
        access.component = component
        members = self.scope.members(component)
        if members is not None and name.text not in members:
            behind = [self.file.references.get(segment, {}).get("property") for segment in access.segments]
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
        if communication is None or self.file.may_declare_within(
            self.scope.origin(component), name.text, NameKind.MEMBER
        ):
            return False
        word = behind[0] if behind else None
        if not isinstance(communication, LASTING):
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
        if repair is None or self.file.may_declare_within(
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
            if isinstance(communication, LASTING)
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
        if not isinstance(communication, LASTING):
            return False
        access.component, access.item = own, communication
        self.file.references[access] = {"item": name}
        return True

    def _running(self, access: rsc.Access, component: rsc.Component, name: Name) -> bool:
        """Link `A.b.running` to a service or action `b` of a component, and return whether this succeeds."""
        communication = (self.scope.communications(component) or {}).get(name.text)
        if not isinstance(communication, LASTING) or len(access.segments) != 1:
            return False
        (segment,) = access.segments
        word = self.file.references.get(segment, {}).get("property")
        if word is None or word.text != RUNNING_WORD:
            return False
        access.item = communication
        access.segments.remove(segment)
        del self.file.references[segment]
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
        if self.file.may_declare(name.text, *own_text, imported=False):
            return
        if qualifies and self.file.may_declare(name.text, NameKind.DATA_TYPE):
            return
        word = self.file.references[access]["item"] if qualifies else None
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
        elif not self.file.may_declare(name.text, NameKind.ENUM_VALUE, NameKind.NAMED):
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
        hint, texts = first_few(having)
        return Repair(f"write {hint}", choices=texts)

    def _enum_value(self, access: rsc.Access, name: Name) -> bool:
        """Link an enum value, or report several with the same name, and return whether there is one."""
        values = self.scope.values(name.text)
        if len(values) == 1:
            access.item = values[0]
        elif values:
            enums = [value.eContainer().eContainer().name for value in values]
            choice, texts = first_few(f"{escape_keyword(enum)}.{escape_keyword(name.text)}" for enum in enums)
            message = f"`{name.text}` is a value of several enums"
            hint = Repair(f"write {choice}", choices=texts) if len(texts) > 1 else "declare an enum in this file"
            self._report(name, message, hint, rule="unique-enum-value")
        return bool(values)

    def _member(self, members: Names, name: Name, component: rsc.Component, declared: NameKind) -> Any:
        member = members.get(name.text)
        if member is None and not self.file.may_declare_within(self.scope.origin(component), name.text, declared):
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
        tokens = self.file.text.tokens
        at = tokens.index_at(name.start)
        return Repair(hint_text, elsewhere=((tokens[at - 2].start, tokens[at - 1].end, ""),), is_offered=True)

    def _read_as_property(self, access: rsc.Access, name: Name) -> None:
        """Read `a.b` as the property `b` of `a`, which is not a component."""
        start = self._point_before(name).start
        segment = rsc.PropertySegment(source=self.file.text.source(start, name.end))
        access.segments.insert(0, segment)
        names = self.file.references
        names[access], names[segment] = {"item": names[access]["component"]}, {"property": name}
        self._segment(segment, name)

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
        del self.file.references[element]

    # Properties

    def _segment(self, segment: rsc.PropertySegment, name: Name) -> None:
        access = segment.eContainer()
        # The segments of an access come in order, and each continues from the type of the previous one.
        if access not in self._types:
            self._commands(access)
            self._types[access] = [start_type(access, value_type(access))]
            self._others[access] = [[other] for other in value_types(access)[1:]] if access.value else []
        types = self._types[access]
        while access.segments[len(types) - 1] is not segment:
            types.append(segment_type(types[-1], access.segments[len(types) - 1]))
        prop = self._property(types[-1], name)
        if prop is not None:
            segment.property = prop
        # The other commands of a set have the field, too.
        for others in self._others[access]:
            while len(others) < len(types):
                others.append(segment_type(others[-1], access.segments[len(others) - 1]))
            other = self._property(others[-1], name)
            others.append(UNKNOWN if other is None else declared_type(other.type))

    def _commands(self, access: rsc.Access) -> None:
        """Link the commands whose data an access reads; after `disables`, they follow in the text."""
        requirement: ex.Located | None = access if access.value else None
        while requirement is not None and not isinstance(requirement, rsc.CommunicationRequirement):
            requirement = requirement.eContainer()
        if requirement is None or requirement.target is None:
            return
        for command in requirement.target.communicationTypes:
            names = self.file.references.get(command)
            if names is not None and command.communicationType is None and command not in self._linked:
                self._linked.add(command)
                self._use(command, names)

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
        if not self.file.may_declare_within(of.definition, name.text, NameKind.PROPERTY):
            self._missing(name, f"object `{of.definition.name}` has no property", properties)
        return None

    def _index_before(self, name: Name) -> Repair:
        point = self._point_before(name).start
        hint = f"write an index before it: `[0].{name.text}`"
        return Repair(hint, elsewhere=((point, point, "[0]"),), is_offered=True)

    def _point_before(self, name: Name) -> Token:
        tokens = self.file.text.tokens
        return tokens[tokens.index_at(name.start) - 1]
