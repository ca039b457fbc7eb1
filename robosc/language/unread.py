"""What is not known of a text because of its syntax errors."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum, auto


class Declared(Enum):
    """What a declaration gives a name to."""

    COMPONENT = auto()
    INTERFACE = auto()
    DATA_TYPE = auto()
    PROPERTY = auto()
    ENUM_VALUE = auto()
    COMMUNICATION = auto()
    MEMBER = auto()  # a variable or a state


@dataclass
class Unread:
    """The names that skipped text seems to declare, and where it stands.

    `nameless` are the kinds of which a declaration was skipped whose name can't be seen; `ranges` are the texts that
    were skipped, `doubtful` also the items that something unknown follows (offsets, the end exclusive).
    """

    names: set[str] = field(default_factory=set)
    nameless: set[Declared] = field(default_factory=set)
    ranges: list[tuple[int, int]] = field(default_factory=list)
    doubtful: list[tuple[int, int]] = field(default_factory=list)

    def may_declare(self, name: str, kinds: tuple[Declared, ...]) -> bool:
        """Whether a name of one of these kinds that is not found may be declared in skipped text."""
        return name in self.names or not self.nameless.isdisjoint(kinds)

    def is_doubtful(self, offset: int) -> bool:
        """Whether what stands at an offset may not mean what it seems to."""
        return any(start <= offset < end for start, end in self.doubtful)
