"""Comparison of the timers in a robot's text with those of the engine model."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from math import prod
from random import Random
from typing import TYPE_CHECKING

from robosc.analysis.paths import TraceStep
from robosc.analysis.system import GuardedSystem
from robosc.analysis.verify.controller_reading.loop import event_names
from robosc.analysis.verify.model_reading.controller import GOES_ON, STARTS, STOPS
from robosc.analysis.verify.model_reading.lockstep import DifferenceError, line, where
from robosc.analysis.verify.model_reading.machine import Slot
from robosc.analysis.wording import words
from robosc.engine.expressions import Compiler, all_inside
from robosc.engine.state import Domain
from robosc.model import engine, sct
from robosc.model.semantics.durations import timer_text
from robosc.model.semantics.roles import event_name
from robosc.synthesis import use_encoding

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from robosc.analysis.verify.model_reading.controller import ControllerText, Effects
    from robosc.analysis.verify.model_reading.machine import Event, EventName, Machine, Plant, Value
    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Encoding

    State = Mapping[Slot, Value]
    Inputs = Mapping[str, Value]


@dataclass(frozen=True)
class Effort:
    """Limits of the comparison for each event and component.

    Up to `values` combinations of the values that timers depend on are compared. If there are more, `random` random
    ones are compared.
    """

    values: int = 100_000
    random: int = 20_000


@dataclass(frozen=True)
class _Restart:
    """Effect of an event on timers under a condition: those of `left` stop, then others start."""

    holds: Callable[[Sequence[int], Sequence[int]], int] | None
    left: Plant | None
    starts: tuple[EventName, ...]


@dataclass(frozen=True)
class _Case:
    """A state and data in which the effect of an event on a timer differs from the text."""

    timer: EventName
    ours: str
    theirs: str
    state: State
    inputs: Inputs


class TimeComparison:
    """Comparison of the starts and stops of timers in the text and in the engine model."""

    def __init__(
        self, controller: ControllerText, plants: Machine, executed: engine.EngineModel, effort: Effort
    ) -> None:
        self.is_sampled = False
        self._controller = controller
        self._plants = plants
        self._executed = executed
        self._effort = effort
        self._names = event_names(plants)
        self._random = Random(0)  # noqa: S311 - the same values on every run
        self._slots = {element: slot for slot, element in plants.sources.items()}
        self._timers = {self._names[timer.event.event]: timer for timer in executed.timers}
        self._compiler = Compiler(executed)
        self._cells = [self._slots.get(cell.variable or cell.plant) for cell in executed.variables]
        self._domains = [Domain(cell.type) for cell in executed.variables]
        self._carried = [(carried.input, Domain(carried.type)) for carried in executed.inputs]

    def run(self) -> None:
        """Compare the timers; raise DifferenceError if one has another length, or starts or stops at other events."""
        self._compare_timers()
        for event in self._executed.events:
            for component in self._controller.times:
                differing = list(self._differing(event, component))
                if differing:
                    self._report(event, differing)

    def _compare_timers(self) -> None:
        theirs = [self._names[timer.event.event] for timer in self._executed.timers]
        ours = [name for names in self._controller.times.values() for name in names]
        for name in dict.fromkeys([*ours, *theirs]):
            if ours.count(name) != theirs.count(name):
                where_not = "in the controller" if name in ours else "in the text"
                raise DifferenceError(f"{self._shown(name)} does not occur exactly once {where_not}")
        for first, other in zip(ours, theirs, strict=True):
            if first != other:
                order = f"{self._shown(first)} comes before {self._shown(other)}"
                raise DifferenceError(f"{order} in the text, and after it in the controller")
        for name in ours:
            self._compare_timer(name)

    def _compare_timer(self, name: EventName) -> None:
        timer, theirs = self._controller.timer(name), self._timers[name]
        shown, length, duration = self._shown(name), timer.length, theirs.duration
        if length.milliseconds != theirs.milliseconds:
            lengths = f"{length.milliseconds:,} ms by the text, and {theirs.milliseconds:,} ms in the controller"
            raise DifferenceError(f"{shown} lasts {lengths}")
        if length.parameter != ("" if duration is None else duration.parameter):
            raise DifferenceError(f"{shown} is set by another parameter in the controller")
        bounds = (length.unit, length.shortest, length.longest)
        if duration is not None and bounds != (duration.unit, duration.shortest, duration.longest):
            raise DifferenceError(f"{shown} can be set to other values in the controller")
        if timer.location != (None if theirs.location is None else theirs.location.name):
            raise DifferenceError(f"{shown} runs in another state in the controller")
        runs = self._controller.runs_from_start(name)
        if runs is not theirs.initial:
            verbs = ("runs", "does not run") if runs else ("does not run", "runs")
            raise DifferenceError(
                f"{shown} {verbs[0]} from the start by the text, and {verbs[1]} from the start in the controller"
            )

    def _shown(self, name: EventName) -> str:
        words_of_time = timer_text(self._plants.events[name].element.timer)
        place = line(self._controller.text.events[name].element)
        return f"the time `after {words_of_time}` of `{name.plant.origin}`{place}"

    def _restarts(self, event: engine.Event, component: Plant) -> list[_Restart]:
        """Return the restarts in the engine model that affect the timers of a component."""
        restarts = []
        for restart in event.restarts:
            names = (self._names[timer.event.event] for timer in restart.starts)
            starts = tuple(name for name in names if name.plant == component)
            left = None if restart.left is None else self._slots[restart.left].plant
            if starts or left == component:
                holds = None if restart.condition is None else self._compiler(restart.condition)
                restarts.append(_Restart(holds, left if left == component else None, starts))
        return restarts

    def _effects(
        self, name: EventName, component: Plant, restarts: Sequence[_Restart], state: State, inputs: Inputs
    ) -> Effects:
        cells = [
            domain.low if slot is None or slot not in state else domain.internal(state[slot])
            for slot, domain in zip(self._cells, self._domains, strict=True)
        ]
        own = self._plants.events[name].element.inputs
        carried = [
            domain.internal(inputs[carrier.name]) if carrier in own else domain.low for carrier, domain in self._carried
        ]
        effects: Effects = {name: STOPS} if name in self._controller.times[component] else {}
        for restart in restarts:
            if restart.holds is None or restart.holds(cells, carried):
                for other in self._controller.times[component] if restart.left is not None else ():
                    # A timer runs only in its own state; in other states, there is nothing to stop.
                    if self._is_here(other, state):
                        effects[other] = STOPS
                effects.update(dict.fromkeys(restart.starts, STARTS))
        return effects

    def _is_here(self, timer: EventName, state: State) -> bool:
        location = self._timers[timer].location
        return location is not None and state[Slot(timer.plant)] == location.name

    def _differing(self, event: engine.Event, component: Plant) -> Iterator[_Case]:
        """Yield states and data in which the event's effects on timers of the component differ."""
        name = self._names[event.event]
        restarts = self._restarts(event, component)
        if not restarts and not self._controller.concerns(name, component):
            return
        conditions = [restart.condition for restart in event.restarts if restart.condition is not None]
        variables = [part.variable for part in all_inside(conditions) if isinstance(part, engine.VariableReference)]
        slots = self._controller.reads(name, component).union(
            self._slots[cell.variable or cell.plant] for cell in variables
        )
        for state, inputs in self._cases(sorted(slots), self._plants.events[name]):
            ours = self._controller.effects(name, component, state, inputs)
            if ours is None:
                continue
            theirs = self._effects(name, component, restarts, state, inputs)
            for other in self._controller.times[component]:
                if ours.get(other) != theirs.get(other):
                    yield _Case(other, ours.get(other, GOES_ON), theirs.get(other, GOES_ON), state, inputs)
                    break

    def _cases(self, slots: Sequence[Slot], event: Event) -> Iterator[tuple[State, Inputs]]:
        """Yield all relevant states and data, or random ones if there are too many."""
        domains = [self._controller.text.domains[slot] for slot in slots]
        carried = list(event.inputs.values())
        names = list(event.inputs)
        everything = [*domains, *carried]
        split = len(slots)
        values: Iterable[tuple[Value, ...]]
        if prod(map(len, everything)) <= self._effort.values:
            values = product(*everything)
        else:
            self.is_sampled = True
            values = (
                tuple(domain[self._random.randrange(len(domain))] for domain in everything)
                for _ in range(self._effort.random)
            )
        for chosen in values:
            state = dict(zip(slots, chosen[:split], strict=True))
            yield state, dict(zip(names, chosen[split:], strict=True))

    def _report(self, event: engine.Event, differing: Sequence[_Case]) -> None:
        """Raise DifferenceError for the case that the supervised robot reaches first, if it reaches any."""

        def look(encoding: Encoding) -> tuple[_Case, tuple[TraceStep, ...]] | None:
            system = GuardedSystem(self._executed.model, encoding)
            states = [
                system.controlled & self._possible(event.event, case, system) & self._states(case.state, encoding)
                for case in differing
            ]
            together = encoding.diagrams.any_of(states)
            if not together.satisfiable():
                return None
            path = system.path_to(together)
            last = system.last(path)
            first = next(case for case, here in zip(differing, states, strict=True) if (here & last).satisfiable())
            return first, system.trace(path)

        shown = use_encoding(self._executed.model, look)
        if shown is None:
            return
        case, trace = shown
        ours = f"with {words(event.event)}, {self._shown(case.timer)} {case.ours} by the text"
        raise DifferenceError(
            f"{ours}, and {case.theirs} in the controller{where(case.state)}",
            trace,
            [TraceStep(event_name(event.event), dict(case.inputs))],
        )

    def _possible(self, event: sct.Event, case: _Case, system: GuardedSystem) -> Diagram:
        """Return the states in which an event can happen: a command with the inputs of the case."""
        relation = system.relations[event]
        if not relation.has_data:
            return system.allowed[event]
        domains = self._plants.events[self._names[event]].inputs
        inputs = [
            system.encoding.has_code(carried, list(domains[carried.name]).index(case.inputs[carried.name]))
            for carried in event.inputs
        ]
        return relation.allowed_by(system.guard(event) & system.diagrams.all_of(inputs))

    def _states(self, values: State, encoding: Encoding) -> Diagram:
        """Return all states in which the slots hold these values."""
        states = encoding.diagrams.true
        for slot, value in values.items():
            element = self._plants.sources[slot]
            if isinstance(element, sct.Plant):
                location = next(place for place in element.locations if place.name == value)
                states &= encoding.location(location)
            else:
                assert isinstance(element, sct.DiscreteVariable)
                states &= encoding.has_code(element, list(self._plants.domains[slot]).index(value))
        return states
