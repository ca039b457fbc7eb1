"""The configuration of a new robot."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robosc.tools.starter.choices import Choices


def configuration(choices: Choices) -> str:
    """Return the text of `controller-config.json`: the messages to send on shutdown, and the package's description."""
    settings = {
        "controlLoop": {"periodMs": 100},
        "onShutdown": [choices.stop] if choices.stop else [],
        "package": {
            "name": choices.package,
            "version": "0.1.0",
            "description": f"Supervisory controller of {choices.robot}.",
        },
    }
    return json.dumps(settings, indent=2) + "\n"
