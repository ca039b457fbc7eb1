"""Failure reasons of services and actions: the predefined enum `Failure`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.model import robosc, sct
from robosc.model.semantics.roles import plant_of

if TYPE_CHECKING:
    from collections.abc import Mapping

#: Text of the input that holds the reason.
REASON = "error"
#: Reason of an answer whose data cannot be read.
UNREADABLE = "unreadable"
#: Name of the predefined enum.
FAILURE = "Failure"
#: Failure reasons by kind of communication. The enum has its literals in this order.
REASONS: Mapping[type[robosc.CommunicationType], tuple[str, ...]] = {
    robosc.Service: ("unavailable", "timeout", "unreadable", "failed"),
    robosc.Action: ("rejected", "lost", "aborted", "canceled", "unavailable", "timeout", "unreadable"),
}
#: All literals of the enum.
FAILURES = frozenset(name for names in REASONS.values() for name in names)
#: Reasons after which a service or an action may still be running.
STILL_RUNNING: Mapping[type[robosc.CommunicationType], tuple[str, ...]] = {
    robosc.Service: ("timeout", "failed"),
    robosc.Action: ("lost",),
}
#: Reasons of errors without an answer or a result.
_WITHOUT_DATA: Mapping[sct.PlantKind, tuple[str, ...]] = {
    sct.PlantKind.service: ("unavailable", "timeout", "failed"),
    sct.PlantKind.action: ("unavailable", "rejected", "lost"),
}
#: Default reason if a text names none.
USUAL: Mapping[type[robosc.CommunicationType], str] = {robosc.Service: "failed", robosc.Action: "aborted"}
_KINDS: Mapping[sct.PlantKind, type[robosc.CommunicationType]] = {
    sct.PlantKind.service: robosc.Service,
    sct.PlantKind.action: robosc.Action,
}


def reasons(communication: robosc.CommunicationType | None) -> tuple[str, ...]:
    """Return the failure reasons of a service or action; empty for a message and for None."""
    return REASONS.get(type(communication), ())  # type: ignore[arg-type]


def possible_reasons(event: sct.Event) -> tuple[str, ...]:
    """Return the possible reasons of an event, the default one first.

    The result is empty unless the event is the error of a service or action.
    """
    communication = _KINDS.get(plant_of(event).kind)
    if communication is None or event.kind != sct.EventKind.error:
        return ()
    usual = USUAL[communication]
    return (usual, *(reason for reason in REASONS[communication] if reason != usual))


def brings_data(event: sct.Event, reason: str | None) -> bool:
    """Return whether an error with this reason has an answer or a result; True if the reason is None."""
    return reason not in _WITHOUT_DATA.get(plant_of(event).kind, ())


def is_reason(input_element: sct.Input) -> bool:
    """Return whether an input holds the reason of an error."""
    return input_element.text == REASON


def is_failure(enum: object) -> bool:
    """Return whether an element is the predefined enum, not a user's enum of the same name."""
    if not isinstance(enum, robosc.EnumDataType) or enum.name != FAILURE:
        return False
    return is_predefined(enum.eContainer())


def is_predefined(base: object) -> bool:
    """Return whether an element is the predefined library."""
    return isinstance(base, robosc.Library) and base.name == base.file == PREDEFINED


#: Name of the predefined library and of its file in models. A user's file has a suffix.
PREDEFINED = "Predefined"
