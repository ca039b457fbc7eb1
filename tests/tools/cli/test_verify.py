"""`robosc verify`: the table, the traces, JSON, JUnit, and the exit status."""

import json
from pathlib import Path
from xml.etree import ElementTree

import pytest

from robosc.analysis.paths import TraceStep
from robosc.analysis.verify import Outcome, Verdict

from .conftest import Run

LOCK = """\
robot Lock {
  component Bolt {
    outgoing message seen with identifier: "/seen", type: none
    incoming message turn with identifier: "/turn", type: none

    behaviour {
      initial marked state out {
        on response from seen goto halfway
        on request to turn
      }

      marked state halfway {
        transition goto in
        transition goto out
      }

      marked state in {
        on request to turn goto out
      }
    }
  }
}
"""


GATE = """\
robot Gate {
  component Leaf {
    incoming message open with identifier: "/open", type: none
    incoming message push with identifier: "/push", type: none
    incoming message pull with identifier: "/pull", type: none

    behaviour {
      initial marked state closed {
        on request to open
        on request to push
        on request to pull
      }
    }
  }

  requirement closed_first: {open, push} needs Leaf.closed
  requirement pull needs Leaf.closed
}
"""


@pytest.fixture
def lock(tmp_path: Path) -> Path:
    """Return a robot with a choice between two silent transitions."""
    file = tmp_path / "lock.rscd"
    file.write_text(LOCK)
    return file


@pytest.fixture(autouse=True)
def translated(monkeypatch: pytest.MonkeyPatch) -> None:
    """Skip the comparison of generated code with the model, which other tests check and which takes too long."""
    found = [Verdict("c-translation", Outcome.SKIPPED, "", "no C compiler is here")]
    monkeypatch.setattr("robosc.analysis.verify.validate", lambda *_: found)


def test_a_table_and_a_count(run: Run, door: Path) -> None:
    answer = run("verify", door)
    assert answer.exit_code == 0, answer.output
    rows = [[cell.strip() for cell in line.split("│")[1:-1]] for line in answer.stdout.splitlines() if "│" in line]
    assert [row[:3] for row in rows] == [
        ["non-blocking", "proved", "2 states, 2 of them marked"],
        ["controllability", "proved", "2 states, 0 uncontrollable events"],
        ["input-enabledness", "proved", "2 states, 0 events"],
        ["requirement open needs Leaf.closed (line 17)", "proved", "happens in 1 state, requires `Leaf.closed`"],
        ["no dead events", "proved", "2 states, 2 events"],
        ["maximal permissiveness", "proved", "2 states, 2 controllable events"],
        ["finite response", "proved", "2 states, 0 silent events"],
        ["bounded response", "proved", "2 states, at most 0 silent events in a row"],
        ["confluence", "proved", "2 states, 2 of them at rest"],
        ["non-blocking in the control loop", "proved", "2 states"],
        ["model-translation", "proved", "2 states, 2 events"],
        ["controller-translation", "proved", "0 times, 2 events"],
        ["c-translation", "skipped", ""],
    ]
    assert answer.stdout.endswith(
        "\nc-translation: no C compiler is here\n\n"
        "Trusted, not examined: the reading of the text itself, the ROS node around the control loop, the C compiler, "
        "RoboSC itself; see docs/verify.md.\n\n"
        "Door: 12 proved, 1 skipped\n"
    )


def test_what_is_refuted_is_shown_with_its_traces(run: Run, lock: Path) -> None:
    answer = run("verify", lock)
    assert answer.exit_code == 1
    assert answer.stdout.partition("\nconfluence: ")[2].partition("\n\n")[0] == (
        "depending on their order, silent events end where `Bolt.out` or where `Bolt.in`\n"
        "  after\n"
        "    1. response from `Bolt.seen`\n"
        "  then\n"
        "    1. transition of `Bolt` in line 14\n"
        "  or instead\n"
        "    1. transition of `Bolt` in line 13"
    )


def test_transitions_in_one_line_are_told_apart(run: Run, lock: Path) -> None:
    lock.write_text(" ".join(lock.read_text().split()))
    told = run("verify", lock).stdout.partition("\nconfluence: ")[2]
    columns = [lock.read_text().index(f"transition goto {direction}") + 1 for direction in ("out", "in")]
    assert all(f"    1. transition of `Bolt` in line 1, column {column}\n" in told for column in columns)


