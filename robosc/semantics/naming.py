"""Names in generated text: snake case, keywords escaped one-to-one, clashes resolved."""

from __future__ import annotations

import re
from collections.abc import Set
from typing import TYPE_CHECKING

from robosc.files.resources import locate

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable

    from robosc.metamodel import expression as ex

_GRAMMAR = locate("grammar/robosc.tx").read_text(encoding="utf-8")


def _words(pattern: str) -> list[str]:
    """The words that are the group of a pattern of the grammar."""
    found = re.search(pattern, _GRAMMAR, re.MULTILINE)
    assert found
    return found[1].split("|")


#: The words of RoboSC that a name in an expression has a `^` before.
ROBOSC_KEYWORDS = frozenset(_words(r"^UnreservedName:\s*/\(\?!\(\?:([a-z|]+)\)"))
#: The names of its functions.
ROBOSC_FUNCTIONS = tuple(_words(r"^BuiltIn: /\(\?:([a-z0-9|]+)\)"))
#: The words that begin a condition on the elements of an array, or on what was made of a template.
ROBOSC_QUANTIFIERS = tuple(_words(r"^Quantifier: /\(([a-z|]+)\)"))
_WORD = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")


def snake_case(name: str) -> str:
    """The name in lower case, underscores between its words: `LineFollower` and `lineFollower` give `line_follower`.

    Not one-to-one: `AB` and `ab` give the same.
    """
    return _WORD.sub("_", name).lower()


def controller_name(robot: ex.NamedElement) -> str:
    """The name of a robot's package, node and executable: in snake case, ending in `_controller`."""
    name = snake_case(robot.name)
    return name if name == "controller" or name.endswith("_controller") else f"{name}_controller"


def layer_name(robot: ex.NamedElement) -> str:
    """The same for the supervisory layer before a robot: ending in `_layer`."""
    name = snake_case(robot.name)
    return name if name == "layer" or name.endswith("_layer") else f"{name}_layer"


def below_layer(name: str) -> str:
    """The name of a topic, service or action for the controller, below the layer's own name: `controller/scan`."""
    return f"controller/{name.removeprefix('/')}"


def escape(name: str, keywords: Collection[str]) -> str:
    """The name, with underscores behind it where a keyword differs from it in underscores at the end only.

    No two names are escaped to the same, and none to a keyword: where `if` is a keyword, `if` gives `if_`, `if_`
    gives `if__`. Everything else stays as it is.
    """
    stem = name.rstrip("_")
    longest = max((len(keyword) for keyword in keywords if keyword.rstrip("_") == stem), default=None)
    return name if longest is None else name + "_" * (longest - len(stem) + 1)


def written(name: str) -> str:
    """A name as a RoboSC text has it where a keyword could stand."""
    return f"^{name}" if name in ROBOSC_KEYWORDS else name


def enumeration(parts: Iterable[str]) -> str:
    """`a, b or c`."""
    *others, last = parts
    return f"{', '.join(others)} or {last}" if others else last


class Names:
    """The names of one scope; one that is taken gets underscores.

    A set of taken names is not copied, so that many scopes can stand beside each other within a large one.
    """

    def __init__(self, taken: Iterable[str] = ()) -> None:
        self._outer = taken if isinstance(taken, Set) else frozenset(taken)
        self._taken: set[str] = set()

    def fresh(self, name: str) -> str:
        """The name itself where it is free, else the name with as few underscores behind it as make it so.

        The same names in the same order give the same result. The name is taken from then on.
        """
        while name in self._taken or name in self._outer:
            name += "_"
        self._taken.add(name)
        return name
