"""Seed faults into the product: compile a function or class of a module again from a changed text."""

from __future__ import annotations

import sys
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pytest


def seed(monkeypatch: pytest.MonkeyPatch, name: str, before: str, after: str) -> None:
    """Replace `before` in the text of a module of `robosc`, and its definitions in all modules that import them.

    Raises AssertionError unless the text occurs exactly once.
    """
    module = import_module(f"robosc.{name}")
    assert module.__file__ is not None
    text = Path(module.__file__).read_text(encoding="utf-8")
    assert text.count(before) == 1, f"{before!r} is {text.count(before)} times in {module.__name__}"
    changed = {**vars(module)}
    exec(compile(text.replace(before, after), module.__file__, "exec"), changed)  # noqa: S102 - the product's own text
    own = {
        id(value): changed[key]
        for key, value in vars(module).items()
        if getattr(value, "__module__", None) == module.__name__ and hasattr(value, "__qualname__")
    }
    for user in [imported for key, imported in sys.modules.items() if key.partition(".")[0] == "robosc"]:
        for key, value in list(vars(user).items()):
            if id(value) in own:
                monkeypatch.setattr(user, key, own[id(value)])
