"""Comparison of the controller's conditions for commands with inputs with the model under its supervisor."""

from __future__ import annotations

from itertools import product
from math import prod
from typing import TYPE_CHECKING

from robosc.analysis.paths import TraceStep
from robosc.analysis.system import GuardedSystem
from robosc.analysis.verify.model_reading.lockstep import DifferenceError
from robosc.analysis.wording import words
from robosc.engine.expressions import Compiler, all_inside
from robosc.engine.state import Domain
from robosc.model import engine
from robosc.model.semantics.roles import event_name
from robosc.synthesis import use_encoding
from robosc.synthesis.decoding import value
from robosc.synthesis.encoding import pick

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from robosc.model import expression as ex
    from robosc.model import sct
    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Element, Encoding

    #: A difference: what the controller does, the trace to it, and the command there.
    _Difference = tuple[str, tuple[TraceStep, ...], TraceStep]


class DataComparison:
    """Comparison of the terms and the condition on inputs of each command that carries inputs.

    In each state that the supervised robot reaches, the terms hold exactly if some inputs are allowed. The further
    condition then holds exactly for these inputs. `is_sampled`: the terms of some command have more than `values`
    combinations of the values that they read, and were not compared.
    """

    def __init__(self, executed: engine.EngineModel, values: int) -> None:
        self.is_sampled = False
        self._executed = executed
        self._values = values
        self._compiler = Compiler(executed)
        self._cells: list[Element] = [cell.variable or cell.plant for cell in executed.variables]
        self._inputs: list[Element] = [carrier.input for carrier in executed.inputs]
        self._commands = [event for event in executed.events if event.event.controllable and event.event.inputs]

    def run(self) -> None:
        """Compare the commands; raise DifferenceError for the first difference."""
        if not self._commands:
            return
        difference = use_encoding(self._executed.model, self._look)
        if difference is not None:
            message, trace, step = difference
            raise DifferenceError(message, trace, [step])

    def _look(self, encoding: Encoding) -> _Difference | None:
        system = GuardedSystem(self._executed.model, encoding)
        for command in self._commands:
            event = command.event
            conditions = [term.condition for term in command.guard.terms]
            known = [self._diagram(condition, encoding) for condition in conditions]
            data = encoding.diagrams.true
            if command.guard.data is not None:
                known.append(self._diagram(command.guard.data, encoding))
            parts = [diagram for diagram in known if diagram is not None]
            if len(parts) < len(known):
                self.is_sampled = True
                continue
            if command.guard.data is not None:
                data = parts.pop()
            enabled = encoding.diagrams.all_of(parts)
            differ = system.controlled & (enabled ^ system.allowed[event])
            if differ.satisfiable():
                return self._described(system, event, differ, enabled, ())
            inputs = [encoding.layout.domains[carried] for carried in event.inputs]
            differ = system.controlled & enabled & encoding.whole(event.inputs) & (data ^ system.happens(event))
            if differ.satisfiable():
                return self._described(system, event, differ, data, [domain.element for domain in inputs])
        return None

    @staticmethod
    def _described(
        system: GuardedSystem, event: sct.Event, differ: Diagram, theirs: Diagram, inputs: Iterable[Element]
    ) -> _Difference:
        """Return a difference in the nearest state; with inputs if it depends on them."""
        encoding = system.encoding
        domains = [encoding.layout.domains[carried] for carried in inputs]
        path = system.path_to(differ.exists(system.relations[event].inputs))
        here = differ & system.last(path)
        codes = pick(here, domains) if domains else {}
        data = {carried.name: value(carried, codes[carried]) for carried in event.inputs if carried in codes}
        what = "its data" if domains else "any data"
        sides = ("in the controller", "in the model")
        allowed, denied = sides if (here & theirs).satisfiable() else sides[::-1]
        message = f"{words(event)} is allowed with {what} {allowed}, and not {denied}"
        return message, system.trace(path), TraceStep(event_name(event), data)

    def _diagram(self, condition: ex.Expression, encoding: Encoding) -> Diagram | None:
        """Return a condition of the engine model as a diagram, from all values that it reads; None if too many."""
        parts = list(all_inside([condition]))
        cells = [cell for cell in self._executed.variables if any(_reads(part, cell) for part in parts)]
        carriers = [carrier for carrier in self._executed.inputs if any(_reads(part, carrier) for part in parts)]
        domains = [Domain(declared.type) for declared in (*cells, *carriers)]
        sizes = [domain.high - domain.low + 1 for domain in domains]
        if prod(sizes) > self._values:
            return None
        places = [self._executed.variables.index(cell) for cell in cells]
        input_places = [self._executed.inputs.index(carrier) for carrier in carriers]
        elements: Sequence[Element] = [
            *(self._cells[place] for place in places),
            *(self._inputs[place] for place in input_places),
        ]
        compute = self._compiler(condition)
        state = [Domain(cell.type).low for cell in self._executed.variables]
        inputs = [Domain(carrier.type).low for carrier in self._executed.inputs]
        result = encoding.diagrams.false
        for codes in product(*map(range, sizes)):
            values = [domain.low + code for domain, code in zip(domains, codes, strict=True)]
            for place, number in zip(places, values, strict=False):
                state[place] = number
            for place, number in zip(input_places, values[len(places) :], strict=True):
                inputs[place] = number
            if compute(state, inputs):
                result |= encoding.diagrams.all_of(map(encoding.has_code, elements, codes))
        return result


def _reads(part: ex.Expression, declared: engine.StateVariable | engine.Input) -> bool:
    if isinstance(part, engine.VariableReference):
        return part.variable is declared
    return isinstance(part, engine.InputReference) and part.input is declared
