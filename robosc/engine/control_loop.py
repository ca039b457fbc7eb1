"""Control loop of every generated controller, in Python: batches of incoming data, ticks, settling."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from robosc.engine.interpreter import Engine
from robosc.engine.timers import Timers
from robosc.model import engine

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Mapping

    from robosc.engine.state import State, Value
    from robosc.model import sct


@dataclass(frozen=True)
class Settings:
    """Limits of a control loop.

    `events_per_tick`: maximum number of cancels and triggers in a tick; 0: no limit. `reactions_per_tick`: maximum
    number that one topic, service or action starts between two ticks. `react_immediately`: whether the end of a batch
    starts any. `resolution_ms`: maximum delay in milliseconds of the caller's time, which is rounded down, behind the
    true time. It is added to every timer so that none expires early.
    """

    events_per_tick: int = 0
    reactions_per_tick: int = 10
    react_immediately: bool = True
    resolution_ms: int = 0


@dataclass(frozen=True)
class Hooks:
    """Optional callbacks of the loop. No callback may call the loop.

    `before`: an enabled event is about to happen. If it is a cancel, a trigger or silent, False withholds it until the
    loop tries it again. For a command with inputs, the callback sets them (`engine.set_inputs`). The loop withholds the
    command if they are not allowed. `after`: the event has happened. `livelock`: silent events do not settle. It is
    called once until they have settled again.
    """

    before: Callable[[str], bool] | None = None
    after: Callable[[str], None] | None = None
    livelock: Callable[[], None] | None = None


class SavedLoop(NamedTuple):
    """State of a control loop between two calls. `restore` accepts it, also in another loop of the model."""

    cells: tuple[int, ...]
    inputs: tuple[int, ...]
    timers: tuple[int, Mapping[int, int]]
    rest: tuple[Any, ...]


class ControlLoop:
    """Runs a model with its supervisor.

    For incoming data, call `begin()`, `perform(event, data)` for each event of the batch, and `end()`. Call `tick()`
    periodically.

    Settling runs silent events to completion. The loop selects data before each of them and at the end. It reports a
    livelock if more of them follow each other than the model's bound. The loop has settled after `end` and `tick`.
    Cancels and triggers run from two queues, the least recently run first. Each topic, service and action has its own
    count of reactions, so that none exhausts another's. Raises the exceptions of `Engine`.

    `timers` are the model's timers. Set their time before each call (`timers.at`). When the next one is due
    (`timers.wait`), call `expire` until it returns None.
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
        #: Groups with an event that has run.
        self._taken: set[engine.Group] = set()
        self._state_before = self.engine.state

    @property
    def state(self) -> State:
        """Current state."""
        return self.engine.state

    @property
    def saved(self) -> SavedLoop:
        """State of the loop. Precondition: no call and no batch is active."""
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
        """Restore the state of the loop from `saved`."""
        self.engine.restore((saved.cells, saved.inputs))
        self.timers.restore(saved.timers)
        cancels, triggers, reactions, owed, taken, *counted = saved.rest
        self._cancels, self._triggers, self._reactions = list(cancels), list(triggers), list(reactions)
        self._owed, self._taken = set(owed), {self._groups_by_number[number] for number in taken}
        self._next_silent, self._quiescent, self._livelocked, self._ticked = counted

    def enabled(self, event: str) -> bool:
        """Return whether the event can happen now."""
        return self.engine.enabled(event)

    def perform(self, event: str, data: Mapping[str, Value] | None = None) -> bool:
        """Perform an event with its data, if it is enabled and not withheld. Return whether it happened."""
        if data:
            self.engine.set_inputs(event, data)
        happened = self.engine.enabled(event) and self._run(event)
        if happened:
            self._source = self._sources.get(event, 0)
        return happened

    def begin(self) -> None:
        """Start a batch: the events of one message from the robot. The last event of the batch determines its topic."""
        self._settle()
        self._source = 0
        self._state_before = self.engine.state

    def end(self) -> None:
        """End a batch: settle, then run the cancels and triggers that it enabled or whose data it changed.

        None runs before the first tick or without `react_immediately`. One topic, service or action starts at most
        `reactions_per_tick` of them between two ticks. The rest waits for the end of a later batch that changes the
        state, or for the next tick.
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
        """Perform the event of the timer that expired first, as a batch.

        Return the event, or None if no timer expired.
        """
        event = self.timers.expire()
        if event is not None:
            self.begin()
            self.perform(event)
            self.end()
        return event

    def tick(self) -> None:
        """Settle, then run each enabled cancel and trigger once, cancels first.

        At most `events_per_tick` run, and at most one of those that share a topic.
        """
        self._ticked = True
        self._reactions = [self.settings.reactions_per_tick] * len(self._reactions)
        self._owed.clear()
        self._taken.clear()
        self._settle()
        self._serve(self._queued(), self.settings.events_per_tick or len(self._queued()))

    def settle(self, *, cancels: bool = True) -> None:
        """Settle, then run each enabled cancel once if `cancels`.

        A supervisory layer, which has no ticks, does this after an event.
        """
        self._settle()
        if cancels:
            self._serve(self._cancels, len(self._cancels))

    def _queued(self) -> list[str]:
        return [*self._cancels, *self._triggers]

    def _candidates(self) -> list[str]:
        """Return the events that the batch enabled, or whose data it changed."""
        before, now = self._state_before, self.engine.state
        return [
            event
            for event in self._queued()
            if self.engine.enabled(event)
            and (not self.engine.enabled(event, before) or self._data(event, before) != self._data(event, now))
        ]

    def _data(self, event: str, state: State) -> Value | None:
        """Return the selection of the event's data in a state."""
        return state[self._chosen_in[event].name] if event in self._chosen_in else None

    def _serve(self, due: Collection[str], most: int) -> int:
        """Run enabled events of `due` in turn, cancels first, at most `most`; return how many more may run.

        The model has settled before each of them.
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
        """Run an enabled event unless the caller or its data withholds it. Return whether it happened."""
        if self.hooks.before is not None and not self.hooks.before(event) and event in self._own:
            return False
        if not self.engine.permits_inputs(event):
            return False
        self._happen(event)
        return True

    def force(self, event: str) -> None:
        """Perform an event that has happened although the supervisor or an assumption forbids it; see `Engine.force`.

        The hook `before` is called as for other events, but cannot withhold it.
        """
        if self.hooks.before is not None:
            self.hooks.before(event)
        self._happen(event)

    def _happen(self, event: str) -> None:
        self.timers.before(event)
        self.engine.force(event)
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
        """Select the data to send: for each choice, the first alternative whose event is enabled."""
        for alternatives in self._choices:
            event, chosen = next(
                (alternative for alternative in alternatives if self.engine.enabled(alternative[0])), ("", None)
            )
            if event and not (chosen is not None and chosen()):
                self._run(event)

    def _chosen(self, alternative: engine.Alternative) -> Callable[[], bool] | None:
        return None if alternative.chosen is None else self.engine.condition(alternative.chosen)
