"""Results that the processes of a test run share."""

from __future__ import annotations

import fcntl
import random
from contextlib import contextmanager
from pathlib import Path
from tempfile import gettempdir
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

#: The ROS 2 domains whose ports are outside the ephemeral range.
_DOMAINS = range(1, 100)


def made_once(folder: Path, name: str, make: Callable[[], str]) -> str:
    """Return the result of `make`. The first process that shares a folder calls it, and the others wait for it."""
    made = folder / name
    with (folder / f"{name}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not made.exists():
            made.write_text(make(), encoding="utf-8")
        return made.read_text(encoding="utf-8")


@contextmanager
def own_domain() -> Iterator[int]:
    """Reserve a ROS 2 domain that no other test of this machine uses."""
    for domain in random.sample(_DOMAINS, len(_DOMAINS)):
        with Path(gettempdir(), f"robosc-domain-{domain}.lock").open("w") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                continue
            yield domain
            return
    raise RuntimeError("each domain of ROS 2 is taken")
