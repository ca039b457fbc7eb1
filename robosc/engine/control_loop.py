"""The control loop of every generated controller, in Python: batches of incoming data, ticks, settling."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from robosc.engine.interpreter import Engine
from robosc.engine.timers import Timers
from robosc.metamodel import engine

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Mapping

    from robosc.engine.state import State, Value
    from robosc.metamodel import sct


@dataclass(frozen=True)
class Settings:
    """Limits of a control loop.

    `events_per_tick`: most cancels and triggers in a tick; 0: no limit. `reactions_per_tick`: most that one topic,
    service or action starts between two ticks. `react_immediately`: whether the end of a batch starts any.
    `resolution_ms`: by how many milliseconds the time that the caller passes may lag behind the true one, as it was
    rounded down; timers are set that much later, so that none expires early.
    """

    events_per_tick: int = 0
    reactions_per_tick: int = 10
    react_immediately: bool = True
    resolution_ms: int = 0


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


class SavedLoop(NamedTuple):
    """All of a control loop between two calls: what `restore` goes back to, also in another loop of the model."""

    cells: tuple[int, ...]
    inputs: tuple[int, ...]
    timers: tuple[int, Mapping[int, int]]
    rest: tuple[Any, ...]


class ControlLoop:
    """Runs a model with its supervisor.

    Incoming data: `begin()`, `perform(event, data)` for each event of the batch, `end()`. Every period: `tick()`.

    To settle is to run silent events to completion, with the choice of data before each and at the end; a livelock is
    reported where more of them follow each other than the model's bound says. After `end` and `tick` the loop has
    settled. Cancels and triggers run from two queues, the least recently run first. Each topic, service and action has
    a count of reactions of its own, so that none uses up another's. Raises what `Engine` raises.

    `timers` are the model's times: tell them before each call what time it is (`timers.at`), and call `expire` when
    they want to be asked (`timers.wait`), until it finds nothing.
    """

    def __init__(
        self, model: sct.SupervisoryControlModel, settings: Settings | None = None, hooks: Hooks | None = None
    ) -> None:
        self.engine = Engine(model)
        self.settings = settings or Settings()
        self.hooks = hooks or Hooks()
        executed = self.engine.executed
        self._cancels = [event.name for event in executed.events if event.role == engine.Role.cancel]
        self._triggers = [event.name for event in executed.events if event.role == engine.Role.trigger]
        self._silent = {
            event.name: position
            for position, event in enumerate(event for event in executed.events if event.role == engine.Role.silent)
        }
        self._own = {*self._cancels, *self._triggers, *self._silent}
        self._choices = [
            [(alternative.event.name, self._chosen(alternative)) for alternative in choice.alternatives]
            for choice in executed.choices
        ]
        self._bound = executed.settlingBound
        self._chosen_in = {
            event.name: event.choice.variable
            for event in executed.events
            if event.choice is not None and event.choice.variable is not None
        }
        self._groups = {event.name: event.group for event in executed.events if event.group is not None}
        self._groups_by_number = list(executed.groups)
        numbers = {source: number for number, source in enumerate(executed.sources, 1)}
        self._sources = {event.name: numbers[event.source] for event in executed.events if event.source is not None}
        self.timers = Timers(self.engine, self.settings.resolution_ms)
        self._next_silent = 0
        self._quiescent = False
        self._livelocked = False
        self._ticked = False
        self._reactions = [0] * (len(executed.sources) + 1)
        self._source = 0
        self._owed: set[str] = set()
        #: The groups of which an event has run.
        self._taken: set[engine.Group] = set()
        self._state_before = self.engine.state

    @property
    def state(self) -> State:
        """The current state."""
        return self.engine.state

    @property
    def saved(self) -> SavedLoop:
        """What the loop is in, when no call and no batch is under way."""
        groups = self._groups_by_number
        rest = (
            tuple(self._cancels),
            tuple(self._triggers),
            tuple(self._reactions),
            frozenset(self._owed),
            frozenset(groups.index(group) for group in self._taken),
            self._next_silent,
            self._quiescent,
            self._livelocked,
            self._ticked,
        )
        return SavedLoop(*self.engine.saved, self.timers.saved, rest)

    def restore(self, saved: SavedLoop) -> None:
        """Goes back to what `saved` was."""
        self.engine.restore((saved.cells, saved.inputs))
        self.timers.restore(saved.timers)
        cancels, triggers, reactions, owed, taken, *counted = saved.rest
        self._cancels, self._triggers, self._reactions = list(cancels), list(triggers), list(reactions)
        self._owed, self._taken = set(owed), {self._groups_by_number[number] for number in taken}
        self._next_silent, self._quiescent, self._livelocked, self._ticked = counted

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

    def end(self) -> None:
        """Ends a batch: settles, then runs each cancel and trigger that it made possible or whose data it changed.

        None is run before the first tick or without `react_immediately`. One topic, service or action starts at most
        `reactions_per_tick` of them between two ticks. What is left over waits for the end of a later batch that
        changes the state, or for the next tick.
        """
        self._settle()
        if self._ticked and self.settings.react_immediately:
            if self._owed and self.engine.state == self._state_before:
                return
            self._owed.update(self._candidates())
            self._taken = {group for group in self._taken if group.span != engine.Span.round}
            left = self._serve(self._owed, self._reactions[self._source])
            self._reactions[self._source] = left
            if left:
                self._owed.clear()

    def expire(self) -> str | None:
        """Lets the first time run out that is up: its event is a batch. Says which event that is; None: none is up."""
        event = self.timers.expire()
        if event is not None:
            self.begin()
            self.perform(event)
            self.end()
        return event

    def tick(self) -> None:
        """Settles, then runs each enabled cancel and trigger once, cancels first.

        At most `events_per_tick` are run, and one of those that share a topic.
        """
        self._ticked = True
        self._reactions = [self.settings.reactions_per_tick] * len(self._reactions)
        self._owed.clear()
        self._taken.clear()
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
        before, now = self._state_before, self.engine.state
        return [
            event
            for event in self._queued()
            if self.engine.enabled(event)
            and (not self.engine.enabled(event, before) or self._data(event, before) != self._data(event, now))
        ]

    def _data(self, event: str, state: State) -> Value | None:
        """Which data the event sends in a state."""
        return state[self._chosen_in[event].name] if event in self._chosen_in else None

    def _serve(self, due: Collection[str], most: int) -> int:
        """Asks each due event at its turn, cancels first, and runs at most so many; returns what is left of these.

        The model has settled whenever one is asked.
        """
        for queue in (self._cancels, self._triggers):
            for event in [event for event in queue if event in due]:
                if most == 0:
                    break
                if self._groups.get(event) not in self._taken and self.engine.enabled(event) and self._run(event):
                    self._settle()
                    most -= 1
        return most

    def _run(self, event: str) -> bool:
        """Lets an enabled event happen, unless the caller withholds it."""
        if self.hooks.before is not None and not self.hooks.before(event) and event in self._own:
            return False
        self.timers.before(event)
        self.engine.perform(event)
        self._quiescent = False
        self._owed.discard(event)
        for queue in (self._cancels, self._triggers):
            if event in queue:
                queue.remove(event)
                queue.append(event)
        if event in self._groups:
            self._taken.add(self._groups[event])
        if self.hooks.after is not None:
            self.hooks.after(event)
        return True

    def _settle(self) -> None:
        left = self._bound
        while not self._quiescent:
            self._provide()
            silent = list(self._silent)
            ahead = silent[self._next_silent :] + silent[: self._next_silent]
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
                    self._next_silent = (self._silent[event] + 1) % len(self._silent)
                    left -= 1
                    break
            else:
                self._livelocked = False
                if withheld:
                    return
                self._quiescent = True

    def _provide(self) -> None:
        """Chooses the data to send: for each choice the first alternative whose event is enabled."""
        for alternatives in self._choices:
            event, chosen = next(
                (alternative for alternative in alternatives if self.engine.enabled(alternative[0])), ("", None)
            )
            if event and not (chosen is not None and chosen()):
                self._run(event)

    def _chosen(self, alternative: engine.Alternative) -> Callable[[], bool] | None:
        return None if alternative.chosen is None else self.engine.condition(alternative.chosen)
