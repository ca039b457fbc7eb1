"""`never`, `always` and names of requirements, from the text to the output for users."""

import re
from pathlib import Path

import pytest

from robosc.analysis.explain.as_text import Renderer
from robosc.analysis.explain.explanations import emptiness, explore
from robosc.analysis.supervise import EmptySupervisorError, supervise
from robosc.analysis.verify import validate_cif, verify_system
from robosc.analysis.verify.verdict import Outcome
from robosc.language.checks import check
from robosc.language.configuration import Configuration
from robosc.language.formatting import format_text
from robosc.language.reading import read
from robosc.language.text import Text
from robosc.m2m import robosc_to_sct, sct_to_engine
from robosc.m2t import cif
from robosc.m2t.models import Models
from robosc.model import sct

ARM = """
    component {0} {{
        incoming message enter{0} with type: none
        outgoing message left{0} with type: none
        behaviour {{
            initial marked state away {{ on request to enter{0} goto in_zone }}
            state in_zone {{ on response from left{0} goto away }}
        }}
        {1}
    }}
"""
STOP = """
    component Stop {
        outgoing message pressed with type: none
        behaviour {
            initial marked state running { on response from pressed goto stopped }
            marked state stopped { on response from pressed goto running }
        }
    }
"""
BASE = """
    component Base {
        action drive with request: none, response: none, feedback: none links go
        behaviour {
            initial marked state idle { on request to drive goto driving }
            state driving {
                on response from drive goto idle
                on error from drive goto idle
                on canceled from drive goto idle
            }
        }
    }
    interface go use Dock from my_msgs
"""
MOVED = """
    component Base {
        outgoing message moved with type: none
        behaviour {
            initial marked state idle { on response from moved goto driving }
            marked state driving { on response from moved goto idle }
        }
    }
"""


def sct_of(folder: Path, *definitions: str) -> sct.SupervisoryControlModel:
    path = folder / "robot.rscd"
    path.write_text(f"robot R {{ {' '.join(definitions)} }}", encoding="utf-8")
    reading = read(path)
    found = [*reading.findings, *check(reading.base, reading.findings)]
    assert [finding for finding in found if finding.rule not in {"interface-unknown", "interface-unused"}] == []
    return robosc_to_sct.transform(reading.base)[0]


def gate(folder: Path, *requirements: str) -> sct.SupervisoryControlModel:
    return sct_of(folder, ARM.format("Left", ""), ARM.format("Right", ""), *requirements)


CRUSH = 'requirement SR4 "no crush at the gate": never Left.in_zone and Right.in_zone'


@pytest.mark.parametrize("said", ["never Left.in_zone and Right.in_zone", "always Left.away or Right.away"])
def test_it_holds_in_every_reachable_state_of_the_supervised_system(tmp_path: Path, said: str) -> None:
    made = gate(tmp_path, f"requirement {said}")
    assert supervise(made).synthesis.controlled_states == 3
    verdict = next(verdict for verdict in verify_system(made) if verdict.property.startswith(f"requirement {said}"))
    assert verdict.outcome is Outcome.PROVED


def test_synthesis_keeps_away_from_where_something_uncontrollable_leads_to_a_violation(tmp_path: Path) -> None:
    """`never EmergencyStop.stopped and Base.driving` forbids driving altogether, and the finding explains why."""
    made = sct_of(
        tmp_path,
        STOP,
        BASE,
        "requirement drive needs Stop.running",
        "requirement SR1: never Stop.stopped and Base.driving",
    )
    found = supervise(made).findings
    never = next(finding for finding in found if finding.rule == "never-enabled")
    assert never.message == (
        "`Base.drive` can never be started: after request to `Base.drive`, response from `Stop.pressed` cannot be "
        "prevented, and then `requirement SR1: never Stop.stopped and Base.driving` is violated"
    )
    assert never.hint == (
        "loosen the requirement (what the action `needs` cancels it; `never` and `always` do not let it start), or "
        "remove it; `robosc explain --why-never Base.drive` explains why"
    )


