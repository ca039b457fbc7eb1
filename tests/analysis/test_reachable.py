"""`requirement reachable`, from the text to the output for users. `SENTENCES` lists the tests of each statement."""

import json
import re
from pathlib import Path

import pytest
from click.testing import CliRunner
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from pygments.token import Token

import robosc
from robosc.analysis.explain.as_json import data_of
from robosc.analysis.explain.as_text import Renderer
from robosc.analysis.explain.explanations import emptiness, explore, possibility
from robosc.analysis.explain.names import find_event
from robosc.analysis.supervise import EmptySupervisorError, supervise
from robosc.analysis.system import GuardedSystem
from robosc.analysis.verify import Outcome, Verdict, validate_cif, validate_model, verify_system
from robosc.analysis.verify.properties import goal_reachable
from robosc.base.ros_types import RosTypes
from robosc.language.cif import read as read_cif
from robosc.language.completion import proposals
from robosc.language.configuration import Configuration
from robosc.language.formatting import format_text
from robosc.language.highlighting.pygments_lexer import RoboscLexer
from robosc.language.hover import describe
from robosc.language.reading import read
from robosc.language.text import Text
from robosc.m2t import cif
from robosc.m2t.models import Models
from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.walks import copy_tree
from robosc.synthesis import count, synthesize, use_encoding
from robosc.synthesis.encoding import Encoding
from robosc.tools.cli import main
from tests.analysis.verify.explicit import Explicit
from tests.language.second_edition import errors
from tests.random_sct import sct_models
from tests.sct_models import Reachable, edge, plant
from tests.sct_models import model as model_of
from tests.searching import examples
from tests.synthesis.oracle import Oracle, State

SENTENCES = {
    "In every reachable state with the premise, a state with the condition can be reached.": (
        "test_the_supervisor_keeps_the_states_reachable",
        "test_verify_refutes_a_guard_that_strands_the_robot",
        "test_verify_against_an_explicit_search",
    ),
    "Without a premise, this holds in every reachable state.": ("test_the_supervisor_keeps_the_states_reachable",),
    "As with marking, some values of inputs suffice.": ("test_some_values_of_inputs_suffice",),
    "Synthesis stays maximally permissive.": (
        "test_the_supervisor_keeps_the_states_reachable",
        "tests/synthesis/test_against_oracle.py::test_random_models",
    ),
    "`explain --why-never` knows it.": (
        "test_why_never_names_the_requirement",
        "test_every_explanation_of_random_models_holds",
    ),
    "`explain --why-empty` knows it.": ("test_why_empty_names_the_requirement",),
    "In CIF, it is an annotation on the specification, with `from` as a named argument.": (
        "test_cif_has_an_annotation",
        "test_verify_refutes_another_annotation",
    ),
    "CIF import reads it.": ("test_the_written_annotation_is_read_again", "test_names_of_an_annotation_in_cif"),
    "`transform --to cif` warns about tools before version 10.": ("test_older_tools_lead_to_a_warning",),
    "The supervised file holds the guards.": ("test_cif_has_an_annotation",),
    "The words stay names.": ("test_both_words_stay_names",),
    "It works in each view.": (
        "test_checks",
        "test_format",
        "test_hover",
        "test_highlighting",
        "test_completion",
        "test_xmi",
        "test_the_second_reading_finds_another_condition",
        "test_the_report_lists_it",
        "test_synthesize_prints_its_weight",
    ),
}
ROVER = """robot Rover {{
  component Battery {{
    outgoing message low with type: none
    incoming message charge with type: none
    behaviour {{
      initial marked state full {{ on response from low goto flat }}
      marked state flat {{ on response from low on request to charge goto full }}
    }}
  }}
  component Base {{
    incoming message leave with type: none
    incoming message venture with type: none
    incoming message back with type: none
    incoming message park with type: none
    behaviour {{
      initial marked state docked {{ on request to leave goto near }}
      marked state near {{ on request to venture goto far on request to park goto docked }}
      marked state far {{ on request to back goto near }}
    }}
  }}
  requirement charge needs Base.docked
  requirement back needs Battery.full
  {}
}}"""
HOME = 'requirement R1 "can always get home": reachable Base.docked from Battery.flat'


