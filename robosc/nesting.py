"""Whether JSON text is fit to be read: `json` follows any number of brackets, until the process ends."""

from itertools import accumulate

_DEEPEST = 100
_BRACKETS = {"{": 1, "[": 1, "]": -1, "}": -1}


def too_deep(text: str) -> bool:
    """Whether more brackets are open at once than anybody needs, those in strings counted, too."""
    return max(accumulate((_BRACKETS.get(each, 0) for each in text), initial=0)) > _DEEPEST
