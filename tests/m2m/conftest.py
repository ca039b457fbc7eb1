"""Robot models that tests define as text."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from robosc.language.reading import read
from robosc.m2m import robosc_to_sct
from robosc.model import sct

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from robosc.m2m.trace import Trace
    from robosc.model import robosc

Transformed = tuple[sct.SupervisoryControlModel, "Trace"]


@pytest.fixture
def robot(tmp_path: Path) -> Callable[..., robosc.Robot]:
    """Return a linked robot from its text; further texts are libraries in its folder."""

    def load(text: str, **libraries: str) -> robosc.Robot:
        for name, library in libraries.items():
            (tmp_path / f"{name}.rscd").write_text(library, encoding="utf-8")
        path = tmp_path / "robot.rscd"
        path.write_text(text, encoding="utf-8")
        reading = read(path)
        assert reading.findings == []
        return reading.base

    return load


@pytest.fixture
def to_sct(robot: Callable[..., robosc.Robot]) -> Callable[..., Transformed]:
    """Return the sct model of a robot's text with its trace."""
    return lambda text, **libraries: robosc_to_sct.transform(robot(text, **libraries))
