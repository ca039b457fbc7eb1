"""Scenarios with repeated steps, blocks, times and counts: `every`, `stop`, `repeat`, `before each`, `within`."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from click.testing import CliRunner, Result

import robosc
from robosc.base.ros_types import RosTypes
from robosc.language import configuration as config
from robosc.run.node_tests.drive import parameters
from robosc.run.node_tests.samples import all_incoming
from robosc.run.node_tests.trace_player import Log, read_trace
from robosc.run.node_tests.trace_player import Player as TracePlayer
from robosc.run.node_tests.trace_test import player_files
from robosc.tools.cli import main
from tests.run.node_tests import in_process_node
from tests.run.node_tests.test_traces import be_impatient

if TYPE_CHECKING:
    from collections.abc import Callable

MODEL = Path(__file__).parent / "uvlamp.rscd"


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    shutil.copy(MODEL, tmp_path)
    return tmp_path


def played(text: str, *options: str) -> Result:
    Path("lamp.scenarios").write_text(text, encoding="utf-8")
    return CliRunner().invoke(main, ["test", MODEL.name, "lamp.scenarios", *options], catch_exceptions=False)


def findings(text: str, *options: str) -> list[tuple[int, int, str, str]]:
    answer = played(text, "--format", "json", *options)
    rows = [finding for finding in json.loads(answer.stdout) if finding["rule"] == "scenario"]
    assert answer.exit_code == bool(rows), answer.output
    return [(row["line"], row["column"], row["message"], row["hint"] or "") for row in rows]


GOOD = """
before each {
  // the door reports at least once in a second
  every 500 ms response from closed with true
  every 1 s Room.motion with {"data": false}
}

scenario "shines when nobody has been there for a while"
  expect lamp forbidden by R1
  expect lamp sent with 0.5 within 5 s
  stop closed
  expect Door.unknown within 2 s
  wait 100 ms
  expect lamp not sent

scenario "goes out for a person"
  wait 5 s
  repeat 3 {
    motion with true
    expect Room.quiet = 0
    repeat 2 { wait 2500 ms }
    expect lamp sent within 200 ms
  }
  every 200 ms motion with true
  wait 1 s
  expect lamp not sent

scenario "counts"
  wait 6 s
  wait 1 s
  expect lamp sent 10 times
  expect lamp sent 10 times with {"data": 0.5}
  repeat 4 {
    wait 500 ms
  }
  expect lamp sent 20 times
"""


@pytest.mark.parametrize("engine", ["python", pytest.param("c", marks=pytest.mark.build)])
def test_repeated_steps_times_and_counts_are_played(engine: str) -> None:
    answer = played(GOOD, "--engine", engine)
    assert answer.exit_code == 0, answer.output
    assert "3 passed in " in answer.stderr


def times_of(event: str, text: str, *options: str) -> list[float]:
    assert played(text, "--traces", "traces", *options).exit_code == 0
    lines = map(json.loads, Path("traces/scenario_1.jsonl").read_text().splitlines())
    return [round(line["time"], 2) for line in lines if line["event"] == event]


CLOSED = "message_closed.u_response"


@pytest.mark.parametrize(
    ("interval", "count"), [("500 ms", 5), ("2 s", 2), ("0.3 s", 7), ("50 ms", 41), ("70 ms", 29), ("1 min", 1)]
)
def test_every_begins_at_once_and_comes_as_often_as_its_interval_fits(interval: str, count: int) -> None:
    text = f'scenario "one"\n  every {interval} closed with true\n  wait 2 s\n  expect Room.quiet = 0\n'
    times = times_of(CLOSED, text)
    assert len(times) == count
    assert times[0] == pytest.approx(0.16)


def test_stop_ends_a_repetition_and_a_second_every_replaces_the_first() -> None:
    text = """scenario "one"
  every 200 ms closed with true
  wait 400 ms
  every 1 s response from Door.closed with true
  wait 2 s
  stop response from closed
  wait 3 s
  expect Door.unknown
