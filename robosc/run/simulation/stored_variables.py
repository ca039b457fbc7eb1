"""Variables that a node keeps beside its supervisor, in a run: numbers, texts and others that no decision needs."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Any

from robosc.model import expression as ex
from robosc.model import rosgraph, sct
from robosc.model.semantics.communication import happens_anyway
from robosc.model.semantics.definition import reported_variables
from robosc.model.semantics.evaluation import evaluate
from robosc.model.semantics.messages import reads_elements
from robosc.model.semantics.operators import UnreadableError
from robosc.model.semantics.roles import event_name
from robosc.run.runtime.core.event_log import format_value
from robosc.run.runtime.core.node_data import NodeData, within_range
from robosc.run.simulation.data import reason_of, whole
from robosc.run.simulation.unreadable import UnknownError, read

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robosc.engine import Engine
    from robosc.engine.state import State

#: Values by `Component.variable`, a literal by its name; None if it is unknown or no finite number.
Values = dict[str, bool | int | float | str | None]


#: Stands for data that an event came without.
_NOT_GIVEN = object()


class StoredVariables:
    """Tracker of those variables of components that reports on `~/state` show and the supervisor does not need."""

    def __init__(self, engine: Engine, graph: rosgraph.RosGraph | None) -> None:
        self._engine = engine
        self._names: dict[rosgraph.NodeVariable, str] = {}
        self._reactions: dict[str, list[rosgraph.Reaction]] = {}
        self._happens_anyway = False
        #: Initial values.
        self.initial: Values = {}
        if graph is None:
            return
        self._node = NodeData(graph, engine)
        shown = reported_variables(graph)
        for plant in engine.model.plants:
            if plant.kind == sct.PlantKind.behaviour:
                self._names |= {
                    variable: f"{variable.component}.{variable.name}" for variable in shown.get(plant.origin, ())
                }
        self.initial = {name: _finite(self._node.variables[variable]) for variable, name in self._names.items()}
        for reaction in graph.reactions:
            if any(assigned.variable in self._names for assigned in reaction.assignments):
                self._reactions.setdefault(event_name(reaction.event), []).append(reaction)

    def after(self, values: Values, event: str, data: Mapping[str, Any], before: State) -> Values:
        """Return the values after an event in the state `before`, with data in the shape of the event log.

        A value computed of missing data is unknown.
        """
        changed: Values = {}
        reactions = self._reactions.get(event, ())
        if reactions:
            self._node.reason = reason_of(reactions[0].event, data)
            self._happens_anyway = happens_anyway(reactions[0].event) and "value" in data
        now, self._engine.state = self._engine.state, before
        for reaction in reactions:
            if not any(map(self._node.is_in, reaction.locations)):
                continue
            taken = True if reaction.guard is None else self._value(reaction.guard, values, data)
            if taken is False:
                continue
            for assigned in reaction.assignments:
                if assigned.variable in self._names:
                    value = self._value(assigned.value, values, data) if taken else None
                    kind = assigned.variable.type
                    changed[self._names[assigned.variable]] = (
                        None if value is None else _finite(within_range(value, kind))
                    )
        self._engine.state = now
        return {**values, **changed}

    def update(self, values: Values, variables: Mapping[str, Any]) -> Values:
        """Return the values updated by a report, by `Component.variable`; other variables of it are ignored."""
        known = {name: value for name, value in variables.items() if name in self.initial}
        return {
            **values,
            **{name: _finite(value) for name, value in known.items() if not isinstance(value, list | dict)},
        }

    def _value(self, expression: ex.Expression, values: Values, data: Mapping[str, Any]) -> Any:
        """Return the value of an expression; None if something that it reads is unknown."""
        whole_data = whole(data["value"], expression) if "value" in data else _NOT_GIVEN
        try:
            return evaluate(expression, partial(self._read, values, whole_data))
        except (UnknownError, UnreadableError):
            return None

    def _read(self, values: Values, data: Any, reference: ex.Expression, *indices: Any) -> Any:
        match reference:
            case rosgraph.NodeVariableReference():
                return self._variable(reference.variable, values)
            case rosgraph.ConversionCall():
                return self._literal(reference.conversion, read(data, reference.argument, *indices), values)
            case rosgraph.ErrorReason():
                return self._node.value(reference)
            case ex.EnumerationLiteralReference():
                return reference.literal
            case sct.LocationReference():
                return self._node.is_in(reference.location)
            case sct.VariableReference():
                return self._node.value(reference)
        return self._reached(data, reference, *indices)

    def _reached(self, data: Any, reference: ex.Expression, *indices: Any) -> Any:
        """Return the value that a reference reads of data.

        The log of an end that happens anyway leaves out what could not be read: an element there is `UnreadableError`.
        """
        try:
            return read(data, reference, *indices)
        except UnknownError:
            if self._happens_anyway and reads_elements(reference):
                raise UnreadableError("the array has no such element") from None
            raise

    def _variable(self, variable: rosgraph.NodeVariable, values: Values) -> Any:
        if isinstance(variable, rosgraph.Parameter):
            return self._node.variables[variable]
        value = values.get(self._names.get(variable, ""))
        if value is None:
            raise UnknownError
        if isinstance(variable.type, ex.EnumerationType):
            return next(literal for literal in variable.type.enumeration.literals if literal.name == value)
        return value

    def _literal(self, conversion: rosgraph.Conversion, argument: Any, values: Values) -> Any:
        """Return the literal that is named, or that a conversion makes of data."""
        named = [literal for literal in conversion.enumeration.literals if literal.name == argument]
        if named:
            return named[0]
        for rule in conversion.rules:
            try:
                if evaluate(rule.condition, partial(self._read, values, argument)):
                    return rule.literal
            except UnreadableError:
                continue
        return conversion.default


def _finite(value: Any) -> bool | int | float | str | None:
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        return None
    external: bool | int | float | str | None = format_value(value)  # type: ignore[assignment]
    return external
