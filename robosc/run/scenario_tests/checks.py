"""Checks of scenarios against the model, before the first one is played."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

from robosc.analysis.explain import NamingError, find_event
from robosc.analysis.wording import join_with_and, name, words
from robosc.base.ros_types.unknown_fields import unknown_field
from robosc.engine import Engine
from robosc.model import sct
from robosc.model.semantics.communication import ANSWERS, REQUESTS
from robosc.model.semantics.failures import brings_data, possible_reasons
from robosc.model.semantics.messages import sent_messages
from robosc.model.semantics.roles import assumptions, event_name, is_goal, plant_of
from robosc.run.scenario_tests.reading import (
    Acceptance,
    Every,
    IncomingEvent,
    Permission,
    Refusal,
    SentCommand,
    Stop,
    Violation,
)
from robosc.run.simulation.data import DataError, EventData

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from robosc.base.diagnostics import Diagnostic
    from robosc.base.ros_types import RosTypes, Section
    from robosc.model import rosgraph
    from robosc.run.scenario_tests.reading import Line, Scenario

#: Kinds of events that end a call or a goal, except the responses of messages.
_ENDS = (sct.EventKind.response, sct.EventKind.error, sct.EventKind.canceled)
#: Kinds of events that happen once for a call or a goal.
_ONCE = (*_ENDS, sct.EventKind.cancelRequest)
#: Kinds of events that a step may name.
_FROM_THE_ROBOT = (*_ENDS, sct.EventKind.feedback, *REQUESTS)


def unknown_events(model: sct.SupervisoryControlModel, scenarios: Iterable[Scenario]) -> Iterable[Diagnostic]:
    """Return a finding for each line that names an event which the model does not have.

    Also for each line with an event that the robot does not send, or that cannot be repeated or stopped.
    """
    # Scenarios share the lines of `before each`.
    return dict.fromkeys(finding for scenario in scenarios for finding in _about_events(model, scenario))


def unfit_data(graph: rosgraph.RosGraph, types: RosTypes, scenarios: Iterable[Scenario]) -> Iterable[Diagnostic]:
    """Return a finding for each line whose data does not fit its event. Precondition: all events are known."""
    checked = EventData(Engine(graph.model), graph, types)
    sent = _sent_types(graph)
    findings: dict[Diagnostic, None] = {}
    for line in (line for scenario in scenarios for line in scenario.lines):
        if isinstance(line, IncomingEvent) and line.data is not None:
            findings |= dict.fromkeys(_about_data(graph, checked, line))
        elif isinstance(line, SentCommand) and line.data is not None:
            event = find_event(graph.model, line.event)
            if event not in sent:
                findings[line.fault(f"the {words(event)} has no data", "leave out `with …`")] = None
            elif (fault := unknown_field(types.distributions, *sent[event], line.data)) is not None:
                findings[line.fault(fault[0], f"did you mean `{fault[1]}`?" if fault[1] else None)] = None
    return findings


def _sent_types(graph: rosgraph.RosGraph) -> Mapping[sct.Event, tuple[str, str, Section]]:
    """Return package, type and section of the data of each command."""
    return {
        sending.event: (interface.package, interface.type, section)
        for interface, section, sending in sent_messages(graph)
    }


def _about_data(graph: rosgraph.RosGraph, checked: EventData, line: IncomingEvent) -> Iterator[Diagnostic]:
    data = {"value": line.data} if line.reason is None else {"value": line.data, "reason": line.reason}
    try:
        checked.check(event_name(find_event(graph.model, line.event)), data, is_message=line.is_message)
    except DataError as error:
        yield line.fault(str(error), error.hint)


def _about_events(model: sct.SupervisoryControlModel, scenario: Scenario) -> Iterator[Diagnostic]:
    repeated: set[sct.Event] = set()
    known = [plant.origin for plant in assumptions(model) if plant.origin]
    for line in scenario.lines:
        if isinstance(line, Violation) and line.assumption not in known:
            hint = f"expected {join_with_and(known)}" if known else "give the assumption a name"
            yield line.fault(f"the robot has no assumption `{line.assumption}`", hint)
        named = line.step if isinstance(line, Every) else line
        if not isinstance(named, (IncomingEvent, Refusal, Permission, SentCommand, Acceptance, Stop)):
            continue
        try:
            event = find_event(model, named.event)
        except NamingError as error:
            if named is line:
                yield _without_cancel(model, named) or line.fault(error.message, error.hint or None)
            continue
        yield from _about_event(line, event, is_repeated=event in repeated)
        if isinstance(line, Every):
            repeated.add(event)
        elif isinstance(line, Stop):
            repeated.discard(event)


def _without_cancel(model: sct.SupervisoryControlModel, line: Line) -> Diagnostic | None:
    """Return a finding if a line cancels a goal that no client can cancel, else None."""
    action, _, kind = line.event.rpartition(".") if isinstance(line, IncomingEvent) else ("", "", "")
    with suppress(NamingError):
        if kind == "cancel" and is_goal(find_event(model, f"{action}.request")):
            hint = f"write a transition `on cancel from {action}` in the model"
            return line.fault(f"the controller rejects each request to cancel a goal of `{action}`", hint)
    return None


def _about_event(line: Line, event: sct.Event, *, is_repeated: bool) -> Iterator[Diagnostic]:
    if isinstance(line, IncomingEvent):
        yield from _impossible(line, event)
    elif isinstance(line, SentCommand) and not event.controllable:
        hint = f"write `response to {name(plant_of(event))} sent`" if event.kind == sct.EventKind.request else None
        yield line.fault(f"the {words(event)} comes from the robot, not from the controller", hint)
    elif isinstance(line, Acceptance) and plant_of(event).kind != sct.PlantKind.actionServer:
        hint = "only an `outgoing action` accepts and rejects goals"
        yield line.fault(f"`{name(plant_of(event))}` takes no goals", hint)
    elif isinstance(line, Stop) and not is_repeated:
        yield line.fault(f"no `every` before this line repeats the {words(event)}", "leave it out")
    elif isinstance(line, Every) and event.kind in _ONCE and plant_of(event).kind != sct.PlantKind.message:
        hint = "write this line without `every`: it comes once for each call or goal"
        yield line.fault(f"the {words(event)} cannot be repeated", hint)


def _impossible(line: IncomingEvent, event: sct.Event) -> Iterator[Diagnostic]:
    """Yield findings if the robot does not send an event, or not with the line's reason or data."""
    possible = possible_reasons(event)
    if event.kind not in _FROM_THE_ROBOT:
        hint = "a step is a message, an answer, an error or a request; time passes with `wait`"
        if event.kind in ANSWERS:
            hint = "the controller sends it: write `expect …` before it, and `sent` after it"
        yield line.fault(f"the {words(event)} does not come from the robot", hint)
    elif line.reason is not None and not possible:
        yield line.fault("only the error of a service or an action has a reason", f"leave out `because {line.reason}`")
    elif line.reason is not None and line.reason not in possible:
        hint = f"expected {join_with_and([f'`{reason}`' for reason in sorted(possible)])}"
        yield line.fault(f"the {words(event)} cannot have the reason `{line.reason}`", hint)
    elif event.kind == sct.EventKind.cancelRequest and line.data is not None:
        yield line.fault("a request to cancel a goal has no data", "leave out `with …`")
    elif possible and line.data is not None and not brings_data(event, line.reason):
        yield line.fault(f"an error with the reason `{line.reason}` has no data", "leave out `with …`")
