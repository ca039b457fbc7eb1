"""A drawing (SVG) of a run: walls, the line, the paths of all moving things, and the places of events."""

from __future__ import annotations

import math
from xml.sax.saxutils import escape

#: Pixels: the margin around the drawing; the height of a line of text.
MARGIN, LINE = 24, 18
WAYS = {
    "robot": "stroke='#1f5fa8' stroke-width='2.5'",
    "ball": "stroke='#c0392b' stroke-width='2' stroke-dasharray='5 3'",
    "person": "stroke='#7d4ca0' stroke-width='2' stroke-dasharray='5 3'",
}


def picture(simulation):
    """Return the drawing of a simulation as it is now, as text. It is the same for the same run."""
    return "\n".join(_Drawing(simulation).elements()) + "\n"


class _Drawing:
    """Conversion of meters, with y upwards, into pixels, with y downwards."""

    def __init__(self, simulation):
        self.simulation = simulation
        world = simulation.world
        self.scale = simulation.scenario.scale
        xs = [x for x, _ in self._points()]
        ys = [y for _, y in self._points()]
        self.left, self.top = min(xs) - 0.25, max(ys) + 0.25
        self.width = (max(xs) + 0.25 - self.left) * self.scale + 2 * MARGIN
        self.height = (self.top - min(ys) + 0.25) * self.scale + 2 * MARGIN
        self.world = world

    def _points(self):
        world, ways = self.simulation.world, self.simulation.ways
        for wall in world.walls:
            yield wall.x1, wall.y1
            yield wall.x2, wall.y2
        yield from world.line
        for area in self.simulation.areas:
            yield area.x1, area.y1
            yield area.x2, area.y2
        for way in ways.values():
            yield from way

    def elements(self):
        said = [f"{happening.time:5.1f} s  {happening.words}" for happening in self.simulation.happenings]
        width = max(self.width, 2 * MARGIN + 300)
        height = self.height + LINE * (len(said) + 2)
        title = self.simulation.scenario.name.replace("_", " ")
        yield (
            f"<svg xmlns='http://www.w3.org/2000/svg' width='{width:.0f}' height='{height:.0f}' "
            f"viewBox='0 0 {width:.0f} {height:.0f}' font-family='sans-serif' font-size='12'>"
        )
        yield f"<title>{escape(title)}</title>"
        yield f"<rect width='{width:.0f}' height='{height:.0f}' fill='white'/>"
        yield from self._place()
        for name, style in WAYS.items():
            if self.simulation.ways[name]:
                yield f"<polyline points='{self._way(self.simulation.ways[name])}' fill='none' {style}/>"
        yield from self._things()
        yield from self._marks()
        for number, words in enumerate(said):
            y = self.height + LINE * (number + 0.5)
            yield f"<text x='{MARGIN}' y='{y:.1f}' xml:space='preserve'>{number + 1:>2}  {escape(words)}</text>"
        yield "</svg>"

    def _place(self):
        world = self.world
        for area in self.simulation.areas:
            yield self._rectangle(area.x1, area.y1, area.x2, area.y2, area.colour)
            x, y = self._at(area.x1, area.y2)
            if area.name:
                yield f"<text x='{x + 4:.1f}' y='{y + 13:.1f}' fill='#777'>{escape(area.name)}</text>"
        if world.goal:
            yield self._rectangle(*world.goal, "#cfe8cf")
        if world.line:
            yield f"<polyline points='{self._way(world.line[::5])}' fill='none' stroke='#f2c200' stroke-width='6'/>"
        for wall in world.walls:
            (x1, y1), (x2, y2) = self._at(wall.x1, wall.y1), self._at(wall.x2, wall.y2)
            yield (
                f"<line x1='{x1:.1f}' y1='{y1:.1f}' x2='{x2:.1f}' y2='{y2:.1f}' "
                "stroke='#444' stroke-width='4' stroke-linecap='round'/>"
            )
        for pillar in self.simulation.pillars:
            yield self._disc(pillar.x, pillar.y, pillar.radius, "fill='#999'")
        for sight in world.sights:
            x, y = self._at(sight.x, sight.y)
            yield f"<text x='{x:.1f}' y='{y:.1f}' text-anchor='end' fill='#c0392b'>{escape(sight.name)}</text>"

    def _things(self):
        world = self.world
        if world.ball:
            yield self._disc(world.ball.x, world.ball.y, world.ball.radius, "fill='#e05545'")
        if world.person:
            yield self._disc(world.person.x, world.person.y, world.person.radius, "fill='#b58fd0'")
        pose = world.pose
        yield self._disc(pose.x, pose.y, 0.14, "fill='#9cc3ec' stroke='#1f5fa8'")
        (x1, y1), (x2, y2) = self._at(pose.x, pose.y), self._at(*pose.ahead(0.14))
        yield f"<line x1='{x1:.1f}' y1='{y1:.1f}' x2='{x2:.1f}' y2='{y2:.1f}' stroke='#1f5fa8' stroke-width='2'/>"

    def _marks(self):
        """Yield numbers at the places of events. Numbers at one place are side by side."""
        taken = []
        for number, happening in enumerate(self.simulation.happenings):
            x, y = self._at(happening.x, happening.y)
            while any(math.dist((x, y), other) < 17 for other in taken):
                x += 17
            taken.append((x, y))
            yield f"<circle cx='{x:.1f}' cy='{y:.1f}' r='8' fill='white' stroke='#1f5fa8'/>"
            yield f"<text x='{x:.1f}' y='{y + 3.5:.1f}' font-size='10' text-anchor='middle'>{number + 1}</text>"

    def _rectangle(self, x1, y1, x2, y2, colour):
        x, y = self._at(x1, y2)
        width, height = (x2 - x1) * self.scale, (y2 - y1) * self.scale
        return f"<rect x='{x:.1f}' y='{y:.1f}' width='{width:.1f}' height='{height:.1f}' fill='{colour}'/>"

    def _disc(self, x, y, radius, style):
        x, y = self._at(x, y)
        return f"<circle cx='{x:.1f}' cy='{y:.1f}' r='{radius * self.scale:.1f}' {style}/>"

    def _way(self, points):
        """Return the points of a polyline. Consecutive points at the same pixel are merged."""
        shown = [f"{x:.1f},{y:.1f}" for x, y in (self._at(*point) for point in points)]
        kept = [image for before, image in zip([None, *shown], shown) if image != before]  # noqa: B905  # old Pythons
        return " ".join(kept)

    def _at(self, x, y):
        return (x - self.left) * self.scale + MARGIN, (self.top - y) * self.scale + MARGIN
