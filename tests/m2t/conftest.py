"""The courier: a robot with every kind of data."""

from __future__ import annotations

from pathlib import Path

import pytest

import robosc
from robosc import config

HERE = Path(__file__).parent / "cpp"


@pytest.fixture(scope="session")
def courier() -> robosc.Models:
    robot = robosc.load(HERE / "courier.rscd")
    assert robosc.check(robot) == []
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    return robosc.Models(model, robosc.to_rosgraph(robot), robot)


@pytest.fixture(scope="session")
def settings() -> config.Configuration:
    return config.read(HERE / "controller-config.json")
