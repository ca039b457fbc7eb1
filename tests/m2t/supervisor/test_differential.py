"""The engine in C does what the interpreter does, event for event: `benchmarks/search.py` tries more models."""

import tempfile
from pathlib import Path

import pytest
from hypothesis import HealthCheck, Phase, assume, given, settings
from hypothesis import strategies as st

from robosc.engine import Settings
from robosc.language import configuration as config
from robosc.m2m.sct_to_engine import POLLED
from robosc.model import sct
from robosc.synthesis import synthesize
from tests.engine.robots import robots
from tests.m2t.supervisor.driver import build, run
from tests.m2t.supervisor.walk import Walk
from tests.random_sct import sct_models
from tests.searching import TIMES, examples

pytestmark = pytest.mark.build

_few = settings(
    max_examples=examples(8),
    deadline=None,
    derandomize=TIMES == 1,
    phases=(Phase.explicit, Phase.generate),
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large],
)
_settings = st.builds(
    Settings,
    events_per_tick=st.sampled_from((0, 0, 1, 2)),
    reactions_per_tick=st.sampled_from((10, 10, 0, 1, 3)),
    react_immediately=st.sampled_from((True, True, True, False)),
)


def _compare(model: sct.SupervisoryControlModel, loop: Settings, seed: int) -> None:
    start = 2**32 - seed % 5000
    walk = Walk(model, loop, seed, start)
    walk.steps(120)
    chosen = config.ControlLoop(
        events_per_tick=loop.events_per_tick,
        reactions_per_tick=loop.reactions_per_tick,
        react_immediately=loop.react_immediately,
    )
    for small in (POLLED, 0):
        with tempfile.TemporaryDirectory() as folder:
            said = run(build(model, Path(folder), chosen, small=small), walk.script, str(start))
        for number, (theirs, ours) in enumerate(zip(said, walk.said, strict=True)):
            assert theirs == ours, f"step {number} of {walk.script}"


@_few
@given(robots(), _settings, st.integers(0, 2**32))
def test_robots(model: sct.SupervisoryControlModel, loop: Settings, seed: int) -> None:
    _compare(model, loop, seed)


@_few
@given(sct_models(), _settings, st.integers(0, 2**32))
def test_random_models(model: sct.SupervisoryControlModel, loop: Settings, seed: int) -> None:
    model.supervisor = synthesize(model).supervisor
    assume(model.supervisor is not None)
    _compare(model, loop, seed)
