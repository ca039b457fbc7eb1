"""Comparisons with stored values, sentence by sentence: `SENTENCES` maps each sentence to the tests that hold it."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from click.testing import CliRunner
from hypothesis import given, settings
from hypothesis import strategies as st

import robosc
from robosc.analysis.verify.model_reading import validate_model
from robosc.analysis.verify.verdict import Outcome
from robosc.language.configuration import Configuration
from robosc.m2t import xmi
from robosc.m2t.models import Models
from robosc.model import validity
from robosc.model.semantics.messages import receptions
from robosc.run.simulation.simulation import LoopSimulation, Simulation
from robosc.tools.cli import main
from tests.language.second_edition import errors, supervised
from tests.run.runtime.fake import Record, World
from tests.searching import examples

if TYPE_CHECKING:
    from collections.abc import Sequence

#: Each sentence of the specification, with the tests that hold it.
SENTENCES = {
    "in `on … if` and in what its `do` assigns, what would be `variable-type` is one input": ["conditions", "values"],
    "or `integer-range`, for want of a range of data": ["data_without_a_range"],
    "the smallest part with a boolean, enum or ranged integer result": ["smallest_part"],
    "computed by the node from the values before the event": ["runtime", "random_expressions", "simulation"],
    "everything that is accepted today is split as today": ["accepted_before"],
    "parts that the node computes, joined by `and`, `or`, `=>` or `!`, are one input together": ["joined"],
    "the node computes the inputs from left to right and no further than needed": ["no_further_than_needed"],
    "one that is not needed has its first value": ["no_further_than_needed"],
    "a variable that stands in such parts only is not needed by the supervisor": ["variables_of_the_node"],
    "parameters of functions may be objects and arrays; such a function is node-side": ["functions", "results"],
    "an error always happens; there a condition that reads an array is one input, false where it cannot be read": [
        "ends"
    ],
    "timed and silent transitions and conditions of requirements stay `variable-type`": ["no_event"],
    "the hint shows a variable that the event sets": ["hint"],
    "every construct works everywhere": [
        "verified",
        "saved",
        "instances",
        "parameters_of_instances",
        "ends_are_verified",
        "requirement_automata",
        "undo",
        "script",
        "log",
        "literals",
    ],
}
WAYPOINTS = Path(__file__).parent / "run" / "runtime" / "waypoints.rscd"
CART = """robot Cart {{
  interface scan use Scan from cart_msgs
  interface drive use Drive from cart_msgs
  datatype object Scan {{
    range: double ok: boolean level: integer(0..3) count: integer ranges: array(double) name: string mode: Mode
    parts: array(Part)
  }}
  datatype object Part {{ x: double size: integer(0..3) fine: boolean mode: Mode }}
  datatype enum Mode from integer to {{ value = 1 -> fast default -> slow }}
  parameter reach: double = 0.5
  {definitions}
  component Lidar {{
    outgoing message scan with identifier: "/scan", type: Scan links scan
    outgoing message kept with identifier: "/kept", type: Scan links scan
    incoming message move with identifier: "/move", type: none
    action drive with request: none, response: Scan, feedback: none links drive
    behaviour {{
      variable left: integer(0..5)
      variable near: boolean
      variable last: double
      variable place: string
      variable mode: Mode
      variable number: integer
      variable list: array(double)
      variable part: Part
      variable parts: array(Part)
      on response from kept
        do last := value.range, parts := value.parts, part := value.parts[0], list := value.ranges, place := value.name
      {transitions}
      initial marked state free {{ {free} on request to move on request to drive goto busy }}
      marked state busy {{ on response from drive goto free on error from drive goto free {busy} }}
    }}
  }}
  requirement move needs {needs}
  {more}
}}
"""


def cart(free: str = "", needs: str = "Lidar.near or Lidar.left > 2 or Lidar.mode = fast", **others: str) -> str:
    places = dict.fromkeys(("definitions", "transitions", "busy", "more"), "")
    return CART.format(**{**places, **others}, free=free, needs=needs)


def inputs(text: str) -> list[str | None]:
    """Return the texts of the inputs of a robot without errors; an input without a text is its name."""
    model = supervised(text)
    return [carried.text or carried.name for plant in model.plants for carried in plant.inputs]


def test_each_sentence_has_its_tests() -> None:
    tested = {name.removeprefix("test_") for name in globals() if name.startswith("test_")}
    assert {name for names in SENTENCES.values() for name in names} <= tested


# Inputs


@pytest.mark.parametrize(
    ("condition", "text"),
    [
        ("value.range < last", "value.range < Lidar.last"),
        ("last > 0.5", "Lidar.last > 0.5"),
        ("value.name = place", "value.name = Lidar.place"),
        ("value.ranges[left] < 0.5", "value.ranges[Lidar.left] < 0.5"),
        ("any r in value.ranges: r < last", "(any r in value.ranges: r < Lidar.last)"),
        ("size(list) > left", "size(Lidar.list) > Lidar.left"),
        ("sqrt(left) > 1.5", "sqrt(Lidar.left) > 1.5"),
        ("value.range < reach and free", "value.range < reach"),
        ("(value.range < reach) = (last < reach)", "value.range < reach"),
        ("if drive.running then value.range < last else near", "value.range < Lidar.last"),
        (
            "value.range * (if drive.running then 1.0 else 2.0) < last",
            "value.range * (if Lidar.drive.running then 1.0 else 2.0) < Lidar.last",
        ),
    ],
)
def test_conditions(condition: str, text: str) -> None:
    assert inputs(cart(f"on response from scan if {condition} do left := 1 goto busy"))[0] == text


@pytest.mark.parametrize(
    ("assignment", "text", "kind"),
    [
        ("near := value.range < last", "value.range < Lidar.last", "BooleanType"),
        ("left := size(parts)", "size(Lidar.parts)", "IntegerType(0, 5)"),
        ("left := floor(last) + left", "floor(Lidar.last) + Lidar.left", "IntegerType(0, 5)"),
        ("left := if near then floor(last) else 2", "floor(Lidar.last)", "IntegerType(0, 5)"),
        ("left := part.size + 1", "Lidar.part.size", "IntegerType(0, 3)"),
        ("mode := parts[number].mode", "Lidar.parts[Lidar.number].mode", "EnumerationType"),
    ],
)
def test_values(assignment: str, text: str, kind: str) -> None:
    model = supervised(cart(f"on response from scan do {assignment}"))
    (carried,) = [carried for plant in model.plants for carried in plant.inputs]
    bounds = f"({carried.type.minimum}, {carried.type.maximum})" if kind.startswith("Integer") else ""
    assert (carried.text, f"{carried.type.eClass.name}{bounds}") == (text, kind)


def test_data_without_a_range() -> None:
    assert inputs(cart("on response from scan if value.count > left goto busy")) == ["value.count > Lidar.left"]
    assert inputs(cart("on response from scan do near := value.count + left = 3")) == ["value.count + Lidar.left = 3"]
    text = cart("on response from scan do number := value.count", "Lidar.number > 3")
    assert {rule for rule, _ in errors(text)} == {"integer-range"}


@pytest.mark.parametrize(
    ("condition", "texts"),
    [
        ("part.fine", ["Lidar.part.fine"]),
        ("part.size > left", ["Lidar.part.size"]),
        ("parts[1].mode = mode", ["Lidar.parts[1].mode"]),
        ("near = (value.range < last)", ["value.range < Lidar.last"]),
        ("left > (if last < 0.5 then 1 else 2)", ["Lidar.last < 0.5"]),
        ("(if near then last else 0.5) > value.range", ["(if Lidar.near then Lidar.last else 0.5) > value.range"]),
    ],
)
def test_smallest_part(condition: str, texts: list[str]) -> None:
    assert inputs(cart(f"on response from scan if {condition} goto busy")) == texts


@pytest.mark.parametrize(
    ("condition", "texts"),
    [
        ("value.range < 0.5 and left > 0", ["value.range < 0.5"]),
        ("value.level = 2 and near", ["i_response_level"]),
        ("!(value.range < reach) or value.ok", ["!(value.range < reach) or value.ok"]),
        ("!(value.range < reach) or near", ["value.range < reach"]),
        ('left > 0 and value.level > left and value.name = "x"', ["i_response_level", 'value.name = "x"']),
    ],
)
def test_accepted_before(condition: str, texts: list[str]) -> None:
    assert inputs(cart(f"on response from scan if {condition} goto busy")) == texts


@pytest.mark.parametrize(
    ("condition", "texts"),
    [
        ("value.range < last and value.range < 0.5", ["value.range < Lidar.last and value.range < 0.5"]),
        ("value.range < last or !(part.fine)", ["value.range < Lidar.last or !Lidar.part.fine"]),
        ("part.fine => value.ok", ["Lidar.part.fine", "i_response_ok"]),
        ("part.fine => value.name = place", ["Lidar.part.fine => value.name = Lidar.place"]),
        ("!(value.range < last)", ["value.range < Lidar.last"]),
        ("near and (last < 0.5 or part.fine)", ["Lidar.last < 0.5 or Lidar.part.fine"]),
        ("last < 0.5 and near and part.fine", ["Lidar.last < 0.5", "Lidar.part.fine"]),
    ],
)
def test_joined(condition: str, texts: list[str]) -> None:
    assert inputs(cart(f"on response from scan if {condition} goto busy")) == texts


def test_variables_of_the_node() -> None:
    text = cart("on response from scan if value.count > left and near do left := left + 1, number := number + 1")
    model = supervised(text.replace("needs Lidar.near or Lidar.left > 2 or Lidar.mode = fast", "needs Lidar.near"))
    held = [variable.name for plant in model.plants for variable in plant.variables]
    assert held == ["near"]
    graph = robosc.to_rosgraph(robosc.load(text=text))
    assert {"last", "number", "parts"} <= {variable.name for variable in graph.variables}


def test_instances() -> None:
    """Equal texts of two instances are two inputs of the port that both hear."""
    text = """robot Two {
      component Sensor { outgoing message range with type: double }
      component Eye(limit: double) { behaviour {
        variable last: double
        variable near: boolean
        on response from Sensor.range if value < last + limit do last := value, near := true
        initial marked state on_ {}
      } }
      component Left is Eye(0.5)
      component Right is Eye(0.5)
      component Motor { incoming message go with type: none }
      requirement go needs !Left.near or !Right.near
    }"""
    assert inputs(text) == ["value < Left.last + 0.5", "value < Right.last + 0.5"]


def test_parameters_of_instances() -> None:
    """A parameter belongs to the component whose text reads it, not to the one that it hears."""
    text = """robot Two {
      component Sensor { outgoing message range with type: double }
      component Eye(first: double) {
        parameter reach: double = first
        behaviour { variable near: boolean
          on response from Sensor.range if value < reach do near := true
          initial marked state on_ {} }
      }
      component Left is Eye(0.5)
      component Right is Eye(0.25)
      component Motor { incoming message go with type: none }
      requirement go needs !Left.near or !Right.near
    }"""
    assert inputs(text) == ["value < Left.reach", "value < Right.reach"]
    assert proved(text)
    robot = robosc.load(text=text)
    assert [parameter.component for parameter in robosc.to_rosgraph(robot).parameters] == ["Left", "Right"]


def test_requirement_automata() -> None:
    """Their transitions have an event beside them, too, though they read no `value`."""
    automaton = """requirement Calm: automaton {
      initial marked state calm {
        on response from Lidar.scan if Lidar.last < 0.5 and Lidar.free goto alarmed
        on response from Lidar.scan
        on request to Lidar.move
      }
      marked state alarmed { on response from Lidar.scan goto calm }
    }"""
    text = cart(more=automaton)
    assert inputs(text) == ["Lidar.last < 0.5"]
    assert proved(text)


# Errors


@pytest.mark.parametrize(
    "text",
    [
        cart("transition if last < 0.5 goto busy"),
        cart("after 2 s do near := last < 0.5"),
        cart(needs="Lidar.last < 0.5"),
        cart("on request to move if last < 0.5"),
        cart(busy="on cancel from drive if last < 0.5 goto free"),
        cart(more="requirement never Lidar.last < 0.5"),
    ],
)
def test_no_event(text: str) -> None:
    assert {rule for rule, _ in errors(text)} == {"variable-type"}


def test_hint() -> None:
    found = robosc.check(robosc.load(text=cart(needs="Lidar.last < 0.5")))
    (hint,) = [finding.hint for finding in found if finding.rule == "variable-type"]
    assert hint == "set another variable where the data arrives, such as `do near := value.range < 0.5`"


# Functions


def test_functions() -> None:
    functions = """
      function close(a: Part, b: Part): boolean = hypot(a.x - b.x, 0.0) < reach and a.fine
      function any_close(all_parts: array(Part), b: Part): boolean = any p in all_parts: close(p, b)
      function third(numbers: array(double), i: integer): double = numbers[i + 2]
      function nested(scan: Scan, i: integer): boolean = close(scan.parts[i], scan.parts[i + 1])"""
    conditions = {
        "close(value.parts[0], part)": "hypot(value.parts[0].x - Lidar.part.x, 0.0) < reach and value.parts[0].fine",
        "any_close(parts, value.parts[left])": "(any p in Lidar.parts: hypot(p.x - value.parts[Lidar.left].x, 0.0)"
        " < reach and p.fine)",
        "third(value.ranges, number) > last": "value.ranges[Lidar.number + 2] > Lidar.last",
        "nested(value, number)": "hypot(value.parts[Lidar.number].x - value.parts[Lidar.number + 1].x, 0.0) < reach"
        " and value.parts[Lidar.number].fine",
    }
    for condition, text in conditions.items():
        robot = cart(f"on response from scan if {condition} goto busy", definitions=functions)
        assert inputs(robot)[0] == text


def test_results() -> None:
    """The result of a function is one value, and its argument has the type of the parameter."""
    same = "function same(a: array(double)): array(double) = a"
    found = errors(cart("on response from scan if size(same(list)) > 1 goto busy", definitions=same))
    assert [rule for rule, _ in found] == ["type"]
    part = "function fine(a: Part): boolean = a.fine"
    assert [rule for rule, _ in errors(cart("on response from scan if fine(value) goto busy", definitions=part))] == [
        "argument"
    ]


# Ends


def test_ends() -> None:
    conditions = {
        "value.ranges[0] < 0.5 or busy": ["value.ranges[0] < 0.5 or Lidar.busy"],
        "!(value.ranges[0] < last)": ["!(value.ranges[0] < Lidar.last)"],
        "near and parts[number].fine": ["Lidar.parts[Lidar.number].fine"],
        "near or parts[number].fine": ["Lidar.near or Lidar.parts[Lidar.number].fine"],
        "value.range < last or near": ["value.range < Lidar.last"],
    }
    for condition, texts in conditions.items():
        text = cart(busy=f"on error from drive if {condition} do left := 3 goto busy")
        text = text.replace("on error from drive goto free", "")
        assert inputs(text) == texts
    text = cart(busy="on error from drive do left := size(parts[number].x)").replace(
        "size(parts[number].x)", "parts[left].size"
    )
    text = text.replace("on error from drive goto free", "")
    assert inputs(text) == [
        "Lidar.parts[Lidar.left].size",
        "Lidar.parts[Lidar.left].size = Lidar.parts[Lidar.left].size",
    ]


# The node


def waypoint(x: float, y: float = 0.0) -> Record:
    position, orientation = point(x, y), Record(x=0.0, y=0.0, z=0.0, w=1.0)
    return Record(header=Record(frame_id=""), pose=Record(position=position, orientation=orientation))


def point(x: float, y: float = 0.0) -> Record:
    return Record(x=x, y=y, z=0.0)


@pytest.fixture
def world(tmp_path: Path) -> World:
    made = World(WAYPOINTS, tmp_path / "events.jsonl")
    made.port.types = {"poses": "geometry_msgs/PoseStamped[]", "frame_id": "string"}
    return made.start()


def place(world: World) -> tuple[str, bool]:
    state = world.controller._control.state
    return str(state["component_Mission"]), bool(state["Mission.moved"])


def drive(world: World) -> list[tuple[str, bool]]:
    """Return the places of the robot along a route."""
    world.hear("plan", poses=[waypoint(1.0), waypoint(2.0, 1.0)])
    world.wait(0.2)
    places = []
    for x, y in ((0.3, 0.0), (0.7, 0.0), (0.7, 0.0), (1.0, 1.0), (1.9, 1.1), (1.9, 1.1)):
        world.hear("position", x=x, y=y, z=0.0)
        world.wait(0.2)
        places.append(place(world))
    return places


def test_runtime(world: World) -> None:
    """The node compares its position with the next waypoint of the route that it stores."""
    assert drive(world) == [
        ("driving", False),
        ("arrived", False),
        ("driving", False),
        ("driving", True),
        ("arrived", True),
        ("waiting", True),
    ]


def test_no_further_than_needed(world: World) -> None:
    """A comparison that cannot be read keeps the event from happening only where a transition needs it."""
    world.hear("position", x=0.3, y=0.0, z=0.0)
    assert place(world)[0] == "waiting"
    (reception,) = [known for known in receptions(world.graph) if known.name == "position"]
    data = world.controller._data
    received = data.receive(reception.event, reception.inputs, point(0.3))
    assert received.inputs["i_response_c1"] is False
    world.hear("plan", poses=[waypoint(1.0)])
    data.variables.update({variable: 5 for variable in data.variables if variable.name == "next"})
    world.hear("position", x=1.0, y=0.0, z=0.0)
    assert place(world)[0] in {"ready", "driving"}
    assert any("there is no element 5 in an array of 1" in text for text in world.port.said)


# Simulation

PLAN = {"poses": [{"pose": {"position": {"x": 1.0}}}, {"pose": {"position": {"x": 2.0, "y": 1.0}}}]}
POSITIONS: Sequence[dict[str, float]] = [{"x": 0.3}, {"x": 0.9}, {"x": 0.9}, {"x": 1.9, "y": 1.1}, {"x": 1.9, "y": 1.1}]


def simulation() -> Simulation:
    robot = robosc.load(WAYPOINTS)
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    return Simulation(model, robosc.to_rosgraph(robot))


def test_simulation() -> None:
    run = simulation()
    run.perform("message_plan.u_response", {"value": PLAN})
    states = [run.perform("message_position.u_response", {"value": data}).state for data in POSITIONS]
    assert [state["component_Mission"] for state in states] == ["ready", "arrived", "ready", "arrived", "waiting"]


def test_undo() -> None:
    """A step back takes back what the node stored."""
    run = simulation()
    run.perform("message_plan.u_response", {"value": PLAN})
    stored = run.data.stored
    run.perform("message_plan.u_response", {"value": {"poses": PLAN["poses"][1:]}})
    run.undo()
    assert run.data.stored == stored
    assert run.perform("message_position.u_response", {"value": POSITIONS[1]}).state["component_Mission"] == "arrived"


def test_log(world: World) -> None:
    """A simulation plays the log of a node and reaches the same states."""
    drive(world)
    world.controller.close()
    done = CliRunner().invoke(main, ["simulate", str(WAYPOINTS), "--script", str(world.log)])
    assert done.exit_code == 0, done.output
    answers = [json.loads(line) for line in done.output.splitlines()]
    assert {answer["accepted"] for answer in answers} == {True}
    assert answers[-1]["state"]["component_Mission"] == place(world)[0] == "waiting"


def test_literals() -> None:
    """In stored data, the name of a literal may replace the data of an enum, too."""
    robot = robosc.load(text=cart("on response from scan if parts[number].mode = value.mode do near := true"))
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    for kept, mode in (("fast", "slow"), (0, 1), ("fast", 1)):
        run = Simulation(model, robosc.to_rosgraph(robot))
        run.perform("message_kept.u_response", {"value": {"parts": [{"mode": kept}]}})
        state = run.perform("message_scan.u_response", {"value": {"mode": mode}}).state
        assert state["Lidar.near"] is (kept == "fast" and mode == 1)


def test_script(tmp_path: Path) -> None:
    """A script may give an input itself, and the control loop follows stored data, too."""
    lines = [
        {"event": "message_plan.u_response", "data": {"value": PLAN}},
        *({"event": "message_position.u_response", "data": {"value": data}} for data in POSITIONS[:2]),
        {"event": "message_position.u_response", "data": {"where": {"Mission.next + 1 < size(Mission.route)": False}}},
    ]
    script = tmp_path / "script.jsonl"
    script.write_text("".join(f"{json.dumps(line)}\n" for line in lines))
    for options in ([], ["--loop"]):
        done = CliRunner().invoke(main, ["simulate", str(WAYPOINTS), "--script", str(script), *options])
        assert done.exit_code == 0, done.output
        states = [json.loads(line)["state"]["component_Mission"] for line in done.output.splitlines()]
        assert states == ["ready", "ready", "arrived", "waiting"]


# All views


def proved(text: str) -> bool:
    """Return whether the second reading of a robot agrees with the first, as everything else."""
    robot = robosc.load(text=text)
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    return validate_model(robot, model).outcome is Outcome.PROVED


@pytest.mark.parametrize(
    "condition",
    [
        "value.range < last",
        "sqrt(left) > 1.5 or near",
        "near and !(part.fine or any r in value.ranges: r < last)",
        "part.size > left and drive.running",
        "(if near then last else 0.5) > value.range * (if drive.running then 1.0 else 2.0)",
        "parts[number].mode = mode and value.count > left",
        "close(value.parts[left], part) => near",
    ],
)
def test_verified(condition: str) -> None:
    definitions = "function close(a: Part, b: Part): boolean = hypot(a.x - b.x, 0.0) < reach"
    assert proved(cart(f"on response from scan if {condition} goto busy", definitions=definitions))


def test_ends_are_verified() -> None:
    """Another reading of the text has the same inputs for the ends of goals."""
    busy = """on error from drive if near or parts[number].fine goto busy
      on error from drive if !(value.ranges[0] < last) and left > 1 do left := parts[left].size goto busy
      on error from drive if value.range < last do near := true goto busy"""
    assert proved(cart(busy=busy).replace("on error from drive goto free", ""))


def test_saved() -> None:
    """Saved models are valid, and keep the values of inputs."""
    robot = robosc.load(WAYPOINTS)
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    graph = robosc.to_rosgraph(robot)
    assert list(validity.faults(graph)) == []
    files = xmi.generate(Models(model, graph, robot), Configuration())
    assert any("Mission.route" in text for text in files.values())


# Random expressions: the node's input equals the expression in the robot's state


NUMBERS = st.sampled_from(["value.range", "last", "0.5", "left", "part.x", "1.25"])
ATOMS = st.one_of(
    st.tuples(NUMBERS, st.sampled_from(["<", ">="]), NUMBERS).map(lambda parts: f"({' '.join(parts)})"),
    st.sampled_from(["near", "free", "part.fine", "value.ok", "(left > 1)"]),
)
CONDITIONS = st.recursive(
    ATOMS,
    lambda inner: st.one_of(
        st.tuples(inner, st.sampled_from(["and", "or", "=>"]), inner).map(lambda parts: f"({' '.join(parts)})"),
        inner.map(lambda part: f"!({part})"),
    ),
    max_leaves=6,
)


def python(condition: str, values: dict[str, Any]) -> bool:
    """Return the value of a condition, computed by Python."""
    names = sorted(values, key=len, reverse=True)
    text = condition.replace("=>", "<=").replace("!(", "not_(")
    for number, name in enumerate(names):
        text = text.replace(name, f"v{number}_")
    named = {f"v{number}_": values[name] for number, name in enumerate(names)}
    return bool(eval(text, {"not_": lambda part: not part}, named))  # noqa: S307


@settings(max_examples=examples(25), deadline=None)
@given(
    CONDITIONS,
    st.lists(st.tuples(st.booleans(), st.sampled_from([0.25, 0.5, 0.75, 1.25, math.nan]), st.booleans()), max_size=6),
)
def test_random_expressions(condition: str, data: list[tuple[bool, float, bool]]) -> None:
    robot = robosc.load(text=cart(f"on response from scan if {condition} do left := left + 1, near := !near"))
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    graph = robosc.to_rosgraph(robot)
    for run in (Simulation(model, graph), LoopSimulation(model, graph)):
        values: dict[str, Any] = dict.fromkeys(("near", "part.fine"), False) | {"free": True, "left": 0}
        values |= dict.fromkeys(("last", "part.x"), 0.0)
        for is_kept, number, ok in data:
            part = {"x": number + 0.25, "fine": ok}
            values |= {"value.range": number, "value.ok": ok}
            if is_kept:
                values |= {"last": number, "part.x": part["x"], "part.fine": ok}
            elif python(condition, values):
                values |= {"left": min(values["left"] + 1, 5), "near": not values["near"]}
            scan = json.dumps({"range": number, "ok": ok, "parts": [part]}).replace("NaN", "null")
            event = f"message_{'kept' if is_kept else 'scan'}.u_response"
            step = run.perform if isinstance(run, Simulation) else run.step
            answer = step(event, {"value": json.loads(scan)})
            state = answer["state"] if isinstance(answer, dict) else answer.state
            assert (state["Lidar.left"], state["Lidar.near"]) == (values["left"], values["near"])
