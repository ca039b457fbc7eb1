"""Pictures: rectangles, paths and texts with coordinates, which one template prints as SVG."""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce
from operator import add
from typing import TYPE_CHECKING
from unicodedata import east_asian_width

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    Point = tuple[float, float]

MARGIN = 20.0
#: Height of the picture's title.
TITLE = 34.0
#: Widths of characters in a sans-serif face, in parts of its size; what is not named is 0.58 wide, East Asian 1.
_NARROW = dict.fromkeys("ijlI.,:;'|![]() ft", 0.36)
_WIDE = dict.fromkeys("mwMW@", 0.92) | dict.fromkeys("ABCDEFGHKNOPQRSUVXYZ", 0.7)


@dataclass(frozen=True)
class Box:
    """A rectangle of a kind, which the template's style sheet names, with a `note` to be shown on demand."""

    kind: str
    x: float
    y: float
    width: float
    height: float
    radius: float
    note: str


@dataclass(frozen=True)
class Line:
    """A path of a kind."""

    kind: str
    path: str


@dataclass(frozen=True)
class Text:
    """A line of text: where its baseline starts, or its middle in a style that centres it."""

    style: str
    x: float
    y: float
    text: str


@dataclass(frozen=True)
class Picture:
    """All there is to draw, in this order."""

    title: str
    width: float
    height: float
    boxes: Sequence[Box]
    lines: Sequence[Line]
    texts: Sequence[Text]


class Pen:
    """Collects what is drawn; coordinates given to it count from `origin`."""

    def __init__(self) -> None:
        self.boxes: list[Box] = []
        self.lines: list[Line] = []
        self.texts: list[Text] = []
        self.origin: Point = (0.0, 0.0)

    def text(self, style: str, x: float, y: float, text: str) -> None:
        """Writes a line of text."""
        self.texts.append(Text(style, *self._moved((x, y)), text))

    def box(self, kind: str, corner: Point, size: Point, radius: float, note: str = "") -> None:
        """Draws a rectangle with rounded corners, given its upper left corner, its width and its height."""
        width, height = map(coordinate, size)
        self.boxes.append(Box(kind, *self._moved(corner), width, height, radius, note))

    def line(self, kind: str, points: Sequence[Point], *, downwards: bool = False) -> None:
        """Draws straight lines along the axes, and curves between them; these leave and arrive level, or upright."""
        x, y = self._moved(points[0])
        drawn = f"M{x} {y}"
        for point in points[1:]:
            next_x, next_y = self._moved(point)
            if next_y == y:
                drawn += f"H{next_x}"
            elif next_x == x:
                drawn += f"V{next_y}"
            elif downwards:
                middle = coordinate((y + next_y) / 2)
                drawn += f"C{x} {middle} {next_x} {middle} {next_x} {next_y}"
            else:
                middle = coordinate((x + next_x) / 2)
                drawn += f"C{middle} {y} {middle} {next_y} {next_x} {next_y}"
            x, y = next_x, next_y
        self.lines.append(Line(kind, drawn))

    def tip(self, kind: str, corners: Sequence[Point], *, closed: bool = True) -> None:
        """Draws the shape at an end of a line, given its corners."""
        drawn = "L".join("{} {}".format(*self._moved(corner)) for corner in corners)
        self.lines.append(Line(kind, f"M{drawn}{'z' if closed else ''}"))

    def picture(self, title: str, width: float, height: float) -> Picture:
        """The picture of that title, as large as what is drawn and a margin around it."""
        return Picture(title, round(width + 2 * MARGIN), round(height + MARGIN), self.boxes, self.lines, self.texts)

    def _moved(self, point: Point) -> Point:
        return coordinate(self.origin[0] + point[0]), coordinate(self.origin[1] + point[1])


def text_width(text: str, size: float) -> float:
    """How wide a line of text is at most, about, in a face of that size."""
    widths = (
        _NARROW.get(character, _WIDE.get(character, 1.0 if east_asian_width(character) in "WF" else 0.58))
        for character in text
    )
    return size * total(widths)


def total(numbers: Iterable[float]) -> float:
    """Their sum, the same with each Python: `sum` rounds otherwise from 3.12 on."""
    return reduce(add, numbers, 0.0)


def coordinate(value: float) -> float:
    """A coordinate with a tenth of a pixel, so that no platform's rounding shows."""
    return round(value, 1) + 0.0
