"""Properties of the control loop that hold for all robots and all sequences of events."""

from collections import Counter
from itertools import combinations
from random import Random

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from robosc.engine import ControlLoop, Hooks, Settings
from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.domains import domain
from robosc.model.semantics.roles import event_name, plant_of
from tests.engine.robots import robots
from tests.searching import examples

_SETTINGS = st.builds(
    Settings,
    events_per_tick=st.sampled_from((0, 1, 2)),
    reactions_per_tick=st.sampled_from((0, 2, 10)),
    react_immediately=st.booleans(),
)


class Observed:
    """A loop under random data. Records each operation, its events, and the events enabled after each of them."""

    def __init__(self, model: sct.SupervisoryControlModel, chosen: Settings, seed: int) -> None:
        self.loop = ControlLoop(model, chosen, Hooks(after=self._after, livelock=self._livelock))
        self.settings = chosen
        self.roles = self.loop.engine.roles
        self.queued = [event_name(event) for event in (*self.roles.cancels, *self.roles.triggers)]
        self.silent = {event_name(event) for event in self.roles.silent}
        self.data = {event_name(event) for events in self.roles.data for event in events}
        self.operations: list[tuple[str, list[str]]] = []
        #: At each moment: the operation, its event, and the enabled cancels and triggers.
        self.moments = [(0, "", {event for event in self.queued if self.loop.enabled(event)})]
        self.performed: list[str] = []
        random = Random(seed)  # noqa: S311
        for _ in range(60):
            self._random_operation(random)

    def _random_operation(self, random: Random) -> None:
        if random.random() < 0.5:
            self._operate("tick")
            return
        self._operate("begin")
        possible = [event for event in self.roles.incoming if self.loop.enabled(event_name(event))]
        self.performed = []
        self.operations.append(("batch", []))
        for event in random.choices(possible, k=random.randint(0, 3)) if possible else ():
            data = {input_.name: self._value(input_.type, random) for input_ in event.inputs}
            if self.loop.perform(event_name(event), data):
                self.performed.append(event_name(event))
        assert self.operations[-1][1] == self.performed, "nothing else happens inside a batch"
        self._operate("end")

    def _operate(self, operation: str) -> None:
        self.operations.append((operation, []))
        getattr(self.loop, operation)()
        if operation != "begin":
            resting = not any(map(self.loop.enabled, self.silent))
            assert resting or "livelock" in {event for _, happened in self.operations for event in happened}

    def _after(self, event: str) -> None:
        self.operations[-1][1].append(event)
        self.moments.append((len(self.operations), event, {event for event in self.queued if self.loop.enabled(event)}))

    def _livelock(self) -> None:
        self.operations[-1][1].append("livelock")

    @staticmethod
    def _value(kind: ex.Type, random: Random) -> bool | int | str:
        match kind:
            case ex.EnumerationType():
                low, high = domain(kind)
                return random.choice([literal.name for literal in kind.enumeration.literals][low : high + 1])
            case ex.IntegerType():
                return random.choice((kind.minimum, kind.maximum, random.randint(kind.minimum, min(kind.maximum, 9))))
        return random.random() < 0.5

    def source(self, number: int) -> int:
        """Return the source of the batch that an operation ends, or 0.

        A source is the topic, service or action of the last event.
        """
        _, performed = self.operations[number - 1]
        sources = {event_name(event): place for place, group in enumerate(self.roles.sources, 1) for event in group}
        return sources[performed[-1]] if performed else 0

    def rounds(self, *kinds: str) -> list[list[str]]:
        """Return the cancels and triggers of each operation of these kinds."""
        return [
            [event for event in happened if event in self.queued] for kind, happened in self.operations if kind in kinds
        ]


_observed = st.builds(Observed, robots(), _SETTINGS, st.integers(0, 2**32))
_some = settings(
    max_examples=examples(12),
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large],
)


@pytest.mark.slow
@_some
@given(_observed)
def test_rounds(seen: Observed) -> None:
    topics = {
        event_name(trigger): plant_of(trigger).topic.strip("/")
        for trigger in seen.roles.triggers
        if plant_of(trigger).kind == sct.PlantKind.message
    }
    for sent in seen.rounds("tick", "end"):
        assert len(sent) == len(set(sent)), "each event at most once"
        on = [topics[event] for event in sent if event in topics]
        assert len(on) == len(set(on)), "at most one message on a topic"
        cancels = [event.endswith("c_cancel") for event in sent]
        assert cancels == sorted(cancels, reverse=True), "cancels first"
    limit = seen.settings.events_per_tick
    assert all(not limit or len(sent) <= limit for sent in seen.rounds("tick"))


