"""Judge of a recorded run: each command by the supervisor, each event of the robot by the model."""

from __future__ import annotations

import math
from collections import deque
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any

from robosc.engine import Blocked
from robosc.engine import Settings as LoopSettings
from robosc.model import expression as ex
from robosc.model import rosgraph, sct
from robosc.model.semantics.edges import edges_by_event, origin
from robosc.model.semantics.messages import find_message, path_of, receptions
from robosc.model.semantics.operators import UnreadableError
from robosc.model.semantics.roles import assumption_text, event_name, plant_of
from robosc.run.audit.findings import SECOND, Audit, Finding, Kind
from robosc.run.audit.shared_topics import SharedTopics
from robosc.run.runtime.core.composer import Composer
from robosc.run.runtime.core.event_handler import EventHandler
from robosc.run.runtime.core.event_loop import EventLoop
from robosc.run.runtime.core.node_data import UNSENDABLE, why_unsendable, within_range
from robosc.run.runtime.core.times import RESOLUTION_MS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from robosc.engine.state import State
    from robosc.language.configuration import Configuration
    from robosc.model.semantics.component_parts import Parts
    from robosc.run.audit.port import RecordingPort
    from robosc.run.runtime.core.json_text import Json
    from robosc.run.runtime.core.port import Client, Message
    from robosc.run.runtime.core.settings import Settings

    #: Called after each event with its name, and for each finding with the name of its event and the finding.
    Watch = Callable[[str, Finding | None], None]

#: Maximum number of times that timers expire between two messages.
_MOST_EXPIRIES = 100_000
#: Nanoseconds for which past states are remembered.
_MEMORY = SECOND


def safe_messages(graph: rosgraph.RosGraph, configuration: Configuration) -> set[rosgraph.Sending]:
    """Return the messages that a node sends in spite of requirements, by its configuration."""
    names = {*configuration.on_shutdown, *configuration.on_withheld, *configuration.on_blocked}
    return {sending for name in names if (sending := find_message(graph, name)) is not None}


@dataclass(eq=False)
class _Command:
    """A command of the recording, as one of several that share a topic.

    While it waits, `chosen` is the one that its `findings` are about. `is_accepted`: it was permitted shortly before.
    """

    sendings: Sequence[rosgraph.Sending]
    message: Message
    is_known: bool
    topic: str
    time: int
    done: Callable[[bool], None] | None
    wire_types: Callable[[Message], Mapping[str, str]]
    chosen: Any = None
    findings: list[Finding] = field(default_factory=list)
    is_accepted: bool = False


