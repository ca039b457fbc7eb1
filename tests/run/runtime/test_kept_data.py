"""Variables that are arrays and objects hold the data of an event, and provided data passes it on."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

import robosc
from robosc.model.semantics.messages import parts_of
from robosc.tools.cli import main
from tests.run.runtime.fake import Record, World

KEPT = Path(__file__).parent / "kept.rscd"


@pytest.fixture
def world(tmp_path: Path) -> World:
    made = World(KEPT, tmp_path / "events.jsonl")
    made.port.types = {"name": "string", "poses": "kept_msgs/Pose[]", "speeds": "float64[]", "tags": "int32[]"}
    made.start()
    made.port.said.clear()
    return made


def pose(x: float, *tags: int) -> Record:
    return Record(x=x, tags=list(tags))


def hear_route(world: World, *xs: float, name: str = "first", speeds: tuple[float, ...] = ()) -> None:
    world.hear("route", name=name, poses=[pose(x, 7) for x in xs], speeds=list(speeds))


def sent(world: World, topic: str) -> list[dict[str, Any]]:
    world.port.sent.clear()
    world.wait(0.3)
    return [plain(fields) for name, fields in world.port.sent if name == topic]


def plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: plain(inner) for name, inner in value.items()}
    if isinstance(value, list):
        return [plain(inner) for inner in value]
    return value.plain() if isinstance(value, Record) else value


def variables(world: World) -> dict[str, Any]:
    world.wait(0.1)
    told = [json.loads(text) for topic, text in world.port.told if topic == "state"]
    found: dict[str, Any] = told[-1]["components"]["Mission"]["variables"]
    return found


def test_provided_data_passes_on_the_whole_or_parts(world: World) -> None:
    """Provided data may pass variables on, whole or in parts.

    Example: `provide go with { pose: Mission.route[Mission.next] }`.
    """
    hear_route(world, 1.0, 2.0, 3.0, speeds=(0.5, 1.5))
    world.hear("next", data=2)
    (go, *_) = sent(world, "/go")
    assert go == {
        "pose": {"x": 3.0, "tags": [7]},
        "rest": [{"x": 2.0, "tags": [7]}, {"x": 3.0, "tags": [7]}],
        "speeds": [0.5, 1.5],
        "tags": [7],
        "name": "first",
    }
    (again, *_) = sent(world, "/again")
    assert again["name"] == "first"
    assert [found["x"] for found in again["poses"]] == [1.0, 2.0, 3.0]


def test_arrays_start_empty_and_objects_field_by_field(world: World) -> None:
    """Arrays start empty, objects field by field as variables of the field's type."""
    world.wait(0.3)
    assert {text for text in world.port.said if "withheld" in text} == {
        "go is withheld: there is no element 0 in an array of 0"
    }
    assert sent(world, "/go") == []
    # No data was stored, so no field is set.
    assert sent(world, "/again")[0] == {}
    world.hear("next", data=0)
    assert variables(world) == {"number": 0, "far": False, "long": 0}


def test_an_index_past_the_end_withholds_the_command(world: World) -> None:
    """The command is withheld and reported, since its data cannot be read."""
    hear_route(world, 1.0, 2.0, 3.0)
    assert sent(world, "/go")
    for number, fault in [
        (3, "there is no element 3 in an array of 3"),
        (-1, "there is no element -1 in an array of 3"),
    ]:
        world.hear("next", data=number)
        world.wait(6)
        assert sent(world, "/go") == []
        assert [text for text in world.port.said if "withheld" in text][-1] == f"go is withheld: {fault}"


def test_what_is_not_finite_is_not_handed_on(world: World) -> None:
    """A double that is not finite is never sent, not even inside stored data that is passed on."""
    for bad in (float("nan"), float("-inf")):
        hear_route(world, 1.0, 2.0, bad)
        world.hear("next", data=0)
        world.wait(6)
        assert sent(world, "/go") == sent(world, "/again") == []
        withheld = [text for text in world.port.said if "withheld" in text]
        assert withheld[-2:] == [
            "go is withheld: its rest would not be finite",
            "again is withheld: its data would not be finite",
        ]
    hear_route(world, 1.0, 2.0, 3.0)
    assert sent(world, "/go")


