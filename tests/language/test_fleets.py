"""Fleets of instances: each sentence of the specification's section 6, with the test that holds it."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from click.testing import CliRunner

import robosc
from robosc.analysis.verify import validate_model
from robosc.analysis.verify.verdict import Outcome
from robosc.base.ros_types import RosTypes
from robosc.language.checks import check
from robosc.language.completion import proposals
from robosc.language.configuration import Configuration
from robosc.language.hover import describe
from robosc.language.reading import read
from robosc.language.semantic_tokens import classify
from robosc.language.text import Documents
from robosc.model import robosc as robosc_model
from robosc.model import sct
from robosc.model.semantics import instances as semantics
from robosc.tools.cli import main
from tests.language.second_edition import errors, requirements, running, supervised

if TYPE_CHECKING:
    from robosc.language.reading import Reading

#: Sentences of section 6, each with the test that holds it, or the folder of models that do.
SENTENCES = {
    "`component NAME[a..b] is …`, or `from … import …`, makes the instances": "test_a_fleet_equals_its_instances",
    "`a`, `b` are integer constants, `0 <= a <= b`, at most 1,000 instances": "checks/rejected/integer-range",
    "in all output, and for `unique-component`, they are named `NAMEa`": "test_output_names_instances_without_brackets",
    "`NAME` itself is taken, too": "checks/rejected/unique-component",
    "in models only `NAME[i]` with a constant expression `i` names one": "test_an_index_is_a_constant_expression",
    "`argument` where there is none": "checks/rejected/argument",
    "scenarios, scripts and configuration take `NAME[i]` and `NAMEi`": "test_files_take_both_names",
    "an index after the name of a fleet is an instance": "test_an_index_behind_a_fleet_is_an_instance",
    "`number` is the instance's number, whatever else has the name": "test_number_hides_other_names",
    "`text(i)` makes a string of a constant integer, in any constant string": "test_text_in_each_constant_string",
    "a user's own function `text` wins": "test_an_own_function_text_wins",
    "`each T:` writes the body once for every instance": "test_each_equals_the_requirements_written_out",
    "`T` stands for the instance": "test_each_equals_the_requirements_written_out",
    "an inner `all`, `any`, `count` ranges over all instances anew": "test_an_inner_quantifier_ranges_anew",
    "a named requirement becomes `NAME[Cell2]`": "test_the_name_holds_the_instance",
    "`NAME` is unique as any name": "test_the_name_is_unique",
    "a state is read as `NAME.state` inside, elsewhere as `NAME[Cell[2]].state`": "test_states_of_automata_with_each",
    "`each` is a keyword only before a name and a colon": "test_each_stays_a_name",
    "`each` over an own component that is no template is `argument`": "checks/rejected/argument",
}
STATION = """component Station(ns: string, most: integer = 1) {
    outgoing message done with identifier: ns + "/done", type: none
    incoming message enter with identifier: ns + "/enter", type: none
    behaviour {
      variable used: integer(0..most)
      initial marked state outside { on request to enter goto inside }
      state inside { on response from done do used := used + 1 goto outside }
    }
  }
  component Gate {
    outgoing message open with type: none
    outgoing message shut with type: none
    behaviour {
      initial marked state free { on response from shut goto closed }
      state closed { on response from open goto free }
    }
  }"""
FLEET = 'component Cell[1..3] is Station("/cell" + text(number), most: number)'
WRITTEN = " ".join(f'component Cell{number} is Station("/cell{number}", most: {number})' for number in (1, 2, 3))


def robot(*parts: str) -> str:
    return f"robot R {{ {STATION} {' '.join(parts)} }}"


def images(model: sct.SupervisoryControlModel) -> list[object]:
    """Return what a model permits: its plants with their topics, its requirements, its invariants and properties."""
    plants = [(plant.name, plant.origin, plant.topic) for plant in model.plants]
    return [plants, *(part.text for part in stated(model))]


def stated(model: sct.SupervisoryControlModel) -> list[Any]:
    """Return the requirements, assumptions and properties of a model."""
    assumptions = [plant for plant in model.plants if plant.kind == sct.PlantKind.assumption]
    return [
        *model.requirements, *model.invariants, *model.reachabilityRequirements, *model.properties, *assumptions
    ]  # fmt: skip


def test_each_sentence_has_a_test() -> None:
    for place in SENTENCES.values():
        fleets = Path(__file__).parent / place
        assert place in globals() or any("fleet" in path.name for path in fleets.glob("*.rscd")), place


def test_a_fleet_equals_its_instances() -> None:
    reads = "requirement Cell{0}.enter needs Gate.free and Cell{1}.outside"
    fleet = supervised(robot(FLEET, reads.format("[3]", "[1]")))
    assert images(fleet) == images(supervised(robot(WRITTEN, reads.format("3", "1"))))
    assert [plant.topic for plant in fleet.plants if plant.topic][2:5] == ["/cell1/done", "/cell1/enter", "/cell2/done"]


def test_a_fleet_of_a_library(tmp_path: Path) -> None:
    text = """robot R {
      component Stop[0..1] from EmergencyStopLibrary import EmergencyStop
        with { stop: "/stop" + text(number), continue: "/go" + text(number) }
      component Base { incoming message move with type: none }
      requirement each EmergencyStop: move needs EmergencyStop.in_service
    }"""
    path = tmp_path / "robot.rscd"
    path.write_text(text)
    model = robosc.to_sct(robosc.load(path))
    assert [plant.topic for plant in model.plants][:2] == ["/stop0", "/go0"]
    assert [requirement.text for requirement in model.requirements] == [
        "requirement move needs Stop0.in_service",
        "requirement move needs Stop1.in_service",
    ]


def test_output_names_instances_without_brackets() -> None:
    model = supervised(robot(FLEET, "requirement Cell[2].enter needs Cell[1].outside"))
    assert {"component_Cell1", "message_Cell2_enter"} <= {plant.name for plant in model.plants}
    assert [requirement.text for requirement in model.requirements] == ["requirement Cell2.enter needs Cell1.outside"]


@pytest.mark.parametrize("number", [1, 3])
def test_each_fault_of_a_fleet_is_reported_once(tmp_path: Path, number: int) -> None:
    """Two faults are two findings, also at one line, and a fault of several instances is one."""
    (tmp_path / "Lib.rscd").write_text(
        """library Lib {
          component Arm {
            service grip1 with identifier: "/grip", request: none, response: none
            service grip2 with identifier: "/drop", request: none, response: none
            outgoing message ok with identifier: "/ok", type: none
            behaviour {
              initial marked state still { on request to grip1 goto closing on request to grip2 goto opening }
              state closing { on response from ok goto still }
              state opening { on response from ok goto still }
            }
          }
        }"""
    )
    (tmp_path / "robot.rscd").write_text(
        f"""robot R {{
          component Hand[1..{number}] from Lib import Arm
            with {{ grip1: "/g" + text(number), grip2: "/d" + text(number), ok: "/o" + text(number) }}
          requirement each Arm: {{ Arm.grip1, Arm.grip2 }} needs Arm.still
        }}"""
    )
    messages = [finding.message for finding in robosc.check(robosc.load(tmp_path / "robot.rscd"))]
    starts = ["`Hand1` goes to `closing` with the request to `grip1`", "`Hand1` goes to `opening` with the request"]
    assert [message[: len(start)] for message, start in zip(messages, starts, strict=True)] == starts


def test_a_topic_of_several_instances_is_reported_once() -> None:
    """The topics of the instances differ in their number."""
    others = " ".join(f'component Other{at} is Station("/cell{at}")' for at in (1, 2, 3))
    findings = robosc.check(robosc.load(text=robot(others, FLEET)))
    messages = [finding.message for finding in findings if finding.rule == "unique-topic"]
    names = [f"`done` of `Cell{at}` and `done` of `Other{at}` share the topic `/cell{at}/done`" for at in (1, 2, 3)]
    assert [any(name in message for message in messages) for name in names] == [True, True, True]
    twins = 'component Pair[1..3] is Station("/cell" + text(number))'
    findings = robosc.check(robosc.load(text=robot(FLEET, twins)))
    [message] = [finding.message for finding in findings if finding.rule == "unique-topic"]
    assert "`done` of `Pair1` and `done` of `Cell1` share the topic `/cell1/done`" in message


@pytest.mark.parametrize("uses", ["component Cell[1..300] is Station(ns: text(number))", WRITTEN])
def test_a_name_of_a_template_is_reported_once(uses: str) -> None:
    lone = "component Lone { incoming message enter with type: none }"
    assert [rule for rule, _ in errors(robot(lone, uses))] == ["unique-communication"]


def test_an_index_is_a_constant_expression() -> None:
    text = robot(
        "constant last: integer = 3", FLEET, "requirement Cell[last - 1].enter needs Cell[min(last, 9)].used = 0"
    )
    assert requirements(text) == ["requirement Cell2.enter needs Cell3.used = 0"]


def test_an_index_may_be_a_parameter_of_a_template() -> None:
    wheel = """component Wheel(ns: string, at: integer) {
      incoming message turn with identifier: ns + "/turn", type: none
      behaviour { initial marked state still { on request to turn } }
      requirement turn needs Cell[at + 1].outside
    }"""
    text = robot(FLEET, wheel, 'component Wheels[0..2] is Wheel("/wheel" + text(number), number)')
    assert requirements(text) == [f"requirement Wheels{at}.turn needs Cell{at + 1}.outside" for at in range(3)]
    assert outcomes(text) == {Outcome.PROVED}


def test_an_index_behind_a_fleet_is_an_instance() -> None:
    own = """component Own {
      incoming message go with type: none
      outgoing message seen with type: std_msgs/Float64MultiArray
      behaviour {
        variable Cell: array(double)
        initial marked state on_way { on request to go on response from seen }
      }
      requirement go needs Cell[2].outside
    }"""
    assert requirements(robot(FLEET, own)) == ["requirement go needs Cell2.outside"]


def test_number_hides_other_names() -> None:
    text = robot("constant number: integer = 7", FLEET, "requirement Cell[number - 5].enter needs Gate.free")
    topics = [plant.topic for plant in supervised(text).plants if plant.topic]
    assert topics[2:5] == ["/cell1/done", "/cell1/enter", "/cell2/done"]
    assert requirements(text) == ["requirement Cell2.enter needs Gate.free"]


def test_text_in_each_constant_string() -> None:
    text = """robot R {
      constant seven: integer = 7
      constant name: string = "n" + text(seven)
      component A(ns: string = "d" + text(1), at: integer = 2) {
        outgoing message a with identifier: "/" + text(at) + ns, type: string
        outgoing message b with identifier: name + ns, type: none
        behaviour {
          variable kept: string = text(seven - 8)
          initial marked state here { on response from a do kept := value }
        }
      }
      component B is A()
      component C is A(text(0))
    }"""
    topics = [plant.topic for plant in supervised(text).plants if plant.topic]
    assert topics[:4] == ["/2d1", "n7d1", "/20", "n70"]
    graph = robosc.to_rosgraph(robosc.load(text=text))
    assert {variable.initial.value for variable in graph.variables} == {"-1"}  # type: ignore[union-attr]


def test_an_own_function_text_wins() -> None:
    text = robot('function text(i: integer): string = "own"', 'component Cell[1..1] is Station("/" + text(number))')
    assert [plant.topic for plant in supervised(text).plants if plant.topic][2:] == ["/own/done", "/own/enter"]


EACH = [
    "requirement{name} {each}{T}.enter needs Gate.free and {T}.used = 0",
    "requirement{name} {each}{T}.inside disables {T}.enter",
    "requirement{name} {each}never {T}.inside and {T}.outside",
    "requirement{name} {each}{T}.enter after each response from {T}.done",
    "requirement{name} {each}at most {T2} {T}.enter since response from {T}.done",
    "requirement{name} {each}reachable {T}.outside from {T}.inside",
    "assume{name} {each}response from {T}.done needs {T}.inside",
    "property{name} {each}reachable {T}.inside from Gate.free",
    "property{name} {each}always {T}.used < 4",
]


@pytest.mark.parametrize("form", EACH)
def test_each_equals_the_requirements_written_out(form: str) -> None:
    each = form.format(name="", each="each Station: ", T="Station", T2="2")
    instances = " ".join(form.format(name="", each="", T=f"Cell{number}", T2="2") for number in (1, 2, 3))
    assert images(supervised(robot(FLEET, each))) == images(supervised(robot(WRITTEN, instances)))


@pytest.mark.parametrize("form", EACH)
def test_the_name_holds_the_instance(form: str) -> None:
    text = form.format(name=' N "why":', each="each Station: ", T="Station", T2="2")
    model = supervised(robot(FLEET, text))
    names = [getattr(part, "origin", None) or part.name for part in stated(model)]
    assert list(dict.fromkeys(name for name in names if name)) == ["N[Cell1]", "N[Cell2]", "N[Cell3]"]


def test_the_name_is_unique() -> None:
    text = "requirement N: each Station: Station.enter needs Gate.free requirement N: never Gate.free and Gate.closed"
    assert [rule for rule, _ in errors(robot(FLEET, text))] == ["unique-component"]


def test_an_inner_quantifier_ranges_anew() -> None:
    text = "requirement each Station: Station.enter needs (count Station: Station.inside) < 2"
    engine = running(robot(FLEET, text, 'component Extra is Station("/extra")'))
    engine.perform("message_Cell1_enter.c_trigger")
    assert engine.enabled("message_Extra_enter.c_trigger")
    engine.perform("message_Extra_enter.c_trigger")
    assert not engine.enabled("message_Cell2_enter.c_trigger")


AUTOMATON = """requirement Turns: each Station: automaton {
    initial state mine { on request to Station.enter goto yours on response from Gate.open }
    state yours { on response from Gate.open goto mine }
  }"""


def test_states_of_automata_with_each() -> None:
    reads = (
        "requirement each Station: Station.enter needs Turns.mine requirement Cell[1].enter needs Turns[Cell[2]].mine"
    )
    text = robot(FLEET, AUTOMATON, reads)
    engine = running(text)
    assert engine.enabled("message_Cell1_enter.c_trigger")
    engine.perform("message_Cell2_enter.c_trigger")
    assert not engine.enabled("message_Cell1_enter.c_trigger")
    assert engine.enabled("message_Cell3_enter.c_trigger")
    assert requirements(text)[:4] == [
        *(f"requirement Cell{at}.enter needs Turns[Cell{at}].mine" for at in (1, 2, 3)),
        "requirement Cell1.enter needs Turns[Cell2].mine",
    ]
    assert outcomes(text) == {Outcome.PROVED}


def test_automata_of_each_in_an_inner_quantifier() -> None:
    """In an inner quantifier, the template and the states of its automata belong to the quantified instance."""
    text = robot(FLEET, AUTOMATON, "requirement each Station: Station.enter needs (count Station: Turns.yours) < 1")
    engine = running(text)
    engine.perform("message_Cell2_enter.c_trigger")
    assert not engine.enabled("message_Cell1_enter.c_trigger")
    assert outcomes(text) == {Outcome.PROVED}


OWN = """requirement D: each Station: Station.enter needs (count Station: Station.inside) < 2 and Station.outside
    requirement A: each Station: automaton {
      initial marked state first { on request to Station.enter goto second }
      state second { on request to enter goto first }
    }
    requirement each Station: enter needs A.first or (any Station: A.second)
    requirement enter needs A[Cell[2]].first or A[Cell[1]].second
    property P: each Station: reachable Station.inside
    assume each Station: Station.done needs Station.inside"""


def test_each_of_a_template_in_its_own_text() -> None:
    """There, the template is the instance whose text it is: `each` writes the definition once for each instance."""
    own = robot(FLEET).replace("behaviour {", f"{OWN} behaviour {{", 1)
    model = supervised(own)
    assert [part.text for part in model.requirements if part.name and "D" in part.name] == [
        f"requirement Cell{at}.D[Cell{at}]: Cell{at}.enter needs (count Station: Station.inside) < 2"
        f" and Cell{at}.outside"
        for at in (1, 2, 3)
    ]
    assert [part.text for part in model.properties] == [
        f"property Cell{at}.P[Cell{at}]: reachable Cell{at}.inside" for at in (1, 2, 3)
    ]
    assert len([part for part in stated(model) if not isinstance(part, sct.Requirement)]) == 6
    assert len(model.requirements) == 9
    assert outcomes(own) == {Outcome.PROVED}


def test_each_in_a_component() -> None:
    """A requirement in a component has the name of the component before its own."""
    door = """component Door {
      incoming message unlock with type: none
      requirement D: each Station: unlock needs Station.outside
    }"""
    model = supervised(robot(FLEET, door))
    assert [requirement.name for requirement in model.requirements] == [f"Door.D[Cell{at}]" for at in (1, 2, 3)]


def outcomes(text: str) -> set[Outcome]:
    """Return the outcome of the second reading of a robot's text."""
    robot_model = robosc.load(text=text)
    model = robosc.to_sct(robot_model)
    robosc.synthesize(model)
    return {validate_model(robot_model, model).outcome}


