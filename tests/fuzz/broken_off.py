"""Commands that a signal ends while they write leave either the old files or the complete new ones."""

from __future__ import annotations

import os
import shutil
import signal
import sys
from pathlib import Path
from random import Random

from robosc.tools.cli import main
from tests.fuzz.trial import said
from tests.interruptions import interrupted

_OLD = """\
robot Door {
  component Lock {
    incoming message open with identifier: "/open", type: none
    behaviour { initial marked state locked { } }
  }
}
"""
_NEW = _OLD.replace("/open", "/unlock").replace("state locked { }", "state free { }")
#: Commands with MODEL and OUT, and the files that they write.
COMMANDS = (
    "transform MODEL --to cif,supervisor,xmi -o OUT",
    "transform MODEL --to ros1,ros2 -o OUT",
    "diagram MODEL -o OUT/door.mmd",
    "format MODEL",
)
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT, signal.SIGKILL)
#: An upper bound of the changes to the file system that any of the commands makes.
_CHANGES = 150


def broken_off_tried(folder: Path, seed: int) -> int:
    """Run a command, interrupt it on a changed model at a random change of the file system, then run it to the end.

    Returns the status of the interrupted run, see `interrupted`. Raises AssertionError if files of the two models are
    mixed, or if the interrupted run leaves other files behind.
    """
    random = Random(seed)  # noqa: S311 - nothing here is secret
    command, sent, again = random.choice(COMMANDS), random.choice(SIGNALS), random.random() < 0.3
    here, fresh = folder / "here", folder / "fresh"
    try:
        old, new = _written(here, command, _OLD), _written(fresh, command, _NEW)
        (here / "door.rscd").write_text(_NEW, encoding="utf-8")
        before = _texts(here)
        words = _words(here, command)

        def run() -> None:
            with Path(os.devnull).open("w", encoding="utf-8") as nowhere:
                sys.stdout = sys.stderr = nowhere  # The run has a process of its own.
                raise SystemExit(main(words, standalone_mode=False))

        status = interrupted(run, random.randint(1, _CHANGES), sent, again=again)
        found = _texts(here)
        if sent is signal.SIGKILL and status:
            kept = {name: text for name, text in found.items() if ".robosc-" not in name}
            assert all(text in {before.get(name), new.get(name)} for name, text in kept.items()), command
        else:
            assert found in (before, new), f"{command}: {sorted(set(found.items()) ^ set(new.items()))[:3]}"
        assert said(*words)[0] == 0
        assert _texts(here) == new, f"{command}: {sorted(set(_texts(here)) ^ set(new))}"
        assert old != new
    finally:
        for place in (here, fresh):
            shutil.rmtree(place, ignore_errors=True)
    return status


def _written(place: Path, command: str, model: str) -> dict[str, str]:
    (place / "out").mkdir(parents=True)
    (place / "door.rscd").write_text(model, encoding="utf-8")
    assert said(*_words(place, command))[0] == 0
    return _texts(place)


def _words(place: Path, command: str) -> list[str]:
    return command.replace("MODEL", str(place / "door.rscd")).replace("OUT", str(place / "out")).split()


def _texts(place: Path) -> dict[str, str]:
    files = (path for path in sorted(place.rglob("*")) if path.is_file())
    return {path.relative_to(place).as_posix(): path.read_text(encoding="utf-8") for path in files}
