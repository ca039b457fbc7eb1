"""`--param NAME=VALUE`: parameters of the robot, in a simulation."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from robosc.tools.cli import main

CRUISE = Path(__file__).parents[2] / "run" / "runtime" / "cruise.rscd"


def played(*options: str) -> Result:
    script = 'message_range.u_response {"value": 0.7}\n'
    return CliRunner().invoke(main, ["simulate", str(CRUISE), *options, "--script", "-"], input=script)


@pytest.mark.parametrize(("given", "state"), [([], "clear"), (["--param", "reach=1"], "blocked")])
def test_data_is_read_with_what_is_set(given: list[str], state: str) -> None:
    answer = played(*given)
    assert answer.exit_code == 0, answer.output
    assert json.loads(answer.stdout)["state"]["component_Lidar"] == state


@pytest.mark.parametrize(("given", "state"), [([], "dark"), (["--param", "Lamp.pause=0.5"], "lit")])
def test_a_time_is_what_is_set(given: list[str], state: str) -> None:
    """`--param` of `simulate` also sets durations."""
    call = ["simulate", str(CRUISE), "--loop", *given, "--script", "-"]
    answer = CliRunner().invoke(main, call, input="wait 1.0\n")
    assert answer.exit_code == 0, answer.output
    assert json.loads(answer.stdout)["state"]["component_Lamp"] == state


REFUSED = [
    ("reech=1", "--param reech=1: the model has no parameter reech; did you mean `reach`?"),
    ("zzz=1", "--param zzz=1: the model has no parameter zzz"),
    ("reach", "--param reach: write reach=VALUE, such as reach=0.5"),
    ("reach=far", "--param reach=far: write reach=VALUE, such as reach=0.5"),
    ("reach=NaN", "--param reach=NaN: write reach=VALUE, such as reach=0.5"),
    ("least=9", "--param least=9: least is 9, not between 1 and 5"),
    ("doubled=1", "--param doubled=1: doubled is 1, not true or false"),
]


@pytest.mark.parametrize(("given", "why"), REFUSED)
def test_what_does_not_fit_is_a_wrong_call(given: str, why: str) -> None:
    answer = played("--param", given)
    assert answer.exit_code == 2
    assert why in answer.output


def test_a_text_may_hold_anything() -> None:
    assert played("--param", 'greeting=a "b" = c').exit_code == 0
