"""The start of the server: its folders and its package."""

import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from robosc.tools.cli import main


def test_without_its_package(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    for name in [
        name for name in sys.modules if name.partition(".")[0] == "mcp" or name.startswith("robosc.tools.mcp")
    ]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "mcp", None)
    answer = CliRunner().invoke(main, ["mcp", str(tmp_path)])
    assert answer.exit_code == 2
    assert answer.output == "Error: mcp is not installed: run pip install 'robosc[mcp]'\n"


@pytest.mark.parametrize("arguments", [[], ["none"], ["."], [".", "--seconds", "0"]])
def test_wrong_calls(arguments: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").touch()
    monkeypatch.chdir(tmp_path)
    arguments = ["file" if argument == "." and len(arguments) == 1 else argument for argument in arguments]
    answer = CliRunner().invoke(main, ["mcp", *arguments])
    assert answer.exit_code == 2
    assert "Traceback" not in answer.output
