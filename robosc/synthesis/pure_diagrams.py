"""Decision diagrams with complement edges in pure Python, for platforms without the library `oxidd`.

The classes have the names and the behavior of `oxidd`, as far as `robosc.synthesis.bdd` uses them. All diagrams have
the same nodes. Only the amount of garbage may differ.

An edge is an integer: twice the number of its node, plus 1 if it is the complement of the node's function. The edge to
the high child is never a complement, so a function has exactly one edge. Bryant: Graph-Based Algorithms for Boolean
Function Manipulation, 1986; Brace, Rudell, Bryant: Efficient Implementation of a BDD Package, 1990.
"""

from __future__ import annotations

import sys
from enum import Enum
from typing import TypeAlias
from weakref import WeakValueDictionary

#: Edge of a diagram.
Edge: TypeAlias = int
#: Level of a node, edge to its child for true, edge to its child for false.
Node: TypeAlias = tuple[int, Edge, Edge]

_TRUE, _FALSE = 0, 1
#: Number of the terminal node, and its level: below all variables.
_TERMINAL, _BOTTOM = 0, sys.maxsize
#: Frames for the callers of an operation, which itself needs one frame for each level.
_FRAMES = 1000


class DDMemoryError(MemoryError):
    """An operation needs more nodes than the capacity."""


class BooleanOperator(Enum):
    """Operators of `apply_exists`."""

    AND = 0


class BCDDFunction:
    """Boolean function. Equal functions are the same object."""

    __slots__ = ("__weakref__", "_edge", "_manager")

    def __init__(self, manager: BCDDManager, edge: Edge) -> None:
        self._manager = manager
        self._edge = edge

    def __invert__(self) -> BCDDFunction:
        return self._manager.function(self._edge ^ 1)

    def __and__(self, other: BCDDFunction) -> BCDDFunction:
        return self._manager.function(self._manager.conjunction(self._edge, other._edge))

    def __or__(self, other: BCDDFunction) -> BCDDFunction:
        return self._manager.function(self._manager.disjunction(self._edge, other._edge))

    def __xor__(self, other: BCDDFunction) -> BCDDFunction:
        return self._manager.function(self._manager.difference(self._edge, other._edge))

    def equiv(self, other: BCDDFunction) -> BCDDFunction:
        """Return the equivalence."""
        return self._manager.function(self._manager.difference(self._edge, other._edge) ^ 1)

    def imp(self, other: BCDDFunction) -> BCDDFunction:
        """Return the implication."""
        return self._manager.function(self._manager.disjunction(self._edge ^ 1, other._edge))

    def ite(self, high: BCDDFunction, low: BCDDFunction) -> BCDDFunction:
        """Return `high` where this function is true and `low` elsewhere."""
        return self._manager.function(self._manager.choice(self._edge, high._edge, low._edge))

    def exists(self, cube: BCDDFunction) -> BCDDFunction:
        """Return the function with the variables of `cube` quantified existentially."""
        return self._manager.function(self._manager.and_exists(self._edge, _TRUE, cube._edge))

    def apply_exists(self, _and: BooleanOperator, other: BCDDFunction, cube: BCDDFunction) -> BCDDFunction:
        """Return the conjunction with the variables of `cube` quantified existentially."""
        return self._manager.function(self._manager.and_exists(self._edge, other._edge, cube._edge))

    def satisfiable(self) -> bool:
        """Return whether the function is true for some values."""
        return self._edge != _FALSE

    def valid(self) -> bool:
        """Return whether the function is true for all values."""
        return self._edge == _TRUE

    def cofactors(self) -> tuple[BCDDFunction, BCDDFunction] | None:
        """Return the functions for a true and a false topmost variable, or None for a constant."""
        if self._edge <= _FALSE:
            return None
        _, high, low = self._manager.children(self._edge)
        return self._manager.function(high), self._manager.function(low)

    def node_level(self) -> int | None:
        """Return the level of the topmost variable, or None for a constant."""
        return self._manager.children(self._edge)[0] if self._edge > _FALSE else None

    def node_count(self) -> int:
        """Return the number of nodes, including the terminal one."""
        return len(self._manager.reachable([self._edge]))

    def sat_count(self, variables: int) -> int:
        """Return the number of satisfying values of so many variables, among them all on which the function depends."""
        return self._manager.count(self._edge, variables)


