"""Values that the node computes from data and from the robot's state, because the supervisor cannot compute them.

A double, a string, an object or an array that a variable stores never reaches the supervisor, nor does data without a
finite domain. Where an expression of a transition compares them with the robot's state, the smallest part with finitely
many values around them is one input. The node computes it before the event.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple, TypeGuard

from robosc.model import expression as ex
from robosc.model import robosc
from robosc.model.semantics.communication import data_type, happens_anyway
from robosc.model.semantics.inputs import ComputedValue, is_partial, parameters_in
from robosc.model.semantics.operators import TypeRule, operator_of
from robosc.model.semantics.printing import RoboscPrinter
from robosc.model.semantics.typing import (
    BOOLEAN,
    DOUBLE,
    INTEGER,
    STRING,
    ArrayType,
    EnumType,
    ObjectType,
    Types,
    declared_type,
)
from robosc.model.semantics.walks import copy_tree, fold, operands, parts

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from robosc.model.semantics.communication import PortEvent
    from robosc.model.semantics.inputs import InputSource
    from robosc.model.semantics.instances import Instance, Instances, PortInstance

#: Operators between conditions. Conditions that the node computes stay one input below them.
_JOINS = (ex.Conjunction, ex.Disjunction, ex.Implication, ex.Negation)


@dataclass(frozen=True)
class StateValue(ComputedValue):
    """A value that the node computes from data and the robot's state before the event, such as `value < Base.last`.

    `within` is the instance whose text contains it; None: it is outside of components.
    """

    within: Instance | None = field(default=None, compare=False)


class InputContext(NamedTuple):
    """Context of an expanded expression of a transition on an event of a port.

    `within` is the instance whose text contains it. `bounds` are those of the variable that it is assigned to.
    """

    instances: Instances
    within: Instance | None
    port: PortInstance
    event: PortEvent
    bounds: tuple[int, int] | None
    is_condition: bool


def with_state_values(
    inputs: Sequence[tuple[ex.Expression, InputSource | None]], expression: ex.Expression, context: InputContext
) -> Sequence[tuple[ex.Expression, InputSource | None]]:
    """Return the parts of an expression that become inputs, with values that the node computes from the robot's state.

    `inputs` are its parts as `inputs_in` returns them. They are the result unless the supervisor lacks something. If a
    component reacts to another one, values that read its parameters belong to it.
    """
    splitting = _Splitting(dict(inputs), expression, context)
    parts_of_expression = list(splitting.inputs()) if splitting.unknown else inputs
    if context.within is context.port.instance:
        return parts_of_expression
    return [
        (part, splitting.state_value(part, source.bounds) if _reads_own_parameter(source) else source)
        for part, source in parts_of_expression
    ]


def with_own_parameters(
    inputs: Sequence[tuple[ex.Expression, InputSource | None]], expression: ex.Expression, context: InputContext
) -> Sequence[tuple[ex.Expression, InputSource | None]]:
    """Return the parts of a condition on a command that become inputs.

    Values that read parameters of a component belong to it. The node computes nothing else from the robot's state: for
    a running goal, the supervisor must judge the state anew.
    """
    splitting = _Splitting(dict(inputs), expression, context)
    return [
        (part, splitting.state_value(part, source.bounds) if _reads_own_parameter(source) else source)
        for part, source in inputs
    ]


class _Splitting:
    """Splitting of one expression. `unknown` are its parts that the supervisor cannot compute with."""

    def __init__(
        self, data: Mapping[ex.Expression, InputSource | None], expression: ex.Expression, context: InputContext
    ) -> None:
        self._data = data
        self._expression = expression
        self._context = context
        self._types = Types(declared_type(data_type(context.port.communication, context.event)))
        self.unknown = list(self._unknown())

    def _unknown(self) -> Iterator[ex.Expression]:
        pending = [self._expression]
        while pending:
            part = pending.pop()
            source = self._data.get(part)
            if isinstance(source, ComputedValue):
                if source.type == INTEGER and source.bounds is None:
                    yield part
                continue
            is_beyond = part in self._data and source is None
            if is_beyond or is_stored(part) or is_foreign(part, self._types):
                yield part
            pending += reversed(operands(part))

    def inputs(self) -> Iterator[tuple[ex.Expression, InputSource | None]]:
        """Iterate over the parts that become inputs, from left to right."""
        computed = self._computed()
        pending = [self._expression]
        while pending:
            part = pending.pop()
            if part in computed:
                yield self._input(part)
            elif part in self._data:
                yield part, self._data[part]
            else:
                pending += reversed(operands(part))

    def _computed(self) -> set[ex.Expression]:
        """Return the parts that the node computes from the robot's state: the largest joins of the smallest parts."""
        smallest = set(self._smallest())
        conditions = {
            part for part, source in self._data.items() if isinstance(source, ComputedValue) and source.type == BOOLEAN
        } | smallest
        joined: dict[ex.Expression, bool] = {}
        fold(
            lambda part, inside: part in conditions or (isinstance(part, _JOINS) and all(inside)),
            self._expression,
            lambda part: () if part in conditions else operands(part),
            joined,
        )
        largest: set[ex.Expression] = set()
        pending = [self._expression]
        while pending:
            part = pending.pop()
            if not joined.get(part):
                pending += [] if part in conditions else operands(part)
            elif not smallest.isdisjoint(parts(part)):
                largest.add(part)
        return largest

    def _smallest(self) -> Iterator[ex.Expression]:
        """Iterate over the smallest parts with finitely many values around the unknown ones.

        At an event that happens anyway, a condition that reads an array stays whole: without the array, it is false.
        """
        parents = {child: part for part in parts(self._expression) for child in operands(part)}
        assigned = {self._expression}
        if isinstance(self._expression, ex.Conditional):
            assigned = set(_branches(self._expression))
        whole = set(self._whole())
        for unknown in self.unknown:
            part: ex.Expression | None = unknown
            above = unknown
            while part is not None and not self._is_finite(part, is_assigned=part in assigned):
                part = parents.get(part)
            while above in parents and above not in whole:
                above = parents[above]
            if above in whole and self._is_finite(above, is_assigned=above in assigned):
                yield above
            elif part is not None:
                yield part

    def _whole(self) -> Iterator[ex.Expression]:
        """Iterate over the parts that stay whole: the operands of `and` that read elements of arrays."""
        pending = [self._expression] if happens_anyway(self._context.event) else []
        while pending:
            part = pending.pop()
            if self._context.is_condition and isinstance(part, ex.Conjunction):
                pending += operands(part)
            elif any(map(is_partial, parts(part))):
                yield part

    def _is_finite(self, part: ex.Expression, *, is_assigned: bool) -> bool:
        kind = self._types(part)
        if kind == INTEGER:
            return self._bounds(part, is_assigned=is_assigned) is not None
        return kind == BOOLEAN or isinstance(kind, EnumType)

    def _bounds(self, part: ex.Expression, *, is_assigned: bool) -> tuple[int, int] | None:
        """Return the bounds of an integer: of the data or the variable that it is, or is assigned to."""
        if is_assigned and self._context.bounds is not None:
            return self._context.bounds
        declared = self._declared(part) if isinstance(part, robosc.Access) else None
        if not isinstance(declared, robosc.IntegerDataType) or declared.minimum is None or declared.maximum is None:
            return None
        return declared.minimum, declared.maximum

    def _declared(self, access: robosc.Access) -> robosc.DataType | None:
        """Return the declared type of the data that an access reads. None if it is unknown."""
        instances, within, port, event, *_ = self._context
        owned = instances.variable(access, within)
        instance = port.instance if owned is None else owned.instance
        reached = data_type(port.communication, event) if access.value else owned.variable.type if owned else None
        for segment in access.segments:
            if isinstance(segment, robosc.PropertySegment):
                reached = segment.property.type if segment.property else None
            elif isinstance(reached, robosc.Array) and isinstance(segment, robosc.IndexSegment):
                reached = reached if segment.last is not None else reached.type
            else:
                return None
        return None if reached is None else instance.data_type(reached)

    def _input(self, part: ex.Expression) -> tuple[ex.Expression, StateValue]:
        """Return the input of a part. A condition and its negation share one, unless arrays may lack elements."""
        while isinstance(part, ex.Negation) and not (
            happens_anyway(self._context.event) and any(map(is_partial, parts(part)))
        ):
            part = part.operand
        is_integer = self._types(part) == INTEGER
        bounds = self._bounds(part, is_assigned=part in _branches(self._expression)) if is_integer else None
        return part, self.state_value(part, bounds)

    def state_value(self, part: ex.Expression, bounds: tuple[int, int] | None) -> StateValue:
        """Return the value of a part as an input with these bounds."""
        instances, within, port, event, *_ = self._context
        expression = _qualified(part, instances, within)
        kind, parameters = self._types(part), parameters_in(expression)
        return StateValue(port, event, RoboscPrinter()(expression), bounds, expression, kind, parameters, within)


