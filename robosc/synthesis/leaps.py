"""Closing many small steps at once, by iterative squaring.

A counter that goes up by one takes as many steps as it has values. The events that move it, put into one relation, are
squared instead until they lead as far as any number of steps would (Burch, Clarke, McMillan, Dill, Hwang: Symbolic
model checking: 10^20 states and beyond, LICS 1990): 31 times for 2^31 values. That pays for few events over few
elements only, so it is done where wide integers keep the search going, with the events that have to do with each other.
"""

from __future__ import annotations

from itertools import accumulate
from typing import TYPE_CHECKING

from robosc.diagnostics import Diagnostic, ModelError, Severity
from robosc.metamodel import sct
from robosc.metamodel.places import place
from robosc.synthesis.bdd import and_exists
from robosc.synthesis.encoding import domain_size
from robosc.synthesis.relation import Step

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Element, Encoding

#: The nodes above which a relation is given up: then single steps are faster.
_LARGE = 20_000
#: After how many turns without an end wide integers are taken in leaps, and after how many not even that helps.
_PATIENCE = 32
_HOPELESS = 1 << 16


class Leaps:
    """What any number of steps of a few events does, as a single step."""

    def __init__(self, steps: Sequence[Step], *, forwards: bool) -> None:
        self._forwards = forwards
        self._wide: Mapping[Element, Sequence[Element]] = steps[0].encoding.layout.wide if steps else {}
        self._known: dict[tuple[tuple[Step, ...], Diagram], Step | None] = {}

    def due(self, turn: int) -> bool:
        """Whether after so many turns of a search without an end leaps are to be tried."""
        return bool(self._wide) and turn >= _PATIENCE and turn.bit_count() == 1

    def over(self, here: Sequence[Step], others: Sequence[Step], turn: int, within: Diagram) -> Iterator[Step]:
        """For each wide integer in reach a leap of the steps that move it, and move what these depend on.

        They are taken from `here`, and from `others`, the farther away the more turns were in vain. Each state on the
        way is `within` the bound. Several wide integers move together only in further leaps, of which each makes use of
        the one before. Raises ModelError where so many turns were in vain that leaps don't help, either.
        """
        if turn >= _HOPELESS:
            raise hopeless([*here, *others])
        hops = (turn // _PATIENCE).bit_length()
        near, touched = _with_neighbours(here, others, hops)
        bundles = list(dict.fromkeys(tuple(self._wide[each]) for each in touched if each in self._wide))
        for bundle in bundles:
            yield from self._leap(near, bundle, within)
        if hops > 1:
            found: list[Step] = []
            for bundle in list(accumulate(bundles))[1:]:
                found = list(self._leap([*near, *found], bundle, within))
                yield from found

    def _leap(self, near: Sequence[Step], bundle: Sequence[Element], within: Diagram) -> Iterator[Step]:
        """The leap of those steps that move one of the wide integers and no other; none where it gets large."""
        steps = tuple(step for step in near if all(each in bundle for each in step.changed if each in self._wide))
        if not any(each in bundle for step in steps for each in step.changed):
            return
        key = steps, within
        if key not in self._known:
            self._known[key] = self._closed(steps, within)
        leap = self._known[key]
        if leap is not None:
            yield leap

    def _closed(self, steps: Sequence[Step], within: Diagram) -> Step | None:
        encoding = steps[0].encoding
        changed = tuple(dict.fromkeys(each for step in steps for each in step.changed))
        frame = _Frame(encoding, changed)
        once = encoding.diagrams.false
        for step in steps:
            moved = step.relation
            for each in changed:
                if each not in step.changed:
                    moved &= encoding.keeps(each)
            once |= moved
        once &= frame.following(within) if self._forwards else within
        closed = once | frame.same
        while closed.node_count() <= _LARGE:
            further = frame.composed(closed)
            encoding.diagrams.statistics.operations += 1
            encoding.diagrams.tidy()
            if further == closed:
                level = min(step.level for step in steps)
                return Step(level, closed, frame.present_cube, frame.following_cube, frame.same, encoding, changed, ())
            closed = further
        return None


class _Frame:
    """The present, following and halfway values of some elements."""

    def __init__(self, encoding: Encoding, elements: Iterable[Element]) -> None:
        domains = [encoding.layout.domains[each] for each in elements]
        pairs = [
            (present, halfway, following)
            for each in domains
            for present, halfway, following in zip(each.levels, each.halfway_levels, each.next_levels, strict=True)
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
        """The states as a condition on the following values."""
        return and_exists(states, self.same, self.present_cube)

    def composed(self, relation: Diagram) -> Diagram:
        """The relation twice in a row."""
        first = and_exists(relation, self._to_following, self.following_cube)
        second = and_exists(relation, self._from_present, self.present_cube)
        return and_exists(first, second, self._halfway_cube)


def hopeless(steps: Iterable[Step]) -> ModelError:
    """What is raised where some steps neither come to an end nor leap: located at the widest integer they touch."""
    variables = [each for step in steps for each in step.touched if isinstance(each, sct.DiscreteVariable)]
    widest = max(variables, key=domain_size)
    message = (
        f"the range of {widest.name}, {domain_size(widest)} values, is too wide: synthesis takes them one by one, "
        "because of what else changes with them"
    )
    hint = "give it a smaller range"
    return ModelError([Diagnostic(*place(widest), Severity.ERROR, "integer-range", message, hint)])


def _with_neighbours(here: Sequence[Step], others: Sequence[Step], hops: int) -> tuple[list[Step], dict[Element, None]]:
    """The steps, those that change what they touch, and so on; with all that these touch."""
    near = list(here)
    touched = dict.fromkeys(each for step in near for each in step.touched)
    rest = list(others)
    for _ in range(hops):
        added = [step for step in rest if any(each in touched for each in step.changed)]
        if not added:
            break
        near += added
        touched |= dict.fromkeys(each for step in added for each in step.touched)
        rest = [step for step in rest if step not in added]
    return near, touched