def rover(*requirements: str) -> sct.SupervisoryControlModel:
    text = ROVER.format("\n  ".join(requirements))
    assert errors(text) == []
    return robosc.to_sct(robosc.load(text=text))


def states(model: sct.SupervisoryControlModel) -> int:
    return synthesize(model).controlled_states


def explained(model: sct.SupervisoryControlModel, event: str | None = None) -> str:
    def answer(system):
        return emptiness(system) if event is None else possibility(system, find_event(model, event))

    return explore(model, lambda system: Renderer(model, lambda _: "R.rscd").answer(answer(system)))


def test_each_sentence_has_its_tests() -> None:
    for name in (name for names in SENTENCES.values() for name in names):
        path, _, function = name.rpartition("::")
        source = Path(path or __file__).read_text(encoding="utf-8")
        assert f"def {function}(" in source


@pytest.mark.parametrize(
    ("requirement", "left"),
    [
        ("", 6),
        ("requirement reachable Base.docked", 4),
        (HOME, 4),
        # The battery may become flat there, but from each state with a full one there is a way.
        ("requirement reachable Base.docked from Battery.full", 6),
        ("requirement reachable Base.far from Battery.full", 6),
    ],
)
def test_the_supervisor_keeps_the_states_reachable(requirement: str, left: int) -> None:
    model = rover(requirement)
    assert states(model) == left
    supervise(model)
    possible = {guard.event.eContainer().origin for guard in model.supervisor.guards if guard.everEnabled}
    assert ("Base.venture" in possible) == (left == 6)


def test_states_without_a_goal_are_removed_until_none_is_left() -> None:
    """Without `b`, which never reaches `g`, the robot does not reach a marked state from `a`."""
    text = """robot R { component C {
        incoming message go with type: none
        incoming message up with type: none
        incoming message hi with type: none
        behaviour {
            initial state a { on request to go goto b }
            state b { on request to up goto m }
            marked state m {}
            state g { on request to hi goto g }
        }
        requirement R1: reachable C.g from C.b
    } }"""
    model = robosc.to_sct(robosc.load(text=text))
    assert states(model) == count(model).controlled_states == 0
    with pytest.raises(EmptySupervisorError, match="the supervisor is empty"):
        supervise(model)


def test_some_values_of_inputs_suffice() -> None:
    text = """robot R { component Dial {
        outgoing message told with type: integer(0..9)
        behaviour {
            variable level: integer(0..9)
            initial marked state on { on response from told do level := value }
        } } requirement reachable Dial.level = 7 }"""
    assert states(robosc.to_sct(robosc.load(text=text))) == 10


@pytest.mark.parametrize(
    "definition",
    [
        "requirement reachable needs Thing.here",
        "requirement reachable after other",
        "requirement reachable: Thing.here disables other",
        'requirement reachable "text": never Thing.here and Thing.^from',
        "property reachable: reachable Thing.here from Thing.^from",
        "requirement reachable: reachable Thing.here from Thing.^from",
        "condition reachable = Thing.here requirement reachable disables other",
        "condition reachable = Thing.here requirement reachable reachable from reachable",
    ],
)
def test_both_words_stay_names(definition: str) -> None:
    text = """robot R {{
      component Thing {{
        incoming message reachable with type: none
        incoming message other with type: none
        behaviour {{
          initial marked state here {{ on request to other goto from }}
          marked state from {{ on request to reachable goto here on request to other }}
        }}
      }}
      {}
    }}"""
    assert errors(text.format(definition)) == []


