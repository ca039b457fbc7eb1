"""The control loop of every generated controller, in Python: batches of incoming data, ticks, settling."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.engine.interpreter import Engine
from robosc.semantics.roles import event_name, plant_of

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Mapping, Sequence

    from robosc.engine.state import State, Value
    from robosc.metamodel import sct


@dataclass(frozen=True)
class Settings:
    """How much the loop does.

    Events in one tick (0: no limit), reactions to one topic, service or action between two ticks, whether it reacts.
    """

    events_per_tick: int = 0
    reactions_per_tick: int = 10
    react_immediately: bool = True


@dataclass(frozen=True)
class Hooks:
    """What the loop calls, if given. No hook may call the loop.

    `before`: an enabled event is about to happen; False withholds it where it is a cancel, a trigger or silent, until
    it is asked again. `after`: it has happened. `livelock`: silent events don't come to rest; once, until they have
    rested again.
    """

    before: Callable[[str], bool] | None = None
    after: Callable[[str], None] | None = None
    livelock: Callable[[], None] | None = None


class ControlLoop:
    """Runs a model with its supervisor.

    Incoming data: `begin()`, `perform(event, data)` for each event of the batch, `end()`. Every period: `tick()`. After
    `end` and `tick` silent events and data plants rest, or a livelock was reported. Cancels and triggers run from two
    queues, the least recently run first. Each topic, service and action has a count of reactions of its own, so that
    none uses up another's. Raises what `Engine` raises.
    """

    def __init__(
        self, model: sct.SupervisoryControlModel, settings: Settings | None = None, hooks: Hooks | None = None
    ) -> None:
        self.engine = Engine(model)
        self.settings = settings or Settings()
        self.hooks = hooks or Hooks()
        roles = self.engine.roles
        self._cancels = [event_name(each) for each in roles.cancels]
        self._triggers = [event_name(each) for each in roles.triggers]
        self._silent = [event_name(each) for each in roles.silent]
        self._data = [_places(events) for events in roles.data]
        self._bound = roles.settling_bound
        self._data_plants = {event_name(event): plant for event, plant in roles.data_plants.items()}
        self._topics = {
            event_name(event): number for number, events in enumerate(roles.shared_topics) for event in events
        }
        self._sources = {
            event_name(event): number for number, events in enumerate(roles.sources, 1) for event in events
        }
        self._once_per_tick = {event_name(each) for each in roles.once_per_tick}
        self._next_silent = 0
        self._rested = False
        self._livelocked = False
        self._ticked = False
        self._reactions = [0] * (len(roles.sources) + 1)
        self._source = 0
        self._owed: set[str] = set()
        self._sent_to: set[int] = set()
        self._started: set[str] = set()
        self._enabled_before: set[str] = set()
        self._data_before: dict[str, int] = {}
        self._state_before = self.engine.state

    @property
    def state(self) -> State:
        """The current state."""
        return self.engine.state

    def enabled(self, event: str) -> bool:
        """Whether the event can happen now."""
        return self.engine.enabled(event)

    def perform(self, event: str, data: Mapping[str, Value] | None = None) -> bool:
        """Lets one event happen with its data, if it is enabled and not withheld; says whether it did."""
        if data:
            self.engine.set_inputs(event, data)
        happened = self.engine.enabled(event) and self._run(event)
        if happened:
            self._source = self._sources.get(event, 0)
        return happened

    def begin(self) -> None:
        """Starts a batch: what one message from the robot means. Its last event says which topic it comes from."""
        self._settle()
        self._source = 0
        self._state_before = self.engine.state
        self._enabled_before = {each for each in self._queued() if self.engine.enabled(each)}
        self._data_before = self._data_locations()

    def end(self) -> None:
        """Ends a batch: settles, then runs each cancel and trigger that it made possible, or whose data it changed.

        What found its count used up is owed: until the next tick it runs after another batch that changes the state.
        """
        self._settle()
        if self._ticked and self.settings.react_immediately:
            if self._owed and self.engine.state == self._state_before:
                return
            self._owed.update(self._candidates())
            self._sent_to.clear()
            left = self._serve(self._owed, self._reactions[self._source])
            self._reactions[self._source] = left
            if left:
                self._owed.clear()

    def tick(self) -> None:
        """Settles, then runs each enabled cancel and trigger once."""
        self._ticked = True
        self._reactions = [self.settings.reactions_per_tick] * len(self._reactions)
        self._owed.clear()
        self._sent_to.clear()
        self._started.clear()
        self._settle()
        self._serve(self._queued(), self.settings.events_per_tick or len(self._queued()))

    def settle(self) -> None:
        """Settles, then runs each enabled cancel once: what a supervisory layer, without ticks, does after an event."""
        self._settle()
        self._serve(self._cancels, len(self._cancels))

    def _queued(self) -> list[str]:
        return [*self._cancels, *self._triggers]

    def _candidates(self) -> list[str]:
        """What is enabled now and was not before the batch, or has other data."""
        data = self._data_locations()
        return [
            each
            for each in self._queued()
            if self.engine.enabled(each)
            and (each not in self._enabled_before or data.get(each) != self._data_before.get(each))
        ]

    def _serve(self, due: Collection[str], most: int) -> int:
        """Asks each due event at its turn, cancels first, and runs at most so many; returns what is left of these.

        The model has settled whenever one is asked.
        """
        for queue in (self._cancels, self._triggers):
            for event in [each for each in queue if each in due]:
                if most == 0:
                    break
                if self._free(event) and self.engine.enabled(event) and self._run(event):
                    self._settle()
                    most -= 1
        return most

    def _free(self, event: str) -> bool:
        return event not in self._started and self._topics.get(event) not in self._sent_to

    def _run(self, event: str) -> bool:
        """Lets an enabled event happen, unless the caller withholds it."""
        own = event in self._cancels or event in self._triggers or event in self._silent
        if self.hooks.before is not None and not self.hooks.before(event) and own:
            return False
        self.engine.perform(event)
        self._rested = False
        self._owed.discard(event)
        for queue in (self._cancels, self._triggers):
            if event in queue:
                queue.remove(event)
                queue.append(event)
        if event in self._topics:
            self._sent_to.add(self._topics[event])
        if event in self._once_per_tick:
            self._started.add(event)
        if self.hooks.after is not None:
            self.hooks.after(event)
        return True

    def _settle(self) -> None:
        left = self._bound
        while not self._rested:
            self._provide()
            ahead = self._silent[self._next_silent :] + self._silent[: self._next_silent]
            ran = withheld = False
            for event in ahead:
                if self.engine.enabled(event):
                    if left == 0:
                        if not self._livelocked and self.hooks.livelock is not None:
                            self.hooks.livelock()
                        self._livelocked = True
                        return
                    ran = self._run(event)
                    withheld = withheld or not ran
                if ran:
                    self._next_silent = (self._silent.index(event) + 1) % len(self._silent)
                    left -= 1
                    break
            else:
                self._livelocked = False
                if withheld:
                    return
                self._rested = True

    def _provide(self) -> None:
        """Moves each data plant to the first of its locations whose condition holds."""
        for events in self._data:
            chosen = next(((event, places) for event, places in events if self.engine.enabled(event)), None)
            if chosen is not None:
                event, places = chosen
                location = self.engine.location(places.plant)
                if places.target(location) != location:
                    self._run(event)

    def _data_locations(self) -> dict[str, int]:
        return {event: self.engine.location(plant) for event, plant in self._data_plants.items()}


@dataclass(frozen=True)
class _Places:
    """Where a data event leads its plant: from everywhere to one location, else by the location that it is in."""

    plant: sct.Plant
    everywhere: int | None
    targets: Mapping[int, int]

    def target(self, location: int) -> int | None:
        """The location after the event in a location."""
        return self.targets.get(location) if self.everywhere is None else self.everywhere


def _places(events: Sequence[sct.Event]) -> list[tuple[str, _Places]]:
    """The data events of one plant by name."""
    plant = plant_of(events[0])
    numbers = {location: number for number, location in enumerate(plant.locations)}
    everywhere = {edge.event: numbers[edge.target] for edge in plant.edges}
    targets: dict[sct.Event, dict[int, int]] = {event: {} for event in events}
    for location, number in numbers.items():
        for edge in location.edges:
            if edge.event in targets:
                targets[edge.event][number] = numbers[edge.target]
    return [(event_name(event), _Places(plant, everywhere.get(event), targets[event])) for event in events]
