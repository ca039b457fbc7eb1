"""Sentences of the language's second edition that hold in every view, each in those that it speaks of."""

from __future__ import annotations

import json
import re
import shutil
from typing import TYPE_CHECKING, Any

import pytest
from click.testing import CliRunner

import robosc
from robosc.analysis.verify import validate_c, validate_cif, verify_system
from robosc.analysis.verify.verdict import Outcome
from robosc.base.diagnostics import ModelError
from robosc.engine import Engine
from robosc.language.configuration import Configuration, ControlLoop
from robosc.m2m.sct_to_engine import transform
from robosc.m2t import cif, supervisor
from robosc.m2t.c import engine
from robosc.m2t.models import Models
from robosc.model import sct
from robosc.model.reflection import tree
from robosc.tools.cli import main
from tests.m2t.supervisor.driver import build, run
from tests.run.runtime.fake import World

if TYPE_CHECKING:
    from pathlib import Path

needs_gcc = pytest.mark.skipif(shutil.which("gcc") is None, reason="no C compiler")


def written(folder: Path, *parts: str) -> Path:
    path = folder / "robot.rscd"
    path.write_text(f"robot R {{ {' '.join(parts)} }}", encoding="utf-8")
    return path


def supervised(folder: Path, *parts: str) -> sct.SupervisoryControlModel:
    robot = robosc.load(written(folder, *parts))
    assert [finding for finding in robosc.check(robot) if finding.severity.name == "ERROR"] == []
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    return model


def simulated(path: Path, *lines: str, loop: bool = False) -> list[dict[str, Any]]:
    options = ["--script", "-", *(["--loop"] if loop else [])]
    done = CliRunner().invoke(main, ["simulate", str(path), *options], input="\n".join(lines))
    assert done.exit_code == 0, done.stderr
    return [json.loads(line) for line in done.stdout.splitlines()]


# `all` of nothing is true

SCANNER = """component Eye {
    outgoing message scan with identifier: "/scan", type: sensor_msgs/LaserScan
    behaviour {
        variable free: boolean
        variable seen: boolean
        variable kept: array(double)
        initial marked state on {
            on response from scan do
                free := all r in value.ranges: r > 1.0, kept := value.ranges, seen := all r in kept: r > 1.0
        }
    }
}
incoming message go with identifier: "/go", type: boolean"""
EYE = SCANNER.replace("incoming message go", "component Base { incoming message go") + " }"
READS = "requirement go needs Eye.free provide go with Eye.seen"


@pytest.mark.parametrize(("ranges", "free"), [([], True), ([0.5], False), ([2.0], True)])
def test_all_of_nothing_is_true(tmp_path: Path, ranges: list[float], free: bool) -> None:
    """Of what comes in, told to the supervisor, and of what the node keeps; in C++: tests/m2t/cpp/test_expressions."""
    path = written(tmp_path, EYE, READS)
    (answer,) = simulated(path, f'message_scan.u_response {{"value": {{"ranges": {json.dumps(ranges)}}}}}')
    assert answer["state"]["Eye.free"] is free
    world = World(path, tmp_path / "log.jsonl").start()
    for kept in ([], ranges):
        world.hear("scan", ranges=kept)
    world.hear("scan", ranges=ranges)
    world.wait(0.3)
    assert [fields["data"] for topic, fields in world.port.sent if topic == "/go"][-1:] == ([True] if free else [])


def test_all_of_no_instances_is_true(tmp_path: Path) -> None:
    bumper = "component Bumper(ns: string) { behaviour { initial marked state clear { } } }"
    base = "component Base { incoming message go with type: none incoming message stay with type: none }"
    requirements = [
        "go needs all Bumper: Bumper.clear",
        "stay needs (any Bumper: Bumper.clear) or (count Bumper: Bumper.clear) = 1",
    ]
    model = supervised(tmp_path, bumper, base, *(f"requirement {text}" for text in requirements))
    interpreter = Engine(model)
    assert interpreter.enabled("message_go.c_trigger")
    assert not interpreter.enabled("message_stay.c_trigger")


# 1 ms to 24 days

DAYS = {"ms": 2_073_600_000, "s": 2_073_600, "min": 34_560}
LEAST = {"ms": "1", "s": "0.001", "min": "1.0 / 60000"}
LAMP = """component Lamp {{
    incoming message lamp with identifier: "/lamp", type: none
    behaviour {{
        initial marked state off {{ after {} goto on_ }}
        marked state on_ {{ on request to lamp }}
    }}
}}"""


@pytest.mark.parametrize("unit", DAYS)
def test_a_time_is_1_ms_to_24_days_in_each_unit(tmp_path: Path, unit: str) -> None:
    """The longest is a time of the plants, of `simulate`, of a node and of the C engine; one more is none."""
    for given, found in ((LEAST[unit], 1), (str(DAYS[unit]), DAYS["ms"])):
        model = supervised(tmp_path, LAMP.format(f"{given} {unit}"))
        assert [timer.milliseconds for _, timer in tree(model) if isinstance(timer, sct.Timer)] == [found]
    for given, fault in (
        (str(DAYS[unit] + 1), "longer than 24 days"),
        ("0.0001" if unit == "ms" else "0", "shorter than 1 ms"),
    ):
        (finding, *_) = robosc.check(robosc.load(written(tmp_path, LAMP.format(f"{given} {unit}"))))
        assert (finding.rule, finding.message) == ("duration", f"this time is {fault}, expected 1 ms to 24 days")


