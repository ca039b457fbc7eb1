"""Events of messages, services and actions, with the data of each event: one table for all packages."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from robosc.base.ros_types.wire import Section
from robosc.model import robosc, sct

if TYPE_CHECKING:
    from collections.abc import Mapping


class PortEvent(NamedTuple):
    """An event of a kind of communication.

    Transitions use its `name` (thesis table 5.1). If the name is empty, no transition can refer to the event. Its data
    is in a `section` of the ROS type; the `feature` of the communication declares the data's type. An event without
    data has the section None and an empty feature.
    """

    kind: sct.EventKind
    name: str
    section: Section | None = None
    feature: str = ""

    @property
    def is_sent(self) -> bool:
        """Whether the controller sends the event with its data. If not, the controller receives it."""
        return self.kind == sct.EventKind.trigger or self.kind in ANSWERS

    @property
    def preposition(self) -> str:
        """Word before the communication in the text of an event: `request to move`, `response from move`."""
        return "to" if self.is_sent else "from"

    @property
    def event_name(self) -> str:
        """Name of the event in the plant, after `c_` or `u_`: the word of the language for a served communication."""
        return self.name if self.kind in (*ANSWERS, *REQUESTS) else self.kind.name


#: Answers of the controller to the clients of a service or an action that it serves.
ANSWERS = (
    sct.EventKind.reply,
    sct.EventKind.replyFeedback,
    sct.EventKind.replyError,
    sct.EventKind.replyCanceled,
)
#: Answers that end a request or a goal.
ENDING_ANSWERS = (sct.EventKind.reply, sct.EventKind.replyError, sct.EventKind.replyCanceled)
#: Events from the clients of a service or an action that the controller serves.
REQUESTS = (sct.EventKind.request, sct.EventKind.cancelRequest)


_RESET = PortEvent(sct.EventKind.reset, "")
_CANCEL = PortEvent(sct.EventKind.cancel, "cancel")
_ERROR = PortEvent(sct.EventKind.error, "error")
#: A goal that ends without success carries its result, or one of ROS's default results.
_ABORTED = PortEvent(sct.EventKind.error, "error", Section.RESULT, "responseType")
_CANCELED = PortEvent(sct.EventKind.canceled, "canceled", Section.RESULT, "responseType")

#: Events of each kind of communication, in the order of its plant. A message has only one of its two events.
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
    robosc.OutgoingService: (
        PortEvent(sct.EventKind.request, "request", Section.REQUEST, "requestType"),
        PortEvent(sct.EventKind.reply, "response", Section.RESPONSE, "responseType"),
    ),
    robosc.OutgoingAction: (
        PortEvent(sct.EventKind.request, "request", Section.GOAL, "requestType"),
        PortEvent(sct.EventKind.cancelRequest, "cancel"),
        PortEvent(sct.EventKind.replyFeedback, "feedback", Section.FEEDBACK, "feedbackType"),
        PortEvent(sct.EventKind.reply, "response", Section.RESULT, "responseType"),
        PortEvent(sct.EventKind.replyError, "error", Section.RESULT, "responseType"),
        PortEvent(sct.EventKind.replyCanceled, "canceled", Section.RESULT, "responseType"),
    ),
}
#: Communications that the controller serves: others call it.
SERVED = (robosc.OutgoingService, robosc.OutgoingAction)
#: Communications that the controller calls.
CALLED = (robosc.Service, robosc.Action)
#: Communications that run from a request to its end: all but messages.
LASTING = (*CALLED, *SERVED)
#: Locations of the plants of services and actions (thesis, listings 5.2 and 5.3). A message's location is READY.
IDLE, WAITING, EXECUTING, READY, ERROR = "idle", "wait_for_response", "executing", "ready", "error"
#: The controller asked the server to cancel the goal, and the goal has not ended yet.
CANCELING = "canceling"
#: The controller serves a request that it has not answered yet.
OPEN = "open"
#: Locations in which a service or action is running: from its request until its end is known.
RUNNING = (OPEN, WAITING, EXECUTING, CANCELING)
#: Word after the name of a service or action that reads whether it is running.
RUNNING_WORD = "running"
#: Names of events, in the order in which the language lists them.
_NAMES = ("request", "response", "error", "feedback", "cancel", "canceled")
#: Kinds of events that the controller decides on: all but events from the robot.
CONTROLLABLE = (
    sct.EventKind.trigger,
    sct.EventKind.reset,
    sct.EventKind.cancel,
    sct.EventKind.tau,
    sct.EventKind.data,
    *ANSWERS,
)


#: Default length of a message queue, if the configuration does not set one.
QUEUE_DEPTH = 10


def is_sensor_data(package: str) -> bool:
    """Return whether ROS 2 receives a package's messages with the sensor data QoS: best effort, newest message."""
    return package == "sensor_msgs"


def event_word(event: sct.Event) -> str:
    """Return the word of the language for an event of a communication, such as `request`; empty for a reset."""
    return next(row.name for rows in EVENTS.values() for row in rows if row.kind == event.kind)


def ros_kind(communication: robosc.CommunicationType) -> str:
    """Return `message`, `service` or `action`."""
    return type(communication).__name__.removeprefix("Outgoing").lower()


def kind_text(communication: robosc.CommunicationType) -> str:
    """Return the kind of a communication in words: `message`, `service`, `outgoing action`."""
    return f"{'outgoing ' * isinstance(communication, SERVED)}{ros_kind(communication)}"


