"""Table 4.1 cell by cell, and the types of names and events."""

from itertools import product

import pytest

from robosc.model import expression as ex
from robosc.model import robosc as rsc
from robosc.model.semantics.typing import (
    BOOLEAN,
    DOUBLE,
    INTEGER,
    NONE,
    STRING,
    UNKNOWN,
    ArrayType,
    EnumType,
    ObjectType,
    Type,
    declared_type,
    event_data_type,
    infer,
    provided_data_type,
    type_of,
    value_type,
)

POINT = rsc.ObjectDataType(name="Point", properties=[rsc.ObjectProperty(name="x", type=rsc.DoubleDataType())])
COLOUR = rsc.EnumDataType(
    name="Colour", type=rsc.StringDataType(), rules=[rsc.EnumDefaultRule(value=rsc.EnumValue(name="red"))]
)
ALL: list[Type] = [BOOLEAN, INTEGER, DOUBLE, STRING, NONE, ArrayType(DOUBLE), ObjectType(POINT), EnumType(COLOUR)]
BOOLEAN_OPERATORS = [
    ex.Implication,
    ex.Disjunction,
    ex.Conjunction,
    ex.Equation,
    ex.Inequation,
    ex.LessThan,
    ex.LessOrEqual,
    ex.GreaterThan,
    ex.GreaterOrEqual,
]
SUMS: dict[tuple[Type, Type], Type] = {
    (INTEGER, INTEGER): INTEGER,
    (INTEGER, DOUBLE): DOUBLE,
    (DOUBLE, INTEGER): DOUBLE,
    (DOUBLE, DOUBLE): DOUBLE,
    (UNKNOWN, DOUBLE): DOUBLE,
    (DOUBLE, UNKNOWN): DOUBLE,
}


def data_type(kind: Type) -> rsc.DataType | None:
    match kind:
        case ArrayType():
            return rsc.Array(type=data_type(kind.element))
        case ObjectType() | EnumType():
            return rsc.ComplexDataTypeReference(type=kind.definition)
    basic = {
        BOOLEAN: rsc.BooleanDataType,
        INTEGER: rsc.IntegerDataType,
        DOUBLE: rsc.DoubleDataType,
        STRING: rsc.StringDataType,
        NONE: rsc.NoneDataType,
    }
    return basic[kind]() if kind in basic else None


def variable(kind: Type) -> rsc.Access:
    """Return an expression of a type: for UNKNOWN, an access without an item."""
    if kind == UNKNOWN:
        return rsc.Access()
    return rsc.Access(item=rsc.Variable(name="v", type=data_type(kind)))


@pytest.mark.parametrize("kind", [*ALL, UNKNOWN], ids=str)
def test_variable_has_its_declared_type(kind: Type) -> None:
    assert declared_type(data_type(kind)) == kind
    assert infer(variable(kind)) == kind


@pytest.mark.parametrize(
    ("literal", "expected"),
    [
        (ex.BooleanLiteral(value=True), BOOLEAN),
        (ex.IntegerLiteral(value=1), INTEGER),
        (ex.DoubleLiteral(value=1.0), DOUBLE),
        (ex.StringLiteral(value="1"), STRING),
        (rsc.ObjectValue(), UNKNOWN),
        (None, UNKNOWN),
    ],
)
def test_literal(literal: ex.Expression | None, expected: Type) -> None:
    assert infer(literal) == expected


def test_comparisons_and_logic_are_boolean() -> None:
    for operator, left in product(BOOLEAN_OPERATORS, [*ALL, UNKNOWN]):
        assert infer(operator(left=variable(left), right=variable(INTEGER))) == BOOLEAN
        assert infer(operator(left=variable(BOOLEAN), right=variable(left))) == BOOLEAN
        assert infer(ex.Negation(operand=variable(left))) == BOOLEAN


@pytest.mark.parametrize("operator", [ex.Addition, ex.Subtraction, ex.Multiplication])
def test_arithmetic(operator: type[ex.BinaryExpression]) -> None:
    sums = SUMS | ({(STRING, STRING): STRING} if operator is ex.Addition else {})
    for left, right in product([*ALL, UNKNOWN], repeat=2):
        assert infer(operator(left=variable(left), right=variable(right))) == sums.get((left, right), UNKNOWN)


def test_quotient_is_always_double() -> None:
    for left, right in product([*ALL, UNKNOWN], repeat=2):
        assert infer(ex.Division(left=variable(left), right=variable(right))) == DOUBLE


@pytest.mark.parametrize("kind", [*ALL, UNKNOWN], ids=str)
def test_minus_keeps_the_type_of_a_number(kind: Type) -> None:
    assert infer(ex.UnaryMinus(operand=variable(kind))) == (kind if kind in {INTEGER, DOUBLE} else UNKNOWN)