def test_each_stays_a_name() -> None:
    """`each`, `number` and `text` are names wherever they were; test_new_words.py holds the other places."""
    text = """robot R {
      component each { incoming message text with type: none outgoing message number with type: integer(0..3)
        behaviour {
          variable text_: integer(0..3)
          initial marked state each { on response from number do text_ := value }
        }
      }
      requirement each: text needs each.text_ = 1
      requirement number: text after each number
      property each_: reachable each.each
      property text "each": always each.text_ < 4
    }"""
    assert errors(text) == [("unique-component", 8)]  # the component and the requirement, as ever
    assert errors(text.replace("requirement each:", "requirement")) == []


def test_each_with_an_inner_quantifier_costs_one_expansion() -> None:
    """The written-out requirements have the expanded quantifier in common."""
    text = "requirement each Station: Station.enter needs Station.outside and (count Station: Station.inside) < 2"

    def cost(number: int) -> int:
        steps = 0

        def counted(_frame: object, event: str, _argument: object) -> None:
            nonlocal steps
            steps += event == "call"

        model = robosc.load(text=robot(f'component Cell[1..{number}] is Station("/cell" + text(number))', text))
        before = sys.getprofile()
        sys.setprofile(counted)
        try:
            robosc.check(model)
        finally:
            sys.setprofile(before)
        return steps

    cost(2)  # load modules once, before counting
    short, long = cost(20), cost(80)
    assert long < 7 * short


