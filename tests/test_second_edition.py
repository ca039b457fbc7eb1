"""Each sentence on the language's second edition has a test: `second_edition.md` names them, and they are there."""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path

import pytest

TESTS = Path(__file__).parent
_PAGE = (TESTS / "second_edition.md").read_text(encoding="utf-8")
#: A sentence, and the lines that name its tests.
SENTENCES = re.findall(r"^> (.+)\n\n((?:- .+\n)+)", _PAGE, flags=re.MULTILINE)


@cache
def functions(file: Path) -> set[str]:
    tree = ast.parse(file.read_text(encoding="utf-8"))
    return {part.name for part in tree.body if isinstance(part, ast.FunctionDef)}


def test_each_has_tests() -> None:
    assert len(SENTENCES) == len(re.findall(r"^> ", _PAGE, flags=re.MULTILINE)) > 100
    assert len({sentence for sentence, _ in SENTENCES}) == len(SENTENCES)


@pytest.mark.parametrize("named", sorted(set(re.findall(r"^- (.+)$", _PAGE, flags=re.MULTILINE))))
def test_what_it_names_is_there(named: str) -> None:
    file, _, function = named.partition("::")
    assert (TESTS / file).is_file()
    if function:
        assert function.startswith("test_")
        assert function in functions(TESTS / file)
    else:
        # A model is read by the tests of its folder, which know its findings by its first line or by its place.
        assert file.endswith(".rscd")
