"""Plugin of pytest for a run with a fault in the product: `SEED` has a module, a text in it, and the text instead."""

from __future__ import annotations

import json
import os
import sys
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Sequence
    from types import CodeType, ModuleType


class _Loader(SourceFileLoader):
    def get_code(self, fullname: str) -> CodeType:
        text = Path(self.path).read_text(encoding="utf-8")
        assert text.count(_BEFORE) == 1, f"{_BEFORE!r} is {text.count(_BEFORE)} times in {fullname}"
        code: Any = compile(text.replace(_BEFORE, _AFTER), self.path, "exec")
        return code  # type: ignore[no-any-return]


class _Finder(MetaPathFinder):
    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if fullname != f"robosc.{_MODULE}":
            return None
        spec = PathFinder.find_spec(fullname, path, target)
        assert spec is not None
        assert spec.origin is not None
        spec.loader = _Loader(fullname, spec.origin)
        return spec


_MODULE, _BEFORE, _AFTER = json.loads(os.environ["SEED"])
assert f"robosc.{_MODULE}" not in sys.modules
sys.meta_path.insert(0, _Finder())
