"""Inputs of the supervisor from the data of an event: finite data itself, and values computed from other data."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from robosc.model import expression as ex
from robosc.model import robosc
from robosc.model.semantics.communication import PortEvent, data_type, happens_anyway
from robosc.model.semantics.operators import operator_of
from robosc.model.semantics.printing import RoboscPrinter
from robosc.model.semantics.typing import BOOLEAN, INTEGER, EnumType, Types, declared_type
from robosc.model.semantics.walks import copy_tree, fold, operands, parts

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from robosc.model.semantics.instances import PortInstance
    from robosc.model.semantics.typing import Type

#: Items that an expression over event data may also read, because no state changes them.
_FIXED = (robosc.EnumValue, robosc.Constant, robosc.Parameter, robosc.FormalParameter, robosc.ArrayElement)


class _Reads(NamedTuple):
    """Summary of an expression's reads: `data` of an event, or values without a finite domain (`beyond`).

    `fixed`: nothing else that it reads depends on the robot's state. `elements`: it reads elements of an array of the
    data. `reason`: it reads why the service or action of an error failed.
    """

    data: bool
    fixed: bool
    beyond: bool
    elements: bool = False
    reason: bool = False

    @property
    def computed(self) -> bool:
        """Whether only the node can compute it, from nothing but the data."""
        return self.data and self.fixed and self.beyond


@dataclass(frozen=True)
class Data:
    """A part of the data of a port's event: the path of properties from the whole to it. Empty: the whole data."""

    port: PortInstance
    event: PortEvent
    path: tuple[robosc.ObjectProperty, ...]

    @property
    def type(self) -> robosc.DataType | None:
        """The declared type, with the bounds of an integer computed. None if unknown."""
        declared = self.path[-1].type if self.path else data_type(self.port.communication, self.event)
        return None if declared is None else self.port.instance.data_type(declared)


@dataclass(frozen=True)
class ComputedValue:
    """A value that the node computes from data without a finite domain, such as `value.range < 0.5`.

    Values with the same text and the same parameters are equal. `bounds` are the bounds of an integer, if any apply.
    """

    port: PortInstance
    event: PortEvent
    text: str
    bounds: tuple[int, int] | None
    expression: ex.Expression = field(compare=False)
    type: Type = field(compare=False)
    parameters: tuple[robosc.Parameter, ...] = ()


@dataclass(frozen=True)
class FailureReason:
    """The reason for the failure of a service or action, as a value of `enum`."""

    port: PortInstance
    event: PortEvent
    enum: robosc.EnumDataType


InputSource: TypeAlias = "Data | ComputedValue | FailureReason"


def inputs_in(
    expression: ex.Expression,
    port: PortInstance,
    event: PortEvent,
    bounds: tuple[int, int] | None = None,
    *,
    is_condition: bool = True,
) -> Iterator[tuple[ex.Expression, InputSource | None]]:
    """Iterate over the parts of an expanded expression that become inputs, from left to right.

    The input of a part is None if it cannot be one. `bounds` are those of the variable that the expression is assigned
    to.

    For an event that happens even without readable data, array elements may be missing. A condition that reads such
    elements is one input, or several joined by `and`: it is false if an element is missing, and so is its negation. A
    value that reads such elements is one input as a whole.
    """
    types = Types(declared_type(data_type(port.communication, event)))
    reads: dict[ex.Expression, _Reads] = {}
    fold(lambda part, inside: _reads(part, inside, port, event), expression, memo=reads)
    pending = [(expression, bounds)]
    while pending:
        part, limits = pending.pop()
        # A condition and its negation share one input. A reason is an input of its own.
        splits = isinstance(part, ex.Negation) or reads[part].reason
        if happens_anyway(event) and reads[part].elements and reads[part].data:
            splits = is_condition and isinstance(part, ex.Conjunction)
            if not splits and not reads[part].computed:
                yield part, None
                continue
        kind = types(part) if reads[part].computed and not splits else None
        if isinstance(part, robosc.ErrorReason):
            assert part.enumeration is not None
            yield part, FailureReason(port, event, part.enumeration)
        elif kind in {BOOLEAN, INTEGER} or isinstance(kind, EnumType):
            yield (
                part,
                ComputedValue(
                    port,
                    event,
                    RoboscPrinter()(part),
                    limits if kind == INTEGER else None,
                    part,
                    kind,
                    parameters_in(part),
                ),
            )
        elif isinstance(part, robosc.Access) and part.value:
            yield part, None if reads[part].beyond else Data(port, event, property_path(part) or ())
        else:
            # The bounds of a conditional's variable apply to its branches.
            inside = operands(part)
            limits_inside = [None, limits, limits] if isinstance(part, ex.Conditional) else [None] * len(inside)
            pending += reversed(list(zip(inside, limits_inside, strict=True)))


