"""Pass: collects the events in the order of the control loop, with their sources, groups and descriptions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.model import engine, sct
from robosc.model.semantics.durations import timer_text
from robosc.model.semantics.edges import edges_by_event, origin
from robosc.model.semantics.printing import RobotPrinter, remark
from robosc.model.semantics.roles import Roles, event_name, plant_of, provide_numbers

if TYPE_CHECKING:
    from collections.abc import Mapping

#: Edges of one event in one plant by their source location. The key None has the edges of all locations.
Edges = dict[sct.Location | None, list[sct.Edge]]
#: Edges of each event in each plant that takes part in it, in the order of the plants.
EdgeTable = dict[sct.Event, dict[sct.Plant, Edges]]

#: Sentence for an event by the kinds of the event and its plant, else by the kind of the event.
_OF_KIND = {
    (sct.EventKind.trigger, sct.PlantKind.message): "{what} is sent{on}.",
    (sct.EventKind.trigger, sct.PlantKind.service): "{what} is called{on}.",
    (sct.EventKind.trigger, sct.PlantKind.action): "{what} is started{on}.",
    (sct.EventKind.response, sct.PlantKind.message): "{what} arrived{on}.",
    (sct.EventKind.request, sct.PlantKind.serviceServer): "A client calls {what}{on}.",
    (sct.EventKind.request, sct.PlantKind.actionServer): "The controller accepts a goal of {what}{on}.",
    (sct.EventKind.reply, sct.PlantKind.serviceServer): "The controller answers a call of {what}{on}.",
    (sct.EventKind.reply, sct.PlantKind.actionServer): "The goal of {what} succeeds{on}.",
}
_SENTENCES = {
    sct.EventKind.trigger: "{what}: {name}.",
    sct.EventKind.cancel: "{what} is asked to cancel{on}.",
    sct.EventKind.canceled: "{what} is canceled{on}.",
    sct.EventKind.response: "{what} is done{on}.",
    sct.EventKind.error: "{what} failed{on}.",
    sct.EventKind.feedback: "{what} is under way{on}.",
    sct.EventKind.reset: "{what} is ready to be used again.",
    sct.EventKind.tau: "{what} changes by itself{steps}.",
    sct.EventKind.data: "{what} is to be sent {data}.",
    sct.EventKind.timeout: "{what} has waited {time}{steps}.",
    sct.EventKind.plain: "{name} happens{steps}.",
    sct.EventKind.input: "{name} gets a value.",
    sct.EventKind.cancelRequest: "A client asks to cancel {what}{on}.",
    sct.EventKind.replyFeedback: "The controller sends feedback on {what}{on}.",
    sct.EventKind.replyError: "The goal of {what} is aborted{on}.",
    sct.EventKind.replyCanceled: "The goal of {what} is canceled{on}.",
}


def collect_edges(model: sct.SupervisoryControlModel) -> EdgeTable:
    """Return the edges of each event."""
    table: EdgeTable = {event: {} for plant in model.plants for event in plant.events}
    for event, by_plant in edges_by_event(model.plants).items():
        for plant, edges in by_plant.items():
            by_origin: Edges = {}
            for edge in edges:
                by_origin.setdefault(origin(edge), []).append(edge)
            table[event][plant] = by_origin
    return table


def collect_events(
    model: sct.SupervisoryControlModel, edges: EdgeTable, inputs: Mapping[sct.Input, engine.Input]
) -> dict[sct.Event, engine.Event]:
    """Return the events by role: cancels, triggers, silent events, data, events from the robot, and timeouts."""
    roles = Roles(model)
    remarks = _remarks(model)
    numbers = {event: number for events in roles.data for event, number in provide_numbers(plant_of(events[0])).items()}
    by_role = [
        (engine.Role.cancel, roles.cancels),
        (engine.Role.trigger, roles.triggers),
        (engine.Role.silent, roles.silent),
        (engine.Role.data, [event for events in roles.data for event in events]),
        (engine.Role.incoming, roles.incoming),
        (engine.Role.timeout, roles.timeouts),
    ]
    return {
        event: engine.Event(
            name=event_name(event),
            event=event,
            role=role,
            description=_description(event, edges[event].get(plant_of(event), {}), numbers.get(event)),
            remarks=remarks.get(event, ()),
            inputs=[inputs[carried] for carried in event.inputs],
        )
        for role, events in by_role
        for event in events
    }


def collect_sources(
    model: sct.SupervisoryControlModel, events: Mapping[sct.Event, engine.Event]
) -> list[engine.Source]:
    """Return the sources of reactions: topics, services, actions, components' timers. Sets `source` of the events."""
    roles, sources = Roles(model), []
    batches = {together[0] for together in roles.batches}
    for together in roles.sources:
        plant = plant_of(together[0])
        topic = plant.topic if plant.kind == sct.PlantKind.message else None
        sources.append(engine.Source(name=topic or plant.name, batch=together[0] in batches))
        for event in together:
            events[event].source = sources[-1]
    return sources


def collect_groups(model: sct.SupervisoryControlModel, events: Mapping[sct.Event, engine.Event]) -> list[engine.Group]:
    """Return groups of triggers that exclude each other in a round or run once in a tick.

    Sets `group` of the events.
    """
    roles, groups = Roles(model), []
    for together in roles.shared_topics:
        groups.append(engine.Group(name=plant_of(together[0]).topic, span=engine.Span.round))
        for event in together:
            events[event].group = groups[-1]
    for event in roles.once_per_tick:
        groups.append(engine.Group(name=event_name(event), span=engine.Span.tick))
        events[event].group = groups[-1]
    return groups


def _remarks(model: sct.SupervisoryControlModel) -> dict[sct.Event, list[str]]:
    """Return the texts of the requirements on each event, each with its file, and the explanations of synthesis."""
    remarks: dict[sct.Event, list[str]] = {}
    for requirement in model.requirements:
        if requirement.text:
            remarks.setdefault(requirement.event, []).append(remark(requirement))
    for guard in model.supervisor.guards if model.supervisor else ():
        if guard.explanation:
            remarks.setdefault(guard.event, []).append(f"synthesis prevents this: {guard.explanation}")
    return remarks


def _description(event: sct.Event, edges: Edges, number: int | None) -> str:
    """Describe the meaning of an event for the robot. `number` is that of the `provide` that it selects."""
    plant = plant_of(event)
    sentence = _OF_KIND.get((event.kind, plant.kind)) or _SENTENCES[event.kind]
    steps = dict.fromkeys(
        f"{location.name} to {edge.target.name}"
        for origin, leaving in edges.items()
        for edge in leaving
        for location in (plant.locations if origin is None else [origin])
    )
    guard = next((edge.guard for leaving in edges.values() for edge in leaving), None)
    data = f"with the data of `provide` {number}" + (f", if {RobotPrinter()(guard)}" if guard else "")
    return sentence.format(
        what=plant.origin or plant.name,
        name=event.name,
        on=f" ({plant.topic})" if plant.topic else "",
        steps=f": {', '.join(steps)}" if steps else "",
        data=data if number else "without data",
        time=timer_text(event.timer) if event.timer else "",
    )
