"""The page's copy of a run equals the sent data, for any number of moments and any limit on storage."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path
from random import Random
from typing import Any

import pytest

from tests.searching import slow_but

from .robots import record, wholes

ROOT = Path(__file__).parents[3]
#: Send messages to a run, and print its content at a moment after each.
SCRIPT = """
import { readFileSync } from "node:fs";
import { Run } from "RUN";
const { most, messages } = JSON.parse(readFileSync(0, "utf8"));
const run = new Run(most ?? undefined);
const told = messages.map(({ from, moments, at }) => {
  run.replace(from, moments);
  const asked = Math.max(run.first, Math.min(at, run.end));
  const whole = run.at(asked);
  return {
    at: asked, first: run.first, end: run.end, time: run.moment(asked).time,
    state: Object.fromEntries(whole.state), commands: Object.fromEntries(whole.commands),
    enabled: Object.fromEntries([...whole.enabled].map((name) => [name, true])),
    timers: Object.fromEntries(whole.timers),
  };
});
console.log(JSON.stringify(told));
"""


@pytest.mark.parametrize("most", slow_but(["None"], [3, 10, 70, 200, None]))
def test_it_is_at_each_moment_what_was_told(most: int | None) -> None:
    node = shutil.which("node", path=Path(sys.executable).parent) or shutil.which("node")
    if node is None:
        pytest.skip("there is no node")
    random = Random(most or 0)
    _, shown, _ = record()
    messages: list[dict[str, Any]] = []
    expected: list[dict[str, Any]] = []
    told = 0
    actions = [{"action": "random", "number": 40}, {"action": "random", "number": 1}, {"action": "wait", "seconds": 1}]
    for _ in range(120):
        before = len(shown.cuts)
        shown.do(random.choice(actions))
        # Only a completely stored run can be undone.
        if most is None and random.random() < 0.1:
            shown.do({"action": "continue", "moment": random.randrange(len(shown.moments))})
        told = min([told, *shown.cuts[before:]])
        messages.append({"from": told, "moments": shown.moments[told:], "at": random.randrange(len(shown.moments))})
        told = len(shown.moments)
        times = [moment["time"] for moment in shown.moments]
        expected.append({"end": told - 1, "wholes": wholes(shown.moments), "times": times})
    script = SCRIPT.replace("RUN", (ROOT / "web" / "src" / "run.ts").as_uri())
    done = subprocess.run(
        [node, "--input-type=module", "--experimental-strip-types", "--no-warnings", "-e", script],
        input=json.dumps({"most": most, "messages": messages}),
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    for found, right in zip(json.loads(done.stdout), expected, strict=True):
        assert found["end"] == right["end"]
        assert most is None or found["end"] - found["first"] <= most
        assert found["time"] == right["times"][found["at"]]
        whole = right["wholes"][found["at"]]
        assert {part: found[part] for part in whole} == whole