def test_as_json(run: Run, lock: Path) -> None:
    answer = run("verify", lock, "--json")
    assert answer.exit_code == 1
    said = json.loads(answer.stdout)
    assert (said["robot"], said["proved"]) == ("Lock", False)
    confluence = next(answer for answer in said["properties"] if answer["property"] == "confluence")
    assert confluence.pop("seconds") >= 0
    assert confluence == {
        "property": "confluence",
        "outcome": "refuted",
        "evidence": "3 states, 2 of them at rest",
        "explanation": "depending on their order, silent events end where `Bolt.out` or where `Bolt.in`",
        "trace": [{"event": "message_seen.u_response", "inputs": {}}],
        "onwards": [{"event": "component_Bolt.c_tau2", "inputs": {}}],
        "other": [{"event": "component_Bolt.c_tau1", "inputs": {}}],
    }
    assert run("verify", lock, "--json").stdout.count("null") == answer.stdout.count("null") > 5


def test_as_junit(run: Run, lock: Path, tmp_path: Path) -> None:
    file = tmp_path / "results.xml"
    assert run("verify", lock, "--junit", file).exit_code == 1
    root = ElementTree.fromstring(file.read_text())  # noqa: S314
    suite = root.find("testsuite")
    cases = {case.get("name"): case for case in suite}
    assert (root.tag, suite.get("name"), suite.get("errors")) == ("testsuites", "Lock", "0")
    assert (suite.get("tests"), suite.get("failures"), suite.get("skipped")) == (str(len(cases)), "1", "1")
    assert {case.get("classname") for case in suite} == {"Lock"}
    failed = [name for name, case in cases.items() if case.find("failure") is not None]
    assert failed == ["confluence"]
    assert "1. response from `Bolt.seen`" in cases["confluence"].find("failure").text
    assert cases["c-translation"].find("skipped").get("message") == "no C compiler is here"
    assert cases["non-blocking"].find("system-out").text == "3 states, 3 of them marked"
    assert not list(root.iter("properties"))


def test_a_test_case_tells_which_requirement_it_verifies(run: Run, tmp_path: Path) -> None:
    """Test cases have the properties of Eclipse S-CORE: `FullyVerifies` if it is the requirement's only test case."""
    robot = tmp_path / "gate.rscd"
    robot.write_text(GATE)
    file = tmp_path / "results.xml"
    assert run("verify", robot, "--junit", file).exit_code == 0
    told = {
        case.get("name"): {entry.get("name"): entry.get("value") for entry in case.iter("property")}
        for case in ElementTree.fromstring(file.read_text()).iter("testcase")  # noqa: S314
        if case.find("properties") is not None
    }
    how = {"TestType": "requirements-based", "DerivationTechnique": "requirements-analysis"}
    assert list(told.values()) == [
        {"PartiallyVerifies": "closed_first", **how},
        {"PartiallyVerifies": "closed_first", **how},
        {"FullyVerifies": "gate.rscd:17", **how},
    ]


def test_inputs_are_in_the_traces(run: Run, door: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    step = TraceStep("message_open.c_trigger", {"i_response": 3})
    found = [Verdict("c-translation", Outcome.REFUTED, "", "it differs", (step,))]
    monkeypatch.setattr("robosc.analysis.verify.validate", lambda *_: found)
    answer = run("verify", door, "--json")
    assert answer.exit_code == 1
    trace = json.loads(answer.stdout)["properties"][-1]["trace"]
    assert trace == [{"event": "message_open.c_trigger", "inputs": {"i_response": 3}}]


def test_nothing_but_the_seconds_changes(run: Run, lock: Path) -> None:
    said = [json.loads(run("verify", lock, "--json").stdout) for _ in range(2)]
    for answer in said:
        for checked in answer["properties"]:
            del checked["seconds"]
    assert said[0] == said[1]


def test_no_supervisor(run: Run, stuck: Path) -> None:
    answer = run("verify", stuck)
    assert (answer.exit_code, answer.stdout) == (3, "")
    assert "[empty-supervisor]" in answer.stderr


def test_errors_come_first(run: Run, broken: Path, self_cancelling: Path) -> None:
    assert run("verify", broken).exit_code == 1
    answer = run("verify", self_cancelling, "-I", "parts")
    assert (answer.exit_code, answer.stdout) == (1, "")
    assert "[self-cancelling]" in answer.stderr


def test_warnings_of_synthesis_are_shown(run: Run, courier: Path) -> None:
    answer = run("verify", courier, "-I", "parts")
    assert answer.exit_code == 0
    assert "[shared-topic-conflict]" in answer.stderr


def test_wrong_calls(run: Run, library: Path, door: Path) -> None:
    assert run("verify", library).exit_code == 2
    assert run("verify", "nothing.rscd").exit_code == 2
    assert run("verify", door, "--junit", door / "file.xml").exit_code == 2
