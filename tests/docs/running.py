"""Execution of the commands of a page in a copy of the examples."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
from contextlib import chdir
from typing import TYPE_CHECKING

from click.testing import CliRunner

from robosc.tools.cli import main
from tests.docs.pages import ROOT, Block

if TYPE_CHECKING:
    from pathlib import Path

#: Commands that run until they are interrupted.
_LASTING = ("robosc run", "robosc gate", "robosc view", "robosc lsp", "robosc dap")
#: Characters with a meaning in the shell.
_SHELL = re.compile(r"[|<>;&$`*~\\\n]")


class Desk:
    """A folder with the examples, as in a clone of the repository, and the programs that pages call."""

    def __init__(self, folder: Path) -> None:
        self.root = folder / "robosc"
        self.home = folder / "home"
        self.programs = folder / "programs"
        for made in (self.root, self.home, self.programs):
            made.mkdir()
        for name in ("examples", "docs/patterns"):
            shutil.copytree(ROOT / name, self.root / name, ignore=shutil.ignore_patterns("__pycache__"))
        for name, words in {"python": "", "python3": "", "robosc": " -m robosc", "pygmentize": " -m pygments"}.items():
            program = self.programs / name
            program.write_text(f'#!/bin/sh\nexec "{sys.executable}"{words} "$@"\n')
            program.chmod(0o755)

    def place(self, block: Block) -> Path:
        """Return the folder that a block runs in or is written to; create it if necessary."""
        folder = self.root / block.marks.get("in", "")
        folder.mkdir(parents=True, exist_ok=True)
        return folder

    def write(self, block: Block) -> None:
        """Write the text of a block into the file named in its mark."""
        path = self.place(block) / block.marks["file"]
        path.parent.mkdir(parents=True, exist_ok=True)
        text = block.text
        if block.kind == "diff":
            text = changed(path.read_text(encoding="utf-8"), text)
        path.write_text(text, encoding="utf-8")

    def run(self, command: str, folder: Path) -> tuple[int, str]:
        """Return exit status and output of a command. Plain calls of robosc run in this process, others in a shell."""
        bare = command.partition("  #")[0].strip()
        if bare.startswith("robosc ") and not bare.startswith(_LASTING) and not _SHELL.search(bare):
            with chdir(folder):
                done = CliRunner().invoke(main, shlex.split(bare)[1:], catch_exceptions=False)
            return done.exit_code, done.output
        environment = {
            **{name: value for name, value in os.environ.items() if not name.startswith(("ROBOSC", "VIRTUAL"))},
            "PATH": f"{self.programs}:{os.environ['PATH']}",
            "PYTHONPATH": str(ROOT),
            "HOME": str(self.home),
        }
        ended = subprocess.run(
            ["bash", "-euo", "pipefail", "-c", command],
            cwd=folder,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=False,
            timeout=300,
        )
        return ended.returncode, ended.stdout


def changed(text: str, diff: str) -> str:
    """Apply one hunk of a diff to a text that contains its old lines exactly once."""
    old, new = (
        "".join(line[1:] for line in diff.splitlines(keepends=True) if line[0] in signs) for signs in ("- ", "+ ")
    )
    assert text.count(old) == 1, old
    return text.replace(old, new)


def commands(block: Block) -> list[tuple[str, str | None]]:
    """Return the commands of a block, each with the output on the page, or None if the page shows none."""
    if block.kind == "console":
        parts = re.split(r"^\$ ", block.text, flags=re.MULTILINE)
        assert parts[0] == "", f"{block.name}: a console begins with a prompt"
        found = [part.partition("\n") for part in parts[1:]]
        return [(command, shown) for command, _, shown in found]
    lines = re.sub(r"(\\|\|)\n", r"\1\0", block.text).splitlines()
    return [(line.replace("\0", "\n"), None) for line in lines if line.strip() and not line.startswith("#")]


def matches(told: str, shown: str) -> bool:
    """Whether the output matches the page. `...` in the page matches any text; alone on a line, any lines."""
    if not shown.strip():
        return not told.strip()
    lines = [re.escape(line.rstrip()).replace(re.escape("..."), ".*") for line in shown.strip().splitlines()]
    pattern = "".join("(?:.*\n)*" if line == ".*" else f"{line} *\n" for line in lines)
    return re.fullmatch(pattern, re.sub(r" +$", "", told.strip(), flags=re.MULTILINE) + "\n") is not None
