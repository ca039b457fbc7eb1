"""Orders, counts and requirement automata, from the text to the engine and the output for users."""

from pathlib import Path

import pytest

from robosc.analysis.supervise import EmptySupervisorError, supervise
from robosc.analysis.verify import validate_c, validate_cif, verify_system
from robosc.analysis.verify.verdict import Outcome
from robosc.engine import Engine
from robosc.language.checks import check
from robosc.language.configuration import Configuration
from robosc.language.formatting import format_text
from robosc.language.reading import read
from robosc.language.text import Text
from robosc.m2m import robosc_to_sct
from robosc.m2t import cif, supervisor
from robosc.m2t.models import Models
from robosc.model import sct

ARM = """
    component Arm {
        incoming message grip with type: none
        incoming message place with type: none
        incoming message drop with type: none
        outgoing message home with type: none
        service dock with request: none, response: none
    }
"""


def read_robot(folder: Path, *definitions: str, arm: str = ARM) -> tuple[list[str], sct.SupervisoryControlModel | None]:
    path = folder / "robot.rscd"
    path.write_text(f"robot R {{ {arm} {' '.join(definitions)} }}", encoding="utf-8")
    reading = read(path)
    found = [*reading.findings, *check(reading.base, reading.findings)]
    texts = [f"{finding.rule}: {finding.message}" for finding in found]
    return texts, None if texts else robosc_to_sct.transform(reading.base)[0]


def supervised(folder: Path, *definitions: str) -> sct.SupervisoryControlModel:
    findings, made = read_robot(folder, *definitions)
    assert findings == []
    supervise(made)
    return made


def possible(made: sct.SupervisoryControlModel, *events: str) -> set[str]:
    """Return those of `grip`, `place`, `drop` and `dock` that can happen after these events."""
    interpreter = Engine(made)
    for event in events:
        interpreter.perform(event)
    names = {f"{'service' if name == 'dock' else 'message'}_{name}.c_trigger": name for name in WORDS}
    return {name for event, name in names.items() if interpreter.enabled(event)}


WORDS = ("grip", "place", "drop", "dock")
GRIP, PLACE, DROP, HOME = (
    "message_grip.c_trigger",
    "message_place.c_trigger",
    "message_drop.c_trigger",
    "message_home.u_response",
)


def test_b_after_a_is_a_at_least_once_before(tmp_path: Path) -> None:
    made = supervised(tmp_path, "requirement place after grip")
    assert possible(made) == {"grip", "drop", "dock"}
    assert possible(made, GRIP) == possible(made, GRIP, PLACE) == {*WORDS}


def test_b_after_each_a_is_a_fresh_a_for_each_b(tmp_path: Path) -> None:
    made = supervised(tmp_path, "requirement place after each grip")
    assert "place" not in possible(made)
    assert "place" in possible(made, GRIP)
    assert "place" not in possible(made, GRIP, PLACE)
    assert "place" not in possible(made, GRIP, GRIP, PLACE)


def test_a_set_on_the_left_any_event_of_it_counts(tmp_path: Path) -> None:
    made = supervised(tmp_path, "requirement { place, drop } after each grip")
    assert possible(made, GRIP) == {*WORDS}
    assert possible(made, GRIP, DROP) == {"grip", "dock"}


def test_at_most_n_b_since_a_counts_b_and_starts_anew_with_each_a(tmp_path: Path) -> None:
    """A bare outgoing message means its response; N is any constant."""
    made = supervised(tmp_path, "constant n: integer = 1", "requirement at most n + 1 { place, drop } since home")
    assert possible(made, PLACE) == {*WORDS}
    assert possible(made, PLACE, DROP) == {"grip", "dock"}
    assert possible(made, PLACE, DROP, HOME) == {*WORDS}


TURNS = """requirement Turns: automaton {
    initial state mine { on request to grip goto yours }
    state yours { on request to place if !Gate.shut goto mine }
}"""
GATE = """component Gate {
    outgoing message closing with type: none
    behaviour {
        initial marked state open { on response from closing goto shut }
        marked state shut { on response from closing goto open }
    }
}"""


def test_an_automaton_forbids_where_no_transition_of_the_state_has_a_condition_that_holds(tmp_path: Path) -> None:
    made = supervised(tmp_path, GATE, TURNS)
    assert possible(made) == {"grip", "drop", "dock"}
    assert possible(made, GRIP) == {"place", "drop", "dock"}
    assert possible(made, GRIP, "message_closing.u_response") == {"drop", "dock"}
    assert possible(made, GRIP, PLACE) == {"grip", "drop", "dock"}


