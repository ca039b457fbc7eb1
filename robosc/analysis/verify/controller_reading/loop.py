"""Comparison of the control loop with the text: roles, order, sources, groups, data, the bound."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.analysis.verify.model_reading.controller import CANCEL, SILENT, TIMEOUT, TRIGGER
from robosc.analysis.verify.model_reading.lockstep import DifferenceError
from robosc.analysis.wording import words
from robosc.engine.expressions import Compiler
from robosc.model import engine

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from robosc.analysis.verify.model_reading.controller import ControllerText
    from robosc.analysis.verify.model_reading.machine import EventName, Machine, Plant

#: Roles whose events are tried one after the other.
_ORDERED = (CANCEL, TRIGGER, SILENT, TIMEOUT)


def event_names(plants: Machine) -> dict[Any, EventName]:
    """Return the name in the text of each event of the model."""
    return {event.element: name for name, event in plants.events.items()}


class LoopComparison:
    """Comparison of the engine model's control loop with that of the text."""

    def __init__(self, controller: ControllerText, plants: Machine, executed: engine.EngineModel) -> None:
        self._controller = controller
        self._plants = plants
        self._executed = executed
        self._names = event_names(plants)

    def run(self) -> None:
        """Compare the loops; raise DifferenceError for the first difference."""
        self._compare_roles()
        self._compare_sources()
        self._compare_groups()
        self._compare_choices()
        self._compare_bound()

    def _shown(self, name: EventName) -> str:
        return words(self._plants.events[name].element)

    def _listed(self, names: Iterable[EventName]) -> str:
        return ", ".join(map(self._shown, names))

    def _compare_roles(self) -> None:
        executed = [(self._names[event.event], event.role.name) for event in self._executed.events]
        for name, role in executed:
            ours = self._controller.role(name)
            if role != ours:
                raise DifferenceError(f"{self._shown(name)} is {ours} by the text, and {role} in the controller")
        for name in self._controller.text.events:
            if sum(name == other for other, _ in executed) != 1:
                raise DifferenceError(f"{self._shown(name)} does not occur exactly once in the controller")
        for tried in _ORDERED:
            theirs = [name for name, role in executed if role == tried]
            for first, other in zip(self._controller.events(tried), theirs, strict=True):
                if first != other:
                    order = f"{self._shown(first)} comes before {self._shown(other)}"
                    raise DifferenceError(f"{order} in the text, and after it in the controller")

    def _compare_sources(self) -> None:
        theirs: dict[engine.Source | None, list[EventName]] = {}
        for event in self._executed.events:
            theirs.setdefault(event.source, []).append(self._names[event.event])
        theirs.pop(None, None)
        self._compare_partitions(self._controller.sources, list(theirs.values()), "come as one")
        for source, names in theirs.items():
            assert source is not None
            if source.batch != self._controller.is_batch(names):
                raise DifferenceError(
                    f"{self._listed(names)} are {'a' if source.batch else 'no'} batch in the controller"
                )

    def _compare_groups(self) -> None:
        rounds, ticks = self._controller.rounds, self._controller.ticks
        for span, ours, verb in (
            (engine.Span.round, rounds, "exclude each other in a round"),
            (engine.Span.tick, ticks, "happens once in a tick"),
        ):
            theirs: dict[engine.Group, list[EventName]] = {}
            for event in self._executed.events:
                if event.group is not None and event.group.span == span:
                    theirs.setdefault(event.group, []).append(self._names[event.event])
            self._compare_partitions(ours, list(theirs.values()), verb)

    def _compare_partitions(
        self, ours: Sequence[Sequence[EventName]], theirs: Sequence[Sequence[EventName]], verb: str
    ) -> None:
        """Compare the grouping of events, and the order of the events of one message."""
        for names in ours:
            ordered = names[0].plant.kind == "message"
            if not any(list(names) == list(other) or (not ordered and {*names} == {*other}) for other in theirs):
                raise DifferenceError(f"{self._listed(names)} {verb} by the text, and not in the controller")
        for names in theirs:
            if {*names} not in [{*other} for other in ours]:
                raise DifferenceError(f"{self._listed(names)} {verb} in the controller, and not by the text")

    def _compare_choices(self) -> None:
        choices = {
            self._names[choice.alternatives[0].event.event].plant: choice
            for choice in self._executed.choices
            if choice.alternatives
        }
        for plant, names in self._controller.alternatives.items():
            choice = choices.get(plant)
            theirs = [self._names[other.event.event] for other in choice.alternatives] if choice else []
            if theirs != names:
                raise DifferenceError(
                    f"data for `{plant.origin}` is chosen in another order in the controller: {self._listed(theirs)}"
                )
        for event in self._executed.events:
            name = self._names[event.event]
            chosen_plant: Plant | None = self._controller.choice(name)
            if event.choice is not (None if chosen_plant is None else choices[chosen_plant]):
                raise DifferenceError(f"{self._shown(name)} sends other data in the controller")
        for choice in self._executed.choices:
            self._compare_chosen(choice)

    def _compare_chosen(self, choice: engine.Choice) -> None:
        """Check that data counts as chosen in its own location only."""
        compute = Compiler(self._executed)
        cells = [0] * len(self._executed.variables)
        place = next((place for place, cell in enumerate(self._executed.variables) if cell is choice.variable), None)
        for alternative in choice.alternatives:
            name = self._names[alternative.event.event]
            chosen = None if alternative.chosen is None else compute(alternative.chosen)
            for number, location in enumerate(choice.plant.locations):
                if place is not None:
                    cells[place] = number
                holds = chosen is not None and bool(chosen(cells, ()))
                if holds is not (location.name == name.name.removeprefix("c_")):
                    verb = "is taken for chosen" if holds else "is not taken for chosen"
                    raise DifferenceError(f"{self._shown(name)} {verb} in the controller where it is `{location.name}`")

    def _compare_bound(self) -> None:
        supervisor = self._executed.model.supervisor
        ours = self._controller.bound(None if supervisor is None else supervisor.settlingBound)
        theirs = self._executed.settlingBound
        if theirs != ours:
            bounds = f"after {theirs:,} silent events in a row in the controller, and not after {ours:,}"
            raise DifferenceError(f"a livelock is reported {bounds}")
