"""Expressions of Supremica's modules: constants, and CIF text with types."""

from __future__ import annotations

import operator as operators
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from robosc.base.diagnostics import ModelError
from robosc.language.des.automata import FaultError, construct
from robosc.language.des.files import attribute

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from robosc.language.des.automata import Automaton
    from robosc.language.des.files import Source
    from robosc.model.places import Place
    from robosc.model.xmi.markup import Element

#: Names of the elements that are expressions.
EXPRESSIONS = frozenset(
    [
        "BinaryExpression",
        "UnaryExpression",
        "IntConstant",
        "SimpleIdentifier",
        "IndexedIdentifier",
        "QualifiedIdentifier",
        "EnumSetExpression",
        "FunctionCallExpression",
    ]
)
_COMPARISONS = {"==": "=", "!=": "!=", "<": "<", "<=": "<=", ">": ">", ">=": ">="}
_ARITHMETIC = {"+": "+", "-": "-", "*": "*", "/": "div", "%": "mod"}
_LOGIC = {"&": "and", "|": "or"}
_CONSTANTS: dict[str, Callable[[int, int], int]] = {
    "<": operators.lt,
    "<=": operators.le,
    ">": operators.gt,
    ">=": operators.ge,
    "+": operators.add,
    "-": operators.sub,
    "*": operators.mul,
    "&": lambda left, right: bool(left and right),
    "|": lambda left, right: bool(left or right),
}
#: A constant: a whole number, an atom of an enumeration, or a set of them.
Constant: TypeAlias = "int | str | range | tuple[str, ...]"
Bindings: TypeAlias = "Mapping[str, Constant]"
_MOST = 2**31
#: Maximum number of expressions inside each other, and of steps in the evaluation of a module.
_DEEPEST, _MOST_STEPS = 50, 2_000_000


@dataclass(eq=False)
class Enumeration:
    """An enumeration of CIF: its name, and the names of its literals by atom."""

    cif: str
    literals: dict[str, str]


@dataclass(eq=False)
class Variable:
    """A variable: its values, its initial value, and the automaton that declares it in CIF.

    `atoms` are its values if it is of an `enumeration`.
    """

    name: str
    place: Place
    values: range | None
    atoms: tuple[str, ...] = ()
    enumeration: Enumeration | None = None
    initial: int | str = 0
    cif: str = ""
    owner: Automaton | None = field(default=None, repr=False)

    @property
    def text(self) -> str:
        """The variable's absolute name in CIF."""
        assert self.owner is not None
        return f"{self.owner.cif}.{self.cif}"


class Value(NamedTuple):
    """An expression in CIF: its text, and its type, which is a range, an enumeration, or None for a boolean.

    `atoms` are the possible values of an enumeration. A compound text needs parentheses inside another. `difference`
    has the two operands of a subtraction.
    """

    text: str
    type: range | Enumeration | None
    atoms: tuple[str, ...] = ()
    compound: bool = False
    difference: tuple[str, str] | None = None

    @property
    def inner(self) -> str:
        """The text as an operand."""
        return f"({self.text})" if self.compound else self.text


