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
#: Character widths of a sans-serif font, relative to its size; the default is 0.58, and 1 for East Asian characters.
_NARROW = dict.fromkeys("ijlI.,:;'|![]() ft", 0.36)
_WIDE = dict.fromkeys("mwMW@", 0.92) | dict.fromkeys("ABCDEFGHKNOPQRSUVXYZ", 0.7)


@dataclass(frozen=True)
class Box:
    """A rectangle of a kind from the template's style sheet, with a `note` that is shown on demand."""

    kind: str
    x: float
    y: float
    width: float
    height: float
    radius: float
    note: str


@dataclass(frozen=True)
class Line:
    """A path of a kind from the template's style sheet."""

    kind: str
    path: str


@dataclass(frozen=True)
class Text:
    """A line of text: the start of its baseline, or its middle in a centered style."""

    style: str
    x: float
    y: float
    text: str


@dataclass(frozen=True)
class Picture:
    """All parts of a picture in drawing order."""

    title: str
    width: float
    height: float
    boxes: Sequence[Box]
    lines: Sequence[Line]
    texts: Sequence[Text]


class Pen:
    """Collects the parts of a picture; coordinates are relative to `origin`."""

    def __init__(self) -> None:
        self.boxes: list[Box] = []
        self.lines: list[Line] = []
        self.texts: list[Text] = []
        self.origin: Point = (0.0, 0.0)

    def text(self, style: str, x: float, y: float, text: str) -> None:
        """Write a line of text."""
        self.texts.append(Text(style, *self._moved((x, y)), text))

    def box(self, kind: str, corner: Point, size: Point, radius: float, note: str = "") -> None:
        """Draw a rectangle with rounded corners from its upper left corner and its size."""
        width, height = map(coordinate, size)
        self.boxes.append(Box(kind, *self._moved(corner), width, height, radius, note))

    def line(self, kind: str, points: Sequence[Point], *, downwards: bool = False) -> None:
        """Draw straight lines along the axes, and curves between them with horizontal (or vertical) ends."""
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
        """Draw the shape at an end of a line from its corners."""
        drawn = "L".join("{} {}".format(*self._moved(corner)) for corner in corners)
        self.lines.append(Line(kind, f"M{drawn}{'z' if closed else ''}"))

    def picture(self, title: str, width: float, height: float) -> Picture:
        """Return the picture with a title, as large as its contents and a margin around them."""
        return Picture(title, round(width + 2 * MARGIN), round(height + MARGIN), self.boxes, self.lines, self.texts)

    def _moved(self, point: Point) -> Point:
        return coordinate(self.origin[0] + point[0]), coordinate(self.origin[1] + point[1])


def text_width(text: str, size: float) -> float:
    """Return an estimate of the maximum width of a line of text in a font of this size."""
    widths = (
        _NARROW.get(character, _WIDE.get(character, 1.0 if east_asian_width(character) in "WF" else 0.58))
        for character in text
    )
    return size * total(widths)


def total(numbers: Iterable[float]) -> float:
    """Return the sum of numbers, the same in each Python version: `sum` rounds differently from 3.12 on."""
    return reduce(add, numbers, 0.0)


def coordinate(value: float) -> float:
    """Return a coordinate rounded to a tenth of a pixel, so that the result is the same on all platforms."""
    return round(value, 1) + 0.0
