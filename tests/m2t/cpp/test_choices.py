"""Provided data that chooses between objects and arrays, in generated nodes."""

from __future__ import annotations

import re
import shutil
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import robosc
from robosc.language.configuration import Configuration
from robosc.model import rosgraph
from robosc.model.validity import load
from tests.m2t.conftest import models
from tests.m2t.cpp.test_headers import run

if TYPE_CHECKING:
    from collections.abc import Callable

FUNCTIONS = Path(__file__).parent / "chooser.inc"


@pytest.fixture(scope="module")
def chooser() -> robosc.Models:
    return models("chooser")


def prepared(files: dict[str, str]) -> str:
    """Return the functions of a node that prepare its messages."""
    (node,) = (text for path, text in files.items() if path.endswith("_node.cpp"))
    return "\n".join(
        re.findall(r"^  (?:bool prepare|void limit)_\w+\([^\n]*\) \{\n.*?^  \}\n", node, re.DOTALL | re.MULTILINE)
    )


def test_a_field_is_set_under_the_condition_of_its_branch(
    chooser: robosc.Models, golden: Callable[[Path, str], None]
) -> None:
    golden(FUNCTIONS, prepared(robosc.generate("ros2", chooser, Configuration())))


def test_a_saved_model_gives_the_same_node(chooser: robosc.Models, tmp_path: Path) -> None:
    written = robosc.generate("xmi", chooser, Configuration())
    for name, text in written.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    (graph,) = (name for name in written if name.endswith(".rosgraph.xmi"))
    saved = load(tmp_path / graph)
    assert isinstance(saved, rosgraph.RosGraph)
    node = robosc.generate("ros2", robosc.Models(saved.model, saved), Configuration())
    assert prepared(node) == FUNCTIONS.read_text(encoding="utf-8")


@pytest.mark.build
def test_a_compiled_node_sends_the_chosen_data(chooser: robosc.Models, tmp_path: Path) -> None:
    if shutil.which("g++") is None:
        pytest.skip("no g++")
    files = robosc.generate("ros2", chooser, Configuration())
    (header,) = (text for path, text in files.items() if path.endswith("chooser_supervisor.h"))
    assert run(
        "g++", "choices.cpp", "address,undefined", {**files, "include/chooser_supervisor.h": header}, tmp_path
    ) == (
        0,
        "",
        "",
    )
