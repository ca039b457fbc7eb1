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
#: After how many turns without an end wide integers are accelerated, and after how many not even that helps.
_PATIENCE = 32
_HOPELESS = 1 << 16


class Acceleration:
    """What any number of steps of a few events does, as a single step."""

    def __init__(self, steps: Sequence[Step], *, forwards: bool) -> None:
        self._forwards = forwards
        self._wide: Mapping[Element, Sequence[Element]] = steps[0].encoding.layout.wide if steps else {}
        self._known: dict[tuple[tuple[Step, ...], Diagram], Step | None] = {}

    def due(self, turn: int) -> bool:
        """Whether after so many turns of a search without an end acceleration is to be tried."""
        return bool(self._wide) and turn >= _PATIENCE and turn.bit_count() == 1

    def over(self, here: Sequence[Step], others: Sequence[Step], turn: int, within: Diagram) -> Iterator[Step]:
        """For each wide integer in reach the closure of the steps that change it and of those that these depend on.

        They are taken from `here`, and from `others`, the farther away the more turns were in vain. Every state on the
        way is `within` the bound. Several wide integers move together only in further closures, which make use of those
        before them. Raises ModelError where so many turns were in vain that acceleration does not help, either.
        """
        if turn >= _HOPELESS:
            raise hopeless([*here, *others])
        hops = (turn // _PATIENCE).bit_length()
        near, touched = _with_neighbours(here, others, hops)
        bundles = list(dict.fromkeys(tuple(self._wide[element]) for element in touched if element in self._wide))
        for bundle in bundles:
            yield from self._accelerated(near, bundle, within)
        if hops > 1:
            found: list[Step] = []
            for bundle in list(accumulate(bundles))[1:]:
                found = list(self._accelerated([*near, *found], bundle, within))
                yield from found

    def _accelerated(self, near: Sequence[Step], bundle: Sequence[Element], within: Diagram) -> Iterator[Step]:
        """The closure of those steps that move one of the wide integers and no other; none where it gets large."""
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

    def _closed(self, steps: Sequence[Step], within: Diagram) -> Step | None:
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
                return Step(level, closed, frame.present_cube, frame.following_cube, frame.same, encoding, changed, ())
            closed = further
        return None


class _Frame:
    """The present, following and halfway values of some elements."""

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
        """The states as a condition on the following values."""
        return and_exists(states, self.same, self.present_cube)

    def composed(self, relation: Diagram) -> Diagram:
        """The relation twice in a row."""
        first = and_exists(relation, self._to_following, self.following_cube)
        second = and_exists(relation, self._from_present, self.present_cube)
        return and_exists(first, second, self._halfway_cube)


def hopeless(steps: Iterable[Step]) -> ModelError:
    """What is raised where steps neither end nor can be accelerated: located at the widest integer that they touch."""
    variables = [element for step in steps for element in step.touched if isinstance(element, sct.DiscreteVariable)]
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
