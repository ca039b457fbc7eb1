"""Timers in the C engine: the caller passes the time, and the engine returns when to call it next."""

import re
import shutil
from pathlib import Path

import pytest

import robosc
from benchmarks.engine_costs import measured
from robosc.language.configuration import ControlLoop
from robosc.m2m.sct_to_engine import transform
from robosc.m2t.c import engine
from robosc.model import sct
from tests.m2t.supervisor.driver import build, run

pytestmark = pytest.mark.build

CRUISE = Path(__file__).parents[2] / "run" / "runtime" / "cruise.rscd"
GUARD = Path(__file__).parents[2] / "run" / "runtime" / "guard.rscd"


def made(path: Path) -> sct.SupervisoryControlModel:
    model = robosc.to_sct(robosc.load(path))
    robosc.synthesize(model)
    return model


@pytest.mark.parametrize("small", [64, 0])
def test_it_is_correct_over_the_wrap_of_32_bits(tmp_path: Path, small: int) -> None:
    """`now` is in milliseconds and wraps at 32 bits: a timer that starts 400 ms before the wrap expires after it."""
    start = 2**32 - 400
    built = build(made(GUARD), tmp_path, small=small)
    script = []
    for at in (100, 399, 400, 800, 999, 1000, 2000):
        script += [f"now {(start + at) % 2**32}", "begin", "perform message_scan.u_response", "end", "expire"]
    expired = [line for line in run(built, script, str(start)) if line.startswith("expire:")]
    told = [re.fullmatch(r"expire:(.*) = \d; (\d+); .*", line) for line in expired]
    assert [(found[1].strip(), int(found[2])) for found in told if found] == [
        ("", 500),
        ("", 500),
        ("", 500),
        ("", 200),
        ("", 1),
        ("component_Base.u_after2", 500),
        ("", 500),
    ]


def test_a_time_that_goes_back_starts_all_times_anew(tmp_path: Path) -> None:
    """This includes a clock that has wrapped meanwhile."""
    script = ["now 200", "tick", f"now {2**32 - 5}", "tick", "expire"]
    lines = run(build(made(GUARD), tmp_path), script, "100")
    assert [line.split("; ")[1].split(";")[0] for line in lines] == ["400", "500", "500"]


@pytest.mark.parametrize(("length", "expired"), [(None, 60_000), (70, 70)])
def test_the_struct_says_how_long_a_time_is_that_is_set_on_the_robot(
    tmp_path: Path, length: int | None, expired: int
) -> None:
    """Durations that are parameters are members of the C supervisor's struct, which has no other parameters."""
    model = made(CRUISE)
    assert [duration.parameter for duration in model.durations] == ["Lamp.pause", "Lamp.pause"]
    script = [] if length is None else [f"set 0 {length}"]
    script += ["begin", "perform message_range.u_response", "end"]
    line = run(build(model, tmp_path), script)[-1]
    assert line.split("; ")[1].split(";")[0] == str(expired)


def test_without_times_nothing_is_added() -> None:
    """Models without timers keep their API: no `now`, no deadline."""
    model = made(Path(__file__).parent / "dock.rscd")
    text = "".join(engine.generate(transform(model), ControlLoop()).values())
    assert not re.search(r"\bnow\b|_expire|_wait\b|resolution", re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL))


def test_it_reads_no_clock_and_allocates_nothing() -> None:
    """The engine reads no clock and uses no heap."""
    text = "".join(engine.generate(transform(made(GUARD)), ControlLoop()).values())
    assert set(re.findall(r"#include <(.*)>", text)) == {"stdbool.h", "stdint.h", "stddef.h"}


def ring(folder: Path, states: int) -> sct.SupervisoryControlModel:
    """Return a component with this number of states, each with a timeout and a silence."""
    text = "".join(
        f"{'' if number else 'initial marked '}state s{number} {{ after {number + 1} s goto s{(number + 1) % states}"
        f" on response from next goto s{(number + 1) % states} }}\n"
        for number in range(states)
    )
    path = folder / f"ring{states}.rscd"
    path.write_text(
        'robot Ring { component A { outgoing message next with identifier: "/next", type: none'
        ' incoming message lamp with identifier: "/lamp", type: none'
        f" behaviour {{ after 5 s without next do on_ := true variable on_: boolean\n{text} }} }}"
        " requirement lamp needs A.s0 }"
    )
    return made(path)


@pytest.mark.slow
def test_more_timed_states_cost_no_more_per_tick(tmp_path: Path) -> None:
    """The test counts instructions, which are the same on every machine.

    Both rings count their states in 16 bits, and their timers run during the measurement.
    Timers of a larger ring might not.
    """
    if shutil.which("valgrind") is None:
        pytest.skip("valgrind is not installed")
    costs = {}
    for states in (280, 400):
        folder = tmp_path / str(states)
        folder.mkdir()
        costs[states] = measured(ring(tmp_path, states), folder, targets={})
    assert costs[400].tick is not None
    assert costs[280].tick is not None
    assert costs[400].tick.most <= costs[280].tick.most * 1.02
