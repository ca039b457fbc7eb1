"""Issue 13: commands that take a `.cif` file, and those that do not yet."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from robosc.cli import main

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

@doc("What synthesis added.")
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


@pytest.mark.parametrize(
    "command", [["verify"], ["simulate", "--random", "3"], ["run", "--ros2"], ["transform", "--to", "supervisor,cif"]]
)
def test_other_commands_say_that_they_do_not_take_it(command: list[str], specification: str) -> None:
    result = CliRunner().invoke(main, [command[0], specification, *command[1:]])
    assert result.exit_code == 2
    assert "is CIF: so far" in result.output


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
