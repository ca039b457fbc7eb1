"""The courier: a robot with every kind of data. The porter: one with every kind of communication."""

from __future__ import annotations

from pathlib import Path

import pytest

import robosc
from robosc import configuration as config

HERE = Path(__file__).parent / "cpp"


def models(name: str) -> robosc.Models:
    robot = robosc.load(HERE / f"{name}.rscd")
    assert [each for each in robosc.check(robot) if each.rule != "interface-unknown"] == []
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    return robosc.Models(model, robosc.to_rosgraph(robot), robot)


@pytest.fixture(scope="session")
def courier() -> robosc.Models:
    return models("courier")


@pytest.fixture(scope="session")
def porter() -> robosc.Models:
    return models("porter")


@pytest.fixture(scope="session")
def settings() -> config.Configuration:
    return config.read(HERE / "controller-config.json")


@pytest.fixture(scope="session")
def porter_settings() -> config.Configuration:
    return config.read(HERE / "porter-config.json")
