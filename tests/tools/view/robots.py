"""A small robot with timers, data, a number and names that pages must not interpret as markup."""

from __future__ import annotations

import asyncio
import json
from typing import TYPE_CHECKING, Any

import robosc
from robosc.m2t.models import Models
from robosc.run.simulation import Simulation
from robosc.tools.view import Record, describe
from robosc.tools.view.server import stream_moments

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.run.simulation import ScriptStep
    from robosc.tools.view import Moments

#: A text with visible effects if any of it became markup.
EVIL = '<img src=x onerror="globalThis.hacked = 1"></script><script>globalThis.hacked = 1</script>'

GATE = f"""\
robot Gate {{
  component Barrier {{
    incoming message open with identifier: "/open", type: none
    incoming message close with identifier: "/close", type: none
    outgoing message car with identifier: "/car", type: boolean

    behaviour {{
      variable cars: integer(0..3) = 0

      initial marked state closed {{
        on request to open goto opened
      }}

      state opened {{
        on request to close goto closed
        on response from car if value do cars := min(cars + 1, 3)
        after 2.0 s goto closed
      }}
    }}
  }}

  requirement Full "no more than three {EVIL.replace('"', "'")}": open needs Barrier.cars < 3
}}
"""


def record(
    text: str = GATE, steps: Sequence[ScriptStep] | None = None
) -> tuple[Mapping[str, object], Record, Simulation]:
    """Return the description and record of a robot, and a second simulation for reference."""
    robot = robosc.load(text=text)
    model, graph = robosc.to_sct(robot), robosc.to_rosgraph(robot)
    robosc.synthesize(model)
    described = describe(Models(model, graph, robot), {"<text>": text})
    return described, Record(Simulation(model, graph), graph, steps), Simulation(model, graph)


def wholes(moments: list[dict[str, Any]]) -> list[dict[str, dict[str, Any]]]:
    """Return the complete values at each moment, accumulated from the changes."""
    now: dict[str, dict[str, Any]] = {part: {} for part in ("state", "commands", "timers", "enabled")}
    found = []
    for moment in moments:
        if moment.get("whole"):
            now = {part: {} for part in now}
        for part, values in now.items():
            changed = {**values, **moment[part]}
            gone = [name for name, value in changed.items() if value is False and part in ("timers", "enabled")]
            now[part] = {name: value for name, value in changed.items() if name not in gone}
        found.append(dict(now))
    return found


class Viewer:
    """A page that reads a stream of moments."""

    def __init__(self, shown: Moments) -> None:
        self._shown = shown
        self._stream = stream_moments(shown)
        self._first = 0
        self.moments: list[dict[str, Any]] = []

    async def read(self) -> None:
        text = await asyncio.wait_for(anext(self._stream), 30)
        part = json.loads(text.removeprefix("data: "))
        if part["from"] > self._first + len(self.moments):
            self._first, self.moments = part["from"], []
        self.moments[part["from"] - self._first :] = part["moments"]

    async def read_all(self) -> None:
        while self._first + len(self.moments) != self._shown.length:
            await self.read()
