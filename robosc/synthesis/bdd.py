"""The one place that knows the library of decision diagrams: `oxidd.bcdd`, on one thread."""

from __future__ import annotations

from functools import reduce
from operator import and_, or_
from typing import TYPE_CHECKING, TypeAlias, cast

from oxidd.bcdd import BCDDFunction, BCDDManager
from oxidd.util import BooleanOperator, DDMemoryError

from robosc.synthesis.memory import TooFewAddressesError, address_space, bounded
from robosc.synthesis.statistics import Statistics

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from typing import TypeVar

    T = TypeVar("T")

#: A boolean function over the variables of its `Diagrams`; equal functions are equal and hash alike. It offers
#: `& | ^ ~`, `equiv`, `imp`, `ite`, `exists(cube)`, `satisfiable`, `valid`, `sat_count`, `node_count`.
Diagram: TypeAlias = BCDDFunction

#: What a node and its share of the operation cache take, measured.
_BYTES_PER_NODE = 40
#: The addresses that the library takes beside the nodes, most of them for the stack of its one thread, measured.
_LIBRARY = (1 << 30) + (192 << 20)
_FIRST_CAPACITY = 1 << 18
#: Up to so many levels a diagram is small, and so is the room that is made first, since making it takes its time; from
#: so many on it is large.
_FEW_LEVELS, _SMALL_CAPACITY, _MANY_LEVELS, _LARGE_CAPACITY = 64, 1 << 15, 512, 1 << 20
#: What comes again from the start takes longer than room that stays empty.
_GROWTH = 8
#: The share of the room at which the library would collect garbage, a little less, and the one that may be in use then.
_FULL = 0.94
_TOO_FULL = 0.75


class _Conjunction:
    """The operator as the library looks at it, without what an `Enum` takes to tell its value: a third of the time."""

    value = BooleanOperator.AND.value


_AND = cast("BooleanOperator", _Conjunction())


class Diagrams:
    """Decision diagrams over a fixed number of variables; a variable's number is its level, 0 at the top."""

    def __init__(self, levels: int, capacity: int, statistics: Statistics | None = None) -> None:
        """Room for `capacity` nodes; an operation that needs more raises DDMemoryError. `statistics` are kept."""
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
        """True where the variable is."""
        return self._variables[level]

    def all_of(self, parts: Iterable[Diagram]) -> Diagram:
        """The conjunction, from the first part to the last; true of none."""
        return reduce(and_, parts, self.true)

    def any_of(self, parts: Iterable[Diagram]) -> Diagram:
        """The disjunction, from the first part to the last; false of none."""
        return reduce(or_, parts, self.false)

    def cube(self, levels: Iterable[int]) -> Diagram:
        """The conjunction of the variables: how quantification is told what to quantify."""
        result = self.true
        for level in sorted(levels, reverse=True):
            result = self.variable(level) & result
        return result

    def tidy(self) -> None:
        """To be called between operations, every now and then: counts the nodes, and collects garbage in good time.

        Where room gets really short the library would collect garbage on a thread of its own: then no two runs would be
        the same. So that counts as too little room, and DDMemoryError is raised.
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
        """`high` where the variable is true, else `low`."""
        return self._variables[level].ite(high, low)


def and_exists(left: Diagram, right: Diagram, cube: Diagram) -> Diagram:
    """The conjunction, its variables in `cube` quantified existentially, in one pass."""
    return left.apply_exists(_AND, right, cube)


def split(diagram: Diagram, level: int) -> tuple[Diagram, Diagram]:
    """The function where the variable is true and where it is false; no variable above it may occur."""
    cofactors = diagram.cofactors() if diagram.node_level() == level else None
    return cofactors or (diagram, diagram)


def _refuse_where_addresses_lack(capacity: int) -> None:
    """The library would end the process."""
    wanted, left = _LIBRARY + capacity * _BYTES_PER_NODE, address_space()
    if left is not None and left < wanted:
        raise TooFewAddressesError(
            f"decision diagrams need {wanted >> 20} MiB of addresses, and `ulimit -v` leaves {max(left, 0) >> 20}"
        )


def with_enough_memory(run: Callable[[int], T], memory: int, levels: int | None = None) -> T:
    """`run` with room for a number of nodes, again from the start with more room each time that it did not suffice.

    There is less room at first where diagrams are known to have few `levels`, and more where they have many.

    `memory` bounds the bytes that the nodes may take, and those of the whole process; raises MemoryError beyond it, and
    where the system allows too few addresses.
    """
    most = memory // _BYTES_PER_NODE
    capacity = _FIRST_CAPACITY
    if levels is not None and levels <= _FEW_LEVELS:
        capacity = min(capacity, _SMALL_CAPACITY)
    elif levels is not None and levels >= _MANY_LEVELS:
        capacity = _LARGE_CAPACITY
    capacity = min(capacity, most)
    while True:
        try:
            with bounded(memory, "synthesis"):
                return run(capacity)
        except DDMemoryError:
            if capacity == most:
                raise MemoryError(f"synthesis needs more than {memory >> 20} MiB for its decision diagrams") from None
            capacity = min(capacity * _GROWTH, most)
