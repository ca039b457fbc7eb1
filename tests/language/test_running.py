"""`Base.drive.running` reads whether a service or action is running, unless the name has another meaning."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

import robosc
from robosc.model import robosc as rsc
from tests.language.second_edition import requirements, running
from tests.language.texts import reading, underlined

if TYPE_CHECKING:
    from pathlib import Path

ROBOT = """robot Carrier {
  interface moving use Move from carrier_msgs
  component Base {
    action drive with request: none, response: none, feedback: none links moving
    service beep with request: none, response: none
    outgoing message bump with type: none
    behaviour {
      initial marked state here { on request to drive if !beep.running on request to beep }
    }
  }
  component Lift { service raise with request: none, response: none }
  requirement raise needs !Base.drive.running
  property never Base.drive.running and Lift.raise.running
}"""


def test_it_is_true_from_the_request_until_the_end() -> None:
    engine = running(ROBOT)
    rise, beep = "service_raise.c_trigger", "service_beep.c_trigger"
    assert engine.enabled(rise)
    engine.perform("action_drive.c_trigger")
    assert not engine.enabled(rise)
    engine.perform("action_drive.u_feedback")
    assert not engine.enabled(rise)
    engine.perform("action_drive.u_response")
    assert engine.enabled(rise)
    engine.perform("action_drive.c_reset")
    engine.perform(beep)
    assert not engine.enabled("action_drive.c_trigger")
    engine.perform("service_beep.u_error")
    assert engine.enabled("action_drive.c_trigger")


def test_it_is_true_while_a_cancel_is_under_way() -> None:
    stop = "component Stop { outgoing message stop with type: none behaviour {"
    stop += " initial marked state free { on response from stop goto pressed } marked state pressed { } } }"
    engine = running(ROBOT.replace("  requirement", f"  {stop} requirement drive needs Stop.free\n  requirement", 1))
    for event in ("action_drive.c_trigger", "message_stop.u_response", "action_drive.c_cancel"):
        assert engine.perform(event)
    assert not engine.enabled("service_raise.c_trigger")
    assert engine.perform("action_drive.u_canceled")
    assert engine.enabled("service_raise.c_trigger")


def test_it_takes_no_state_of_its_own() -> None:
    with_it, without = (
        robosc.synthesize(robosc.to_sct(robosc.load(text=text))).uncontrolledStates
        for text in (ROBOT.replace(" if !beep.running", ""), ROBOT.replace("Base.drive.running", "false"))
    )
    assert with_it == without == 5 * 4 * 4


def test_a_text_keeps_its_meaning(tmp_path: Path) -> None:
    """A variable with the name of a communication and a property `running` takes precedence."""
    found = reading(
        tmp_path,
        """robot R {
          interface link use Data from my_msgs
          datatype object Data { running: boolean }
          component C {
            outgoing message told with type: Data links link
            service drive with request: none, response: none
            behaviour {
              variable drive: Data
              initial marked state here { on response from told do drive := value }
            }
          }
          component running { behaviour { initial marked state s { } } }
          provide go with 1.0 if C.drive.running
          component D { incoming message go with type: double }
        }""",
    )
    assert underlined(found) == []
    assert found.base is not None
    items = [element.item for element in found.base.eAllContents() if isinstance(element, rsc.Access) and element.item]
    assert [type(item).__name__ for item in items] == ["Variable", "Variable"]


def test_it_is_printed_as_it_is_written() -> None:
    assert "requirement raise needs !Base.drive.running" in requirements(ROBOT)


@pytest.mark.parametrize(
    ("wrong", "finding", "right"),
    [
        ("outside Base.drive.runing", ("runing", "did you mean `running`?"), "Base.drive.running"),
        ("outside Base.drive.active", ("active", "write `running`"), "Base.drive.running"),
        ("outside Base.drive", ("drive", "write `drive.running`"), "Base.drive.running"),
        ("outside Base.drve.running", ("drve", "did you mean `drive`?"), "Base.drive.running"),
        ("outside Base.drive.running.x", ("x", "leave `.x` out"), "Base.drive.running"),
        ("outside drive.running", ("drive", "write `Base.drive`"), "Base.drive.running"),
        ("outside Base.bump.running", ("bump", "store in a variable that it was sent"), None),
        ("inside drive.runnin", ("runnin", "did you mean `running`?"), "drive.running"),
        ("inside drive.active", ("active", "write `running`"), "drive.running"),
        ("inside drve.running", ("drve", "did you mean `drive`?"), "drive.running"),
        ("inside drive", ("drive", "write `drive.running`"), "drive.running"),
        ("inside bump.running", ("bump", "store in a variable that it was sent"), None),
    ],
)
def test_what_is_nearly_running_says_so(
    tmp_path: Path, wrong: str, finding: tuple[str, str], right: str | None
) -> None:
    place, wrong = wrong.split()
    outside = ROBOT.replace("!Base.drive.running", "!{0}")
    text = outside if place == "outside" else ROBOT.replace("!beep.running", "!{0}")
    found = reading(tmp_path, text.replace("{0}", wrong))
    assert underlined(found) == [("unresolved-reference", finding[0])]
    assert found.findings[0].hint == finding[1]
    (first, *_) = found.findings
    mended = found.file.text.after(first.edits or next((way.edits for way in first.alternatives), ()))
    assert mended == text.replace("{0}", right or wrong)
