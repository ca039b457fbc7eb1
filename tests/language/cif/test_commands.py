"""Commands that accept a `.cif` file, and those that reject it."""

import importlib
import json
import re
import subprocess
from pathlib import Path

import pytest
from click.testing import CliRunner

from robosc.tools.cli import main
from tests.m2t.supervisor.driver import STRICT

_TEXT = """controllable c_on, c_off;
uncontrollable u_fail;
input bool pressed;
plant Motor:
  disc int[0..3] n;
  location Off: initial; marked;
    edge c_on when n < 3 do n := n + 1 goto On;
  location On:
    edge c_off goto Off;
    edge u_fail when pressed goto Broken;
  location Broken:
    edge c_off when n > 0 do n := n - 1 goto Off;
end
requirement c_on needs Motor.n != 2;
"""
#: `c_go` with n at 2 leads to a trap.
_TRAP = """
plant P:
  controllable c_go, c_more;
  disc int[0..3] n;
  location A: initial; marked;
    edge c_more when n < 3 do n := n + 1;
    edge c_go goto B;
  location B:
    edge c_go when n != 2 do n := 0 goto A;
end
"""


@pytest.fixture
def specification(tmp_path: Path) -> str:
    path = tmp_path / "motor.cif"
    path.write_text(_TEXT)
    return str(path)


def test_check_says_that_nothing_is_wrong(specification: str) -> None:
    result = CliRunner().invoke(main, ["check", specification])
    assert (result.exit_code, result.output) == (0, "")


def test_check_shows_the_line(tmp_path: Path) -> None:
    path = tmp_path / "wrong.cif"
    path.write_text(_TEXT.replace("u_fail when", "u_fial when"))
    result = CliRunner().invoke(main, ["check", str(path)])
    assert result.exit_code == 1
    assert "wrong.cif:10:10: error: there is no `u_fial` here [unresolved-reference]" in result.output
    assert "        edge u_fial when pressed goto Broken;\n             ^^^^^^" in result.output
    assert "hint: did you mean `u_fail`?" in result.output


def test_synthesize_counts_as_cif_does(specification: str) -> None:
    answer = json.loads(CliRunner().invoke(main, ["synthesize", specification, "--json"]).stdout)
    assert (answer["robot"], answer["controlled_states"], answer["empty"]) == ("motor", 14, False)
    assert [event["name"] for event in answer["events"]] == ["c_on", "c_off", "u_fail", "pressed"]
    assert answer["events"][0]["guard"] == "Motor.n != 2"


def test_a_guard_too_long_to_read_is_not_written_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "trap.cif"
    path.write_text(_TRAP)
    whole = json.loads(CliRunner().invoke(main, ["synthesize", str(path), "--json"]).stdout)
    assert (whole["events"][0]["guard"], whole["events"][0].get("guard_nodes")) == ("P.n != 2", None)
    monkeypatch.setattr(importlib.import_module("robosc.tools.cli.synthesize"), "_LONGEST", 0)
    answer = json.loads(CliRunner().invoke(main, ["synthesize", str(path), "--json"]).stdout)
    assert answer["controlled_states"] == whole["controlled_states"]
    guard = answer["events"][0]
    assert (guard["guard"], guard["added_by_synthesis"], guard["ever_enabled"]) == (None, None, True)
    assert guard["guard_nodes"] > 1
    said = CliRunner().invoke(main, ["synthesize", str(path)]).stdout
    assert f"guard: too long to print: a decision diagram of {guard['guard_nodes']} nodes" in said


def test_inputs_of_cif_are_counted_at_any_rate(specification: str) -> None:
    answer = json.loads(CliRunner().invoke(main, ["synthesize", specification, "--count-inputs", "--json"]).stdout)
    assert answer["controlled_states"] == 14


def test_synthesize_says_why_there_is_no_supervisor(tmp_path: Path) -> None:
    path = tmp_path / "empty.cif"
    path.write_text(_TEXT + "requirement u_fail needs false; requirement Motor.n > 0;")
    result = CliRunner().invoke(main, ["synthesize", str(path)])
    assert result.exit_code == 3
    assert "`requirement Motor.n > 0` (line 15)" in result.output


def test_explain_and_diagram_take_cif(specification: str) -> None:
    result = CliRunner().invoke(main, ["explain", specification, "--event", "c_off"])
    assert "`c_off`" in result.output
    assert result.exit_code == 0
    drawn = CliRunner().invoke(main, ["diagram", specification, "--kind", "plants"])
    assert "Broken" in drawn.output


