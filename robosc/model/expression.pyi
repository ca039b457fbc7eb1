"""Generated from metamodel/expression.ecore by `python scripts/metamodel_stubs.py`."""

from collections.abc import Iterable, MutableSequence
from typing import Any, ClassVar

from robosc.model.places import Place

class Located:
    """An element with a place in a source text."""
    source: Place | None
    def eContainer(self) -> Any: ...
    @property
    def eClass(self) -> Any: ...
    def __init__(self, *, source: Place | None = ...) -> None: ...

class NamedElement(Located):
    """An element with a name."""
    name: str
    def __init__(self, *, name: str | None = ..., source: Place | None = ...) -> None: ...

class Type(Located):
    """The type of an input, a variable or a field in sct and rosgraph models."""
    def __init__(self, *, source: Place | None = ...) -> None: ...

class BooleanType(Type):
    """true or false."""
    def __init__(self, *, source: Place | None = ...) -> None: ...

class IntegerType(Type):
    """Whole numbers, both bounds included. In an sct model both bounds are present, and a value outside becomes the nearest bound."""
    minimum: int | None
    maximum: int | None
    def __init__(self, *, minimum: int | None = ..., maximum: int | None = ..., source: Place | None = ...) -> None: ...

class DoubleType(Type):
    """IEEE 754 binary64. An sct model has no doubles."""
    def __init__(self, *, source: Place | None = ...) -> None: ...

class StringType(Type):
    """Text. An sct model has no strings."""
    def __init__(self, *, source: Place | None = ...) -> None: ...

class EnumerationType(Type):
    """One of the literals of an enumeration."""
    enumeration: Enumeration
    first: EnumerationLiteral | None
    last: EnumerationLiteral | None
    def __init__(self, *, enumeration: Enumeration | None = ..., first: EnumerationLiteral | None = ..., last: EnumerationLiteral | None = ..., source: Place | None = ...) -> None: ...

class Enumeration(NamedElement):
    """A finite set of named values (thesis 5.2.3)."""
    literals: MutableSequence[EnumerationLiteral]
    origin: str | None
    def __init__(self, *, literals: Iterable[EnumerationLiteral] = ..., origin: str | None = ..., name: str | None = ..., source: Place | None = ...) -> None: ...

class EnumerationLiteral(NamedElement):
    """One value of an enumeration."""
    def __init__(self, *, name: str | None = ..., source: Place | None = ...) -> None: ...

class Expression(Located):
    """Anything that has a value. The tree holds the structure, so the model has no parentheses."""
    def __init__(self, *, source: Place | None = ...) -> None: ...

class BinaryExpression(Expression):
    """An operator between two operands."""
    left: Expression
    right: Expression
    def __init__(self, *, left: Expression | None = ..., right: Expression | None = ..., source: Place | None = ...) -> None: ...

class Implication(BinaryExpression):
    """`=>` on booleans, right-associative."""
    def __init__(self, *, left: Expression | None = ..., right: Expression | None = ..., source: Place | None = ...) -> None: ...

class Disjunction(BinaryExpression):
    """`or` on booleans."""
    def __init__(self, *, left: Expression | None = ..., right: Expression | None = ..., source: Place | None = ...) -> None: ...

class Conjunction(BinaryExpression):
    """`and` on booleans."""
    def __init__(self, *, left: Expression | None = ..., right: Expression | None = ..., source: Place | None = ...) -> None: ...

class Equation(BinaryExpression):
    """`=` on two values of the same type."""
    def __init__(self, *, left: Expression | None = ..., right: Expression | None = ..., source: Place | None = ...) -> None: ...

class Inequation(BinaryExpression):
    """`!=` on two values of the same type."""
    def __init__(self, *, left: Expression | None = ..., right: Expression | None = ..., source: Place | None = ...) -> None: ...

class LessThan(BinaryExpression):
    """`<` on numbers."""
    def __init__(self, *, left: Expression | None = ..., right: Expression | None = ..., source: Place | None = ...) -> None: ...

