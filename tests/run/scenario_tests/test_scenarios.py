"""Scenarios of users: their syntax, their faults, and robots that do not meet the expectations."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

import robosc
from robosc.tools.cli import main

HERE = Path(__file__).parent
EXAMPLE = HERE.parents[2] / "examples" / "line_follower"


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    shutil.copy(HERE / "dock.rscd", tmp_path)
    return tmp_path


def played_files(*arguments: str) -> Result:
    return CliRunner().invoke(main, ["test", *arguments], catch_exceptions=False)


def played(text: str, *options: str) -> Result:
    Path("dock.scenarios").write_text(text, encoding="utf-8")
    return played_files("dock.rscd", "dock.scenarios", *options)


def findings(text: str, *options: str) -> list[tuple[int, int, str]]:
    answer = played(text, "--format", "json", *options)
    said = json.loads(answer.stdout)
    assert answer.exit_code == any(finding["severity"] == "error" for finding in said), answer.output
    return [
        (finding["line"], finding["column"], finding["message"]) for finding in said if finding["rule"] == "scenario"
    ]


GOOD = """
scenario "docks"
  wait 100 ms
  expect Dock.docking
  feedback from dock
  response from dock with {"slot": 3}
  expect Dock.docked and not_pressed
  wait 100 ms
  expect lamp sent with 0.5

scenario "another slot, an error and a pause"
  wait 0.1 s
  response from dock with {"slot": 1}
  expect dock sent
  error from dock
  expect Dock.pausing
  expect dock not sent
  wait 1900 ms
  expect Dock.pausing
  wait 3 s
  expect dock sent

scenario "not while the bumper is pressed"
  hit with true
  wait 0.2 s
  canceled from dock
  expect dock forbidden by SR1
  expect dock forbidden by "nobody is run over"
