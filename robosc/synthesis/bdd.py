"""Wrapper of the library of decision diagrams, `oxidd.bcdd`, on one thread; no other module uses the library.

Where the library is not installed, `pure_diagrams` replaces it, with the same results in more time.
"""

from __future__ import annotations

from functools import reduce
from operator import and_, or_
from typing import TYPE_CHECKING, TypeAlias, cast

from robosc.synthesis.memory import TooFewAddressesError, address_space, limit_memory
from robosc.synthesis.statistics import Statistics

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from typing import TypeVar

    T = TypeVar("T")

try:
    from oxidd.bcdd import BCDDFunction, BCDDManager
    from oxidd.util import BooleanOperator, DDMemoryError

    #: Whether the decision diagrams are those in pure Python.
    IS_PURE = False
except ImportError:
    if not TYPE_CHECKING:
        from robosc.synthesis.pure_diagrams import BCDDFunction, BCDDManager, BooleanOperator, DDMemoryError

    IS_PURE = True

#: Error of an operation that runs out of room for nodes.
OutOfRoomError = DDMemoryError
#: Boolean function over the variables of its `Diagrams`. Equal functions compare equal and have the same hash. It
#: offers `& | ^ ~`, `equiv`, `imp`, `ite`, `exists(cube)`, `satisfiable`, `valid`, `sat_count`, `node_count`.
Diagram: TypeAlias = BCDDFunction

#: Measured size of a node with its share of the operation cache, in bytes.
_BYTES_PER_NODE = 500 if IS_PURE else 40
#: Measured address space of the library without nodes, in bytes. Most of it is the stack of its thread.
_LIBRARY = (1 << 30) + (192 << 20)
_FIRST_CAPACITY = 1 << 18
#: Allocating room takes time: diagrams of at most `_FEW_LEVELS` levels begin with `_SMALL_CAPACITY` nodes. Diagrams of
#: at least `_MANY_LEVELS` levels begin with `_LARGE_CAPACITY` nodes.
_FEW_LEVELS, _SMALL_CAPACITY, _MANY_LEVELS, _LARGE_CAPACITY = 64, 1 << 15, 200, 1 << 20
#: Growth factor of the capacity. A restart takes more time than unused room, so the factor is high.
_GROWTH = 8
#: Share of the capacity shortly before the library collects garbage by itself, and the largest share that may still be
#: in use after a collection.
_FULL = 0.94
_TOO_FULL = 0.75


class _Conjunction:
    """Conjunction operator with a plain `value`. The `value` of an `Enum` takes a third of the time of a call."""

    value = BooleanOperator.AND.value


_AND = cast("BooleanOperator", _Conjunction())


class Diagrams:
    """Decision diagrams over a fixed number of variables; a variable's number is its level, 0 at the top."""

    def __init__(self, levels: int, capacity: int, statistics: Statistics | None = None) -> None:
        """Allocate room for `capacity` nodes; an operation that needs more raises DDMemoryError.

        The diagrams update `statistics`.
        """
        _refuse_where_addresses_lack(capacity)
        self._manager = BCDDManager(capacity, capacity, 1)
        self._manager.add_vars(levels)
        self._capacity = capacity
        self._full = capacity * _FULL
        self._crowded = capacity // 2
        self._collections = self._manager.gc_count()
        self.statistics = statistics or Statistics()
        self.levels = levels
        self._variables = [self._manager.var(level) for level in range(levels)]
        self.true = self._manager.true()
        self.false = self._manager.false()

    def variable(self, level: int) -> Diagram:
        """Return the function of one variable."""
        return self._variables[level]

    def all_of(self, parts: Iterable[Diagram]) -> Diagram:
        """Return the conjunction, from the first part to the last; true for no parts."""
        return reduce(and_, parts, self.true)

    def any_of(self, parts: Iterable[Diagram]) -> Diagram:
        """Return the disjunction, from the first part to the last; false for no parts."""
        return reduce(or_, parts, self.false)

    def cube(self, levels: Iterable[int]) -> Diagram:
        """Return the conjunction of the variables. Quantification takes its variables in this form."""
        result = self.true
        for level in sorted(levels, reverse=True):
            result = self.variable(level) & result
        return result

    def tidy(self) -> None:
        """Count the nodes and collect garbage early. Call it regularly between operations.

        If room gets really short, the library collects garbage on a thread of its own, and runs are no longer
        reproducible. DDMemoryError is raised before that.
        """
        manager, statistics = self._manager, self.statistics
        nodes = manager.approx_num_inner_nodes()
        if nodes > statistics.peak_nodes:  # noqa: PLR1730 - `max` takes twice as long
            statistics.peak_nodes = nodes
        if nodes > self._full or manager.gc_count() != self._collections:
            raise DDMemoryError
        if nodes > self._crowded:
            manager.gc()
            self._collections = manager.gc_count()
            left = manager.approx_num_inner_nodes()
            if left > self._capacity * _TOO_FULL:
                raise DDMemoryError
            self._crowded = (left + self._capacity) // 2

    def node(self, level: int, high: Diagram, low: Diagram) -> Diagram:
        """Return `high` for a true variable and `low` for a false one."""
        return self._variables[level].ite(high, low)


def and_exists(left: Diagram, right: Diagram, cube: Diagram) -> Diagram:
    """Return the conjunction with the variables of `cube` quantified existentially, in one pass."""
    return left.apply_exists(_AND, right, cube)


def split(diagram: Diagram, level: int) -> tuple[Diagram, Diagram]:
    """Return the cofactors for a true and a false variable; no variable above it may occur."""
    cofactors = diagram.cofactors() if diagram.node_level() == level else None
    return cofactors or (diagram, diagram)


def _refuse_where_addresses_lack(capacity: int) -> None:
    """Raise TooFewAddressesError if the address space is too small for the library, which would end the process."""
    needed, left = _LIBRARY + capacity * _BYTES_PER_NODE, address_space()
    if not IS_PURE and left is not None and left < needed:
        raise TooFewAddressesError(
            f"decision diagrams need {needed >> 20} MiB of addresses, and `ulimit -v` leaves {max(left, 0) >> 20}"
        )


def nodes_in(memory: int) -> int:
    """Return the number of nodes that take a number of bytes."""
    return memory // _BYTES_PER_NODE


def with_enough_memory(run: Callable[[int], T], memory: int, levels: int | None = None) -> T:
    """Run `run` with a capacity in nodes; restart it with a larger one as long as it runs out of room.

    The first capacity is smaller for few `levels` and larger for many. `memory` bounds the bytes of the nodes and those
    of the whole process. Raises MemoryError beyond it, and if the system allows too few addresses.
    """
    most = nodes_in(memory)
    capacity = _FIRST_CAPACITY
    if levels is not None and levels <= _FEW_LEVELS:
        capacity = min(capacity, _SMALL_CAPACITY)
    elif levels is not None and levels >= _MANY_LEVELS:
        capacity = _LARGE_CAPACITY
    capacity = min(capacity, most)
    while True:
        try:
            with limit_memory(memory, "synthesis"):
                return run(capacity)
        except DDMemoryError:
            if capacity == most:
                raise MemoryError(f"synthesis needs more than {memory >> 20} MiB for its decision diagrams") from None
            capacity = min(capacity * _GROWTH, most)
