"""Answers as JSON data; `at` returns the place of an element: an object with `file`, `line` and `column`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

from robosc.analysis.blocking_in_words import describe_blocking
from robosc.analysis.explain.answers import Emptiness, Explanation, Possibility
from robosc.analysis.paths import trace_data
from robosc.analysis.wording import name
from robosc.model.semantics.roles import event_name

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from robosc.analysis.explain.answers import Answer, Loosening, Note

    At: TypeAlias = Callable[[Any], dict[str, Any]]


def data_of(told: Answer | None, at: At) -> dict[str, Any]:
    """Return the data of an answer; None is the answer for a supervisor that is not empty."""
    match told:
        case Explanation():
            return _explanation(told, at)
        case Possibility():
            return _possibility(told, at)
        case Emptiness():
            return _emptiness(told, at)
    return {"empty": False}


def _explanation(told: Explanation, at: At) -> dict[str, Any]:
    """Return the data about an event in a state."""
    counterexample = told.counterexample
    return {
        "event": event_name(told.event),
        "allowed": told.allowed,
        "by": None if told.by is None else str(told.by),
        "reach": str(told.situation.reach),
        "state": dict(told.situation.state),
        "trace": trace_data(told.situation.trace),
        "plants": _notes(told.plants, at),
        "requirements": _notes(told.requirements, at),
        "counterexample": counterexample
        and {
            "trace": trace_data(counterexample.trace),
            "onwards": trace_data(counterexample.onwards),
            "guards_against": counterexample.onwards[-1].event if counterexample.onwards else None,
            "stuck": [name(plant) for plant in counterexample.unmarked],
            "requirements": _notes(told.blamed, at),
        },
        "changes": _notes(told.changes, at),
        "way": None if told.way is None else trace_data(told.way),
        "refusal": told.refusal and _explanation(told.refusal, at),
    }


def _possibility(told: Possibility, at: At) -> dict[str, Any]:
    """Return the data about an event that may never happen."""
    return {
        "event": event_name(told.event),
        "possible": told.possible,
        "nearest": told.nearest and _explanation(told.nearest, at),
        "beyond": told.beyond and _explanation(told.beyond, at),
        "conflict": _notes(told.conflict, at),
        "plants": _notes(told.plants, at),
        "loosenings": _loosenings(told.loosenings, at),
    }


def _emptiness(told: Emptiness, at: At) -> dict[str, Any]:
    """Return the data about an empty supervisor."""
    return {
        "empty": True,
        "message": describe_blocking(told.reason),
        "event": told.reason.event and event_name(told.reason.event),
        "trace": trace_data(told.reason.trace),
        "stuck": _notes(told.stuck, at),
        "requirements": _notes(told.blamed, at),
        "loosenings": _loosenings(told.loosenings, at),
    }


def _notes(notes: Iterable[Note], at: At) -> list[dict[str, Any]]:
    return [{**at(note.element), "text": note.text, "details": list(note.details)} for note in notes]


def _loosenings(loosenings: tuple[Loosening, ...] | None, at: At) -> list[dict[str, Any]] | None:
    """Return the data of requirements to loosen; None means that no removal of requirements would help."""
    if loosenings is None:
        return None
    return [
        {
            **at(loosening.requirements[0]),
            "texts": [own.text for own in loosening.requirements],
            "states": loosening.states,
        }
        for loosening in loosenings
    ]
