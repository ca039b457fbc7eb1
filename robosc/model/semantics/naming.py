"""Names in generated text: snake case, escaped keywords, resolved clashes."""

from __future__ import annotations

import re
from collections.abc import Set
from typing import TYPE_CHECKING

from robosc.base.files.resources import locate

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable

    from robosc.model import expression as ex

_GRAMMAR = locate("grammar/robosc.tx").read_text(encoding="utf-8")


def _words(pattern: str) -> list[str]:
    """Return the words in the group of a pattern of the grammar."""
    match = re.search(pattern, _GRAMMAR, re.MULTILINE)
    assert match
    return match[1].split("|")


#: Keywords of RoboSC that need a `^` before them if they are used as a name in an expression.
ROBOSC_KEYWORDS = frozenset(_words(r"^UnreservedName:\s*/\(\?!\(\?:([a-z|]+)\)"))
#: Names of RoboSC's functions.
ROBOSC_FUNCTIONS = tuple(_words(r"^BuiltIn: /\(\?:([a-z0-9|]+)\)"))
#: Words that begin a condition on the elements of an array, or on the instances of a template.
ROBOSC_QUANTIFIERS = tuple(_words(r"^Quantifier: /\(([a-z|]+)\)"))
#: The function that makes a string of a constant integer, where no function of the model has the name.
TEXT_FUNCTION = "text"
#: The number of the instance in the arguments and remappings of a fleet.
NUMBER = "number"
#: An instance of a fleet, behind its name.
_INSTANCE = re.compile(r"(?<=\w)\[0*([0-9]+)\]")
_WORD = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")


def snake_case(name: str) -> str:
    """Return the name in lower case with underscores between its words.

    `LineFollower` and `lineFollower` give `line_follower`. The mapping is not one-to-one: `AB` and `ab` give the same.
    """
    return _WORD.sub("_", name).lower()


def controller_name(robot: ex.NamedElement) -> str:
    """Return the name of a robot's package, node and executable: in snake case, ending in `_controller`."""
    name = snake_case(robot.name)
    return name if name == "controller" or name.endswith("_controller") else f"{name}_controller"


def layer_name(robot: ex.NamedElement) -> str:
    """Return the name of a robot's supervisory layer: in snake case, ending in `_layer`."""
    name = snake_case(robot.name)
    return name if name == "layer" or name.endswith("_layer") else f"{name}_layer"


def below_layer(name: str) -> str:
    """Return the controller's name of a topic, service or action below the layer's own name: `controller/scan`."""
    return f"controller/{name.removeprefix('/')}"


def escape(name: str, keywords: Collection[str]) -> str:
    """Return the name, with underscores appended if it equals a keyword up to underscores at the end.

    The mapping is one-to-one and never returns a keyword: if `if` is a keyword, `if` gives `if_`, and `if_` gives
    `if__`. Other names stay unchanged.
    """
    stem = name.rstrip("_")
    longest = max((len(keyword) for keyword in keywords if keyword.rstrip("_") == stem), default=None)
    return name if longest is None else name + "_" * (longest - len(stem) + 1)


def escape_keyword(name: str) -> str:
    """Return a name for a RoboSC text at a place where a keyword may stand."""
    return f"^{name}" if name in ROBOSC_KEYWORDS else name


def output_name(name: str) -> str:
    """Return a name as all output has it: `Cell2.enter` for `Cell[2].enter`. Other names stay unchanged.

    As in a model, `Cell[02]` is `Cell[2]`.
    """
    return _INSTANCE.sub(r"\1", name)


def enumeration(parts: Iterable[str]) -> str:
    """Return a list in words: `a, b or c`."""
    *others, last = parts
    return f"{', '.join(others)} or {last}" if others else last


class Names:
    """Names of one scope. Appends underscores to a name that is already taken.

    A set of taken names is not copied, so that many small scopes can share one large outer scope.
    """

    def __init__(self, taken: Iterable[str] = ()) -> None:
        self._outer = taken if isinstance(taken, Set) else frozenset(taken)
        self._taken: set[str] = set()

    def fresh(self, name: str) -> str:
        """Return a name that is free: the name itself, or the name with the fewest underscores appended.

        The result depends only on the names and their order. Marks the name as taken.
        """
        while name in self._taken or name in self._outer:
            name += "_"
        self._taken.add(name)
        return name