def test_of_several_transitions_the_first_is_taken_whose_condition_holds(tmp_path: Path) -> None:
    made = supervised(
        tmp_path,
        GATE,
        """requirement T: automaton {
            initial state a {
                on request to grip if Gate.shut goto b
                on request to grip if Gate.open goto c
            }
            state b { on request to place }
            state c { on request to drop }
        }""",
    )
    assert possible(made) == {"grip", "dock"}
    assert possible(made, GRIP) == {"drop", "dock"}
    assert possible(made, "message_closing.u_response", GRIP) == {"place", "dock"}
    assert validate_cif(made, cif.generate(Models(made), Configuration())).outcome is Outcome.PROVED


def test_requirements_read_the_states_of_an_automaton(tmp_path: Path) -> None:
    made = supervised(tmp_path, GATE, TURNS, "condition my_turn = Turns.mine", "requirement drop needs my_turn")
    assert "drop" in possible(made)
    assert "drop" not in possible(made, GRIP)


def test_it_does_not_start_what_it_could_not_let_go_on(tmp_path: Path) -> None:
    """A forbidden uncontrollable event makes the state bad: after the service call its response may come."""
    made = supervised(tmp_path, "requirement O1: response from dock after home")
    assert possible(made) == {"grip", "place", "drop"}
    assert possible(made, HOME) == {*WORDS}
    explanation = next(
        guard.explanation for guard in made.supervisor.guards if guard.event.name == "c_trigger" and guard.explanation
    )
    assert explanation == (
        "after request to `Arm.dock`, response from `Arm.dock` can come, which `requirement O1: response from dock "
        "after home` forbids"
    )


def test_an_empty_supervisor_names_the_requirement(tmp_path: Path) -> None:
    gate = GATE.replace("marked state open", "state open")
    findings, made = read_robot(
        tmp_path, gate, "requirement T: automaton { initial state a { on response from closing if Gate.shut } }"
    )
    assert findings == []
    with pytest.raises(EmptySupervisorError, match=r"which `requirement T: automaton` .* forbids"):
        supervise(made)


def test_marked_states_of_an_automaton_count(tmp_path: Path) -> None:
    """If an automaton has a marked state, the robot must be able to return to it."""
    bound = "requirement T: automaton {{ initial {} state a {{ on request to grip goto b }} state b {{ }} }}"
    assert "grip" in possible(supervised(tmp_path, bound.format("")))
    assert "grip" not in possible(supervised(tmp_path, bound.format("marked")))


def test_controlled_states_count_them_and_uncontrolled_states_do_not(tmp_path: Path) -> None:
    alone = supervised(tmp_path).supervisor
    made = supervised(tmp_path, "requirement at most 3 place since grip", "requirement drop after grip").supervisor
    assert made.uncontrolledStates == alone.uncontrolledStates == 4
    assert made.controlledStates == 4 * 8


def test_they_are_requirement_automata_in_cif_and_read_back_the_same(tmp_path: Path) -> None:
    made = supervised(
        tmp_path, GATE, TURNS, "requirement C1: at most 3 drop since grip", "requirement place after each home"
    )
    files = cif.generate(Models(made), Configuration())
    for name in ("requirement_Turns", "requirement_C1", "requirement_3"):
        assert f"requirement automaton {name}:" in files["R.cif"]
    assert validate_cif(made, files).outcome is Outcome.PROVED
    for text, changed in (
        ("requirement_Turns:", "plant"),
        ("goto yours", ""),
        ("needs requirement_C1.count < 3", "needs requirement_C1.count < 2"),
        ("count := 0", "count := 1"),
    ):
        broken = (
            files["R.cif"].replace(text, changed)
            if changed != "plant"
            else files["R.cif"].replace("requirement automaton requirement_Turns", "plant requirement_Turns")
        )
        assert broken != files["R.cif"]
        assert validate_cif(made, {**files, "R.cif": broken}).outcome is Outcome.REFUTED


@pytest.mark.build
def test_the_c_engine_tracks_them(tmp_path: Path) -> None:
    made = supervised(
        tmp_path, GATE, TURNS, "requirement C1: at most 3 drop since grip", "requirement place after each home"
    )
    files = supervisor.generate(Models(made), Configuration())
    assert validate_c(made, files).outcome is Outcome.PROVED
    (name,) = [name for name in files if name.endswith(".c")]
    text = files[name]
    assert "requirement C1: at most 3 drop since grip (robot.rscd)" in text
    for right, wrong in (
        ("requirement_C1_count < 3U", "requirement_C1_count <= 3U"),
        ("requirement_C1_count = 0;", "requirement_C1_count = 1;"),
        ("requirement_Turns = r_requirement_Turns_yours", "requirement_Turns = r_requirement_Turns_mine"),
        ("requirement_3 == r_requirement_3_ready", "requirement_3 == r_requirement_3_waiting"),
    ):
        assert right in text
        verdict = validate_c(made, {**files, name: text.replace(right, wrong)})
        assert verdict.outcome is Outcome.REFUTED