class BCDDManager:
    """Nodes of decision diagrams: at most `capacity`, and at most `cached` results of operations."""

    def __init__(self, capacity: int, cached: int, _threads: int = 1) -> None:
        self._capacity = capacity
        self._cached = cached
        self._levels = self._collections = 0
        self._next = _TERMINAL + 1
        self._nodes: dict[int, Node] = {_TERMINAL: (_BOTTOM, _TRUE, _TRUE)}
        self._numbers: dict[Node, int] = {}
        #: Edge of each result. A conjunction has two operands, `difference` a third one that no other operation has.
        self._results: dict[tuple[Edge, ...], Edge] = {}
        #: Functions in use, by their edges. A garbage collection keeps their nodes.
        self._functions: WeakValueDictionary[Edge, BCDDFunction] = WeakValueDictionary()

    def add_vars(self, number: int) -> None:
        """Add variables below those that exist."""
        self._levels += number
        sys.setrecursionlimit(max(sys.getrecursionlimit(), self._levels + _FRAMES))

    def var(self, level: int) -> BCDDFunction:
        """Return the function of the variable of a level."""
        return self.function(self._edge(level, _TRUE, _FALSE))

    def true(self) -> BCDDFunction:
        """Return the function that is always true."""
        return self.function(_TRUE)

    def false(self) -> BCDDFunction:
        """Return the function that is always false."""
        return self.function(_FALSE)

    def approx_num_inner_nodes(self) -> int:
        """Return the number of nodes, including garbage, without the terminal one."""
        return len(self._numbers)

    def gc_count(self) -> int:
        """Return the number of garbage collections."""
        return self._collections

    def gc(self) -> None:
        """Remove all nodes that no function in use needs."""
        self._collections += 1
        self._results.clear()
        used = self.reachable([_TRUE, *self._functions.keys()])
        self._nodes = {number: node for number, node in self._nodes.items() if number in used}
        self._numbers = {node: number for number, node in self._nodes.items() if number != _TERMINAL}

    def function(self, edge: Edge) -> BCDDFunction:
        """Return the function of an edge."""
        known = self._functions.get(edge)
        if known is None:
            self._functions[edge] = known = BCDDFunction(self, edge)
        return known

    def children(self, edge: Edge) -> Node:
        """Return the level of an edge and the edges to the functions for a true and a false variable of this level."""
        level, high, low = self._nodes[edge >> 1]
        return (level, high ^ 1, low ^ 1) if edge & 1 else (level, high, low)

    def reachable(self, edges: list[Edge]) -> set[int]:
        """Return the numbers of the nodes that edges lead to."""
        numbers: set[int] = set()
        pending = [edge >> 1 for edge in edges]
        while pending:
            number = pending.pop()
            if number not in numbers:
                numbers.add(number)
                _, high, low = self._nodes[number]
                pending += (high >> 1, low >> 1)
        return numbers

    def count(self, edge: Edge, variables: int) -> int:
        """Return the number of satisfying values of an edge, as `BCDDFunction.sat_count`."""
        every = 1 << max(variables, self._levels)
        counts = {_TERMINAL: every}
        # A child has a greater level than its parents, so its count is ready before theirs.
        inner = sorted(self.reachable([edge]) - {_TERMINAL}, key=lambda number: -self._nodes[number][0])
        for number in inner:
            _, high, low = self._nodes[number]
            below = counts[low >> 1]
            counts[number] = (counts[high >> 1] + (every - below if low & 1 else below)) >> 1
        count = counts[edge >> 1]
        return (every - count if edge & 1 else count) >> (max(variables, self._levels) - variables)

    def _edge(self, level: int, high: Edge, low: Edge) -> Edge:
        """Return the edge of a variable with two children. Raises DDMemoryError if there is no room for its node."""
        if high == low:
            return high
        complement = high & 1
        node = (level, high ^ complement, low ^ complement)
        number = self._numbers.get(node)
        if number is None:
            if len(self._numbers) >= self._capacity:
                raise DDMemoryError
            if len(self._results) >= self._cached:
                self._results.clear()
            number = self._next
            self._next += 1
            self._nodes[number] = node
            self._numbers[node] = number
        return number << 1 | complement

    def _cofactors(self, left: Edge, right: Edge) -> tuple[int, Edge, Edge, Edge, Edge]:
        """Return the upper level of two edges, and their edges for a true and a false variable of this level."""
        level, left_high, left_low = self.children(left)
        right_level, right_high, right_low = self.children(right)
        if level < right_level:
            right_high = right_low = right
        elif level > right_level:
            level, left_high, left_low = right_level, left, left
        return level, left_high, left_low, right_high, right_low

    def conjunction(self, left: Edge, right: Edge) -> Edge:
        """Return the conjunction of two edges."""
        if left > right:
            left, right = right, left
        if left <= _FALSE:
            return right if left == _TRUE else _FALSE
        if left >> 1 == right >> 1:
            return left if left == right else _FALSE
        key = (left, right)
        result = self._results.get(key)
        if result is None:
            level, left_high, left_low, right_high, right_low = self._cofactors(left, right)
            high = self.conjunction(left_high, right_high)
            result = self._edge(level, high, self.conjunction(left_low, right_low))
            self._results[key] = result
        return result

    def disjunction(self, left: Edge, right: Edge) -> Edge:
        """Return the disjunction of two edges."""
        return self.conjunction(left ^ 1, right ^ 1) ^ 1

    def difference(self, left: Edge, right: Edge) -> Edge:
        """Return the exclusive disjunction of two edges."""
        complement = (left ^ right) & 1
        left, right = left & ~1, right & ~1
        if left > right:
            left, right = right, left
        if left == right:
            return _FALSE ^ complement
        if left == _TRUE:
            return right ^ complement ^ 1
        key = (left, right, -1)
        result = self._results.get(key)
        if result is None:
            level, left_high, left_low, right_high, right_low = self._cofactors(left, right)
            high = self.difference(left_high, right_high)
            result = self._edge(level, high, self.difference(left_low, right_low))
            self._results[key] = result
        return result ^ complement

    def choice(self, condition: Edge, then: Edge, other: Edge) -> Edge:
        """Return `then` where the condition is true and `other` elsewhere."""
        if condition & 1:
            condition, then, other = condition ^ 1, other, then
        if condition == _TRUE:
            return then
        if then >> 1 == condition >> 1:
            then = _TRUE if then == condition else _FALSE
        if other >> 1 == condition >> 1:
            other = _FALSE if other == condition else _TRUE
        if then == other:
            return then
        if then <= _FALSE:
            return self.disjunction(condition, other) if then == _TRUE else self.conjunction(condition ^ 1, other)
        if other <= _FALSE:
            return self.conjunction(condition, then) if other == _FALSE else self.disjunction(condition ^ 1, then)
        key = (condition, then, other)
        result = self._results.get(key)
        if result is None:
            nodes = [self.children(edge) for edge in key]
            level = min(node[0] for node in nodes)
            pairs = [node[1:] if node[0] == level else (edge, edge) for node, edge in zip(nodes, key, strict=True)]
            high = self.choice(pairs[0][0], pairs[1][0], pairs[2][0])
            result = self._edge(level, high, self.choice(pairs[0][1], pairs[1][1], pairs[2][1]))
            self._results[key] = result
        return result

    def and_exists(self, left: Edge, right: Edge, cube: Edge) -> Edge:
        """Return the conjunction of two edges with the variables of `cube` quantified existentially."""
        if left > right:
            left, right = right, left
        if left == _FALSE or left ^ 1 == right:
            return _FALSE
        if left == right:
            left = _TRUE
        level = min(self._nodes[left >> 1][0], self._nodes[right >> 1][0])
        cube_level, rest, _ = self._nodes[cube >> 1]
        while cube_level < level:
            cube = rest
            cube_level, rest, _ = self._nodes[cube >> 1]
        if cube == _TRUE:
            return self.conjunction(left, right)
        key = (left, right, ~cube)
        result = self._results.get(key)
        if result is None:
            _, left_high, left_low, right_high, right_low = self._cofactors(left, right)
            high = self.and_exists(left_high, right_high, cube)
            if level != cube_level:
                result = self._edge(level, high, self.and_exists(left_low, right_low, cube))
            elif high == _TRUE:
                result = _TRUE
            else:
                result = self.disjunction(high, self.and_exists(left_low, right_low, cube))
            self._results[key] = result
        return result
