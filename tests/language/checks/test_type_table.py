"""Each cell of table 4.1: the operand types that each operator accepts."""

from itertools import product

import pytest

from robosc.language.checks import check
from robosc.language.checks.expression_types import ExpressionCheck, Place
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
    BasicType,
    EnumType,
    ObjectType,
    Type,
)

ENUM, OTHER_ENUM = EnumType(rsc.EnumDataType(name="E")), EnumType(rsc.EnumDataType(name="F"))
OBJECT = ObjectType(rsc.ObjectDataType(name="O"))
TYPES: list[Type] = [BOOLEAN, INTEGER, DOUBLE, STRING, NONE, ArrayType(DOUBLE), OBJECT, ENUM, OTHER_ENUM]
BOOLEANS = {(BOOLEAN, BOOLEAN)}
NUMBERS = {(INTEGER, INTEGER), (INTEGER, DOUBLE), (DOUBLE, INTEGER), (DOUBLE, DOUBLE)}
EQUALS = {(kind, kind) for kind in (BOOLEAN, INTEGER, DOUBLE, STRING, ENUM, OTHER_ENUM)}
ACCEPTED: dict[type[ex.BinaryExpression], set[tuple[Type, Type]]] = {
    ex.Implication: BOOLEANS,
    ex.Disjunction: BOOLEANS,
    ex.Conjunction: BOOLEANS,
    ex.Equation: EQUALS,
    ex.Inequation: EQUALS,
    ex.LessThan: NUMBERS,
    ex.LessOrEqual: NUMBERS,
    ex.GreaterThan: NUMBERS,
    ex.GreaterOrEqual: NUMBERS,
    ex.Addition: NUMBERS,
    ex.Subtraction: NUMBERS,
    ex.Multiplication: NUMBERS,
    ex.Division: NUMBERS,
}


def operand(kind: Type) -> rsc.Access:
    match kind:
        case ArrayType():
            declared: rsc.DataType = rsc.Array(type=rsc.DoubleDataType())
        case BasicType():
            basic = {
                BOOLEAN: rsc.BooleanDataType,
                INTEGER: rsc.IntegerDataType,
                DOUBLE: rsc.DoubleDataType,
                STRING: rsc.StringDataType,
                NONE: rsc.NoneDataType,
            }
            if kind not in basic:
                return rsc.Access()
            declared = basic[kind]()
        case _:
            declared = rsc.ComplexDataTypeReference(type=kind.definition)
    return rsc.Access(item=rsc.Variable(name="v", type=declared))


def faults(expression: ex.Expression) -> list[ex.Located]:
    """Return the elements with a finding in an expression."""
    check = ExpressionCheck(Place(None))
    check.type(expression)
    assert all(finding.message and finding.hint for finding in check.findings)
    return [finding.element for finding in check.findings]


@pytest.mark.parametrize("operator", ACCEPTED)
def test_operator_accepts_exactly_the_operands_of_the_table(operator: type[ex.BinaryExpression]) -> None:
    for left, right in product(TYPES, TYPES):
        expression = operator(left=operand(left), right=operand(right))
        accepted = (left, right) in ACCEPTED[operator]
        assert bool(faults(expression)) is not accepted, f"{left} {operator.__name__} {right}"


@pytest.mark.parametrize("operator", ACCEPTED)
def test_what_is_unknown_draws_nothing(operator: type[ex.BinaryExpression]) -> None:
    fitting = {left for left, _ in ACCEPTED[operator]}
    for kind in [*TYPES, UNKNOWN]:
        alone = kind == UNKNOWN or kind in fitting
        for expression in (
            operator(left=operand(kind), right=operand(UNKNOWN)),
            operator(left=operand(UNKNOWN), right=operand(kind)),
        ):
            assert len(faults(expression)) == (0 if alone else 1)


@pytest.mark.parametrize("kind", [*TYPES, UNKNOWN], ids=str)
def test_unary_operators(kind: Type) -> None:
    negation, minus = ex.Negation(operand=operand(kind)), ex.UnaryMinus(operand=operand(kind))
    assert faults(negation) == ([] if kind in {BOOLEAN, UNKNOWN} else [negation.operand])
    assert faults(minus) == ([] if kind in {INTEGER, DOUBLE, UNKNOWN} else [minus.operand])


