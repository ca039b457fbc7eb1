"""The tests cover each message that the page on faults quotes; `Scout.says` finds their messages on the page."""

from __future__ import annotations

import re

from tests.ros.faults.partners import DOCUMENTATION, HERE

#: Tests of faults of a controller's clients.
SERVING = (
    HERE.parent / "test_serving.py",
    HERE.parent / "test_serving_stop.py",
    HERE.parents[1] / "run" / "runtime" / "test_servers.py",
)
#: A quoted message: it begins with a topic, a service or an action, or reports a withheld command.
MESSAGE = re.compile(r"`((?:/\w+: |\w+ is withheld: )[^`]+)`")


def test_all_quoted_messages_are_looked_for() -> None:
    tests = "".join(path.read_text() for path in [*sorted(HERE.glob("test_*.py")), *SERVING])
    quoted = MESSAGE.findall(DOCUMENTATION.read_text())
    assert len(quoted) > 15
    assert [text for text in quoted if f'"{text}"' not in tests] == []
