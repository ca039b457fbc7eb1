"""The events of messages, services and actions, and the data that each of them carries: one table for all packages."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from robosc.metamodel import robosc, sct
from robosc.ros_types.wire import Section

if TYPE_CHECKING:
    from collections.abc import Mapping


class PortEvent(NamedTuple):
    """An event of a kind of communication.

    `name` is what transitions call it (thesis table 5.1); empty: no transition can name it. Its data stands in a
    `section` of the ROS type, and the `feature` of the communication declares its type; None and empty: it has no data.
    """

    kind: sct.EventKind
    name: str
    section: Section | None = None
    feature: str = ""

    @property
    def is_sent(self) -> bool:
        """Whether the controller sends the data, or a component gets it."""
        return self.kind == sct.EventKind.trigger


_RESET = PortEvent(sct.EventKind.reset, "")
_CANCEL = PortEvent(sct.EventKind.cancel, "cancel")
_ERROR = PortEvent(sct.EventKind.error, "error")
#: The ends of a goal that has not succeeded come with its result, or with one of ROS's defaults.
_ABORTED = PortEvent(sct.EventKind.error, "error", Section.RESULT, "responseType")
_CANCELED = PortEvent(sct.EventKind.canceled, "canceled", Section.RESULT, "responseType")

#: The events of each kind of communication, in the order of its plant; of a message only one of the two happens.
EVENTS: Mapping[type[robosc.CommunicationType], tuple[PortEvent, ...]] = {
    robosc.Message: (
        PortEvent(sct.EventKind.trigger, "request", Section.MESSAGE, "type"),
        PortEvent(sct.EventKind.response, "response", Section.MESSAGE, "type"),
    ),
    robosc.Service: (
        PortEvent(sct.EventKind.trigger, "request", Section.REQUEST, "requestType"),
        _RESET,
        PortEvent(sct.EventKind.response, "response", Section.RESPONSE, "responseType"),
        _ERROR,
    ),
    robosc.Action: (
        PortEvent(sct.EventKind.trigger, "request", Section.GOAL, "requestType"),
        _RESET,
        _CANCEL,
        PortEvent(sct.EventKind.feedback, "feedback", Section.FEEDBACK, "feedbackType"),
        PortEvent(sct.EventKind.response, "response", Section.RESULT, "responseType"),
        _ABORTED,
        _CANCELED,
    ),
}
#: The locations of the plants of services and actions (thesis, listings 5.2 and 5.3); that of a message is READY.
IDLE, WAITING, EXECUTING, READY, ERROR = "idle", "wait_for_response", "executing", "ready", "error"
#: The controller has asked the server to cancel the goal, which has not ended yet.
CANCELING = "canceling"
#: The locations in which a service or action is running: from its request until its end is known.
RUNNING = (WAITING, EXECUTING, CANCELING)
#: The word behind a service or action that reads whether it is running.
RUNNING_WORD = "running"
#: In the order in which the language lists them.
_NAMES = ("request", "response", "error", "feedback", "cancel", "canceled")
#: The kinds of the events that the controller decides on: all but what comes from the robot.
CONTROLLABLE = (
    sct.EventKind.trigger,
    sct.EventKind.reset,
    sct.EventKind.cancel,
    sct.EventKind.tau,
    sct.EventKind.data,
)


#: Quality of service where the configuration says nothing: how many messages wait in a queue.
QUEUE_DEPTH = 10


def is_sensor_data(package: str) -> bool:
    """Whether ROS 2 receives messages of a package by its quality of service for sensors: best effort, the newest."""
    return package == "sensor_msgs"


def events(communication: robosc.CommunicationType | None) -> tuple[PortEvent, ...]:
    """The events of a communication; of a message the one that its direction means."""
    rows = EVENTS.get(type(communication), ())  # type: ignore[arg-type]
    if isinstance(communication, robosc.Message):
        return rows[:1] if communication.direction == robosc.MessageDirection.incoming else rows[1:]
    return rows


def is_error(event: PortEvent | None) -> bool:
    """Whether an event is the error of a service or an action, which has a reason."""
    return event is not None and event.kind == sct.EventKind.error


def happens_anyway(event: PortEvent | sct.Event) -> bool:
    """Whether an event happens whether its data can be read or not."""
    return event.kind in (sct.EventKind.error, sct.EventKind.canceled)


def event_names(communication: robosc.CommunicationType | None) -> list[str]:
    """The names of the events that a transition can react to."""
    return sorted((event.name for event in events(communication) if event.name), key=_NAMES.index)


def event(communication: robosc.CommunicationType | None, name: robosc.ResultType | None) -> PortEvent | None:
    """The event that a transition names; None where the communication has no such event."""
    return next((row for row in events(communication) if row.name == str(name)), None)


def event_of(reference: robosc.CommunicationReference | None, name: robosc.ResultType | None) -> PortEvent | None:
    """The same for a reference in a text; None also where it is not resolved."""
    return event(reference.communicationType if reference else None, name)


def meant(reference: robosc.EventReference) -> PortEvent | None:
    """The event that a requirement names; without a word for it the request, or what an outgoing message brings."""
    named = reference.communicationType
    communication = named.communicationType if named else None
    if isinstance(reference, robosc.NamedEvent):
        return event(communication, reference.resultType)
    return next(iter(events(communication)), None)


def sent(communication: robosc.CommunicationType | None) -> PortEvent | None:
    """The event with which data goes out of the controller; None where none goes out."""
    return next((row for row in events(communication) if row.is_sent), None)


def carried(communication: robosc.CommunicationType) -> list[tuple[PortEvent, robosc.DataType]]:
    """The events that carry data, in the order of the text, each with the type that is declared for it.

    Of the ends of a goal, which all carry its result, the response.
    """
    rows = sorted((row for row in events(communication) if row.section and not happens_anyway(row)), key=_section_index)
    types = ((row, data_type(communication, row)) for row in rows)
    return [(row, declared) for row, declared in types if declared is not None]


def data_type(communication: robosc.CommunicationType | None, row: PortEvent | None) -> robosc.DataType | None:
    """The declared type of the data of an event; None where it has none."""
    return getattr(communication, row.feature) if row is not None and row.feature else None


def sent_type(communication: robosc.CommunicationType | None) -> robosc.DataType | None:
    """The declared type of the data that goes out of the controller; None where none goes out."""
    return data_type(communication, sent(communication))


def section_of(declared: robosc.DataType) -> Section:
    """The section of the ROS type that a type in the text of a communication stands for; elsewhere a message."""
    rows = EVENTS.get(type(declared.eContainer()), ())
    owner = declared.eContainer()
    sections = (row.section for row in rows if row.feature and getattr(owner, row.feature) is declared)
    return next(sections, None) or Section.MESSAGE


#: The types of std_msgs that carry basic data without `links`.
_BASIC = {
    robosc.BooleanDataType: "Bool",
    robosc.IntegerDataType: "Int16",
    robosc.DoubleDataType: "Float32",
    robosc.StringDataType: "String",
    robosc.NoneDataType: "Empty",
}


def ros_type(communication: robosc.CommunicationType) -> tuple[str, str] | None:
    """The package and the name of a communication's ROS type.

    That is the linked one, or the one of `std_msgs` or `std_srvs` for basic data; None where there is none.
    """
    linked = communication.interface
    if linked is not None:
        return linked.package, linked.type
    if not isinstance(communication, robosc.Message):
        return "std_srvs", "Empty"
    name = _BASIC.get(type(basis(communication.type)))
    return None if name is None else ("std_msgs", name)


def basis(declared: robosc.DataType | None) -> robosc.DataType | None:
    """The type that carries data of a type: that of an enum is the type that it is made from."""
    if isinstance(declared, robosc.ComplexDataTypeReference) and isinstance(declared.type, robosc.EnumDataType):
        return basis(declared.type.type)
    return declared


def _section_index(row: PortEvent) -> int:
    return row.section.index if row.section else 0