def _reads_own_parameter(source: InputSource | None) -> TypeGuard[ComputedValue]:
    """Return whether a value that the node computes reads a parameter of a component."""
    return isinstance(source, ComputedValue) and any(
        isinstance(part, robosc.Access) and isinstance(part.item, robosc.Parameter) and part.component is not None
        for part in parts(source.expression)
    )


def is_stored(part: ex.Expression) -> bool:
    """Return whether a part reads a variable of a type that only the node stores."""
    if not isinstance(part, robosc.Access) or not isinstance(part.item, robosc.Variable):
        return False
    kind = declared_type(part.item.type)
    return kind in {DOUBLE, STRING} or isinstance(kind, ArrayType | ObjectType)


def is_foreign(part: ex.Expression, types: Types) -> bool:
    """Return whether a part is a function of doubles or strings that depends on something."""
    row = operator_of(part) if isinstance(part, ex.FunctionCall) else None
    if row is None or row.rule is TypeRule.INTEGER or not {DOUBLE, STRING} & {types(part), *map(types, operands(part))}:
        return False
    return any(isinstance(inside, robosc.Access) for inside in parts(part))


def _branches(expression: ex.Expression) -> Iterator[ex.Expression]:
    """Iterate over an expression and the branches of its conditionals, to which the bounds of its variable apply."""
    pending = [expression]
    while pending:
        part = pending.pop()
        yield part
        if isinstance(part, ex.Conditional):
            pending += [part.then, part.otherwise]


def _qualified(part: ex.Expression, instances: Instances, within: Instance | None) -> ex.Expression:
    """Return a copy of an expression in which each state and variable has the name of its component."""
    copy = copy_tree(part)
    for access in parts(copy):
        if not isinstance(access, robosc.Access):
            continue
        if isinstance(access.item, robosc.Variable | robosc.State | robosc.CommunicationType | robosc.Parameter):
            is_outside = isinstance(access.item, robosc.Parameter) and access.component is None
            owner = None if is_outside else instances.instance_of(access, within)
            if owner is not None:
                access.component, access.index = owner.referent, None
    return copy