def test_what_could_happen_only_beyond_names_the_requirement(tmp_path: Path) -> None:
    """A finding about an event in unreachable states names its cause.

    The cause is a requirement and an uncontrollable event, with a trace.
    """
    horn = "component Horn { incoming message toot with type: none }"
    made = sct_of(
        tmp_path,
        STOP,
        BASE.replace("state driving {", "state driving { on request to toot"),
        horn,
        "requirement SR1: never Stop.stopped and Base.driving",
    )
    (toot,) = [finding for finding in supervise(made).findings if "`Horn.toot` can never" in finding.message]
    assert toot.rule == "never-enabled"
    assert toot.message == (
        "therefore, `Horn.toot` can never be sent: the supervised robot reaches no state in which it could be "
        "sent: after request to `Base.drive`, response from `Stop.pressed` cannot be prevented, and then `requirement "
        "SR1: never Stop.stopped and Base.driving` is violated"
    )


def test_a_state_that_is_out_of_reach_says_what_keeps_it_out(tmp_path: Path) -> None:
    made = sct_of(tmp_path, STOP, BASE, "requirement SR1: never Stop.stopped and Base.driving")
    unreachable = next(finding for finding in supervise(made).findings if finding.rule == "unreachable-state")
    assert unreachable.message.startswith("therefore, `Base` is never in `driving`: in `idle` the supervisor prevents")
    assert unreachable.message.endswith("`requirement SR1: never Stop.stopped and Base.driving` is violated")


def test_an_action_is_cancelled_for_no_invariant(tmp_path: Path) -> None:
    made = sct_of(tmp_path, STOP, BASE, "requirement never Stop.stopped and Base.driving")
    cancel = next(requirement for requirement in made.requirements if requirement.event.kind == sct.EventKind.cancel)
    assert cancel.text == "drive is never cancelled: no requirement restricts it"


@pytest.mark.parametrize(
    ("requirement", "message"),
    [
        (
            "requirement SR1: never Stop.stopped and Base.driving",
            (
                "response from `Stop.pressed` cannot be prevented, and after it {} is violated; a shortest trace: "
                "response from `Base.moved`, then response from `Stop.pressed`"
            ),
        ),
        (
            "requirement SR2: always Base.driving",
            "{} is violated from the start",
        ),
    ],
)
def test_an_empty_supervisor_names_the_requirement_and_the_shortest_way(
    tmp_path: Path, requirement: str, message: str
) -> None:
    made = sct_of(tmp_path, STOP, MOVED, requirement)
    with pytest.raises(EmptySupervisorError) as raised:
        supervise(made)
    (found,) = raised.value.diagnostics
    assert (
        re.sub(r" \(line \d+\)", "", found.message) == f"the supervisor is empty: {message.format(f'`{requirement}`')}"
    )
    told = explore(made, lambda system: Renderer(made, lambda _: "").answer(emptiness(system)))
    assert f"Loosen or remove one of these:\n  : {requirement} (4 states without it)" in told


def test_a_way_to_a_marked_state_through_a_violation(tmp_path: Path) -> None:
    """The marked state exists, but the path to it is forbidden."""
    component = """component Base {
        incoming message go with type: none
        behaviour {
            initial state start { on request to go goto middle }
            state middle { on request to go goto home }
            marked state home { }
        }
    }"""
    made = sct_of(tmp_path, component, "requirement SR1: never Base.middle")
    with pytest.raises(EmptySupervisorError, match=r"needs request to `Base.go`, after which `requirement SR1: never"):
        supervise(made)


