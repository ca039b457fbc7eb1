"""Assumptions, sentence by sentence: `SENTENCES` maps each sentence about them to the tests that hold it."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from random import Random
from typing import TYPE_CHECKING, Any

import pytest
from click.testing import CliRunner
from jsonschema import Draft202012Validator

import robosc
from robosc.analysis.explain import explain, explore, find_event
from robosc.analysis.explain.as_text import Renderer
from robosc.analysis.supervise import supervise
from robosc.analysis.verify import validate_c, validate_cif, verify_system
from robosc.analysis.verify.verdict import Outcome
from robosc.base.diagnostics import ModelError, Severity
from robosc.base.files.resources import locate
from robosc.base.ros_types import RosTypes
from robosc.engine import Blocked, Engine
from robosc.language import configuration as config
from robosc.language.configuration import Configuration
from robosc.language.configuration.parameters import layer_parameters
from robosc.m2t import cif, supervisor, xmi
from robosc.m2t.models import Models
from robosc.m2t.ros.preconditions import preconditions
from robosc.m2t.targets import TARGETS
from robosc.model import sct, validity
from robosc.model.semantics.definition import definition_text
from robosc.model.semantics.messages import find_message
from robosc.run.node_tests import trace_player
from robosc.run.node_tests.trace_test import trace_test_of
from robosc.run.report import report
from robosc.run.runtime.core.event_loop import EventLoop
from robosc.run.runtime.core.layer import Layer
from robosc.run.runtime.core.port import GoalOutcome
from robosc.run.runtime.core.settings import SafeMessages, Settings
from robosc.run.runtime.core.violations import Violations
from robosc.synthesis import count, synthesize
from robosc.tools.cli import main
from robosc.tools.view.description import describe
from tests.language.second_edition import errors, supervised
from tests.m2t.conftest import ROS1_INTERFACES
from tests.random_assumptions import assuming_robot
from tests.run.node_tests.in_process_node import InProcessNode
from tests.run.runtime.fake import FakePort, Record, World
from tests.run.runtime.fake import supervised as graph_of
from tests.searching import examples
from tests.synthesis.test_against_oracle import check as check_by_search

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

#: Each sentence of the specification of assumptions, with the tests that hold it.
SENTENCES = {
    "assume [NAME] [text] : EVENTS needs C": ["forms"],
    "EVENTS are outgoing messages, feedback and responses; a message alone means its response": ["forms", "events"],
    "requests, cancels, error, canceled and incoming messages are `requirement-event`": ["events"],
    "names of assumptions are unique as those of requirements": ["names"],
    "the condition has no `value` and no requirement automata": ["conditions"],
    "it stands in robots, libraries and components": ["places", "library"],
    "to synthesis it is a plant with one location": ["plant", "explicit_search", "explicit_search_of_random_robots"],
    "`uncontrolled_states` includes it": ["plant"],
    "in CIF it is that plant": ["cif"],
    "the node checks it in the state right before the event": ["batch"],
    "in a batch after the events before it; the others of the batch go on": ["batch"],
    "a violating event happens for no component, and nothing is stored": ["violation"],
    "it counts as not received: watchdogs, `without`": ["watchdog", "without"],
    "it is logged as `violated`, an error in /diagnostics, and in ~/state": ["violation", "traces"],
    "a response against an assumption is the error with the reason `unreadable`": ["response", "goal"],
    "onViolation is stop: as a tripped watchdog": ["stop", "generated_nodes"],
    "until the node is started or activated anew": ["stop", "a_managed_node_begins_anew"],
    "a layer blocks every command, cancels running goals and sends what onBlocked names": ["layer"],
    "onViolation is report: the robot goes on, with warnings": ["report", "warnings"],
    "warning `assumption-unused`": ["unused"],
    "robosc synthesize --without NAME": ["without_one"],
    "simulate refuses the event (by: assumption, with its name)": ["simulate"],
    "scenarios may play it and `expect A1 violated`": ["scenario"],
    "in a layer the event itself is forwarded": ["layer"],
    "the saved models have it": ["saved", "a_saved_assumption_that_does_not_fit"],
    "generated C checks the same": ["c", "c_and_python_find_the_same_violations"],
    "verify proves the same rows as without it": ["verify"],
    "explain names it as a reason": ["explain"],
    "`assume` stays a name": ["name"],
}

SHOP = """robot Shop {
  component M1 {
    service work with identifier: "/work", request: none, response: none
    outgoing message done with identifier: "/done", type: boolean
    outgoing message also with identifier: "/done", type: boolean

    behaviour {
      variable last: boolean = false
      variable counted: boolean = false
      variable stored: double = 0.0
      on response from also do counted := value
      initial marked state idle { on request to work goto busy }
      state busy {
        on response from done do last := value, stored := 2.0 goto ready
        on error from work if error = unreadable goto unread
        on error from work goto idle
      }
      state ready {
        on response from work goto idle
        on error from work goto idle
      }
      marked state unread { on response from done goto idle }
    }
  }

  component Lamp {
    incoming message lamp with identifier: "/lamp", type: none
    incoming message safe with identifier: "/safe", type: none
  }

  requirement lamp needs M1.counted
  requirement safe needs M1.last
  assume A1 "the machine answers only when asked": done needs M1.busy
  assume A2: response from work needs M1.ready
}
"""
DRIVE = """robot Cart {
  interface travel use NavigateToPose from nav2_msgs
  component Base {
    action drive with identifier: "/drive", request: none, response: none, feedback: none links travel
    service beep with identifier: "/beep", request: none, response: none
    behaviour {
      variable fed: boolean = false
      initial marked state parked { on request to drive goto driving }
      state driving {
        on feedback from drive do fed := true
        on response from drive goto parked
        on error from drive if error = unreadable goto parked
        on error from drive goto parked
        on canceled from drive goto parked
      }
    }
    assume { feedback from drive, response from drive } needs Door.closed
  }
  component Door {
    outgoing message opened with identifier: "/opened", type: none
    incoming message velocity with identifier: "/velocity", type: none
    behaviour {
      initial marked state closed { on response from opened goto open }
      marked state open { on response from opened goto closed }
    }
  }
  requirement velocity needs Door.closed
  assume A3: opened needs Base.parked
}
"""


def test_each_sentence_has_its_tests() -> None:
    tested = {name.removeprefix("test_") for name in globals() if name.startswith("test_")}
    assert {name for names in SENTENCES.values() for name in names} <= tested


def model_of(text: str) -> sct.SupervisoryControlModel:
    return supervised(text)


def assumptions_of(model: sct.SupervisoryControlModel) -> list[sct.Plant]:
    return [plant for plant in model.plants if plant.kind == sct.PlantKind.assumption]


def changed(old: str, new: str, text: str = SHOP) -> str:
    assert text.count(old) == 1
    return text.replace(old, new)


# The language


def test_forms() -> None:
    forms = ['A1 "why": done needs M1.busy', '"why": done needs M1.busy', "A1: { done, also } needs M1.busy"]
    line = 'assume A1 "the machine answers only when asked": done needs M1.busy'
    for form in [*forms, "done needs M1.busy", "response from done needs M1.busy"]:
        plant, _ = assumptions_of(model_of(changed(line, f"assume {form}")))
        events = [edge.event.name for edge in plant.locations[0].edges]
        assert events == ["u_response"] * (2 if "also" in form else 1)
        assert plant.text == f"assume {form}"


@pytest.mark.parametrize(
    ("event", "message"),
    [
        ("request to work", "the controller decides on the request of `work`"),
        ("work", "the controller decides on the request of `work`"),
        ("error from work", "the node itself makes the error of `work`"),
        ("lamp", "the controller decides on the request of `lamp`"),
    ],
)
def test_events(event: str, message: str) -> None:
    text = changed("assume A2: response from work", f"assume A2: {event}")
    [finding] = [each for each in robosc.check(robosc.load(text=text)) if each.severity is Severity.ERROR]
    assert (finding.rule, finding.message.partition(",")[0]) == ("requirement-event", message)
    assert errors(DRIVE.replace("feedback from drive, ", "cancel from drive, ")) == [("requirement-event", 17)]
    assert errors(DRIVE.replace("feedback from drive, ", "canceled from drive, ")) == [("requirement-event", 17)]


def test_names() -> None:
    assert errors(changed("assume A2:", "assume A1:")) == [("unique-component", 34)]
    assert errors(changed("assume A2:", "assume M1:"))[0][0] == "unique-component"
    twice = "assume B: done needs busy assume B: done needs busy behaviour { variable last"
    assert errors(changed("behaviour {\n      variable last", twice)) == [("unique-variable", 7)]


def test_conditions() -> None:
    turns = "requirement Turns: automaton { initial state a { on lamp } } assume A1"
    assert errors(changed("needs M1.ready", "needs value")) == [("type", 34)]
    read = changed("needs M1.ready", "needs Turns.a").replace("assume A1", turns)
    assert errors(read) == [("requirement-event", 34)]
    assert errors(changed("needs M1.ready", "needs M1.work.running")) == []
    assert errors(changed("needs M1.ready", "needs M1.stored > 1.0")) == [("variable-type", 10)]


def test_places() -> None:
    inside = changed("behaviour {\n      variable last", "assume B: also needs !ready behaviour { variable last")
    (*_, plant) = assumptions_of(model_of(inside))
    assert (plant.name, plant.origin) == ("assumption_M1_B", "M1.B")
    assert plant.text == "assume M1.B: also needs !M1.ready"


LIBRARY = """library Machines {
  component Machine {
    outgoing message done with identifier: "/done", type: none
    incoming message ask with identifier: "/ask", type: none
    behaviour {
      initial marked state idle { on request to ask goto busy }
      state busy { on response from done goto idle }
    }
    assume inner: done needs busy
  }
  component Other { outgoing message told with type: none }
  assume outer: Machine.done needs Machine.busy
}
"""
PAIR = """robot Pair {
  component Left from Machines import Machine with { done: "/l/done", ask: "/l/ask" }
  component Right from Machines import Machine with { done: "/r/done", ask: "/r/ask" }
}
"""


def test_library(tmp_path: Path) -> None:
    """An assumption outside of components holds for each import of its component."""
    (tmp_path / "machines.rscd").write_text(LIBRARY)
    (tmp_path / "pair.rscd").write_text(PAIR)
    model = robosc.to_sct(robosc.load(tmp_path / "pair.rscd"))
    names = [(side, name) for side in ("Left", "Right") for name in ("inner", "outer")]
    texts = {f"assume {side}.{name}: {side}.done needs {side}.busy" for side, name in names}
    assert {plant.text for plant in assumptions_of(model)} == texts
    robosc.synthesize(model)
    assert Engine(model).violated_assumptions("message_Left_done.u_response") != []
    (tmp_path / "machines.rscd").write_text(LIBRARY.replace("assume outer: Machine.done", "assume outer: told"))
    messages = [finding.message for finding in robosc.check(robosc.load(tmp_path / "pair.rscd"))]
    assert any("expected one component" in message for message in messages)


def test_name() -> None:
    """A model may have the word as a name; more places are in `tests/language/test_new_words.py`."""
    text = re.sub(r"\bdone\b", "assume", SHOP)
    assert errors(text) == []


# Synthesis


def test_plant() -> None:
    model = model_of(SHOP)
    plants = assumptions_of(model)
    assert [(plant.name, len(plant.locations)) for plant in plants] == [("assumption_A1", 1), ("assumption_A2", 1)]
    free = model_of(re.sub(r"  assume .*\n", "", SHOP))
    assert model.supervisor is not None
    assert free.supervisor is not None
    assert model.supervisor.uncontrolledStates < free.supervisor.uncontrolledStates


def test_cif() -> None:
    model = model_of(SHOP)
    texts = cif.generate(Models(model), Configuration())
    for text in texts.values():
        assert (
            '@doc("assume A1 \\"the machine answers only when asked\\": done needs M1.busy")\n'
            "plant assumption_A1:\n  location:\n    initial; marked;\n"
            "    edge message_done.u_response when component_M1.busy;\nend\n"
        ) in text
    assert validate_cif(model, texts).outcome is Outcome.PROVED


def test_verify() -> None:
    verdicts = verify_system(model_of(SHOP))
    assert [verdict.property for verdict in verdicts if verdict.outcome is not Outcome.PROVED] == []


@pytest.mark.skipif(shutil.which("gcc") is None, reason="no C compiler")
def test_c() -> None:
    model = model_of(SHOP)
    assert validate_c(model, supervisor.generate(Models(model), Configuration())).outcome is Outcome.PROVED


def unused(text: str) -> list[str]:
    model = robosc.to_sct(robosc.load(text=text))
    return [finding.message for finding in supervise(model).findings if finding.rule == "assumption-unused"]


def test_unused() -> None:
    assert unused(SHOP) == []
    text = "done needs M1.idle or !M1.idle"
    [message] = unused(changed("done needs M1.busy", text))
    assert message.startswith(f'`assume A1 "the machine answers only when asked": {text}` excludes nothing')
    assert len(unused(SHOP.replace("  assume A2", "  assume A0: done needs M1.busy\n  assume A2"))) == 2


EACH = """robot Each {
  component Machine(ns: string) {
    incoming message start with identifier: ns + "/start", type: none
    outgoing message done with identifier: ns + "/done", type: none
    behaviour {
      initial marked state idle { on request to start goto busy }
      state busy { on response from done goto idle }
    }
  }
  component M[1..3] is Machine("/m" + text(number))
  assume A: each Machine: Machine.done needs CONDITION
  requirement M[3].start needs M[3].busy
}"""


def test_unused_with_each() -> None:
    """One of the instances is enough to need the assumption."""
    assert unused(EACH.replace("CONDITION", "Machine.busy")) == []
    assert unused(EACH.replace("CONDITION", "Machine.busy or M[1].idle or M[2].idle")) == []
    [message] = unused(EACH.replace("CONDITION", "Machine.busy or Machine.idle"))
    assert message.startswith("`assume A[M1]: M1.done needs M1.busy or M1.idle` excludes nothing")
    assert message.endswith("; the same holds for the other 2 instances")


def command(*arguments: str, text: str = "") -> Any:
    return CliRunner().invoke(main, list(arguments), input=text)


def written(folder: Path, text: str = SHOP) -> Path:
    path = folder / "model.rscd"
    path.write_text(text)
    return path


def path_without(folder: Path) -> str:
    """Return the path of a robot without assumptions."""
    path = folder / "without.rscd"
    path.write_text("robot R { component C { incoming message go with type: none } }")
    return str(path)


def test_without_one_events_and_guards_change(tmp_path: Path) -> None:
    path = written(
        tmp_path,
        """robot Fleet {
          component Station(ns: string) {
            incoming message go with identifier: ns + "/go", type: none
            outgoing message done with identifier: ns + "/done", type: none
            behaviour {
              initial marked state idle { on request to go goto busy on response from done goto confused }
              state busy { on response from done goto idle }
              state confused { on request to go goto busy }
            }
          }
          component Cell[1..2] is Station("/c" + text(number))
          assume A1: each Station: Station.done needs Station.busy
          requirement Cell[1].go needs !Cell[2].confused
        }""",
    )
    assert changed_guards(path, "A1[Cell2]") == [("message_Cell1_go.c_trigger", ["true", "!component_Cell2.confused"])]
    path = written(
        tmp_path,
        """robot P {
          component S {
            outgoing message done with type: none
            incoming message go with type: none
            behaviour {
              initial marked state a { on response from done goto b }
              marked state b { on request to go goto a }
            }
          }
          assume A1: done needs S.b
        }""",
    )
    assert changed_guards(path, "A1") == [
        ("message_done.u_response", ["never enabled", "true"]),
        ("message_go.c_trigger", ["never enabled", "true"]),
    ]


@pytest.mark.parametrize("name", ["A1[Cell2]", "A1[Cell[2]]"])
def test_a_scenario_names_the_assumption_of_an_instance(tmp_path: Path, name: str) -> None:
    path = written(
        tmp_path,
        """robot Fleet {
          component Station(ns: string) {
            outgoing message done with identifier: ns + "/done", type: boolean
            behaviour { variable armed: boolean initial marked state idle { on response from done do armed := value } }
          }
          component Cell[1..2] is Station("/c" + text(number))
          assume A1: each Station: Station.done needs Station.armed
        }""",
    )
    scenarios = tmp_path / "fleet.scenarios"
    scenarios.write_text(f'scenario "early"\n  Cell2.done with true\n  expect {name} violated\n')
    assert command("test", str(path), str(scenarios)).exit_code == 0
    scenarios.write_text(f'scenario "early"\n  Cell1.done with true\n  expect {name} violated\n')
    assert "the last step does not violate `A1[Cell2]`" in command("test", str(path), str(scenarios)).output


def changed_guards(path: Path, name: str) -> list[tuple[str, list[str]]]:
    answer = json.loads(command("synthesize", str(path), "--without", name, "--json").stdout)
    return [(row["name"], row["guards"]) for row in answer["guards"]]


def test_without_one(tmp_path: Path) -> None:
    path = str(written(tmp_path))
    shown = command("synthesize", path, "--without", "A2")
    assert shown.exit_code == 0
    assert re.search(r"Shop: \d+ states before, \d+ states after", shown.stdout)
    assert "no assumption with a name" in command("synthesize", path_without(tmp_path), "--without", "A1").stderr
    told = json.loads(command("synthesize", path, "--without", "A2", "--json").stdout)
    assert (told["without"], told["empty"]) == ("A2", False)
    assert [each["states"] for each in told["requirements"]] != []
    assert "expected A1 or A2" in command("synthesize", path, "--without", "A3").stderr
    only = """robot R {
      component C {
        outgoing message hit with type: none
        incoming message go with type: none
        behaviour { initial marked state a { on response from hit goto b on request to go }
          state b { on request to go goto a } }
      }
      requirement go needs C.a
      assume A: hit needs C.b
    }"""
    shown = command("synthesize", str(written(tmp_path, only)), "--without", "A")
    assert shown.exit_code == 0
    assert "R: the supervisor is empty" in shown.stdout


# The node


def log_of(world: World) -> list[tuple[str, str]]:
    world.controller.flush_log()
    lines = map(json.loads, world.log.read_text().splitlines())
    return [(line["direction"], line["event"]) for line in lines]


def state_of(port: FakePort) -> dict[str, Any]:
    state: dict[str, Any] = json.loads([text for name, text in port.told if name == "state"][-1])
    return state


def shop(folder: Path, **settings: Any) -> World:
    settings = {"on_shutdown": ["safe"], **settings}
    return World(written(folder), folder / "log.jsonl", Configuration(**settings))


def test_violation(tmp_path: Path) -> None:
    world = shop(tmp_path, on_violation="report").start()
    world.hear("done", data=True)  # the machine is idle before the first tick
    assert ("violated", "message_done.u_response") in log_of(world)
    assert ("in", "message_done.u_response") not in log_of(world)
    world.wait(0.15)
    state = state_of(world.port)
    assert state["violated"] == ["A1"]
    assert state["components"]["M1"]["variables"] == {"last": False, "counted": True, "stored": 0.0}
    (status,) = [each for each in world.port.statuses[-1] if each.component == "M1"]
    assert status.level == "ERROR"
    assert "violated: A1" in status.message
    assert any("violates `assume A1" in text for text in world.port.said)


def test_batch(tmp_path: Path) -> None:
    """`done` makes the machine ready; only then `also` is checked."""
    text = changed("  assume A2", "  assume A0: also needs M1.ready\n  assume A2")
    world = World(written(tmp_path, text), tmp_path / "log.jsonl", Configuration(on_violation="report")).start()
    world.wait(0.15)
    world.hear("done", data=True)
    assert [line for line in log_of(world) if "/done" in line[1] or ("message_" in line[1] and line[0] != "out")] == [
        ("in", "message_done.u_response"),
        ("in", "message_also.u_response"),
    ]
    world.hear("done", data=True)
    assert log_of(world)[-2:] == [("violated", "message_done.u_response"), ("in", "message_also.u_response")]


def test_watchdog(tmp_path: Path) -> None:
    world = shop(tmp_path, on_violation="report", watchdog_ms={"done": 500}).start()
    world.wait(0.4)
    world.hear("done", data=True)  # the machine was asked
    world.wait(0.4)
    assert "/done: silent for 500 ms" not in world.port.said
    world.hear("done", data=True)  # violates A1
    world.wait(0.2)
    assert "/done: silent for 500 ms" in world.port.said


def test_without(tmp_path: Path) -> None:
    text = changed(
        "on response from also do counted",
        "after 1 s without done do last := false\n      on response from also do counted",
    )
    world = World(written(tmp_path, text), tmp_path / "log.jsonl", Configuration(on_violation="report")).start()
    world.wait(0.15)
    world.hear("done", data=True)
    world.wait(0.5)
    world.hear("done", data=True)  # violates A1, so that the time goes on
    world.wait(0.7)
    assert state_of(world.port)["components"]["M1"]["variables"]["last"] is False


def test_response(tmp_path: Path) -> None:
    world = shop(tmp_path, on_violation="report").start()
    world.wait(0.15)
    (call,) = world.port.calls
    call.answered(Record())
    world.wait(0.01)
    assert len([text for text in world.port.said if "violates `assume A2" in text]) == 1
    assert log_of(world)[-2:] == [("violated", "service_work.u_response"), ("in", "service_work.u_error")]
    world.wait(0.1)
    assert state_of(world.port)["components"]["M1"]["state"] == "unread"
    assert state_of(world.port)["violated"] == ["A2"]


def test_a_violation_leaves_nothing_but_its_assumptions() -> None:
    """A node that goes on does not grow with each violation."""
    model = model_of(SHOP)
    violations = Violations(Engine(model), stop=False)
    done = next(event for plant in model.plants for event in plant.events if event.eContainer().origin == "M1.done")

    def sizes() -> dict[str, int]:
        return {name: len(value) for name, value in vars(violations).items() if isinstance(value, (dict, list, set))}

    fault = violations.check(done)
    assert fault is not None
    assert fault.assumptions == assumptions_of(model)[:1]
    before = sizes()
    assert violations.check(done) is not None
    assert sizes() == before


@pytest.mark.parametrize("target", ["ros1", "ros2", "ros2-layer"])
def test_a_violating_response_is_reported_once(tmp_path: Path, target: str) -> None:
    handler = body_of(generated(tmp_path, target), "void on_drive_response(")
    violated = handler[handler.index("if (violates(") : handler.index("    } else {\n")]
    assert "cart_action_drive_u_error" in violated
    assert "WARN" not in violated
    assert ("drive_fault_ = violation_;" in violated) == (target != "ros2-layer")


def test_goal(tmp_path: Path) -> None:
    world = World(written(tmp_path, DRIVE), tmp_path / "log.jsonl", Configuration(on_violation="report")).start()
    world.hear("opened")
    world.wait(0.3)
    (goal,) = world.port.goals
    goal.handlers.accepted()
    world.hear("opened")  # violates A3, so that the door stays open
    goal.handlers.feedback(Record())
    goal.handlers.ended(GoalOutcome.SUCCEEDED, Record(), "")
    world.wait(0.01)
    events = [line for line in log_of(world) if line[0] in ("in", "violated")]
    assert events == [
        ("in", "message_opened.u_response"),
        ("violated", "message_opened.u_response"),
        ("violated", "action_drive.u_feedback"),
        ("violated", "action_drive.u_response"),
        ("in", "action_drive.u_error"),
    ]


def test_stop(tmp_path: Path) -> None:
    """Commands are held back, goals are canceled, and `onShutdown` is sent; nothing ends that but a new start."""
    world = shop(tmp_path).start()
    world.wait(0.15)
    world.hear("done", data=True)
    world.wait(0.15)
    sent = [topic for topic, _ in world.port.sent]
    assert "/lamp" in sent
    world.hear("done", data=True)
    world.port.sent.clear()
    assert any(text.startswith("commands are held back: the robot violated an assumption") for text in world.port.said)
    world.wait(2.0)
    assert world.port.sent == []
    assert ("outside", "message_safe.c_trigger") in log_of(world)
    assert [each for each in world.port.statuses[-1] if each.level == "ERROR"]
    (tmp_path / "cart").mkdir()
    cart = World(written(tmp_path / "cart", DRIVE), tmp_path / "cart.jsonl").start()
    cart.wait(0.3)
    (goal,) = cart.port.goals
    goal.handlers.accepted()
    cart.wait(0.01)
    cart.hear("opened")
    assert goal.cancels == 1


def test_report(tmp_path: Path) -> None:
    world = shop(tmp_path, on_violation="report").start()
    assert any(text.startswith("onViolation is report") for text in world.port.said)
    world.hear("done", data=True)
    world.wait(0.3)
    assert "/lamp" in [topic for topic, _ in world.port.sent]


def findings_of(path: Path, kind: str, **settings: Any) -> list[str]:
    graph = graph_of(path)
    models = Models(graph.model, graph)
    return [finding.message for finding in preconditions(models, Configuration(**settings), kind, 2)]


@pytest.mark.parametrize("kind", ["controller", "layer"])
def test_warnings(tmp_path: Path, kind: str) -> None:
    path = written(tmp_path, DRIVE)
    about = '"onViolation": after the first violation of an assumption, nothing about the robot is proved'
    assert about in findings_of(path, kind, on_violation="report")
    assert about not in findings_of(path, kind)
    other = tmp_path / "other.rscd"
    other.write_text(re.sub(r" +assume .*\n", "", DRIVE))
    assert '"onViolation" has no effect: the model has no assumption' in findings_of(other, kind, on_violation="stop")


@pytest.mark.parametrize(
    ("settings", "expected"),
    [
        ({}, [config.NO_STOP, config.NO_STOP_ON_VIOLATION]),
        ({"on_shutdown": []}, [config.NO_STOP_ON_VIOLATION]),
        ({"on_shutdown": ["velocity"]}, []),
        ({"on_shutdown": [], "on_violation": "report"}, [config.REPORTS_VIOLATIONS]),
    ],
)
def test_a_node_warns_that_a_violation_does_not_stop_the_robot(
    tmp_path: Path, settings: dict[str, Any], expected: list[str]
) -> None:
    world = World(written(tmp_path, DRIVE), tmp_path / "log.jsonl", Configuration(**settings)).start()
    assert world.port.said == expected
    for target in ("ros1", "ros2"):
        node = re.sub(r'"\n\s*"', "", generated(tmp_path, target, **settings))
        body = node[node.index("void warn_of_no_stop()") :] if "void warn_of_no_stop()" in node else ""
        body = body.partition("  }\n")[0]
        assert [
            text for text in (config.NO_STOP, config.NO_STOP_ON_VIOLATION, config.REPORTS_VIOLATIONS) if text in body
        ] == expected
        assert (config.NO_STOP_ON_VIOLATION in node) == (config.NO_STOP_ON_VIOLATION in expected)


UNGUARDED = """robot Cart {
  component Base {
    incoming message velocity with identifier: "/velocity", type: geometry_msgs/Twist
    outgoing message told with identifier: "/told", type: none
    behaviour { initial marked state still { on response from told goto moving } marked state moving {} }
  }
  assume told needs Base.still
}
"""


def test_a_layer_may_block_each_command_after_a_violation(tmp_path: Path) -> None:
    """Nothing else can block the velocity."""
    path = written(tmp_path, UNGUARDED)
    (blocked,) = findings_of(path, "layer")
    assert blocked.startswith("the layer can block velocity, also one that stops the robot")
    assert findings_of(path, "layer", on_blocked=[]) == []
    (reported,) = findings_of(path, "layer", on_violation="report")
    assert reported.startswith('"onViolation": after the first violation')


class Bench:
    """A layer of the cart whose goals are recorded."""

    trouble = ""
    waits = False

    def __init__(self, folder: Path, on_blocked: Sequence[str] = (), text: str = DRIVE) -> None:
        self.graph = graph_of(written(folder, text))
        self.port = FakePort()
        configuration = Configuration()
        log = str(folder / "layer.jsonl")
        values = {parameter.name: parameter.default for parameter in layer_parameters(self.graph, configuration, log)}
        sendings = [sending for name in on_blocked if (sending := find_message(self.graph, name)) is not None]
        event_loop = EventLoop(lambda: self.port.time)
        settings = Settings(values, configuration)
        self.layer = Layer(self.graph, settings, self.port, event_loop, SafeMessages(on_blocked=sendings))
        (action,) = self.graph.actionClients
        self.cancels = 0
        self.layer.goals[action.cancel] = self
        self.layer.start()

    def cancel(self) -> None:
        self.cancels += 1

    def leave(self) -> None:
        """Nothing runs at the end."""

    def command(self, name: str) -> bool:
        """Send a message of the controller; return whether it passes."""
        sending = find_message(self.graph, name)
        assert sending is not None
        return self.layer.forwarded(sending, Record()) is not None

    def open_door(self) -> None:
        """Send `opened` from the robot, which violates A3 unless the base is parked."""
        opened = next(each for each in self.graph.subscriptions if each.topic == "/opened")
        self.layer.receive(opened, Record())  # the node behind it forwards the message itself


def test_layer(tmp_path: Path) -> None:
    bench = Bench(tmp_path, ["velocity"])
    (action,) = bench.graph.actionClients
    assert bench.command("velocity")
    assert bench.layer.forwarded(action.request, Record()) is not None
    bench.open_door()
    assert bench.cancels >= 1
    assert [topic for topic, _ in bench.port.sent] == ["/velocity"]
    assert not bench.command("velocity")
    assert not bench.command("velocity")
    assert [topic for topic, _ in bench.port.sent] == ["/velocity"], "its own message is not sent again"
    blocked = json.loads([text for name, text in bench.port.told if name == "blocked"][-1])
    assert (blocked["reason"], blocked["because"]) == ("assumption", ["assume A3: opened needs Base.parked"])


LIT = DRIVE.replace(
    "  requirement velocity",
    """  component Lamp {
    incoming message lights with identifier: "/lights", type: none
    incoming message horn with identifier: "/horn", type: none
  }
  requirement velocity""",
)


@pytest.mark.parametrize("names", [["velocity", "lights"], ["lights", "velocity"], ["horn", "velocity", "lights"]])
def test_a_layer_sends_its_messages_in_the_configured_order(tmp_path: Path, names: list[str]) -> None:
    bench = Bench(tmp_path, names, LIT)
    (action,) = bench.graph.actionClients
    assert bench.layer.forwarded(action.request, Record()) is not None
    bench.open_door()
    assert [topic for topic, _ in bench.port.sent] == [f"/{name}" for name in names]
    node = generated(tmp_path, "ros2-layer", text=LIT, on_blocked=names)
    assert re.findall(r"    send_(\w+)\(\);", body_of(node, "void halt()")) == names


# Tools


def test_simulate(tmp_path: Path) -> None:
    script = 'message_done.u_response {"value": true}\n'
    path = str(written(tmp_path))
    answer = json.loads(command("simulate", path, "--script", "-", text=script).stdout)
    assert (answer["accepted"], answer["by"], answer["violated"]) == (False, "assumption", ["A1"])
    answers = command("simulate", path, "--script", "-", "--loop", text="tick\nservice_work.u_response\n").stdout
    last = json.loads(answers.splitlines()[-1])
    assert (last["by"], last["violated"], last["happened"][0]) == ("assumption", ["A2"], "service_work.u_error")
    engine = Engine(model_of(SHOP))
    assert engine.blocked_by("message_done.u_response") is Blocked.ASSUMPTION
    assert engine.blocked_by("service_work.u_response") is Blocked.PLANT


SCENARIO = """scenario "in order"
  done with true
  response from work
  expect M1.idle

