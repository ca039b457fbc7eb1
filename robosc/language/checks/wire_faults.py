"""Mismatches between a data type and the ROS type that carries its data."""

from __future__ import annotations

from dataclasses import dataclass
from difflib import get_close_matches
from typing import TYPE_CHECKING

from robosc.base.ros_types import MAKE_KNOWN, REPAIR
from robosc.base.ros_types.wire import (
    PRIMITIVES,
    Basic,
    DefinitionError,
    Fields,
    NestedType,
    Section,
    Sequence,
    WireType,
)
from robosc.model import robosc as rsc
from robosc.model.semantics.naming import escape_keyword
from robosc.model.semantics.typing import declared_type

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from robosc.base.ros_types import RosDistribution, RosTypes
    from robosc.language.checks.wire_data import CommunicationData, Uses


@dataclass(frozen=True)
class Fault:
    """Mismatch of a property, or of the whole data if None; `unknown`: the definition is missing or unreadable."""

    property: rsc.ObjectProperty | None
    message: str
    hint: str
    unknown: bool = False
    #: Text that replaces the property or the whole data, if the hint proposes it.
    text: str | None = None
    #: New name of the property, if the hint proposes it.
    new_name: str | None = None
    #: Whether the text or the name is a guess, so that the user chooses.
    is_guess: bool = False
    #: Existing fields with their types, if the property is none of them or has no type.
    others: Mapping[str, str] | None = None

    def is_used(self, uses: Uses) -> bool:
        """Return whether the mismatch affects used data; a mismatch of the whole data always does."""
        return self.property is None or self.property in uses


@dataclass(frozen=True)
class Unknown:
    """Missing or unreadable definition of the ROS type, with the reason."""

    message: str
    hint: str
    #: Package and name of the intended type.
    meant: tuple[str, str] | None = None


def faults(data: CommunicationData, interfaces: RosTypes, uses: Uses) -> list[Fault] | Unknown:
    """Return the mismatches of some data with its ROS type, in the ROS version in which the used data fits best."""
    answers = []
    try:
        for _, mismatches in _by_distribution(data, interfaces):
            if mismatches == []:
                return []
            if mismatches is not None:
                answers.append(mismatches)
    except DefinitionError:
        answers = []
    if not answers:
        return Unknown(*interfaces.why_unknown(data.ros_type.package, data.ros_type.name, data.part))
    return min(answers, key=lambda answer: (sum(fault.is_used(uses) for fault in answer), len(answer)))


def misfits(data: CommunicationData, interfaces: RosTypes, uses: Uses) -> dict[str, str]:
    """Return each of the two ROS versions in which the used data does not fit, with the reason.

    If nothing is known of the type's package, the data may fit.
    """
    misfit_reasons = {}
    try:
        for distribution, answer in _by_distribution(data, interfaces):
            if answer is not None:
                reasons = [fault.message for fault in answer if fault.is_used(uses) and not fault.unknown]
            elif distribution.names(data.ros_type.package, data.part.kind):
                reasons = [f"there is no {data.ros_type}"]
            else:
                reasons = []
            if reasons:
                misfit_reasons[distribution.name] = reasons[0]
    except DefinitionError:
        return {}
    return misfit_reasons


def _by_distribution(
    data: CommunicationData, interfaces: RosTypes
) -> Iterator[tuple[RosDistribution, list[Fault] | None]]:
    """Yield the mismatches in each ROS version; None if it has no such type. Raises DefinitionError."""
    ros_type, part = data.ros_type, data.part
    for distribution in interfaces.distributions:
        fields = distribution.fields(ros_type.package, ros_type.name, part)
        if fields is None:
            yield distribution, None
        else:
            yield (
                distribution,
                list(_Comparison(distribution, data).whole(data.declared, fields, _name(ros_type, part))),
            )


