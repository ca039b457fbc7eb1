"""Counts of the literature, for robots and for CIF.

Small factory, transfer line and guided vehicles: W. M. Wonham, "Supervisory Control of Discrete-Event Systems". Cat and
mouse: P. J. Ramadge and W. M. Wonham, "The control of discrete event systems", Proceedings of the IEEE 77 (1989).
"""

from pathlib import Path

import pytest

import robosc
from robosc.language.cif import read
from robosc.synthesis import synthesize

_MODELS = Path(__file__).parents[2] / "docs" / "supervisory-control"
_COUNTS = {"small_factory": 12, "transfer_line": 28, "cat_and_mouse": 6, "agv": 4406}


@pytest.mark.parametrize(("name", "states"), _COUNTS.items())
def test_a_robot_has_the_published_count(name: str, states: int) -> None:
    robot = robosc.load(_MODELS / f"{name}.rscd")
    assert robosc.check(robot) == []
    assert synthesize(robosc.to_sct(robot)).controlled_states == states


@pytest.mark.parametrize(("name", "states"), _COUNTS.items())
def test_its_cif_has_the_published_count(name: str, states: int) -> None:
    reading = read(_MODELS / f"{name}.cif")
    assert reading.findings == []
    assert reading.model is not None
    assert synthesize(reading.model).controlled_states == states


def test_every_model_has_a_count() -> None:
    assert {path.stem for path in _MODELS.iterdir()} == set(_COUNTS)
