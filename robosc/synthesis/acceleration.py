"""Acceleration of long event sequences by iterative squaring.

A counter that increases by one takes as many steps as it has values. Instead, the relation of the events that change it
is squared until it covers any number of steps (Burch, Clarke, McMillan, Dill, Hwang: Symbolic model checking: 10^20
states and beyond, LICS 1990): 31 squarings for 2^31 values. This pays only for few events over few elements. It is
therefore used only if wide integers keep the search going, and only for events that depend on each other.
"""

from __future__ import annotations

from itertools import accumulate
from typing import TYPE_CHECKING

from robosc.base.diagnostics import Diagnostic, ModelError, Severity
from robosc.model import sct
from robosc.model.places import place
from robosc.synthesis.bdd import and_exists
from robosc.synthesis.encoding import domain_size
from robosc.synthesis.relation import SymbolicStep

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Element, Encoding

#: Maximum number of nodes of an accelerated relation. Above it, single steps are faster.
_LARGE = 20_000
#: Number of turns without an end after which wide integers are accelerated, and after which synthesis gives up.
_PATIENCE = 32
_HOPELESS = 1 << 16


class Acceleration:
    """Closures of few events under any number of steps, each as a single step."""

    def __init__(self, steps: Sequence[SymbolicStep], *, forwards: bool) -> None:
        self._forwards = forwards
        self._wide: Mapping[Element, Sequence[Element]] = steps[0].encoding.layout.wide if steps else {}
        self._known: dict[tuple[tuple[SymbolicStep, ...], Diagram], SymbolicStep | None] = {}

    def due(self, turn: int) -> bool:
        """Return whether to try acceleration after this number of turns."""
        return bool(self._wide) and turn >= _PATIENCE and turn.bit_count() == 1

    def over(
        self, here: Sequence[SymbolicStep], others: Sequence[SymbolicStep], turn: int, within: Diagram
    ) -> Iterator[SymbolicStep]:
        """Yield closures of steps for each wide integer in reach.

        A closure covers the steps that change a wide integer and the steps that these depend on. The steps come from
        `here`, and from `others` in a distance that grows with the number of turns. Every state on the way is `within`
        the bound. Closures of several wide integers come last; they use those before them. Raises ModelError if `turn`
        is so high that acceleration does not help either.
        """
        if turn >= _HOPELESS:
            raise hopeless([*here, *others])
        hops = (turn // _PATIENCE).bit_length()
        near, touched = _with_neighbours(here, others, hops)
        bundles = list(dict.fromkeys(tuple(self._wide[element]) for element in touched if element in self._wide))
        for bundle in bundles:
            yield from self._accelerated(near, bundle, within)
        if hops > 1:
            closures: list[SymbolicStep] = []
            for bundle in list(accumulate(bundles))[1:]:
                closures = list(self._accelerated([*near, *closures], bundle, within))
                yield from closures

    def _accelerated(
        self, near: Sequence[SymbolicStep], bundle: Sequence[Element], within: Diagram
    ) -> Iterator[SymbolicStep]:
        """Yield the closure of the steps that change no wide integer outside `bundle`; nothing if it gets large."""
        steps = tuple(
            step for step in near if all(element in bundle for element in step.changed if element in self._wide)
        )
        if not any(element in bundle for step in steps for element in step.changed):
            return
        key = steps, within
        if key not in self._known:
            self._known[key] = self._closed(steps, within)
        accelerated = self._known[key]
        if accelerated is not None:
            yield accelerated

    def _closed(self, steps: Sequence[SymbolicStep], within: Diagram) -> SymbolicStep | None:
        encoding = steps[0].encoding
        changed = tuple(dict.fromkeys(element for step in steps for element in step.changed))
        frame = _Frame(encoding, changed)
        once = encoding.diagrams.false
        for step in steps:
            moved = step.relation
            for element in changed:
                if element not in step.changed:
                    moved &= encoding.keeps(element)
            once |= moved
        once &= frame.following(within) if self._forwards else within
        closed = once | frame.same
        while closed.node_count() <= _LARGE:
            further = frame.composed(closed)
            encoding.diagrams.statistics.operations += 1
            encoding.diagrams.tidy()
            if further == closed:
                level = min(step.level for step in steps)
                return SymbolicStep(
                    level, closed, frame.present_cube, frame.following_cube, frame.same, encoding, changed, ()
                )
            closed = further
        return None


class _Frame:
    """Levels of the present, following and halfway values of some elements."""

    def __init__(self, encoding: Encoding, elements: Iterable[Element]) -> None:
        domains = [encoding.layout.domains[element] for element in elements]
        pairs = [
            (present, halfway, following)
            for domain in domains
            for present, halfway, following in zip(
                domain.levels, domain.halfway_levels, domain.next_levels, strict=True
            )
        ]
        pairs.sort(reverse=True)
        diagrams = encoding.diagrams
        self.present_cube = diagrams.cube(present for present, _, _ in pairs)
        self.following_cube = diagrams.cube(following for _, _, following in pairs)
        self._halfway_cube = diagrams.cube(halfway for _, halfway, _ in pairs)
        self.same = self._from_present = self._to_following = diagrams.true
        for present, halfway, following in pairs:
            before, between, after = (diagrams.variable(level) for level in (present, halfway, following))
            self.same = before.equiv(after) & self.same
            self._from_present = before.equiv(between) & self._from_present
            self._to_following = between.equiv(after) & self._to_following

    def following(self, states: Diagram) -> Diagram:
        """Return the states as a condition on the following values."""
        return and_exists(states, self.same, self.present_cube)

    def composed(self, relation: Diagram) -> Diagram:
        """Return the composition of the relation with itself."""
        first = and_exists(relation, self._to_following, self.following_cube)
        second = and_exists(relation, self._from_present, self.present_cube)
        return and_exists(first, second, self._halfway_cube)


def hopeless(steps: Iterable[SymbolicStep]) -> ModelError:
    """Return the error for steps that neither end nor can be accelerated, located at their widest integer."""
    variables = [element for step in steps for element in step.touched if isinstance(element, sct.DiscreteVariable)]
    widest = max(variables, key=domain_size)
    message = (
        f"the range of {widest.name}, {domain_size(widest)} values, is too wide: synthesis handles them one by one, "
        "because other values change with them"
    )
    hint = "use a smaller range"
    return ModelError([Diagnostic(*place(widest), Severity.ERROR, "integer-range", message, hint)])


def _with_neighbours(
    here: Sequence[SymbolicStep], others: Sequence[SymbolicStep], hops: int
) -> tuple[list[SymbolicStep], dict[Element, None]]:
    """Return the steps with those that change what they touch, up to `hops` times, and all elements they touch."""
    near = list(here)
    touched = dict.fromkeys(element for step in near for element in step.touched)
    rest = list(others)
    for _ in range(hops):
        added = [step for step in rest if any(element in touched for element in step.changed)]
        if not added:
            break
        near += added
        touched |= dict.fromkeys(element for step in added for element in step.touched)
        rest = [step for step in rest if step not in added]
    return near, touched