@pytest.mark.parametrize(
    ("requirement", "rule"),
    [
        ("requirement reachable 1", "type"),
        ("requirement reachable Base.docked from 1", "type"),
        ("requirement reachable Base.nowhere", "unresolved-reference"),
        ("requirement reachable value = 1", "type"),
        ("requirement reachable", "syntax"),
        ("requirement R: reachable Base.docked requirement R: reachable Base.far", "unique-component"),
    ],
)
def test_checks(requirement: str, rule: str) -> None:
    assert rule in [name for name, _ in errors(ROVER.format(requirement))]


def test_format() -> None:
    text = ROVER.format(HOME.replace(": ", ":").replace(" from", "\n from"))
    formatted, _ = format_text(Text("robot.rscd", text))
    assert formatted is not None
    assert f"  {HOME}\n" in formatted
    assert format_text(Text("robot.rscd", formatted))[0] == formatted


def test_hover(tmp_path: Path) -> None:
    reading = read(written(tmp_path, HOME))
    shown = describe(reading, reading.base.definitions[-1], RosTypes())
    assert "From every state with `Battery.flat`, the supervised robot can reach a state with `Base.docked`." in shown


def test_highlighting() -> None:
    tokens = list(RoboscLexer().get_tokens(f"robot R {{ {HOME} requirement reachable needs reachable }}"))
    assert [kind for kind, text in tokens if text == "reachable"] == [Token.Keyword, Token.Name, Token.Name]
    assert [kind for kind, text in tokens if text == "from"] == [Token.Keyword]


@pytest.mark.parametrize(
    ("before", "word"), [("requirement ", "reachable"), ("requirement reachable Base.docked ", "from")]
)
def test_completion(tmp_path: Path, before: str, word: str) -> None:
    text = ROVER.format(before)

    def reading(content: str):
        path = tmp_path / "robot.rscd"
        path.write_text(content, encoding="utf-8")
        return read(path)

    *_, results = proposals(text, text.rindex(before) + len(before), reading, RosTypes(), list)
    assert word in [proposal.text for proposal in results]


def written(folder: Path, *requirements: str) -> Path:
    path = folder / "robot.rscd"
    path.write_text(ROVER.format("\n  ".join(requirements)), encoding="utf-8")
    return path


def ran(*arguments: object) -> str:
    done = CliRunner().invoke(main, list(map(str, arguments)))
    assert done.exit_code == 0, done.output
    return done.stdout


def test_xmi(tmp_path: Path) -> None:
    ran("transform", written(tmp_path, HOME), "--to", "xmi,cif", "-o", tmp_path / "first")
    ran("transform", tmp_path / "first" / "Rover.sct.xmi", "--to", "xmi,cif", "-o", tmp_path / "second")
    for name in ("Rover.sct.xmi", "Rover.cif", "Rover.supervised.cif"):
        first, second = (tmp_path / folder / name for folder in ("first", "second"))
        assert first.read_bytes() == second.read_bytes()


def test_synthesize_prints_its_weight(tmp_path: Path) -> None:
    printed = ran("synthesize", written(tmp_path, HOME))
    assert "Rover: 4 states, of 6 without requirements" in printed
    assert f"`{HOME}` (line 23)\n    forbids 1 state" in printed


def test_the_report_lists_it(tmp_path: Path) -> None:
    done = CliRunner().invoke(main, ["report", str(written(tmp_path, HOME)), "--json"])
    report = json.loads(done.stdout)
    (entry,) = [entry for entry in report["requirements"] if entry["name"] == "R1"]
    assert entry["kind"] == "state requirement"
    assert [verdict["outcome"] for verdict in entry["verdicts"]] == ["proved"]


# explain


def test_why_never_names_the_requirement() -> None:
    answer = explained(rover(HOME), "venture")
    assert f"and then `{HOME}` cannot be satisfied: no state with `Base.docked` can be reached" in answer
    assert "R.rscd: " + HOME + "\n    needs a way to a state with `Base.docked`" in answer
    assert "R.rscd: requirement back needs Battery.full\n    forbids the request to `Base.back`" in answer
    assert (
        "To allow it, give the robot a way from there to a state with `Base.docked`, or loosen the requirement."
        in answer
    )
    assert f"R.rscd: {HOME} (6 states without it)" in answer