scenario "too early"
  response from work
  expect A2 violated
  expect M1.unread
  expect lamp not sent

scenario "twice"
  done with true
  done with false
  expect A1 violated
  expect M1.last
"""


def test_scenario(tmp_path: Path) -> None:
    scenarios = tmp_path / "shop.scenarios"
    scenarios.write_text(SCENARIO)
    played = command("test", str(written(tmp_path)), str(scenarios))
    assert played.exit_code == 0, played.output
    scenarios.write_text(SCENARIO.replace("  response from work\n  expect M1.idle", "  expect A1 violated"))
    assert "the last step does not violate `A1`" in command("test", str(written(tmp_path)), str(scenarios)).output
    scenarios.write_text(SCENARIO.replace("expect A2 violated", "expect A3 violated"))
    assert "the robot has no assumption `A3`" in command("test", str(written(tmp_path)), str(scenarios)).output


def test_saved(tmp_path: Path) -> None:
    """A saved robot and its saved plants have the assumptions, and give the same bytes."""
    robot = robosc.load(written(tmp_path))
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    files = xmi.generate(Models(model, robosc.to_rosgraph(robot), robot), Configuration())
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    (saved,) = [name for name in files if name.endswith(".sct.xmi")]
    read = validity.load(tmp_path / saved)
    assert [plant.text for plant in assumptions_of(read)] == [plant.text for plant in assumptions_of(model)]
    (text,) = [name for name in files if name == "Shop.robosc.xmi"]
    again = robosc.to_sct(robosc.load(tmp_path / text))
    assert [plant.text for plant in assumptions_of(again)] == [plant.text for plant in assumptions_of(model)]


def test_explain() -> None:
    model = model_of(SHOP)
    event = find_event(model, "done")
    explanation = explore(model, lambda system: explain(system, event, {}))
    assert explanation.by is Blocked.ASSUMPTION
    shown = Renderer(model, lambda _: "here").answer(explanation)
    assert "cannot happen here: an assumption excludes it" in shown
    assert '`assume A1 "the machine answers only when asked": done needs M1.busy` excludes it' in shown


def test_report_and_view(tmp_path: Path) -> None:
    robot = robosc.load(written(tmp_path))
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    models = Models(model, robosc.to_rosgraph(robot), robot)
    stated = report(models, Configuration(), [], texts={}, version="0")["assumptions"]
    assert [each["text"] for each in stated["stated"]] == [plant.text for plant in assumptions_of(model)]
    assert stated["on_violation"] == "stop"
    shown = [each["text"] for each in describe(models, {})["requirements"]]
    assert set(shown) > {plant.text for plant in assumptions_of(model)}


def test_format(tmp_path: Path) -> None:
    path = written(tmp_path, changed("  assume A2: response from work needs", "assume A2:response from   work needs"))
    assert command("format", str(path)).exit_code == 0
    assert "  assume A2: response from work needs M1.ready\n" in path.read_text()


FOLLOWER = """#include "shop_supervisor.h"
#include <stdio.h>

