"""The models of one robot that uses the whole language."""

from pathlib import Path
from typing import Any

import pytest

from robosc.language.reading import read
from robosc.m2m import robosc_to_rosgraph, robosc_to_sct
from robosc.model import robosc
from robosc.model.xmi import to_texts


@pytest.fixture(scope="session")
def roots() -> dict[str, Any]:
    """Return all models of the robot that belong together, by the paths of their files."""
    reading = read(Path(__file__).with_name("warehouse.rscd"))
    assert reading.findings == []
    robot = reading.base
    model, trace = robosc_to_sct.transform(robot)
    libraries = [
        definition.type.library
        for definition in robot.definitions
        if isinstance(definition, robosc.Component) and isinstance(definition.type, robosc.ImportedComponent)
    ]
    return {
        "Warehouse.robosc.xmi": robot,
        "Warehouse.sct.xmi": model,
        "Warehouse.rosgraph.xmi": robosc_to_rosgraph.transform(trace),
    } | {f"{library.name}.robosc.xmi": library for library in libraries}


@pytest.fixture(scope="session")
def texts(roots: dict[str, Any]) -> dict[str, str]:
    return to_texts(roots)


@pytest.fixture
def folder(tmp_path: Path, texts: dict[str, str]) -> Path:
    """Return a folder with the saved models."""
    for name, text in texts.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path