@pytest.mark.slow
def test_24_days_are_waited_for(tmp_path: Path) -> None:
    path = written(tmp_path, LAMP.format("24 * 24 * 60 min"))
    almost, then = simulated(path, f"wait {DAYS['s'] - 0.001}", "wait 0.001", loop=True)
    assert almost["happened"] == []
    assert then["happened"] == ["component_Lamp.u_after1"]
    world = World(path, tmp_path / "log.jsonl", period_ms=86_400_000).start()
    world.wait(DAYS["s"] - 0.01)
    assert world.port.sent == []
    world.wait(0.02)
    assert [topic for topic, _ in world.port.sent] == ["/lamp"]


@pytest.mark.build
@needs_gcc
def test_the_c_engine_waits_for_24_days(tmp_path: Path) -> None:
    model = supervised(tmp_path, LAMP.format(f"{DAYS['min']} min"))
    script = [f"now {DAYS['ms'] - 1}", "expire", f"now {DAYS['ms']}", "expire"]
    almost, then = (line for line in run(build(model, tmp_path), script, "0") if line.startswith("expire:"))
    assert almost.startswith("expire: = 0; 1; ")
    assert then.startswith("expire: component_Lamp.u_after1 = 1; ")
    assert validate_c(model, supervisor.generate(Models(model), Configuration())).outcome is Outcome.PROVED


# `at most N` with N from 1 to 1,000

ARM = "component Arm { incoming message grip with type: none outgoing message home with type: none }"


@pytest.mark.parametrize("most", [1, 1000])
def test_at_most_counts_to_1_000(tmp_path: Path, most: int) -> None:
    model = supervised(tmp_path, ARM, f"requirement at most {most} grip since home")
    assert model.supervisor.controlledStates == most + 1
    interpreter = Engine(model)
    for _ in range(2):
        for _ in range(most):
            assert interpreter.perform("message_grip.c_trigger")
        assert not interpreter.enabled("message_grip.c_trigger")
        assert interpreter.perform("message_home.u_response")
    assert validate_cif(model, cif.generate(Models(model), Configuration())).outcome is Outcome.PROVED
    assert validate_c(model, supervisor.generate(Models(model), Configuration())).outcome is Outcome.PROVED
    assert {verdict.outcome for verdict in verify_system(model)} == {Outcome.PROVED}


@pytest.mark.parametrize("most", [0, 1001])
def test_at_most_counts_to_no_more(tmp_path: Path, most: int) -> None:
    path = written(tmp_path, ARM, f"constant n: integer = {most} requirement at most n grip since home")
    (finding,) = [found for found in robosc.check(robosc.load(path)) if found.severity.name == "ERROR"]
    assert finding.message == f"`at most` counts to {most}, expected a number from 1 to 1,000"


# The C supervisor

CLOCK = """parameter pause: integer(1..60) = 5
parameter speed: double(0.0..1.0) = 0.5
parameter loud: boolean = true
component Lamp {
    incoming message lamp with identifier: "/lamp", type: double
    behaviour { initial marked state off { after pause s goto on_ } marked state on_ { on request to lamp goto off } }
}
provide lamp with if loud then speed else 0.0"""


def test_the_c_supervisor_has_no_parameter_but_durations(tmp_path: Path) -> None:
    """The C supervisor takes such durations in its struct, and has no other parameter."""
    model = supervised(tmp_path, CLOCK)
    texts = "".join(engine.generate(transform(model), ControlLoop()).values())
    assert [duration.parameter for duration in model.durations] == ["pause"]
    assert "pause" in texts
    for name in ("speed", "loud"):
        assert name not in texts


# `send: change` has no part in the layer


def test_send_change_has_no_part_in_the_layer(tmp_path: Path) -> None:
    """With it and without it, a layer is the same; a controller is not."""
    path = written(
        tmp_path,
        LAMP.format("1 s").replace("type: none", "type: boolean, send: change").replace("on request to lamp", ""),
    )
    made = []
    for text in (path.read_text(), path.read_text().replace(", send: change", "")):
        path.write_text(text)
        robot = robosc.load(path)
        models = Models(robosc.to_sct(robot), robosc.to_rosgraph(robot), robot)
        robosc.synthesize(models.sct)
        made.append({name: robosc.generate(name, models) for name in ("ros2-layer", "ros2")})
    layers, controllers = ([files[name] for files in made] for name in made[0])
    assert layers[0] == layers[1]
    assert controllers[0] != controllers[1]


# `abs min max` in CIF


def test_abs_min_max_are_written_out_by_cases_in_cif(tmp_path: Path) -> None:
    """Of variables that the supervisor knows: nothing is left that CIF's synthesis does not take."""
    counter = """component Counter {
        outgoing message tick with type: integer(-3..3)
        incoming message ring with type: none
        behaviour {
            variable count: integer(-3..3)
            initial marked state counting {
                on response from tick do count := max(min(value, count + 1), abs(count) - 3)
            }
        }
    }"""
    model = supervised(
        tmp_path,
        counter,
        "requirement never abs(Counter.count) > max(Counter.count, 3)",
        "requirement ring needs min(Counter.count, 0) = 0",
    )
    files = cif.generate(Models(model), Configuration())
    text = re.sub(r'//.*|".*?"', "", files["R.cif"])
    assert not [word for word in ("abs(", "min(", "max(") if word in text]
    assert validate_cif(model, files).outcome is Outcome.PROVED


# Hints


@pytest.mark.parametrize("word", ["all", "any", "count", "never", "always", "reachable", "each", "after"])
def test_a_word_that_is_read_as_a_name_shows_its_construct(tmp_path: Path, word: str) -> None:
    """A word of this page in a place where it can't stand gets a hint that shows the construct meant."""
    path = written(
        tmp_path, "component Base { incoming message go with type: none }", f"requirement go needs {word} > 1"
    )
    with pytest.raises(ModelError) as raised:
        robosc.load(path)
    (finding,) = raised.value.diagnostics
    assert finding.hint is not None
    assert finding.hint.startswith("write ")
    assert f"{word}" in finding.hint