LIBRARY = """library Arms {
  component Arm(ns: string) {
    incoming message move with identifier: ns + "/move", type: none
    outgoing message ok with identifier: ns + "/ok", type: none
    behaviour {
      initial marked state still { on request to move goto moving }
      state moving { on response from ok goto still }
    }
  }
  component Gate {
    outgoing message opened with type: none
    behaviour { initial marked state free { on response from opened } }
  }
  component Lone is Arm("/lone")
  ASSUMPTION
}"""


def test_each_of_a_template_in_a_library(tmp_path: Path) -> None:
    """The assumption holds for each import of the template, and of a component that is one."""
    assumption = "assume A: each Arm: Arm.ok needs Arm.moving"
    (tmp_path / "Arms.rscd").write_text(LIBRARY.replace("ASSUMPTION", assumption))
    path = tmp_path / "robot.rscd"
    path.write_text(
        """robot R {
          component Hand[1..2] from Arms import Arm("/hand" + text(number))
          component Third from Arms import Lone
          component Way from Arms import Gate
        }"""
    )
    robot_model = robosc.load(path)
    model = robosc.to_sct(robot_model)
    robosc.synthesize(model)
    assert [plant.text for plant in model.plants if plant.text] == [
        f"assume {name}.A[{name}]: {name}.ok needs {name}.moving" for name in ("Hand1", "Hand2", "Third")
    ]
    assert validate_model(robot_model, model).outcome is Outcome.PROVED


