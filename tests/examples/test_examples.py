"""The examples have no unexpected findings, and their guards and targets match the documentation."""

import json
import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from robosc.language.reading import read
from robosc.model import robosc as rsc
from robosc.tools.cli import main
from robosc.tools.diagrams import behaviour_graph, diagram, ros_graph
from tests.searching import slow_but

from .conftest import EXAMPLES, MODELS, PAGES, SCENARIOS, SHOWCASES, models_of

GUARDS = Path(__file__).with_name("guards")
#: Targets for controllers with services or actions, and targets for controllers with messages only.
ALL, MESSAGES = "cif,supervisor,xmi", "cif,supervisor,xmi,ros1,ros2"
#: The packages of detectors are not installed everywhere.
EXPECTED = {"interface-unknown"}
EACH = pytest.mark.parametrize("name", slow_but((name for name in MODELS if name not in SHOWCASES), MODELS))
#: Events that synthesis restricts beyond the requirements.
ADDED = {"warehouse_robot": ["service_raise.c_trigger"]}


def test_the_eight_scenarios_are_there() -> None:
    assert len(SCENARIOS) == 8
    assert {*PAGES} == {*SCENARIOS, *SHOWCASES} <= {*MODELS}


@EACH
def test_nothing_is_wrong(name: str) -> None:
    answer = CliRunner().invoke(main, ["check", "--format", "json", str(MODELS[name])])
    assert answer.exit_code == 0
    assert {load["rule"] for load in json.loads(answer.stdout)} <= EXPECTED


@EACH
def test_a_robot_that_gets_messages_says_what_stops_it(name: str) -> None:
    """The node cancels its goals when it ends, but a message such as a velocity stays in effect."""
    messages = [
        definition.name
        for component in read(MODELS[name]).base.definitions
        if isinstance(component, rsc.Component) and isinstance(component.type, rsc.LocalComponent)
        for definition in component.type.definitions
        if isinstance(definition, rsc.Message) and definition.direction == rsc.MessageDirection.incoming
    ]
    settings = json.loads((MODELS[name].parent / "controller-config.json").read_text())
    assert not messages or "onShutdown" in settings


@EACH
def test_guards(name: str, golden) -> None:
    answer = CliRunner().invoke(main, ["synthesize", "--json", str(MODELS[name])])
    assert answer.exit_code == 0
    assert {*re.findall(r" warning: .* \[([a-z-]+)\]$", answer.stderr, re.MULTILINE)} <= EXPECTED
    said = json.loads(answer.stdout)
    # The costs of synthesis may change; the golden files omit them.
    said = {key: said[key] for key in ("robot", "uncontrolled_states", "controlled_states", "empty", "events")}
    golden(GUARDS / f"{name}.json", json.dumps(said, indent=2) + "\n")
    assert not said["empty"]
    assert [event["name"] for event in said["events"] if event["added_by_synthesis"]] == ADDED.get(name, [])
    unused = [event["name"] for event in said["events"] if not event["ever_enabled"]]
    assert [event for event in unused if not event.endswith(".c_none")] == []


@EACH
def test_everything_can_be_generated(name: str, tmp_path: Path) -> None:
    graph = models_of(name).rosgraph
    targets = ALL if graph.serviceClients or graph.actionClients else MESSAGES
    answer = CliRunner().invoke(main, ["transform", str(MODELS[name]), "--to", targets, "-o", str(tmp_path)])
    assert answer.exit_code == 0, answer.output
    assert {path.name for path in tmp_path.iterdir()} > {"supervisor"} | {"ros1", "ros2"} & {*targets.split(",")}


@pytest.mark.parametrize("name", PAGES)
def test_pictures_are_up_to_date(name: str, golden) -> None:
    models = models_of(name)
    page = (EXAMPLES / name / "README.md").read_text()
    for picture, graph in [("behaviour", behaviour_graph(models.robosc)), ("ros-graph", ros_graph(models.rosgraph))]:
        golden(EXAMPLES / name / f"{picture}.svg", diagram(graph, "svg"))
        assert f"]({picture}.svg)" in page


@pytest.mark.parametrize("name", [scenario for scenario in PAGES if scenario != "line_follower"])
def test_the_page_names_every_topic(name: str) -> None:
    graph = models_of(name).rosgraph
    rows = [row.strip("| ").split(" | ") for row in (EXAMPLES / name / "README.md").read_text().splitlines()]
    said = {(row[0], *(cell.strip("`") for cell in row[1:3])) for row in rows if len(row) == 4 and row[1][:2] == "`/"}
    ways = [
        (
            way,
            getattr(connection, "topic", None) or connection.identifier,
            f"{connection.interface.package}/{connection.interface.type}",
        )
        for way, connections in [
            ("outgoing", graph.subscriptions),
            ("incoming", graph.publishers),
            ("service", graph.serviceClients),
            ("action", graph.actionClients),
            ("outgoing service", graph.serviceServers),
            ("outgoing action", graph.actionServers),
        ]
        for connection in connections
    ]
    assert said == {*ways}


def test_the_list_of_examples_is_complete() -> None:
    page = (EXAMPLES / "README.md").read_text()
    assert [scenario for scenario in PAGES if f"[{scenario}]({scenario})" not in page] == []