def test_names() -> None:
    assert infer(rsc.Access(item=rsc.State(name="on"))) == BOOLEAN
    assert infer(rsc.Access(item=COLOUR.rules[0].value)) == EnumType(COLOUR)
    assert infer(rsc.Access(item=rsc.Component(name="Lamp"))) == UNKNOWN


def test_a_service_and_an_action_of_one_name_have_different_types() -> None:
    def request(communication: type[rsc.Service | rsc.Action]) -> ObjectType:
        definition = rsc.ObjectDataType(name="Dock")
        communication(requestType=rsc.InterfaceTypeReference(package="p", rosType="Dock", definition=definition))
        return ObjectType(definition)

    assert request(rsc.Service) == request(rsc.Service) != request(rsc.Action)


def test_types_with_a_definition_are_nominal() -> None:
    other = rsc.EnumDataType(name="Colour")
    assert EnumType(COLOUR) != EnumType(other)
    assert ArrayType(EnumType(COLOUR)) == ArrayType(EnumType(COLOUR))
    assert str(ArrayType(ArrayType(ObjectType(POINT)))) == "array(array(object Point))"


def test_range_is_no_part_of_the_type() -> None:
    assert declared_type(rsc.IntegerDataType(minimum=0, maximum=5)) == INTEGER


def test_segments() -> None:
    grid = ArrayType(ArrayType(ObjectType(POINT)))
    index, x = rsc.IndexSegment(index=0), rsc.PropertySegment(property=POINT.properties[0])
    read = rsc.Access(value=True, segments=[index, rsc.IndexSegment(index=3), x])
    assert infer(read, grid) == DOUBLE
    assert infer(read, ArrayType(DOUBLE)) == DOUBLE  # A resolved property has its own type, whatever precedes it.
    assert infer(rsc.Access(value=True, segments=[rsc.IndexSegment(index=0)]), grid) == ArrayType(ObjectType(POINT))
    assert infer(rsc.Access(value=True, segments=[rsc.IndexSegment(index=0)]), DOUBLE) == UNKNOWN
    assert infer(rsc.Access(value=True, segments=[rsc.PropertySegment()]), ObjectType(POINT)) == UNKNOWN
    assert infer(rsc.Access(value=True)) == UNKNOWN


def result(name: str) -> rsc.ResultType:
    found: rsc.ResultType = getattr(rsc.ResultType, name)
    return found


MESSAGE_OUT = rsc.Message(direction=rsc.MessageDirection.outgoing, type=rsc.DoubleDataType())
MESSAGE_IN = rsc.Message(direction=rsc.MessageDirection.incoming, type=rsc.DoubleDataType())
SERVICE = rsc.Service(requestType=rsc.IntegerDataType(), responseType=rsc.BooleanDataType())
ACTION = rsc.Action(
    requestType=rsc.IntegerDataType(), responseType=rsc.BooleanDataType(), feedbackType=rsc.StringDataType()
)


@pytest.mark.parametrize(
    ("communication", "event", "expected"),
    [
        (MESSAGE_OUT, "response", DOUBLE),
        (MESSAGE_OUT, "request", UNKNOWN),
        (MESSAGE_IN, "request", DOUBLE),
        (MESSAGE_IN, "error", UNKNOWN),
        (SERVICE, "request", INTEGER),
        (SERVICE, "response", BOOLEAN),
        (SERVICE, "error", None),
        (SERVICE, "feedback", UNKNOWN),
        (SERVICE, "cancel", UNKNOWN),
        (ACTION, "request", INTEGER),
        (ACTION, "response", BOOLEAN),
        (ACTION, "feedback", STRING),
        (ACTION, "error", BOOLEAN),
        (ACTION, "cancel", None),
        (None, "response", UNKNOWN),
    ],
)
def test_data_of_an_event(communication: rsc.CommunicationType | None, event: str, expected: Type | None) -> None:
    assert event_data_type(communication, result(event)) == expected


def test_data_that_goes_out() -> None:
    assert provided_data_type(MESSAGE_IN) == DOUBLE
    assert provided_data_type(MESSAGE_OUT) == UNKNOWN
    assert provided_data_type(SERVICE) == INTEGER
    assert provided_data_type(ACTION) == INTEGER
    assert provided_data_type(None) == UNKNOWN


def test_value_means_what_its_place_says() -> None:
    in_transition, in_enum, in_guard = (rsc.Access(value=True) for _ in range(3))
    rsc.ResultTransition(
        resultType=result("feedback"),
        communicationType=rsc.CommunicationReference(communicationType=ACTION),
        assignments=[rsc.Assignment(value=ex.Equation(left=in_transition))],
    )
    rsc.EnumDataType(type=rsc.DoubleDataType(), rules=[rsc.EnumTransformationRule(condition=in_enum)])
    rsc.TauTransition(guard=in_guard)
    assert (type_of(in_transition), type_of(in_enum), type_of(in_guard)) == (STRING, DOUBLE, UNKNOWN)
    assert value_type(in_guard) is None
    assert value_type(rsc.ResultTransition()) == UNKNOWN
