"""Explanations why an event is impossible now or ever, or why a supervisor is empty, with possible repairs.

    answer = explored(model, lambda system: possibility(system, event_named(model, "move")))

`explanations` computes the answers, `obstacles` finds the obstacles to an event, and `names` resolves the names that a
user writes. Answers (`answers`) are rendered `as_text` for users and `as_json` for programs.
"""

from robosc.analysis.explain.answers import Emptiness, Explanation, Possibility
from robosc.analysis.explain.as_json import data_in_short, data_of
from robosc.analysis.explain.as_text import NEEDLESS, Renderer
from robosc.analysis.explain.explanations import emptiness, explain, explore, possibility
from robosc.analysis.explain.names import NamingError, find_event, parse_state

__all__ = [
    "NEEDLESS",
    "Emptiness",
    "Explanation",
    "NamingError",
    "Possibility",
    "Renderer",
    "data_in_short",
    "data_of",
    "emptiness",
    "explain",
    "explore",
    "find_event",
    "parse_state",
    "possibility",
]