"""
    assert times_of(CLOSED, text) == [0.16, 0.36, 0.56, 0.56, 1.56, 2.56]


def test_a_second_stop_is_a_fault() -> None:
    text = 'scenario "one"\n  every 1 s motion with false\n  stop motion\n  stop motion\n  expect Door.unknown\n'
    [(line, _, message, _)] = findings(text)
    assert (line, message) == (4, "no `every` before this line repeats the response from `Room.motion`")


@pytest.mark.slow
def test_a_node_follows_the_event_logs(monkeypatch: pytest.MonkeyPatch) -> None:
    """A node in this process, played by the trace player of generated packages."""
    assert played(GOOD, "--traces", "traces").exit_code == 0
    robot, configuration = robosc.load(MODEL.name), config.Configuration()
    robosc.synthesize(robosc.to_sct(robot))
    graph = robosc.to_rosgraph(robot)
    incoming = all_incoming(graph, RosTypes().distributions[0])
    files = player_files(graph, configuration, parameters(graph, configuration), incoming)
    connections = json.loads(files["connections.json"])
    be_impatient(monkeypatch)
    traces = sorted(Path("traces").iterdir())
    assert len(traces) == 3
    for trace in traces:
        log = Path(f"{trace.stem}.events.jsonl")
        node = in_process_node.InProcessNode(connections, graph, configuration, log)
        TracePlayer(connections, node, Log(str(log))).play(read_trace(str(trace)))


def test_a_repetition_goes_on_while_a_step_takes_its_time() -> None:
    """The failure of a call takes the time of the configuration."""
    text = (
        'scenario "one"\n  every 1 s motion with false\n  error from drive because timeout\n  expect Room.quiet = 5\n'
    )
    assert findings(text) == []


def test_a_repetition_belongs_to_its_scenario() -> None:
    text = 'scenario "one"\n  every 1 s closed with true\n  expect Door.shut\n'
    assert findings(text + 'scenario "two"\n  wait 3 s\n  expect Door.unknown\n') == []


def test_a_repetition_that_cannot_be_played_is_reported_at_its_line() -> None:
    text = 'scenario "one"\n  every 1 s feedback from drive\n  response from drive\n  wait 5 s\n  expect Base.parked\n'
    [(line, _, message, _)] = findings(text)
    assert (line, message) == (2, "the feedback from `Base.drive` cannot come now: no goal runs")


def test_a_failed_expectation_in_a_block_is_reported_once_with_its_round() -> None:
    text = """scenario "one"
  repeat 2 {
    repeat 3 {
      motion with false
      expect Room.quiet < 5
    }
  }
"""
    [(line, column, message, hint)] = findings(text)
    assert (line, column, message) == (5, 14, "`Room.quiet < 5` does not hold")
    assert hint.endswith("Room.quiet = 5; in round 2 of 2; in round 2 of 3")


def test_a_failed_shared_line_names_its_scenario() -> None:
    text = """before each {
  motion with false
  expect Room.quiet = 2
}
scenario "first"
  expect Door.unknown
scenario "second"
  expect Door.unknown
"""
    rows = findings(text)
    assert [(line, hint.rpartition("; ")[2]) for line, _, _, hint in rows] == [
        (3, 'in the scenario "first"'),
        (3, 'in the scenario "second"'),
    ]


def test_an_expectation_that_is_not_met_in_time_names_the_time() -> None:
    text = 'scenario "one"\n  every 1 s motion with false\n  expect Room.quiet = 5 within 3 s\n'
    [(line, column, message, hint)] = findings(text)
    assert (line, column, message) == (3, 10, "after 3 s, `Room.quiet = 5` does not hold")
    assert "Room.quiet = 4" in hint


def test_time_passes_only_until_an_expectation_is_met() -> None:
    text = """scenario "one"
  every 1 s motion with false
  expect Room.quiet = 3 within 1 min
  expect Room.quiet = 3
