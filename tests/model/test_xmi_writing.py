"""Write models as XMI: the order of the text, which depends on the model only."""
# ruff: noqa: E501 - XML declares its namespaces in one line.

import re
from typing import Any

import pytest

from robosc.base.diagnostics import ModelError, Span
from robosc.model import expression as ex
from robosc.model import robosc, rosgraph, sct
from robosc.model.places import Place
from robosc.model.validity import load
from robosc.model.xmi import to_texts
from robosc.model.xmi.format import DEEPEST
from tests.sct_models import edge, model, needs, plant


def machine() -> sct.SupervisoryControlModel:
    return model(
        [
            plant(
                "machine",
                {"idle": [edge("start", when="not n", do={"n": "true"})]},
                controllable=["start"],
                variables={"n": "bool"},
            )
        ],
        [needs("start", "machine.idle")],
        name="robot",
    )


def test_a_model_reads_like_its_metamodel() -> None:
    assert to_texts({"robot.sct.xmi": machine()}) == {
        "robot.sct.xmi": """\
<?xml version="1.0" encoding="UTF-8"?>
<sct:SupervisoryControlModel xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:expression="urn:robosc:expression:1" xmlns:sct="urn:robosc:sct:1"
    name="robot" supervised="false">
  <plants name="machine" kind="behaviour">
    <events name="start" controllable="true" kind="trigger"/>
    <variables name="n">
      <type xsi:type="expression:BooleanType"/>
      <initial xsi:type="expression:BooleanLiteral" value="false"/>
    </variables>
    <locations name="idle" initial="true" marked="true">
      <edges event="//@plants.0/@events.0" target="//@plants.0/@locations.0">
        <guard xsi:type="expression:Negation">
          <operand xsi:type="sct:VariableReference" variable="//@plants.0/@variables.0"/>
        </guard>
        <updates variable="//@plants.0/@variables.0">
          <value xsi:type="expression:BooleanLiteral" value="true"/>
        </updates>
      </edges>
    </locations>
  </plants>
  <requirements event="//@plants.0/@events.0" kind="needs">
    <condition xsi:type="sct:LocationReference" location="//@plants.0/@locations.0"/>
  </requirements>
</sct:SupervisoryControlModel>
"""
    }


def test_the_order_of_construction_does_not_show() -> None:
    backwards = sct.Plant(kind=sct.PlantKind.message)
    backwards.locations.append(sct.Location(marked=True, name="ready", initial=True))
    event = sct.Event(kind=sct.EventKind.trigger)
    backwards.events.append(event)
    backwards.topic = "/t"
    event.controllable = True
    event.name = "c_trigger"
    backwards.name = "message_x"
    forwards = sct.Plant(
        name="message_x",
        kind=sct.PlantKind.message,
        topic="/t",
        events=[sct.Event(name="c_trigger", controllable=True, kind=sct.EventKind.trigger)],
        locations=[sct.Location(name="ready", initial=True, marked=True)],
    )
    first, second = (
        to_texts({"x": sct.SupervisoryControlModel(name="robot", plants=[automaton])})
        for automaton in (backwards, forwards)
    )
    assert first == second


def test_references_between_files_are_relative(tmp_path: Any) -> None:
    graph = rosgraph.RosGraph(name="robot", model=machine())
    for prefix in ("", "deep/er/"):
        texts = to_texts({f"{prefix}graphs/a b.xmi": graph, f"{prefix}robot.sct.xmi": graph.model})
        assert '<model href="../robot.sct.xmi#/"/>' in texts[f"{prefix}graphs/a b.xmi"]
    below = to_texts({"graph.xmi": graph, "models/the robot.sct.xmi": graph.model})
    assert '<model href="models/the%20robot.sct.xmi#/"/>' in below["graph.xmi"]
    for name, text in below.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    assert load(tmp_path / "graph.xmi").model.plants[0].name == "machine"


def test_a_reference_to_a_model_that_is_not_saved_is_a_mistake_of_the_caller() -> None:
    with pytest.raises(ValueError, match="model of a RosGraph refers to a SupervisoryControlModel of no saved model"):
        to_texts({"graph.xmi": rosgraph.RosGraph(name="robot", model=machine())})


TEXTS = ["", " blank ", "<&>\"'", "two\nlines\r\n\tand more", "]]>", "größer 漢字 🤖", "&#10;", "\ufffd"]


@pytest.mark.parametrize("text", TEXTS)
def test_every_text_comes_back(text: str, tmp_path: Any) -> None:
    robot = robosc.Robot(name="r", file=text)
    (tmp_path / "r.xmi").write_bytes(to_texts({"r.xmi": robot})["r.xmi"].encode())
    assert load(tmp_path / "r.xmi").file == text


@pytest.mark.parametrize("value", [0, 7, 2**63 - 1])
def test_integers_come_back(value: int, tmp_path: Any) -> None:
    saved = model([plant("p", {"s": []})])
    states = 10**5000 + 1  # more digits than Python prints by default
    saved.supervisor = sct.Supervisor(
        uncontrolledStates=states, controlledStates=0, bddNodes=value, settlingBound=value
    )
    (tmp_path / "r.xmi").write_text(to_texts({"r.xmi": saved})["r.xmi"])
    supervisor = load(tmp_path / "r.xmi").supervisor
    assert (supervisor.bddNodes, supervisor.settlingBound, supervisor.uncontrolledStates) == (value, value, states)


@pytest.mark.parametrize("value", [0.0, 0.1, 1e300, 5e-324, 123456789.125])
def test_doubles_come_back(value: float, tmp_path: Any) -> None:
    graph = rosgraph.RosGraph(
        name="r",
        model=machine(),
        variables=[
            rosgraph.NodeVariable(name="v", component="C", type=ex.DoubleType(), initial=ex.DoubleLiteral(value=value))
        ],
    )
    for name, text in to_texts({"r.xmi": graph, "s.xmi": graph.model}).items():
        (tmp_path / name).write_text(text)
    assert load(tmp_path / "r.xmi").variables[0].initial.value == value


def test_lists_of_texts_are_elements(texts: dict[str, str]) -> None:
    path = re.search(r"<path>pose</path>\s*<path>x</path>", texts["Warehouse.rosgraph.xmi"])
    assert path


def test_what_xml_cannot_hold_is_located() -> None:
    saved = machine()
    saved.plants[0].origin = "bell \x07"
    saved.plants[0].source = Place.parse("robot.rscd:3:1-4:2")
    with pytest.raises(ModelError) as raised:
        to_texts({"x": saved})
    [finding] = raised.value.diagnostics
    assert (finding.file, finding.span, finding.rule) == ("robot.rscd", Span(3, 1, 4, 2), "xmi")


def nested(depth: int) -> sct.SupervisoryControlModel:
    saved = machine()
    condition: ex.Expression = saved.requirements[0].condition
    for _ in range(depth):
        condition = ex.Negation(operand=condition)
    saved.requirements[0].condition = condition
    return saved


@pytest.mark.slow
def test_depth_is_bounded(tmp_path: Any) -> None:
    text = to_texts({"x.xmi": nested(DEEPEST - 3)})["x.xmi"]
    (tmp_path / "x.xmi").write_text(text)
    assert to_texts({"x.xmi": load(tmp_path / "x.xmi")})["x.xmi"] == text
    with pytest.raises(ModelError, match="more than 6000 elements"):
        to_texts({"x.xmi": nested(DEEPEST)})
