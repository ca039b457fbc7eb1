"""Says why an event can't happen, or never, or why nothing can, in the words of its model, and what would help.

    answer = explored(model, lambda system: possibility(system, event_named(model, "move")))

`explaining` answers, `obstacles` finds what stands in the way, `names` finds what a user names. Answers (`answers`) are
rendered `as_text` for a person and `as_json` for programs.
"""

from robosc.analysis.explain.answers import Emptiness, Explanation, Possibility
from robosc.analysis.explain.as_json import data_of
from robosc.analysis.explain.as_text import NEEDLESS, Renderer
from robosc.analysis.explain.explaining import emptiness, explain, explored, possibility
from robosc.analysis.explain.names import NamingError, event_named, state_given

__all__ = [
    "NEEDLESS",
    "Emptiness",
    "Explanation",
    "NamingError",
    "Possibility",
    "Renderer",
    "data_of",
    "emptiness",
    "event_named",
    "explain",
    "explored",
    "possibility",
    "state_given",
]
