"""A small, complete first model of a robot: its text, configuration, page and test."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.tools.starter.choices import Choices
from robosc.tools.starter.configuration import configuration
from robosc.tools.starter.model import model
from robosc.tools.starter.page import page
from robosc.tools.starter.trial import trial

if TYPE_CHECKING:
    from collections.abc import Mapping

__all__ = ["Choices", "files"]


def files(choices: Choices) -> Mapping[str, str]:
    """Return the files of a folder for a robot, by their names; `robosc format` does the layout of the model."""
    return {
        f"{choices.stem}.rscd": model(choices),
        "controller-config.json": configuration(choices),
        "README.md": page(choices),
        f"test_{choices.stem}.py": trial(choices),
    }