""".replace(" and not_pressed", " and !Bumper.pressed")


@pytest.mark.parametrize("engine", ["python", pytest.param("c", marks=pytest.mark.build)])
def test_what_is_as_expected(engine: str) -> None:
    answer = played(GOOD, "--engine", engine)
    assert answer.exit_code == 0, answer.output
    assert "3 passed in " in answer.stderr


@pytest.mark.parametrize("engine", ["python", pytest.param("c", marks=pytest.mark.build)])
def test_the_example(engine: str) -> None:
    files = [str(EXAMPLE / "line_follower.rscd"), str(EXAMPLE / "line_follower.scenarios")]
    answer = played_files(*files, "--engine", engine)
    assert answer.exit_code == 0, answer.output
    assert "4 passed in " in answer.stderr


@pytest.mark.parametrize(
    ("expectation", "why"),
    [
        ("Dock.docked", "`Dock.docked` does not hold"),
        (
            "lamp allowed",
            "the request to `Lamp.lamp` is not allowed: `requirement lamp needs Dock.docked` (line 58) forbids it",
        ),
        ("dock allowed", "the request to `Dock.dock` is not allowed: the robot is not ready for it"),
        ("hit forbidden", "the response from `Bumper.hit` is not forbidden: it is allowed"),
        ("lamp forbidden by SR1", "the request to `Lamp.lamp` is not forbidden by `SR1`, but by `requirement lamp"),
        ("lamp sent", "the request to `Lamp.lamp` was not sent since the last step"),
        ("dock not sent", "the request to `Dock.dock` was sent"),
    ],
)
def test_what_is_not_as_expected(expectation: str, why: str) -> None:
    [(line, column, message)] = findings(f'scenario "one"\n\n  expect {expectation}\n')
    assert (line, column) == (3, 10 if "does not hold" in why else 3)
    assert message.startswith(why)


def test_other_data() -> None:
    text = GOOD.replace("lamp sent with 0.5", "lamp sent with 0.25")
    [(line, _, message)] = findings(text)
    assert (line, message) == (9, "the request to `Lamp.lamp` was sent with other data")


def test_a_misspelt_field(folder: Path) -> None:
    (folder / "line.scenarios").write_text('scenario "one"\n  scan with {"range": [0.2]}\n  expect move not sent\n')
    answer = played_files(str(EXAMPLE / "line_follower.rscd"), "line.scenarios")
    assert answer.exit_code == 1
    assert "line.scenarios:2:3: error: sensor_msgs/LaserScan has no field `range`" in answer.stdout
    assert "hint: did you mean `ranges`?" in answer.stdout


LIDAR = """robot X {
  interface laser use LaserScan from sensor_msgs
  datatype object LaserScan { ranges: array(double) range_max: double }
  datatype enum Ahead from LaserScan to { value.ranges[0] > 0.5 -> clear default -> near }
  component Lidar {
    outgoing message scan with identifier: "/scan", type: Ahead links laser
    outgoing message frame with identifier: "/frame", type: string
    outgoing message lamp with identifier: "/lamp", type: Lamp
    outgoing message ranges with identifier: "/ranges", type: LaserScan links laser

    behaviour {
      variable number: integer(0..9)
      variable lit: boolean
      on response from frame
      on response from lamp do lit := value = bright
      on response from ranges do number := size(value.ranges)
      initial marked state blocked { on response from scan if value = clear goto free }
      marked state free { on response from scan if value = near goto blocked }
    }
  }
  datatype enum Lamp from boolean to { value -> bright default -> dark }
}"""


@pytest.mark.parametrize(
    ("line", "state"),
    [
        ('scan with {"ranges": [9.0]}', "Lidar.free"),
        ('scan with {"ranges": {"0": 9.0}}', "Lidar.free"),
        ('scan with {"ranges": [0.25]}', "Lidar.blocked"),
        ("scan with clear", "Lidar.free"),
        ('ranges with {"ranges": [1.0, 2.0]}', "Lidar.number = 2"),
        ('ranges with {"ranges": {"2": 2.0}}', "Lidar.number = 3"),
    ],
)
def test_data_of_ros_is_played_as_it_is(folder: Path, line: str, state: str) -> None:
    (folder / "x.rscd").write_text(LIDAR)
    (folder / "x.scenarios").write_text(f'scenario "one"\n  {line}\n  expect {state}\n')
    answer = played_files("x.rscd", "x.scenarios")
    assert answer.exit_code == 0, answer.stdout


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("lamp with true", "true is ROS data instead of a literal"),
        ('frame with "\\ud800"', "expected a text that UTF-8 can encode"),
    ],
)
def test_data_that_is_not_played(folder: Path, line: str, message: str) -> None:
    (folder / "x.rscd").write_text(LIDAR)
    (folder / "x.scenarios").write_text(f'scenario "one"\n  {line}\n  expect !Lidar.lit\n')
    answer = played_files("x.rscd", "x.scenarios", "--traces", "traces")
    assert answer.exit_code == 1
    assert message in answer.stdout


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("expect Lidar.free) or (true", "this is not a single condition"),
        ("expect Lidar.free /* later", "this is not a single condition"),
        ("expect scan sent", "the response from `Lidar.scan` comes from the robot, not from the controller"),
        ("expect Lidar.far > 0.3", "the supervisor needs it, expected boolean, an integer with a range or an enum"),
    ],
)
def test_expectations_that_mean_nothing(folder: Path, line: str, message: str) -> None:
    (folder / "x.rscd").write_text(LIDAR.replace("variable lit", "variable far: double variable lit"))
    (folder / "x.scenarios").write_text(f'scenario "one"\n  frame with "a"\n  {line}\n')
    answer = played_files("x.rscd", "x.scenarios")
    assert answer.exit_code == 1
    assert "x.scenarios:3:" in answer.stdout
    assert message in answer.stdout


def test_null_is_no_number(folder: Path) -> None:
    (folder / "x.rscd").write_text(LIDAR.replace("> 0.5 -> clear default -> near", "< 0.5 -> near default -> clear"))
    (folder / "x.scenarios").write_text('scenario "one"\n  scan with {"ranges": [null]}\n  expect Lidar.free\n')
    answer = played_files("x.rscd", "x.scenarios")
    assert answer.exit_code == 0, answer.stdout


def test_what_can_not_come() -> None:
    """Later steps of the scenario are not tried; other scenarios are."""
    failing = "  error from dock\n  error from dock\n  expect Dock.docked\n"
    text = f'scenario "one"\n{failing}scenario "two"\n  expect Dock.docked\n'
    told = findings(text)
    assert [line for line, _, _ in told] == [3, 6]
    assert told[0][2].endswith("cannot come now: it ends no running call or goal")


def test_all_faults_are_told_in_one_run() -> None:
    text = """expect Dock.away
