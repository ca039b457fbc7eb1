"""The configuration of a guard."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robosc.tools.starter.guard.choices import GuardChoices


def configuration(choices: GuardChoices) -> str:
    """Return the text of `controller-config.json`: the messages in place of blocked ones, and the package."""
    settings = {
        "onBlocked": [command.word for command in choices.stopping],
        "onShutdown": [],
        "package": {
            "name": choices.package,
            "version": "0.1.0",
            "description": f"Supervisory layer in front of {choices.robot}.",
        },
    }
    return json.dumps(settings, indent=2) + "\n"
