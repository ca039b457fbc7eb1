"""Answers the requests of a debugger's client about one run of a robot."""

from __future__ import annotations

import asyncio
import sys
import traceback
from typing import TYPE_CHECKING, Any, ClassVar

from robosc.analysis.explain import NamingError, Renderer, find_event
from robosc.base.diagnostics import as_text
from robosc.base.files.json_reading import JsonError, json_value
from robosc.model.semantics.failures import possible_reasons
from robosc.model.semantics.roles import event_name
from robosc.model.semantics.steps import FIRST_WORDS, StepError
from robosc.run.simulation import DataError, Simulation, read_script
from robosc.run.simulation.replay import Replay
from robosc.run.simulation.script import WAIT, spoken
from robosc.run.simulation.sources import PlayError
from robosc.tools.debugger.launch import Launch, RequestError
from robosc.tools.debugger.stops import FILTERS, Stop, Stops
from robosc.tools.debugger.views import Views, at, format_value

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from typing import TypeGuard

    from robosc.model import sct
    from robosc.run.simulation.replay import Moment
    from robosc.tools.debugger.launch import Loader
    from robosc.tools.debugger.protocol import Connection
    from robosc.tools.debugger.views import Variable

#: Identifier of the only thread: the robot.
_THREAD = 1
#: Number of steps before the adapter sends output and reads requests again.
_AT_ONCE = 100
_HELP = """\
EVENT [JSON]  perform an event, with data: move, Lidar.scan {"value": "clear"}, message_move.c_trigger
STEP          a step of a scenario: response from scan with clear, error from lift because timeout
wait SECONDS  let time pass
why EVENT     why an event cannot happen here, and what would change that
NAME          a component's state, a variable's value, whether a state is the current one: Lidar, Lidar.free"""
#: Requests that are allowed while the robot runs.
_WHILE_RUNNING = (
    "pause",
    "threads",
    "setBreakpoints",
    "setFunctionBreakpoints",
    "setExceptionBreakpoints",
    "setDataBreakpoints",
)
_CAPABILITIES = {
    "supportsConfigurationDoneRequest": True,
    "supportsFunctionBreakpoints": True,
    "supportsDataBreakpoints": True,
    "supportsBreakpointLocationsRequest": True,
    "supportsStepBack": True,
    "supportsStepInTargetsRequest": True,
    "supportsTerminateRequest": True,
    "supportsCompletionsRequest": True,
    "supportsExceptionInfoRequest": True,
    "supportsExceptionFilterOptions": True,
    "supportsEvaluateForHovers": True,
    "exceptionBreakpointFilters": FILTERS,
}


class _Run:
    """One run: the replay, its views, and its stops."""

    def __init__(self, replay: Replay, launch: Launch) -> None:
        self.replay = replay
        self.launch = launch
        self.views = Views(replay, launch.script)
        self.stops = Stops(replay, self.views, launch.script)