scenario docks
  wait 3 hours
  wait 200 min
  expect
  hit with {"a": }
  hti with true
  expect Dock.dockd
  expect Dock.docked and
  dock
  expect dock not sent with 1
  §
"""
    told = findings(text)
    assert [line for line, _, _ in told] == [1, 2, 3, 5, 6, 7, 8, 9, 10, 11, 12]
    assert "no variable or state `dockd`" in told[6][2]
    assert told[6][1] == 15


def test_a_scenario_without_expectations() -> None:
    assert findings('scenario "one"\n  wait 1 s\n') == [(1, 1, "the scenario has no expectation")]


@pytest.mark.parametrize("text", ["", "\n// the start\n"])
def test_a_file_without_scenarios(text: str) -> None:
    assert findings(text) == [(1, 1, "the file has no scenario")]


def test_a_tab_separates_words() -> None:
    assert findings('scenario\t"one"\n\twait\t100 ms\n\texpect\tDock.docking\n') == []


def test_a_wait_has_a_limit(folder: Path) -> None:
    (folder / "fast.json").write_text('{"controlLoop": {"periodMs": 1}}')
    text = 'scenario "one"\n  wait 60 min\n  expect lamp sent\n'
    limit = "this time has 3,600,000 ticks of the control loop, at most a million"
    assert findings(text, "--config", "fast.json") == [(2, 3, limit)]


def test_conditions_know_the_language() -> None:
    assert findings('scenario "one"\n  expect Dock.away => !(Bumper.pressed) and 1 + 1 = 2 // so it is\n') == []


def test_traces_are_event_logs(folder: Path) -> None:
    assert played(GOOD, "--traces", "traces").exit_code == 0
    names = sorted(path.name for path in (folder / "traces").iterdir())
    assert names == ["scenario_1.jsonl", "scenario_2.jsonl", "scenario_3.jsonl"]
    lines = [json.loads(line) for line in (folder / "traces" / "scenario_1.jsonl").read_text().splitlines()]
    assert [line["event"] for line in lines if line["direction"] == "out"] == [
        "action_dock.c_trigger",
        "message_lamp.c_trigger",
        "message_lamp.c_trigger",
    ]
    assert next(line for line in lines if line["event"] == "action_dock.u_response")["message"] == {"slot": 3}


@pytest.mark.build
def test_a_generated_loop_that_differs_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """The difference is reported at the step that shows it."""

    def forgetful(target: str, models: robosc.Models, configuration: robosc.Configuration) -> dict[str, str]:
        files = generate(target, models, configuration)
        text = files["porter_supervisor.c"]
        assert mutated in text
        return {**files, "porter_supervisor.c": text.replace(mutated, ";")}

    mutated = "\n            && state->component_Bumper == porter_component_Bumper_clear;"
    generate = robosc.generate
    monkeypatch.setattr(robosc, "generate", forgetful)
    [(line, _, message)] = findings(GOOD, "--engine", "c")
    assert GOOD.splitlines()[line - 1].strip() == "canceled from dock"
    assert message.startswith("in the control loop of the generated C")