def parameters_in(expression: ex.Expression) -> tuple[robosc.Parameter, ...]:
    """Return the parameters that an expression reads. Those of a library and of a robot may have the same name."""
    accesses = (part for part in parts(expression) if isinstance(part, robosc.Access))
    return tuple(access.item for access in accesses if isinstance(access.item, robosc.Parameter))


def readable(carried: ComputedValue) -> ComputedValue:
    """Return the input that is true if all array elements for a value exist.

    Its expression compares the value with itself.
    """
    same = ex.Equation(left=copy_tree(carried.expression), right=copy_tree(carried.expression))
    return ComputedValue(carried.port, carried.event, RoboscPrinter()(same), None, same, BOOLEAN, carried.parameters)


def may_be_missing(carried: ComputedValue) -> bool:
    """Return whether an array element that the value needs may be missing, at an event that happens even then."""
    return happens_anyway(carried.event) and any(map(is_partial, parts(carried.expression)))


def _reads(part: ex.Expression, inside: Sequence[_Reads], port: PortInstance, event: PortEvent) -> _Reads:
    """Summarize the reads of an expression from those of its operands. The operands of an access are its indices."""
    data, fixed = any(operand.data for operand in inside), all(operand.fixed for operand in inside)
    beyond, reason = any(operand.beyond for operand in inside), any(operand.reason for operand in inside)
    elements = any(operand.elements for operand in inside) or is_partial(part)
    if isinstance(part, robosc.ErrorReason):
        return _Reads(True, True, False, reason=True)
    if not isinstance(part, robosc.Access):
        return _Reads(data, fixed, beyond, elements, reason)
    if not part.value:
        fixed = fixed and isinstance(part.item, _FIXED)
        return _Reads(data, fixed, beyond or isinstance(part.item, robosc.Parameter), elements, reason)
    path = property_path(part)
    return _Reads(True, fixed, path is None or not _is_finite(Data(port, event, path).type), elements, reason)


def is_partial(part: ex.Expression) -> bool:
    """Return whether a part may have no value: it reads an array element by index, or calls a partial function."""
    if isinstance(part, robosc.Access):
        return any(isinstance(segment, robosc.IndexSegment) for segment in part.segments)
    row = operator_of(part) if isinstance(part, ex.FunctionCall) else None
    return row is not None and row.is_partial


def _is_finite(declared: robosc.DataType | None) -> bool:
    """Return whether data of the type is an input itself. Unknown types count too; other checks report them."""
    if isinstance(declared, robosc.IntegerDataType):
        return declared.minimum is not None and declared.maximum is not None
    kind = declared_type(declared)
    return kind == BOOLEAN or isinstance(kind, EnumType)


def property_path(access: robosc.Access) -> tuple[robosc.ObjectProperty, ...] | None:
    """Return the properties that an access to `value` follows. None if it indexes an array or is unresolved."""
    segments = list(access.segments)
    if not all(isinstance(segment, robosc.PropertySegment) and segment.property is not None for segment in segments):
        return None
    return tuple(segment.property for segment in segments if isinstance(segment, robosc.PropertySegment))
