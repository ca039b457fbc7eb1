"""The setup in docs/editor.md for Neovim, Emacs and Helix works in these editors, if they are installed."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from tests.tools.editor.server import LIBRARY, ROBOT, ROOT

PAGE = (ROOT / "docs" / "editor.md").read_text()
#: The timeout of the editors in seconds, sufficient for a busy machine.
LONGEST = 120
SAID = "component `Door` has no variable or state `opem`"


def recipe(language: str, nth: int = 0) -> str:
    return re.findall(rf"```{language}\n(.*?)```", PAGE, re.DOTALL)[nth]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a robot with an error in a folder that editors recognize as a project, with `robosc` on their path."""
    (tmp_path / "controller-config.json").write_text("{}")
    (tmp_path / "wheels.rscd").write_text(LIBRARY)
    (tmp_path / "cart.rscd").write_text(ROBOT.replace("Door.open", "Door.opem"))
    programs = tmp_path / "bin"
    programs.mkdir()
    (programs / "robosc").write_text(f'#!/bin/sh\nexec "{sys.executable}" -m robosc "$@"\n')
    (programs / "robosc").chmod(0o755)
    return tmp_path


def run(folder: Path, *words: str | Path) -> str:
    environment = {
        **os.environ,
        "HOME": str(folder),
        "PATH": f"{folder / 'bin'}{os.pathsep}{os.environ['PATH']}",
        "PYTHONPATH": str(ROOT),
        **{name: str(folder / name) for name in ("XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_STATE_HOME")},
    }
    done = subprocess.run(
        words, check=False, cwd=folder, env=environment, capture_output=True, text=True, timeout=2 * LONGEST
    )
    return done.stdout + done.stderr


def neovim(version: tuple[int, int]) -> str:
    """Return a Neovim of at least a version, from the tests' packages or the system.

    If the version is below 0.11, so is the Neovim.
    """
    own = shutil.which("nvim", path=str(Path(sys.executable).parent))
    program = own if version >= (0, 11) and own else shutil.which("nvim", path=os.defpath)
    if program is None:
        pytest.skip("there is no Neovim here")
    said = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
    found = tuple(int(part) for part in re.search(r"v(\d+)\.(\d+)", said).groups())
    if (found >= (0, 11)) is not (version >= (0, 11)) or found < version:
        pytest.skip(f"this Neovim is {found[0]}.{found[1]}")
    return program


@pytest.mark.slow
@pytest.mark.parametrize(("nth", "version"), [(0, (0, 11)), (1, (0, 7))], ids=["0.11", "0.7"])
def test_neovim(folder: Path, nth: int, version: tuple[int, int]) -> None:
    program = neovim(version)
    (folder / "init.lua").write_text(recipe("lua", nth))
    look = (
        f"vim.wait({LONGEST * 1000}, function() return #vim.diagnostic.get(0) > 0 end, 50)"
        " for _, found in ipairs(vim.diagnostic.get(0)) do print(found.message) end"
        ' print("comments: " .. vim.bo.commentstring)'
    )
    said = run(folder, program, "--headless", "-u", "init.lua", "cart.rscd", "-c", f"lua {look}", "-c", "qa!")
    assert SAID in said
    assert "comments: // %s" in said


def test_emacs(folder: Path) -> None:
    if shutil.which("emacs") is None:
        pytest.skip("there is no Emacs here")
    known = run(folder, "emacs", "--batch", "--eval", '(progn (package-initialize) (princ (locate-library "eglot")))')
    if "eglot" not in known.replace('locate-library "eglot"', ""):
        pytest.skip("this Emacs has no eglot")
    (folder / "init.el").write_text(f"(package-initialize)\n(require 'eglot)\n{recipe('elisp')}")
    look = f"""(progn
      (find-file "cart.rscd")
      (call-interactively 'eglot)
      (let ((end (+ (float-time) {LONGEST})))
        (while (and (< (float-time) end) (not (flymake-diagnostics)))
          (accept-process-output nil 0.05)
          (flymake-start)))
      (dolist (found (flymake-diagnostics)) (princ (flymake-diagnostic-text found))))"""
    assert SAID in run(folder, "emacs", "--batch", "--load", "init.el", "--eval", look)


def test_helix() -> None:
    """The tests' packages have no Helix: its configuration must have the server's command line."""
    told = tomllib.loads(recipe("toml"))
    server = told["language-server"]["robosc"]
    assert [server["command"], *server["args"]] == ["robosc", "lsp"]
    (language,) = told["language"]
    assert (language["file-types"], language["language-servers"]) == (["rscd"], ["robosc"])
    scope = (ROOT / "editors" / "vscode" / "syntaxes" / "robosc.tmLanguage.json").read_text()
    assert f'"scopeName": "{language["scope"]}"' in scope
