"""The reasons for which services and actions fail: the predefined enum `Failure`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.metamodel import robosc, sct
from robosc.semantics.roles import plant_of

if TYPE_CHECKING:
    from collections.abc import Mapping

#: The text of the input that has the reason.
REASON = "error"
#: The reason of an answer whose data can't be read.
UNREADABLE = "unreadable"
#: The name of the predefined enum.
FAILURE = "Failure"
#: The values of the enum with which each kind of communication can fail; in the enum, too, they follow each other.
REASONS: Mapping[type[robosc.CommunicationType], tuple[str, ...]] = {
    robosc.Service: ("unavailable", "timeout", "unreadable", "failed"),
    robosc.Action: ("rejected", "lost", "aborted", "canceled", "unavailable", "timeout", "unreadable"),
}
#: All values of the enum.
FAILURES = frozenset(name for names in REASONS.values() for name in names)
#: The reasons after which a service or an action may still be running.
STILL_RUNNING: Mapping[type[robosc.CommunicationType], tuple[str, ...]] = {
    robosc.Service: ("timeout", "failed"),
    robosc.Action: ("lost",),
}
#: The reasons of errors that bring no answer and no result.
_WITHOUT_DATA: Mapping[sct.PlantKind, tuple[str, ...]] = {
    sct.PlantKind.service: ("unavailable", "timeout", "failed"),
    sct.PlantKind.action: ("unavailable", "rejected", "lost"),
}
#: The reason where a text names none.
USUAL: Mapping[type[robosc.CommunicationType], str] = {robosc.Service: "failed", robosc.Action: "aborted"}
_KINDS: Mapping[sct.PlantKind, type[robosc.CommunicationType]] = {
    sct.PlantKind.service: robosc.Service,
    sct.PlantKind.action: robosc.Action,
}


def reasons(communication: robosc.CommunicationType | None) -> tuple[str, ...]:
    """The reasons for which a service or an action can fail; empty for a message and for None."""
    return REASONS.get(type(communication), ())  # type: ignore[arg-type]


def possible_reasons(event: sct.Event) -> tuple[str, ...]:
    """The reasons that an event can have, the usual one first; empty where it is no error of a service or action."""
    communication = _KINDS.get(plant_of(event).kind)
    if communication is None or event.kind != sct.EventKind.error:
        return ()
    usual = USUAL[communication]
    return (usual, *(reason for reason in REASONS[communication] if reason != usual))


def brings_data(event: sct.Event, reason: str | None) -> bool:
    """Whether an error with a reason brings an answer or a result; True where no reason is given."""
    return reason not in _WITHOUT_DATA.get(plant_of(event).kind, ())


def is_reason(given: sct.Input) -> bool:
    """Whether an input has the reason of an error."""
    return given.text == REASON


def is_failure(enum: object) -> bool:
    """Whether an element is the predefined enum, not one of the user's own with its name."""
    if not isinstance(enum, robosc.EnumDataType) or enum.name != FAILURE:
        return False
    return is_predefined(enum.eContainer())


def is_predefined(base: object) -> bool:
    """Whether a library is the one that every model knows."""
    return isinstance(base, robosc.Library) and base.name == base.file == PREDEFINED


#: The name of the library that every model knows. Models call its file so, too: a user's file has a suffix.
PREDEFINED = "Predefined"