class Names:
    """Names that an expression may have: constants, variables, atoms and automata."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.constants: dict[str, Element] = {}
        self.variables: dict[str, Variable] = {}
        self.enumerations: dict[str, Enumeration] = {}
        self.automata: dict[str, Automaton] = {}
        #: Values of constants, by name, and the names of those that are being computed.
        self._computed: dict[str, Constant] = {}
        self._computing: set[str] = set()
        self._depth = self._steps = 0

    def count(self, node: Element, steps: int = 1) -> None:
        """Count steps of the evaluation. Raises ModelError, which ends the reading, if there are too many."""
        self._steps += steps
        if self._steps > _MOST_STEPS:
            what = f"a module whose expansion takes more than {_MOST_STEPS} steps"
            fault = construct(self.source.place(node), what, "make its ranges and loops smaller")
            raise ModelError([fault.finding()])

    @contextmanager
    def _inside(self, node: Element) -> Iterator[None]:
        """Count an expression inside others. Raises FaultError if it is too deep inside."""
        self.count(node)
        if self._depth >= _DEEPEST:
            what = f"more than {_DEEPEST} expressions inside each other"
            raise construct(self.source.place(node), what, "divide the expression")
        self._depth += 1
        try:
            yield
        finally:
            self._depth -= 1

    # Constants

    def compute(self) -> None:
        """Compute the constants in their order, so that a long chain of them is not deep. A fault shows at its use."""
        for name, node in self.constants.items():
            with suppress(FaultError):
                self._constant_named(name, node)

    def constant(self, node: Element, bindings: Bindings) -> Constant:
        """Return the value of a constant expression. Raises FaultError if it has none."""
        with self._inside(node):
            return self._constant(node, bindings)

    def _constant(self, node: Element, bindings: Bindings) -> Constant:
        match node.name:
            case "IntConstant":
                return self._number(node)
            case "EnumSetExpression":
                atoms = (self.name(child, bindings) for child in node.children if child.name in EXPRESSIONS)
                return tuple(dict.fromkeys(atoms))
            case "SimpleIdentifier" | "IndexedIdentifier" | "QualifiedIdentifier":
                return self._constant_of(node, bindings)
            case "UnaryExpression":
                operand = self.constant(_only(node, 1, self.source)[0], bindings)
                operator = attribute(node, "Operator", self.source)
                if isinstance(operand, int) and operator in ("-", "!"):
                    return -operand if operator == "-" else int(not operand)
            case "BinaryExpression":
                operands = [self.constant(child, bindings) for child in _only(node, 2, self.source)]
                return self._combined(node, *operands)
        raise FaultError(self.source.place(node), "type", "this is not a constant")

    def _constant_of(self, node: Element, bindings: Bindings) -> Constant:
        """Return the constant of a name: of a loop, of an alias, or an atom."""
        name = self.name(node, bindings)
        if name in bindings:
            return bindings[name]
        if name in self.constants:
            return self._constant_named(name, node)
        if name in self.variables:
            raise FaultError(self.source.place(node), "type", f"`{name}` is a variable, expected a constant")
        return name

    def _constant_named(self, name: str, node: Element) -> Constant:
        """Return the value of an alias, which `node` names."""
        if name not in self._computed:
            if name in self._computing:
                raise FaultError(self.source.place(node), "cyclic-definition", f"`{name}` is computed from itself")
            self._computing.add(name)
            try:
                self._computed[name] = self.constant(self.constants[name], {})
            finally:
                self._computing.remove(name)
        return self._computed[name]

    def _number(self, node: Element) -> int:
        text = attribute(node, "Value", self.source)
        try:
            number = int(text)
        except ValueError:
            raise FaultError(self.source.place(node), "syntax", f"`{text}` is not a whole number") from None
        if abs(number) >= _MOST:
            raise FaultError(self.source.place(node), "integer-range", "numbers have at most 32 bits")
        return number

    def _combined(self, node: Element, left: Constant, right: Constant) -> Constant:
        operator = attribute(node, "Operator", self.source)
        if operator in ("==", "!="):
            return int((left == right) == (operator == "=="))
        if isinstance(left, int) and isinstance(right, int):
            if operator == "..":
                return range(left, right + 1)
            if operator in ("/", "%") and right:
                quotient = abs(left) // abs(right) * (1 if (left < 0) == (right < 0) else -1)
                return quotient if operator == "/" else left - quotient * right
            if operator in _CONSTANTS and max(abs(left), abs(right)) < _MOST:
                return int(_CONSTANTS[operator](left, right))
        raise FaultError(self.source.place(node), "type", f"`{operator}` does not apply to these constants")

    def values(self, node: Element, bindings: Bindings) -> list[Constant]:
        """Return the values of a range or a set. Raises FaultError if it is none, or too large."""
        value = self.constant(node, bindings)
        if isinstance(value, range) and len(value) <= 10_000:
            return list(value)
        if isinstance(value, tuple):
            return list(value)
        raise FaultError(self.source.place(node), "type", "expected a range of at most 10000 numbers, or a set")

    def name(self, node: Element, bindings: Bindings) -> str:
        """Return an identifier as a text, with the values of its indexes. Raises FaultError if it is none."""
        with self._inside(node):
            return self._name(node, bindings)

    def _name(self, node: Element, bindings: Bindings) -> str:
        match node.name:
            case "SimpleIdentifier":
                return attribute(node, "Name", self.source)
            case "IndexedIdentifier":
                indexes = (child for child in _nested(node, ("IndexList",)))
                values = (self.constant(child, bindings) for child in indexes)
                return attribute(node, "Name", self.source) + "".join(f"[{value}]" for value in values)
            case "QualifiedIdentifier":
                return ".".join(self.name(child, bindings) for child in node.children if child.name in EXPRESSIONS)
        raise FaultError(self.source.place(node), "syntax", f"found `{node.name}`, expected a name")

    # Expressions over the state

    def value(self, node: Element, bindings: Bindings) -> Value:
        """Return an expression over variables and states. Raises FaultError if it is wrong."""
        with self._inside(node):
            return self._value(node, bindings)

    def _value(self, node: Element, bindings: Bindings) -> Value:
        match node.name:
            case "IntConstant":
                return number(self._number(node))
            case "SimpleIdentifier" | "IndexedIdentifier" | "QualifiedIdentifier":
                return self._named(node, bindings)
            case "UnaryExpression":
                return self._unary(node, bindings)
            case "BinaryExpression":
                return self._binary(node, bindings)
            case "FunctionCallExpression":
                return self._call(node, bindings)
        raise FaultError(self.source.place(node), "syntax", f"found `{node.name}`, expected an expression")

    def _named(self, node: Element, bindings: Bindings) -> Value:
        name = self.name(node, bindings)
        if name in self.variables and name not in bindings:
            variable = self.variables[name]
            return Value(variable.text, variable.enumeration or variable.values, variable.atoms)
        constant = self.constant(node, bindings)
        if isinstance(constant, int):
            return number(constant)
        if isinstance(constant, str) and constant in self.enumerations:
            enumeration = self.enumerations[constant]
            return Value(enumeration.literals[constant], enumeration, (constant,))
        message = f"there is no variable, constant or value `{name}`"
        raise FaultError(self.source.place(node), "unresolved-reference", message)

    def condition(self, node: Element, bindings: Bindings) -> Value:
        """Return a boolean expression; a number is true unless it is 0."""
        return self._boolean(node, self.value(node, bindings))

    def _boolean(self, node: Element, value: Value) -> Value:
        if isinstance(value.type, range):
            return Value(f"{value.inner} != 0", None, compound=True)
        if value.type is not None:
            raise FaultError(self.source.place(node), "type", f"`{value.text}` is not a condition")
        return value

    def as_number(self, node: Element, value: Value) -> Value:
        """Return a value as a number: a condition is 1 or 0. Raises FaultError for a value of an enumeration."""
        if value.type is None:
            return Value(f"if {value.text}: 1 else 0 end", range(2), compound=True)
        if not isinstance(value.type, range):
            raise FaultError(self.source.place(node), "type", f"`{value.text}` is not a number")
        return value

    def _unary(self, node: Element, bindings: Bindings) -> Value:
        [operand] = _only(node, 1, self.source)
        operator = attribute(node, "Operator", self.source)
        if operator == "!":
            return Value(f"not {self.condition(operand, bindings).inner}", None, compound=True)
        if operator == "-":
            value = self.as_number(operand, self.value(operand, bindings))
            assert isinstance(value.type, range)
            return Value(f"-{value.inner}", range(1 - value.type.stop, 1 - value.type.start), compound=True)
        hint = "write an action `x = …`, or a guard `x' == …` beside other conditions"
        raise construct(self.source.place(node), f"the operator `{operator}` here", hint)

    def _binary(self, node: Element, bindings: Bindings) -> Value:
        left, right = _only(node, 2, self.source)
        operator = attribute(node, "Operator", self.source)
        place = self.source.place(node)
        if operator in _LOGIC:
            parts = (self.condition(operand, bindings).inner for operand in (left, right))
            return Value(f" {_LOGIC[operator]} ".join(parts), None, compound=True)
        if operator in ("==", "!="):
            at = self._at(left, right, bindings) or self._at(right, left, bindings)
            if at is not None:
                return at if operator == "==" else Value(f"not {at.inner}", None, compound=True)
        if operator not in _COMPARISONS and operator not in _ARITHMETIC:
            raise construct(place, f"the operator `{operator}` here", "write another expression")
        first, second = self.value(left, bindings), self.value(right, bindings)
        if operator in ("==", "!=") and isinstance(first.type, Enumeration) and first.type is second.type:
            return Value(f"{first.inner} {_COMPARISONS[operator]} {second.inner}", None, compound=True)
        first, second = self.as_number(left, first), self.as_number(right, second)
        if operator in _COMPARISONS:
            return compared(first, _COMPARISONS[operator], second)
        assert isinstance(first.type, range)
        assert isinstance(second.type, range)
        values = _result(operator, first.type, second.type)
        if values is None:
            raise construct(place, f"`{operator}` by a value that is not a positive constant", "divide by a constant")
        if max(abs(values.start), abs(values.stop)) > _MOST:
            raise FaultError(place, "integer-range", "the value may have more than 32 bits")
        difference = (first.inner, second.inner) if operator == "-" else None
        text = f"{first.inner} {_ARITHMETIC[operator]} {second.inner}"
        return Value(text, values, compound=True, difference=difference)

    def _at(self, automaton: Element, state: Element, bindings: Bindings) -> Value | None:
        """Return the condition that an automaton is in a state; None if the names are others."""
        if not {automaton.name, state.name} <= {"SimpleIdentifier", "IndexedIdentifier", "QualifiedIdentifier"}:
            return None
        named = self.automata.get(self.name(automaton, bindings))
        if named is None:
            return None
        position = named.states.get(self.name(state, bindings))
        if position is None:
            message = f"`{named.name}` has no state `{self.name(state, bindings)}`"
            raise FaultError(self.source.place(state), "unresolved-reference", message)
        return Value(f"{named.cif}.{position.cif}", None)

    def _call(self, node: Element, bindings: Bindings) -> Value:
        name = attribute(node, "FunctionName", self.source).lstrip("\\")
        arguments = list(_nested(node, ("ArgumentList",)))
        if name in ("min", "max") and len(arguments) == 2:
            first, second = (self.as_number(child, self.value(child, bindings)) for child in arguments)
            assert isinstance(first.type, range)
            assert isinstance(second.type, range)
            best = min if name == "min" else max
            values = range(best(first.type.start, second.type.start), best(first.type.stop, second.type.stop))
            return Value(f"{name}({first.text}, {second.text})", values)
        raise construct(self.source.place(node), f"the function `{name}`", "write the value as conditions")


def compared(left: Value, operator: str, right: Value) -> Value:
    """Return a comparison. Subtrahends move to the other side: CIF's synthesis supports `-` in assignments only."""
    (plus, minus), (other_plus, other_minus) = (value.difference or (value.inner, "0") for value in (left, right))
    sides = (_sum(plus, other_minus), _sum(other_plus, minus))
    return Value(f" {operator} ".join(sides), None, compound=True)


