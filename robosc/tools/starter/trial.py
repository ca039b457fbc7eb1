"""The test of a new robot: the checks of the tool, and a story that the simulator plays."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.tools.starter.model import condition

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.tools.starter.choices import Choices

_TEXT = '''\
"""{robot} is a valid model and behaves as intended: run `python -m unittest` or `pytest` in this folder."""

import json
import subprocess
import sys
import unittest
from pathlib import Path

MODEL = Path(__file__).parent / "{stem}.rscd"

#: Requested events, in order, and whether the supervised robot allows them; `robosc simulate` lists all events.
STORY = [
{story}
]


def robosc(*arguments: str, given: str = "") -> subprocess.CompletedProcess[str]:
    """Run a command of robosc on the model."""
    command = [sys.executable, "-m", "robosc", *arguments]
    return subprocess.run(command, input=given, capture_output=True, text=True, check=False)


class {robot}Test(unittest.TestCase):
    def test_the_model_is_sound(self) -> None:
        for command in (["check"], ["format", "--check", "--diff"], ["verify"]):
            done = robosc(*command, str(MODEL))
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_{command}(self) -> None:
        """`{command}` goes out while {condition}."""
        done = robosc("simulate", str(MODEL), "--script", "-", given="\\n".join(line for line, _ in STORY))
        self.assertEqual(done.returncode, 0, done.stderr)
        answers = [json.loads(line)["accepted"] for line in done.stdout.splitlines()]
        self.assertEqual(list(zip((line for line, _ in STORY), answers, strict=True)), STORY)


if __name__ == "__main__":
    unittest.main()
'''


def trial(choices: Choices) -> str:
    """Return the text of the test."""
    story = "\n".join(f"    ({_quoted(line)}, {happens})," for line, happens in _story(choices))
    return _TEXT.format(
        robot=choices.robot,
        stem=choices.stem,
        story=story,
        command=choices.command,
        condition=condition(choices).replace("`", ""),
    )


def _quoted(line: str) -> str:
    return repr(line) if '"' in line else f'"{line}"'


def _story(choices: Choices) -> Iterator[tuple[str, bool]]:
    command = f"message_{choices.command}.c_trigger"
    stop = f"message_{choices.stop}.c_trigger" if choices.stop else None
    yield command, False
    if choices.service:
        yield f"service_{choices.service}.c_trigger", True
        yield f'service_{choices.service}.u_response {{"value": {{"success": true}}}}', True
    for sensor in choices.sensors:
        yield command, False
        yield f'message_{sensor}.u_response {{"value": true}}', True
    yield command, True
    for sensor in choices.sensors:
        if stop:
            yield stop, False
        yield f'message_{sensor}.u_response {{"value": false}}', True
        yield command, False
        if stop:
            yield stop, True
        yield f'message_{sensor}.u_response {{"value": true}}', True
    yield command, True
