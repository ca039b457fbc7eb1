"""Comparison of the conditions under which an event violates an assumption with the text."""

from __future__ import annotations

from itertools import product
from math import prod
from typing import TYPE_CHECKING, Any

from robosc.analysis.verify.controller_reading.loop import event_names
from robosc.analysis.verify.model_reading.lockstep import DifferenceError, line, where
from robosc.analysis.wording import words
from robosc.engine.expressions import Compiler, all_inside
from robosc.engine.state import Domain
from robosc.model import engine

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from robosc.analysis.verify.model_reading.controller import ControllerText
    from robosc.analysis.verify.model_reading.machine import Condition, Machine, Plant, Slot, Value
    from robosc.model import expression as ex

    State = Mapping[Slot, Value]


class ViolationComparison:
    """Comparison of the assumptions about each event, in all values of what their conditions read.

    An event violates an assumption exactly where the condition in the text does not hold. The guard of the event holds
    as far as assumptions are concerned where it violates none. `is_sampled`: some condition reads more than `values`
    combinations of values, and was not compared.
    """

    def __init__(self, controller: ControllerText, plants: Machine, executed: engine.EngineModel, values: int) -> None:
        self.is_sampled = False
        self._text = controller.text
        self._executed = executed
        self._values = values
        self._names = event_names(plants)
        self._slots: dict[Any, Slot] = {element: slot for slot, element in plants.sources.items()}
        self._compiler = Compiler(executed)
        self._cells = [self._slots.get(cell.variable or cell.plant) for cell in executed.variables]
        self._domains = [Domain(cell.type) for cell in executed.variables]

    def run(self) -> None:
        """Compare the assumptions; raise DifferenceError for the first difference."""
        for event in self._executed.events:
            ours = self._text.assumed.get(self._names[event.event], {})
            reasons = {
                self._slots[reason.assumption].plant: reason.condition
                for reason in event.reasons
                if reason.assumption is not None
            }
            for plant in dict.fromkeys([*ours, *reasons]):
                self._compare_violation(event, plant, ours.get(plant), reasons.get(plant))
            self._compare_guard(event, list(ours.values()))

    def _compare_violation(
        self, event: engine.Event, plant: Plant, condition: Condition | None, reason: ex.Expression | None
    ) -> None:
        def violated(state: State) -> bool:
            return condition is not None and not condition.compute(state, {})

        state = self._difference(violated, [] if condition is None else [condition], reason, otherwise=False)
        if state is not None:
            is_ours = violated(state)
            sides = ("by the text", "in the controller") if is_ours else ("in the controller", "by the text")
            source = next(slot for slot in self._text.domains if slot.plant == plant)
            assumption = f"the assumption{line(self._text.sources.get(source))}"
            message = f"{words(event.event)} violates {assumption} {sides[0]}, and not {sides[1]}"
            raise DifferenceError(f"{message}{where(state)}")

    def _compare_guard(self, event: engine.Event, conditions: list[Condition]) -> None:
        def holds(state: State) -> bool:
            return all(condition.compute(state, {}) for condition in conditions)

        state = self._difference(holds, conditions, event.guard.assumption, otherwise=True)
        if state is not None:
            verb = "violates no assumption" if holds(state) else "violates an assumption"
            message = f"{words(event.event)} {verb} by the text, and its guard in the controller differs"
            raise DifferenceError(f"{message}{where(state)}")

    def _difference(
        self, ours: Callable[[State], bool], sources: list[Condition], theirs: ex.Expression | None, *, otherwise: bool
    ) -> State | None:
        """Return values for which a condition of the text and one of the controller differ.

        `sources` are the conditions that the one of the text is computed from. A missing one of the controller has the
        value `otherwise`.
        """
        conditions = [] if theirs is None else [theirs]
        variables = (part.variable for part in all_inside(conditions) if isinstance(part, engine.VariableReference))
        slots = sorted(
            {self._slots[cell.variable or cell.plant] for cell in variables}.union(*(own.reads for own in sources))
        )
        domains = [self._text.domains[slot] for slot in slots]
        if prod(map(len, domains)) > self._values:
            self.is_sampled = True
            return None
        compute = None if theirs is None else self._compiler(theirs)
        for values in product(*domains):
            state: State = dict(zip(slots, values, strict=True))
            holds = otherwise if compute is None else bool(compute(self._codes(state), ()))
            if holds is not ours(state):
                return state
        return None

    def _codes(self, state: State) -> list[int]:
        return [
            domain.low if slot is None or slot not in state else domain.internal(state[slot])
            for slot, domain in zip(self._cells, self._domains, strict=True)
        ]
