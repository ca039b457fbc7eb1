"""What the control loop does with each event of an sct model: one answer for the interpreter and the generated code."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import prod
from typing import TYPE_CHECKING

from robosc.metamodel import expression as ex
from robosc.metamodel import sct
from robosc.semantics.domains import domain
from robosc.semantics.edges import edges_of

if TYPE_CHECKING:
    from collections.abc import Iterable

#: The kinds of events that run by themselves.
SILENT = (sct.EventKind.tau, sct.EventKind.reset)


def plant_of(event: sct.Event) -> sct.Plant:
    """The plant that declares an event."""
    plant = event.eContainer()
    assert isinstance(plant, sct.Plant)
    return plant


def is_from_cif(model: sct.SupervisoryControlModel) -> bool:
    """Whether a model was read from CIF.

    Its events stand for no communication, it may start in several states, or where it has no event at all, its text is
    called so.
    """
    if model.initialPredicates or (model.source and model.source.file and model.source.file.name.endswith(".cif")):
        return True
    return any(
        any(event.kind in (sct.EventKind.plain, sct.EventKind.input) for event in plant.events)
        or any(variable.initial is None for variable in plant.variables)
        for plant in model.plants
    )


def input_values(model: sct.SupervisoryControlModel) -> int:
    """How many values the inputs of a robot have together: to CIF these are part of a state, at any time.

    1 for a model that was read from CIF: its inputs are variables. An input of CIF can be each literal of its
    enumeration.
    """
    if is_from_cif(model):
        return 1
    kinds = [parameter.type for plant in model.plants for parameter in plant.inputs]
    return prod(
        len(kind.enumeration.literals) if isinstance(kind, ex.EnumerationType) else domain(kind).size for kind in kinds
    )


def event_name(event: sct.Event) -> str:
    """The event with its plant, such as `message_move.c_trigger`, or its absolute name in CIF; no two share it."""
    plant = plant_of(event)
    if event.kind in (sct.EventKind.plain, sct.EventKind.input):
        return f"{plant.origin}.{event.name}" if plant.origin else event.name
    return f"{plant.name}.{event.name}"


def provide_number(event: sct.Event) -> int:
    """Which `provide` for its communication a data event chooses, from 1 in the order of the text; 0 for none."""
    return provide_numbers(plant_of(event))[event]


def provide_numbers(plant: sct.Plant) -> dict[sct.Event, int]:
    """The same for all events of a data plant."""
    nothing = {edge.event for edge in edges_of(plant) if edge.target.initial}
    return {event: 0 if event in nothing else number for number, event in enumerate(plant.events, start=1)}


@dataclass(frozen=True)
class Roles:
    """The events of a model by role. Each tuple is in event-table order: plants as the model has them, then events."""

    model: sct.SupervisoryControlModel

    @cached_property
    def events(self) -> tuple[sct.Event, ...]:
        """All events."""
        return tuple(event for plant in self.model.plants for event in plant.events)

    @cached_property
    def cancels(self) -> tuple[sct.Event, ...]:
        """What the loop asks first in a round."""
        return self._of(sct.EventKind.cancel)

    @cached_property
    def triggers(self) -> tuple[sct.Event, ...]:
        """What the loop asks then."""
        return self._of(sct.EventKind.trigger)

    @cached_property
    def silent(self) -> tuple[sct.Event, ...]:
        """What the loop runs by itself until none is enabled."""
        return self._of(*SILENT)

    @cached_property
    def data(self) -> tuple[tuple[sct.Event, ...], ...]:
        """The events that choose what data goes out, plant by plant, most wanted first."""
        chosen = ([event for event in plant.events if event.kind == sct.EventKind.data] for plant in self.model.plants)
        return tuple(tuple(events) for events in chosen if events)

    @cached_property
    def incoming(self) -> tuple[sct.Event, ...]:
        """What comes from the robot, and all events of a model from CIF: the caller performs it."""
        return self._of(
            sct.EventKind.response,
            sct.EventKind.error,
            sct.EventKind.feedback,
            sct.EventKind.canceled,
            sct.EventKind.plain,
            sct.EventKind.input,
        )

    @cached_property
    def timeouts(self) -> tuple[sct.Event, ...]:
        """What happens when a time is up."""
        return self._of(sct.EventKind.timeout)

    @cached_property
    def sources(self) -> tuple[tuple[sct.Event, ...], ...]:
        """What drives reactions: messages on one topic, what one service says, or one action; times of a component."""
        return _by_source([*self.incoming, *self.timeouts])

    @cached_property
    def batches(self) -> tuple[tuple[sct.Event, ...], ...]:
        """The events of each message from the robot, two or more: they happen with nothing in between."""
        kind = sct.PlantKind.message
        return tuple(events for events in self.sources if len(events) > 1 and plant_of(events[0]).kind == kind)

    @cached_property
    def shared_topics(self) -> tuple[tuple[sct.Event, ...], ...]:
        """Triggers of messages that go to one topic, two or more: at most one of them runs in a round."""
        return tuple(events for events in _by_source(self.triggers) if len(events) > 1)

    @cached_property
    def once_per_tick(self) -> tuple[sct.Event, ...]:
        """Triggers of services and actions: each runs at most once from the start of one tick to that of the next."""
        return tuple(
            event for event in self.triggers if plant_of(event).kind in (sct.PlantKind.service, sct.PlantKind.action)
        )

    @cached_property
    def data_plants(self) -> dict[sct.Event, sct.Plant]:
        """The plant that chooses a trigger's data, for each trigger that has one: both have the same origin."""
        plants = {
            plant.origin: plant for plant in self.model.plants if plant.kind == sct.PlantKind.data and plant.origin
        }
        origins = {event: plant_of(event).origin for event in self.triggers}
        return {event: plants[origin] for event, origin in origins.items() if origin in plants}

    @cached_property
    def settling_bound(self) -> int:
        """How many silent events may run in a row: what verification proved, else 2 for each of them and 16."""
        proved = None if self.model.supervisor is None else self.model.supervisor.settlingBound
        return 2 * len(self.silent) + 16 if proved is None else min(proved, 0xFFFFFFFF)

    def _of(self, *kinds: sct.EventKind) -> tuple[sct.Event, ...]:
        return tuple(event for event in self.events if event.kind in kinds)


def _by_source(events: Iterable[sct.Event]) -> tuple[tuple[sct.Event, ...], ...]:
    """Events of messages by their topic, with or without a slash before it; others by their plant."""
    found: dict[str | sct.Plant, list[sct.Event]] = {}
    for event in events:
        plant = plant_of(event)
        named = plant.kind == sct.PlantKind.message and plant.topic
        found.setdefault(plant.topic.removeprefix("/") if named and plant.topic else plant, []).append(event)
    return tuple(map(tuple, found.values()))