class Adapter:
    """Debugs one robot for one client."""

    def __init__(self, connection: Connection, load: Loader) -> None:
        self._connection = connection
        self._load = load
        self._run: _Run | None = None
        self._ended = False
        self._first_line = self._first_column = 1
        self._references: list[Callable[[], Sequence[Variable]]] = []
        self._stop: Stop | None = None
        self._pausing = False
        self._running: asyncio.Task[None] | None = None

    @property
    def ended(self) -> bool:
        """Whether the client has disconnected."""
        return self._ended

    # Messages

    async def handle(self, message: dict[str, Any]) -> None:
        """Answer a request."""
        command, sequence = message.get("command"), message.get("seq")
        if message.get("type") == "response":
            return  # The adapter sends no requests.
        if message.get("type") != "request" or not isinstance(command, str) or not _is_integer(sequence):
            request = None
            if message.get("type") == "request" and _is_integer(sequence):
                request = sequence, command if isinstance(command, str) else ""
            self.malformed("a message is not a request with `seq` and `command`", request)
            return
        arguments = message.get("arguments")
        answer = {"request_seq": sequence, "command": command}
        after: Callable[[], None] | None = None
        try:
            body, after = await self._answer(command, {} if arguments is None else arguments)
            self._connection.send("response", **answer, success=True, **({} if body is None else {"body": body}))
        except (RequestError, PlayError, NamingError, DataError, OSError, MemoryError) as error:
            self._refuse(answer, _error_text(error))
            if isinstance(error, PlayError) and error.findings:
                self._output(as_text.render(error.findings, error.texts), "stderr")
            if command == "launch":
                self._event("terminated")
        except Exception as error:  # Report every fault to the client, which can then continue.
            traceback.print_exc(file=sys.stderr)
            self._refuse(answer, f"internal error of robosc, please report it: {type(error).__name__}: {error}")
        if after is not None:
            after()

    def malformed(self, fault: str, request: tuple[int, str] | None = None) -> None:
        """Report an unreadable message: as the answer to its apparent request, or by an event."""
        if request is None:
            self._output(f"{fault}: it is left out\n", "stderr")
        else:
            self._refuse({"request_seq": request[0], "command": request[1]}, fault)

    def _refuse(self, answer: Mapping[str, Any], why: str) -> None:
        # The format would read braces as names of variables.
        error = {"id": 1, "format": why.replace("{", "(").replace("}", ")"), "showUser": True}
        self._connection.send("response", **answer, success=False, message=why, body={"error": error})

    def _event(self, name: str, body: Mapping[str, Any] | None = None) -> None:
        self._connection.send("event", event=name, **({} if body is None else {"body": body}))

    def _output(self, text: str, category: str = "console") -> None:
        if text:
            self._event("output", {"category": category, "output": text})

    async def _answer(self, command: str, arguments: Any) -> tuple[Mapping[str, Any] | None, Callable[[], None] | None]:
        """Return the body of the response, and the function to call after it is sent."""
        if not isinstance(arguments, dict):
            raise RequestError("`arguments` are no object")
        answers = self._answers.get(command)
        if answers is None:
            raise RequestError(f"the request `{command}` is unknown")
        if command in ("disconnect", "terminate"):
            await self._halt()
        elif self._running is not None and command not in _WHILE_RUNNING:
            raise RequestError("the robot runs: pause it first")
        result = answers(self, arguments)
        return result if isinstance(result, tuple) else (result, None)

    async def _halt(self) -> None:
        if self._running is not None:
            self._running.cancel()
            await asyncio.gather(self._running, return_exceptions=True)
            self._running = None

    @property
    def _debugged(self) -> _Run:
        if self._run is None:
            raise RequestError("no robot is launched yet")
        return self._run

    # From start to end

    def _initialize(self, arguments: Mapping[str, Any]) -> Mapping[str, Any]:
        self._first_line = int(arguments.get("linesStartAt1", True) is not False)
        self._first_column = int(arguments.get("columnsStartAt1", True) is not False)
        return _CAPABILITIES

    def _launch(self, arguments: Mapping[str, Any]) -> tuple[None, Callable[[], None]]:
        self._run = self._launched(arguments)
        return None, lambda: self._event("initialized")

    def _launched(self, arguments: Mapping[str, Any]) -> _Run:
        launch = Launch.of(arguments)
        models, findings, texts = self._load(launch.target)
        self._output(as_text.render(findings, texts), "stderr")
        simulation = Simulation(models.sct, models.rosgraph, models.ros_types)
        steps, message = launch.steps(simulation)
        self._output(message)
        replay = Replay(simulation, steps, launch.seed)
        self._event("process", {"name": models.sct.name, "isLocalProcess": True, "startMethod": "launch"})
        return _Run(replay, launch)

    def _configuration_done(self, _: Mapping[str, Any]) -> tuple[None, Callable[[], None]]:
        run = self._debugged

        def begin() -> None:
            if run.launch.stop_on_entry:
                self._stopped(Stop("entry", f"{run.replay.engine.model.name} has not started"))
            else:
                self._go_on(forward=True)

        return None, begin

    def _disconnect(self, _: Mapping[str, Any]) -> None:
        self._ended = True

    def _terminate(self, _: Mapping[str, Any]) -> tuple[None, Callable[[], None]]:
        return None, self._terminated

    def _terminated(self) -> None:
        self._event("exited", {"exitCode": 0})
        self._event("terminated")

    # Running

    def _next(self, _: Mapping[str, Any]) -> tuple[None, Callable[[], None]]:
        run = self._debugged
        return None, lambda: self._step(run)

    def _step(self, run: _Run) -> None:
        moment = run.replay.forward()
        if moment is None:
            self._over(run)
            return
        self._output(self._describe(moment))
        run.stops.look()
        hit = run.stops.hit(moment)
        self._stopped(hit or Stop("step", run.views.describe(moment)))

    def _over(self, run: _Run) -> None:
        """Stop or terminate, because no step is left to play."""
        if run.replay.steps is None:
            self._stopped(run.stops.stuck)
        else:
            self._output("the script is at its end\n")
            self._terminated()

    def _step_in(self, arguments: Mapping[str, Any]) -> tuple[None, Callable[[], None]]:
        run = self._debugged
        target = arguments.get("targetId")
        if target is None:
            return self._next(arguments)
        enabled = run.replay.simulation.enabled
        if not _is_integer(target) or not 0 <= target < len(run.replay.engine.events):
            raise RequestError("there is no such target")
        event = run.replay.engine.events[target]
        if event not in enabled:
            raise RequestError(f"{event} cannot happen here")
        moment = run.replay.inject(event, {})
        return None, lambda: self._injected(run, [moment])

    def _step_in_targets(self, _: Mapping[str, Any]) -> Mapping[str, Any]:
        run = self._debugged
        enabled = set(run.replay.simulation.enabled)
        return {
            "targets": [
                {"id": number, "label": event}
                for number, event in enumerate(run.replay.engine.events)
                if event in enabled
            ]
        }

    def _step_back(self, _: Mapping[str, Any]) -> tuple[None, Callable[[], None]]:
        run = self._debugged
        moment = run.replay.back()
        if moment is None:
            return None, lambda: self._stopped(Stop("entry", "this is the start of the robot"))
        self._output(f"taken back: {run.views.describe(moment)}\n")
        run.stops.look()
        return None, lambda: self._stopped(Stop("step", "one step back"))

    def _continue(self, _: Mapping[str, Any]) -> tuple[Mapping[str, Any], Callable[[], None]]:
        self._debugged  # noqa: B018 - raises if nothing is launched
        return {"allThreadsContinued": True}, lambda: self._go_on(forward=True)

    def _reverse_continue(self, _: Mapping[str, Any]) -> tuple[None, Callable[[], None]]:
        self._debugged  # noqa: B018 - raises if nothing is launched
        return None, lambda: self._go_on(forward=False)

    def _pause(self, _: Mapping[str, Any]) -> None:
        self._debugged  # noqa: B018 - raises if nothing is launched
        self._pausing = True

    def _go_on(self, *, forward: bool) -> None:
        self._pausing = False
        self._references.clear()
        run = self._debugged
        self._running = asyncio.get_running_loop().create_task(
            self._play(run, self._onwards if forward else self._back)
        )

    async def _play(self, run: _Run, step: Callable[[_Run, int], tuple[str, Stop | None, bool]]) -> None:
        """Make steps until one stops the run."""
        try:
            await self._played(run, step)
        except Exception as error:  # Report every fault to the client, which can then continue.
            traceback.print_exc(file=sys.stderr)
            self._running = None
            fault = f"{type(error).__name__}: {error}"
            self._stopped(Stop("exception", f"internal error of robosc, please report it: {fault}"))

    async def _played(self, run: _Run, step: Callable[[_Run, int], tuple[str, Stop | None, bool]]) -> None:
        outputs: list[str] = []
        number = 0
        while True:
            output, stop, over = step(run, number)
            outputs.append(output)
            number += 1
            if self._pausing and stop is None and not over:
                stop = Stop("pause", "paused")
            if stop is not None or over:
                self._running = None
                self._output("".join(outputs))
                if stop is not None:
                    self._stopped(stop)
                else:
                    self._over(run)
                return
            if number % _AT_ONCE == 0:
                self._output("".join(outputs))
                outputs.clear()
                await asyncio.sleep(0)

    def _onwards(self, run: _Run, number: int) -> tuple[str, Stop | None, bool]:
        if run.replay.steps is None and number >= run.launch.most:
            return "", Stop("pause", f"{number:,} events have happened; continue for more"), False
        stop = run.stops.before_line(run.replay.next_line) if number else None
        if stop is not None:
            return "", stop, False
        moment = run.replay.forward()
        if moment is None:
            return "", None, True
        run.stops.look()
        stop = run.stops.hit(moment)
        if stop is None and run.replay.is_over:
            stop = Stop("pause", "the script is at its end")
        return self._describe(moment), stop, False

    def _back(self, run: _Run, _: int) -> tuple[str, Stop | None, bool]:
        moment = run.replay.back()
        if moment is None:
            return "", Stop("entry", "this is the start of the robot"), False
        run.stops.look()
        last = run.replay.past[-1] if run.replay.past else None
        stop: Stop | None = None
        if last is not None:
            # The hits of a step depend on the states before and after it.
            run.replay.back()
            run.stops.look()
            run.replay.forward()
            run.stops.look()
            stop = run.stops.hit(last)
        return f"taken back: {run.views.describe(moment)}\n", stop, False

    def _describe(self, moment: Moment) -> str:
        run = self._debugged
        changed = [
            f"    {name} = {format_value(value)}\n"
            for name, value in moment.after.items()
            if moment.before[name] != value
        ]
        return "".join([f"{run.views.describe(moment)}\n", *changed])

    def _stopped(self, stop: Stop) -> None:
        self._stop = stop
        self._references.clear()
        body = {
            "reason": stop.reason,
            "description": stop.description,
            "text": stop.description,
            "threadId": _THREAD,
            "allThreadsStopped": True,
        }
        self._event("stopped", {**body, **({"hitBreakpointIds": stop.breakpoints} if stop.breakpoints else {})})

    # Breakpoints

    def _set_breakpoints(self, arguments: Mapping[str, Any]) -> Mapping[str, Any]:
        lines = [self._line(point) for point in _objects(arguments.get("breakpoints"))]
        points = self._debugged.stops.in_file(_path(arguments), lines)
        return {"breakpoints": [point | {"line": self._shown_line(point["line"])} for point in points]}

    def _set_function_breakpoints(self, arguments: Mapping[str, Any]) -> Mapping[str, Any]:
        names = [str(point.get("name", "")) for point in _objects(arguments.get("breakpoints"))]
        return {"breakpoints": self._debugged.stops.by_name(names)}

    def _set_exception_breakpoints(self, arguments: Mapping[str, Any]) -> Mapping[str, Any]:
        named = arguments.get("filters")
        filters = [{"filterId": name} for name in (named if isinstance(named, list) else ())]
        return {"breakpoints": self._debugged.stops.filters([*filters, *_objects(arguments.get("filterOptions"))])}

    def _data_breakpoint_info(self, arguments: Mapping[str, Any]) -> Mapping[str, Any]:
        requested = str(arguments.get("name", ""))
        if arguments.get("variablesReference"):
            children = self._children(arguments["variablesReference"])
            requested = next((child.path for child in children if child.name == requested and child.path), requested)
        name = self._debugged.views.state_name(requested)
        if name is None:
            return {"dataId": None, "description": f"{requested} is not part of the state that changes"}
        return {"dataId": name, "description": name, "accessTypes": ["write"], "canPersist": True}

    def _set_data_breakpoints(self, arguments: Mapping[str, Any]) -> Mapping[str, Any]:
        names = [str(point.get("dataId")) for point in _objects(arguments.get("breakpoints"))]
        return {"breakpoints": self._debugged.stops.by_value(names)}

    def _breakpoint_locations(self, arguments: Mapping[str, Any]) -> Mapping[str, Any]:
        first = self._line(arguments)
        last = self._line({"line": arguments.get("endLine") or arguments.get("line")})
        lines = [line for line in self._debugged.stops.lines(_path(arguments)) if first <= line <= last]
        return {"breakpoints": [{"line": self._shown_line(line)} for line in lines]}

    # Views

    def _threads(self, _: Mapping[str, Any]) -> Mapping[str, Any]:
        name = self._run.replay.engine.model.name if self._run else "robot"
        return {"threads": [{"id": _THREAD, "name": name}]}

    def _stack_trace(self, arguments: Mapping[str, Any]) -> Mapping[str, Any]:
        frames = self._debugged.views.frames()
        shown_frames = []
        for number, frame in enumerate(frames):
            shown_frame: dict[str, Any] = {"id": number + 1, "name": frame.name, "line": 0, "column": 0}
            if frame.file is not None:
                shown_frame |= {
                    "source": {"name": frame.file.rpartition("/")[2], "path": frame.file},
                    "line": self._shown_line(frame.line),
                    "column": frame.column - 1 + self._first_column,
                }
                if frame.end_line is not None and frame.end_column is not None:
                    shown_frame["endLine"] = self._shown_line(frame.end_line)
                    shown_frame["endColumn"] = frame.end_column - 1 + self._first_column
            shown_frames.append(shown_frame)
        first, count = (_natural(arguments.get(name)) for name in ("startFrame", "levels"))
        return {"stackFrames": shown_frames[first : first + count if count else None], "totalFrames": len(shown_frames)}

    def _scopes(self, arguments: Mapping[str, Any]) -> Mapping[str, Any]:
        views = self._debugged.views
        frames, number = views.frames(), arguments.get("frameId")
        if not _is_integer(number) or not 1 <= number <= len(frames):
            raise RequestError("there is no such frame")
        return {
            "scopes": [
                {"name": scope.name, "variablesReference": self._reference(scope.children), "expensive": False}
                for scope in views.scopes(frames[number - 1].plant)
            ]
        }

    def _variables(self, arguments: Mapping[str, Any]) -> Mapping[str, Any]:
        children = self._children(arguments.get("variablesReference"))
        first, count = (_natural(arguments.get(name)) for name in ("start", "count"))
        return {
            "variables": [self._variable(variable) for variable in children[first : first + count if count else None]]
        }

    def _variable(self, variable: Variable) -> dict[str, Any]:
        body: dict[str, Any] = {
            "name": variable.name,
            "value": variable.value,
            "variablesReference": self._reference(variable.children),
        }
        if variable.path is not None:
            body["evaluateName"] = variable.path
        return body

    def _reference(self, children: Callable[[], Sequence[Variable]] | None) -> int:
        if children is None:
            return 0
        self._references.append(children)
        return len(self._references)

    def _children(self, reference: Any) -> Sequence[Variable]:
        if not _is_integer(reference) or not 1 <= reference <= len(self._references):
            raise RequestError("this variable does not exist any more: the robot has continued")
        return self._references[reference - 1]()

    def _exception_info(self, _: Mapping[str, Any]) -> Mapping[str, Any]:
        if self._stop is None or self._stop.reason != "exception":
            raise RequestError("the robot has stopped for another reason")
        return {"exceptionId": "robosc", "description": self._stop.description, "breakMode": "always"}

    # The debug console

    def _evaluate(self, arguments: Mapping[str, Any]) -> tuple[Mapping[str, Any], Callable[[], None] | None]:
        run = self._debugged
        text = str(arguments.get("expression", "")).strip()
        if arguments.get("context") not in ("repl", None):
            value = run.views.value(text)
            if value is None:
                raise RequestError(f"`{text}` is not a component, variable or state")
            return {"result": value, "variablesReference": 0}, None
        word, _, rest = text.partition(" ")
        if text in ("", "help", "?"):
            return {"result": _HELP, "variablesReference": 0}, None
        if word == "why":
            explanation = run.views.explain(event_name(find_event(run.replay.engine.model, rest.strip())))
            answer_text = Renderer(run.replay.engine.model, at).answer(explanation)
            return {"result": answer_text, "variablesReference": 0}, None
        if word == WAIT:
            return self._waited(run, text)
        value = run.views.value(text)
        if value is not None and not self._is_event(run, text):
            return {"result": value, "variablesReference": 0}, None
        moment = run.replay.inject(*_event(run.replay.engine.model, text))
        if moment.by is not None:
            raise RequestError(run.views.describe(moment))
        return {"result": self._describe(moment).rstrip(), "variablesReference": 0}, lambda: self._injected(
            run, [moment]
        )

    def _waited(self, run: _Run, text: str) -> tuple[Mapping[str, Any], Callable[[], None]]:
        steps, findings = read_script("", text, [WAIT])
        if findings:
            raise RequestError(f"{findings[0].message}; {findings[0].hint}")
        moments = run.replay.let_go_by(steps[0].data["seconds"])
        output = "".join(map(self._describe, moments)).rstrip()
        return {"result": output, "variablesReference": 0}, lambda: self._injected(run, moments)

    @staticmethod
    def _is_event(run: _Run, text: str) -> bool:
        try:
            find_event(run.replay.engine.model, text)
        except NamingError:
            return False
        return True

    def _injected(self, run: _Run, moments: Sequence[Moment]) -> None:
        run.stops.look()
        hit = next(filter(None, (run.stops.hit(moment) for moment in moments)), None)
        self._stopped(hit or Stop("step", run.views.describe(moments[-1])))

    def _completions(self, arguments: Mapping[str, Any]) -> Mapping[str, Any]:
        engine = self._debugged.replay.engine
        column = arguments.get("column")
        text = str(arguments.get("text", ""))
        before = text[: column - self._first_column] if _is_integer(column) else text
        command, _, typed = before.rpartition(" ")
        if command not in ("", "why"):
            return {"targets": []}
        words = [*engine.events, *(["why", "wait", "help"] if not command else [])]
        return {
            "targets": [
                {"label": word, "start": len(before) - len(typed) + self._first_column - 1, "length": len(typed)}
                for word in words
                if word.startswith(typed)
            ]
        }

    # Lines

    def _line(self, position: Any) -> int:
        line = position.get("line") if isinstance(position, dict) else None
        if not _is_integer(line):
            raise RequestError("`line` must be a number")
        return line + 1 - self._first_line

    def _shown_line(self, line: int) -> int:
        return line - 1 + self._first_line

    #: The methods that answer requests, by the commands of the protocol.
    _answers: ClassVar[Mapping[str, Callable[..., Any]]] = {
        "setBreakpoints": _set_breakpoints,
        "setFunctionBreakpoints": _set_function_breakpoints,
        "setExceptionBreakpoints": _set_exception_breakpoints,
        "setDataBreakpoints": _set_data_breakpoints,
        "initialize": _initialize,
        "launch": _launch,
        "configurationDone": _configuration_done,
        "disconnect": _disconnect,
        "terminate": _terminate,
        "next": _next,
        "stepIn": _step_in,
        "stepInTargets": _step_in_targets,
        "stepOut": _next,
        "stepBack": _step_back,
        "continue": _continue,
        "reverseContinue": _reverse_continue,
        "pause": _pause,
        "dataBreakpointInfo": _data_breakpoint_info,
        "breakpointLocations": _breakpoint_locations,
        "threads": _threads,
        "stackTrace": _stack_trace,
        "scopes": _scopes,
        "variables": _variables,
        "exceptionInfo": _exception_info,
        "evaluate": _evaluate,
        "completions": _completions,
    }