@pytest.mark.parametrize(
    ("assumption", "message", "hint"),
    [
        (
            "assume each Arm: Arm.ok needs Gate.free",
            "this assumption is about `Arm` and `Gate`, expected one component: each import of it has the assumption",
            "write it in the robot",
        ),
        (
            "assume Lone.ok needs Lone.moving",
            "`Lone` takes its text from another component, expected a component with a text of its own",
            "begin it with `each Arm:`, or write it in the robot",
        ),
    ],
)
def test_an_assumption_of_a_library_that_no_import_could_have(assumption: str, message: str, hint: str) -> None:
    text = LIBRARY.replace("ASSUMPTION", assumption)
    reading = read("Arms.rscd", documents=Documents({"Arms.rscd": text}))
    findings = [*reading.findings, *check(reading.base, reading.findings)]
    assert [(finding.message, finding.hint) for finding in findings] == [(message, hint)]


def test_assumptions_of_a_library_are_sorted_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assumptions = " ".join(f"assume A{number}: Arm.ok needs Arm.moving" for number in range(5))
    (tmp_path / "Lib.rscd").write_text(
        f"""library Lib {{ {assumptions} component Arm {{
          incoming message move with type: none
          outgoing message ok with type: none
          behaviour {{
            initial marked state still {{ on request to move goto moving }}
            state moving {{ on response from ok goto still }}
          }}
        }} }}"""
    )
    (tmp_path / "robot.rscd").write_text(
        """robot R {
          component Arm[1..9] from Lib import Arm with { move: "/m" + text(number), ok: "/o" + text(number) }
        }"""
    )
    sorted_assumptions: list[robosc_model.Assumption] = []
    original = semantics.assumed_components

    def counted(assumption: robosc_model.Assumption, known: semantics.Instances) -> list[robosc_model.Component]:
        sorted_assumptions.append(assumption)
        return original(assumption, known)

    monkeypatch.setattr(semantics, "assumed_components", counted)
    known = semantics.Instances(robosc.load(tmp_path / "robot.rscd"))
    assert known.statements(robosc_model.Requirement) == []
    assert sorted_assumptions == []
    for _ in range(3):
        assert len(known.statements(robosc_model.Assumption)) == 45
    assert len(sorted_assumptions) == 5