GUIDE = """component Guide {
    behaviour {
        initial marked state idle { on request to grip goto busy }
        marked state busy { on response from home goto late on request to drop }
        marked state late { on request to place }
    }
}"""


WHEREVER = "in every state where it could be, `requirement {}` (line 15) forbids it, for example "
OUT_OF_REACH = "the supervised robot reaches no state in which it could be sent: "


@pytest.mark.parametrize(
    ("requirement", "name", "why"),
    [
        (  # forbidden in all states in which it could happen
            "requirement T: automaton { initial state a { on grip on response from home } state b { on place } }",
            "place",
            WHEREVER.format("T: automaton") + "after request to `Arm.grip`, then response from `Arm.home`",
        ),
        (
            "requirement { grip, place } after drop",
            "grip",
            WHEREVER.format("{ grip, place } after drop") + "at the start",
        ),
        (  # kept out of reach by a requirement on the path
            "requirement grip after drop",
            "place",
            OUT_OF_REACH + "the shortest way to one needs request to `Arm.grip`, where `requirement grip after drop` "
            "(line 15) forbids it",
        ),
        (  # by an uncontrollable response
            "requirement T: automaton { initial state a { on grip goto b on response from home } state b { on grip } }",
            "place",
            OUT_OF_REACH + "after request to `Arm.grip`, response from `Arm.home` can come, which `requirement T: "
            "automaton` forbids",
        ),
        (  # by an automaton that could not return to its marked state
            "requirement T: automaton { initial marked state a { on grip goto b } state b { } }",
            "place",
            OUT_OF_REACH + "after request to `Arm.grip`, `T` cannot get back to a marked state",
        ),
    ],
)
def test_never_enabled_says_why_with_a_trace(tmp_path: Path, requirement: str, name: str, why: str) -> None:
    """If one of these requirements leaves an event never enabled, `never-enabled` explains why.

    It names the requirement and the uncontrollable event, with a trace.
    """
    findings, made = read_robot(tmp_path, GUIDE, requirement)
    assert findings == []
    found = [finding.message for finding in supervise(made).findings if finding.rule == "never-enabled"]
    assert f"`Arm.{name}` can never be sent: {why}" in [message.removeprefix("therefore, ") for message in found]


def test_verify_has_a_row_for_each_event_and_refutes_a_guard_that_forgets(tmp_path: Path) -> None:
    made = supervised(tmp_path, "requirement O1: place after each grip")
    row = "requirement O1: place after each grip (line 9)"
    verdicts = {verdict.property: verdict for verdict in verify_system(made)}
    assert {verdict.outcome for verdict in verdicts.values()} == {Outcome.PROVED}
    assert row in verdicts
    for guard in made.supervisor.guards:
        guard.requirement = None
    verdict = next(verdict for verdict in verify_system(made) if verdict.property == row)
    assert verdict.outcome is Outcome.REFUTED
    assert [step.event for step in verdict.trace] == [PLACE]


def test_an_action_is_not_cancelled_for_an_order(tmp_path: Path) -> None:
    """`drive after each grip` forbids another start while the action runs. This draws no `self-cancelling`."""
    base = """component Base {
        action drive with request: none, response: none, feedback: none links go
    }
    interface go use Dock from my_msgs"""
    path = tmp_path / "robot.rscd"
    path.write_text(f"robot R {{ {ARM} {base} requirement drive after each grip }}", encoding="utf-8")
    made = robosc_to_sct.transform(read(path).base)[0]
    found = supervise(made).findings
    assert "self-cancelling" not in {finding.rule for finding in found}
    assert {requirement.text for requirement in made.requirements} == {
        "requirement drive after each grip",
        "drive is never cancelled: no requirement restricts it",
    }


