"""Loads the templates of a package, or what a user put in their place."""

from __future__ import annotations

import sys
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from jinja2 import Environment, FileSystemBytecodeCache, FileSystemLoader, StrictUndefined

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
def environment(*packages: str, overrides: Path | None = None, escapes: bool = False) -> Environment:
    """What is in the folders `templates` of packages, such as `robosc.m2t.cif`: of templates of one name the first.

    A template of the same name in the folder `overrides` takes the place of ours. A name that a template reads and
    nobody prepared is an error. What comes from a model is made safe beforehand for where it stands, unless `escapes`
    says that the templates are HTML or XML.
    """
    folders = [locate("/".join([*package.split(".")[1:], "templates"])) for package in packages]
    return Environment(
        loader=FileSystemLoader([*([overrides] if overrides else []), *folders]),
        bytecode_cache=_Compiled(str(folders[0] / "__pycache__")),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=escapes,  # noqa: S701  # C, CMake and Python are no HTML.
    )