int main(void)
{
    shop_supervisor robot;
    unsigned event;
    shop_init(&robot, NULL, NULL);
    while (scanf("%u", &event) == 1) {
        for (unsigned each = 0U; each < SHOP_EVENT_COUNT; ++each) {
            for (unsigned number = 0U; number < SHOP_ASSUMPTION_COUNT; ++number) {
                if (shop_violates(&robot, (shop_event)each, number)) {
                    printf("%s %s;", shop_event_name((shop_event)each), shop_assumption_name(number));
                }
            }
        }
        printf("\\n");
        (void)shop_perform(&robot, (shop_event)event);
    }
    return 0;
}
"""


@pytest.mark.skipif(shutil.which("gcc") is None, reason="no C compiler")
def test_c_and_python_find_the_same_violations(tmp_path: Path) -> None:
    model = model_of(SHOP)
    for name, text in supervisor.generate(Models(model), Configuration()).items():
        (tmp_path / name).write_text(text)
    (tmp_path / "main.c").write_text(FOLLOWER)
    flags = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-Wconversion"]
    program = tmp_path / "follower"
    subprocess.run(["gcc", *flags, "-o", program, *tmp_path.glob("*.c")], cwd=tmp_path, check=True)
    engine, random, expected, steps = Engine(model), Random(0), [], []  # noqa: S311 - nothing here is secret
    names = [event.name for event in engine.executed.events]
    for _ in range(300):
        found = [(name, plant.origin) for name in names for plant in engine.violated_assumptions(name)]
        expected.append("".join(f"{name} {origin};" for name, origin in found))
        steps.append(random.randrange(len(names)))
        engine.perform(names[steps[-1]])
    told = subprocess.run([program], input=" ".join(map(str, steps)), capture_output=True, text=True, check=True)
    assert told.stdout.split("\n")[:-1] == expected
    assert len(set(expected)) == 2


@pytest.mark.parametrize("reaction", ["stop", "report"])
def test_traces(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, reaction: str) -> None:
    """The tests of a package play the event log of a scenario with violations against its node."""
    for name, seconds in {"SETTLED": 0.0, "REACTION": 0.0, "ANSWER": 0.0, "PATIENCE": 0.05}.items():
        monkeypatch.setattr(trace_player, name, seconds)
    path, scenarios = written(tmp_path), tmp_path / "shop.scenarios"
    (tmp_path / "controller-config.json").write_text(json.dumps({"onViolation": reaction}))
    scenarios.write_text(SCENARIO)
    assert command("test", str(path), str(scenarios), "--traces", str(tmp_path / "traces")).exit_code == 0
    graph = graph_of(path)
    configuration = config.read(tmp_path / "controller-config.json")
    planned = trace_test_of(TARGETS["ros2"], Models(graph.model, graph), configuration)
    assert planned is not None
    connections = json.loads(planned.files["connections.json"])
    violated = 0
    for number, trace in enumerate(sorted((tmp_path / "traces").iterdir())):
        lines = trace_player.read_trace(str(trace))
        violated += sum(line.direction == "violated" for line in lines)
        log = tmp_path / f"events{number}.jsonl"
        node = InProcessNode(connections, graph, configuration, log)
        trace_player.Player(connections, node, trace_player.Log(str(log))).play(lines)
    assert violated == 2


def test_a_saved_assumption_that_does_not_fit(tmp_path: Path) -> None:
    model = robosc.to_sct(robosc.load(text=SHOP))
    plant, _ = assumptions_of(model)
    plant.locations.append(sct.Location(name="other", initial=False, marked=True))
    files = xmi.generate(Models(model), Configuration())
    path = tmp_path / "Shop.sct.xmi"
    path.write_text(files[path.name])
    with pytest.raises(ModelError, match="'assumption_A1' needs one location, and edges for data from the robot only"):
        validity.load(path)


def generated(folder: Path, target: str, text: str = DRIVE, **settings: Any) -> str:
    """Return the source of a node of the cart."""
    graph = graph_of(written(folder, text))
    models = Models(graph.model, graph, ros_types=RosTypes([ROS1_INTERFACES]))
    files = robosc.generate(target, models, Configuration(**settings))
    return next(text for path, text in files.items() if path.endswith("_node.cpp"))


def test_an_assumption_without_a_text_is_violated_like_any_other(tmp_path: Path) -> None:
    graph = graph_of(written(tmp_path, DRIVE))
    plants = assumptions_of(graph.model)
    for plant in plants:
        plant.text = plant.origin = None
    files = robosc.generate("ros2", Models(graph.model, graph), Configuration())
    names = [f'"{plant.name}"' for plant in plants]
    assert files["src/cart_supervisor.c"].count(",\n        ".join(names)) == 2, "as names and as texts"
    assert "if (!violated) return false;" in files["src/cart_controller_node.cpp"]
    engine = Engine(graph.model)
    assert engine.perform("action_drive.c_trigger")
    violation = Violations(engine, stop=True).check(graph.subscriptions[0].receptions[0].event)
    assert str(violation) == f"violates `{plants[0].name}`"


def body_of(node: str, function: str) -> str:
    """Return a method of a generated node, from its name on."""
    return node[node.index(f"  {function}") :].partition("\n  }\n")[0]


def test_the_definition_lists_them() -> None:
    robot = robosc.load(text=SHOP)
    graph = robosc.to_rosgraph(robot)
    told = json.loads(definition_text(graph))
    Draft202012Validator(json.loads(locate("schemas/definition.schema.json").read_text())).validate(told)
    names = {"A1": "message_done.u_response", "A2": "service_work.u_response"}
    assert {each["name"]: each["events"] for each in told["assumptions"]} == {
        name: [event] for name, event in names.items()
    }
    assert [each["text"] for each in told["assumptions"]] == [plant.text for plant in assumptions_of(graph.model)]
    assert {each["kind"] for each in told["communications"]} == {"message", "service"}
    assert "assumptions" not in json.loads(
        definition_text(robosc.to_rosgraph(robosc.load(text=re.sub(r"  assume .*\n", "", SHOP))))
    )


@pytest.mark.parametrize("target", ["ros1", "ros2", "ros2-layer"])
def test_the_typed_state_has_the_violated_ones(tmp_path: Path, target: str) -> None:
    graph = graph_of(written(tmp_path, DRIVE))
    typed = Configuration(typed_state=True)
    (message,) = [
        text
        for path, text in TARGETS[target].beside(Models(graph.model, graph), typed).items()
        if path.endswith("State.msg")
    ]
    assert message.endswith(
        "# The assumptions that the robot has violated, by name or else by text.\nstring[] violated\n"
    )
    node = generated(tmp_path, target, typed_state=True)
    assert "    report.violated = violations_.names();\n" in node


@pytest.mark.parametrize("target", ["ros1", "ros2", "ros2-layer"])
def test_generated_nodes(tmp_path: Path, target: str) -> None:
    stopping = generated(tmp_path, target, on_shutdown=["velocity"], on_blocked=["velocity"])
    assert 'if (violates(cart_message_opened_u_response, "Door")) {' in stopping
    assert stopping.count("stop_if_violated();") > 3
    assert 'log_.write(seconds(), "violated", cart_event_name(cart_action_drive_u_response));' in stopping
    halting = body_of(stopping, "void halt()")
    assert "_cancel" in halting
    if target == "ros2-layer":
        assert "    if (violations_.empty() && cart_perform(" in body_of(stopping, "bool pass_velocity()")
        assert "    velocity_forwarded_ = false;\n    send_velocity();" in halting
    else:
        assert "const {\n    if (!violations_.empty()) return true;\n" in body_of(stopping, "bool held()")
        handler = body_of(stopping, "void on_opened(")
        refused, _, accepted = handler.partition("    } else {\n")
        assert "      read_whole = false;\n" in refused
        assert "    if (read_whole && opened_watchdog_->hear())" in accepted
        assert "velocity_publisher_" in halting
    reporting = generated(tmp_path, target, on_violation="report")
    assert "violates(" in reporting
    assert "stop_if_violated" not in reporting
    assert "violations_.empty()" not in reporting
    assert "onViolation is report" in reporting


def test_a_managed_node_begins_anew(tmp_path: Path) -> None:
    """Its deactivation ends the stop. A violation while it is inactive stops the robot at its activation."""
    text = generated(tmp_path, "ros2", lifecycle=True)
    activation, deactivation, cleanup = (
        body_of(text, f"void {name}()") for name in ("activate", "deactivate", "disconnect")
    )
    forgets = "    violations_ = Violations<cart_event>();\n"
    assert forgets not in activation
    assert activation.endswith("    stop_if_violated();")
    assert activation.index("active_ = true;") < activation.index("stop_if_violated();")
    assert deactivation.index("halt();") < deactivation.index(forgets)
    assert forgets in cleanup
    assert "if (!active_ || !violations_.take_halt()) return;" in text


@pytest.mark.parametrize("text", [SHOP, DRIVE], ids=["shop", "cart"])
def test_explicit_search(text: str) -> None:
    model = robosc.to_sct(robosc.load(text=text))
    check_by_search(model, synthesize(model))


@pytest.mark.slow
def test_explicit_search_of_random_robots() -> None:
    searched = 0
    for text in map(assuming_robot, range(examples(12))):
        try:
            model = robosc.to_sct(robosc.load(text=text))
        except ModelError:  # it imports a library that is not there
            continue
        inputs = [carried for plant in model.plants for carried in plant.inputs]
        counted = count(model)
        if len(inputs) > 4 or counted.uncontrolled_states is None or counted.uncontrolled_states > 300:
            continue
        check_by_search(model, synthesize(model))
        searched += any(plant.kind == sct.PlantKind.assumption for plant in model.plants)
    assert searched > 0
