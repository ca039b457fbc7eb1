"""Limits, sentence by sentence: `SENTENCES` maps each sentence about them to the tests that hold it."""

from __future__ import annotations

import json
import math
import re
import shutil
from typing import TYPE_CHECKING, Any

import pytest
from click.testing import CliRunner
from jsonschema import Draft202012Validator

import robosc
from robosc.base.diagnostics import ModelError
from robosc.base.files.resources import locate
from robosc.base.ros_types import RosTypes
from robosc.language.completion import proposals
from robosc.language.configuration import Configuration
from robosc.language.hover import describe
from robosc.language.reading import read
from robosc.language.semantic_tokens import classify
from robosc.language.text import Documents
from robosc.m2t import xmi
from robosc.m2t.models import Models
from robosc.m2t.targets import TARGETS
from robosc.model import validity
from robosc.model.semantics.evaluation import single_precision
from robosc.run.node_tests import trace_player
from robosc.run.node_tests.trace_test import trace_test_of
from robosc.tools.cli import main
from tests.language.second_edition import errors
from tests.m2t.cpp.test_headers import run
from tests.run.node_tests.in_process_node import InProcessNode
from tests.run.runtime.fake import LayerBench, Record, World
from tests.run.runtime.fake import supervised as graph_of

if TYPE_CHECKING:
    from pathlib import Path

    from click.testing import Result

    from robosc.language.reading import Reading

#: Each sentence of the specification of limits, with the tests that hold it.
SENTENCES = {
    "limit changes data instead of forbidding it": ["synthesis", "applies"],
    "it is for incoming messages": ["provisioning"],
    "it applies after `provide`": ["applies"],
    "in a layer it applies to what the controller sent": ["layer"],
    "fields that the object names are replaced, arrays as a whole": ["fields"],
    "other fields stay, also those that the model does not know": ["fields", "layer"],
    "all limits whose condition holds apply, each to the result of the one before": ["order"],
    "first those in components, then those outside, in the order of the text": ["order", "fleet"],
    "condition and data may read `value`, variables, states, constants and parameters": ["reads"],
    "of a message of a basic type the expression is the new data": ["basic"],
    "`send: change` compares after limits": ["on_change"],
    "limit of anything but an incoming message with data is `data-provisioning`": ["provisioning"],
    "it may stand where `provide` may": ["places"],
    "`limit` stays a name": ["name"],
    "data are typed as for `provide`, the condition is boolean": ["types"],
    "what only a limit reads is no variable of the supervisor": ["synthesis"],
    "a double that is not finite withholds the command": ["not_finite", "layer_not_finite"],
    "data that cannot be read withhold the command": ["unreadable"],
    "literals, constants and parameters compared with a float32 are narrowed": ["single_precision"],
    "in scenarios `sent with` sees the limited data": ["scenario"],
    "the saved models have it": ["saved"],
    "generated nodes apply it": ["generated_nodes", "compiled_layer", "traces"],
    "verify reads it": ["verify"],
    "format, hover and completion know it": ["format", "editor"],
}

