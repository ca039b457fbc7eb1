"""A folder with a small robot, and a runner of the command line in it."""

import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from robosc.tools.cli import main

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
    """Run robosc in an empty folder; an internal fault of the tool fails the test."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("ROBOSC_PATH", raising=False)
    monkeypatch.delenv("ROBOSC_TRACEBACK", raising=False)
    return lambda *arguments: CliRunner().invoke(
        main, [str(argument) for argument in arguments], catch_exceptions=False
    )


@contextmanager
def not_longer_than(seconds: int) -> Iterator[None]:
    """Fail if the block takes longer, for example because it waits for a pipe without a writer."""

    def give_up(*_: object) -> None:
        raise TimeoutError(f"not done within {seconds} s")

    before = signal.signal(signal.SIGALRM, give_up)
    signal.alarm(seconds)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


@pytest.fixture
def door(tmp_path: Path) -> Path:
    """Return a file with a robot without faults."""
    file = tmp_path / "door.rscd"
    file.write_text(DOOR)
    return file


@pytest.fixture
def broken(tmp_path: Path) -> Path:
    """Return a file with a robot with two errors: a second initial state, and an unknown name."""
    file = tmp_path / "broken.rscd"
    file.write_text(DOOR.replace("marked state opened", "initial marked state opened").replace("Leaf.closed", "Leaf.x"))
    return file


@pytest.fixture
def stuck(tmp_path: Path) -> Path:
    """Return a file with a robot whose requirement prevents it from ever reaching a marked state."""
    file = tmp_path / "stuck.rscd"
    file.write_text(DOOR.replace("initial marked", "initial").replace("needs Leaf.closed", "needs Leaf.opened"))
    return file


@pytest.fixture
def library(tmp_path: Path) -> Path:
    """Return a file with a library."""
    file = tmp_path / "library.rscd"
    file.write_text("library Parts {}\n")
    return file


#: A robot with imported lamps that draws a warning in the library, and an error if `{needs}` is `resting`.
COURIER = """\
robot Courier {{
  interface drive_action use Drive from courier_msgs

  component Lamps from Lamps import Lamps

  component Base {{
    action drive with identifier: "/drive", request: none, response: none, feedback: none links drive_action

    behaviour {{
      initial marked state resting {{ on request to drive goto driving }}

      state driving {{
        on response from drive goto resting
        on error from drive goto resting
        on canceled from drive goto resting
      }}
    }}
  }}

  requirement drive needs Base.{needs}

  provide light with true
  provide dark with false
}}
"""

LAMPS = """\
library Lamps {
  component Lamps {
    incoming message light with identifier: "/lamps", type: boolean
    incoming message dark with identifier: "/lamps", type: boolean
  }
}
"""


@pytest.fixture
def courier(tmp_path: Path) -> Path:
    """Return a file with a robot that draws a warning of synthesis in a library in the folder `parts`."""
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "lamps.rscd").write_text(LAMPS)
    file = tmp_path / "courier.rscd"
    file.write_text(COURIER.format(needs="resting or Base.driving"))
    return file


@pytest.fixture
def self_cancelling(courier: Path) -> Path:
    """Return the same robot with an action that would be canceled directly after its start."""
    courier.write_text(COURIER.format(needs="resting"))
    return courier
