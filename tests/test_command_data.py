"""Conditions on the data of commands: `SENTENCES` maps each sentence to the tests that hold it."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

import pytest
from click.testing import CliRunner

import robosc
from robosc.engine import ControlLoop, Engine, Hooks
from robosc.language.configuration import Configuration
from robosc.m2t import xmi
from robosc.m2t.models import Models
from robosc.model import rosgraph, sct, validity
from robosc.run.simulation.simulation import Simulation
from robosc.tools.cli import main
from tests.language.second_edition import errors
from tests.run.runtime.fake import LayerBench, Record, World
from tests.run.runtime.fake import supervised as graph_of

if TYPE_CHECKING:
    from pathlib import Path

#: Each sentence of the specification of conditions on data of commands, with the tests that hold it.
SENTENCES = {
    "in the condition of `needs` and `disables`, `value` is the data of the command": [
        "permissions",
        "disables",
        "disables_by_a_field",
    ],
    "in `if` of `on request to x`, of components and requirement automata, too": ["component", "automaton"],
    "in a controller, it is what `provide` computes, and ROS defaults": ["controller", "simulation"],
    "in a layer, it is what the controller sent": ["layer"],
    "it is the data that goes out, after limits and narrowing": ["limits", "single_precision"],
    "in a set of communications the condition is typed for each": ["sets"],
    "`value` of a command stands nowhere else": ["nowhere_else"],
    "each part with `value` that the supervisor cannot compute is an input": ["inputs"],
    "a part without `value` stays `variable-type`": ["stored"],
    "a parameter may stand only in a part with `value`": ["parameters"],
    "the supervisor is maximally permissive over the combinations of inputs": ["permissions", "synthesis_part"],
    "a state is non-blocking if some combination leads on": ["non_blocking"],
    "`never-enabled` means that no combination is ever allowed": ["never_enabled"],
    "enabled is a command that some data would allow": ["enabled"],
    "a command that its data forbid is withheld: it takes no turn and is no reaction": ["withheld"],
    "it is reported once on `~/blocked` until it is sent or is no longer enabled": ["reported_once"],
    "in a layer the inputs are set before the question": ["layer"],
    "an action keeps the inputs of its start until the goal ends": ["goal"],
    "the requirement judges the running goal by its own data": ["goal"],
    "where a double that is read is not finite, a layer blocks the command": ["not_finite"],
    "the saved models have it": ["saved"],
    "generated nodes have it": ["generated"],
    "reports name what forbids": ["reasons_of_a_layer", "reasons_of_synthesis"],
    "an integer outside its range is not judged": ["out_of_range"],
    "a command is withheld as one whose data are not finite": ["instead_of_forbidden_data"],
    "messages on change are sent again after others": ["on_change"],
    "the log of a layer has the data that decide": ["log_of_a_layer"],
}

#: A base that drives slowly near a person, with a lamp that a requirement restricts by its data.
BASE = """robot Cart {
  component Person {
    outgoing message seen with identifier: "/seen", type: boolean
    behaviour {
      initial marked state far {
        on response from seen if value goto near
      }
      marked state near {
        on response from seen if !value goto far
      }
    }
  }

  component Base {
    incoming message velocity with identifier: "/velocity", type: geometry_msgs/Twist
    incoming message lamp with identifier: "/lamp", type: integer(0..3)
    outgoing message top with identifier: "/top", type: double
    behaviour {
      variable most: double = 0.5
      on response from top do most := value
      initial marked state ready {}
    }
  }

  requirement R1: Base.velocity needs Person.far or value.linear.x <= 0.3
  requirement R2: value > 1 disables Base.lamp
  provide Base.velocity with { linear: { x: Base.most } }
  provide Base.lamp with 2 if Person.near
  provide Base.lamp with 1
}
"""
VELOCITY, LAMP = "message_velocity.c_trigger", "message_lamp.c_trigger"


def changed(old: str, new: str, text: str = BASE) -> str:
    assert text.count(old) == 1
    return text.replace(old, new)


def more(statements: str, text: str = BASE) -> str:
    """Return the text with statements behind the others."""
    return text.rstrip().removesuffix("}") + statements + "\n}\n"


def written(folder: Path, text: str = BASE) -> Path:
    path = folder / "cart.rscd"
    path.write_text(text)
    return path


def supervised(text: str = BASE) -> sct.SupervisoryControlModel:
    model = robosc.to_sct(robosc.load(text=text))
    model.supervisor = robosc.synthesize(model)
    return model


def allows(engine: Engine, event: str, **inputs: Any) -> bool:
    engine.set_inputs(event, inputs)
    return engine.enabled(event) and engine.permits_inputs(event)


def rules(text: str) -> list[str]:
    return [rule for rule, _ in errors(text)]


def test_each_sentence_has_its_tests() -> None:
    names = {name.removeprefix("test_") for name in globals() if name.startswith("test_")}
    assert {name for tests in SENTENCES.values() for name in tests} <= names


# The language


def test_inputs() -> None:
    model = supervised()
    inputs = {f"{plant.name}.{each.name}": each.text for plant in model.plants for each in plant.inputs}
    assert inputs["message_velocity.i_trigger_c1"] == "value.linear.x <= 0.3"
    assert inputs["message_lamp.i_trigger"] is None


@pytest.mark.parametrize(
    "statement",
    [
        "condition slow = value.linear.x < 0.1",
        "requirement never value.linear.x < 0.1",
        "requirement reachable value.linear.x < 0.1",
        "property always value.linear.x < 0.1",
        "provide Base.velocity with { linear: { x: 0.1 } } if value.linear.x < 0.1",
        "provide Base.velocity with { linear: { x: value.linear.x } }",
    ],
)
def test_nowhere_else(statement: str) -> None:
    assert "type" in rules(more(statement)) or "unresolved-reference" in rules(more(statement))


def test_nowhere_else_in_assignments() -> None:
    more_lines = "variable sent: double\n      on request to velocity do sent := value.linear.x\n      "
    text = changed("on response from top", f"{more_lines}on response from top")
    assert rules(text) == ["type"] or "assignment-on-message-to-node" in rules(text)


def test_sets() -> None:
    pair = """robot R {
      datatype object Slow { speed: double }
      datatype object Fast { speed: double height: double }
      component C {
        incoming message a with identifier: "/a", type: Slow links Twist
        incoming message b with identifier: "/b", type: Fast links Twist
      }
      interface Twist use Twist from geometry_msgs
      requirement { a, b } needs value.speed < 1.0
    }"""
    own = [rule for rule, _ in errors(pair) if rule not in {"data-type", "interface-type", "interface-fields"}]
    assert own == []
    wrong = pair.replace("value.speed < 1.0", "value.height < 1.0")
    assert "unresolved-reference" in rules(wrong)
    numbers = """robot R {
      component C {
        incoming message a with identifier: "/a", type: integer
        incoming message b with identifier: "/b", type: boolean
      }
      requirement { a, b } needs value < 1
    }"""
    assert rules(numbers) == ["type"]


def test_stored() -> None:
    assert rules(more("requirement Base.velocity needs Base.most < 0.4")) == ["variable-type"]
    assert rules(more("requirement Base.velocity needs Base.most < 0.4 or value.linear.x < 0.1")) == ["variable-type"]


def test_parameters() -> None:
    limit = "parameter most: double = 0.4\n  requirement Base.velocity needs "
    assert rules(more(f"{limit} value.linear.x < most")) == []
    assert rules(more(f"{limit} most < 0.5 or Person.far")) == ["parameter-scope"]


# Synthesis


def test_permissions() -> None:
    engine = Engine(supervised())
    assert allows(engine, VELOCITY, i_trigger_c1=False)
    assert allows(engine, VELOCITY, i_trigger_c1=True)
    engine.perform("message_seen.u_response", {"i_response": True})
    assert not allows(engine, VELOCITY, i_trigger_c1=False)
    assert allows(engine, VELOCITY, i_trigger_c1=True)


def test_disables() -> None:
    engine = Engine(supervised())
    assert [allows(engine, LAMP, i_trigger=level) for level in range(4)] == [True, True, False, False]


@pytest.mark.parametrize("commands", ["Base.velocity", "{ Base.velocity, again }", "Left.move"])
def test_disables_by_a_field(commands: str) -> None:
    """The field is found although its command follows in the text."""
    text = more(f"""requirement value.linear.z > 0.4 disables {commands}
      component Other(ns: string) {{
        incoming message move with identifier: ns + "/move", type: geometry_msgs/Twist
        requirement value.linear.y > 0.4 disables move
      }}
      component Left is Other("/left")
      component Again {{ incoming message again with identifier: "/again", type: geometry_msgs/Twist }}""")
    assert rules(text) == []
    assert rules(text.replace("z > 0.4", "w > 0.4")) == ["unresolved-reference"]
    graph = robosc.to_rosgraph(robosc.load(text=text))
    assert {"y", "z"} <= {step.name for step in graph.eAllContents() if isinstance(step, rosgraph.FieldStep)}


#: A switch that the robot follows by its data, and that must not reach `broken`.
SWITCH = """robot Switch {
  component C {
    incoming message go with identifier: "/go", type: integer(0..3)
    outgoing message tick with identifier: "/tick", type: none
    behaviour {
      initial marked state one {
        on request to go if value = 1 goto two
        on request to go if value = 2 goto three
        on request to go if value = 3 goto broken
      }
      state two { on request to go if value = 0 goto one }
      state three { on response from tick goto broken }
      state broken {}
    }
  }
  requirement never C.broken
}
"""
GO = "message_go.c_trigger"


def test_component() -> None:
    """A component permits the data of its transitions, and its transition depends on the data."""
    engine = Engine(supervised(SWITCH))
    assert not allows(engine, GO, i_trigger=0)
    assert engine.perform(GO, {"i_trigger": 1})
    assert engine.state["component_C"] == "two"
    assert [allows(engine, GO, i_trigger=each) for each in range(4)] == [True, False, False, False]


def test_synthesis_part() -> None:
    """Synthesis forbids the data that lead to a forbidden state, at once or by an event of the robot."""
    engine = Engine(supervised(SWITCH))
    assert [allows(engine, GO, i_trigger=each) for each in range(4)] == [False, True, False, False]


def test_non_blocking() -> None:
    text = SWITCH.replace("requirement never C.broken", "").replace("if value = 1 goto two", "if value = 1 goto broken")
    engine = Engine(supervised(text))
    assert [allows(engine, GO, i_trigger=each) for each in range(4)] == [False] * 4
    assert supervised(text).supervisor.controlledStates == 1  # type: ignore[union-attr]
    trapped = text.replace("initial marked state one", "initial state one").replace("state two {", "marked state two {")
    assert robosc.synthesize(robosc.to_sct(robosc.load(text=trapped.replace("goto broken", "goto two", 1)))) is not None


def test_automaton() -> None:
    text = more("""requirement A: automaton {
        initial marked state free { on request to Base.lamp if value = 1 goto used }
        marked state used { on request to Base.lamp if value = 0 goto free }
      }""")
    engine = Engine(supervised(text))
    assert [allows(engine, LAMP, i_trigger=level) for level in range(4)] == [False, True, False, False]
    assert engine.perform(LAMP, {"i_trigger": 1})
    assert [allows(engine, LAMP, i_trigger=level) for level in range(4)] == [True, False, False, False]


def test_never_enabled(tmp_path: Path) -> None:
    never = more("requirement Base.lamp needs value = 2")
    output = CliRunner().invoke(main, ["synthesize", str(written(tmp_path, never))]).output
    assert "never-enabled" in output
    output = CliRunner().invoke(main, ["synthesize", str(written(tmp_path))]).output
    assert "never-enabled" not in output


def test_enabled() -> None:
    engine = Engine(supervised(SWITCH))
    assert engine.enabled(GO)
    engine.perform(GO, {"i_trigger": 1})
    assert engine.enabled(GO)
    blocked = more("requirement Base.lamp needs Person.far and value < 2")
    engine = Engine(supervised(blocked))
    assert engine.enabled(LAMP)
    engine.perform("message_seen.u_response", {"i_response": True})
    assert not engine.enabled(LAMP)
    assert engine.blocked_by(LAMP) == "requirement"


GOALS = """robot Arm {
  component Door {
    outgoing message open with identifier: "/open", type: boolean
    behaviour {
      initial marked state closed { on response from open if value goto wide }
      marked state wide { on response from open if !value goto closed }
    }
  }
  component Arm {
    action move with identifier: "/move", request: example_interfaces/Fibonacci, response: example_interfaces/Fibonacci,
      feedback: example_interfaces/Fibonacci
    behaviour { initial marked state ready {} }
  }
  requirement Arm.move needs Door.closed or value.order < 5
}
"""


def test_goal() -> None:
    model = supervised(GOALS)
    (plant,) = [plant for plant in model.plants if plant.kind == sct.PlantKind.action]
    assert [variable.name for variable in plant.variables] == ["goal_c1"]
    engine = Engine(model)
    start, cancel = "action_move.c_trigger", "action_move.c_cancel"
    assert engine.perform(start, {"i_trigger_c1": False})  # far
    assert not engine.enabled(cancel)
    engine.perform("message_open.u_response", {"i_response": True})
    assert engine.enabled(cancel)
    engine.perform(cancel)
    engine.perform("action_move.u_canceled")
    assert engine.state["Arm.move.goal_c1" if "Arm.move.goal_c1" in engine.state else "action_move.goal_c1"] is False
    assert not allows(engine, start, i_trigger_c1=False)
    assert engine.perform(start, {"i_trigger_c1": True})  # near: it may go on
    assert not engine.enabled(cancel)


# Running


def test_withheld() -> None:
    model = supervised()
    slow, happened = {VELOCITY: False, LAMP: 1}, list[str]()

    def before(event: str) -> bool:
        if event in slow:
            name = "i_trigger_c1" if event == VELOCITY else "i_trigger"
            loop.engine.set_inputs(event, {name: slow[event]})
        return True

    loop = ControlLoop(model, None, Hooks(before, happened.append))
    loop.tick()
    assert [event for event in happened if event.startswith("message")] == [VELOCITY, LAMP]
    happened.clear()
    loop.begin()
    loop.perform("message_seen.u_response", {"i_response": True})
    loop.end()
    loop.tick()
    assert VELOCITY not in happened, "its data are forbidden near a person"
    assert LAMP in happened
    slow[VELOCITY] = True
    loop.tick()
    assert VELOCITY in happened


def test_controller(tmp_path: Path) -> None:
    world = World(written(tmp_path), tmp_path / "log.jsonl").start()
    world.wait(0.15)
    assert sent(world, "/velocity") == [0.5] * len(sent(world, "/velocity"))
    world.hear("seen", data=True)
    world.port.sent.clear()
    world.wait(0.3)
    assert sent(world, "/velocity") == []
    world.hear("top", data=0.2)
    world.wait(0.15)
    assert set(sent(world, "/velocity")) == {0.2}


def sent(world: World, topic: str) -> list[Any]:
    return [
        data["linear"]["x"] if topic == "/velocity" else data["data"] for name, data in world.port.sent if name == topic
    ]


def blocked(world: World) -> list[dict[str, Any]]:
    return [json.loads(text) for name, text in world.port.told if name == "blocked"]


def test_reported_once(tmp_path: Path) -> None:
    world = World(written(tmp_path), tmp_path / "log.jsonl").start()
    world.wait(0.15)
    assert blocked(world) == []
    world.hear("seen", data=True)
    world.wait(0.5)
    reports = blocked(world)
    assert sorted((each["name"], each["reason"]) for each in reports) == [
        ("Base.lamp", "requirement"),
        ("Base.velocity", "requirement"),
    ]
    assert reports[0]["because"] != []
    world.hear("top", data=0.2)
    world.wait(0.15)
    world.hear("top", data=0.4)
    world.wait(0.15)
    assert [each["name"] for each in blocked(world)].count("Base.velocity") == 2


def test_limits(tmp_path: Path) -> None:
    """The supervisor sees what limits make of the data."""
    limited = more("limit Base.velocity with { linear: { x: min(value.linear.x, 0.25) } } if Person.near")
    world = World(written(tmp_path, limited), tmp_path / "log.jsonl").start()
    world.hear("seen", data=True)
    world.port.sent.clear()
    world.wait(0.15)
    assert set(sent(world, "/velocity")) == {0.25}


def test_single_precision(tmp_path: Path) -> None:
    """A constant is rounded as the field of the command is."""
    text = """robot R {
      component C { incoming message speed with identifier: "/speed", type: std_msgs/Float32 }
      requirement speed needs value.data <= 0.1
      provide speed with { data: 0.1 }
    }"""
    path = written(tmp_path, text)
    world = World(path, tmp_path / "log.jsonl")
    world.port.types = {"data": "float"}
    world.start()
    world.wait(0.15)
    assert [name for name, _ in world.port.sent] != []


def test_simulation(tmp_path: Path) -> None:
    model = graph_of(written(tmp_path))
    simulation = Simulation(model.model, model)
    simulation.perform("message_seen.u_response", {"value": True})
    assert simulation.perform(VELOCITY, {"value": {"linear": {"x": 0.5}}}).by == "requirement"
    assert simulation.perform(VELOCITY, {"value": {"linear": {"x": 0.2}}}).by is None
    assert simulation.perform(VELOCITY, {}).by is None, "without a choice of data, the defaults of ROS"
    simulation.perform("data_velocity.c_d1")
    assert simulation.perform(VELOCITY, {}).by == "requirement", "what `provide` gives"


def twist(x: float) -> Record:
    return Record(linear=Record(x=x))


def test_layer(tmp_path: Path) -> None:
    bench = LayerBench(written(tmp_path))
    assert bench.passes("velocity", twist(0.5))
    bench.hear("/seen", data=True)
    assert not bench.passes("velocity", twist(0.5))
    assert bench.blocked()["reason"] == "requirement"
    assert bench.passes("velocity", twist(0.3))
    assert [bench.passes("lamp", Record(data=level)) for level in range(4)] == [True, True, False, False]


def test_not_finite(tmp_path: Path) -> None:
    bench = LayerBench(written(tmp_path))
    for number in (math.nan, math.inf):
        assert not bench.passes("velocity", twist(number))
        assert bench.blocked()["reason"] == "data"


# Files


def test_saved(tmp_path: Path) -> None:
    graph = graph_of(written(tmp_path))
    robot = robosc.load(tmp_path / "cart.rscd")
    files = xmi.generate(Models(graph.model, graph, robot), Configuration())
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    saved = validity.load(tmp_path / "Cart.rosgraph.xmi")
    for target in ("ros2", "supervisor", "cif"):
        expected = robosc.generate(target, Models(graph.model, graph), Configuration())
        assert robosc.generate(target, Models(saved.model, saved), Configuration()) == expected


def test_generated(tmp_path: Path) -> None:
    path = written(tmp_path)
    for target in ("ros1", "ros2", "ros2-layer", "supervisor", "cif"):
        made = CliRunner().invoke(main, ["transform", "--to", target, str(path), "-o", str(tmp_path / target)])
        assert made.exit_code == 0, made.output


def test_reasons_of_a_layer(tmp_path: Path) -> None:
    """A component that is not ready is the reason, not a requirement that holds with this data."""
    text = changed("initial marked state ready {}", "initial marked state ready {} state open { on request to lamp }")
    bench = LayerBench(written(tmp_path, text))
    assert not bench.passes("lamp", Record(data=0))
    assert bench.blocked()["reason"] == "state"


SLOW = "requirement R1: velocity needs Person.far or value.linear.x <= 0.3"
RELEASED = "requirement velocity needs Button.released"


@pytest.mark.parametrize(
    ("pressed", "x", "because"), [(True, 0.2, [RELEASED]), (False, 0.5, [SLOW]), (True, 0.5, [SLOW, RELEASED])]
)
def test_reasons_of_two_kinds(tmp_path: Path, pressed: bool, x: float, because: list[str]) -> None:
    """A requirement on the data that holds is no reason in a state in which another requirement forbids all data."""
    text = more("requirement Base.velocity needs Button.released").replace(
        "  component Base {",
        """  component Button {
    outgoing message pressed with identifier: "/pressed", type: boolean
    behaviour {
      initial marked state released { on response from pressed if value goto held }
      marked state held { on response from pressed if !value goto released }
    }
  }
  component Base {""",
    )
    bench = LayerBench(written(tmp_path, text))
    bench.hear("/seen", data=True)
    bench.hear("/pressed", data=pressed)
    assert not bench.passes("velocity", twist(x))
    assert bench.blocked()["because"] == because


@pytest.mark.parametrize("setting", ["onShutdown", "onWithheld", "onBlocked"])
def test_unsteady_stops(tmp_path: Path, setting: str) -> None:
    """A message that stops the robot has constant data."""
    path = written(tmp_path)
    (tmp_path / "controller-config.json").write_text(json.dumps({setting: ["lamp"]}))
    target = "ros2-layer" if setting == "onBlocked" else "ros2"
    output = CliRunner().invoke(main, ["transform", "--to", target, str(path), "-o", str(tmp_path / "out")]).output
    assert f'"{setting}": the data of lamp depend on the state of the robot, and may not stop it' in output
    path.write_text(changed("  provide Base.lamp with 2 if Person.near\n", ""))
    output = CliRunner().invoke(main, ["transform", "--to", target, str(path), "-o", str(tmp_path / "out")]).output
    assert "and may not stop it" not in output


def test_out_of_range(tmp_path: Path) -> None:
    """A layer does not judge another number than it forwards."""
    bench = LayerBench(written(tmp_path))
    for level in (-100, 70):
        assert not bench.passes("lamp", Record(data=level))
        assert bench.blocked()["reason"] == "data"


def test_instead_of_forbidden_data(tmp_path: Path) -> None:
    """A command whose data are forbidden is withheld as one whose data cannot be sent."""
    text = changed(
        "    incoming message lamp",
        '    incoming message halt with identifier: "/velocity", type: geometry_msgs/Twist\n    incoming message lamp',
    )
    text = changed(
        "  provide Base.velocity",
        "  requirement Base.halt needs Person.near and Person.far\n  provide Base.velocity",
        text,
    )
    world = World(written(tmp_path, text), tmp_path / "log.jsonl", Configuration(on_withheld=["halt"])).start()
    world.wait(0.15)
    world.port.sent.clear()
    world.hear("seen", data=True)
    world.wait(0.3)
    halts = [data for topic, data in world.port.sent if topic == "/velocity"]
    assert halts == [{}, {}], "once for the velocity, once for the lamp"


CHANGES = """robot Cart {
  component Person {
    outgoing message seen with identifier: "/seen", type: boolean
    behaviour {
      initial marked state far { on response from seen if value goto near }
      marked state near { on response from seen if !value goto far }
    }
  }
  component Base {
    incoming message go with identifier: "/speed", type: double, send: change
    incoming message halt with identifier: "/speed", type: double, send: change
  }
  requirement Base.go needs Person.far
  requirement Base.halt needs Person.near or value < 0.0
  provide Base.go with 0.5
  provide Base.halt with 0.0
}
"""


def test_on_change(tmp_path: Path) -> None:
    """A message on the same topic, or forbidden data, let a message be sent again."""
    world = World(written(tmp_path, CHANGES), tmp_path / "log.jsonl").start()
    world.wait(0.15)
    for seen in (True, False, True, False):
        world.port.sent.clear()
        world.hear("seen", data=seen)
        world.wait(0.3)
        assert sent(world, "/speed") == [0.0 if seen else 0.5]


def test_disables_fields(tmp_path: Path) -> None:
    text = changed(
        "requirement R2: value > 1 disables Base.lamp", "requirement R2: value.linear.y > 0.1 disables Base.velocity"
    )
    assert rules(text) == []
    bench = LayerBench(written(tmp_path, text))
    assert bench.passes("velocity", Record(linear=Record(x=0.1, y=0.0)))
    assert not bench.passes("velocity", Record(linear=Record(x=0.1, y=0.5)))
    assert rules(changed("value > 1 disables Base.lamp", "value.foo > 1 disables Base.lamp")) != []


def test_running_goal_is_judged_by_the_state() -> None:
    """The state of the robot is no part of the data that an action keeps."""
    assert rules(GOALS.replace("value.order < 5", "value.order < (if Door.closed then 10 else 2)")) != []


def test_parameters_of_one_name(tmp_path: Path) -> None:
    """The parameters of a library and of a robot are two."""
    (tmp_path / "Lib.rscd").write_text(
        """library Lib {
          parameter most: double = 0.1
          component Base {
            incoming message v with identifier: "/v", type: double
            requirement v needs value < most
          }
        }"""
    )
    robot = written(
        tmp_path,
        """robot R {
          component Base from Lib import Base
          parameter most: double = 0.9
          requirement Base.v needs value < most
        }""",
    )
    model = robosc.to_sct(robosc.load(robot))
    assert [len(plant.inputs) for plant in model.plants if plant.name == "message_v"] == [2]


def test_reasons_of_synthesis() -> None:
    """Synthesis is the reason where it forbids all data that a requirement permits."""
    engine = Engine(supervised(SWITCH.replace("if value = 1 goto two", "if value = 1 goto broken") + ""))
    assert engine.blocked_by(GO) == "synthesis"
    assert engine.failing_requirements(GO) == []


STORED = """robot Cart {
  component Base {
    outgoing message plan with identifier: "/plan", type: geometry_msgs/PoseStamped
    incoming message go with identifier: "/go", type: geometry_msgs/PoseStamped
    behaviour {
      variable stored: geometry_msgs/PoseStamped
      initial marked state ready { on response from plan do stored := value goto has_plan }
      marked state has_plan {}
    }
  }
  requirement go needs Base.has_plan and value.pose.position.x < 3.0
  provide go with Base.stored
}
"""


def test_stored_objects(tmp_path: Path) -> None:
    """The simulation compares stored objects that are sent as they are."""
    graph = graph_of(written(tmp_path, STORED))
    for x, by in ((1.0, None), (5.0, "requirement")):
        simulation = Simulation(graph.model, graph)
        simulation.perform("message_plan.u_response", {"value": {"pose": {"position": {"x": x}}}})
        simulation.perform("data_go.c_d1")
        assert simulation.perform("message_go.c_trigger", {}).by == by


def test_functions_of_data() -> None:
    """A function of the data may read parameters, also if its own parameter has a ROS type."""
    text = more("""parameter most: double = 0.5
      function slow(speed: geometry_msgs/Vector3): boolean = hypot(speed.x, speed.y) < most
      requirement Base.velocity needs slow(value.linear)""")
    assert rules(text) == []


def test_log_of_a_layer(tmp_path: Path) -> None:
    """The log has the data that decide, so that a simulation of it decides alike."""
    bench = LayerBench(written(tmp_path, SWITCH.replace("requirement never C.broken", "")), log=tmp_path / "log.jsonl")
    assert bench.passes("go", Record(data=1))
    assert not bench.passes("go", Record(data=2))
    assert bench.passes("go", Record(data=0))
    bench.layer.close()
    lines = [json.loads(line) for line in (tmp_path / "log.jsonl").read_text().splitlines()]
    assert [(line["direction"], line["data"]) for line in lines] == [
        ("out", {"value": 1}),
        ("blocked", {"value": 2}),
        ("out", {"value": 0}),
    ]


#: Text of a robot whose node stores, for a limit, that a command happened.
LIMITED_AFTERWARDS = """robot Cart {
  component Base {
    incoming message velocity with identifier: "/velocity", type: geometry_msgs/Twist
    behaviour {
      variable most: double = 0.2
      initial marked state ready { on request to velocity do most := 0.1 }
    }
  }
  requirement Base.velocity needs value.linear.y <= 0.3
  limit Base.velocity with { linear: { x: Base.most } }
}
"""


def test_forbidden_command_changes_no_data_of_the_layer(tmp_path: Path) -> None:
    bench = LayerBench(written(tmp_path, LIMITED_AFTERWARDS))
    forbidden, allowed = (Record(linear=Record(x=1.0, y=y)) for y in (0.5, 0.0))
    assert bench.forwarded("velocity", forbidden) is None
    assert bench.forwarded("velocity", allowed) == {"linear": {"x": 0.2, "y": 0.0}}
    assert bench.forwarded("velocity", allowed) == {"linear": {"x": 0.1, "y": 0.0}}
