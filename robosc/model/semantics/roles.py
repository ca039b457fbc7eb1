"""Roles of an sct model's events in the control loop, shared by the interpreter and the generated code."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import prod
from typing import TYPE_CHECKING

from robosc.base.files.suffixes import AUTOMATA
from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.communication import ANSWERS, REQUESTS
from robosc.model.semantics.domains import domain
from robosc.model.semantics.edges import edges_of

if TYPE_CHECKING:
    from collections.abc import Iterable

#: Kinds of events that the loop runs by itself.
SILENT = (sct.EventKind.tau, sct.EventKind.reset)


def is_goal(event: sct.Event) -> bool:
    """Return whether an event is the acceptance of a goal for the controller."""
    return event.kind == sct.EventKind.request and plant_of(event).kind == sct.PlantKind.actionServer


def plant_of(event: sct.Event) -> sct.Plant:
    """Return the plant that declares an event."""
    plant = event.eContainer()
    assert isinstance(plant, sct.Plant)
    return plant


def is_from_cif(model: sct.SupervisoryControlModel) -> bool:
    """Return whether a model was read from CIF, or from automata by way of CIF.

    Its events stand for no communication, or it may start in several states. A model without events is recognized by
    the name of its file.
    """
    if model.initialPredicates or is_written_as(model, ".cif", *AUTOMATA):
        return True
    return any(
        any(event.kind in (sct.EventKind.plain, sct.EventKind.input) for event in plant.events)
        or any(variable.initial is None for variable in plant.variables)
        for plant in model.plants
    )


def is_written_as(model: sct.SupervisoryControlModel, *suffixes: str) -> bool:
    """Return whether the name of a model's file ends with one of the suffixes."""
    return bool(model.source and model.source.file and model.source.file.name.endswith(suffixes))


def input_values(model: sct.SupervisoryControlModel) -> int:
    """Return the number of joint values of a robot's inputs. In CIF, inputs are part of every state.

    Returns 1 for a model that was read from CIF, because its inputs are variables. An input in CIF can have every
    literal of its enumeration.
    """
    if is_from_cif(model):
        return 1
    kinds = [parameter.type for plant in model.plants for parameter in plant.inputs]
    return prod(
        len(kind.enumeration.literals) if isinstance(kind, ex.EnumerationType) else domain(kind).size for kind in kinds
    )


def event_name(event: sct.Event) -> str:
    """Return the unique name of an event: with its plant, such as `message_move.c_trigger`, or its CIF name."""
    plant = plant_of(event)
    if event.kind in (sct.EventKind.plain, sct.EventKind.input):
        return f"{plant.origin}.{event.name}" if plant.origin else event.name
    return f"{plant.name}.{event.name}"


def component_name(event: sct.Event) -> str:
    """Return the component of a communication's event."""
    return (plant_of(event).origin or "").rpartition(".")[0]


def data_origin(event: sct.Event) -> str | None:
    """Return the origin of the data plant of an event that the controller sends."""
    origin = plant_of(event).origin
    return f"{origin}.feedback" if origin and event.kind == sct.EventKind.replyFeedback else origin


def assumptions(model: sct.SupervisoryControlModel) -> list[sct.Plant]:
    """Return the assumptions of a model."""
    return [plant for plant in model.plants if plant.kind == sct.PlantKind.assumption]


def assumption_name(assumption: sct.Plant) -> str:
    """Return the name of an assumption; its text if it has none."""
    return assumption.origin or assumption_text(assumption)


def assumption_text(assumption: sct.Plant) -> str:
    """Return the text of an assumption; the name of its plant if it has none."""
    return assumption.text or assumption.name


def provide_number(event: sct.Event) -> int:
    """Return the number of the `provide` statement that a data event selects, from 1 in text order. 0 for none."""
    return provide_numbers(plant_of(event))[event]


def provide_numbers(plant: sct.Plant) -> dict[sct.Event, int]:
    """Return the numbers of the `provide` statements for all events of a data plant; see `provide_number`."""
    nothing = {edge.event for edge in edges_of(plant) if edge.target.initial}
    return {event: 0 if event in nothing else number for number, event in enumerate(plant.events, start=1)}


