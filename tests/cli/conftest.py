"""A folder with a small robot, and a way to call the command line in it."""

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from robosc.cli import main

DOOR = """\
robot Door {
  component Leaf {
    incoming message open with identifier: "/open", type: none
    incoming message close with identifier: "/close", type: none

    behaviour {
      initial marked state closed {
        on request to open goto opened
      }

      marked state opened {
        on request to close goto closed
      }
    }
  }

  requirement open needs Leaf.closed
}
"""

Run = Callable[..., Result]


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    """Calls robosc in an empty folder; a fault of the tool itself fails the test."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("ROBOSC_PATH", raising=False)
    monkeypatch.delenv("ROBOSC_TRACEBACK", raising=False)
    return lambda *arguments: CliRunner().invoke(main, [str(each) for each in arguments], catch_exceptions=False)


@pytest.fixture
def door(tmp_path: Path) -> Path:
    """A file with a robot in which nothing is wrong."""
    file = tmp_path / "door.rscd"
    file.write_text(DOOR)
    return file


@pytest.fixture
def broken(tmp_path: Path) -> Path:
    """A file with a robot with two errors: a second initial state, and a name that is nothing."""
    file = tmp_path / "broken.rscd"
    file.write_text(DOOR.replace("marked state opened", "initial marked state opened").replace("Leaf.closed", "Leaf.x"))
    return file


@pytest.fixture
def stuck(tmp_path: Path) -> Path:
    """A file with a robot whose requirement keeps it from ever reaching a marked state."""
    file = tmp_path / "stuck.rscd"
    file.write_text(DOOR.replace("initial marked", "initial").replace("needs Leaf.closed", "needs Leaf.opened"))
    return file


@pytest.fixture
def library(tmp_path: Path) -> Path:
    """A file with a library."""
    file = tmp_path / "library.rscd"
    file.write_text("library Parts {}\n")
    return file
