"""Events, states and traces of an SCT model in the words of the robot model that it came from."""

from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING

from robosc.model import sct
from robosc.model.semantics.durations import timer_text
from robosc.model.semantics.edges import edges_from
from robosc.model.semantics.printing import RobotPrinter
from robosc.model.semantics.roles import event_name, plant_of, provide_number
from robosc.synthesis.decoding import text

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from robosc.analysis.paths import TraceStep
    from robosc.synthesis.decoding import Value
    from robosc.synthesis.encoding import Element

#: Maximum number of components that a sentence names.
NAMED = 4
_EVENTS = {
    sct.EventKind.trigger: "request to {}",
    sct.EventKind.response: "response from {}",
    sct.EventKind.error: "error from {}",
    sct.EventKind.feedback: "feedback from {}",
    sct.EventKind.cancel: "cancel of {}",
    sct.EventKind.canceled: "canceled from {}",
    sct.EventKind.reset: "reset of {}",
    sct.EventKind.tau: "transition of {}",
    sct.EventKind.timeout: "timeout of {}",
    sct.EventKind.request: "request from {}",
    sct.EventKind.cancelRequest: "cancel from {}",
    sct.EventKind.reply: "response to {}",
    sct.EventKind.replyFeedback: "feedback to {}",
    sct.EventKind.replyError: "error to {}",
    sct.EventKind.replyCanceled: "answer `canceled` to {}",
}
#: Events of transitions without communication: their names do not identify the text that they come from.
_OWN = (sct.EventKind.tau, sct.EventKind.timeout)


def name(plant: sct.Plant) -> str:
    """Return the name in the robot model: a component, or a component and its communication with a dot."""
    return plant.origin or plant.name


def reference(plant: sct.Plant) -> str:
    """Return the text that refers to a component or its communication in the robot model."""
    return plant.reference or name(plant)


def words(event: sct.Event) -> str:
    """Return an event in words, such as `request to Platform.move`.

    Silent transitions and `provide` statements also get their line, and a column if needed to distinguish them.
    """
    owner = f"`{name(plant_of(event))}`"
    if event.kind == sct.EventKind.data:
        number = provide_number(event)
        phrase = f"choice of `provide` {number} for {owner}" if number else f"choice of no data for {owner}"
        where = _where(event) if number else ""
    elif event.kind in (sct.EventKind.plain, sct.EventKind.input):
        phrase = f"{'change of ' * (event.kind == sct.EventKind.input)}`{event_name(event)}`"
        where = ""
    else:
        phrase = _EVENTS[event.kind].format(owner)
        phrase += f" after {timer_text(event.timer)}" if event.timer else ""
        where = _where(event) if event.kind in _OWN else ""
    return f"{phrase} in {where}" if where else phrase


def describe_event(event: sct.Event) -> str:
    """Return the event's name, with its description if the name does not identify its text."""
    unclear = event.kind in (*_OWN, sct.EventKind.data) and event.source
    return f"{event_name(event)} ({words(event)})" if unclear else event_name(event)


def _where(event: sct.Event) -> str:
    """Return the line of an event, with the column if another event of its plant has the same line."""
    if event.source is None:
        return ""
    span = event.source.span
    others = (other.source.span for other in plant_of(event).events if other is not event and other.source)
    shared = any(other.line == span.line and other != span for other in others)
    return f"line {span.line}, column {span.column}" if shared else f"line {span.line}"


def change(event: sct.Event) -> str:
    """Return an internal event in words: `Lidar changes by itself: blocked to free`; with the line if ambiguous."""
    plant = plant_of(event)
    if event.kind == sct.EventKind.reset:
        return f"{name(plant)} is ready to be used again"
    steps: dict[sct.Event, dict[str, None]] = {}
    for location in plant.locations:
        for edge in edges_from(location):
            steps.setdefault(edge.event, {})[f"{location.name} to {edge.target.name}"] = None
    own = steps.get(event, {})
    alike = any(other.kind == sct.EventKind.tau and steps[other] == own for other in steps if other is not event)
    where = _where(event) if alike else ""
    return f"{name(plant)} changes by itself: {', '.join(own)}" + (f" ({where})" if where else "")


def quote_requirements(requirements: Sequence[sct.StatedRequirement]) -> str:
    """Return requirements with their text and line: "`requirement move needs Lidar.free` (line 12)"."""
    texts = list(dict.fromkeys(map(_called, requirements)))
    named = texts[:NAMED]
    if len(texts) > NAMED:
        named.append(f"{len(texts) - NAMED} more")
    return join_with_and(named)