def test_files_take_both_names(tmp_path: Path) -> None:
    text = robot(
        FLEET, AUTOMATON, "requirement R1: each Station: Station.enter needs (count Station: Station.inside) < 3"
    )
    (tmp_path / "robot.rscd").write_text(text)
    (tmp_path / "good.scenarios").write_text(
        """scenario "both"
          response from Cell[1].done
          expect Cell[1].inside or Cell1.outside
          response from Cell1.done
          expect Turns[Cell[3]].mine or Turns[Cell3].yours
          expect Cell[2].enter forbidden by Turns[Cell[2]]
          expect Cell2.enter forbidden by Turns[Cell2]
          response from Cell[01].done
          expect Cell[02].enter forbidden by Turns[Cell[02]]
        """
    )
    assert errors(text.replace("Turns.mine", "Turns[Cell[02]].mine")) == []
    script = "request to Cell[1].enter\nresponse from Cell1.done\nmessage_Cell[2]_enter.c_trigger\n"
    test = CliRunner().invoke(main, ["test", str(tmp_path / "robot.rscd"), str(tmp_path / "good.scenarios")])
    assert "no event" not in test.output
    assert "[unresolved-reference]" not in test.output
    simulated = CliRunner().invoke(main, ["simulate", str(tmp_path / "robot.rscd"), "--script", "-"], input=script)
    assert [json.loads(line)["accepted"] for line in simulated.stdout.splitlines()] == [True, True, True]
    settings = Configuration.model_validate({"onShutdown": ["Cell[2].enter", "Cell3.enter", "Cell[010].enter"]})
    assert settings.on_shutdown == ["Cell2.enter", "Cell3.enter", "Cell10.enter"]


