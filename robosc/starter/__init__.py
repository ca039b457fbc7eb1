"""A first model of a robot, small and whole: its text, configuration, page and test."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.starter.choices import Choices
from robosc.starter.configuration import configuration
from robosc.starter.model import model
from robosc.starter.page import page
from robosc.starter.trial import trial

if TYPE_CHECKING:
    from collections.abc import Mapping

__all__ = ["Choices", "files"]


def files(choices: Choices) -> Mapping[str, str]:
    """The files of a folder for a robot, by their names; the layout of the model is left to `robosc format`."""
    return {
        f"{choices.stem}.rscd": model(choices),
        "controller-config.json": configuration(choices),
        "README.md": page(choices),
        f"test_{choices.stem}.py": trial(choices),
    }
