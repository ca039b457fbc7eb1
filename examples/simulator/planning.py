"""The shortest way over a grid around obstacles."""

from __future__ import annotations

import heapq
import math

CELL = 0.1
_NEIGHBOURS = [(dx, dy) for dx in (-1, 0, 1) for dy in (-1, 0, 1) if dx or dy]


class Grid:
    """A plane of squares. A square is blocked if the robot's center can't enter it."""

    def __init__(self, clearance, blocked=()):
        """Create the grid. `clearance` is the distance that the robot's center keeps from obstacles added later."""
        self._clearance = clearance
        self._near = math.ceil(clearance / CELL)
        self.blocked = set(blocked)

    @staticmethod
    def cell(x, y):
        """Return the square that contains a point."""
        return math.floor(x / CELL), math.floor(y / CELL)

    @staticmethod
    def centre(cell):
        """Return the middle of a square."""
        return (cell[0] + 0.5) * CELL, (cell[1] + 0.5) * CELL

    def block(self, x, y):
        """Add a point as an obstacle."""
        column, row = self.cell(x, y)
        for dx in range(-self._near, self._near + 1):
            for dy in range(-self._near, self._near + 1):
                cell = column + dx, row + dy
                near_x, near_y = self.centre(cell)
                if math.hypot(near_x - x, near_y - y) < self._clearance:
                    self.blocked.add(cell)

    def block_wall(self, wall):
        """Add a wall as an obstacle."""
        length = math.hypot(wall.x2 - wall.x1, wall.y2 - wall.y1)
        pieces = max(1, math.ceil(length / (CELL / 2)))
        for piece in range(pieces + 1):
            share = piece / pieces
            self.block(wall.x1 + (wall.x2 - wall.x1) * share, wall.y1 + (wall.y2 - wall.y1) * share)

    def way(self, start, end, furthest=400):
        """Return the points of the shortest way between two points. None if there is none within `furthest` squares.

        Squares next to the start count as free: the robot is there, and has to get away.
        """
        first, last = self.cell(*start), self.cell(*end)
        if last in self.blocked:
            return None
        came_from, costs = {first: None}, {first: 0.0}
        queue = [(0.0, first)]
        # Check from the end whether the end is enclosed: from outside, the search would visit all squares within reach.
        around_end, pending = {last}, [last]
        while queue and (pending or first in around_end):
            if first not in around_end:
                pending += self._around(pending.pop(), first, around_end)
            _, cell = heapq.heappop(queue)
            if cell == last:
                return self._points(came_from, last, end)
            for dx, dy in _NEIGHBOURS:
                there = cell[0] + dx, cell[1] + dy
                cost = costs[cell] + math.hypot(dx, dy)
                if self._is_blocked(there, first):
                    continue
                if cost > furthest or costs.get(there, math.inf) <= cost:
                    continue
                costs[there], came_from[there] = cost, cell
                heapq.heappush(queue, (cost + math.hypot(last[0] - there[0], last[1] - there[1]), there))
        return None

    def _is_blocked(self, cell, first):
        return cell in self.blocked and max(abs(cell[0] - first[0]), abs(cell[1] - first[1])) > 1

    def _around(self, cell, first, known):
        """Return the neighbors of a square that are not known yet, and add them to the known ones."""
        squares = ((cell[0] + dx, cell[1] + dy) for dx, dy in _NEIGHBOURS)
        new = [square for square in squares if square not in known and not self._is_blocked(square, first)]
        known.update(new)
        return new

    def _points(self, came_from, last, end):
        points, cell = [end], came_from[last]
        while cell is not None:
            points.append(self.centre(cell))
            cell = came_from[cell]
        return points[::-1]
