"""Check whether arrays in the data of a script's event have all elements that its transitions read."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from robosc.model import expression as ex
from robosc.model import rosgraph
from robosc.model.semantics.evaluation import Value, evaluate
from robosc.model.semantics.operators import UnreadableError, as_double, operator_of
from robosc.model.semantics.walks import operands, walk
from robosc.run.runtime.core.node_data import PastEndError

if TYPE_CHECKING:
    from collections.abc import Generator, Iterable

#: Stands for a value that a script does not give.
_UNKNOWN: Any = object()


@dataclass(frozen=True)
class Unreadable:
    """Data that can't be read: `why`, and the `error` event that happens instead; None: it counts as not received.

    Or data of an error that can be read: then it belongs to a `response`.
    """

    why: str
    error: str | None
    response: str | None = None

    def __str__(self) -> str:
        return "data"


class UnknownError(Exception):
    """Read of a value that is not given."""


def past_end(expressions: Iterable[ex.Expression], value: Any) -> UnreadableError | None:
    """Return an error for the first element that these expressions read and an array in the value lacks, else None.

    The value is an event's data as JSON. Missing arrays are not considered.
    """

    def missing(expression: ex.Expression) -> Generator[ex.Expression, UnreadableError | None, UnreadableError | None]:
        match expression:
            case rosgraph.WireAccess() if not operands(expression) and expression.quantifier is None:
                return _past_end(expression, value)
            case rosgraph.ConversionCall() if not operands(expression.argument):
                return _past_end(expression.argument, value)
            case rosgraph.ArrayQuantifier() | rosgraph.WireAccess() | rosgraph.ConversionCall():
                return _fault(expression, value)
        operator = operator_of(expression)
        if operator is not None and operator.is_partial:
            return _fault(expression, value)
        for operand in operands(expression):
            fault = yield operand
            if fault is not None:
                return fault
            decided = None if operator is None else operator.decided
            if decided is not None and _known(operand, value) is not (not decided):
                return None  # the right side is not read, or the value is unknown
        return None

    return next(filter(None, (walk(missing, expression) for expression in expressions)), None)


def _fault(expression: ex.Expression, value: Any) -> UnreadableError | None:
    """Return why an expression has no value; None if it has one, or if a value that it reads is not given."""
    try:
        evaluate(expression, partial(read, value))
    except UnreadableError as fault:
        return fault
    except UnknownError:
        pass
    return None


def _past_end(access: rosgraph.WireAccess, value: Any) -> PastEndError | None:
    reached = _UNKNOWN if access.variable is not None else value  # stored data is unknown
    for step in access.steps:
        if isinstance(step, rosgraph.IndexStep) and isinstance(reached, list | dict):
            length = len(reached) if isinstance(reached, list) else 1 + max(map(int, reached), default=-1)
            assert step.index is not None
            if step.index >= length:
                return PastEndError(step.index, length)
        reached = _below(reached, step)
    return None


def _below(value: Any, step: rosgraph.WireStep) -> Any:
    if isinstance(step, rosgraph.IndexStep):
        if isinstance(value, list):
            index = step.index
            return value[index] if index is not None and index < len(value) else _UNKNOWN
        return value.get(str(step.index), _UNKNOWN) if isinstance(value, dict) else _UNKNOWN
    assert isinstance(step, rosgraph.FieldStep)
    return value.get(step.name, _UNKNOWN) if isinstance(value, dict) else _UNKNOWN


def _known(condition: ex.Expression, value: Any) -> bool | None:
    """Return the value of a condition; None if something that it reads is not given."""
    try:
        return bool(evaluate(condition, partial(read, value)))
    except (UnknownError, UnreadableError):
        return None


def read(value: Any, reference: ex.Expression, *indices: Any) -> Value:
    """Return what a reference reads of a value; `indices` are its indices, after the element of its quantifier, if any.

    Raises UnknownError and UnreadableError.
    """
    if not isinstance(reference, rosgraph.WireAccess) or reference.variable is not None:
        raise UnknownError
    rest = iter(indices if reference.quantifier else (value, *indices))
    reached = next(rest)
    for step in reference.steps:
        if isinstance(step, rosgraph.SliceStep):
            first, last, length = next(rest), next(rest), len(_elements(reached))
            if first <= last and not (first >= 0 and last < length):
                raise UnreadableError(f"there are no elements {first} to {last} in an array of {length}")
            reached = _elements(reached)[first : last + 1] if first <= last else []
        elif isinstance(step, rosgraph.IndexStep) and step.position is not None:
            index, length = next(rest), len(_elements(reached))
            if not 0 <= index < length:
                raise PastEndError(index, length)
            reached = _elements(reached)[index]
        else:
            reached = _below(reached, step)
    leaf: Value = _leaf(reached, reference.type)
    return leaf


def _leaf(reached: Any, kind: ex.Type | None) -> Any:
    if isinstance(kind, rosgraph.ArrayType):
        return [_leaf(element, kind.element) for element in _elements(reached)]
    if reached is None and isinstance(kind, ex.DoubleType):
        return math.nan
    if kind is not None and not isinstance(reached, bool | int | float | str):
        raise UnknownError
    return as_double(reached) if isinstance(kind, ex.DoubleType) else reached


def _elements(array: Any) -> list[Any]:
    if not isinstance(array, list):
        raise UnknownError  # an object from index to element may lack elements
    return array
