"""Target `supervisor`: the engine in C99 as a static library, for robots with and without ROS."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.base.files.templates import environment
from robosc.m2t.c import engine
from robosc.m2t.c import preconditions as c_preconditions
from robosc.m2t.c.names import CNames

if TYPE_CHECKING:
    from robosc.base.diagnostics import Diagnostic
    from robosc.language.configuration import Configuration
    from robosc.m2t.models import Models


def preconditions(models: Models, configuration: Configuration) -> list[Diagnostic]:  # noqa: ARG001
    """Return errors on computations that need more than 64 bits."""
    return c_preconditions.preconditions(models.sct)


def generate(models: Models, configuration: Configuration, into: str | None = None) -> dict[str, str]:
    """Return header, source and `CMakeLists.txt` of a model with its supervisor: relative path to text.

    `into` names a CMake target, which a `fragment.cmake` creates in place of the `CMakeLists.txt`.
    """
    names = CNames(models.sct)
    build = "CMakeLists.txt" if into is None else "fragment.cmake"
    template = environment("robosc.m2t.supervisor").get_template(f"{build}.j2")
    return {
        **engine.generate(models.engine, configuration.control_loop),
        build: template.render(p=names.prefix, u=names.macro, version=configuration.package.version, into=into),
    }
