"""Verdicts of synthesis in the background: code lenses, and guards in hovers."""

from __future__ import annotations

import asyncio
import json
import sys
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from lsprotocol import types

from robosc.base.diagnostics import has_errors
from robosc.language.document_symbols import outline
from robosc.model import robosc as rsc
from robosc.model.semantics.expansion import constant_value
from robosc.tools.editor.answers import Request, Verdict
from robosc.tools.editor.places import to_range

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from robosc.language.document_symbols import Item
    from robosc.tools.editor.project import Analysis, Snapshot

COMMAND = (sys.executable, "-m", "robosc.tools.editor.verdict")
#: Titles of lenses on a robot, and the editor commands behind them.
COMMANDS = {"simulate": "robosc.debug", "run": "robosc.run", "verify": "robosc.verify"}
#: Time limit of synthesis in seconds.
_LONGEST = 120
_FAILED = "synthesis failed: `robosc synthesize` shows the error"
RUNNING = "synthesis is running …"


@dataclass(frozen=True)
class Question:
    """A request for synthesis: a robot's path, all texts that it was read from, and the places of lenses by line."""

    path: Path
    texts: Mapping[str, str]
    places: Mapping[int, types.Range]


def question(_: Snapshot, analysis: Analysis) -> Question | None:
    """Return the request for a text, or None if it holds no robot, or a robot with errors."""
    if not isinstance(analysis.reading.base, rsc.Robot) or has_errors(analysis.findings):
        return None
    robot, text = outline(analysis.file)[0], analysis.text
    items = [robot, *(item for item in _all(robot.items) if isinstance(item.element, rsc.Requirement))]
    places = {item.element.source.span.line: to_range(text, item.name_start, item.name_end) for item in items}
    return Question(analysis.path, analysis.reading.texts, places)


def lenses(
    query: Question, verdict: Verdict | str | None, uri: str = "", *, commands: bool = False
) -> list[types.CodeLens]:
    """Return the lenses above the robot and its requirements.

    With `commands`, these include lenses for commands, which the editor itself runs on the robot's text `uri`.
    """
    robot, *_ = query.places
    done = [_lens(query.places[robot], title, command, [uri]) for title, command in COMMANDS.items() if commands]
    if not isinstance(verdict, Verdict):
        return [_lens(query.places[robot], verdict or RUNNING), *done]
    titles = {robot: verdict.robot, **{int(line): title for line, title in verdict.requirements.items()}}
    return [
        *(_lens(query.places[line], title) for line, title in titles.items() if line in query.places),
        *done,
    ]


def _lens(place: types.Range, title: str, command: str = "", arguments: Sequence[Any] | None = None) -> types.CodeLens:
    return types.CodeLens(place, types.Command(title, command=command, arguments=arguments))


def communication_at(analysis: Analysis, offset: int) -> str | None:
    """Return the communication named at an offset, with its component, as in `Verdict.guards`."""
    name = analysis.file.name_at(offset)
    if name is None or not isinstance(name.target, rsc.CommunicationType):
        return None
    reference = name.user if isinstance(name.user, rsc.CommunicationReference) else None
    owner = reference.component if reference is not None else None
    number = constant_value(reference.index) if reference is not None else None
    around: Any = name.target
    while owner is None and around is not None:
        around = around.eContainer()
        owner = around if isinstance(around, rsc.Component) else None
    return None if owner is None else f"{owner.name}{'' if number is None else number}.{name.target.name}"


def _all(items: Sequence[Item]) -> list[Item]:
    return [nested_item for item in items for nested_item in (item, *_all(item.items))]


class Verdicts:
    """The last verdict on each text, and the running synthesis processes."""

    def __init__(self, command: Sequence[str], news: Callable[[], None]) -> None:
        """Run `command` for each request, and call `news` after each verdict."""
        self._command = command
        self._news = news
        self._answers: dict[Path, tuple[Mapping[str, str], Verdict | str]] = {}
        self._running: dict[Path, tuple[Mapping[str, str], asyncio.Task[None]]] = {}

    def ask(self, query: Question, libraries: Sequence[str], interfaces: Sequence[str]) -> Verdict | str | None:
        """Return the verdict on exactly these texts, or why there is none; None while synthesis runs."""
        known = self.lookup(query.path, query.texts)
        if known is not None:
            return known
        running = self._running.get(query.path)
        if running is None or running[0] != query.texts:
            if running is not None:
                running[1].cancel()
            task = asyncio.get_running_loop().create_task(self._look(query, libraries, interfaces))
            self._running[query.path] = query.texts, task
        return None

    def lookup(self, path: Path, texts: Mapping[str, str]) -> Verdict | str | None:
        """Return the verdict on exactly these texts, or None if there is none."""
        answer = self._answers.get(path)
        return answer[1] if answer is not None and answer[0] == texts else None

    def cancel(self) -> None:
        """Stop all processes, because texts have changed."""
        for _, task in self._running.values():
            task.cancel()
        self._running = {}

    async def _look(self, query: Question, libraries: Sequence[str], interfaces: Sequence[str]) -> None:
        pipe = asyncio.subprocess.PIPE
        request = json.dumps(asdict(Request(str(query.path), query.texts, libraries, interfaces))).encode()
        process = await asyncio.create_subprocess_exec(
            *self._command, stdin=pipe, stdout=pipe, stderr=asyncio.subprocess.DEVNULL
        )
        answer: Verdict | str
        try:
            async with asyncio.timeout(_LONGEST):
                output, _ = await process.communicate(request)
            answer = (
                Verdict(**json.loads(output))
                if process.returncode == 0
                else "synthesis failed: `robosc synthesize` shows the error"
            )
        except TimeoutError:
            answer = f"synthesis takes more than {_LONGEST} seconds"
        finally:
            if process.returncode is None:
                process.kill()
                await process.wait()
        self._answers[query.path] = query.texts, answer
        self._running.pop(query.path, None)
        self._news()
