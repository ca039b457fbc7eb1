"""Measures and paths that drawings of all kinds share."""

from __future__ import annotations

from typing import TYPE_CHECKING
from unicodedata import east_asian_width

if TYPE_CHECKING:
    from collections.abc import Sequence

    Point = tuple[float, float]

#: Widths of characters in a sans-serif face, in parts of its size; what is not named is 0.58 wide, East Asian 1.
_NARROW = dict.fromkeys("ijlI.,:;'|![]() ft", 0.36)
_WIDE = dict.fromkeys("mwMW@", 0.92) | dict.fromkeys("ABCDEFGHKNOPQRSUVXYZ", 0.7)


def text_width(text: str, size: float) -> float:
    """How wide a line of text is at most, about, in a face of that size."""
    return size * sum(
        _NARROW.get(character, _WIDE.get(character, 1.0 if east_asian_width(character) in "WF" else 0.58))
        for character in text
    )


def coordinate(value: float) -> float:
    """A coordinate with a tenth of a pixel, so that no platform's rounding shows."""
    return round(value, 1) + 0.0


def path(points: Sequence[Point], *, downwards: bool = False) -> str:
    """Straight lines along the axes, and curves that leave and arrive level (or, `downwards`, upright) between them."""
    x, y = points[0]
    drawn = f"M{coordinate(x)} {coordinate(y)}"
    for next_x, next_y in points[1:]:
        end = f"{coordinate(next_x)} {coordinate(next_y)}"
        if coordinate(next_y) == coordinate(y):
            drawn += f"H{coordinate(next_x)}"
        elif coordinate(next_x) == coordinate(x):
            drawn += f"V{coordinate(next_y)}"
        elif downwards:
            middle = coordinate((y + next_y) / 2)
            drawn += f"C{coordinate(x)} {middle} {coordinate(next_x)} {middle} {end}"
        else:
            middle = coordinate((x + next_x) / 2)
            drawn += f"C{middle} {coordinate(y)} {middle} {coordinate(next_y)} {end}"
        x, y = next_x, next_y
    return drawn