"""
    assert findings(text) == []


@pytest.mark.parametrize(
    ("expectation", "message"),
    [
        ("lamp sent 9 times", "the request to `Lamp.lamp` was sent 10 times since the last step, not 9"),
        ("lamp sent 1 time", "the request to `Lamp.lamp` was sent 10 times since the last step, not 1"),
        (
            "lamp sent 9 times with 0.5",
            "the request to `Lamp.lamp` with this data was sent 10 times since the last step, not 9",
        ),
        ("lamp sent 10 times with 0.25", "the request to `Lamp.lamp` was sent with other data"),
        ("drive sent 2 times", "the request to `Base.drive` was not sent since the last step"),
    ],
)
def test_another_count_is_reported(expectation: str, message: str) -> None:
    text = GOOD.replace("  repeat 4 {\n    wait 500 ms\n  }\n  expect lamp sent 20 times\n", "")
    line = text.count("\n") + 1
    assert [row[::2] for row in findings(f"{text}  expect {expectation}\n")] == [(line, message)]


def test_all_faults_of_blocks_and_times_are_reported_in_one_run(golden: Callable[[Path, str], None]) -> None:
    text = """repeat 2 {
}
}
before each {
  motion with false
scenario "one"
  before each { motion with false }
  repeat 0 {
    expect Door.shut
  }
  repeat many {
    expect Door.shut
  }
  repeat 1000 { repeat 1001 { motion with false } }
  repeat 3 { motion with false
  }
  every 0 s motion with false
  every 25 h motion with false
  every 1 s wait 1 s
  every 1 s error from drive
  every 1 s motin with false
  every 1 s motion with 3
  stop motion
  stop lamp
  expect lamp sent 0 times
  expect lamp not sent within 1 s
  expect lamp sent within 2 days
  expect lamp sent within
  expect lamp sent within 25 min with 0.5
  expect lamp not sent 3 times
  expect lamp sent twice
  repeat 2 {
"""
    answer = played(text)
    assert answer.exit_code == 1
    golden(Path(__file__).parent / "blocks.findings.txt", answer.stdout)


def test_what_data_a_repeated_step_has_is_checked_before_the_first_scenario() -> None:
    text = 'scenario "one"\n  every 1 s motion with 3\n  expect Door.unknown\n'
    assert [row[:3] for row in findings(text)] == [(2, 3, "value is 3, expected a boolean")]


def test_deep_blocks_are_refused() -> None:
    deep = "  repeat 1 {\n" * 500 + "  }\n" * 500
    rows = findings(f'scenario "one"\n  expect Door.unknown\n{deep}')
    assert {row[2] for row in rows} == {"more than 10 blocks are within each other"}


def test_a_block_with_too_many_ticks_is_refused_at_once() -> None:
    text = 'scenario "one"\n  repeat 1000 {\n    wait 1 h\n  }\n  expect Door.unknown\n'.replace("1 h", "60 min")
    [(line, _, message, _)] = findings(text)
    assert (line, message) == (3, "this time has 36,000,000 ticks of the control loop in all rounds, at most a million")


NAMES = """\
robot Names {
  component Words {
    outgoing message stop with identifier: "/stop", type: boolean
    outgoing message every with identifier: "/every", type: boolean
    outgoing message repeat with identifier: "/repeat", type: none
    outgoing message before with identifier: "/before", type: none
    incoming message go with identifier: "/go", type: none

    behaviour {
      variable last: integer(0..4) = 0

      on response from stop do last := 1
      on response from every do last := 2
      on response from ^repeat do last := 3
      on response from before do last := 4

      initial marked state listening {}
    }
  }

  requirement R1 "stop within 2 s": go needs Words.last = 0
}
"""


def test_older_files_keep_their_meaning(folder: Path) -> None:
    """Events may have the names of the words of blocks, and the text of a requirement may have a time."""
    (folder / "names.rscd").write_text(NAMES.replace("^repeat", "repeat"))
    steps = {"stop with true": 1, "every with true": 2, "repeat": 3, "before": 4, "stop": 1}
    lines = "".join(f"  {step}\n  expect Words.last = {last}\n" for step, last in steps.items())
    (folder / "names.scenarios").write_text(f'scenario "one"\n{lines}  expect go forbidden by stop within 2 s\n')
    answer = CliRunner().invoke(main, ["test", "names.rscd", "names.scenarios"], catch_exceptions=False)
    assert answer.exit_code == 0, answer.output


def test_a_cancel_is_sent_without_data(folder: Path) -> None:
    model = folder / MODEL.name
    stop = """component Stop {
    outgoing message pressed with identifier: "/pressed", type: none
    behaviour {
      initial marked state released { on response from pressed goto held }
      marked state held {}
    }
  }

  component Base {"""
    text = model.read_text().replace("component Base {", stop).replace("drive needs", "drive needs Stop.released and")
    model.write_text(text)
    steps = 'scenario "one"\n  pressed\n  expect cancel from drive sent\n  expect cancel from drive sent 1 time'
    assert findings(f"{steps}\n") == []
    [(line, _, message, hint)] = findings(f"{steps} with 1\n")
    assert (line, message, hint) == (4, "the cancel of `Base.drive` has no data", "leave out `with …`")
