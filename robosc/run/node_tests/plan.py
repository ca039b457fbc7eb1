"""Planner of tours: possible inputs, the effects in a control loop, and the route that reaches the goals."""

from __future__ import annotations

import random
from collections import Counter
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property, partial, reduce
from operator import or_
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from robosc.engine import ControlLoop, Hooks
from robosc.model import sct
from robosc.model.engine import Role
from robosc.model.semantics.roles import event_name, is_goal
from robosc.run.node_tests.coverage import Goal, Watcher, goals
from robosc.run.node_tests.guide import Guide, Way
from robosc.run.node_tests.steps import WAIT, Place, Stimulus, TourStep
from robosc.run.simulation.data import EventData
from robosc.synthesis import use_encoding
from robosc.synthesis.bdd import OutOfRoomError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence
    from collections.abc import Set as AbstractSet

    from robosc.engine import Settings
    from robosc.engine.control_loop import SavedLoop
    from robosc.engine.state import Value
    from robosc.model import rosgraph
    from robosc.synthesis.encoding import Encoding

T = TypeVar("T")

#: Maximum number of steps to explore; below it, all places are explored.
_ALL = 12_000
#: Number of randomized attempts to plan a tour: exhaustive, guided, and guided again after a deviation.
_PLANS, _GUIDED, _AGAIN = 10, 5, 1
#: Maximum length in steps of a path that replaces a part of a tour.
_DETOUR = 4
#: Give a goal up after this many paths that missed it, and for a run after this many plans without it.
_IN_VAIN, _PLANS_IN_VAIN = 4, 3


class _Way(NamedTuple):
    """Consecutive steps, and the goals that they show together, as bits."""

    steps: tuple[TourStep, ...]
    shows: int


@dataclass
class _Known:
    saved: SavedLoop
    steps: list[TourStep] | None = None