def test_a_condition_of_a_scenario_keeps_its_columns(tmp_path: Path) -> None:
    """In the robot's text, `Cell1` is longer by two characters."""
    (tmp_path / "robot.rscd").write_text(robot(FLEET))
    line = "  expect Cell1.inside or Cell2.outside and Cell1.nonsense"
    (tmp_path / "wrong.scenarios").write_text(f'scenario "one"\n{line}\n')
    found = CliRunner().invoke(main, ["test", str(tmp_path / "robot.rscd"), str(tmp_path / "wrong.scenarios")])
    assert f"wrong.scenarios:2:{line.index('nonsense') + 1}: error: component `Cell` has no" in found.output


def test_cell_with_its_number_is_no_name_in_a_model() -> None:
    text = robot(FLEET, "requirement Cell1.enter needs Gate.free")
    with pytest.raises(robosc.ModelError) as raised:
        robosc.load(text=text)
    (finding,) = raised.value.diagnostics
    assert (finding.rule, finding.hint) == ("unresolved-reference", "write `Cell[1]`")


@pytest.mark.parametrize(
    ("requirement", "proposed"),
    [
        ("requirement Cell[2].¦ needs Gate.free", {"enter"}),
        ("requirement Cell[2].enter needs Cell[1].¦", {"inside", "outside", "used"}),
        ("requirement Cell[2].enter needs Turns[Cell[1]].¦", {"mine", "yours"}),
        ("requirement each Station: Station.enter needs Station.¦", {"inside", "outside", "used"}),
        ("requirement each Station: Station.enter needs ¦", {"Station", "Cell", "Turns"}),
        ("requirement ¦ needs Gate.free", {"each", "Cell[1].enter"}),
        ("requirement each ¦: Station.enter needs Gate.free", {"Station"}),
        ('component More[1..2] is Station("/more" + ¦)', {"number", "text"}),
    ],
)
def test_completion(tmp_path: Path, requirement: str, proposed: set[str]) -> None:
    content, path = robot(FLEET, AUTOMATON, requirement), tmp_path / "robot.rscd"
    offset = content.index("¦")

    def read_text(text: str) -> Reading:
        return read(path, documents=Documents({str(path): text}))

    _, _, candidates = proposals(content.replace("¦", ""), offset, read_text, RosTypes(), list)
    assert proposed <= {candidate.text for candidate in candidates}


def test_an_editor_knows_fleets(tmp_path: Path) -> None:
    """Every name of an instance refers to the fleet, so that renaming the fleet changes all of them."""
    text = robot(FLEET, AUTOMATON, "requirement Cell[1].enter needs Cell[2].outside and Turns[Cell[3]].mine")
    reading = read(tmp_path / "robot.rscd", documents=Documents({str(tmp_path / "robot.rscd"): text}))
    assert reading.base is not None
    fleet = next(part for part in reading.base.definitions if getattr(part, "first", None) is not None)
    assert len(reading.file.occurrences(fleet)) == 4
    hover = describe(reading, fleet, RosTypes())
    assert hover is not None
    assert "Fleet of 3 instances: `Cell[1]` … `Cell[3]`." in hover
    number = describe(reading, fleet.number, RosTypes())
    assert number is not None
    assert "The number of the instance of the fleet." in number
    words = {text[word.start : word.end]: word.what for word in classify(reading.file)}
    assert (words["text"], words["number"], words["each"]) == ("function", "parameter", "keyword")
