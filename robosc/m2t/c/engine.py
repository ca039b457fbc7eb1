"""Writes the engine: a header and a source file in C99 (and C++17), with state, guards, events and control loop."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.m2t.c.behaviour import Behaviour
from robosc.m2t.c.context import Context
from robosc.m2t.c.declarations import Declarations
from robosc.m2t.templates import environment

if TYPE_CHECKING:
    from pathlib import Path

    from robosc.config import ControlLoop
    from robosc.metamodel import sct


def generate(
    model: sct.SupervisoryControlModel, settings: ControlLoop, templates: Path | None = None
) -> dict[str, str]:
    """The files `P_supervisor.h` and `P_supervisor.c` of a model with its supervisor.

    `settings` become the default settings. The preconditions of `robosc.m2t.c.preconditions` must hold.
    """
    context = Context(model)
    names = context.names
    prepared = {
        "p": names.prefix,
        "u": names.macro,
        "settings": settings,
        **Declarations(context).prepared(),
        **Behaviour(context).prepared(),
    }
    loaded = environment("robosc.m2t.c", templates)
    return {
        f"{names.prefix}_supervisor.{kind}": loaded.get_template(f"supervisor.{kind}.j2").render(prepared)
        for kind in ("h", "c")
    }
