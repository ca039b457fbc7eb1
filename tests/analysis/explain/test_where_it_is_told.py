"""The supervisor stores why synthesis forbids an event, and every relevant output shows this."""

import json
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

import robosc
from robosc.base.files.resources import locate
from robosc.language.configuration import Configuration
from robosc.language.configuration.parameters import layer_parameters
from robosc.m2t.models import Models
from robosc.model import rosgraph
from robosc.model.semantics.roles import event_name
from robosc.model.validity import load
from robosc.run.runtime.core.event_loop import EventLoop
from robosc.run.runtime.core.layer import Layer
from robosc.run.runtime.core.settings import Settings
from robosc.run.simulation import Simulation
from robosc.run.simulation.session import Session
from tests.run.runtime.fake import FakePort, Record, supervised

PORTER = Path(__file__).parent / "porter.rscd"
WHY = (
    "after request to `Door.open`, then request to `Base.enter`, response from `Door.closed` cannot be prevented, and"
    " then `Base` cannot get back to a marked state"
)


@pytest.fixture
def porter() -> rosgraph.RosGraph:
    return supervised(PORTER)


def test_the_supervisor_knows(porter: rosgraph.RosGraph) -> None:
    guards = {event_name(guard.event): guard for guard in porter.model.supervisor.guards}
    assert {name for name, guard in guards.items() if guard.explanation} == {"message_enter.c_trigger"}
    assert guards["message_enter.c_trigger"].explanation == WHY
    # Events that no requirement forbids have no requirements behind their guards.
    behind = {name: [requirement.text for requirement in guard.requirements] for name, guard in guards.items()}
    assert behind == {
        "message_open.c_trigger": [],
        "message_hold.c_trigger": [],
        "message_release.c_trigger": ["requirement release needs Base.lobby"],
        "message_enter.c_trigger": ["requirement enter needs Door.ajar or Door.held"],
        "message_leave.c_trigger": [],
    }


def test_a_saved_supervisor_knows_it_still(porter: rosgraph.RosGraph, tmp_path: Path) -> None:
    for name, text in robosc.generate("xmi", Models(porter.model, porter)).items():
        (tmp_path / name).write_text(text)
    read = load(str(tmp_path / "Porter.sct.xmi"))
    guards = [(guard.explanation, [own.text for own in guard.requirements]) for guard in read.supervisor.guards]
    assert guards == [
        (guard.explanation, [own.text for own in guard.requirements]) for guard in porter.model.supervisor.guards
    ]


def flowing(text: str) -> str:
    """Return a text without line breaks and comment signs."""
    return " ".join(text.replace("//", " ").replace("*", " ").replace("-", " ").split())


@pytest.mark.parametrize(
    ("target", "file"),
    [
        ("supervisor", "porter_supervisor.c"),
        ("supervisor", "porter_supervisor.h"),
        ("ros1", "src/porter_controller_node.cpp"),
        ("ros2", "src/porter_controller_node.cpp"),
    ],
)
def test_generated_code_says_it_in_comments(porter: rosgraph.RosGraph, target: str, file: str) -> None:
    text = flowing(robosc.generate(target, Models(porter.model, porter))[file])
    assert text.count(flowing(f"synthesis prevents this: {WHY}")) == 1


def test_a_generated_layer_says_it_when_it_blocks(porter: rosgraph.RosGraph) -> None:
    text = robosc.generate("ros2-layer", Models(porter.model, porter))["src/porter_layer_node.cpp"]
    [literal] = [line.strip() for line in text.splitlines() if "add_consequence" in line]
    assert literal == f'reasons.add_consequence("{WHY}");'
    entering = text.partition("bool pass_enter()")[2].partition("\n  }\n\n")[0]
    assert "against_enter()" in entering
    assert literal in text.partition("BlockReasons against_enter() const")[2].partition("\n  }\n\n")[0]


def test_so_does_a_layer_that_runs(porter: rosgraph.RosGraph, tmp_path: Path) -> None:
    port, configuration = FakePort(), Configuration()
    values = {
        parameter.name: parameter.default
        for parameter in layer_parameters(porter, configuration, str(tmp_path / "log"))
    }
    layer = Layer(porter, Settings(values, configuration), port, EventLoop(lambda: port.time))
    layer.start()
    sendings = {sending.name: sending for publisher in porter.publishers for sending in publisher.sendings}
    assert layer.forwarded(sendings["open"], Record()) is not None
    assert layer.forwarded(sendings["enter"], Record()) is None
    [report] = [json.loads(text) for topic, text in port.told if topic == "blocked"]
    assert (report["name"], report["reason"], report["because"]) == ("Base.enter", "synthesis", [WHY])
    schema = json.loads(locate("schemas/blocked.schema.json").read_text(encoding="utf-8"))
    Draft202012Validator(schema).validate(report)
    layer.close()


def test_and_a_simulation(porter: rosgraph.RosGraph) -> None:
    session = Session(Simulation(porter.model, porter), seed=0)
    session.do("message_open.c_trigger")
    assert session.do("message_enter.c_trigger") == (
        f"message_enter.c_trigger: forbidden by synthesis, which requires component_Door.held; otherwise, {WHY}"
    )
