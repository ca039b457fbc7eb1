"""Types of expressions: thesis table 4.1, made strict by the language reference; also for sct and rosgraph models.

Types are values. The basic types are members of `BasicType`. Arrays are equal if their elements are; objects and enums
are equal if their definition is the same (nominal typing). An unknown type, such as that of an unresolved name, is
`UNKNOWN`: it fits everywhere and causes no finding. The range of an integer is no part of its type.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Any, TypeAlias

from robosc.model import expression as ex
from robosc.model import robosc as rsc
from robosc.model import rosgraph, sct
from robosc.model.semantics.communication import (
    data_type,
    event,
    port_event_of,
    provided_event,
    section_of,
    sent_type,
)
from robosc.model.semantics.naming import escape_keyword
from robosc.model.semantics.operators import CONDITIONS, Operator, TypeRule, operator_of
from robosc.model.semantics.walks import copy_tree, fold, parts

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence


class BasicType(StrEnum):
    """Types without a definition, and UNKNOWN."""

    BOOLEAN = "boolean"
    INTEGER = "integer"
    DOUBLE = "double"
    STRING = "string"
    NONE = "none"
    UNKNOWN = "unknown"


@dataclass(frozen=True)
class ArrayType:
    """An array of values of one type."""

    element: Type

    def __str__(self) -> str:
        return f"array({self.element})"


@dataclass(frozen=True, eq=False)
class ObjectType:
    """An object data type. Objects that ROS defines are the same type if they name the same ROS type."""

    definition: rsc.ObjectDataType

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ObjectType) and self._identity == other._identity

    def __hash__(self) -> int:
        return hash(self._identity)

    @property
    def _identity(self) -> Any:
        unit: Any = self.definition.eContainer()
        if not isinstance(unit, rsc.InterfaceTypeReference):
            return self.definition
        return unit.package, unit.rosType, section_of(unit)

    @property
    def qualified_name(self) -> str:
        """Unambiguous name of the object in a model."""
        unit: Any = self.definition.eContainer()
        if isinstance(unit, rsc.InterfaceTypeReference):
            return f"{unit.package}/{unit.rosType}"
        return escape_keyword(self.definition.name)

    def __str__(self) -> str:
        return f"object {self.definition.name}"


@dataclass(frozen=True)
class EnumType:
    """An enum data type, or the enumeration that it becomes in an sct or rosgraph model."""

    definition: Any

    def __str__(self) -> str:
        return f"enum {self.definition.name}"


Type: TypeAlias = BasicType | ArrayType | ObjectType | EnumType

BOOLEAN, INTEGER, DOUBLE, STRING, NONE, UNKNOWN = BasicType

_BASIC: Mapping[type[rsc.DataType] | type[ex.Type], BasicType] = {
    rsc.BooleanDataType: BOOLEAN,
    ex.BooleanType: BOOLEAN,
    rsc.IntegerDataType: INTEGER,
    ex.IntegerType: INTEGER,
    rsc.DoubleDataType: DOUBLE,
    ex.DoubleType: DOUBLE,
    rsc.StringDataType: STRING,
    ex.StringType: STRING,
    rsc.NoneDataType: NONE,
}
_LITERAL: Mapping[type[ex.Expression], BasicType] = {
    ex.BooleanLiteral: BOOLEAN,
    ex.IntegerLiteral: INTEGER,
    ex.DoubleLiteral: DOUBLE,
    ex.StringLiteral: STRING,
}


def declared_type(data_type: rsc.DataType | ex.Type | None) -> Type:
    """Return the type that a declaration names. UNKNOWN if it is missing or its name is unresolved."""
    if isinstance(data_type, ex.EnumerationType):
        return EnumType(data_type.enumeration)
    if isinstance(data_type, rsc.Array):
        return ArrayType(declared_type(data_type.type))
    if isinstance(data_type, rosgraph.ArrayType):
        return ArrayType(declared_type(data_type.element))
    if isinstance(data_type, rsc.ComplexDataTypeReference):
        definition = data_type.type
        if isinstance(definition, rsc.ObjectDataType):
            return ObjectType(definition)
        return EnumType(definition) if isinstance(definition, rsc.EnumDataType) else UNKNOWN
    return UNKNOWN if data_type is None else _BASIC.get(type(data_type), UNKNOWN)


def event_data_type(communication: rsc.CommunicationType | None, result_type: rsc.ResultType | None) -> Type | None:
    """Return the type of the data that an event carries, which `value` reads.

    None for events without data, such as cancels. UNKNOWN if the communication has no such event (rule `result-type`)
    or is unresolved.
    """
    row = event(communication, result_type)
    if row is None:
        return UNKNOWN
    return declared_type(data_type(communication, row)) if row.feature else None


def provided_data_type(communication: rsc.CommunicationType | None) -> Type:
    """Return the type of the data that a communication sends: of a message or a request.

    Return UNKNOWN if it sends nothing (the component itself sends an outgoing message, rule `data-provisioning`) or is
    unresolved.
    """
    return declared_type(sent_type(communication))


def provided_type(statement: rsc.DataStatement) -> Type:
    """Return the type of the data that a `provide` statement or a limit determines; UNKNOWN if there is none."""
    return declared_type(data_type(_communication(statement.communicationType), provided_event(statement)))


def object_value_type(value: rsc.ObjectValue) -> Type:
    """Return the type that an object value needs at its place in provided data; UNKNOWN in any other expression."""
    around = value.eContainer()
    while isinstance(around, ex.Conditional):
        around = around.eContainer()
    if isinstance(around, rsc.DataStatement):
        return provided_type(around)
    is_property = isinstance(around, rsc.ObjectPropertyValue) and around.property
    return declared_type(around.property.type) if is_property else UNKNOWN


def value_type(element: ex.Located) -> Type | None:
    """Return the type of `value` at a place in the model. None if there is no `value`.

    In the condition of a requirement on several commands, it is the type of the first one.
    """
    return next(iter(value_types(element)), None)


def value_types(element: ex.Located) -> Sequence[Type]:
    """Return the types of `value` at a place in the model; none if there is no `value`.

    Inside an enum, `value` is the enum's source. Inside a transition, it is the data of its event; only the guard may
    read that of an event that the controller sends. Inside a limit, it is the data of its message. In the condition of
    a requirement, it is the data of each of its commands.
    """
    inside, around = None, element
    while around is not None:
        match around:
            case rsc.EnumDataType():
                return (declared_type(around.type),)
            case rsc.ResultTransition():
                in_guard = inside is not None and inside is around.guard
                communication = _communication(around.communicationType)
                row = event(communication, around.resultType)
                is_sent = around.resultType == rsc.ResultType.request if row is None else row.is_sent
                if communication is not None and is_sent and not in_guard:
                    return ()
                kind = event_data_type(communication, around.resultType)
                return () if kind is None else (kind,)
            case rsc.RequirementTransition():
                named = around.event
                row = None if named is None else port_event_of(named)
                if named is None or row is None or not row.is_sent:
                    return ()
                return (declared_type(data_type(_communication(named.communicationType), row)),)
            case rsc.LimitStatement():
                return (_sent(around.communicationType),)
            case rsc.CommunicationRequirement() if inside is around.condition and around.target is not None:
                return tuple(dict.fromkeys(map(_sent, around.target.communicationTypes)))
        inside, around = around, around.eContainer()
    return ()


def _communication(reference: rsc.CommunicationReference | None) -> rsc.CommunicationType | None:
    return reference.communicationType if reference else None


def _sent(reference: rsc.CommunicationReference | None) -> Type:
    return provided_data_type(_communication(reference))


def read_from(expression: ex.Expression, value: Type) -> ex.Expression:
    """Return an expression that reads the same fields from data of the type `value`.

    It is the expression itself if it reads that type already, else a copy. Fields that the type lacks stay as they are.
    """
    accesses = [part for part in parts(expression) if isinstance(part, rsc.Access) and part.value]
    if all(_resolved(access, value) == [*map(_property_of, access.segments)] for access in accesses):
        return expression
    copy = copy_tree(expression)
    for part in parts(copy):
        if isinstance(part, rsc.Access) and part.value:
            for segment, prop in zip(part.segments, _resolved(part, value), strict=True):
                if isinstance(segment, rsc.PropertySegment) and prop is not None:
                    segment.property = prop
    return copy


def _property_of(segment: rsc.AccessSegment) -> rsc.ObjectProperty | None:
    return segment.property if isinstance(segment, rsc.PropertySegment) else None


def _resolved(access: rsc.Access, value: Type) -> list[rsc.ObjectProperty | None]:
    """Return the properties that an access reads from data of a type, by their names; None for an index."""
    kind, resolved = value, list[rsc.ObjectProperty | None]()
    for segment in access.segments:
        original = _property_of(segment)
        prop: rsc.ObjectProperty | None = None
        if original is not None and kind == ObjectType(original.eContainer()):
            prop, kind = original, declared_type(original.type)
        elif original is not None:
            properties = kind.definition.properties if isinstance(kind, ObjectType) else ()
            prop = next((other for other in properties if other.name == original.name), None)
            kind = declared_type(prop.type if prop else None)
        else:
            kind = segment_type(kind, segment)
        resolved.append(prop)
    return resolved


def is_number(kind: Type) -> bool:
    """Return whether a type is integer or double."""
    return kind in {INTEGER, DOUBLE}


def operator_type(row: Operator, operands: Sequence[Type]) -> Type:
    """Return the type of an operator's value for the types of its operands.

    A condition is boolean for any operands. UNKNOWN for a call with wrong arguments, and for arithmetic with operands
    that are unknown or no numbers.
    """
    if row.parameters not in {0, len(operands)}:
        return UNKNOWN  # the rule `argument`
    if row.rule in CONDITIONS:
        return BOOLEAN
    if row.rule is TypeRule.DOUBLE:
        return DOUBLE
    if row.rule in {TypeRule.ROUNDING, TypeRule.SIZE}:
        return INTEGER
    if row.rule is TypeRule.INTEGER:
        return INTEGER if {*operands} == {INTEGER} else UNKNOWN
    if row.rule is TypeRule.ELEMENTS:
        (array,) = operands
        return array.element if isinstance(array, ArrayType) and is_number(array.element) else UNKNOWN
    if row.metaclass is ex.Addition and {*operands} == {STRING}:
        return STRING  # in constant expressions
    if not all(is_number(operand) or operand == UNKNOWN for operand in operands):
        return UNKNOWN
    if DOUBLE in operands:
        return DOUBLE
    return UNKNOWN if UNKNOWN in operands else INTEGER


def item_type(item: rsc.AccessibleItem | None) -> Type:
    """Return the type of a name's value.

    A state is a boolean. A bare component has no value and is UNKNOWN.
    """
    match item:
        case rsc.State() | rsc.RequirementState() | rsc.CommunicationType():
            return BOOLEAN
        case rsc.Variable() | rsc.Constant() | rsc.Parameter() | rsc.FormalParameter():
            return declared_type(item.type)
        case rsc.Condition():
            return BOOLEAN
        case rsc.EnumValue():
            return EnumType(item.eContainer().eContainer())
        case rsc.ArrayElement():
            quantifier = item.eContainer()
            array = infer(quantifier.array, value_type(quantifier))
            return array.element if isinstance(array, ArrayType) else UNKNOWN
    return UNKNOWN


def segment_type(before: Type, segment: rsc.AccessSegment) -> Type:
    """Return the type after one step into data of type `before`. UNKNOWN if the step is invalid."""
    match segment:
        case rsc.PropertySegment():
            return declared_type(segment.property.type) if segment.property else UNKNOWN
        case rsc.IndexSegment() if isinstance(before, ArrayType):
            return before.element if segment.last is None else before
    return UNKNOWN


def start_type(access: rsc.Access, value: Type | None = None) -> Type:
    """Return the type of the first item of an access; `value` as for `access_types`."""
    return (UNKNOWN if value is None else value) if access.value else item_type(access.item)


def access_types(access: rsc.Access, value: Type | None = None) -> list[Type]:
    """Return the types along an access: of its first item, then after each of its segments.

    `value` is the type of `value` at this place, None if there is no `value`.
    """
    types = [start_type(access, value)]
    for segment in access.segments:
        types.append(segment_type(types[-1], segment))
    return types


class Types:
    """Types of expressions of any model. Each expression is typed only once.

    Reports no errors: an expression without a type is UNKNOWN. `value` is the type of `value` in the text, None if
    there is no `value`. An object value gets its type from the communication that it is provided to; alone it is
    UNKNOWN.
    """

    def __init__(self, value: Type | None = None) -> None:
        self._value = value
        self._known: dict[ex.Expression, Type] = {}

    def __call__(self, expression: ex.Expression | None) -> Type:
        """Return the type of an expression."""
        return UNKNOWN if expression is None else fold(self._type, expression, memo=self._known)

    def _type(self, expression: ex.Expression, operands: list[Type]) -> Type:
        row = operator_of(expression)
        if row is not None:
            return operator_type(row, operands)
        match expression:
            case rosgraph.ArrayLiteral():
                return ArrayType(operands[0]) if operands else UNKNOWN
            case ex.Conditional():
                return operands[1] if operands[1] != UNKNOWN else operands[2]
            case rsc.Access():
                return access_types(expression, self._value)[-1]
            case rsc.Call():
                return declared_type(expression.function.type) if expression.function else UNKNOWN
            case rsc.IntegerText():
                return STRING
            case rsc.ErrorReason():
                return EnumType(expression.enumeration) if expression.enumeration else UNKNOWN
            case rosgraph.IfReadable():
                return operands[0]
            case rsc.InstanceQuantifier() | rsc.ArrayQuantifier():
                return INTEGER if expression.quantifier == rsc.Quantifier.count else BOOLEAN
        return _reference_type(expression)


def _reference_type(expression: ex.Expression) -> Type:
    """Return the type of a literal, or of a reference in an sct or rosgraph model."""
    match expression:
        case ex.EnumerationLiteralReference():
            return EnumType(expression.literal.eContainer())
        case sct.LocationReference():
            return BOOLEAN
        case sct.VariableReference() | rosgraph.NodeVariableReference():
            return declared_type(expression.variable.type)
        case sct.InputReference():
            return declared_type(expression.input.type)
        case rosgraph.WireAccess():
            return declared_type(expression.type)
        case rosgraph.ArrayQuantifier():
            return INTEGER if expression.quantifier == rosgraph.Quantifier.count else BOOLEAN
        case rosgraph.ConversionCall():
            return EnumType(expression.conversion.enumeration)
        case rosgraph.ErrorReason():
            return EnumType(expression.enumeration)
    return _LITERAL.get(type(expression), UNKNOWN)


def infer(expression: ex.Expression | None, value: Type | None = None) -> Type:
    """Return the type of one expression; `value` as for `Types`."""
    return Types(value)(expression)


def type_of(expression: ex.Expression) -> Type:
    """Return the type of an expression of a model. Its place in the model determines the type of `value`."""
    return infer(expression, value_type(expression))
