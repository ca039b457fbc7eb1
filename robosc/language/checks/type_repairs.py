"""Repairs for expressions of the wrong type."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.base.diagnostics import Repair
from robosc.language.checks.definitions import component_of
from robosc.language.checks.edits import Choice, Insertion, Replacement, Together, wrap
from robosc.model import expression as ex
from robosc.model import robosc as rsc
from robosc.model.semantics.communication import data_type, event_of
from robosc.model.semantics.naming import escape_keyword
from robosc.model.semantics.operators import COMPARISONS
from robosc.model.semantics.printing import RoboscPrinter
from robosc.model.semantics.typing import (
    BOOLEAN,
    DOUBLE,
    INTEGER,
    NONE,
    STRING,
    ArrayType,
    BasicType,
    EnumType,
    ObjectType,
    Type,
    declared_type,
)
from robosc.model.semantics.walks import parts

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from robosc.language.checks.edits import Hint

#: Placeholder in a hint for text that the user writes.
_GAP = "…"
_COMPARISON: Mapping[Type, str] = {INTEGER: "> 0", DOUBLE: "> 0.0", STRING: f'= "{_GAP}"'}
#: Literals of each type, and their description in hints.
_LITERALS: Mapping[Type, tuple[tuple[str, ...], str]] = {
    BOOLEAN: (("true", "false"), "`true` or `false`"),
    INTEGER: (("0",), "a whole number such as `0`"),
    DOUBLE: (("0.0",), "a number such as `0.0`"),
    STRING: (('""',), f'a string such as `"{_GAP}"`'),
}

#: Elements whose own parts are integers by the language, so that no declaration changes their type.
_ALWAYS_INTEGER = (
    ex.FunctionCall,
    rsc.Access,
    rsc.CommunicationReference,
    rsc.Component,
    rsc.CountRequirement,
    rsc.IndexSegment,
    rsc.IntegerDataType,
    rsc.IntegerText,
)
_LITERAL = (ex.IntegerLiteral, ex.DoubleLiteral, ex.StringLiteral)


def repair(expression: ex.Expression, actual: Type, expected: Type) -> Hint:
    """Return how to turn an expression of one type into one of the wanted type.

    An object value has the type UNKNOWN in `actual`. If UNKNOWN is `expected`, any comparable type is accepted.
    """
    source = _source(expression) if isinstance(expected, EnumType) else None
    if source and isinstance(expected, EnumType) and declared_type(expected.definition.type) == actual:
        name = escape_keyword(expected.definition.name)
        hint = f"declare {source[0]} with the type `{name}`, whose rules read this data"
        return Replacement(hint, name, source[1], is_choice=True)
    if isinstance(actual, (ObjectType, ArrayType)) or actual == NONE:
        return _part(expression, actual, expected)
    literal = literal_repair(expression, actual, expected)
    if literal:
        return literal
    match expected:
        case EnumType():
            return Choice(
                f"write one of its values: {_alternatives(expected)}", _in_place(expression, _values(expected))
            )
        case ObjectType():
            first = next(iter(expected.definition.properties), None)
            return f"write an object value, such as `{{ {first.name}: … }}`" if first else "write `{}`"
        case ArrayType():
            hint = "write an array, such as `[1.0, 0.0]`"
            return wrap(hint, "[", "]", expression, is_choice=True) if actual == expected.element else hint
        case BasicType.NONE:
            return "leave the provide statement out: it has no data to send"
    return _conversion(expression, actual, expected)


def literal_repair(expression: ex.Expression, actual: Type, expected: Type) -> Repair | Replacement | None:
    """Return the equivalent literal of the wanted type as a repair; None if there is none."""
    inner = expression.operand if isinstance(expression, ex.UnaryMinus) else expression
    sign = "" if inner is expression else "-"
    text = offer = None
    match inner, expected:
        case ex.IntegerLiteral(), BasicType.DOUBLE:
            text = f"{sign}{inner.value}.0"
        case ex.DoubleLiteral(), BasicType.INTEGER if inner.value.is_integer() and abs(inner.value) < 2**53:
            text = f"{sign}{int(inner.value)}"
        case ex.IntegerLiteral() | ex.DoubleLiteral(), BasicType.STRING:
            offer = f'"{sign}{inner.value}"'  # the number may have been spelled otherwise, such as `1.10`
        case ex.BooleanLiteral(), BasicType.STRING:
            offer = f'"{str(inner.value).lower()}"'  # the text may be spelled otherwise, such as `"on"`
        case ex.IntegerLiteral(), BasicType.BOOLEAN if not sign and inner.value in {0, 1}:
            offer = str(bool(inner.value)).lower()  # `x = 0 or 1` means another comparison
        case ex.StringLiteral(), BasicType.BOOLEAN if inner.value in {"true", "false"}:
            text = inner.value
        case ex.StringLiteral(), EnumType() if inner.value in _values(expected):
            offer = escape_keyword(inner.value)  # a variable may have the same name
    if actual == expected:
        return None
    if offer is not None:
        return Replacement(f"write `{offer}`", offer, expression, is_choice=True)
    return Repair(f"write `{text}`", text) if text is not None else None


def equality_repair(operator: ex.Equation | ex.Inequation, left: Type, right: Type) -> tuple[ex.Expression, Hint]:
    """Return the place and the repair of a comparison of two types: a literal to rewrite, else the whole."""
    sides = ((operator.right, right, left), (operator.left, left, right))
    for expression, actual, expected in sides:
        literal = literal_repair(expression, actual, expected)
        # In other languages `/` divides integers, with another result.
        if isinstance(literal, Repair) and any(isinstance(part, ex.Division) for part in parts(operator)):
            hint = f"{literal.hint}: `/` is a division of doubles"
            return expression, Replacement(hint, str(literal.text), expression, is_choice=True)
        if literal:
            return expression, literal
    for expression, actual, expected in sides:
        if isinstance(expected, EnumType):
            hint = f"compare with one of {_alternatives(expected)}"
            return operator, Choice(hint, _in_place(expression, _values(expected)))
        if {actual, expected} == {INTEGER, DOUBLE}:
            whole = operator.left if left == INTEGER else operator.right
            hint_text = "multiply the integer by `1.0`, or compare by `<`, `<=`, `>` or `>=`"
            return operator, _around(hint_text, whole, "", " * 1.0")
    return operator, f"compare {left} with {left}, or {right} with {right}"


def negated_comparison(operator: ex.Expression) -> Hint | None:
    """Return the repair of `!a = b` or `!a < b`, which negates `a` only; None for another operator."""
    around = operator.eContainer()
    if not isinstance(operator, ex.Negation) or not isinstance(around, COMPARISONS) or around.left is not operator:
        return None
    whole = (Insertion("", "(", operator.operand), Insertion("", ")", around.right, behind=True))
    return Together("write parentheses around the comparison, such as `not (a = b)`", whole, is_choice=True)


def _in_place(expression: ex.Expression, names: Iterable[str]) -> tuple[Replacement, ...]:
    """Return one replacement of the expression for each name."""
    return tuple(Replacement(f"write `{escape_keyword(name)}`", escape_keyword(name), expression) for name in names)


def _source(expression: ex.Expression) -> tuple[str, rsc.DataType] | None:
    """Return the source of the data that an expression is as a whole, and the data's declared type.

    The source is a message, or the response, error or feedback of another communication.
    """
    if not isinstance(expression, rsc.Access) or not expression.value or expression.segments:
        return None
    around = expression.eContainer()
    while around is not None and not isinstance(around, rsc.ResultTransition):
        around = around.eContainer()
    communication = around.communicationType.communicationType if around and around.communicationType else None
    if around is None or communication is None:
        return None
    name = f"`{escape_keyword(communication.name)}`"
    if isinstance(communication, rsc.Message):
        return name, communication.type
    declared = data_type(communication, event_of(around.communicationType, around.resultType))
    return None if declared is None else (f"the {around.resultType} of {name}", declared)


def _part(whole: ex.Expression, actual: Type, expected: Type) -> Hint:
    if isinstance(actual, ArrayType):
        hint = f"read one of its elements, such as `{_text(whole)}[0]`"
        return Insertion(hint, "[0]", whole, behind=True, is_choice=True)
    if not isinstance(actual, ObjectType):
        return "leave it out: this event carries no data"
    properties = list(actual.definition.properties)
    fitting = [part for part in properties if declared_type(part.type) == expected]
    if isinstance(expected, ObjectType) and not fitting:
        return f"declare the source and the target of the data with one type, such as `{actual.qualified_name}`"
    fitting = fitting or properties
    if not fitting:
        return "it has none to read"
    hint = f"read one of its properties, such as `{_text(whole)}.{escape_keyword(fitting[0].name)}`"
    names = [escape_keyword(part.name) for part in fitting]
    ways = (Insertion(f"write `{_text(whole)}.{name}`", f".{name}", whole, behind=True) for name in names)
    return Choice(hint, tuple(ways))


def _conversion(expression: ex.Expression, actual: Type, expected: Type) -> Hint:
    if expected == BOOLEAN and not isinstance(expression, _LITERAL):
        compared = _compared(expression, actual)
        if compared is not None:
            return compared
    if (actual, expected) == (INTEGER, DOUBLE):
        return _around(f"write `{_text(expression)} * 1.0`", expression, "", " * 1.0", is_choice=False)
    if (actual, expected) == (DOUBLE, INTEGER):
        otherwise = "" if isinstance(expression.eContainer(), _ALWAYS_INTEGER) else " or declare it double"
        if isinstance(expression, _LITERAL):
            return f"write a whole number{otherwise}: RoboSC never rounds implicitly"
        why = "`/` always gives a double" if isinstance(expression, ex.Division) else "RoboSC never rounds implicitly"
        hint = f"write `round({_text(expression).strip('()')})`{otherwise}: {why}"
        return wrap(hint, "round(", ")", expression, is_choice=True)
    if isinstance(actual, EnumType):
        return "compare an enum's values by `=` only"
    ways = tuple(Replacement(f"write `{text}`", text, expression) for text in _LITERALS[expected][0])
    return Choice(f"write {_LITERALS[expected][1]}", ways)


def _compared(expression: ex.Expression, actual: Type) -> Hint | None:
    """Return a comparison that has the value as one side."""
    if isinstance(actual, EnumType):
        texts = [f"= {escape_keyword(value)}" for value in _values(actual)]
        ways = (
            _around(f"write `{_text(expression)} {text}`", expression, "", f" {text}", is_choice=False)
            for text in texts
        )
        return Choice(f"compare it, such as `{_text(expression)} {texts[0]}`", tuple(ways)) if texts else "compare it"
    if actual not in _COMPARISON:
        return None
    hint = f"compare it, such as `{_text(expression)} {_COMPARISON[actual]}`"
    return _around(hint, expression, "", f" {_COMPARISON[actual].replace(_GAP, '')}")


def _around(hint: str, expression: ex.Expression, before: str, behind: str, *, is_choice: bool = True) -> Together:
    """Return a hint to write text around an expression, in parentheses unless the expression is a name."""
    if isinstance(expression.eContainer(), ex.Expression):
        before, behind = f"({before}", f"{behind})"
    if not isinstance(expression, rsc.Access):
        before, behind = f"{before}(", f"){behind}"
    return wrap(hint, before, behind, expression, is_choice=is_choice)


def _alternatives(enum: EnumType) -> str:
    return ", ".join(f"`{escape_keyword(value)}`" for value in _values(enum))


def _values(enum: EnumType) -> list[str]:
    return list(dict.fromkeys(rule.value.name for rule in enum.definition.rules if rule.value))


def _text(expression: ex.Expression) -> str:
    """Return an access as the text has it, without its own component; `(…)` for any other expression."""
    if not isinstance(expression, rsc.Access):
        return "(…)"
    text, own = RoboscPrinter()(expression), component_of(expression)
    return (
        text.removeprefix(f"{escape_keyword(own.name)}.") if own is not None and own is expression.component else text
    )