#: A base whose speed is limited near a person.
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
    outgoing message top with identifier: "/top", type: double
    behaviour {
      variable most: double = 0.5
      on response from top do most := value
      initial marked state ready {}
    }
  }

  provide velocity with { linear: { x: Base.most, y: 0.1 }, angular: { z: 0.9 } }
  limit velocity with { linear: { x: max(-0.3, min(value.linear.x, 0.3)) } } if Person.near
}
"""


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


def command(*arguments: str) -> Result:
    return CliRunner().invoke(main, list(arguments))


def world_of(folder: Path, text: str = BASE, types: dict[str, str] | None = None) -> World:
    world = World(written(folder, text), folder / "log.jsonl")
    world.port.types = types or {}
    return world.start()


def sent(world: World, topic: str = "/velocity") -> Any:
    """Return what the controller sends next."""
    world.port.sent.clear()
    world.wait(0.15)
    return next((data for name, data in world.port.sent if name == topic), None)


def twist(x: float, z: float = 0.0) -> Record:
    return Record(linear=Record(x=x), angular=Record(z=z), unknown=7.0)


def test_each_sentence_has_its_tests() -> None:
    names = {name.removeprefix("test_") for name in globals() if name.startswith("test_")}
    assert {name for tests in SENTENCES.values() for name in tests} <= names


# The language


@pytest.mark.parametrize(
    ("kind", "message"),
    [
        ('outgoing message x with identifier: "/x", type: boolean', "`x`, which the controller receives"),
        ("incoming message x with type: none", "`x`, which is declared with the type `none`"),
        ("service x with request: std_srvs/SetBool, response: std_srvs/SetBool", "the service `x`"),
    ],
)
def test_provisioning(kind: str, message: str) -> None:
    text = f"robot R {{ component C {{ {kind} }} limit x with true }}"
    (finding,) = [each for each in robosc.check(robosc.load(text=text)) if each.rule == "data-provisioning"]
    assert finding.message == f"a limit changes the data of {message}, expected an incoming message with data"


def test_places() -> None:
    inside = changed("limit velocity", "property never false\n  limit velocity")
    assert errors(inside) == []
    assert errors(changed("      initial marked state ready {}\n    }\n", "      initial marked state ready {}\n    }\n"
                          "    limit velocity with { linear: { y: 0.0 } }\n")) == []  # fmt: skip
    with pytest.raises(ModelError, match="a library has no limit statements"):
        robosc.load(text="library L { component C { incoming message m with type: boolean } limit m with true }")


def test_name() -> None:
    text = """robot limit {
      component limit {
        incoming message limit with type: boolean
        behaviour { variable limit_: boolean initial marked state limit {} }
        limit limit with !value if limit.limit
      }
      requirement limit needs limit.limit
      limit limit.limit with true
      limit limit with value
    }"""
    assert errors(text) == []


@pytest.mark.parametrize(
    ("limit", "rule"),
    [
        ("limit velocity with { linear: { x: true } }", "type"),
        ("limit velocity with 1.0", "type"),
        ("limit velocity with { linear: { x: 0.0 } } if value.linear.x", "type"),
        ("limit velocity with { linear: { q: 0.0 } }", "unresolved-reference"),
        ("limit velocity with { linear: { x: 0.0 }, linear: { y: 0.0 } }", "unique-property"),
        ("limit velocity with { linear: { x: value.angular } }", "type"),
        ("limit velocity with { angular: value.linear } if value.linear.x > 0.2", None),
        ("limit velocity with if value.linear.x > 0.0 then { linear: { x: 0.0 } } else { linear: { y: 0.0 } }", None),
    ],
)
def test_types(limit: str, rule: str | None) -> None:
    assert [found for found, _ in errors(more(limit))] == ([] if rule is None else [rule])


def test_synthesis() -> None:
    """A limit changes neither plants nor the supervisor, and its variables stay in the node."""
    limit = "  limit velocity with { linear: { x: max(-0.3, min(value.linear.x, 0.3)) } } if Person.near\n"
    with_limit = robosc.to_sct(
        robosc.load(text=more("limit velocity with { linear: { x: Base.most } } if Base.most > 0.1"))
    )
    without = robosc.to_sct(robosc.load(text=changed(limit, "")))
    for model in (with_limit, without):
        robosc.synthesize(model)
    assert [plant.name for plant in with_limit.plants] == [plant.name for plant in without.plants]
    assert [variable.name for plant in with_limit.plants for variable in plant.variables] == []
    assert with_limit.requirements == without.requirements == []


@pytest.mark.slow
def test_verify(tmp_path: Path) -> None:
    """Its second reading accepts limits, also in components."""
    verified = command("verify", str(written(tmp_path)))
    assert verified.exit_code == 0, verified.output
    assert "refuted" not in verified.output


def test_editor(tmp_path: Path) -> None:
    path = tmp_path / "cart.rscd"

    def read_text(text: str) -> Reading:
        return read(path, documents=Documents({str(path): text}))

    def proposed(text: str) -> set[str]:
        offset = text.index("¦")
        return {each.text for each in proposals(text.replace("¦", ""), offset, read_text, RosTypes(), list)[2]}

    assert "limit" in proposed(more("¦"))
    assert "velocity" in proposed(more("limit ¦ with true"))
    assert "top" not in proposed(more("limit ¦ with true"))
    assert {"linear", "angular"} <= proposed(more("limit velocity with { linear: value.¦ }"))
    assert {"value", "Person"} <= proposed(more("limit velocity with { linear: { x: 0.0 } } if ¦"))
    reading = read_text(BASE)
    assert reading.base is not None
    velocity = next(each for each in reading.base.eAllContents() if getattr(each, "name", "") == "velocity")
    assert "Restricted by:\n- `limit velocity with" in str(describe(reading, velocity, RosTypes()))
    words = {BASE[word.start : word.end]: word.what for word in classify(reading.file)}
    assert words["limit"] == "keyword"


def test_format(tmp_path: Path) -> None:
    path = written(tmp_path, changed("limit velocity with {", "limit  velocity\nwith{"))
    assert command("format", str(path)).exit_code == 0
    assert path.read_text() == BASE


# A controller


def test_applies(tmp_path: Path) -> None:
    world = world_of(tmp_path)
    assert sent(world) == {"linear": {"x": 0.5, "y": 0.1}, "angular": {"z": 0.9}}
    world.hear("seen", data=True)
    assert sent(world) == {"linear": {"x": 0.3, "y": 0.1}, "angular": {"z": 0.9}}
    world.hear("top", data=-2.0)
    assert sent(world)["linear"] == {"x": -0.3, "y": 0.1}
    world.controller.flush_log()
    lines = [json.loads(line) for line in world.log.read_text().splitlines()]
    assert lines[-1]["data"] == {"value": {"linear": {"x": -0.3, "y": 0.1}, "angular": {"z": 0.9}}}


def test_fields(tmp_path: Path) -> None:
    text = """robot R {
      component C { incoming message joints with identifier: "/joints", type: sensor_msgs/JointState }
      provide joints with { name: ["a", "b"], position: [1.0, 2.0, 3.0], velocity: [4.0] }
      limit joints with { position: [value.position[1], 9.0], velocity: value.position }
    }"""
    assert sent(world_of(tmp_path, text, ARRAYS), "/joints") == {
        "name": ["a", "b"],
        "position": [2.0, 9.0],
        "velocity": [1.0, 2.0, 3.0],
    }


def test_order(tmp_path: Path) -> None:
    text = changed(
        "  provide velocity", "  limit velocity with { linear: { y: value.linear.y * 2 } }\n  provide velocity"
    )
    text = more("  limit velocity with { linear: { y: value.linear.y + 1 } } if value.linear.y > 0.5", text)
    text = more("  limit velocity with { linear: { y: 7.0 } } if value.linear.y > 100.0", text)
    inner = "      initial marked state ready {}\n    }\n"
    text = changed(inner, inner + "    limit velocity with { linear: { y: value.linear.y + 0.4 } }\n", text)
    assert sent(world_of(tmp_path, text))["linear"]["y"] == (0.1 + 0.4) * 2 + 1


def test_fleet(tmp_path: Path) -> None:
    """A limit in a template applies to each instance, before those outside."""
    text = """robot R {
      component Cell(ns: string, most: double) {
        incoming message speed with identifier: ns + "/speed", type: std_msgs/Float64
        limit speed with { data: min(value.data, most) }
      }
      component Line[1..2] is Cell(ns: "/line" + text(number), most: 0.5)
      provide Line[1].speed with { data: 2.0 }
      provide Line[2].speed with { data: 0.25 }
      limit Line[2].speed with { data: value.data * 2 }
    }"""
    world = world_of(tmp_path, text)
    assert (sent(world, "/line1/speed"), sent(world, "/line2/speed")) == ({"data": 0.5}, {"data": 0.5})


def test_reads(tmp_path: Path) -> None:
    text = more(
        """
  constant scale: double = 0.5
  parameter gain: double = 3.0
  condition watched = Person.near
  function twice(x: double): double = x * 2
  limit velocity with { angular: { z: twice(value.linear.x) * scale * gain + Base.most } }
    if watched and Base.ready and value.linear.x > 0.0