class _Comparison:
    def __init__(self, distribution: RosDistribution, data: CommunicationData) -> None:
        self._distribution = distribution
        self._ros_type = data.ros_type
        self._is_received = data.is_received
        self._around: list[tuple[object, NestedType]] = []

    def whole(self, declared: rsc.DataType, fields: Fields, name: str) -> Iterator[Fault]:
        """Yield the mismatches of a section: objects field by field, a basic value with the only field."""
        carried = wire_type(declared)
        if isinstance(carried, rsc.InterfaceTypeReference) and _ros_type(carried) != self._ros_type:
            message = f"the data is {_ros_type(carried)} here, and the communication is {self._ros_type}"
            yield Fault(None, message, f"write `{self._ros_type}`", text=str(self._ros_type))
        elif isinstance(carried, rsc.ComplexDataTypeReference):
            if isinstance(carried.type, rsc.ObjectDataType):
                yield from self._object(carried.type, fields, name)
        elif isinstance(carried, rsc.BasicDataType) and not isinstance(carried, rsc.NoneDataType):
            field = next(iter(fields)) if len(fields) == 1 else "data"
            if field not in fields:
                message = f"{name} has no field for a lone {_text(carried)}: {_listed(fields)}"
                yield Fault(None, message, _lone(fields), text=None if fields else "none")
            elif not self._holds(fields[field], carried):
                message = f"the data is {_text(carried)} here, and {fields[field]} in `{field}` of {name}"
                # Arrays and types with fields of their own occur only in objects.
                lone = isinstance(fields[field], Basic)
                repair, text = _repair(fields[field], None if lone else field)
                yield Fault(
                    None, message, repair if lone else f"declare an object: {repair}", text=text if lone else None
                )

    def _object(self, definition: rsc.ObjectDataType, fields: Fields, name: str) -> Iterator[Fault]:
        for owner in definition.properties:
            if owner.name in fields:
                yield from self._property(owner, fields[owner.name], name)
            else:
                close = get_close_matches(owner.name, fields, n=1)
                hint = f"did you mean `{close[0]}`?" if close else "write an existing field, or leave this one out"
                others = {field: fitting for field in fields if (fitting := _type_for(fields[field])) is not None}
                taken = {other.name for other in definition.properties}
                others = {field: fitting for field, fitting in others.items() if field not in taken}
                fitting = _type_for(fields[close[0]]) if close and isinstance(owner.type, rsc.BasicDataType) else None
                text = f"{escape_keyword(close[0])}: {fitting}" if fitting is not None else None
                message = f"`{owner.name}` is not a field of {name}: {_listed(fields)}"
                yield Fault(
                    owner,
                    message,
                    hint,
                    text=text,
                    new_name=close[0] if close and text is None else None,
                    is_guess=True,
                    others=None if close else others,
                )

    def _property(self, owner: rsc.ObjectProperty, wire: WireType, name: str) -> Iterator[Fault]:
        declared, element = wire_type(owner.type), wire
        while isinstance(declared, rsc.Array) and isinstance(element, Sequence):
            declared, element = wire_type(declared.type), element.element
        definition = declared.type if isinstance(declared, rsc.ComplexDataTypeReference) else None
        if isinstance(declared, rsc.InterfaceTypeReference) and _ros_type(declared) != element:
            message = f"`{owner.name}` is {_text(owner.type)} here, and {wire} in {name}"
            hint, text = _repair(wire, owner.name)
            yield Fault(owner, message, hint, text=text, others=None if text else {})
        elif isinstance(definition, rsc.ObjectDataType) and isinstance(element, NestedType):
            yield from self._nested(owner, definition, element)
        elif declared is not None and not _is_open(declared) and not self._holds(element, declared):
            message = f"`{owner.name}` is {_text(owner.type)} here, and {wire} in {name}"
            hint, text = _repair(wire, owner.name)
            yield Fault(owner, message, hint, text=text, others=None if text else {})

    def _nested(self, owner: rsc.ObjectProperty, definition: rsc.ObjectDataType, wire: NestedType) -> Iterator[Fault]:
        if (definition, wire) in self._around:
            return  # ROS has no type that contains itself, and `data-type` reports such a model.
        try:
            fields = self._distribution.fields(wire.package, wire.name, Section.MESSAGE)
        except DefinitionError as fault:
            message = f"the definition of {wire}, the type of `{owner.name}`, cannot be read: {fault}"
            yield Fault(owner, message, REPAIR, unknown=True)
            return
        if fields is None:
            yield Fault(owner, f"{wire}, the type of `{owner.name}` in ROS, is unknown", MAKE_KNOWN, unknown=True)
            return
        self._around.append((definition, wire))
        yield from self._object(definition, fields, str(wire))
        self._around.pop()

    def _holds(self, wire: WireType, declared: rsc.DataType) -> bool:
        """Return whether a wire type holds values of a type; received integers may become doubles."""
        primitive = PRIMITIVES.get(wire.name) if isinstance(wire, Basic) else None
        if primitive is None or not isinstance(declared, rsc.BasicDataType):
            return False
        text = _text(declared)
        return primitive.name == text or (self._is_received and (primitive.name, text) == ("integer", "double"))


def _name(ros_type: NestedType, part: Section) -> str:
    return str(ros_type) if part is Section.MESSAGE else f"the {part.name.lower()} of {ros_type}"


def wire_type(declared: rsc.DataType | None) -> rsc.DataType | None:
    """Return the wire type: the base type of an enum, or the type itself."""
    seen: list[rsc.DataType] = []
    while (
        isinstance(declared, rsc.ComplexDataTypeReference)
        and isinstance(declared.type, rsc.EnumDataType)
        and declared not in seen
    ):
        seen.append(declared)
        declared = declared.type.type
    return declared


def _ros_type(reference: rsc.InterfaceTypeReference) -> NestedType:
    return NestedType(reference.package, reference.rosType)


def _is_open(declared: rsc.DataType) -> bool:
    """Return whether a type is undecided: a name without definition, or no data at all."""
    return isinstance(declared, rsc.NoneDataType) or (
        isinstance(declared, rsc.ComplexDataTypeReference) and not isinstance(declared.type, rsc.ObjectDataType)
    )


def _text(declared: rsc.DataType) -> str:
    return str(declared_type(declared))


def _listed(fields: Fields) -> str:
    return f"it has {', '.join(f'`{field}`' for field in fields)}" if fields else "it has none"


def _lone(fields: Fields) -> str:
    return "declare an object with the fields that you use" if fields else "write `none`"


def _repair(wire: WireType, name: str | None) -> tuple[str, str | None]:
    """Return a hint and the text that it proposes."""
    fitting = _type_for(wire)
    if fitting is None:
        return f"leave it out: no data type fits {wire}" if name else f"write `none`: no data type fits {wire}", None
    text = f"{escape_keyword(name)}: {fitting}" if name else fitting
    return f"write `{text}`", text


def _type_for(wire: WireType) -> str | None:
    if isinstance(wire, Sequence):
        element = _type_for(wire.element)
        return None if element is None else f"array({element})"
    if isinstance(wire, NestedType):
        return str(wire)
    primitive = PRIMITIVES.get(wire.name)
    return None if primitive is None else primitive.name