def events(communication: robosc.CommunicationType | None) -> tuple[PortEvent, ...]:
    """Return the events of a communication. A message has one event, selected by its direction."""
    rows = EVENTS.get(type(communication), ())  # type: ignore[arg-type]
    if isinstance(communication, robosc.Message):
        return rows[:1] if communication.direction == robosc.MessageDirection.incoming else rows[1:]
    return rows


def is_error(event: PortEvent | None) -> bool:
    """Return whether an event is the error of a service or an action, which has a reason."""
    return event is not None and event.kind == sct.EventKind.error


def happens_anyway(event: PortEvent | sct.Event) -> bool:
    """Return whether an event happens even if its data cannot be read."""
    return event.kind in (sct.EventKind.error, sct.EventKind.canceled)


def event_names(communication: robosc.CommunicationType | None) -> list[str]:
    """Return the names of the events that a transition can react to."""
    return sorted((event.name for event in events(communication) if event.name), key=_NAMES.index)


def event(communication: robosc.CommunicationType | None, name: robosc.ResultType | None) -> PortEvent | None:
    """Return the event that a transition names. None if the communication has no such event."""
    return next((row for row in events(communication) if row.name == str(name)), None)


def event_of(reference: robosc.CommunicationReference | None, name: robosc.ResultType | None) -> PortEvent | None:
    """Return the event that a transition names, by a reference in a text. None also if the reference is unresolved."""
    return event(reference.communicationType if reference else None, name)


def port_event_of(reference: robosc.EventReference) -> PortEvent | None:
    """Return the event that a requirement names.

    Without a word for the event, it is the request, or the arrival of an outgoing message.
    """
    named = reference.communicationType
    communication = named.communicationType if named else None
    if isinstance(reference, robosc.NamedEvent):
        return event(communication, reference.resultType)
    return next(iter(events(communication)), None)


def sending_event(communication: robosc.CommunicationType | None) -> PortEvent | None:
    """Return the event with which the controller sends data. None if it sends none.

    This is the response of a service or action that the controller serves.
    """
    kinds = (sct.EventKind.trigger, sct.EventKind.reply)
    return next((row for row in events(communication) if row.kind in kinds), None)


def feedback_event(communication: robosc.CommunicationType | None) -> PortEvent | None:
    """Return the event with which the controller sends feedback. None if it sends none."""
    return next((row for row in events(communication) if row.kind == sct.EventKind.replyFeedback), None)


def provided_event(statement: robosc.DataStatement) -> PortEvent | None:
    """Return the event whose data a `provide` statement or a limit determines. None if there is none."""
    communication = statement.communicationType.communicationType if statement.communicationType else None
    if isinstance(statement, robosc.ProvideStatement) and statement.feedback:
        return feedback_event(communication)
    return sending_event(communication)


def carrying_events(communication: robosc.CommunicationType) -> list[tuple[PortEvent, robosc.DataType]]:
    """Return the events that carry data, in the order of the text, each with its declared type.

    Several ends of a goal carry its result. Only the response is included.
    """
    others = (sct.EventKind.replyError, sct.EventKind.replyCanceled)
    carrying = (row for row in events(communication) if row.section and not happens_anyway(row))
    rows = sorted((row for row in carrying if row.kind not in others), key=_section_index)
    types = ((row, data_type(communication, row)) for row in rows)
    return [(row, declared) for row, declared in types if declared is not None]


def data_type(communication: robosc.CommunicationType | None, row: PortEvent | None) -> robosc.DataType | None:
    """Return the declared type of an event's data. None if the event has no data."""
    return getattr(communication, row.feature) if row is not None and row.feature else None


def sent_type(communication: robosc.CommunicationType | None) -> robosc.DataType | None:
    """Return the declared type of the data that the controller sends. None if it sends none."""
    return data_type(communication, sending_event(communication))


def section_of(declared: robosc.DataType) -> Section:
    """Return the section of the ROS type that a type in a communication's text describes; elsewhere the message."""
    rows = EVENTS.get(type(declared.eContainer()), ())
    owner = declared.eContainer()
    sections = (row.section for row in rows if row.feature and getattr(owner, row.feature) is declared)
    return next(sections, None) or Section.MESSAGE


#: Types of std_msgs that carry basic data of communications without `links`.
_BASIC = {
    robosc.BooleanDataType: "Bool",
    robosc.IntegerDataType: "Int16",
    robosc.DoubleDataType: "Float32",
    robosc.StringDataType: "String",
    robosc.NoneDataType: "Empty",
}


def ros_type(communication: robosc.CommunicationType) -> tuple[str, str] | None:
    """Return the package and the name of a communication's ROS type.

    This is the linked type, or the type of `std_msgs` or `std_srvs` for basic data. None if there is no such type.
    """
    linked = communication.interface
    if linked is not None:
        return linked.package, linked.type
    if not isinstance(communication, robosc.Message):
        return "std_srvs", "Empty"
    name = _BASIC.get(type(basis(communication.type)))
    return None if name is None else ("std_msgs", name)


def basis(declared: robosc.DataType | None) -> robosc.DataType | None:
    """Return the type that carries data of a type. An enum is carried by the type it is defined on."""
    if isinstance(declared, robosc.ComplexDataTypeReference) and isinstance(declared.type, robosc.EnumDataType):
        return basis(declared.type.type)
    return declared


def _section_index(row: PortEvent) -> int:
    return row.section.index if row.section else 0
