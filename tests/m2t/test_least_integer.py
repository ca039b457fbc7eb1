"""The least 64-bit integer, whose magnitude has no 64-bit type: written, saved, read and compiled."""

from __future__ import annotations

import re
import shutil
import subprocess
from typing import TYPE_CHECKING

import pytest

import robosc
from robosc.m2t.models import Models
from robosc.model.validity import faults, load
from robosc.run.simulation import Simulation

if TYPE_CHECKING:
    from pathlib import Path

LEAST = -(2**63)
MODEL = f"""
robot R {{
  component A {{
    outgoing message m with type: integer({LEAST}..5)
    outgoing message d with type: double
    incoming message c with type: integer
    behaviour {{
      variable n: integer({LEAST}..{LEAST + 2}) = {LEAST}
      variable k: integer = {LEAST}
      initial marked state s {{
        on response from m do n := value
        on response from d do k := {LEAST} + 1
        transition if n = {LEAST + 1} do n := {LEAST} goto t
      }}
      state t {{ on response from m do n := value goto s }}
    }}
  }}
  requirement c needs A.n > {LEAST}
  provide c with {LEAST} if A.n = {LEAST + 1}
  provide c with A.k - 1
}}
"""


@pytest.fixture
def models(tmp_path: Path) -> Models:
    """Return the models of a robot with that number in every place."""
    file = tmp_path / "r.rscd"
    file.write_text(MODEL, encoding="utf-8")
    robot = robosc.load(file)
    models = Models(robosc.to_sct(robot), robosc.to_rosgraph(robot), robot)
    robosc.synthesize(models.sct)
    return models


def test_it_is_saved_and_read(models: Models, tmp_path: Path) -> None:
    texts = robosc.generate("xmi", models)
    for name, text in texts.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    for name in texts:
        assert list(faults(load(tmp_path / name))) == []


def test_it_is_computed_with(models: Models) -> None:
    simulation = Simulation(models.sct, models.rosgraph)
    assert not simulation.perform("message_c.c_trigger").accepted
    happened = simulation.perform("message_m.u_response", {"value": LEAST + 1})
    assert happened.state["A.n"] == LEAST + 1
    assert simulation.perform("message_c.c_trigger").accepted


@pytest.mark.skipif(shutil.which("gcc") is None, reason="no C compiler")
def test_c_compiles_it(models: Models, tmp_path: Path) -> None:
    files = robosc.generate("supervisor", models)
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    sources = [tmp_path / file for file in files if file.endswith(".c")]
    options = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror", "-c"]
    subprocess.run(["gcc", *options, *sources], cwd=tmp_path, check=True)


@pytest.mark.parametrize("target", ["ros1", "ros2"])
def test_no_literal_of_cpp_is_too_large(models: Models, target: str) -> None:
    files = robosc.generate(target, models)
    node = next(text for name, text in files.items() if name.endswith("_node.cpp"))
    assert "(-9223372036854775807 - 1)" in node
    assert not re.search(r"9223372036854775808", re.sub(r"//.*|\"[^\"\n]*\"", "", node))


@pytest.mark.parametrize("value", ["9223372036854775808", "5 - 9223372036854775808", "-9223372036854775809"])
def test_nothing_else_reaches_that_far(tmp_path: Path, value: str) -> None:
    file = tmp_path / "r.rscd"
    file.write_text(MODEL.replace(f"variable k: integer = {LEAST}", f"variable k: integer = {value}"), encoding="utf-8")
    with pytest.raises(robosc.ModelError, match="an integer lies between"):
        robosc.load(file)


def test_no_saved_model_reaches_further(models: Models, tmp_path: Path) -> None:
    for name, text in robosc.generate("xmi", models).items():
        (tmp_path / name).write_text(
            text.replace('value="9223372036854775808"', 'value="9223372036854775809"'), encoding="utf-8"
        )
    with pytest.raises(robosc.ModelError, match="9223372036854775809 is not an integer of 64 bits"):
        load(tmp_path / "R.sct.xmi")
