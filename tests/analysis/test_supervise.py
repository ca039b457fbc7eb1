"""A supervisor is stored in the model, unless it is incomplete."""

from pathlib import Path

import pytest

import robosc
from robosc.analysis.supervise import EmptySupervisorError, supervise
from robosc.base.diagnostics import has_errors
from robosc.synthesis import Tuning
from tests.synthesis.classics import philosophers

LIBRARY = """\
library StopLibrary {
  component Stop {
    outgoing message pressed with identifier: "/pressed", type: none

    behaviour {
      initial marked state released { on response from pressed goto pressed }
      state pressed {}
    }
  }
}
"""
ROBOT = """\
robot Robot {
  component Stop from StopLibrary import Stop
  component Base {
    incoming message move with identifier: "/move", type: none
  }

  REQUIREMENT
}
"""


def test_a_supervisor_without_all_its_guards_is_nobodys() -> None:
    """A controller with an incomplete supervisor would permit events that synthesis forbids."""
    whole, short = philosophers(5), philosophers(5)
    assert not has_errors(supervise(whole).findings)
    assert whole.supervisor is not None
    supervision = supervise(short, tuning=Tuning(longest=0))
    assert supervision.synthesis.unwritten
    assert not has_errors(supervision.findings)
    assert short.supervisor is None


def test_an_empty_supervisor_is_reported_in_the_robots_own_file(tmp_path: Path) -> None:
    """If the event at fault belongs to a library, the finding is at the requirement."""
    (tmp_path / "StopLibrary.rscd").write_text(LIBRARY)
    text = ROBOT.replace("REQUIREMENT", "requirement R: never Stop.pressed")
    robot = robosc.load(str(tmp_path / "robot.rscd"), text=text)
    with pytest.raises(EmptySupervisorError) as error:
        supervise(robosc.to_sct(robot))
    [finding] = error.value.diagnostics
    line = text.splitlines().index("  requirement R: never Stop.pressed") + 1
    assert (Path(finding.file).name, finding.span.line) == ("robot.rscd", line)
