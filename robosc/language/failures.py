"""Bare values of the predefined enum `Failure`, which are recognized only where the text expects a reason."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.model import expression as ex
from robosc.model import robosc as rsc
from robosc.model.semantics.failures import FAILURE, is_failure
from robosc.model.semantics.typing import EnumType, declared_type, type_of

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from robosc.language.scopes import File


def names_failures(file: File) -> bool:
    """Return whether a file needs the predefined library.

    That is the case if it, or a library that it imports, names the enum or a reason.
    """
    if any(library is not None and library.predefined is not None for library in file.libraries.values()):
        return True
    return any(
        isinstance(element, rsc.ErrorReason) or any(name.text == FAILURE for name in names.values())
        for element, names in file.references.items()
    )


def expects_failure(element: ex.Located, is_bare: Callable[[ex.Expression], bool]) -> bool:
    """Return whether the text expects a value of `Failure` at the position of an expression.

    All other names of the text must be linked. `is_bare` returns whether an expression is a bare name. If both operands
    of `=` or `!=` are bare names, only the right one is expected to have the type of the other.
    """
    around = element.eContainer()
    while isinstance(around, ex.Conditional) and element is not around.condition:
        element, around = around, around.eContainer()
    match around:
        case ex.Equation() | ex.Inequation():
            if element is around.right:
                return _is_reason(around.left)
            return not is_bare(around.right) and _is_reason(around.right)
        case rsc.Assignment():
            return around.item is not element and _is_reason(around.item)
        case rsc.Variable() | rsc.Constant() | rsc.Parameter() | rsc.FormalParameter() | rsc.Function():
            return _is_declared(around.type)
        case rsc.Call() if around.function is not None:
            return _is_argument(element, around.arguments, around.function.parameters)
        case rsc.Argument():
            return _is_given(around)
    return False


def _is_given(argument: rsc.Argument) -> bool:
    user = argument.eContainer()
    if argument.parameter is not None:
        return _is_declared(argument.parameter.type)
    made_of = user.type if isinstance(user, rsc.ComplexDataTypeReference) else user.definition
    parameters = made_of.parameters if isinstance(made_of, rsc.Component | rsc.EnumDataType) else ()
    return _is_argument(argument, user.arguments, parameters)


def _is_argument(
    argument: ex.Located, arguments: Sequence[ex.Located], parameters: Sequence[rsc.FormalParameter]
) -> bool:
    at = list(arguments).index(argument)
    return at < len(parameters) and _is_declared(parameters[at].type)


def _is_declared(declared: rsc.DataType | None) -> bool:
    kind = declared_type(declared)
    return isinstance(kind, EnumType) and is_failure(kind.definition)


def _is_reason(expression: ex.Expression | None) -> bool:
    # Only these expressions can have an enum type. Operators are skipped: long chains of them would be slow to type.
    if not isinstance(expression, rsc.Access | rsc.ErrorReason | rsc.Call | ex.Conditional):
        return False
    kind = type_of(expression)
    return isinstance(kind, EnumType) and is_failure(kind.definition)