def _called(requirement: sct.StatedRequirement) -> str:
    unnamed = "a requirement"
    if isinstance(requirement, sct.Requirement):
        unnamed = f"a requirement on the {words(requirement.event)}"
    text = f"`{requirement.text}`" if requirement.text else unnamed
    return f"{text} (line {requirement.source.span.line})" if requirement.source else text


def forbid(requirements: Sequence[sct.Requirement], what: str) -> str:
    """Return a clause which states that requirements forbid something."""
    return f"{quote_requirements(requirements)} {_forbid(requirements)} {what}"


def violates(named: str, requirements: Sequence[sct.StatedRequirement]) -> str:
    """Return a clause which states that requirements, named `named`, are violated."""
    events = dict.fromkeys(
        requirement.event for requirement in requirements if isinstance(requirement, sct.Requirement)
    )
    if events:
        return f"{join_with_and([words(event) for event in events])} can come, which {named} {_forbid(requirements)}"
    goals = dict.fromkeys(map(goal_in_words, requirements))
    if None not in goals:
        return f"{named} cannot be satisfied: no {' and no '.join(filter(None, goals))} can be reached"
    return f"{named} {'is' if len(requirements) == 1 else 'are'} violated"


def goal_in_words(requirement: sct.StatedRequirement) -> str | None:
    """Return the states that a requirement wants to be reachable: "state with `Base.docked`"; None for other kinds."""
    if not isinstance(requirement, sct.ReachabilityRequirement):
        return None
    along, bound = requirement.pathCondition, requirement.bound
    goal = f"state with `{RobotPrinter()(requirement.condition)}`"
    goal += "" if bound is None else f" in at most {bound:,} event{'' if bound == 1 else 's'}"
    return goal if along is None else f"{goal} through states with `{RobotPrinter()(along)}` only"


def _forbid(requirements: Sequence[sct.StatedRequirement]) -> str:
    return "forbids" if len(set(map(_called, requirements))) == 1 else "forbid"


def in_words(steps: Sequence[TraceStep], model: sct.SupervisoryControlModel) -> str:
    """Return the events of a trace with the data that matters; repetitions in a row appear once."""
    events = {event_name(event): event for plant in model.plants for event in plant.events}
    phrases = []
    for step in steps:
        event = events[step.event]
        data = ", ".join(_data(parameter, chosen, event) for parameter, chosen in step.inputs.items())
        phrases.append(f"{words(event)} ({data})" if data else words(event))
    runs = [(phrase, len(list(run))) for phrase, run in groupby(phrases)]
    return ", then ".join(phrase if times == 1 else f"{times:,} times {phrase}" for phrase, times in runs)


def _data(input_name: str, chosen: Value, event: sct.Event) -> str:
    """Return a piece of an event's data, or the node's computation on it, as the model writes it."""
    computed = next((carried.text for carried in event.inputs if carried.name == input_name), None)
    if computed is None:
        name = input_name.removeprefix(f"i_{event.name.partition('_')[2]}").removeprefix("_") or "value"
        return f"{name} = {text(chosen)}"
    return computed if chosen is True else f"!({computed})" if chosen is False else f"{computed} = {text(chosen)}"


def join_with_and(names: Sequence[str]) -> str:
    """Return `a`, `a and b`, or `a, b and c`."""
    return ", ".join(names[:-1]) + f" and {names[-1]}" if len(names) > 1 else "".join(names)


def condition(values: Iterable[tuple[Element, Value]]) -> str:
    """Return values as a condition of the language, such as `Lidar.free and Lidar.front = clear`."""
    return " and ".join(_is(element, chosen) for element, chosen in values)


def what_is(element: Element, chosen: Value) -> str:
    """Return the value of a plant or variable in words, such as "`Lidar` is in `free`" or "`Gauge.level` is 3"."""
    if isinstance(element, sct.Plant):
        return f"`{name(element)}` is in `{chosen}`"
    return f"`{name(element.eContainer())}.{element.name}` is {text(chosen)}"


def _is(element: Element, chosen: Value) -> str:
    if isinstance(element, sct.Plant):
        return f"{name(element)}.{chosen}"
    whole = f"{name(element.eContainer())}.{element.name}"
    if isinstance(chosen, bool):
        return whole if chosen else f"!{whole}"
    return f"{whole} = {text(chosen)}"
