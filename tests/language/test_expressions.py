"""Expressions: precedence of operators, and the printed text of a tree is read as the same tree."""

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robosc.language.builder import Builder
from robosc.language.grammar import Failure, parse
from robosc.language.text import Text
from robosc.model import expression as ex
from robosc.model import robosc as rsc
from robosc.model.semantics.naming import ROBOSC_KEYWORDS
from robosc.model.semantics.operators import PRECEDENCE
from robosc.model.semantics.printing import RoboscPrinter

NAMES = st.sampled_from(["a", "B2", "_", "not", *sorted(ROBOSC_KEYWORDS)])
SEGMENTS = st.lists(
    st.builds(lambda name: rsc.PropertySegment(property=rsc.ObjectProperty(name=name)), NAMES)
    | st.builds(lambda index: rsc.IndexSegment(index=index), st.integers(0, 2**63 - 1)),
    max_size=3,
)
ACCESSES = st.builds(lambda segments: rsc.Access(value=True, segments=segments), SEGMENTS) | st.builds(
    lambda component, item, segments: rsc.Access(
        component=component and rsc.Component(name=component), item=rsc.Variable(name=item), segments=segments
    ),
    st.none() | NAMES,
    NAMES,
    st.just([]),
)
LITERALS = (
    st.builds(lambda value: ex.BooleanLiteral(value=value), st.booleans())
    | st.builds(lambda value: ex.IntegerLiteral(value=value), st.integers(0, 2**63 - 1))
    | st.builds(lambda value: ex.DoubleLiteral(value=abs(value)), st.floats(allow_nan=False, allow_infinity=False))
    | st.builds(lambda value: ex.StringLiteral(value=value), st.text(st.characters(exclude_categories=["Cs"])))
)
UNARY = (ex.Negation, ex.UnaryMinus)
BINARY = [operator for operator in PRECEDENCE if operator not in UNARY]


def trees(parts: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    unary = st.builds(lambda made, operand: made(operand=operand), st.sampled_from(UNARY), parts)
    return unary | st.builds(
        lambda made, *both: made(left=both[0], right=both[1]), st.sampled_from(BINARY), parts, parts
    )


EXPRESSIONS = st.recursive(ACCESSES | LITERALS, trees, max_leaves=12)


def shape(expression: Any, names: Any = None) -> Any:
    """Return a comparable form of an expression; `names` has the names of a parsed, unlinked one."""

    def name(element: Any, feature: str) -> str | None:
        if names is not None:
            found = names.get(element, {}).get(feature)
            return found.text if found else None
        target = getattr(element, feature)
        return target.name if target is not None else None

    kind = type(expression).__name__
    match expression:
        case rsc.Access():
            segments = [
                segment.index if isinstance(segment, rsc.IndexSegment) else name(segment, "property")
                for segment in expression.segments
            ]
            return kind, expression.value, name(expression, "component"), name(expression, "item"), segments
        case ex.BinaryExpression():
            return kind, shape(expression.left, names), shape(expression.right, names)
        case ex.UnaryExpression():
            return kind, shape(expression.operand, names)
    return kind, expression.value


def read_shape(text: str) -> Any:
    tree = parse(text, "Expression")
    assert not isinstance(tree, Failure), f"{text}: {tree}"
    builder = Builder(Text("", text))
    expression = builder.build(tree)
    assert builder.findings == []
    return shape(expression, builder.references)


@settings(deadline=None)
@given(EXPRESSIONS)
def test_a_printed_expression_is_read_as_it_was(expression: Any) -> None:
    assert read_shape(RoboscPrinter()(expression)) == shape(expression)


@pytest.mark.parametrize(
    ("text", "same"),
    [
        ("a => b => c", "a => (b => c)"),
        ("a => b or c => d", "a => ((b or c) => d)"),
        ("a or b and c", "a or (b and c)"),
        ("a or b or c", "(a or b) or c"),
        ("a and b = c", "a and (b = c)"),
        ("a = b != c", "(a = b) != c"),
        ("a = b < c", "a = (b < c)"),
        ("a < b + c", "a < (b + c)"),
        ("a - b - c + d", "((a - b) - c) + d"),
        ("a + b * c", "a + (b * c)"),
        ("a / b * c", "(a / b) * c"),
        ("!a = b", "(!a) = b"),
        ("-a * b", "(-a) * b"),
        ("!!a", "!(!a)"),
        ("a - -b", "a - (-b)"),
        ("-value.x[0].y / 2", "(-(value.x[0].y)) / 2"),
    ],
)
def test_precedence(text: str, same: str) -> None:
    assert read_shape(text) == read_shape(same)


def test_the_levels_of_the_language_reference() -> None:
    levels = ["=>", "or", "and", "= !=", "< <= > >=", "+ -", "* /"]
    symbols = RoboscPrinter.symbols
    by_level: dict[int, set[str]] = {}
    for kind, level in PRECEDENCE.items():
        by_level.setdefault(level, set()).add(symbols[kind])
    assert [by_level[level] for level in sorted(by_level)] == [*(set(level.split()) for level in levels), {"!", "-"}]


def test_parentheses_belong_to_an_operator_and_not_to_its_operand() -> None:
    tree = parse("(a + b) * c", "Expression")
    product = Builder(Text("", "(a + b) * c")).build(tree)
    assert str(product.source) == "1:1-1:12"
    assert str(product.left.source) == "1:2-1:7"


def test_a_long_chain_is_no_deep_recursion() -> None:
    expression = Builder(Text("", "")).build(parse(" or ".join(["a"] * 3000), "Expression"))
    for _ in range(2999):
        assert isinstance(expression, ex.Disjunction)
        assert isinstance(expression.right, rsc.Access)
        expression = expression.left
    assert isinstance(expression, rsc.Access)
