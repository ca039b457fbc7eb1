"""The pages contain no misspelling that codespell knows."""

from __future__ import annotations

import subprocess
import sys

import pytest

from tests.docs.pages import PAGES, ROOT


def misspelled(*paths: object) -> str:
    command = [sys.executable, "-m", "codespell_lib", "--disable-colors", *map(str, paths)]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False).stdout


def test_nothing_is_misspelled() -> None:
    pytest.importorskip("codespell_lib", reason="the packages of [docs] are not installed")
    assert misspelled(*PAGES) == ""


def test_what_is_misspelled_is_found(tmp_path) -> None:
    pytest.importorskip("codespell_lib", reason="the packages of [docs] are not installed")
    page = tmp_path / "page.md"
    page.write_text("The robot recieves a mesage.\n")
    assert misspelled(page).count("==>") == 2