class Judge(EventHandler):
    """Judge of the commands of a layer. It forwards nothing: the recorded command has reached the robot.

    A forbidden command, and an event against an assumption, happen for all components that have a transition for it.
    A command that is permitted at some time within `tolerance` nanoseconds before or after it is no finding: recordings
    do not order the messages of different topics more precisely. `watch` is called after each
    event with its name, and for each finding with the finding.
    """

    def __init__(
        self,
        graph: rosgraph.RosGraph,
        settings: Settings,
        port: RecordingPort,
        tolerance: int = 0,
        watch: Watch | None = None,
    ) -> None:
        super().__init__(graph, settings, port, EventLoop(port.now), LoopSettings(resolution_ms=RESOLUTION_MS))
        self.audit = Audit(graph.name)
        self.engine = self._control.engine
        self.timers = self._control.timers
        self._recorder = port
        self._tolerance = tolerance
        self._watch = watch
        self._composer = Composer(port, self._data)
        self._shared = SharedTopics(port, self._composer)
        self._safe = safe_messages(graph, settings.configuration)
        self._origins = {event: plant_of(event).origin or plant_of(event).name for event in self._names}
        #: Topic of the present message.
        self.topic = ""
        self._time = self._offset = 0
        #: Past states, with the times at which they began, the latest last.
        self._past: deque[tuple[int, State]] = deque()
        self._transitions = self._places_of_transitions()
        self._ranges = {
            reception.event: [
                (assigned.value, assigned.input.type)
                for assigned in reception.inputs
                if isinstance(assigned.value, rosgraph.WireAccess) and isinstance(assigned.input.type, ex.IntegerType)
            ]
            for reception in receptions(graph)
        }
        self._plants = {
            element: f"{element.origin or element.name}"
            for element in graph.model.plants
            if element.kind == sct.PlantKind.behaviour
        }
        #: Components of which no event has happened yet, and the components of each event.
        self._unheard = set(self._plants)
        self._involved = {
            event_name(event): [plant for plant in taking_part if plant in self._plants]
            for event, taking_part in edges_by_event(graph.model.plants).items()
        }
        #: Goals that the supervisor would cancel, with the time since when.
        self._due: dict[rosgraph.ActionClient, int] = {}
        self._actions = list(graph.actionClients)
        self._patience = settings.seconds("action_timeout_ms") if self._actions else 0.0
        self._decisive: dict[sct.Event, set[sct.Plant]] = {}
        #: Commands that are not permitted yet, in the order of their times.
        self._waiting: deque[_Command] = deque()

    def _deciding(self, event: sct.Event) -> set[sct.Plant]:
        """Return the components whose states and variables decide whether an event is possible."""
        if event not in self._decisive:
            elements = self.engine.reads(self._names[event])
            plants = {element if isinstance(element, sct.Plant) else element.eContainer() for element in elements}
            self._decisive[event] = plants & self._plants.keys()
        return self._decisive[event]

    def _places_of_transitions(self) -> dict[sct.Event, list[tuple[sct.Plant, frozenset[int]]]]:
        """Return the components with transitions for a message, each with the positions of the states that have one.

        Components with a transition in every state are left out.
        """
        places: dict[sct.Event, list[tuple[sct.Plant, frozenset[int]]]] = {}
        for event, taking_part in edges_by_event(self._graph.model.plants).items():
            if event.kind is not sct.EventKind.response or plant_of(event).kind != sct.PlantKind.message:
                continue
            for plant, edges in taking_part.items():
                written = [edge for edge in edges if edge.source is not None]
                owners = [origin(edge) for edge in written]
                if plant.kind == sct.PlantKind.behaviour and written and None not in owners:
                    positions = frozenset(number for number, place in enumerate(plant.locations) if place in owners)
                    if len(positions) < len(plant.locations):
                        places.setdefault(event, []).append((plant, positions))
        return places

    # Time

    @property
    def time(self) -> int:
        """The latest time of the recording, in nanoseconds."""
        return self._time

    def begin(self, time: int, state: Mapping[sct.Plant | sct.DiscreteVariable, Any] | None = None) -> None:
        """Start at a time in nanoseconds, in the initial state, or in the state that differs in these values."""
        self.audit.start = self._time = time
        self._offset = 0 if time >= SECOND else SECOND  # a clock at 0 has not begun
        self._recorder.time = (time + self._offset) / SECOND
        if state:
            self.engine.state = self.engine.state_with(state)
            self._unheard -= {element if isinstance(element, sct.Plant) else element.eContainer() for element in state}
        self._times.start()
        with self._times:
            self._control.settle(cancels=False)
        self._remember()

    def start(self) -> None:
        """Do nothing: `begin` starts at a time."""

    def advance(self, time: int) -> None:
        """Let time pass; a time before the latest one counts as that. Timers expire at their times."""
        port, loop = self._recorder, self._event_loop
        while self._waiting and self._waiting[0].time + self._tolerance < time:
            self._decide_first()
        now = (time + self._offset) / SECOND
        expiries = 0
        while (wait := loop.run_pending()) is not None and port.time + wait <= now:
            expiries += 1
            if expiries > _MOST_EXPIRIES:
                self.audit.note(
                    f"timers expire more than {_MOST_EXPIRIES:,} times between two messages: some are left out"
                )
                break
            port.time = max(port.time + wait, math.nextafter(port.time, math.inf))
            self._time = max(self._time, min(time, round(port.time * SECOND) - self._offset))
        port.time = max(port.time, now)
        self._time = max(self._time, time)
        self.audit.end = self._time

    def call_later(self, seconds: float, action: Callable[[], None]) -> Any:
        """Make a call after some time of the recording."""
        return self._event_loop.call_later(seconds, action)

    def _remember(self) -> None:
        """Remember the present state if it is new, and the goals that the supervisor would cancel now."""
        state, past = self.engine.state, self._past
        if past and past[-1][1].cells == state.cells:
            return
        for client in self._actions:
            if not self._control.enabled(self._names[client.cancel]):
                self._due.pop(client, None)
            elif client not in self._due:
                self._due[client] = self._time
                self.call_later(self._patience, partial(self._miss_cancel, client, self._time))
        past.append((self._time, state))
        limit = self._time - max(_MEMORY, self._tolerance)
        while len(past) > 1 and past[1][0] <= limit:
            past.popleft()

    def _miss_cancel(self, client: rosgraph.ActionClient, since: int) -> None:
        """Add a finding for a goal that has gone on although the supervisor would have canceled it."""
        if self._due.get(client) == since:
            failing = self.engine.failing_requirements(self._names[client.request.event])
            texts = [requirement.text for requirement in failing if requirement.text]
            self._add(self._finding(Kind.FORBIDDEN, client.cancel, "cancel", texts), since)

    def _permitted_before(self, name: str, *, with_data: bool) -> int | None:
        """Return the nanoseconds since a command was last permitted; None if that is unknown."""
        ended = self._time
        for began, state in reversed(self._past):
            if self.engine.enabled(name, state) and (not with_data or self.engine.permits_inputs(name, state)):
                return self._time - ended
            ended = began
        return None

    # Findings

    def _finding(
        self, kind: Kind, event: sct.Event, reason: str, because: Sequence[str], since: int | None = None
    ) -> Finding:
        finding = Finding(kind, self._names[event], self._origins[event], self.topic, reason, because, {}, since)
        if not self.audit.repeats(finding):
            finding.components = self._reports.components()
            finding.unheard = sorted({self._plants[plant] for plant in self._unheard & self._deciding(event)})
        return finding

    def _add(self, finding: Finding, time: int) -> None:
        finding = self.audit.add(finding, time)
        if self._watch is not None:
            self._watch(finding.event, finding)

    def _find(self, kind: Kind, event: sct.Event, reason: str, because: Sequence[str]) -> None:
        self._add(self._finding(kind, event, reason, because), self._time)

    def unexpected(self, event: sct.Event, why: str) -> None:
        """Add a finding of an event that the model does not expect."""
        self._find(Kind.UNEXPECTED, event, "state", [why])

    # Commands

    def command(
        self,
        sendings: Sequence[rosgraph.Sending],
        message: Message,
        done: Callable[[bool], None] | None = None,
        *,
        is_known: bool = True,
    ) -> None:
        """Judge a command with its data. It is one of `sendings`, which share a topic.

        Without `is_known`, the recording does not have the data: the command is a finding if no data permits it. `done`
        is called, perhaps later, with whether the model has a transition for it.
        """
        self.audit.commands += 1
        types = self._recorder.recorded_types
        command = _Command(sendings, message, is_known, self.topic, self._time, done, types)
        if not self._waiting and (sending := self._permitted(command)) is not None:
            self._happen(command, sending)
            return
        if any(sending in self._safe and self._shared.has_data(sending, message) for sending in sendings):
            self.audit.safe += 1
            return
        self._waiting.append(command)
        with self._as_of(command):
            self._forbid(command)
        if not self._tolerance or command.is_accepted:
            self.decide()

    def decide(self) -> None:
        """Decide on all commands that wait: no later message can permit them."""
        while self._waiting:
            self._decide_first()

    def _decide_first(self) -> None:
        """Decide on the first command that waits, and on those that it permits."""
        command = self._waiting.popleft()
        sending = self._permitted(command) or command.chosen
        if command.is_accepted:
            self.audit.tolerated += 1
        else:
            for finding in command.findings:
                self._add(finding, command.time)
        self._happen(command, sending, is_found=not command.is_accepted)
        self._retry()

    def _retry(self) -> None:
        """Let the commands that wait happen, in their order, as far as they are permitted by now."""
        while self._waiting and (sending := self._permitted(self._waiting[0])) is not None:
            self.audit.tolerated += 1
            self._happen(self._waiting.popleft(), sending)

    def _candidates(self, command: _Command) -> list[rosgraph.Sending]:
        """Return the commands of a topic that can have the data of a message."""
        sendings = list(command.sendings)
        if len(sendings) == 1:
            return sendings
        having = [sending for sending in sendings if self._shared.has_data(sending, command.message)]
        return having or [sending for sending in sendings if not self._shared.is_constant(sending)]

    def _permitted(self, command: _Command) -> rosgraph.Sending | None:
        """Return the command that is permitted now, of those that the message can be."""
        self._recorder.recorded_types = command.wire_types
        return next((sending for sending in self._candidates(command) if self._is_permitted(sending, command)), None)

    def _is_permitted(self, sending: rosgraph.Sending, command: _Command) -> bool:
        name = self._names[sending.event]
        if not self.engine.enabled(name):
            return False
        return not command.is_known or (
            not self._set_inputs(sending, command.message) and self.engine.permits_inputs(name)
        )

    def _forbid(self, command: _Command) -> None:
        """Set the findings of a command that is not permitted now, and whether it was permitted shortly before."""
        candidates = self._candidates(command)
        if not candidates:
            command.chosen = next(
                (sending for sending in command.sendings if not self._is_permitted(sending, command)),
                command.sendings[0],
            )
            names = " and ".join(f"`{sending.name}`" for sending in command.sendings)
            why = f"{names} never have this data"
            command.findings.append(self._finding(Kind.UNEXPECTED, command.chosen.event, "state", [why]))
            if self._is_permitted(command.chosen, command):
                return
        else:
            command.chosen = candidates[0]
        event, is_known = command.chosen.event, command.is_known
        fault = self._set_inputs(command.chosen, command.message) if is_known else ""
        if fault:
            command.findings.append(self._finding(Kind.FORBIDDEN, event, "data", [fault]))
            return
        since = self._permitted_before(self._names[event], with_data=is_known)
        is_close = self._tolerance > 0 and since is not None and since <= self._tolerance
        command.is_accepted = bool(candidates) and is_close
        reason = self._blocking.reason(event)
        command.findings.append(self._finding(Kind.FORBIDDEN, event, reason.kind, reason.because, since))

    @contextmanager
    def _as_of(self, command: _Command) -> Iterator[None]:
        """Use the topic of a command."""
        topic, self.topic = self.topic, command.topic
        yield
        self.topic = topic

    def _happen(self, command: _Command, sending: rosgraph.Sending, *, is_found: bool = False) -> None:
        """Perform a command that the robot has got, as far as the model has a transition for it."""
        self._recorder.recorded_types = command.wire_types
        event, message, name = sending.event, command.message, self._names[sending.event]
        with self._as_of(command), self._times:
            is_readable = command.is_known and not self._set_inputs(sending, message)
            if not is_found:
                beyond = self._beyond_limits(sending, message) if is_readable else []
                if beyond:
                    self._add(self._finding(Kind.FORBIDDEN, event, "limit", beyond), command.time)
                else:
                    self.audit.clear(name)
            happens = self._has_transition(name, with_data=is_readable)
            before = self.engine.state.cells
            if happens:
                self._sent = message
                self._control.force(name)
                self._sent = None
                self._control.settle(cancels=False)
        if self.engine.state.cells != before:
            self._past.clear()  # the controller knows its own commands
        self._remember()
        if command.done is not None:
            command.done(happens)

    def _has_transition(self, name: str, *, with_data: bool) -> bool:
        """Return whether the plants have a transition for a command."""
        if self.engine.blocked_by(name) is Blocked.PLANT:
            return False
        return not with_data or self.engine.inputs_blocked_by(name) is not Blocked.PLANT

    def _set_inputs(self, sending: rosgraph.Sending, message: Message) -> str:
        """Set the inputs of a command; return why they can't be read, empty if they can."""
        if not sending.inputs and not sending.limits:
            return ""
        try:
            self._composer.limited_fields(sending, message)  # its doubles are finite
            self.engine.set_inputs(self._names[sending.event], self._composer.inputs(sending, message))
        except UNSENDABLE as error:
            return why_unsendable(error)
        return ""

    def _beyond_limits(self, sending: rosgraph.Sending, message: Message) -> list[str]:
        """Return the fields of a command that its limits would change, in words."""
        if not sending.limits:
            return []
        beyond = []
        for path, value in self._composer.limited_fields(sending, message).items():
            own = message
            for step in path:
                own = getattr(own, step)
            own = own.tolist() if hasattr(own, "tolist") else own
            if own != value:
                beyond.append(f"{'.'.join(path)} is {own}, limited to {value}")
        return beyond

    def cancel(self, client: rosgraph.ActionClient) -> None:
        """Note that a goal is being canceled: by the supervisor if it permits that now, else by others."""
        with self._batch():
            self._control.perform(self._names[client.cancel])

    def adopt(self, client: rosgraph.ActionClient) -> None:
        """Note that a goal is active that the model does not know: its request happens without a judgment."""
        name = self._names[client.request.event]
        if self._has_transition(name, with_data=False):
            with self._batch():
                self._control.force(name)

    # Events of the robot

    @contextmanager
    def _batch(self) -> Iterator[None]:
        with self._times:
            yield
            self._control.settle(cancels=False)
        self._remember()
        self._retry()

    def _perform(
        self,
        event: sct.Event,
        inputs: Sequence[rosgraph.InputAssignment] = (),
        message: Message = None,
        source: sct.Event | None = None,
    ) -> UnreadableError | None:
        """Perform an event of the robot, also against an assumption; return why its data can't be read, else None."""
        self.audit.events += 1
        name, violated = self._names[event], []
        if not self._control.enabled(name):
            violated = self.engine.violated_assumptions(name)
            if not violated:
                self._find(Kind.UNEXPECTED, event, "state", self._states_of(event))
                return None
        try:
            received = self._data.receive(event, inputs, message)
        except UnreadableError as fault:
            self._find(Kind.UNEXPECTED, event, "data", [str(fault)])
            return fault
        except AttributeError as fault:  # a type of another version
            self._find(Kind.UNEXPECTED, event, "data", [f"the message has no field `{fault.name}`"])
            return UnreadableError(str(fault))
        outside = self._outside(event, message)
        if violated:
            self._find(Kind.ASSUMPTION, event, "assumption", list(map(assumption_text, violated)))
        elif outside:
            self._find(Kind.UNEXPECTED, event, "range", outside)
        else:
            self.audit.clear(name)
        for plant, positions in self._transitions.get(event, ()):
            if (position := self.engine.location(plant)) not in positions:
                self.audit.ignore(name, f"{self._plants[plant]}.{plant.locations[position].name}")
        self._data.variables.update(received.variables)
        if violated:
            self.engine.set_inputs(name, received.inputs)
            self._control.force(name)
        else:
            self._run(event, (source or event, message), received.inputs)
        return None

    def _outside(self, event: sct.Event, message: Message) -> list[str]:
        """Return the integers of a message that are outside their range, in words."""
        outside = []
        for access, kind in self._ranges.get(event, ()):
            try:
                value = self._data.value(access, message)
            except UnreadableError:
                continue
            if within_range(value, kind) != value:
                place = ".".join(path_of(access))
                outside.append(f"{place} is {value}, expected {kind.minimum} to {kind.maximum}")
        return outside

    def _states_of(self, event: sct.Event) -> list[str]:
        """Return the state in which an answer is not possible: that of its communication."""
        plant = plant_of(event)
        return [f"{plant.origin or plant.name}.{plant.locations[self.engine.location(plant)].name}"]

    # Hooks of the event handler

    def _changes(self, event: sct.Event) -> bool:
        try:
            return super()._changes(event)
        except AttributeError:  # the recording does not have the data of the command
            return True

    def _follow_up(self) -> None:
        self._control.settle(cancels=False)
        self._remember()
        self._retry()

    def _after(self, name: str) -> None:
        if self._unheard:
            self._unheard.difference_update(self._involved.get(name, ()))
        if self._watch is not None:
            self._watch(name, None)

    def _act(self, event: sct.Event) -> tuple[str, Mapping[str, Json] | None] | None:  # noqa: ARG002
        return None

    def _halt(self) -> None:
        """Go on: the robot is recorded."""

    def _note_failure(self, client: Client, why: str, *, logged: bool = False) -> None:
        """Note nothing: the end is an event."""

    def _faults(self, parts: Parts) -> list[str]:  # noqa: ARG002
        return []
