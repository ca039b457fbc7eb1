"""Answers as JSON data; `at` returns the place of an element: an object with `file`, `line` and `column`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

from robosc.analysis.blocking_in_words import counterexample_in_words, describe_blocking
from robosc.analysis.explain.answers import Emptiness, Explanation, Possibility
from robosc.analysis.explain.as_text import NEEDLESS
from robosc.analysis.paths import trace_data
from robosc.analysis.wording import in_words, name
from robosc.model.semantics.roles import event_name

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from robosc.analysis.explain.answers import Answer, Loosening, Note
    from robosc.model import sct

    At: TypeAlias = Callable[[Any], dict[str, Any]]


def data_of(answer: Answer | None, at: At) -> dict[str, Any]:
    """Return the data of an answer; None is the answer for a supervisor that is not empty."""
    match answer:
        case Explanation():
            return _explanation(answer, at)
        case Possibility():
            return _possibility(answer, at)
        case Emptiness():
            return _emptiness(answer, at)
    return {"empty": False}


def data_in_short(explanation: Explanation, model: sct.SupervisoryControlModel) -> dict[str, Any]:
    """Return the data about an event in a state, in words: the obstacles, and what makes the event possible."""
    counterexample = explanation.counterexample
    return {
        "allowed": explanation.allowed,
        "notes": [NEEDLESS]
        if explanation.needless
        else [note.text for note in (*explanation.plants, *explanation.requirements)],
        "otherwise": "" if counterexample is None else counterexample_in_words(counterexample, model),
        "changes": [note.text for note in explanation.changes],
        "way": in_words(explanation.way, model) if explanation.way else "",
    }


def _explanation(explanation: Explanation, at: At) -> dict[str, Any]:
    """Return the data about an event in a state."""
    counterexample = explanation.counterexample
    return {
        "event": event_name(explanation.event),
        "allowed": explanation.allowed,
        "by": None if explanation.by is None else str(explanation.by),
        "reach": str(explanation.situation.reach),
        "state": dict(explanation.situation.state),
        "trace": trace_data(explanation.situation.trace),
        "plants": _notes(explanation.plants, at),
        "requirements": _notes(explanation.requirements, at),
        "data": _notes(explanation.data, at),
        "counterexample": counterexample
        and {
            "trace": trace_data(counterexample.trace),
            "onwards": trace_data(counterexample.onwards),
            "guards_against": counterexample.onwards[-1].event if counterexample.onwards else None,
            "stuck": [name(plant) for plant in counterexample.unmarked],
            "requirements": _notes(explanation.blamed, at),
        },
        "changes": _notes(explanation.changes, at),
        "way": None if explanation.way is None else trace_data(explanation.way),
        "refusal": explanation.refusal and _explanation(explanation.refusal, at),
    }


def _possibility(possibility: Possibility, at: At) -> dict[str, Any]:
    """Return the data about an event that may never happen."""
    return {
        "event": event_name(possibility.event),
        "possible": possibility.possible,
        "nearest": possibility.nearest and _explanation(possibility.nearest, at),
        "beyond": possibility.beyond and _explanation(possibility.beyond, at),
        "conflict": _notes(possibility.conflict, at),
        "plants": _notes(possibility.plants, at),
        "loosenings": _loosenings(possibility.loosenings, at),
    }


def _emptiness(emptiness: Emptiness, at: At) -> dict[str, Any]:
    """Return the data about an empty supervisor."""
    return {
        "empty": True,
        "message": describe_blocking(emptiness.reason),
        "event": emptiness.reason.event and event_name(emptiness.reason.event),
        "trace": trace_data(emptiness.reason.trace),
        "stuck": _notes(emptiness.stuck, at),
        "requirements": _notes(emptiness.blamed, at),
        "loosenings": _loosenings(emptiness.loosenings, at),
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
            "texts": list(dict.fromkeys(own.text for own in loosening.requirements)),
            "states": loosening.states,
        }
        for loosening in loosenings
    ]