def test_names_appear_in_every_message_and_comment(tmp_path: Path) -> None:
    named = [
        'requirement SR5 "one at a time": enterLeft needs Right.away',
        'requirement "doubled": Right.in_zone disables enterRight',
    ]
    made = gate(tmp_path, CRUSH, *named)
    supervise(made)
    stated = [*made.requirements, *made.invariants]
    assert [(requirement.name, requirement.text) for requirement in stated] == [
        ("SR5", named[0]),
        (None, named[1]),
        ("SR4", CRUSH),
    ]
    events = {event.name: event.remarks for event in sct_to_engine.transform(made).events}
    assert events["message_enterLeft.c_trigger"] == [f"{named[0]} (robot.rscd)"]
    *_, synthesis = events["message_enterRight.c_trigger"]
    assert synthesis.startswith("synthesis prevents this: after request to `Left.enterLeft`")
    assert synthesis.endswith(f"`{CRUSH}` is violated")


def test_names_of_requirements_in_instances_have_their_component(tmp_path: Path) -> None:
    template = ARM.format("Arm", "requirement SR4: never in_zone").replace("Arm {", "Arm(ns: string) {", 1)
    template = template.replace("message leftArm with", 'message leftArm with identifier: ns + "/left",')
    made = sct_of(tmp_path, template, 'component Left is Arm("l") component Right is Arm("r")')
    assert [(invariant.name, invariant.text) for invariant in made.invariants] == [
        ("Left.SR4", "requirement Left.SR4: never Left.in_zone"),
        ("Right.SR4", "requirement Right.SR4: never Right.in_zone"),
    ]


def test_names_are_unique(tmp_path: Path) -> None:
    path = tmp_path / "robot.rscd"
    path.write_text(f"robot R {{ {ARM.format('Left', '')} requirement Left: never Left.in_zone }}", encoding="utf-8")
    reading = read(path)
    (found,) = [finding for finding in check(reading.base, reading.findings) if finding.rule == "unique-component"]
    assert found.message.startswith("requirement `Left` has the name of a component (line 2)")


def test_cif_says_it_as_a_requirement_invariant(tmp_path: Path) -> None:
    made = gate(tmp_path, CRUSH)
    supervise(made)
    files = cif.generate(Models(made), Configuration())
    said = "requirement invariant SR4: not (component_Left.in_zone and component_Right.in_zone);"
    assert said in files["R.cif"]
    assert said not in files["R.supervised.cif"]
    assert validate_cif(made, files).outcome is Outcome.PROVED
    for changed in (said.replace("not (component_Left.in_zone and", "(true or"), said.replace(" and ", " or ")):
        verdict = validate_cif(made, {**files, "R.cif": files["R.cif"].replace(said, changed)})
        assert verdict.outcome is Outcome.REFUTED
        assert "by its invariants the generated CIF without supervisor" in verdict.explanation


def test_a_guard_that_lets_the_robot_violate_it_is_refuted_with_a_shortest_trace(tmp_path: Path) -> None:
    made = gate(tmp_path, CRUSH)
    supervise(made)
    for guard in made.supervisor.guards:
        guard.synthesis = None
    verdict = next(verdict for verdict in verify_system(made) if verdict.property.startswith(CRUSH))
    assert verdict.outcome is Outcome.REFUTED
    assert verdict.explanation == "it is violated where `Left.in_zone and Right.in_zone`"
    assert {step.event for step in verdict.trace} == {"message_enterLeft.c_trigger", "message_enterRight.c_trigger"}
    assert len(verdict.trace) == 2


def test_the_words_are_names_elsewhere(tmp_path: Path) -> None:
    """`never` and `always` are not reserved: a communication or a state may have these names."""
    component = """component always {
        incoming message never with type: none
        behaviour {
            variable left: integer(0..3)
            initial marked state on_duty { on request to never transition do left := left + 1 }
        }
    }"""
    made = sct_of(
        tmp_path, component, "requirement never needs always.on_duty", "requirement always.left = 3 disables never"
    )
    assert [requirement.kind.name for requirement in made.requirements] == ["needs", "disables"]
    assert not list(made.invariants)


def test_format_keeps_what_is_laid_out() -> None:
    laid_out = f"robot R {{\n  {CRUSH}\n  requirement always Base.idle or Lift.down\n}}\n"
    assert format_text(Text("robot.rscd", laid_out)) == (laid_out, [])
