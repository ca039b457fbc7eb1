"""Loads the templates of a package, or a user's replacements."""

from __future__ import annotations

import sys
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from jinja2 import Environment, FileSystemBytecodeCache, FileSystemLoader, StrictUndefined

from robosc.base.files.resources import locate

if TYPE_CHECKING:
    from jinja2.bccache import Bucket


class _Compiled(FileSystemBytecodeCache):
    """Caches compiled templates like Python modules: in a `__pycache__` beside them, if that is writable."""

    def dump_bytecode(self, bucket: Bucket) -> None:
        if not sys.dont_write_bytecode:
            with suppress(OSError):
                Path(self.directory).mkdir(exist_ok=True)
                super().dump_bytecode(bucket)


@cache
def environment(*packages: str, overrides: Path | None = None, escapes: bool = False) -> Environment:
    """Return an environment for the `templates` folders of packages, such as `robosc.m2t.cif`; the first folder wins.

    A template of the same name in the folder `overrides` replaces ours. An undefined name in a template is an error.
    Texts of a model are made safe beforehand for their place, unless `escapes` marks the templates as HTML or XML.
    """
    folders = [locate("/".join([*package.split(".")[1:], "templates"])) for package in packages]
    return Environment(
        loader=FileSystemLoader([*([overrides] if overrides else []), *folders]),
        bytecode_cache=_Compiled(str(folders[0] / "__pycache__")),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=escapes,  # noqa: S701  # C, CMake and Python need no HTML escapes.
    )