def test_expressions_read_what_is_kept(world: World) -> None:
    hear_route(world, 1.0, 6.0, speeds=(0.5,))
    world.hear("next", data=1)
    assert variables(world) == {"number": 1, "far": True, "long": 5}


def test_assignments_read_the_values_from_before(world: World) -> None:
    hear_route(world, 1.0, 2.0, 3.0)
    world.wait(0.1)
    world.port.calls[-1].answered(
        Record(route=Record(name="planned", poses=[pose(5.0), pose(6.0), pose(7.0)], speeds=[]))
    )
    assert sent(world, "/again")[0]["name"] == "planned"
    # `poses` gets the old value of `whole`.
    assert sent(world, "/go")[0]["pose"]["x"] == 1.0


def test_nothing_of_an_event_that_cannot_be_read_is_stored(world: World) -> None:
    """The event happens for no component, and none of its data is stored."""
    hear_route(world, 1.0, 2.0, 3.0)
    hear_route(world, name="empty")
    assert world.port.said[-1] == "/route: there is no element 0 in an array of 0"
    assert sent(world, "/again")[0]["name"] == "first"


def test_the_log_shows_what_is_kept_of_objects(world: World) -> None:
    hear_route(world, 1.0, 2.0, speeds=(0.5,))
    world.controller._log.flush()
    lines = [json.loads(line) for line in world.log.read_text().splitlines()]
    (line,) = [line for line in lines if line["event"] == "message_route.u_response"]
    poses = [{"x": 1.0, "tags": [7]}, {"x": 2.0, "tags": [7]}]
    assert line["data"] == {"value": {"name": "first", "poses": poses, "speeds": [0.5]}}


def test_simulate_reads_the_log_back(world: World) -> None:
    """Simulation accepts an index into stored data as readable."""
    hear_route(world, 1.0, 2.0, 3.0)
    world.hear("next", data=2)
    world.wait(0.3)
    world.controller.close()
    done = CliRunner().invoke(main, ["simulate", str(KEPT), "--script", str(world.log)])
    assert done.exit_code == 0, done.stderr
    answers = [json.loads(line) for line in done.stdout.splitlines()]
    assert [answer["event"] for answer in answers] == [
        json.loads(line)["event"] for line in world.log.read_text().splitlines()
    ]
    assert all(answer["accepted"] for answer in answers)


def test_the_fields_of_ros_types_are_those_of_both_ros(tmp_path: Path) -> None:
    """`Header` has `seq` in ROS 1 alone, and times have other names. A field that the model names is visible."""
    model = tmp_path / "keeper.rscd"
    declared = 'outgoing message path with identifier: "/path", type: nav_msgs/Path'
    kept = "variable path: nav_msgs/Path variable since: integer initial marked state on"
    reaction = "on response from path do path := value, since := path.header.stamp.sec"
    model.write_text(f"robot Keeper {{ component Eye {{ {declared} behaviour {{ {kept} {{ {reaction} }} }} }} }}")
    graph = robosc.to_rosgraph(robosc.load(model))
    header = ["header.stamp.sec", "header.frame_id"]
    pose = ["position.x", "position.y", "position.z", *(f"orientation.{axis}" for axis in "xyzw")]
    found = [".".join(path) for path, _ in parts_of(graph.variables[0].type)]
    assert found == [*header, "poses.*.header.frame_id", *(f"poses.*.pose.{part}" for part in pose)]


def test_nothing_is_known_of_an_object_of_too_many_values(tmp_path: Path) -> None:
    """Its fields are never all enumerated: there may be astronomically many."""
    model = tmp_path / "keeper.rscd"
    types = " ".join(f"datatype object T{n} {{ a: T{n + 1} b: T{n + 1} }}" for n in range(60))
    declared = 'outgoing message t with identifier: "/t", type: T0 links t'
    kept = "variable kept: T0 initial marked state on { on response from t do kept := value }"
    component = f"component Eye {{ {declared} behaviour {{ {kept} }} }}"
    model.write_text(
        f"robot Keeper {{ interface t use T from unknown_msgs {types} datatype object T60 {{ }} {component} }}"
    )
    graph = robosc.to_rosgraph(robosc.load(model))
    assert list(parts_of(graph.variables[0].type)) == []
