"""Values of static expressions, of all types of CIF.

A static expression has the same value in every state. Synthesis evaluates it, so that only values of its own types
remain: bool, int, and literals of enumerations. The result of an operation is that of `CifEvalUtils` and `CifMath` of
Eclipse ESCET.

The Python value of a real is a float, of a list a tuple, of a set a frozenset, of a dictionary `Pairs`, of a tuple
`Tuple`, and of an enumeration its literal.
"""

from __future__ import annotations

import math
import operator
from dataclasses import dataclass, field
from decimal import Decimal
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn

from robosc.language.cif.faults import CifFaultError, construct
from robosc.model import expression as ex
from robosc.model.semantics.cif_types import BOOLEAN, LARGEST, Type
from robosc.model.semantics.evaluation import evaluate

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

#: Maximum number of elements and characters of a static value.
_LARGEST = 10_000
_COMPARISONS = {"<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge}
_ARITHMETIC = {"+": operator.add, "-": operator.sub, "*": operator.mul}
_ON_SETS = {"and": operator.and_, "or": operator.or_, "-": operator.sub, "sub": operator.le}
_ON_REALS: Mapping[str, Callable[[float], float]] = {
    name: getattr(math, name)
    for name in ("acos", "acosh", "asin", "asinh", "atan", "atanh", "cos", "cosh", "sin", "sinh", "tan", "tanh")
} | {
    "cbrt": lambda value: float(whole) if (whole := round(math.cbrt(value))) ** 3 == value else math.cbrt(value),
    "exp": math.exp,
    "ln": math.log,
    "log": math.log10,
    "sqrt": math.sqrt,
}
_TO_INTEGER: Mapping[str, Callable[[float], int]] = {
    "ceil": math.ceil,
    "floor": math.floor,
    "round": lambda value: math.floor(value + 0.5),
}
_KINDS: Sequence[tuple[Any, str]] = ((bool, "bool"), (int, "int"), (float, "real"), (str, "string"), (tuple, "list"))
_PLURALS = {"real": "reals", "string": "strings", "list": "lists", "set": "sets", "dict": "dictionaries"}


class TypedNode(NamedTuple):
    """An expression with its type and the object of the grammar from which it was created.

    The type of an automaton is its plant; an automaton has a value only in a `switch`. An expression of a type that
    synthesis does not have is a `Static` value; its type is the word of its kind.
    """

    node: Any
    expression: Any
    type: Type | Any


@dataclass(frozen=True, eq=False)
class Static:
    """A value in place of an expression."""

    value: Any


class Pairs(dict[Any, Any]):
    """A dictionary of CIF."""

    def __hash__(self) -> int:  # type: ignore[override]
        return hash(frozenset(self.items()))


@dataclass(frozen=True)
class Tuple:
    """A tuple of CIF; `names` are its fields, if its type is declared."""

    values: tuple[Any, ...]
    names: tuple[str, ...] = field(default=(), compare=False)


@dataclass(frozen=True, eq=False)
class ForeignType:
    """A type that only static values have: its word, the types of its parts, and the names of its fields."""

    word: str
    parts: tuple[Any, ...] = ()
    names: tuple[str, ...] = ()
    #: The lengths of a list.
    sizes: range | None = None


class _ChangingError(Exception):
    """Signals that a value is not static."""


def constant_value(expression: ex.Expression | Static) -> Any:
    """Return the value of a static expression, or None if it depends on the state."""

    def read(reference: ex.Expression) -> Any:
        if isinstance(reference, ex.EnumerationLiteralReference):
            return reference.literal
        raise _ChangingError

    if isinstance(expression, Static):
        return expression.value
    try:
        return evaluate(expression, read)
    except _ChangingError:
        return None


def literal(value: Any) -> ex.Expression:
    """Return a value as a literal."""
    if isinstance(value, bool):
        return ex.BooleanLiteral(value=value)
    if isinstance(value, ex.EnumerationLiteral):
        return ex.EnumerationLiteralReference(literal=value)
    whole = ex.IntegerLiteral(value=abs(int(value)))
    return ex.UnaryMinus(operand=whole) if value < 0 else whole


def default(kind: Type) -> Any:
    """Return CIF's default value of a type."""
    if isinstance(kind, range):
        return min(max(0, kind.start), kind.stop - 1)
    return kind.literals[0] if isinstance(kind, ex.Enumeration) else False


def is_foreign(kind: Any) -> bool:
    """Return whether the type of an expression is one that only static values have."""
    return isinstance(kind, str) and kind != BOOLEAN


def static_node(node: Any, value: Any) -> TypedNode:
    """Return a value as an expression with its type. Raises CifFaultError if it is outside CIF's numbers."""
    if isinstance(value, bool):
        return TypedNode(node, literal(value), BOOLEAN)
    if isinstance(value, int):
        if not -LARGEST - 1 <= value <= LARGEST:
            raise CifFaultError(node, "integer-range", f"the value {value} does not fit 32 bits")
        return TypedNode(node, literal(value), range(value, value + 1))
    if isinstance(value, ex.EnumerationLiteral):
        return TypedNode(node, literal(value), value.eContainer())
    if isinstance(value, float):
        if not math.isfinite(value):
            raise CifFaultError(node, "type", "the value of this is no real number")
        value += 0.0  # There is no negative zero.
    if _size(value) > _LARGEST:
        message = f"the value of this has more than {_LARGEST} elements and characters"
        raise CifFaultError(node, "cif-construct", message, "split it into smaller constants")
    return TypedNode(node, Static(value), _kind(value))


def static_value(typed: TypedNode, what: str = "") -> Any:
    """Return the value of a static expression. Raises CifFaultError if it depends on the state.

    `what` is the construct that needs a static value.
    """
    value = None if typed.expression is None else constant_value(typed.expression)
    if value is None:
        refuse_changing(typed, what)
    return value


def refuse_changing(typed: TypedNode, what: str = "") -> NoReturn:
    """Raise CifFaultError: an expression that depends on the state has a type that synthesis does not have."""
    hint = "write constants and whole numbers, or an algebraic variable of type bool, int or an enumeration"
    raise construct(
        typed.node, f"{what or _PLURALS.get(str(typed.type), 'values of this type')} that depend on the state", hint
    )


def computed(node: Any, what: str, compute: Callable[..., Any], operands: Sequence[TypedNode], named: str) -> TypedNode:
    """Return the value of an operation on static values. Raises CifFaultError.

    `what` is the operator or function, and `named` the plural of the construct.
    """
    values = [static_value(operand, named) for operand in operands]
    try:
        return static_node(node, compute(*values))
    except TypeError:
        kinds = " and ".join(map(_kind, values))
        raise CifFaultError(node, "type", f"`{what}` does not apply to {kinds}") from None
    except (ArithmeticError, LookupError, ValueError) as error:
        reason = f": {error}" if isinstance(error, _Error) else ""
        raise CifFaultError(node, "type", f"`{what}` has no value here{reason}") from None


class _Error(ValueError):
    """The reason why an operation has no value."""


def binary(node: Any, word: str, left: TypedNode, right: TypedNode) -> TypedNode:
    """Return the value of a binary operation on static values. Raises CifFaultError."""
    kind = left.type if is_foreign(left.type) else right.type
    named = _PLURALS.get(str(kind), "values") if is_foreign(kind) else f"operands of `{word}`"
    return computed(node, word, lambda a, b: _binary(word, a, b), (left, right), named)


def _binary(word: str, left: Any, right: Any) -> Any:
    kinds = _kind(left), _kind(right)
    if word == "in" and isinstance(right, (tuple, frozenset, Pairs)):
        return left in right
    if word in ("=", "!=") and (kinds[0] == kinds[1] or set(kinds) == {"int", "real"}):
        return (left == right) is (word == "=")
    if set(kinds) <= {"int", "real"}:
        return _on_numbers(word, left, right)
    if kinds == ("set", "set") and word in _ON_SETS:
        return _ON_SETS[word](left, right)
    if word == "+" and kinds in (("string", "string"), ("list", "list")):
        return left + right
    if word == "+" and kinds == ("dict", "dict"):
        return Pairs(left | right)
    if word == "-" and isinstance(left, Pairs) and isinstance(right, (tuple, frozenset, Pairs)):
        return Pairs({key: value for key, value in left.items() if key not in right})
    raise TypeError


def _on_numbers(word: str, left: Any, right: Any) -> Any:
    if word in _COMPARISONS:
        return _COMPARISONS[word](left, right)
    if word in _ARITHMETIC:
        return _ARITHMETIC[word](left, right)
    if word == "/":
        return left / right
    if word in ("div", "mod") and isinstance(left, int) and isinstance(right, int):
        quotient = abs(left) // abs(right) * (1 if (left < 0) == (right < 0) else -1)
        return quotient if word == "div" else left - quotient * right
    raise TypeError


def negated(node: Any, operand: TypedNode) -> TypedNode:
    """Return the negative of a static number. Raises CifFaultError."""
    return computed(node, "-", _negative, [operand], "reals")


def _negative(value: Any) -> Any:
    if _kind(value) not in ("int", "real"):
        raise TypeError
    return -value


def call(node: Any, name: str, arguments: Sequence[TypedNode]) -> TypedNode:
    """Return the value of a function of CIF on static values. Raises CifFaultError."""
    return computed(node, name, lambda *values: _call(name, values), arguments, f"arguments of `{name}`")


def _call(name: str, values: Sequence[Any]) -> Any:
    if {_kind(value) for value in values} <= {"int", "real"}:
        return _call_on_numbers(name, values)
    match name, values:
        case "size", [str() | tuple() | frozenset() | Pairs() as value]:
            return len(value)
        case "empty", [tuple() | frozenset() | Pairs() as value]:
            return not value
        case "pop", [tuple() as value]:
            return Tuple((value[0], value[1:]))
        case "del", [tuple() as value, int() as index]:
            place = range(len(value))[index]
            return value[:place] + value[place + 1 :]
        case "fmt", [str() as pattern, *others]:
            return _formatted(pattern, others)
    raise TypeError


def _call_on_numbers(name: str, values: Sequence[Any]) -> Any:
    match name, values:
        case _, [value] if name in _ON_REALS:
            return _ON_REALS[name](float(value))
        case _, [value] if name in _TO_INTEGER:
            return _TO_INTEGER[name](float(value))
        case "abs", [value]:
            return abs(value)
        case "sign", [value]:
            return (value > 0) - (value < 0)
        case (("min" | "max"), [left, right]):
            both = [left, right] if _kind(left) == _kind(right) else [float(left), float(right)]
            return min(both) if name == "min" else max(both)
        case "pow", [left, right]:
            are_whole = isinstance(left, int) and isinstance(right, int) and right >= 0
            return _power(left, right) if are_whole else math.pow(left, right)
        case "scale", [value, low, high, lowest, highest]:
            return lowest + (value - low) / (high - low) * float(highest - lowest)
    raise TypeError


def _power(base: int, exponent: int) -> int:
    if abs(base) > 1 and exponent > 32:
        raise _Error("it does not fit 32 bits")
    return int(base**exponent)


def _formatted(pattern: str, values: Sequence[Any]) -> str:
    """Return a text with values in it, for the simple specifiers only."""
    pieces, rest = [], list(values)
    parts = iter(pattern.replace("%%", "\0").split("%"))
    pieces.append(next(parts))
    for part in parts:
        if not rest or part[:1] not in ("s", "d", "b") or (part[0] == "d") > isinstance(rest[0], int):
            raise _Error("synthesis evaluates only `%s`, `%d`, `%b` and `%%`")
        pieces.append(_as_text(rest.pop(0)) + part[1:])
    return "".join(pieces).replace("\0", "%")


def cast(node: Any, operand: TypedNode) -> TypedNode:
    """Return a static value of another type. Raises CifFaultError."""
    target = node.token[1:-1].strip()
    return computed(node, node.token, lambda value: _cast(target, value), [operand], "casts of values")


def _cast(target: str, value: Any) -> Any:
    match target, value:
        case "string", _:
            return _as_text(value)
        case "bool", "true" | "false":
            return value == "true"
        case "int", str():
            return int(value)
        case "real", int() | str() if not isinstance(value, bool):
            return float(value)
        case (("bool" | "int" | "real"), _) if _kind(value) != target:
            raise TypeError
    return value


def _as_text(value: Any) -> str:
    match value:
        case bool():
            return str(value).lower()
        case float():
            _, digits, exponent = Decimal(repr(value)).normalize().as_tuple()
            assert isinstance(exponent, int)
            power = len(digits) + exponent - 1
            if value == 0 or -3 <= power < 7:
                return repr(value)
            rest = "".join(map(str, digits[1:])) or "0"
            return f"{'-' if value < 0 else ''}{digits[0]}.{rest}e{power}"
        case str():
            return value
        case int():
            return str(value)
    raise TypeError


def projected(node: Any, base: TypedNode, index: TypedNode | str) -> TypedNode:
    """Return an element of a static list, text, tuple or dictionary. Raises CifFaultError.

    The index of a tuple may be the name of a field.
    """
    operands = (base,) if isinstance(index, str) else (base, index)
    named = "elements of lists and tuples"
    return computed(node, "[]", lambda value, key=index: _element(value, key), operands, named)


def _element(value: Any, key: Any) -> Any:
    match value:
        case Pairs():
            return value[key]
        case Tuple():
            return value.values[value.names.index(key) if isinstance(key, str) else range(len(value.values))[key]]
        case str() | tuple() if isinstance(key, int):
            return value[key]
    raise TypeError


def sliced(node: Any, base: TypedNode, bounds: Sequence[TypedNode | None]) -> TypedNode:
    """Return a part of a static list or text. Raises CifFaultError."""
    first, last = (None if bound is None else static_value(bound) for bound in bounds)
    return computed(node, "[:]", lambda value: _slice(value, first, last), [base], "parts of lists")


def _slice(value: Any, first: Any, last: Any) -> Any:
    if not isinstance(value, (str, tuple)):
        raise TypeError
    return value[first:last]


def collection(node: Any, elements: Sequence[TypedNode | tuple[TypedNode, TypedNode]]) -> TypedNode:
    """Return a list, a set or a dictionary. Raises CifFaultError."""
    is_list = node.opening == "["
    named = "lists" if is_list else "sets and dictionaries"
    pairs = [element for element in elements if not isinstance(element, TypedNode)]
    values = [static_value(element, named) for element in elements if isinstance(element, TypedNode)]
    if pairs and (is_list or values):
        raise CifFaultError(node, "syntax", "`:` is not allowed here")
    kinds = list(dict.fromkeys(map(_kind, values)))
    if len(kinds) > 1:
        raise CifFaultError(node, "type", f"the elements are {kinds[0]} and {kinds[1]}")
    if pairs:
        dictionary = Pairs((static_value(key, named), static_value(value, named)) for key, value in pairs)
        return static_node(node, dictionary)
    return static_node(node, tuple(values) if is_list else frozenset(values))


def conformed(typed: TypedNode, kind: Any, name: str) -> TypedNode:
    """Return a static value with the names of its declared type. Raises CifFaultError if the type differs."""
    value = static_value(typed, _PLURALS.get(kind.word, f"values of the type `{kind.word}`"))
    try:
        return typed._replace(expression=Static(_conform(value, kind)))
    except TypeError:
        message = f"`{name}` is {kind.word}, its value {_kind(value)}"
        if _kind(value) == kind.word:
            message = f"the value of `{name}` has other elements than its type"
        raise CifFaultError(typed.node, "type", message) from None


def _conform(value: Any, kind: Any) -> Any:
    """Return a value with the names that its type declares. Raises TypeError if it is not of that type."""
    if not isinstance(kind, ForeignType):
        if isinstance(kind, range):
            fits = _kind(value) == "int" and value in kind
        else:
            fits = _kind(value) == (kind if isinstance(kind, str) else "enum")
        if not fits:
            raise TypeError
        return value
    if kind.word == "dict" and value == frozenset():
        value = Pairs()
    if kind.word == "real" and _kind(value) == "int":
        value = float(value)
    if _kind(value) != kind.word or (kind.sizes is not None and len(value) not in kind.sizes):
        raise TypeError
    return _conform_parts(value, kind)


def _conform_parts(value: Any, kind: ForeignType) -> Any:
    """Return a value of the kind of a type with the names that its parts declare. Raises TypeError."""
    match value:
        case Tuple():
            if len(value.values) != len(kind.parts):
                raise TypeError
            return Tuple(tuple(map(_conform, value.values, kind.parts)), kind.names)
        case tuple() | frozenset():
            return type(value)(_conform(element, kind.parts[0]) for element in value)
        case Pairs():
            keys, elements = kind.parts
            return Pairs((_conform(key, keys), _conform(element, elements)) for key, element in value.items())
    return value


def _size(value: Any) -> int:
    """Return the number of elements and characters of a value, those of its parts included."""
    match value:
        case str():
            return len(value)
        case Tuple():
            return _size(value.values)
        case Pairs():
            return len(value) + sum(map(_size, value)) + sum(map(_size, value.values()))
        case tuple() | frozenset():
            return len(value) + sum(map(_size, value))
    return 1


def _kind(value: Any) -> str:
    """Return the word of a value's type."""
    for python, word in _KINDS:
        if isinstance(value, python):
            return word
    return {frozenset: "set", Pairs: "dict", Tuple: "tuple"}.get(type(value), "enum")