def _event(model: sct.SupervisoryControlModel, text: str) -> tuple[str, Mapping[str, Any]]:
    """Return an event and its data as typed, by its name or in words. Raises NamingError, RequestError."""
    word, _, rest = text.partition(" ")
    try:
        event = find_event(model, word)
    except NamingError:
        try:
            step = spoken(model, text) if word in FIRST_WORDS else None
        except StepError as error:
            raise RequestError(str(error)) from None
        if step is None:
            raise
        return step
    return event_name(event), _data(rest.strip(), event)


def _data(text: str, event: sct.Event) -> Mapping[str, Any]:
    """Return the data of an event as typed: data as in the event log, or the bare value.

    Raises RequestError.
    """
    if not text:
        return {}
    try:
        data = json_value(text)
    except JsonError as error:
        raise RequestError(f'the data cannot be read: {error}; write {{"value": ...}}') from None
    known = {"value", "where", *(["reason"] if possible_reasons(event) else [])}
    return data if isinstance(data, dict) and set(data) <= known else {"value": data}


def _error_text(error: Exception) -> str:
    if isinstance(error, OSError) and error.filename:
        return f"{error.filename}: {error.strerror}"
    return str(error)


def _path(arguments: Mapping[str, Any]) -> str:
    source = arguments.get("source")
    path = source.get("path") if isinstance(source, dict) else None
    if not isinstance(path, str):
        raise RequestError("`source` needs a `path`")
    return path


def _is_integer(value: Any) -> TypeGuard[int]:
    return isinstance(value, int) and not isinstance(value, bool)


def _natural(value: Any) -> int:
    return value if _is_integer(value) and value > 0 else 0


def _objects(items: Any) -> list[dict[str, Any]]:
    if items is not None and not (isinstance(items, list) and all(isinstance(item, dict) for item in items)):
        raise RequestError("expected a list of objects")
    return items or []
