"""A guard: the model of a supervisory layer in front of a robot, with its configuration, page and scenarios."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.tools.starter.guard.choices import GuardChoices
from robosc.tools.starter.guard.configuration import configuration
from robosc.tools.starter.guard.from_graph import Suggestion, suggestion
from robosc.tools.starter.guard.model import model
from robosc.tools.starter.guard.page import page
from robosc.tools.starter.guard.scenarios import scenarios

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robosc.base.ros_types import RosTypes

__all__ = ["GuardChoices", "Suggestion", "files", "suggestion"]


def files(choices: GuardChoices, types: RosTypes) -> Mapping[str, str]:
    """Return the files of a folder for a guard, by their names; `robosc format` does the layout of the model."""
    return {
        f"{choices.stem}.rscd": model(choices, types),
        "controller-config.json": configuration(choices),
        "README.md": page(choices),
        f"{choices.stem}.scenarios": scenarios(choices),
    }
