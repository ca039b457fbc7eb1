"""Whether arrays in the data that a script gives to an event have all elements that its transitions read."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from robosc.metamodel import expression as ex
from robosc.metamodel import rosgraph
from robosc.runtime.core.node_data import PastEndError
from robosc.semantics.evaluation import Value, evaluate
from robosc.semantics.operators import operator_of
from robosc.semantics.walks import operands, walk

if TYPE_CHECKING:
    from collections.abc import Generator, Iterable, Sequence

#: A value that a script does not give.
_UNKNOWN: Any = object()


@dataclass(frozen=True)
class Unreadable:
    """Data that can't be read: `why`, and the `error` event that happens instead; None: it counts as not received."""

    why: str
    error: str | None

    def __str__(self) -> str:
        return "data"


class _UnknownError(Exception):
    """A condition reads a value that the script does not give."""


def past_end(expressions: Iterable[ex.Expression], value: Any) -> PastEndError | None:
    """The first element that these expressions read and an array in the value lacks; None where there is none.

    The value is that of an event's data, as JSON: of an array that is not there nothing is known.
    """

    def missing(expression: ex.Expression) -> Generator[ex.Expression, PastEndError | None, PastEndError | None]:
        match expression:
            case rosgraph.WireAccess():
                return _past_end(expression.steps, value)
            case rosgraph.ConversionCall():
                return _past_end(expression.argument.steps, value)
        operator = operator_of(expression)
        for operand in operands(expression):
            fault = yield operand
            if fault is not None:
                return fault
            decided = None if operator is None else operator.decided
            if decided is not None and _known(operand, value) is not (not decided):
                return None  # the right side is not read, or nobody knows
        return None

    return next(filter(None, (walk(missing, expression) for expression in expressions)), None)


def _past_end(steps: Sequence[rosgraph.WireStep], value: Any) -> PastEndError | None:
    reached = value
    for step in steps:
        if isinstance(step, rosgraph.IndexStep) and isinstance(reached, list | dict):
            length = len(reached) if isinstance(reached, list) else 1 + max(map(int, reached), default=-1)
            if step.index >= length:
                return PastEndError(step.index, length)
        reached = _below(reached, step)
    return None


def _below(value: Any, step: rosgraph.WireStep) -> Any:
    if isinstance(step, rosgraph.IndexStep):
        if isinstance(value, list):
            return value[step.index] if step.index < len(value) else _UNKNOWN
        return value.get(str(step.index), _UNKNOWN) if isinstance(value, dict) else _UNKNOWN
    assert isinstance(step, rosgraph.FieldStep)
    return value.get(step.name, _UNKNOWN) if isinstance(value, dict) else _UNKNOWN


def _known(condition: ex.Expression, value: Any) -> bool | None:
    """The value of a condition; None where something that it reads is not given."""

    def read(reference: ex.Expression) -> Value:
        if not isinstance(reference, rosgraph.WireAccess):
            raise _UnknownError
        reached = value
        for step in reference.steps:
            reached = _below(reached, step)
        if reached is None and isinstance(reference.type, ex.DoubleType):
            return math.nan
        if not isinstance(reached, bool | int | float | str):
            raise _UnknownError
        return reached

    try:
        return bool(evaluate(condition, read))
    except _UnknownError:
        return None