class LessOrEqual(BinaryExpression):
    """`<=` on numbers."""
    def __init__(self, *, left: Expression | None = ..., right: Expression | None = ..., source: Place | None = ...) -> None: ...

class GreaterThan(BinaryExpression):
    """`>` on numbers."""
    def __init__(self, *, left: Expression | None = ..., right: Expression | None = ..., source: Place | None = ...) -> None: ...

class GreaterOrEqual(BinaryExpression):
    """`>=` on numbers."""
    def __init__(self, *, left: Expression | None = ..., right: Expression | None = ..., source: Place | None = ...) -> None: ...

class Addition(BinaryExpression):
    """`+` on numbers."""
    def __init__(self, *, left: Expression | None = ..., right: Expression | None = ..., source: Place | None = ...) -> None: ...

class Subtraction(BinaryExpression):
    """`-` on numbers."""
    def __init__(self, *, left: Expression | None = ..., right: Expression | None = ..., source: Place | None = ...) -> None: ...

class Multiplication(BinaryExpression):
    """`*` on numbers."""
    def __init__(self, *, left: Expression | None = ..., right: Expression | None = ..., source: Place | None = ...) -> None: ...

class Division(BinaryExpression):
    """`/` on numbers; the value is always a double."""
    def __init__(self, *, left: Expression | None = ..., right: Expression | None = ..., source: Place | None = ...) -> None: ...

class UnaryExpression(Expression):
    """An operator before its operand."""
    operand: Expression
    def __init__(self, *, operand: Expression | None = ..., source: Place | None = ...) -> None: ...

class Negation(UnaryExpression):
    """`!` on a boolean."""
    def __init__(self, *, operand: Expression | None = ..., source: Place | None = ...) -> None: ...

class UnaryMinus(UnaryExpression):
    """`-` on a number."""
    def __init__(self, *, operand: Expression | None = ..., source: Place | None = ...) -> None: ...

class DoubleConversion(UnaryExpression):
    """An integer as a double. Only transformations create this element: in sct and rosgraph models, both operands of a binary operator have one type."""
    def __init__(self, *, operand: Expression | None = ..., source: Place | None = ...) -> None: ...

class Conditional(Expression):
    """`then` if the condition holds, else `otherwise`. Only in provided data of a robosc model, the two may be objects or arrays."""
    condition: Expression
    then: Expression
    otherwise: Expression
    def __init__(self, *, condition: Expression | None = ..., then: Expression | None = ..., otherwise: Expression | None = ..., source: Place | None = ...) -> None: ...

class FunctionCall(Expression):
    """A function of its arguments, such as `mod(a, b)`. robosc/model/semantics/operators.py defines the functions."""
    function: str
    arguments: MutableSequence[Expression]
    def __init__(self, *, function: str | None = ..., arguments: Iterable[Expression] = ..., source: Place | None = ...) -> None: ...

class BooleanLiteral(Expression):
    """`true` or `false`."""
    value: bool
    def __init__(self, *, value: bool | None = ..., source: Place | None = ...) -> None: ...

class IntegerLiteral(Expression):
    """A whole number without sign, up to 2^63 - 1; 2^63 as the operand of a UnaryMinus only."""
    value: int
    def __init__(self, *, value: int | None = ..., source: Place | None = ...) -> None: ...

class DoubleLiteral(Expression):
    """A number with a fraction, without sign."""
    value: float
    def __init__(self, *, value: float | None = ..., source: Place | None = ...) -> None: ...

class StringLiteral(Expression):
    """Text with its escapes resolved."""
    value: str
    def __init__(self, *, value: str | None = ..., source: Place | None = ...) -> None: ...

class EnumerationLiteralReference(Expression):
    """A literal of an enumeration, in sct and rosgraph models."""
    literal: EnumerationLiteral
    def __init__(self, *, literal: EnumerationLiteral | None = ..., source: Place | None = ...) -> None: ...