def test_transform_adds_the_supervisor_to_the_specification(tmp_path: Path) -> None:
    path = tmp_path / "motor.cif"
    path.write_text(
        _TEXT.replace("int[0..3] n", "int[0..3] n in {0, 3}")
        + "group end_: controllable $end; uncontrollable u; input int[0..1] $if; end\n"
        + "plant q: location a: initial; marked; edge end_.$end when end_.$if = 1 goto b; "
        + "location b: edge end_.u goto c; location c; end\nrequirement Motor.n < 3;"
    )
    result = CliRunner().invoke(main, ["transform", str(path), "--to", "cif", "-o", str(tmp_path)])
    assert result.exit_code == 0, result.output
    assert (
        (tmp_path / "motor.supervised.cif").read_text()
        == """@@doc("motor under its supervisor: 28 states.")
import "motor.cif";

@doc("Conditions by synthesis.")
supervisor automaton sup:
  alphabet c_on, c_off, end_.end;
  initial Motor.n = 0;

  location:
    initial; marked;
    edge c_on;
    edge c_off;
    edge end_.end when false;
end
"""
    )


_OVERFLOW = "plant P: controllable up; disc int[0..3] n; location: initial; marked; edge up do n := n + 1; end\n"


def test_a_guard_keeps_what_it_is_copied_to_in_its_range(tmp_path: Path) -> None:
    """An update outside the range is an error in CIF's other tools; a PLC continues."""
    path = tmp_path / "overflow.cif"
    path.write_text(_OVERFLOW)
    told = CliRunner().invoke(main, ["synthesize", str(path)]).stdout
    assert "P.up\n    guard: P.n + 1 <= 3\n" in told
    assert "`range of n: edge up do n := n + 1` (line 1)\n    restricts the robot in 1 state\n" in told
    answer = json.loads(CliRunner().invoke(main, ["synthesize", str(path), "--json"]).stdout)
    assert [event["guard"] for event in answer["events"]] == ["P.n + 1 <= 3"]
    CliRunner().invoke(main, ["transform", str(path), "--to", "cif", "-o", str(tmp_path)])
    assert "edge P.up when P.n + 1 <= 3;" in (tmp_path / "overflow.supervised.cif").read_text()
    explained = CliRunner().invoke(main, ["explain", str(path), "--event", "P.up", "--state", "P.n=3"]).stdout
    assert "range of n: edge up do n := n + 1" in explained


def test_a_range_that_the_text_keeps_is_no_restriction(tmp_path: Path) -> None:
    path = tmp_path / "guarded.cif"
    path.write_text(_OVERFLOW.replace("edge up", "edge up when n < 3"))
    told = CliRunner().invoke(main, ["synthesize", str(path)]).stdout
    assert "guard: true" in told
    assert "range" not in told
    CliRunner().invoke(main, ["transform", str(path), "--to", "cif", "-o", str(tmp_path)])
    assert "edge P.up;" in (tmp_path / "guarded.supervised.cif").read_text()


@pytest.mark.parametrize(
    ("update", "guard"),
    [
        ("x := x - 1", "P.x >= 1"),
        ("x := 2 - y", "2 >= P.y"),
        ("x := Q.z", "Q.z <= 3"),
        ("x := (x + Q.z) mod 7", "(P.x + Q.z) mod 7 <= 3"),
        ("y := x + Q.z - 4", "P.x + Q.z >= 4 and P.x + Q.z <= 9"),
        ("x := x - 1, y := y + 1", "P.x >= 1 and P.y + 1 <= 5"),
    ],
)
def test_what_is_subtracted_is_on_the_other_side(update: str, guard: str, tmp_path: Path) -> None:
    """CIF's synthesis and its controller check support `-` in assignments only."""
    path = tmp_path / "ranges.cif"
    path.write_text(
        f"plant P: controllable c; disc int[0..3] x in any; disc int[0..5] y in any; location: initial; marked; "
        f"edge c do {update}; end plant Q: controllable z_; disc int[0..9] z; location: initial; marked; "
        "edge P.c do z := if z = 9: 0 else z + 1 end; end"
    )
    CliRunner().invoke(main, ["transform", str(path), "--to", "cif", "-o", str(tmp_path)])
    assert f"edge P.c when {guard};" in (tmp_path / "ranges.supervised.cif").read_text()


def test_a_remainder_is_an_operator_in_the_written_guard(tmp_path: Path) -> None:
    path = tmp_path / "remainder.cif"
    text = _OVERFLOW.replace("n + 1", "(n mod 3 + 1) mod 5 + n div 2")
    path.write_text(text)
    CliRunner().invoke(main, ["transform", str(path), "--to", "cif", "-o", str(tmp_path)])
    written = tmp_path / "remainder.supervised.cif"
    assert "edge P.up when (P.n mod 3 + 1) mod 5 + P.n div 2 <= 3;" in written.read_text()
    assert CliRunner().invoke(main, ["check", str(written)]).exit_code == 0


