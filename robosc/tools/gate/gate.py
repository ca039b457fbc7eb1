"""Calls of tools: each one is checked, admitted and logged, and commands pass the layer of the robot."""

from __future__ import annotations

import asyncio
import json
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

from robosc.analysis.explain import data_in_short, explain, explore
from robosc.analysis.explain.answers import Reach
from robosc.model import rosgraph
from robosc.run.runtime.core.json_text import json_text
from robosc.tools.gate.admission import Limits, Rates, Writer
from robosc.tools.gate.shapes import Anything, Choice, Fields, Messages, Number, faults_of

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Mapping, Sequence

    from robosc.analysis.explain import Explanation
    from robosc.model import sct
    from robosc.run.runtime.core.event_log import EventLog
    from robosc.run.runtime.core.gate import GatedGoal, GatedLayer, Outcome
    from robosc.run.runtime.core.node import RunningNode
    from robosc.run.runtime.core.port import Message
    from robosc.tools.gate.commands import Command
    from robosc.tools.gate.dry import RobotEvent

    T = TypeVar("T")

#: Name of the tool that plays the robot.
ROBOT = "robot"
#: Verdicts of calls that changed nothing or failed.
ERRORS = frozenset({"refused", "failed"})
#: Seconds that the answer to a refused command waits for its explanation, and that of `why`, and that `wait` waits.
_PATIENCE, _LONG_PATIENCE = 1.0, 5.0
_LONGEST_WAIT, _WAIT = 60.0, 10.0
#: Number of characters of data in the log, and of explanations in memory.
_SHOWN, _MOST_EXPLAINED = 2000, 1000
#: Reasons whose way out depends on the state of the model.
_OF_THE_STATE = {"requirement", "state", "synthesis"}
_WAYS_OUT = {
    "busy": "Wait until the running call or goal has ended, or cancel the goal.",
    "assumption": "Bring the robot into the state that the model describes, and restart `robosc gate`.",
    "data": "Send finite numbers within their ranges, and arrays with the elements that the model reads.",
    "schema": "Send data that fits the schema of the tool.",
    "size": "Send less data.",
    "rate": "Call less often.",
    "writer": "Wait until the other client releases the robot, ends its session, or is silent for long enough.",
    "unknown": "List the tools.",
}


@dataclass(frozen=True)
class Tool:
    """Tool of a gate: its name, its description, the shape of its data, and its effect.

    `writes`: only the writer may call it. `call` gets the client and its data, which fits the shape.
    """

    name: str
    description: str
    shape: Fields
    call: Callable[[str, dict[str, Any]], Awaitable[dict[str, Any]]]
    writes: bool = False

    @property
    def reads(self) -> bool:
        """Whether a call changes nothing."""
        return not self.writes and self.name != ROBOT


def refusal(reason: str, *because: str) -> dict[str, Any]:
    """Return the answer to a call that the gate itself refuses."""
    return {"verdict": "refused", "reason": reason, "because": list(because), "possible": [_WAYS_OUT[reason]]}


@dataclass(eq=False)
class _Write:
    """Call of a tool that writes. `ended`: the session of its client has ended meanwhile."""

    client: str
    ended: bool = False


