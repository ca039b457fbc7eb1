"""Loads the templates of a target, or what a user put in their place."""

from __future__ import annotations

import sys
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from jinja2 import BaseLoader, ChoiceLoader, Environment, FileSystemBytecodeCache, FileSystemLoader, StrictUndefined

from robosc.files.resources import locate

if TYPE_CHECKING:
    from jinja2.bccache import Bucket


class _Compiled(FileSystemBytecodeCache):
    """Keeps compiled templates as Python keeps its modules: in `__pycache__` beside them, if that can be written."""

    def dump_bytecode(self, bucket: Bucket) -> None:
        if not sys.dont_write_bytecode:
            with suppress(OSError):
                Path(self.directory).mkdir(exist_ok=True)
                super().dump_bytecode(bucket)


@cache
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
        bytecode_cache=_Compiled(str(folder / "__pycache__")),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,  # noqa: S701  # C, CMake and Python are no HTML.
    )
