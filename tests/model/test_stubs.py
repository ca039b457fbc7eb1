"""The type stubs of the metamodels match the .ecore files."""

from pathlib import Path

import pytest

import robosc.model
from robosc.model._ecore import PACKAGES
from scripts.metamodel_stubs import stub


@pytest.mark.parametrize("name", PACKAGES)
def test_stubs_are_up_to_date(name: str) -> None:
    written = Path(robosc.model.__file__).with_name(f"{name}.pyi").read_text(encoding="utf-8")
    assert written == stub(name), "python scripts/metamodel_stubs.py writes it anew"