@_some
@given(_observed)
def test_reactions(seen: Observed) -> None:
    once = {event_name(event) for event in seen.roles.once_per_tick}
    reactions, started, ticked = Counter(), [], False
    for number, (operation, happened) in enumerate(seen.operations):
        sent = [event for event in happened if event in seen.queued]
        if operation == "tick":
            reactions, started, ticked = Counter(), [], True
        elif operation == "end":
            reactions[seen.source(number)] += len(sent)
        started += [event for event in sent if event in once]
        assert len(started) == len(set(started)), "a service or action starts once between two ticks"
        assert operation in ("tick", "end") or not sent
        allowed = seen.settings.reactions_per_tick if ticked and seen.settings.react_immediately else 0
        assert all(number <= allowed for number in reactions.values())
        assert reactions.total() <= (len(seen.roles.sources) + 1) * allowed


@pytest.mark.slow
@_some
@given(_observed)
def test_what_a_batch_makes_possible_waits_for_no_other_topic(seen: Observed) -> None:
    """A command that a batch enables is sent at the end of the batch.

    The only exception is a batch whose source has used up its own count; other sources do not matter. One message per
    shared topic is sent. A service or action starts once between two ticks.
    """
    shared = {event_name(event): number for number, group in enumerate(seen.roles.shared_topics) for event in group}
    once = {event_name(event) for event in seen.roles.once_per_tick}
    reactions, started, before, ticked = Counter(), set(), set(), False
    for number, (operation, happened) in enumerate(seen.operations):
        sent = [event for event in happened if event in seen.queued]
        started |= {*sent} & once
        if operation == "tick":
            reactions, started, ticked = Counter(), {*sent} & once, True
        elif operation == "begin":
            before = [enabled for place, _, enabled in seen.moments if place <= number + 1][-1]
        elif operation == "end" and ticked and seen.settings.react_immediately:
            reactions[seen.source(number)] += len(sent)
            if reactions[seen.source(number)] < seen.settings.reactions_per_tick:
                moments = [moment for moment in seen.moments if moment[0] <= number + 1]
                ran = [at for at, (place, event, _) in enumerate(moments) if place == number + 1 and event in sent]
                settled = ran[0] - 1 if ran else len(moments) - 1
                waiting = set.intersection(*(enabled for _, _, enabled in moments[settled:]))
                waiting -= before | {*sent} | started
                topics = {shared[event] for event in sent if event in shared}
                assert all(event in shared and shared[event] in topics for event in waiting)


@pytest.mark.slow
@_some
@given(_observed)
def test_settling(seen: Observed) -> None:
    bound = seen.roles.settling_bound
    for _, happened in seen.operations:
        row = 0
        for event in happened:
            row = row + 1 if event in seen.silent else row if event in seen.data or event == "livelock" else 0
            assert row <= bound
            assert event != "livelock" or row == bound


@pytest.mark.slow
@_some
@given(_observed)
def test_data_rests_at_the_first_statement_whose_condition_holds(seen: Observed) -> None:
    engine = seen.loop.engine
    for events in seen.roles.data:
        plant = plant_of(events[0])
        wanted = next(event for event in events if engine.enabled(event_name(event)))
        assert engine.state[plant.name] == wanted.name.removeprefix("c_")


@pytest.mark.slow
@_some
@given(_observed)
def test_no_enabled_event_waits_while_another_runs_in_two_ticks(seen: Observed) -> None:
    """Queues are fair: in ticks, no event runs twice while another of its kind stays enabled and waits.

    Messages on one topic are fair among themselves: they share the topic's turn in each round. Reactions are not
    rounds: there, an event waits for the tick unless the batch concerns it.
    """
    ticks = {number for number, (kind, _) in enumerate(seen.operations, 1) if kind == "tick"}
    shared = {event_name(event): number for number, group in enumerate(seen.roles.shared_topics) for event in group}
    runs = [
        place for place, (operation, event, _) in enumerate(seen.moments) if operation in ticks and event in seen.queued
    ]
    for first, second in combinations(runs, 2):
        event = seen.moments[first][1]
        if seen.moments[second][1] == event:
            between = seen.moments[first:second]
            waited = set.intersection(*(enabled for _, _, enabled in between)) - {event for _, event, _ in between}
            for name in waited:
                assert name.endswith("c_cancel") != event.endswith("c_cancel") or (
                    name in shared and shared[name] != shared.get(event)
                )