@dataclass
class Gate:
    """Tools of a robot for clients; its coroutines run in one thread, and the layer in that of its node.

    `frames`: frames of the headers in the data of commands, by their ROS names without a leading slash. `robot`: the
    events of a robot without ROS, by their names.
    """

    model: sct.SupervisoryControlModel
    commands: Sequence[Command]
    node: RunningNode
    layer: GatedLayer
    log: EventLog
    limits: Limits = field(default_factory=Limits)
    frames: Mapping[str, str] = field(default_factory=dict)
    robot: Mapping[str, RobotEvent] = field(default_factory=dict)
    tools: dict[str, Tool] = field(init=False)

    def __post_init__(self) -> None:
        """Create the tools."""
        self._commands = {command.tool: command for command in self.commands}
        self._actions = {
            tool: self.layer.actions[command.element]
            for tool, command in self._commands.items()
            if isinstance(command.element, rosgraph.ActionClient)
        }
        self._messages = Messages(self.node)
        self._rates = Rates(self.limits, time.monotonic)
        self._writer = Writer(self.limits, time.monotonic)
        self._writes: list[_Write] = []
        self._explained: dict[Any, Explanation | None] = {}
        #: The explanation under way: its event and state, and its end.
        self._explaining: tuple[Any, asyncio.Future[Explanation]] | None = None
        self._explainer = ThreadPoolExecutor(1, "explanations")
        self.tools = {tool.name: tool for tool in self._tools()}

    # Tools

    def _tools(self) -> list[Tool]:
        tools = [
            Tool(name, command.description, command.shape, partial(self._command, command), writes=True)
            for name, command in self._commands.items()
        ]
        names = Choice(tuple(self._commands), notes=("A command.",))
        tools.append(
            Tool(
                "state",
                "Return the state of each component, and which commands are allowed now.",
                Fields({}),
                self._state,
            )
        )
        tools.append(
            Tool(
                "why",
                "Explain why a command is forbidden now, and what would make it possible. Nothing is sent.",
                Fields({"command": names, "data": Anything(notes=("Data of the command.",))}, ("command",)),
                self._why,
            )
        )
        if self._actions:
            actions = Choice(tuple(self._actions), notes=("An action.",))
            seconds = Number(0, _LONGEST_WAIT, "d", notes=(f"Longest wait in seconds, at most {_LONGEST_WAIT:g}.",))
            text = "Wait for the end of the last goal of an action. Return its status, feedback and result."
            tools.append(Tool("wait", text, Fields({"command": actions, "seconds": seconds}, ("command",)), self._wait))
            text = "Cancel the goal of an action. `wait` returns its end."
            tools.append(Tool("cancel", text, Fields({"command": actions}, ("command",)), self._cancel, writes=True))
        text = "Stop: cancel your goals, send the configured stop messages, and let another client send commands."
        tools.append(Tool("release", text, Fields({}), self._release, writes=True))
        if self.robot:
            events = Choice(tuple(self.robot), notes=("An event of the simulated robot.",))
            shape = Fields({"event": events, "data": Anything(notes=("Its data, as ROS has it.",))}, ("event",))
            tools.append(Tool(ROBOT, "Cause an event of the simulated robot.", shape, self._robot))
        return tools

    async def call(self, client: str, name: str, data: Any) -> dict[str, Any]:
        """Call a tool and log the call. Return the answer: a `verdict`, and more."""
        answer = {"verdict": "failed", "reason": "canceled", "because": ["the client has canceled the call"]}
        try:
            answer = await self._answer(client, name, {} if data is None else data)
        except Exception as error:  # the robot must not depend on a fault here
            answer = {"verdict": "failed", "reason": "internal", "because": [f"{type(error).__name__}: {error}"]}
        finally:
            self.note(client, name, data, answer)
        return answer

    async def _answer(self, client: str, name: str, data: Any) -> dict[str, Any]:
        tool = self.tools.get(name)
        # A client with many sessions has the rates of one.
        if not self._rates.admits(client.partition("/")[0], name if tool else ""):
            return refusal(
                "rate", f"more than {self.limits.rate:g} calls of a tool, or {self.limits.total:g}, a second"
            )
        if tool is None:
            return refusal("unknown", f"there is no tool {name[:80]}")
        try:
            size = len(json.dumps(data))
        except RecursionError:
            size = self.limits.largest + 1
        if size > self.limits.largest:
            return refusal("size", f"the data has more than {self.limits.largest} characters")
        faults = faults_of(tool.shape, data)
        if faults:
            return refusal("schema", *faults)
        self._writer.note(client)
        if not tool.writes:
            return await tool.call(client, tool.shape.converted(data))
        write = _Write(client)
        self._writes.append(write)
        try:
            await self.expire()
            if write.ended:
                return refusal("writer", "the session of the client has ended")
            if not self._writer.admits(client):
                return refusal("writer", f"{self._writer.holder} is the writer")
            return await tool.call(client, tool.shape.converted(data))
        finally:
            self._writes.remove(write)

    def note(self, client: str, name: str, data: Any, answer: Mapping[str, Any]) -> None:
        """Log a call."""
        entry = {"time": time.time(), "client": client, "tool": name[:_SHOWN], "data": _loggable(data)}
        entry |= {key: answer[key] for key in ("verdict", "reason", "because", "sent", "warning") if key in answer}
        self.log.append(json_text(entry) + "\n")
        if lost := self.log.lost():
            self.node.warn(f"the log of calls lost {lost} lines")

    # Writers

    async def leave(self, client: str) -> None:
        """End the session of a client: stop what it has started."""
        for write in self._writes:
            write.ended |= write.client == client
        if self._writer.leave(client):
            await self._on_node(self.layer.release)
            self.note(client, "", None, {"verdict": "released"})

    async def expire(self) -> None:
        """End the role of a writer that has been silent for too long. A writer waits for its running call and goal."""
        holder = self._writer.holder
        if holder is None or not self._writer.is_silent:
            return
        writes = any(write.client == holder for write in self._writes)
        if writes or await self._on_node(lambda: any(action.runs for action in self._actions.values())):
            self._writer.note(holder)
        else:
            await self.leave(holder)

    async def watch(self) -> None:
        """End the roles of silent writers, forever."""
        while True:
            await asyncio.sleep(min(1.0, self.limits.lease / 4))
            await self.expire()

    async def _release(self, client: str, _: dict[str, Any]) -> dict[str, Any]:
        self._writer.leave(client)
        await self._on_node(self.layer.release)
        return {"verdict": "released"}

    # Commands

    async def _command(self, command: Command, _: str, data: dict[str, Any]) -> dict[str, Any]:
        outcome = await self._post(partial(self._start, command, data))
        answer: dict[str, Any] = {"verdict": outcome.verdict}
        if outcome.verdict not in ERRORS and not outcome.receivers:
            answer["warning"] = f"no node is subscribed to {command.ros_name}"
        if outcome.verdict in ERRORS:
            answer |= await self._obstacle(command, outcome)
        elif outcome.verdict == "answered":
            answer["response"] = await self._plain(outcome.message)
        elif outcome.verdict == "limited":
            answer["sent"] = await self._plain(outcome.message)
        return answer

    def _start(self, command: Command, data: dict[str, Any], done: Callable[[Outcome], None]) -> None:
        """Start a command in the thread of the node."""
        message = self._message(command, data)
        match command.element:
            case rosgraph.Publisher():
                receivers = self.node.receivers(command.element)
                done(replace(self.layer.send(command.sending, message), receivers=receivers))
            case rosgraph.ServiceClient():
                self.layer.call(command.element, message, done)
            case rosgraph.ActionClient():
                self.layer.start_goal(command.element, message, done)

    def _message(self, command: Command, data: Mapping[str, Any]) -> Message:
        frame = self.frames.get(command.ros_name.removeprefix("/"), "")
        return self._messages.create(command.element.interface, command.section, data, frame)

    async def _obstacle(self, command: Command, outcome: Outcome, patience: float = _PATIENCE) -> dict[str, Any]:
        """Return why a command did not happen, and what would make it possible."""
        possible = [_WAYS_OUT[outcome.reason]] if outcome.reason in _WAYS_OUT else []
        if outcome.reason in _OF_THE_STATE:
            explanation = await self._explanation(command.sending.event, patience)
            possible = [] if explanation is None else _ways_out(explanation, self.model)
        answer: dict[str, Any] = {"reason": outcome.reason, "because": list(outcome.because)}
        return {**answer, "possible": possible} if possible else answer

    async def _why(self, _: str, data: dict[str, Any]) -> dict[str, Any]:
        command, example = self._commands[data["command"]], data.get("data")
        if example is not None:
            faults = faults_of(command.shape, example)
            if faults:
                return {"verdict": "explained", "allowed": False, **_without_verdict(refusal("schema", *faults))}
            example = command.shape.converted(example)

        def look() -> Outcome | None:
            return self.layer.verdict(command.sending, None if example is None else self._message(command, example))

        outcome = await self._on_node(look)
        if outcome is None:
            return {"verdict": "explained", "allowed": True}
        obstacle = await self._obstacle(command, outcome, _LONG_PATIENCE)
        return {"verdict": "explained", "allowed": False, **obstacle}

    async def _explanation(self, event: sct.Event, patience: float) -> Explanation | None:
        """Return the explanation of a command in the present state; None if it is not ready within some seconds."""
        codes: dict[Any, int] = await self._on_node(lambda: dict(self.layer.codes))
        key = event, tuple(codes.values())
        if key not in self._explained and self._explaining is None:
            self._explaining = key, self._explain(key, event, codes)
        if self._explaining is not None and self._explaining[0] == key:
            await asyncio.wait([self._explaining[1]], timeout=patience)
        return self._explained.get(key)

    def _explain(self, key: Any, event: sct.Event, codes: dict[Any, int]) -> asyncio.Future[Explanation]:
        """Explain a command in a state, one at a time, however long it takes."""
        look = partial(explore, self.model, lambda system: explain(system, event, codes))

        def keep(explained: asyncio.Future[Explanation]) -> None:
            self._explaining = None
            if len(self._explained) >= _MOST_EXPLAINED:
                self._explained.clear()
            # Too little memory, for example: there is no explanation of this state.
            self._explained[key] = None if explained.cancelled() or explained.exception() else explained.result()

        running = asyncio.get_running_loop().run_in_executor(self._explainer, look)
        running.add_done_callback(keep)  # before those that wait for the end
        return running

    # State and goals

    async def _state(self, client: str, _: dict[str, Any]) -> dict[str, Any]:
        def look() -> dict[str, Any]:
            verdicts = {tool: self.layer.verdict(command.sending) for tool, command in self._commands.items()}
            return {
                "components": self.layer.components(),
                "commands": {
                    tool: {"allowed": True}
                    if verdict is None
                    else {"allowed": False, "reason": verdict.reason, "because": list(verdict.because)}
                    for tool, verdict in verdicts.items()
                },
                "goals": {tool: self._goal(action.latest) for tool, action in self._actions.items() if action.latest},
                "violated": self.layer.violated(),
                "graph": self.layer.graph_faults(),
            }

        holder = self._writer.holder
        writer = None if holder is None else "you" if holder == client else "another client"
        return {"verdict": "shown", **await self._on_node(look), "writer": writer}

    def _goal(self, goal: GatedGoal) -> dict[str, Any]:
        entry: dict[str, Any] = {"status": goal.status}
        if goal.feedback is not None:
            entry["feedback"] = self._messages.plain(goal.feedback)
        if goal.result is not None:
            entry["result"] = self._messages.plain(goal.result)
        return {**entry, "because": [goal.why]} if goal.why else entry

    async def _wait(self, _: str, data: dict[str, Any]) -> dict[str, Any]:
        action = self._actions[data["command"]]

        def subscribe(done: Callable[[None], None]) -> None:
            goal = action.latest
            if goal is None or goal.outcome:
                done(None)
            else:
                goal.waiting.append(lambda: done(None))

        with suppress(TimeoutError):
            async with asyncio.timeout(data.get("seconds", _WAIT)):
                await self._post(subscribe)
        goal = await self._on_node(lambda: None if action.latest is None else self._goal(action.latest))
        return {"verdict": "shown", **(goal or {"status": "none"})}

    async def _cancel(self, _: str, data: dict[str, Any]) -> dict[str, Any]:
        action = self._actions[data["command"]]

        def cancel() -> bool:
            runs = action.runs
            action.cancel()
            return runs

        is_running = await self._on_node(cancel)
        if not is_running:
            return {"verdict": "refused", "reason": "state", "because": ["no goal runs"], "possible": []}
        return {"verdict": "canceling"}

    async def _robot(self, _: str, data: dict[str, Any]) -> dict[str, Any]:
        event, values = self.robot[data["event"]], data.get("data", {})
        faults = faults_of(event.shape, values)
        if faults:
            return refusal("schema", *faults)
        trouble = await self._on_node(partial(event.cause, event.shape.converted(values)))
        if trouble is not None:
            return {"verdict": "failed", "reason": "state", "because": [trouble]}
        return {"verdict": "happened"}

    # The thread of the node

    async def _plain(self, message: Message) -> Any:
        """Return data of the robot as JSON, or a note if it is too large."""
        data = self._messages.plain(message)
        size = len(json.dumps(data))
        return data if size <= self.limits.largest else {"left_out": f"{size} characters"}

    async def _on_node(self, action: Callable[[], T]) -> T:
        """Return the result of a function that runs in the thread of the node."""
        return await self._post(lambda done: done(action()))

    async def _post(self, action: Callable[[Callable[[T], None]], object]) -> T:
        """Run a function in the thread of the node, and return the value that it passes to its argument."""
        loop = asyncio.get_running_loop()
        future: asyncio.Future[T] = loop.create_future()

        def settle(result: T | None, error: Exception | None = None) -> None:
            if future.done():
                return
            if error is None:
                future.set_result(result)  # type: ignore[arg-type]
            else:
                future.set_exception(error)

        def give(result: T | None, error: Exception | None = None) -> None:
            with suppress(RuntimeError):  # the client's loop has ended
                loop.call_soon_threadsafe(settle, result, error)

        def run() -> None:
            if future.cancelled():
                return
            try:
                action(give)
            except Exception as error:  # reported to the client; the node goes on
                give(None, error)

        self.node.event_loop.post(run)
        self.node.wake()
        return await future


def _without_verdict(answer: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in answer.items() if key != "verdict"}


def _ways_out(explanation: Explanation, model: sct.SupervisoryControlModel) -> list[str]:
    """Return what would make a command possible, in words."""
    if explanation.situation.reach is not Reach.SUPERVISED:
        return []
    if explanation.data:
        return [f"Send data that fulfills: {note.text}" for note in explanation.data]
    short = data_in_short(explanation, model)
    ways = [f"At once: {text}." for text in short["changes"]]
    if short["way"]:
        ways.append(f"A shortest way: {short['way']}.")
    return ways or ["From here, the robot reaches no state where it is possible."]


def _loggable(data: Any) -> Any:
    """Return data for a line of the log; a text if it is long, or no JSON."""
    try:
        text = json.dumps(data)
        json.dumps(data, allow_nan=False)
    except (ValueError, RecursionError):
        text = repr(data) if not isinstance(data, dict | list) else _dumped(data)
    else:
        if len(text) <= _SHOWN:
            return data
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}…"


def _dumped(data: Any) -> str:
    with suppress(ValueError, RecursionError):
        return json.dumps(data)
    return "nested too deeply"