@pytest.mark.parametrize(
    ("requirements", "reason"),
    [
        (
            ["requirement R1: reachable Base.far", "requirement Base.near disables venture"],
            (
                "{} cannot be satisfied: no state with `Base.far` can be reached: the shortest way to one needs request"
                " to `Base.venture` where `requirement Base.near disables venture` forbids it"
            ),
        ),
        (
            ["requirement R1: reachable Base.far", "requirement never Base.near"],
            (
                "{} cannot be satisfied: no state with `Base.far` can be reached: the shortest way to one needs request"
                " to `Base.leave`, after which `requirement never Base.near` is violated"
            ),
        ),
        (
            ["requirement R1: reachable Base.far and Base.near"],
            "{} cannot be satisfied: no state with `Base.far and Base.near` can be reached from the start",
        ),
        (
            ["requirement R1: reachable Battery.full", "requirement charge needs false"],
            (
                "response from `Battery.low` cannot be prevented, and after it {} cannot be satisfied: no state with"
                " `Battery.full` can be reached"
            ),
        ),
    ],
)
def test_why_empty_names_the_requirement(requirements: list[str], reason: str) -> None:
    model = rover(*requirements)
    with pytest.raises(EmptySupervisorError) as raised:
        supervise(model)
    (found,) = raised.value.diagnostics
    message = re.sub(r" \(line \d+\)", "", found.message)
    assert message.startswith(f"the supervisor is empty: {reason.format(f'`{requirements[0]}`')}")
    assert f"R.rscd: {requirements[0]} (" in explained(model)


@pytest.mark.slow
@given(sct_models(requirements=True, goals=True))
@settings(
    max_examples=examples(20), deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large]
)
def test_every_explanation_of_random_models_holds(model: sct.SupervisoryControlModel) -> None:
    """Every question has an answer, and leaving out the requirements that help gives the counted states."""
    oracle = Oracle(model)

    def look(system):
        assert (emptiness(system) is None) == bool(oracle.controlled)
        for event in system.relations if oracle.controlled else ():
            answer = possibility(system, event)
            assert answer.possible == any(oracle.allows(event, state) for state in oracle.controlled)
            assert Renderer(model, lambda _: "").answer(answer)
            assert data_of(answer, lambda _: {})

    explore(model, look)
    if oracle.controlled:
        assert supervise(model).synthesis.controlled_states == len(oracle.controlled)


# CIF


@pytest.mark.parametrize(
    ("requirement", "arguments"),
    [
        (HOME, "component_Base.docked, from: component_Battery.flat"),
        ("requirement reachable !Base.far", "not component_Base.far"),
        ("requirement reachable (Base.docked)", "component_Base.docked"),
    ],
)
def test_cif_has_an_annotation(requirement: str, arguments: str) -> None:
    model = rover(requirement)
    supervise(model)
    files = cif.generate(Models(model), Configuration())
    annotation = f"@@requirement:reachable({arguments})\n"
    assert annotation in files["Rover.cif"]
    assert "@@requirement" not in files["Rover.supervised.cif"]
    assert validate_cif(model, files).outcome is Outcome.PROVED
    misplaced = {**files, "Rover.supervised.cif": annotation + files["Rover.supervised.cif"]}
    assert "no supervised specification has" in validate_cif(model, misplaced).explanation


