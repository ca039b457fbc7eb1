"""A control loop restores a saved state, and so does another loop of the same model."""

from __future__ import annotations

from pathlib import Path
from random import Random

import pytest

import robosc
from robosc.engine import ControlLoop, Settings
from robosc.model.engine import Role
from tests.searching import slow_but

EXAMPLES = Path(__file__).parents[2] / "examples"


def played(loop: ControlLoop, seed: int) -> list[object]:
    """Return the behavior of a loop in twenty random batches, each with a tick."""
    random = Random(seed)  # noqa: S311
    incoming = [event.name for event in loop.engine.executed.events if event.role == Role.incoming]
    seen: list[object] = []
    for _ in range(20):
        loop.timers.at(loop.timers.now + random.randrange(2000))
        loop.expire()
        loop.begin()
        loop.perform(random.choice(incoming))
        loop.end()
        loop.tick()
        seen.append(loop.saved)
    return seen


@pytest.mark.parametrize("name", slow_but(["line_follower"], ["line_follower", "push_ball", "sprayer"]))
def test_what_was_saved_goes_on_alike(name: str) -> None:
    model = robosc.to_sct(robosc.load(EXAMPLES / name / f"{name}.rscd"))
    robosc.synthesize(model)
    settings = Settings(events_per_tick=1, reactions_per_tick=1)
    loop, other = (ControlLoop(model, settings) for _ in range(2))
    played(loop, 1)
    saved = loop.saved
    first = played(loop, 2)
    loop.restore(saved)
    assert loop.saved == saved
    assert played(loop, 2) == first
    other.restore(saved)
    assert played(other, 2) == first
    assert len(set(map(str, first))) > 1