"""
    )
    world = world_of(tmp_path, text)
    assert sent(world)["angular"] == {"z": 0.9}
    world.hear("seen", data=True)
    assert sent(world)["angular"] == {"z": 0.3 * 2 * 0.5 * 3.0 + 0.5}


#: Types of fields in ROS.
SINGLE = {"data": "float32"}
ARRAYS = {"name": "string[]", **dict.fromkeys(("position", "velocity", "effort"), "float64[]")}
LAMP = """robot R {
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
  component Lamp {
    incoming message light with identifier: "/light", type: double, send: change
    outgoing message wish with identifier: "/wish", type: double
    behaviour {
      variable level: double = 1.0
      on response from wish do level := value
      initial marked state ready {}
    }
  }
  parameter most: double = 0.7
  provide light with Lamp.level
  limit light with min(value, most) if Person.near
  limit light with -1.0 if value > most and Person.near
  limit light with -2.0 if value = 0.7 and Person.far
}
"""


def test_basic(tmp_path: Path) -> None:
    world = world_of(tmp_path, LAMP, SINGLE)
    assert sent(world, "/light") == {"data": 1.0}
    world.hear("seen", data=True)
    assert sent(world, "/light") == {"data": single_precision(0.7)}


def test_on_change(tmp_path: Path) -> None:
    world = world_of(tmp_path, LAMP, SINGLE)
    world.hear("seen", data=True)
    assert sent(world, "/light") == {"data": single_precision(0.7)}
    world.hear("wish", data=5.0)
    assert sent(world, "/light") is None, "the limited data are the same"
    world.hear("wish", data=0.25)
    assert sent(world, "/light") == {"data": 0.25}


def test_single_precision(tmp_path: Path) -> None:
    """A field that was limited to a number is not above the number."""
    world = world_of(tmp_path, LAMP, SINGLE)
    world.hear("seen", data=True)
    assert sent(world, "/light") == {"data": single_precision(0.7)} != {"data": 0.7}
    world.hear("wish", data=0.7)
    world.hear("seen", data=False)
    assert sent(world, "/light") == {"data": -2.0}


def test_not_finite(tmp_path: Path) -> None:
    world = world_of(tmp_path, more("limit velocity with { linear: { x: 1.0 / (Base.most - 0.5) } } if Base.ready"))
    assert sent(world) is None
    assert any("velocity is withheld: its linear.x would not be finite" in text for text in world.port.said)
    world.hear("top", data=1.0)
    assert sent(world)["linear"]["x"] == 2.0


def test_unreadable(tmp_path: Path) -> None:
    text = """robot R {
      component C { incoming message joints with identifier: "/joints", type: sensor_msgs/JointState }
      provide joints with { position: [1.0] }
      limit joints with { effort: [value.position[1]] }
    }"""
    world = world_of(tmp_path, text, ARRAYS)
    assert sent(world, "/joints") is None
    assert any("joints is withheld: there is no element 1 in an array of 1" in text for text in world.port.said)


# A layer


def test_layer(tmp_path: Path) -> None:
    bench = LayerBench(written(tmp_path))
    given = twist(2.0, 0.5)
    assert bench.forwarded("velocity", given) == {"linear": {"x": 2.0}, "angular": {"z": 0.5}, "unknown": 7.0}
    bench.hear("/seen", data=True)
    assert bench.forwarded("velocity", given) == {"linear": {"x": 0.3}, "angular": {"z": 0.5}, "unknown": 7.0}
    assert given.plain()["linear"] == {"x": 2.0}, "the message of the controller stays"


@pytest.mark.parametrize("number", [math.nan, math.inf])
@pytest.mark.parametrize("near", [True, False])
def test_layer_not_finite(tmp_path: Path, number: float, near: bool) -> None:
    bench = LayerBench(written(tmp_path), "velocity")
    bench.hear("/seen", data=near)
    assert bench.forwarded("velocity", twist(0.1)) is not None
    assert bench.forwarded("velocity", twist(number)) is None
    report = bench.blocked()
    assert (report["reason"], report["because"]) == ("data", ["its linear.x would not be finite"])
    schema = json.loads(locate("schemas/blocked.schema.json").read_text(encoding="utf-8"))
    Draft202012Validator(schema).validate(report)
    ((topic, data),) = bench.port.sent
    assert (topic, data["linear"]["x"]) == ("/velocity", 0.3 if near else 0.5), "onBlocked"
    assert bench.forwarded("velocity", twist(0.1, number)) is not None, "no limit reads it"


# Tools


def test_scenario(tmp_path: Path) -> None:
    path = written(tmp_path)
    scenarios = tmp_path / "cart.scenarios"
    scenarios.write_text(
        'scenario "slow near a person"\n'
        '  expect velocity sent with { "linear": { "x": 0.5 } }\n'
        "  seen with true\n"
        "  wait 200 ms\n"
        '  expect velocity sent with { "linear": { "x": 0.3 } }\n'
    )
    played = command("test", str(path), str(scenarios))
    assert played.exit_code == 0, played.output


def test_traces(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The tests of a package expect the limited data."""
    for name, seconds in {"SETTLED": 0.0, "REACTION": 0.0, "ANSWER": 0.0, "PATIENCE": 0.05}.items():
        monkeypatch.setattr(trace_player, name, seconds)
    graph = graph_of(written(tmp_path))
    configuration = Configuration()
    planned = trace_test_of(TARGETS["ros2"], Models(graph.model, graph), configuration)
    assert planned is not None
    connections = json.loads(planned.files["connections.json"])
    speeds = set()
    for number, name in enumerate(each for each in planned.files if each.endswith(".jsonl")):
        trace = tmp_path / f"trace{number}.jsonl"
        trace.write_text(planned.files[name])
        lines = trace_player.read_trace(str(trace))
        data = [json.loads(line)["data"] for line in planned.files[name].splitlines() if "c_trigger" in line]
        speeds |= {each["value"]["linear"]["x"] for each in data}
        log = tmp_path / f"events{number}.jsonl"
        node = InProcessNode(connections, graph, configuration, log)
        trace_player.Player(connections, node, trace_player.Log(str(log))).play(lines)
    assert {0.5, 0.3} <= speeds


