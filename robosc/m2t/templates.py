"""Loads the templates of a target, or what a user put in their place."""

from __future__ import annotations

from typing import TYPE_CHECKING

from jinja2 import BaseLoader, ChoiceLoader, Environment, FileSystemLoader, StrictUndefined

from robosc.resources import locate

if TYPE_CHECKING:
    from pathlib import Path


def environment(package: str, overrides: Path | None = None) -> Environment:
    """Where the templates of a target live: in the folder `templates` of its package, such as `robosc.m2t.cif`.

    A template of the same name in the folder `overrides` takes the place of ours. A name that a template reads and
    nobody prepared is an error. Nothing is escaped: what comes from a model is made safe for its target beforehand.
    """
    folder = locate("/".join([*package.split(".")[1:], "templates"]))
    loaders: list[BaseLoader] = [FileSystemLoader(folder)]
    if overrides is not None:
        loaders.insert(0, FileSystemLoader(overrides))
    return Environment(
        loader=ChoiceLoader(loaders),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,  # noqa: S701  # C, CMake and Python are no HTML.
    )