@pytest.mark.parametrize(
    ("requirement", "finding"),
    [
        (
            "requirement at most 0 place since grip",
            "integer-range: `at most` counts to 0, expected a number from 1 to 1,000",
        ),
        (
            "requirement at most 1001 place since grip",
            "integer-range: `at most` counts to 1001, expected a number from 1 to 1,000",
        ),
        ("requirement at most 1.5 place since grip", "type: the number after `at most` must be integer, found double"),
        (
            "requirement { } after grip",
            "requirement-target: the requirement restricts nothing, expected at least one event in the braces",
        ),
        (
            "requirement feedback from dock after grip",
            "result-type: service `dock` has no feedback, expected `request`, `response` or `error`",
        ),
        (
            "requirement T: automaton { state a { } }",
            "initial-state: no state of the automaton is initial, expected one",
        ),
        (
            "requirement T: automaton { initial state a { } initial state b { } }",
            "initial-state: the automaton has a second initial state `b`, expected one",
        ),
        (
            "requirement T: automaton { initial state a { } state a { } }",
            "unique-state: state `a` has the name of another state (line 9)",
        ),
        (
            "requirement T: automaton { initial state a { on request to grip goto b } }",
            "unresolved-reference: the requirement has no state `b`",
        ),
        (
            "requirement T: automaton { initial state a { on grip on request to grip } }",
            "nondeterminism: this transition of state `a` is never tried",
        ),
        (
            "requirement T: automaton { initial state a { } } requirement place needs T.b",
            "unresolved-reference: requirement `T` has no state `b`",
        ),
        (
            "requirement T: automaton { initial state a { on grip if 1 } }",
            "type: the condition after `if` must be boolean, found integer",
        ),
    ],
)
def test_what_is_wrong_is_found(tmp_path: Path, requirement: str, finding: str) -> None:
    (found,) = read_robot(tmp_path, requirement)[0]
    assert found.startswith(finding)


@pytest.mark.parametrize("inside", ["variable v: boolean", "on request to grip goto a", "transition goto a"])
def test_states_and_transitions_on_events_only(tmp_path: Path, inside: str) -> None:
    """Variables, silent transitions and automaton-level transitions are not permitted: `syntax`."""
    found, _ = read_robot(tmp_path, f"requirement T: automaton {{ initial state a {{ }} {inside} }}")
    assert any(text.startswith("syntax") for text in found)


def test_the_words_are_names_elsewhere(tmp_path: Path) -> None:
    words = "after each at most since automaton"
    messages = " ".join(f"incoming message {word} with type: none" for word in words.split())
    component = f"component since_then {{ {messages} }}"
    requirements = "requirement after after each each requirement at after since requirement at most 2 most since at"
    made = supervised(tmp_path, component, requirements)
    assert [requirement.text for requirement in made.requirements] == [
        "requirement after after each each",
        "requirement at after since",
        "requirement at most 2 most since at",
    ]


LIBRARY = """library Arms {
    component Arm {
        incoming message grip with type: none
        incoming message place with type: none
        requirement O1: place after each grip
        requirement Held: automaton {
            initial state no { on request to grip goto yes }
            state yes { on request to place goto no }
        }
        requirement never Held.no and Held.yes
        requirement place needs Held.yes
        property reachable Held.yes
    }
}"""


def test_each_instance_of_a_component_of_a_library_has_its_own(tmp_path: Path) -> None:
    """Requirements may be in components, also in libraries; `Left.O1` is that of the instance."""
    (tmp_path / "arms.rscd").write_text(LIBRARY, encoding="utf-8")
    left, right = (
        f'component {name} from Arms import Arm with {{ grip: "/{name}/grip", place: "/{name}/place" }}'
        for name in ("Left", "Right")
    )
    between = "requirement at most 2 { Left.place, request to Right.place } since Left.grip"
    findings, made = read_robot(tmp_path, left, right, between, arm="")
    assert findings == []
    supervise(made)
    assert [plant.name for plant in made.plants if plant.kind == sct.PlantKind.requirement] == [
        "requirement_1",
        "requirement_Left_O1",
        "requirement_Left_Held",
        "requirement_Right_O1",
        "requirement_Right_Held",
    ]
    assert [invariant.text for invariant in made.invariants] == ["requirement never Held.no and Held.yes"] * 2
    engine = Engine(made)
    engine.perform("message_Left_grip.c_trigger")
    assert engine.enabled("message_Left_place.c_trigger")
    assert not engine.enabled("message_Right_place.c_trigger")


def test_format_keeps_what_is_laid_out() -> None:
    laid_out = """robot R {
  requirement O1 "one each": { place, response from dock } after each grip
  requirement at most 3 dock since response from undock
  requirement Turns: automaton {
    initial state mine {
      on request to grip if Gate.open goto yours
    }
    state yours {}
  }
}
"""
    assert format_text(Text("robot.rscd", laid_out)) == (laid_out, [])