def test_each_wrong_operand_is_a_finding_of_its_own() -> None:
    both = ex.Conjunction(left=operand(INTEGER), right=operand(STRING))
    assert faults(both) == [both.left, both.right]


def test_a_fault_does_not_spread() -> None:
    inner = ex.Addition(left=operand(STRING), right=operand(INTEGER))
    assert faults(ex.Equation(left=inner, right=operand(STRING))) == [inner.left]


@pytest.mark.parametrize("wanted", TYPES, ids=str)
@pytest.mark.parametrize("found", TYPES, ids=str)
def test_a_place_accepts_exactly_its_type(wanted: Type, found: Type) -> None:
    check = ExpressionCheck(Place(None))
    check.expect(operand(found), wanted, "it")
    assert bool(check.findings) == (wanted != found)
    for finding in check.findings:
        assert finding.message == f"it must be {wanted}, found {found}"
        assert finding.hint


def test_types_of_one_name_are_told_apart() -> None:
    ours, theirs = rsc.EnumDataType(name="Colour"), rsc.EnumDataType(name="Colour")
    rsc.Robot(name="House", definitions=[ours])
    rsc.Library(name="Paints", definitions=[theirs])
    check = ExpressionCheck(Place(None))
    check.expect(operand(EnumType(theirs)), EnumType(ours), "it")
    assert [finding.message for finding in check.findings] == [
        "it must be enum Colour of robot House, found enum Colour of library Paints"
    ]


@pytest.mark.parametrize(
    ("literal", "wanted", "repair"),
    [
        (ex.IntegerLiteral(value=0), DOUBLE, "write `0.0`"),
        (ex.UnaryMinus(operand=ex.IntegerLiteral(value=3)), DOUBLE, "write `-3.0`"),
        (ex.DoubleLiteral(value=4.0), INTEGER, "write `4`"),
        (ex.UnaryMinus(operand=ex.DoubleLiteral(value=4.0)), INTEGER, "write `-4`"),
        (
            ex.DoubleLiteral(value=4.5),
            INTEGER,
            "write a whole number or declare it double: RoboSC never rounds implicitly",
        ),
        (ex.IntegerLiteral(value=1), BOOLEAN, "write `true`"),
        (ex.IntegerLiteral(value=0), BOOLEAN, "write `false`"),
        (ex.UnaryMinus(operand=ex.IntegerLiteral(value=1)), BOOLEAN, "compare it, such as `(…) > 0`"),
        (ex.IntegerLiteral(value=2), BOOLEAN, "write `true` or `false`"),
        (ex.StringLiteral(value="false"), BOOLEAN, "write `false`"),
        (ex.BooleanLiteral(value=True), STRING, 'write `"true"`'),
        (ex.DoubleLiteral(value=0.5), STRING, 'write `"0.5"`'),
    ],
)
def test_repair_of_a_literal(literal: ex.Expression, wanted: Type, repair: str) -> None:
    check = ExpressionCheck(Place(None))
    check.expect(literal, wanted, "it")
    assert [getattr(finding.hint, "hint", finding.hint) for finding in check.findings] == [repair]


@pytest.mark.parametrize(
    "item", [rsc.State(name="on"), rsc.Variable(name="v", type=rsc.BooleanDataType()), rsc.Component(name="Lamp")]
)
def test_enum_rules_read_nothing_that_changes(item: rsc.AccessibleItem) -> None:
    rules = [
        rsc.EnumTransformationRule(condition=rsc.Access(item=item), value=rsc.EnumValue(name="a")),
        rsc.EnumDefaultRule(value=rsc.EnumValue(name="b")),
    ]
    enum = rsc.EnumDataType(name="E", type=rsc.DoubleDataType(), rules=rules)
    (finding,) = check(rsc.Robot(name="House", definitions=[enum]))
    assert finding.rule == "type"
    assert finding.message == (
        f"an enum rule reads `value`, constants, parameters and enum values only, "
        f"found {type(item).__name__.lower()} `{item.name}`"
    )