@pytest.mark.parametrize(
    ("old", "new", "explanation"),
    [
        ("component_Base.docked,", "component_Base.near,", "a requirement about reachable states differs in the state"),
        ("from: component_Battery.flat", "from: component_Battery.full", "differs in the state"),
        (", from: component_Battery.flat", "", "differs in the state"),
        ("@@requirement:reachable(component_Base.docked, from: component_Battery.flat)", "", "0 requirements about"),
        ("component_Battery.flat)", "component_Battery.flat", "is wrong: line 3"),
        ("component_Battery.flat)", "component_Battery.flat))", "is wrong: line 3"),
        ("@@requirement:reachable(", "@@requirement:avoidable(", "is wrong: line 3"),
    ],
)
def test_verify_refutes_another_annotation(old: str, new: str, explanation: str) -> None:
    model = rover(HOME)
    supervise(model)
    files = cif.generate(Models(model), Configuration())
    assert files["Rover.cif"].count(old) == 1
    verdict = validate_cif(model, {**files, "Rover.cif": files["Rover.cif"].replace(old, new)})
    assert verdict.outcome is Outcome.REFUTED
    assert explanation in verdict.explanation


@pytest.mark.parametrize(
    ("requirement", "version"), [("requirement reachable Base.docked", "10"), (HOME, "13 or later")]
)
def test_older_tools_lead_to_a_warning(tmp_path: Path, requirement: str, version: str) -> None:
    path = written(tmp_path, requirement)
    done = CliRunner().invoke(main, ["transform", str(path), "--to", "cif", "-o", str(tmp_path / "out")])
    assert done.exit_code == 0
    assert "warning: tools of CIF before version 10 ignore this requirement" in done.output
    assert f"CIF {version}" in done.output


def test_the_written_annotation_is_read_again(tmp_path: Path) -> None:
    (tmp_path / "Rover.cif").write_text(cif.generate(Models(rover(HOME)), Configuration())["Rover.cif"])
    again = read_cif(tmp_path / "Rover.cif")
    assert again.findings == []
    assert states(again.model) == 4


@pytest.mark.parametrize(
    "text",
    [
        "@requirement:reachable(away) plant p: {} end",
        "@@requirement:reachable(p.away) plant p: {} end",
        "@@requirement:reachable(g.p.away,) @requirement:reachable(p.away, from: p.home) group g: plant p: {} end end",
        "@requirement:reachable(away) plant def P(): {} end p: P();",
        "group g: @requirement:reachable(from: true, ^g.p.away) plant p: {} end end",
    ],
)
def test_names_of_an_annotation_in_cif(tmp_path: Path, text: str) -> None:
    """An annotation resolves its names inside the component. Its supervisor forbids the way to `stuck`."""
    body = """controllable go, back, leave;
        location home: initial; marked; edge go goto away; edge leave goto stuck;
        location away: edge back goto home;
        location stuck: marked;"""
    (tmp_path / "p.cif").write_text(text.format(body))
    reading = read_cif(tmp_path / "p.cif")
    assert reading.findings == []
    assert all(required.text.startswith("@") for required in reading.model.reachabilityRequirements)
    assert states(reading.model) == 2


# verify


def of(model: sct.SupervisoryControlModel, requirement: str) -> Verdict:
    return next(verdict for verdict in verify_system(model) if verdict.property.startswith(requirement))


def test_verify_refutes_a_guard_that_strands_the_robot() -> None:
    model = rover(HOME)
    supervise(model)
    assert of(model, HOME).outcome is Outcome.PROVED
    assert of(model, HOME).evidence == "from 2 states to `Base.docked`"
    conditions = {required.event: required.condition for required in model.requirements}
    for guard in model.supervisor.guards:
        guard.synthesis = None
        guard.requirement = copy_tree(conditions[guard.event]) if guard.event in conditions else None
    verdict = of(model, HOME)
    assert verdict.outcome is Outcome.REFUTED
    assert "no state with `Base.docked` can be reached" in verdict.explanation
    assert [step.event for step in verdict.trace] == [
        "message_leave.c_trigger",
        "message_venture.c_trigger",
        "message_low.u_response",
    ]


