"""What is not known of a text because of its syntax errors."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum, auto
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robosc.diagnostics import Span


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
class SkippedRegions:
    """The names that skipped text seems to declare, and where it stands.

    `nameless` are the kinds of which a declaration was skipped whose name can't be seen, and where; `mended` says
    whether braces had to be added or taken away. `skipped` are the ranges of the text that were skipped,
    `uncertain` those of items that are whole, but that something unknown follows (offsets, the end exclusive).
    """

    names: set[str] = field(default_factory=set)
    nameless: list[tuple[Declared, Span]] = field(default_factory=list)
    mended: bool = False
    skipped: list[tuple[int, int]] = field(default_factory=list)
    uncertain: list[tuple[int, int]] = field(default_factory=list)

    def may_declare(self, name: str, kinds: tuple[Declared, ...], within: Span | None = None) -> bool:
        """Whether a name of one of these kinds that is not found may be declared in skipped text.

        Only a declaration within a definition can declare a member of it, unless braces were mended: then nobody knows
        what was meant to stand where.
        """
        if name in self.names:
            return True
        span = None if self.mended else within
        return any(kind in kinds and (span is None or span.contains(place)) for kind, place in self.nameless)

    def is_uncertain(self, offset: int) -> bool:
        """Whether what stands at an offset may not mean what it seems to."""
        return any(start <= offset < end for start, end in self.uncertain)