@dataclass
class Plan:
    """Places of one model's control loop, explored on demand, and tours through them."""

    model: sct.SupervisoryControlModel
    settings: Settings
    stimuli: Sequence[Stimulus]
    #: Longest time to wait for, in milliseconds.
    longest: int
    #: Duration of a period, and of the pause after a failure, in milliseconds.
    period: int
    pause: int
    graph: rosgraph.RosGraph
    _known: dict[Place, _Known] = field(default_factory=dict)
    _ways_from: dict[Place, dict[Place, list[_Way]]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._loop = ControlLoop(self.model, self.settings, Hooks(self._before))
        self._watcher = Watcher(self._loop)
        data = EventData(self._loop.engine, self.graph)
        self._inputs = {
            event.name: partial(data.inputs, event.name, {})
            for event in self._loop.engine.executed.events
            if event.role is Role.trigger and event.inputs
        }
        #: All coverage goals.
        self.goals = goals(self._loop)
        #: Bit of each goal.
        self.bits = {goal: 1 << number for number, goal in enumerate(self.goals)}
        self._at_rest: dict[tuple[int, ...], int] = {}
        events = [event for plant in self.model.plants for event in plant.events]
        self._resets = {event_name(event) for event in events if event.kind == sct.EventKind.reset}
        self._rejectable = {event_name(event) for event in events if is_goal(event)}
        self._timers = {timer.event.name: number for number, timer in enumerate(self._loop.engine.executed.timers)}
        self._pauses = self._time_passes = False
        self._shown = self._anywhere = 0
        self._last_guide: Guide | None = None
        #: Number of plans of the present run that lack a goal.
        self._missed = Counter[Goal]()

    def is_like(self, other: Plan) -> bool:
        """Return whether another plan would plan the same tours from the same place and coverage."""
        ours, others = (
            (id(plan.model), plan.settings, tuple(plan.stimuli), plan.longest, plan.period, plan.pause)
            for plan in (self, other)
        )
        return ours == others

    def _before(self, event: str) -> bool:
        if event in self._resets and self._pauses:
            return False
        if event in self._inputs:
            self._loop.engine.set_inputs(event, self._inputs[event]())
        self._shown |= self._mask(self._watcher.before_event(event))
        return True

    def _mask(self, seen: Iterable[Goal]) -> int:
        return reduce(or_, (self.bits[goal] for goal in seen), 0)

    def place(self, saved: SavedLoop, *, pauses: bool) -> Place:
        """Return the place of a loop, and remember its saved state for exploration."""
        now, up = saved.timers
        left = tuple(-((now - up[number]) // self.period) for number in sorted(up)) if self._time_passes else ()
        place = Place(saved.cells, frozenset(up), pauses, left)
        self._known.setdefault(place, _Known(saved))
        return place

    @property
    def places(self) -> list[Place]:
        """The known places, in the order of their discovery."""
        return list(self._known)

    @cached_property
    def possible(self) -> set[Goal]:
        """The goals that can be seen: from the first known place on, else in the supervised system."""
        if self.is_whole:
            return {goal for goal in self.goals if self.bits[goal] & self._anywhere}
        return self._with_guide(lambda guide: guide.possible)

    @cached_property
    def is_whole(self) -> bool:
        """Whether there are so few places that all of them were explored."""
        pending = list(self._known)
        seen = set(pending)
        while pending and len(seen) * len(self.stimuli) < _ALL:
            for step in self.steps(pending.pop()):
                self._anywhere |= step.shows
                if step.end not in seen:
                    seen.add(step.end)
                    pending.append(step.end)
        return not pending

    def steps(self, place: Place) -> list[TourStep]:
        """Return all steps from a place that lead to another one or show a goal."""
        known = self._known[place]
        if known.steps is None:
            candidates = (self._step(place, known.saved, stimulus) for stimulus in self.stimuli)
            known.steps = [step for step in candidates if step is not None and (step.end != place or step.shows)]
        return known.steps

    def _step(self, place: Place, saved: SavedLoop, stimulus: Stimulus) -> TourStep | None:
        loop = self._loop
        loop.restore(saved)
        self._pauses, self._shown = place.pauses, 0
        if stimulus.events:
            if place.pauses or not all(loop.enabled(event) for event, _ in stimulus.events):
                return None  # nothing comes in during the pause after a failure
            if any(self._is_rejected(event, inputs) for event, inputs in stimulus.events):
                return None
            loop.begin()
            for event, inputs in stimulus.events:
                loop.perform(event, dict(inputs))
            self._pauses = stimulus.fails
            loop.end()
        else:
            wait = self.pause if place.pauses else loop.timers.wait
            if wait is None or wait > self.longest:
                return None
            if self._time_passes:
                for _ in range(-(-wait // self.period) - 1):
                    self._pass_period()
            elif not place.pauses:
                loop.timers.at(loop.timers.now + wait)
                loop.expire()
            self._pauses = False
        return self._ended(stimulus)

    def _is_rejected(self, event: str, inputs: Iterable[tuple[str, Value]]) -> bool:
        """Return whether the controller rejects a goal of a client with these inputs."""
        if event not in self._rejectable:
            return False
        self._loop.engine.set_inputs(event, dict(inputs))
        return not self._loop.engine.permits_inputs(event)

    def _ended(self, stimulus: Stimulus) -> TourStep:
        self._shown |= self._rest()
        self._pass_period()
        return TourStep(stimulus, self.place(self._loop.saved, pauses=self._pauses), self._shown)

    def _pass_period(self) -> None:
        """Run a tick; if time counts, after a period, with the timers that expire on the way."""
        loop = self._loop
        if self._time_passes:
            end = loop.timers.now + self.period
            while (wait := loop.timers.wait) is not None and loop.timers.now + wait <= end:
                loop.timers.at(loop.timers.now + wait)
                loop.expire()
                self._shown |= self._rest()
            loop.timers.at(end)
        loop.tick()
        self._shown |= self._rest()

    def _rest(self) -> int:
        cells, _ = self._loop.engine.saved
        if cells not in self._at_rest:
            self._at_rest[cells] = self._mask(self._watcher.at_rest())
        return self._at_rest[cells]

    # Tours

    def tour(self, start: Place, shown: AbstractSet[Goal], *, again: bool = False) -> list[TourStep]:
        """Return a short path from a start that shows goals that can be shown and were not, as far as it is found.

        If there are too many places to explore, decision diagrams guide the search. `again`: the run has deviated from
        an earlier path, and a plain path is enough.
        """
        goals = self._mask(self.possible - shown)
        if not again:
            self._missed.clear()
        if not self.is_whole and not self._time_passes:
            known, self._known, self._time_passes = self._known, {}, True
            start = self.place(known[start].saved, pauses=start.pauses)
        if self.is_whole:
            tours = [self._planned(start, goals, choice) for choice in _choices(_PLANS)]
        else:
            number = _AGAIN if again else _GUIDED
            tours = self._with_guide(
                lambda guide: [self._guided(start, goals, guide, choice) for choice in _choices(number)]
            )
        best = max(tours, key=lambda tour: ((_together(tour) & goals).bit_count(), -len(tour)))
        missed = goals & ~_together(best)
        self._missed.update(goal for goal in self.goals if self.bits[goal] & missed)
        return best

    def _planned(self, start: Place, goals: int, choice: random.Random) -> list[TourStep]:
        tour: list[TourStep] = []
        left, here = goals, start
        while left and (way := self._way_to_any(here, left, choice)):
            tour += way
            here = tour[-1].end
            left &= ~_together(way)
        return self._shortened(start, tour, goals, _DETOUR)

    def _way_to_any(self, start: Place, goals: int, choice: random.Random) -> list[TourStep]:
        """Return the shortest path to a wanted goal; among several, favor one that shows many, with some randomness."""
        ways: dict[Place, list[TourStep]] = {start: []}
        layer = [start]
        while layer:
            rated_ways: list[tuple[float, float, list[TourStep]]] = []
            onwards: list[Place] = []
            for place in layer:
                for step in self.steps(place):
                    if step.shows & goals:
                        much = (step.shows & goals).bit_count() * (1 + choice.random())
                        rated_ways.append((much, choice.random(), [*ways[place], step]))
                    if step.end not in ways:
                        ways[step.end] = [*ways[place], step]
                        onwards.append(step.end)
            if rated_ways:
                return max(rated_ways, key=lambda way: way[:2])[2]
            layer = onwards
        return []

    def _guided(self, start: Place, goals: int, guide: Guide, choice: random.Random) -> list[TourStep]:
        """Repeat the step that shows the most goals, else follow the supervised system's path to a missing goal."""
        tour: list[TourStep] = []
        hopeless = {goal for goal, number in self._missed.items() if number >= _PLANS_IN_VAIN}
        left, here, in_vain = goals & ~self._mask(hopeless), start, Counter[Goal]()
        while left:
            # Timers first: some expire only before anything has come in.
            showing = [step for step in self.steps(here) if step.shows & left]
            if showing:
                much = [(step.stimulus == WAIT, (step.shows & left).bit_count(), choice.random()) for step in showing]
                way = [showing[much.index(max(much))]]
            else:
                promising = [goal for goal in self.goals if self.bits[goal] & left and in_vain[goal] < _IN_VAIN]
                events, aims = self._timed(here, promising) or guide.way(self._codes(here), promising)
                if not events:
                    break
                in_vain.update(aims)
                way = self._followed(here, events, left)
            tour += way
            here = way[-1].end if way else here
            left &= ~_together(way)
        return self._shortened(start, tour, goals, 1)

    def _with_guide(self, look: Callable[[Guide], T]) -> T:
        """Return `look(guide)`. The guide lives on for the next call, with its closed sets."""
        if self._last_guide is not None:
            with suppress(OutOfRoomError):
                return look(self._last_guide)
            self._last_guide = None

        def begin(encoding: Encoding) -> T:
            data: dict[str, list[dict[str, Value]]] = {}
            for event, inputs in (pair for stimulus in self.stimuli for pair in stimulus.events):
                data.setdefault(event, []).append(dict(inputs))
            guide = Guide(self.model, encoding, self.goals, data)
            result = look(guide)
            self._last_guide = guide
            return result

        return use_encoding(self.model, begin)

    def release(self) -> None:
        """Free the decision diagrams."""
        self._last_guide = None

    def _codes(self, place: Place) -> Mapping[sct.Plant | sct.DiscreteVariable, int]:
        self._loop.engine.restore((place.cells, self._loop.engine.saved[1]))
        return self._loop.engine.codes

    def _timed(self, here: Place, goals: Iterable[Goal]) -> Way | None:
        """Return the wait for a goal that is seen when a running timer expires."""
        for goal in goals:
            event = event_name(goal.of.event) if isinstance(goal.of, sct.Edge) else ""
            if self._timers.get(event) in here.running:
                return Way([(event, {})], {goal})
        return None

    def _followed(self, start: Place, events: Iterable[tuple[str, dict[str, Value]]], goals: int) -> list[TourStep]:
        """Return steps that cause these events, or similar ones, until a wanted goal is seen."""
        way: list[TourStep] = []
        for event, inputs in events:
            for _ in range(1 + len(self._timers)):
                here = way[-1].end if way else start
                like = [step for step in self.steps(here) if self._is(step.stimulus, event)]
                if like:  # else the controller performs it itself, or it is not possible now
                    way.append(min(like, key=lambda step: (_unlike(step.stimulus, event, inputs), step.stimulus.name)))
                if _together(way) & goals:
                    return way
                if not like or self._timers.get(event) not in way[-1].end.running:
                    break  # else another timer expired before this one
        return way

    def _is(self, stimulus: Stimulus, event: str) -> bool:
        if not stimulus.events:
            return ".u_after" in event or event in self._resets
        return event in dict(stimulus.events)

    def _shortened(self, start: Place, tour: list[TourStep], goals: int, detour: int) -> list[TourStep]:
        """Remove detours from the tour: leave out a part or take a shorter path if no goal is lost."""
        improved = True
        while improved:
            improved = False
            places = [start, *(step.end for step in tour)]
            before, after = _running(tour), _running(tour[::-1])[::-1]
            for first in range(len(tour)):
                seen, ways = _running(tour[first:]), self._ways(places[first], detour)
                for last in range(len(tour), first, -1):
                    lost = seen[last - first] & goals & ~before[first] & ~after[last]
                    shorter = (way for way in ways.get(places[last], ()) if len(way.steps) < last - first)
                    way = next((way.steps for way in shorter if not lost & ~way.shows), None)
                    if way is not None:
                        tour = [*tour[:first], *way, *tour[last:]]
                        improved = True
                        break
                if improved:
                    break
        while tour and not tour[-1].shows & goals & ~_together(tour[:-1]):
            tour.pop()
        return tour

    def _ways(self, start: Place, longest: int) -> dict[Place, list[_Way]]:
        """Return paths of at most `longest` steps to all places, shortest first; each shows more than those before it.

        The result is cached if all places were explored, since many tours request it.
        """
        if (ways := self._ways_from.get(start)) is not None:
            return ways
        first = _Way((), 0)
        ways, nearest, layer = {start: [first]}, {start: first}, [start]
        for _ in range(longest):
            onwards = []
            for place in layer:
                for step in self._known[place].steps or ():
                    way = _Way((*nearest[place].steps, step), nearest[place].shows | step.shows)
                    others = ways.setdefault(step.end, [])
                    if all(way.shows & ~other.shows for other in others):
                        others.append(way)
                    if step.end not in nearest:
                        nearest[step.end] = way
                        onwards.append(step.end)
            layer = onwards
        if self.is_whole:
            self._ways_from[start] = ways
        return ways


def _choices(number: int) -> list[random.Random]:
    return [random.Random(seed) for seed in range(number)]  # noqa: S311 - reproducible, and nothing is secret


def _unlike(stimulus: Stimulus, event: str, inputs: Mapping[str, Value]) -> int:
    """Return how many inputs of the event differ in a stimulus."""
    stimulus_inputs = dict(dict(stimulus.events).get(event, ()))
    return sum(stimulus_inputs.get(name) != value for name, value in inputs.items())


def _together(steps: Iterable[TourStep]) -> int:
    return reduce(or_, (step.shows for step in steps), 0)


def _running(steps: Sequence[TourStep]) -> list[int]:
    """Return the goals shown by each prefix of the steps, from the empty one on."""
    shown = [0]
    for step in steps:
        shown.append(shown[-1] | step.shows)
    return shown