@pytest.mark.parametrize("feature", ["condition", "premise"])
def test_the_second_reading_finds_another_condition(feature: str) -> None:
    text = ROVER.format(HOME)
    robot, model = robosc.load(text=text), rover(HOME)
    assert validate_model(robot, model).outcome is not Outcome.REFUTED
    (required,) = model.reachabilityRequirements
    setattr(required, feature, ex.Negation(operand=getattr(required, feature)))
    verdict = validate_model(robot, model)
    assert verdict.outcome is Outcome.REFUTED
    assert "of a requirement (line 23) " in verdict.explanation


@pytest.mark.slow
@given(sct_models(requirements=True, goals=True), st.booleans())
@settings(
    max_examples=examples(30), deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large]
)
def test_verify_against_an_explicit_search(model: sct.SupervisoryControlModel, is_complete: bool) -> None:
    """The supervisor of many models lacks the conditions of synthesis, or does not exist."""
    supervisor = synthesize(model).supervisor
    is_complete = is_complete and supervisor is not None
    events = [event for plant in model.plants for event in plant.events if event.controllable]
    guards = [sct.EventGuard(event=event, everEnabled=True) for event in events]
    model.supervisor = supervisor or sct.Supervisor(guards=guards)
    for guard in () if is_complete else model.supervisor.guards:
        guard.synthesis = None
    explicit = Explicit(model)
    assume(len(explicit.states) < 100)

    def holds(condition: ex.Expression | None, state: State) -> bool:
        return explicit.oracle.value(condition, state, {})

    def is_stranded(state: State, required: sct.ReachabilityRequirement) -> bool:
        latest = onwards = {state} if holds(required.pathCondition, state) else set()
        steps = 0
        while latest and steps != required.bound:
            after = {after for here in latest for _, after in explicit.moves(here)} - onwards
            latest = {state for state in after if holds(required.pathCondition, state)}
            onwards = onwards | latest
            steps += 1
        is_due = bool(onwards) and holds(required.premise, state)
        return is_due and not any(holds(required.condition, after) for after in onwards)

    def look(encoding: Encoding) -> list[Verdict]:
        system = GuardedSystem(model, encoding)
        return [goal_reachable(system, required) for required in model.reachabilityRequirements]

    for required, verdict in zip(model.reachabilityRequirements, use_encoding(model, look), strict=True):
        is_refuted = any(is_stranded(state, required) for state in explicit.states)
        assert verdict.outcome is (Outcome.REFUTED if is_refuted else Outcome.PROVED)
        assert not (is_refuted and is_complete)


@pytest.mark.parametrize(
    ("along", "bound", "arguments", "left"),
    [
        ("p.a or p.c", 1, "p.c, stay: p.a or p.c, bound: 1", 3),
        (None, 1, "p.c, bound: 1", 2),
        ("p.a or p.c", None, "p.c, stay: p.a or p.c", 3),
    ],
)
def test_the_path_is_written_and_read_again(
    tmp_path: Path, along: str | None, bound: int | None, arguments: str, left: int
) -> None:
    locations = {
        "a": [edge("c_trigger", "b"), edge("c_tau1", "c")],
        "b": [edge("c_reset", "a")],
        "c": [edge("c_reset", "a")],
    }
    events = ["c_trigger", "c_tau1", "c_reset"]
    made = model_of(
        [plant("p", locations, controllable=events, marked=["a", "b", "c"])],
        (),
        reachable=[Reachable("p.c", None, along, bound)],
    )
    made.supervisor = synthesize(made).supervisor
    files = cif.generate(Models(made), Configuration())
    assert f"@@requirement:reachable({arguments})" in files["robot.cif"]
    (tmp_path / "robot.cif").write_text(files["robot.cif"])
    assert made.supervisor.controlledStates == left
    assert count(read_cif(tmp_path / "robot.cif").model).controlled_states == left
    assert validate_cif(made, files).outcome is Outcome.PROVED
    made.reachabilityRequirements[0].bound = 9
    assert "has another bound in" in validate_cif(made, files).explanation
