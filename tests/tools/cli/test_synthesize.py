"""`robosc synthesize`: the supervisor as text and as JSON."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from robosc.synthesis import Strategy

from .conftest import DOOR, Run


def test_as_json(run: Run, door: Path) -> None:
    answer = run("synthesize", door, "--json")
    assert answer.exit_code == 0
    said = json.loads(answer.stdout)
    assert said.pop("seconds") > 0
    assert said.pop("processor_seconds") > 0
    assert said.pop("bdd_nodes") > 0
    assert said.pop("peak_nodes") > 0
    assert said.pop("operations") > 0
    assert said.pop("peak_bytes") > 1 << 20
    assert [*said.pop("phase_seconds")] == ["order", "encode", "fixpoint", "guards", "observe"]
    assert said == {
        "robot": "Door",
        "uncontrolled_states": 2,
        "controlled_states": 2,
        "empty": False,
        "rounds": 1,
        "strategy": "forward",
        "attempts": 1,
        "requirements": [
            {
                "name": None,
                "texts": ["requirement open needs Leaf.closed"],
                "file": str(door),
                "line": 17,
                "column": 3,
                "states": 0,
            }
        ],
        "events": [
            {
                "name": "message_open.c_trigger",
                "controllable": True,
                "guard": "true",
                "added_by_synthesis": None,
                "ever_enabled": True,
            },
            {
                "name": "message_close.c_trigger",
                "controllable": True,
                "guard": "true",
                "added_by_synthesis": None,
                "ever_enabled": True,
            },
        ],
    }


def test_all_but_the_time_is_the_same_on_every_run(run: Run, door: Path) -> None:
    said = [json.loads(run("synthesize", door, "--json").stdout) for _ in range(2)]
    for event in said:
        del event["seconds"], event["processor_seconds"], event["phase_seconds"], event["peak_bytes"]
    assert said[0] == said[1]


#: Two counts and their sum: neither single steps nor accelerated ones finish within minutes.
SUM = """
robot Sum {
  component Counter {
    outgoing message left with identifier: "/left", type: none
    outgoing message right with identifier: "/right", type: none
    incoming message go with identifier: "/go", type: none

    behaviour {
      variable lefts: integer(0..2000000000)
      variable rights: integer(0..2000000000)
      variable all: integer(0..2000000000)
      initial marked state counting {
        on response from left do lefts := lefts + 1, all := all + 1
        on response from right do rights := rights + 1, all := all + 1
      }
    }
  }

  requirement go needs Counter.all < Counter.lefts + Counter.rights
}
"""


@pytest.fixture
def long(tmp_path: Path) -> Path:
    """Return a file with a robot whose synthesis takes minutes and much memory."""
    file = tmp_path / "sum.rscd"
    file.write_text(SUM)
    return file


@pytest.mark.parametrize("command", [("synthesize", "--json"), ("transform", "--to", "cif")])
def test_memory_is_bounded(run: Run, long: Path, command: tuple[str, ...]) -> None:
    answer = run(*command, "--memory", "1", long)
    assert answer.exit_code == 2
    assert answer.stdout == ""
    assert answer.stderr == (
        "Error: the model is too large: synthesis needs more than 1 MiB for its decision diagrams: "
        "raise `--memory` of `synthesize` or `transform`, or give integers smaller ranges\n"
    )
    assert sorted(Path.cwd().iterdir()) == [long]


def test_no_memory_at_all_is_a_wrong_call(run: Run, door: Path) -> None:
    assert run("synthesize", door, "--memory", "0").exit_code == 2


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="there are no pseudo-terminals")
def test_an_interrupt_ends_a_long_synthesis(long: Path) -> None:
    """On a terminal with progress output: the cursor stays visible, and there is no output."""
    ours, theirs = os.openpty()
    command = [sys.executable, "-m", "robosc", "synthesize", "--json", long]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=theirs, stdin=subprocess.DEVNULL, env={**os.environ, "TERM": "xterm"}
    ) as process:
        os.close(theirs)
        shown = b""
        while b"fixpoint, round" not in shown and b"operations" not in shown:
            shown += os.read(ours, 1000)
        process.send_signal(signal.SIGINT)
        try:
            while more := os.read(ours, 1000):
                shown += more
        except OSError:
            pass  # the end of a pseudo-terminal raises this
        assert process.stdout is not None
        assert process.stdout.read() == b""
    os.close(ours)
    assert process.returncode == 130
    assert b"Traceback" not in shown
    assert shown.rindex(b"\x1b[?25h") > shown.rindex(b"\x1b[?25l")


#: A leaf that can only be closed while it is not locked, and that must not stay open.
LOCK = """
  component Lock {
    incoming message lock with identifier: "/lock", type: none

    behaviour {
      initial marked state free {
        on request to lock goto locked
      }

      marked state locked {}
    }
  }

  requirement close needs Lock.free
}
"""


def test_as_text(run: Run, tmp_path: Path) -> None:
    file = tmp_path / "lock.rscd"
    file.write_text(DOOR.partition("\n  requirement")[0].replace("marked state opened", "state opened") + LOCK)
    answer = run("synthesize", file)
    assert answer.exit_code == 0, answer.output
    assert answer.stdout == (
        "Door: 3 states, of 4 without requirements\n"
        "\nmessage_open.c_trigger\n"
        "    guard: component_Lock.free\n"
        "    added by synthesis: component_Lock.free\n"
        "\nmessage_close.c_trigger\n"
        "    guard: true\n"
        "\nmessage_lock.c_trigger\n"
        "    guard: component_Leaf.closed\n"
        "    added by synthesis: component_Leaf.closed\n"
        "\n`requirement close needs Lock.free` (line 29)\n"
        "    matters in no state\n"
    )


def test_the_text_tells_what_the_robot_does(run: Run, tmp_path: Path) -> None:
    """The text has silent events in words, no choices of data, and no guards without effect."""
    file = tmp_path / "lamp.rscd"
    file.write_text(
        """robot Lamp {
  component Sensor {
    outgoing message dark with identifier: "/dark", type: boolean
    incoming message light with identifier: "/light", type: boolean
    incoming message flash with identifier: "/flash", type: none

    behaviour {
      variable seen: boolean = false
      on response from dark do seen := value
      initial marked state day { transition if seen goto night }
      marked state night { transition if !seen goto day }
      marked state never { on request to flash goto day }
    }
  }

  requirement light needs Sensor.night
  provide light with true
}
"""
    )
    assert run("synthesize", file).stdout == (
        "Lamp: 8 states, of 8 without requirements\n"
        "\nmessage_light.c_trigger\n"
        "    guard: component_Sensor.night\n"
        "\nmessage_flash.c_trigger (never enabled)\n"
        "\nSensor changes by itself: day to night\n"
        "    guard: true\n"
        "\nSensor changes by itself: night to day\n"
        "    guard: true\n"
        "\n`requirement light needs Sensor.night` (line 16)\n"
        "    restricts the robot in 4 states\n"
    )
    names = [event["name"] for event in json.loads(run("synthesize", file, "--json").stdout)["events"]]
    assert {"data_light.c_none", "component_Sensor.c_tau1"} <= {*names}


def test_silent_events_with_one_source_and_target_are_told_apart(run: Run, tmp_path: Path) -> None:
    file = tmp_path / "lamp.rscd"
    file.write_text(
        """robot Lamp {
  component Bulb {
    behaviour {
      variable level: integer(0..2)
      initial marked state off {
        transition do level := 1 goto on transition do level := 2 goto on
        transition if level = 2 goto on
      }
      marked state on { transition goto off }
    }
  }
}
"""
    )
    headings = [line for line in run("synthesize", file).stdout.splitlines() if line.startswith("Bulb")]
    assert headings == [
        "Bulb changes by itself: off to on (line 6, column 9)",
        "Bulb changes by itself: off to on (line 6, column 42)",
        "Bulb changes by itself: off to on (line 7)",
        "Bulb changes by itself: on to off",
    ]


def test_no_supervisor(run: Run, stuck: Path) -> None:
    answer = run("synthesize", stuck, "--json")
    assert answer.exit_code == 3
    said = json.loads(answer.stdout)
    assert (said["empty"], said["controlled_states"], said["events"]) == (True, 0, [])
    assert "needs request to `Leaf.open` where `requirement open needs Leaf.opened` (line " in answer.stderr
    assert "component_" not in answer.stderr
    assert "[empty-supervisor]" in answer.stderr
    assert f"{stuck}:3:5: error: " in answer.stderr
    assert run("synthesize", stuck).exit_code == 3
    assert run("synthesize", stuck).stdout == ""


def test_errors_come_first(run: Run, broken: Path) -> None:
    answer = run("synthesize", broken, "--json")
    assert (answer.exit_code, answer.stdout) == (1, "")
    assert "[initial-state]" in answer.stderr


def test_a_library_has_no_supervisor(run: Run, library: Path) -> None:
    answer = run("synthesize", library)
    assert answer.exit_code == 2
    assert "has a library" in answer.stderr


def test_warnings_of_synthesis_leave_the_status_alone(run: Run, courier: Path) -> None:
    answer = run("synthesize", courier, "-I", "parts", "--json")
    assert answer.exit_code == 0
    assert json.loads(answer.stdout)["controlled_states"] == 16
    assert "parts/lamps.rscd:4:5: warning: `Lamps.light` and `Lamps.dark` go to one topic" in answer.stderr
    assert "[shared-topic-conflict]" in answer.stderr
    assert "[shared-topic-conflict]" not in run("check", courier, "-I", "parts").stdout


def test_errors_of_synthesis_are_shown_beside_the_supervisor(run: Run, self_cancelling: Path) -> None:
    answer = run("synthesize", self_cancelling, "-I", "parts", "--json")
    assert answer.exit_code == 1
    assert json.loads(answer.stdout)["empty"] is False
    assert f"{self_cancelling}:20:3: error: `Base.drive` is cancelled as soon as it has started" in answer.stderr


def test_events_that_come_from_the_robot_are_listed_too(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "tank.rscd"
    path.write_text(
        """robot Tank {
  component Level {
    outgoing message full with type: none
    outgoing message drained with type: none
    incoming message drain with type: none
    behaviour {
      initial marked state low { on response from full goto high }
      marked state high { on request to drain goto low }
    }
  }
}
"""
    )
    events = json.loads(run("synthesize", path, "--json").stdout)["events"]
    assert [(event["name"], event["controllable"], event["ever_enabled"]) for event in events] == [
        ("message_full.u_response", False, True),
        ("message_drained.u_response", False, True),
        ("message_drain.c_trigger", True, True),
    ]


def test_the_order_and_the_strategy_leave_the_guards(run: Run, door: Path, tmp_path: Path) -> None:
    answer = run("synthesize", door)
    order = tmp_path / "order.txt"
    order.write_bytes(b"\xef\xbb\xbf# from the top\r\nmessage_open  # first\r\n\r\ncomponent_Leaf\r\n")
    for options in (["--order", "text"], ["--order", str(order)], *(["--strategy", s] for s in Strategy)):
        assert run("synthesize", door, *options).output == answer.output


def test_all_lines_without_an_element_are_errors(run: Run, door: Path, tmp_path: Path) -> None:
    order = tmp_path / "order.txt"
    order.write_text("component_Leav\nmessage_open\n  wheel # of the door\n")
    answer = run("synthesize", door, "--counts", "--order", order)
    assert answer.exit_code == 2
    assert answer.stderr.splitlines() == [
        f"Error: {order}:1:1: the model has no element `component_Leav`; did you mean `component_Leaf`?",
        f"{order}:3:3: the model has no element `wheel`; `synthesize --explain-cost` prints all names",
    ]
    assert run("transform", door, "--to", "cif", "-o", tmp_path / "out", "--order", order).exit_code == 2
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("content", [None, b"component_Leaf\xff\n"])
def test_an_order_that_cannot_be_read_is_an_error(run: Run, door: Path, tmp_path: Path, content: bytes | None) -> None:
    order = tmp_path / "order.txt"
    if content is not None:
        order.write_bytes(content)
    answer = run("synthesize", door, "--order", order)
    assert answer.exit_code in {1, 2}
    assert str(order) in answer.stderr


def test_the_cost_names_events_and_requirements(run: Run, door: Path) -> None:
    answer = run("synthesize", door, "--explain-cost")
    assert answer.exit_code == 0
    first, *lines = answer.output.splitlines()
    assert first == "Door: 2 states"
    assert any("`requirement open needs Leaf.closed` (line 17)" in line for line in lines)
    order = lines[lines.index("order of the diagrams, from the top (a file with these lines is a value of --order):") :]
    assert "component_Leaf" in {line.strip() for line in order[1:]}
    cost = json.loads(run("synthesize", door, "--explain-cost", "--json").stdout)
    assert cost["order"] == [line.strip() for line in order[1:]]
    assert cost["hubs"] == [{"element": "component_Leaf", "couplings": 2}]
    assert cost["events"][0]["operations"] > 0


@pytest.mark.parametrize("option", [["--counts"], ["--without", "A1"]])
def test_the_cost_replaces_the_other_output(run: Run, door: Path, option: list[str]) -> None:
    answer = run("synthesize", door, "--explain-cost", *option)
    assert answer.exit_code == 2
    assert "--explain-cost replaces the other output" in answer.stderr


def test_the_printed_order_is_a_value_of_the_option(run: Run, tmp_path: Path) -> None:
    path, order = tmp_path / "lamp.cif", tmp_path / "order.txt"
    path.write_text(
        "input bool a, b; controllable c; plant P: disc int[0..3] n; location: initial; marked;"
        " edge c when a and not b and n < 3 do n := n + 1; end"
    )
    for option in ([], ["--order", "text"]):
        names = json.loads(run("synthesize", path, "--explain-cost", "--json", *option).stdout)["order"]
        assert {"specification.a", "specification.a+"} <= set(names)
        order.write_text("\n".join(names))
        again = json.loads(run("synthesize", path, "--explain-cost", "--json", "--order", order).stdout)
        assert again["order"] == names