def test_edges_that_leave_a_range_exclude_each_other_without_it(tmp_path: Path) -> None:
    """CIF's synthesis compares the guards only, too."""
    path = tmp_path / "both.cif"
    path.write_text(_OVERFLOW.replace("; end", "; edge up when n = 3 do n := 0; end"))
    result = CliRunner().invoke(main, ["synthesize", str(path)])
    assert result.exit_code == 1
    assert "[nondeterminism]" in result.output


def test_the_written_specification_imports_its_own_from_where_it_is(specification: str, tmp_path: Path) -> None:
    folder = tmp_path / "build" / "motor"
    assert CliRunner().invoke(main, ["transform", specification, "--to", "cif", "-o", str(folder)]).exit_code == 0
    written = folder / "motor.supervised.cif"
    assert 'import "../../motor.cif";' in written.read_text()
    checked = CliRunner().invoke(main, ["check", str(written)])
    assert (checked.exit_code, checked.output) == (0, "")


def test_one_model_that_the_tool_fails_at_does_not_hide_the_others(
    specification: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    failing, wrong = tmp_path / "failing.cif", tmp_path / "wrong.cif"
    failing.write_text(_TEXT)
    wrong.write_text(_TEXT.replace("u_fail when", "u_fial when"))
    checking = importlib.import_module("robosc.tools.cli.check")
    own = checking.read

    def read(path: str, *others: object) -> object:
        if path == str(failing):
            raise KeyError("a fault of the tool")
        return own(path, *others)

    monkeypatch.setattr(checking, "read", read)
    result = CliRunner().invoke(main, ["check", specification, str(failing), str(wrong)])
    assert result.exit_code == 70
    assert "there is no `u_fial` here" in result.output
    assert "internal error of robosc, please report it: KeyError" in result.output


def test_a_saved_model_is_the_same(specification: str, tmp_path: Path) -> None:
    assert CliRunner().invoke(main, ["transform", specification, "--to", "xmi", "-o", str(tmp_path)]).exit_code == 0
    again = CliRunner().invoke(main, ["synthesize", str(tmp_path / "motor.sct.xmi"), "--json"])
    assert json.loads(again.stdout)["controlled_states"] == 14


def test_names_are_those_of_the_specification(tmp_path: Path) -> None:
    path = tmp_path / "nested.cif"
    path.write_text(
        "group a: group b: controllable c, d; enum E = x, y; plant P: disc E e; location l: initial; marked e = y; "
        "edge c do e := if e = x: y else x end; edge d when e = y goto m; location m; end end end"
    )
    shown = CliRunner().invoke(main, ["synthesize", str(path), "--json"])
    assert [event["name"] for event in json.loads(shown.stdout)["events"]] == ["a.b.c", "a.b.d"]
    CliRunner().invoke(main, ["transform", str(path), "--to", "cif", "-o", str(tmp_path)])
    assert "edge a.b.d when false;" in (tmp_path / "nested.supervised.cif").read_text()


@pytest.mark.build
def test_verify_proves_what_it_says_of_robots(specification: str) -> None:
    result = CliRunner().invoke(main, ["verify", specification, "--json"])
    assert result.exit_code == 0, result.output
    verdicts = {verdict["property"]: verdict["outcome"] for verdict in json.loads(result.stdout)["properties"]}
    assert verdicts == {
        "non-blocking": "proved",
        "controllability": "proved",
        "requirement c_on needs Motor.n != 2 (line 14)": "proved",
        "ranges": "proved",
        "maximal permissiveness": "proved",
        "model-translation": "skipped",
        "c-translation": "proved",
        "cif-translation": "proved",
    }


def test_simulate_plays_events(specification: str, tmp_path: Path) -> None:
    script = tmp_path / "script.txt"
    script.write_text('c_on\nu_fail\npressed {"value": true}\nu_fail\nc_off\nc_on\nc_off\nc_on\n')
    result = CliRunner().invoke(main, ["simulate", specification, "--script", str(script)])
    assert result.exit_code == 0, result.output
    answers = [json.loads(line) for line in result.stdout.splitlines()]
    assert [answer["by"] for answer in answers] == [None, "plant", None, None, None, None, None, None]
    assert answers[-1]["state"]["Motor.n"] == 2
    drawn = CliRunner().invoke(main, ["simulate", specification, "--random", "20"])
    assert len(drawn.stdout.splitlines()) == 20


def test_of_several_initial_states_the_first_that_is_good_is_taken(tmp_path: Path) -> None:
    path = tmp_path / "motor.cif"
    path.write_text(
        _TEXT.replace("int[0..3] n", "int[0..3] n in {3, 2, 1}") + "requirement Motor.n < 3; initial Motor.n > 1;"
    )
    result = CliRunner().invoke(main, ["simulate", str(path)], input="s\n")
    assert "Motor.n = 2\n" in result.output


_STEPS = """#include "motor_supervisor.h"
#include <stdio.h>
int main(void)
{
    motor_supervisor motor;
    motor_init(&motor);
    printf("%d", motor_perform(&motor, motor_specification_u_fail));
    printf("%d", motor_perform(&motor, motor_specification_c_on));
    motor.inputs.specification_pressed = true;
    printf("%d", motor_perform(&motor, motor_specification_pressed));
    printf("%d", motor_enabled(&motor, motor_specification_u_fail));
    printf("%d", motor_enabled(&motor, motor_specification_c_on));
    printf(" %s %d\\n", motor_event_name(motor_specification_c_on), motor.state.Motor_n);
    return 0;
}
"""


@pytest.mark.build
def test_the_supervisor_in_c_goes_step_by_step(specification: str, tmp_path: Path) -> None:
    result = CliRunner().invoke(main, ["transform", specification, "--to", "supervisor", "-o", str(tmp_path)])
    assert result.exit_code == 0, result.output
    folder = tmp_path / "supervisor"
    (folder / "main.c").write_text(_STEPS)
    compiler = ["gcc", "-std=c99", *STRICT, "main.c", "motor_supervisor.c", "-o", "motor"]
    subprocess.run(compiler, cwd=folder, check=True)
    done = subprocess.run([folder / "motor"], check=True, capture_output=True, text=True)
    assert done.stdout == "01110 c_on 1\n"
    # The code has no control loop and none of its settings.
    header = (folder / "motor_supervisor.h").read_text()
    assert not re.search("tick|hooks|settings|batch|robot that", header)


@pytest.mark.parametrize(
    "command", [["simulate", "--loop", "--script", "-"], ["run", "--ros2"], ["transform", "--to", "supervisor,ros2"]]
)
def test_what_needs_ros_or_a_control_loop_does_not_take_it(command: list[str], specification: str) -> None:
    result = CliRunner().invoke(main, [command[0], specification, *command[1:]])
    assert result.exit_code == 2
    assert "is CIF, which has no ROS graph and no control loop" in result.output


@pytest.mark.parametrize("command", [["simulate", "--random", "1"], ["verify"], ["transform", "--to", "supervisor"]])
def test_what_runs_a_supervisor_learns_too_late_what_an_input_is(command: list[str], tmp_path: Path) -> None:
    path = tmp_path / "input.cif"
    path.write_text("input bool x; plant invariant x; controllable c; plant p: location: initial; marked; edge c; end")
    output = ["--output", str(tmp_path / "out")] if command[0] == "transform" else []
    result = CliRunner().invoke(main, [*command, str(path), *output])
    assert result.exit_code == 1
    assert "input.cif:1:12: error: `x` depends on its data" in result.output
    assert not (tmp_path / "out").exists()


def test_synthesize_counts_without_guards(specification: str) -> None:
    result = CliRunner().invoke(main, ["synthesize", specification, "--counts", "--json"])
    assert result.exit_code == 0
    answer, whole = (
        json.loads(CliRunner().invoke(main, ["synthesize", specification, *option, "--json"]).output)
        for option in (["--counts"], [])
    )
    assert answer["controlled_states"] == whole["controlled_states"] > 0
    assert answer["uncontrolled_states"] is None
    assert "events" not in answer
    said = CliRunner().invoke(main, ["synthesize", specification, "--counts"]).output
    assert said == f"{answer['robot']}: {answer['controlled_states']} states\n"


def test_no_supervisor_where_each_initial_state_is_lost_in_its_own_way(tmp_path: Path) -> None:
    """One initial state is stuck itself; the other reaches it by an uncontrollable event."""
    path = tmp_path / "lost.cif"
    path.write_text(
        "uncontrollable u; plant P: location stuck: initial; location on: initial; marked; edge u goto stuck; end"
    )
    result = CliRunner().invoke(main, ["synthesize", str(path)])
    assert result.exit_code == 3
    assert "the supervisor is empty" in result.output
    assert "`u`" in result.output


@pytest.mark.parametrize(
    ("text", "states"),
    [
        ("controllable c; plant p: disc int[0..5] x in {1, 3}; location: initial; marked; end", 2),
        ("plant p: disc bool b in any; location c: initial b; marked; location d: initial not b; marked; end", 2),
    ],
)
def test_a_specification_may_have_no_event_that_happens(text: str, states: int, tmp_path: Path) -> None:
    path = tmp_path / "still.cif"
    path.write_text(text)
    result = CliRunner().invoke(main, ["transform", str(path), "--to", "cif,supervisor,xmi", "-o", str(tmp_path)])
    assert result.exit_code == 0, result.output
    made = (tmp_path / "still.supervised.cif").read_text()
    assert made.startswith(f'@@doc("still under its supervisor: {states} states.")\nimport "still.cif";\n')
