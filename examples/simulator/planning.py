"""The shortest way over a grid, around what is in it."""

from __future__ import annotations

import heapq
import math

CELL = 0.1
_NEIGHBOURS = [(dx, dy) for dx in (-1, 0, 1) for dy in (-1, 0, 1) if dx or dy]


class Grid:
    """A plane in squares, those blocked into which the robot's centre can't go."""

    def __init__(self, clearance, blocked=()):
        """`clearance` is the distance that the robot's centre keeps from all that is blocked from now on."""
        self._clearance = clearance
        self._near = math.ceil(clearance / CELL)
        self.blocked = set(blocked)

    @staticmethod
    def cell(x, y):
        """The square that a point is in."""
        return math.floor(x / CELL), math.floor(y / CELL)

    @staticmethod
    def centre(cell):
        """The middle of a square."""
        return (cell[0] + 0.5) * CELL, (cell[1] + 0.5) * CELL

    def block(self, x, y):
        """Keeps the robot clear of a point."""
        column, row = self.cell(x, y)
        for dx in range(-self._near, self._near + 1):
            for dy in range(-self._near, self._near + 1):
                cell = column + dx, row + dy
                near_x, near_y = self.centre(cell)
                if math.hypot(near_x - x, near_y - y) < self._clearance:
                    self.blocked.add(cell)

    def block_wall(self, wall):
        """Keeps the robot clear of a wall."""
        length = math.hypot(wall.x2 - wall.x1, wall.y2 - wall.y1)
        pieces = max(1, math.ceil(length / (CELL / 2)))
        for piece in range(pieces + 1):
            share = piece / pieces
            self.block(wall.x1 + (wall.x2 - wall.x1) * share, wall.y1 + (wall.y2 - wall.y1) * share)

    def way(self, start, end, furthest=400):
        """The points of the shortest way from one point to another; None where there is none within `furthest` squares.

        Next to the start nothing is blocked: the robot is there, and has to get away.
        """
        first, last = self.cell(*start), self.cell(*end)
        if last in self.blocked:
            return None
        came_from, costs = {first: None}, {first: 0.0}
        queue = [(0.0, first)]
        # Whether the end is shut in is looked at from there: from outside all squares within reach would be looked at.
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
        """The squares next to one that are not known yet, which they are from now on."""
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