def test_saved(tmp_path: Path) -> None:
    """Saved models have the limits, and give the same nodes."""
    robot = robosc.load(written(tmp_path))
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    graph = robosc.to_rosgraph(robot)
    files = xmi.generate(Models(model, graph, robot), Configuration())
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    saved = validity.load(tmp_path / "Cart.rosgraph.xmi")
    expected = robosc.generate("ros2", Models(model, graph), Configuration())
    assert robosc.generate("ros2", Models(saved.model, saved), Configuration()) == expected
    again = robosc.load(tmp_path / "Cart.robosc.xmi")
    assert len(robosc.to_rosgraph(again).publishers[0].sendings[0].limits) == 1


@pytest.mark.parametrize("target", ["ros1", "ros2", "ros2-layer"])
def test_generated_nodes(tmp_path: Path, target: str) -> None:
    graph = graph_of(written(tmp_path))
    files = robosc.generate(target, Models(graph.model, graph), Configuration())
    node = next(text for path, text in files.items() if path.endswith("_node.cpp"))
    assert "supervisor_.state.component_Person == cart_component_Person_near) {" in node
    assert 'write.set("linear.x", data.linear.x, larger(-0.3, smaller(double(before.linear.x), 0.3)));' in node
    assert 'write.require("linear.x", data.linear.x);' in node
    assert ("BlockReasons::unsendable(unsendable)" in node) == (target == "ros2-layer")


@pytest.mark.build
@pytest.mark.skipif(shutil.which("g++") is None, reason="no g++")
def test_compiled_layer(tmp_path: Path) -> None:
    """It forwards limited messages, and blocks one with a number that is not finite."""
    graph = graph_of(written(tmp_path))
    files = robosc.generate("ros2-layer", Models(graph.model, graph), Configuration(on_blocked=["velocity"]))
    node = next(text for path, text in files.items() if path.endswith("_node.cpp"))
    signature = r"^  (?:bool (?:pass|forward|prepare)|void (?:limit|send))_velocity\([^\n]*\) \{\n.*?^  \}\n"
    functions = "\n".join(re.findall(signature, node, re.DOTALL | re.MULTILINE))
    sources = {
        name: text for name in ("h", "c") for path, text in files.items() if path.endswith(f"_supervisor.{name}")
    }
    files |= {"include/cart_supervisor.h": sources["h"], "include/forwarding.inc": functions}
    (tmp_path / "cart_supervisor.c").write_text(sources["c"])
    assert run("g++", "forwarding.cpp", "address,undefined", files, tmp_path, tmp_path / "cart_supervisor.c") == (
        0,
        "",
        "",
    )