@dataclass(frozen=True)
class Roles:
    """Events of a model by role. Each tuple is in event-table order: by plant of the model, then by event."""

    model: sct.SupervisoryControlModel

    @cached_property
    def events(self) -> tuple[sct.Event, ...]:
        """All events."""
        return tuple(event for plant in self.model.plants for event in plant.events)

    @cached_property
    def cancels(self) -> tuple[sct.Event, ...]:
        """Cancel events. The loop tries them first in a round."""
        return self._of(sct.EventKind.cancel)

    @cached_property
    def triggers(self) -> tuple[sct.Event, ...]:
        """Triggers, and answers to clients. The loop tries them after the cancels."""
        return self._of(sct.EventKind.trigger, *ANSWERS)

    @cached_property
    def silent(self) -> tuple[sct.Event, ...]:
        """Silent events. The loop runs them by itself until none is enabled."""
        return self._of(*SILENT)

    @cached_property
    def data(self) -> tuple[tuple[sct.Event, ...], ...]:
        """Events that select outgoing data, by plant, in order of priority."""
        chosen = ([event for event in plant.events if event.kind == sct.EventKind.data] for plant in self.model.plants)
        return tuple(tuple(events) for events in chosen if events)

    @cached_property
    def incoming(self) -> tuple[sct.Event, ...]:
        """Events from the robot. In a model from CIF, all events: the caller performs them."""
        return self._of(
            sct.EventKind.response,
            sct.EventKind.error,
            sct.EventKind.feedback,
            sct.EventKind.canceled,
            sct.EventKind.plain,
            sct.EventKind.input,
            *REQUESTS,
        )

    @cached_property
    def timeouts(self) -> tuple[sct.Event, ...]:
        """Events of expired timers."""
        return self._of(sct.EventKind.timeout)

    @cached_property
    def sources(self) -> tuple[tuple[sct.Event, ...], ...]:
        """Groups of events that cause reactions: of a topic, a service, an action, or a component's timers."""
        return _by_source([*self.incoming, *self.timeouts])

    @cached_property
    def batches(self) -> tuple[tuple[sct.Event, ...], ...]:
        """Groups of two or more events of one message from the robot.

        No other event happens between the events of a group.
        """
        kind = sct.PlantKind.message
        return tuple(events for events in self.sources if len(events) > 1 and plant_of(events[0]).kind == kind)

    @cached_property
    def shared_topics(self) -> tuple[tuple[sct.Event, ...], ...]:
        """Groups of two or more triggers for one topic. At most one trigger of a group runs in a round."""
        messages = (event for event in self.triggers if plant_of(event).kind == sct.PlantKind.message)
        return tuple(events for events in _by_source(messages) if len(events) > 1)

    @cached_property
    def once_per_tick(self) -> tuple[sct.Event, ...]:
        """Triggers of services and actions. Each runs at most once between the starts of two ticks."""
        return tuple(
            event for event in self.triggers if plant_of(event).kind in (sct.PlantKind.service, sct.PlantKind.action)
        )

    @cached_property
    def data_plants(self) -> dict[sct.Event, sct.Plant]:
        """Plant that selects a trigger's data, for each trigger with such a plant. Both have the same origin.

        The origin of the plant for the feedback of an action that the controller serves ends with `.feedback`.
        """
        plants = {
            plant.origin: plant for plant in self.model.plants if plant.kind == sct.PlantKind.data and plant.origin
        }
        origins = {event: data_origin(event) for event in self.triggers}
        return {event: plants[origin] for event, origin in origins.items() if origin in plants}

    @cached_property
    def settling_bound(self) -> int:
        """Maximum number of silent events in a row. Default without verification: 16, plus 2 for each silent event."""
        proved = None if self.model.supervisor is None else self.model.supervisor.settlingBound
        return 2 * len(self.silent) + 16 if proved is None else min(proved, 0xFFFFFFFF)

    def _of(self, *kinds: sct.EventKind) -> tuple[sct.Event, ...]:
        return tuple(event for event in self.events if event.kind in kinds)


def _by_source(events: Iterable[sct.Event]) -> tuple[tuple[sct.Event, ...], ...]:
    """Group events of messages by topic, with or without a leading slash, and other events by plant."""
    groups: dict[str | sct.Plant, list[sct.Event]] = {}
    for event in events:
        plant = plant_of(event)
        named = plant.kind == sct.PlantKind.message and plant.topic
        groups.setdefault(plant.topic.removeprefix("/") if named and plant.topic else plant, []).append(event)
    return tuple(map(tuple, groups.values()))