def _sum(left: str, right: str) -> str:
    if left.isdecimal() and right.isdecimal():
        return str(int(left) + int(right))
    return left if right == "0" else right if left == "0" else f"{left} + {right}"


def number(value: int) -> Value:
    """Return a whole number as an expression."""
    return Value(str(value), range(value, value + 1), compound=value < 0)


def _result(operator: str, first: range, second: range) -> range | None:
    """Return the values of an arithmetic expression; None if CIF's synthesis cannot compute it."""
    lows, highs = (first.start, first.stop - 1), (second.start, second.stop - 1)
    match operator:
        case "+":
            return range(lows[0] + highs[0], lows[1] + highs[1] + 1)
        case "-":
            return range(lows[0] - highs[1], lows[1] - highs[0] + 1)
        case "*":
            products = [left * right for left in lows for right in highs]
            return range(min(products), max(products) + 1)
    if len(second) != 1 or second.start <= 0 or first.start < 0:
        return None
    return range(first.stop) if operator == "/" else range(min(first.stop, second.start))


def _only(node: Element, count: int, source: Source) -> list[Element]:
    operands = [child for child in node.children if child.name in EXPRESSIONS]
    if len(operands) != count:
        message = f"`{node.name}` has {len(operands)} operands, expected {count}"
        raise FaultError(source.place(node), "syntax", message)
    return operands


def _nested(node: Element, lists: tuple[str, ...]) -> Iterator[Element]:
    """Yield the expressions in an element, directly or in one of these lists."""
    for child in node.children:
        if child.name in lists:
            yield from (inner for inner in child.children if inner.name in EXPRESSIONS)
        elif child.name in EXPRESSIONS:
            yield child
