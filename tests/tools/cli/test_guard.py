"""Guards: `robosc new --guard`, and `robosc verify --guard` on the graphs of files."""

import json
import sys
from itertools import chain
from pathlib import Path
from xml.etree import ElementTree

import pytest
from click.testing import CliRunner

from robosc.tools.cli import main, new
from tests.run.runtime.fake import LayerBench, Record

from .conftest import Run

FLAGS = [
    ("--topic", "/cmd_vel:geometry_msgs/Twist", "--topic", "/arm/cmd_vel:geometry_msgs/msg/TwistStamped"),
    ("--service", "/gripper/release:std_srvs/Trigger", "--service", "/state:my_msgs/State"),
    ("--action", "/go:nav2_msgs/NavigateToPose", "--action", "/dance:my_msgs/action/Dance", "--pose", "/amcl_pose"),
    ("--topic", "/grip:my_msgs/Grip", "--topic", "/horn:std_msgs/Empty", "--button", "latched"),
]
GRAPH = {
    "nodes": [
        {
            "name": "/base",
            "subscribers": {"/cmd_vel": ["geometry_msgs/msg/Twist"], "/imu": ["sensor_msgs/msg/Imu"]},
            "service_servers": {
                "/release": ["std_srvs/srv/Trigger"],
                "/base/set_parameters": ["rcl_interfaces/srv/SetParameters"],
            },
        },
        {
            "name": "/smoother",
            "subscribers": {"/cmd_vel_nav": ["geometry_msgs/msg/Twist"]},
            "publishers": {"/cmd_vel": ["geometry_msgs/msg/Twist"]},
        },
        {
            "name": "/bt_navigator",
            "action_servers": {"/navigate_to_pose": ["nav2_msgs/action/NavigateToPose"]},
            "action_clients": {"/follow_path": ["nav2_msgs/action/FollowPath"]},
        },
        {"name": "/amcl", "publishers": {"/amcl_pose": ["geometry_msgs/msg/PoseWithCovarianceStamped"]}},
        {"name": "/rviz", "publishers": {"/initialpose": ["geometry_msgs/msg/PoseWithCovarianceStamped"]}},
    ]
}


@pytest.mark.parametrize("flags", [*((flag,) for flag in FLAGS), FLAGS], ids=len)
def test_each_guard_is_sound(run: Run, tmp_path: Path, flags: tuple[tuple[str, ...], ...]) -> None:
    chosen = list(chain(*flags))
    written = run("new", "my_porter", "--guard", *chosen)
    assert written.exit_code == 0, written.stderr
    folder = tmp_path / "my_porter"
    model = folder / "my_porter.rscd"
    assert {path.name for path in folder.iterdir()} == {
        model.name,
        "controller-config.json",
        "README.md",
        "my_porter.scenarios",
    }
    # A type without a definition is only a warning, with the place in the model.
    unknown = {text for text in chosen if "my_msgs" in text}
    assert written.stderr.count("[interface-unknown]") == len(unknown)
    checked = run("check", model, "--format", "json")
    assert {finding["rule"] for finding in json.loads(checked.stdout)} <= {"interface-unknown"}
    assert checked.exit_code == run("format", "--check", model).exit_code == 0
    played = run("test", model, folder / "my_porter.scenarios")
    assert played.exit_code == 0, played.output
    generated = run("transform", model, "--to", "ros2-layer")
    assert generated.exit_code == 0, generated.output
    assert "onBlocked" not in generated.output


@pytest.mark.slow
def test_a_guard_is_verified(run: Run) -> None:
    run("new", "Porter", "--guard", *chain(*FLAGS[:3]))
    answer = run("verify", "porter/porter.rscd", "--json")
    assert json.loads(answer.stdout)["proved"] is True


def test_the_scenarios_can_fail(run: Run, tmp_path: Path) -> None:
    run("new", "Porter", "--guard", *FLAGS[1])
    model = tmp_path / "porter" / "porter.rscd"
    model.write_text(model.read_text().replace("{ release, state_2 } needs", "release needs"))
    played = run("test", model, tmp_path / "porter" / "porter.scenarios")
    assert played.exit_code == 1
    assert "2 failed" in played.stderr + played.stdout


def test_velocities_are_limited_in_all_directions(run: Run, tmp_path: Path) -> None:
    run("new", "Porter", "--guard", *FLAGS[0])
    bench = LayerBench(tmp_path / "porter" / "porter.rscd")
    fast = Record(linear=Record(x=3.0, y=-3.0, z=0.1), angular=Record(x=0.0, y=5.0, z=-5.0))
    assert bench.forwarded("cmd_vel", fast) is None
    bench.hear("/emergency_stop", data=False)
    bench.hear("/continue")
    limited = {"linear": {"x": 0.5, "y": -0.5, "z": 0.1}, "angular": {"x": 0.0, "y": 1.0, "z": -1.0}}
    assert bench.forwarded("cmd_vel", fast) == limited
    assert bench.forwarded("arm_cmd_vel", Record(twist=fast)) == {"twist": limited}
    bench.hear("/emergency_stop", data=True)
    assert bench.forwarded("cmd_vel", fast) is None
    assert json.loads((tmp_path / "porter" / "controller-config.json").read_text())["onBlocked"] == [
        "cmd_vel",
        "arm_cmd_vel",
    ]
    assert bench.blocked()["because"] == [
        'requirement Stopped "the robot is stopped": cmd_vel needs EmergencyStop.in_service'
    ]


def test_a_goal_needs_a_place(run: Run, tmp_path: Path) -> None:
    run("new", "Porter", "--guard", *FLAGS[2])
    bench = LayerBench(tmp_path / "porter" / "porter.rscd")
    bench.hear("/emergency_stop", data=False)
    bench.hear("/continue")
    goals = [action.request for action in bench.graph.actionClients]
    for variance, passes in ((None, False), (1.0, False), (0.01, True)):
        if variance is not None:
            bench.hear("/amcl_pose", pose=Record(covariance=[variance] * 36))
        assert [bench.layer.forwarded(goal, Record()) is not None for goal in goals] == [passes] * 2


@pytest.fixture
def graph(tmp_path: Path) -> Path:
    file = tmp_path / "graph.json"
    file.write_text(json.dumps(GRAPH))
    return file


def identifiers(tmp_path: Path) -> list[str]:
    """Return the names of the commands of the guard, and of its messages of localization."""
    return [part.split('"')[1] for part in (tmp_path / "porter" / "porter.rscd").read_text().split("identifier: ")[1:]]


def test_a_graph_gives_the_commands_of_well_known_types(run: Run, tmp_path: Path, graph: Path) -> None:
    written = run("new", "Porter", "--guard", "--from-graph", graph)
    assert identifiers(tmp_path) == ["/amcl_pose", "/cmd_vel", "/navigate_to_pose"]
    assert written.stderr == "left out: topic /cmd_vel_nav (geometry_msgs/Twist): its nodes pass commands on\n"


def test_a_layer_in_the_graph_is_not_the_robot(run: Run, tmp_path: Path, graph: Path) -> None:
    nodes = json.loads(graph.read_text())["nodes"]
    go, twist = {"/navigate_to_pose": ["nav2_msgs/NavigateToPose"]}, ["geometry_msgs/Twist"]
    inside = {f"/old_layer/controller{name}": types for name, types in go.items()}
    layer = {
        "name": "/old_layer",
        "subscribers": {"/old_layer/controller/cmd_vel": twist},
        "publishers": {"/cmd_vel": twist},
        "action_servers": inside,
        "action_clients": go,
    }
    graph.write_text(json.dumps({"nodes": [*nodes, layer]}))
    run("new", "Porter", "--guard", "--from-graph", graph)
    assert identifiers(tmp_path) == ["/amcl_pose", "/cmd_vel", "/navigate_to_pose"]


def test_a_graph_gives_everything_that_the_named_nodes_take(run: Run, tmp_path: Path, graph: Path) -> None:
    written = run("new", "Porter", "--guard", "--from-graph", graph, "--robot", "/base", "--pose", "-")
    assert identifiers(tmp_path) == ["/cmd_vel", "/release"]
    assert written.stderr == "left out: topic /imu (sensor_msgs/Imu): sensor data\n"
    again = run(
        "new", "Porter", "--guard", "--from-graph", graph, "--robot", "b*", "--topic", "/x:std_msgs/Bool", "-o", "b"
    )
    assert again.exit_code == 0
    texts = (tmp_path / "b" / "porter.rscd").read_text()
    assert "/x" in texts
    assert "/cmd_vel" not in texts, "the call decides"
    assert "/navigate_to_pose" in texts


def test_options_that_do_not_fit_are_rejected(run: Run, tmp_path: Path, graph: Path) -> None:
    calls = {
        ("--topic", "/cmd_vel"): "is not NAME:TYPE of a topic: write it as `/cmd_vel:geometry_msgs/Twist`",
        ("--action", "/go nav2_msgs/Go"): "is not NAME:TYPE of an action",
        ("--service", "/x:std_msgs/msg/Bool"): "names another kind of type",
        ("--topic", "/x:std_msgs/Bool", "--service", "/x:std_srvs/Empty"): "`/x` is used twice",
        ("--sensor", "clear"): "--sensor has no meaning with --guard",
        ("--ros", "1"): "--ros has no meaning with --guard",
        ("--robot", "/base"): "--robot needs --from-graph",
        ("--from-graph", "nowhere.json"): "does not exist",
        ("--from-graph", str(graph), "--robot", "/nase"): "the graph has no node /nase; it has /amcl, /base",
    }
    for flags, words in calls.items():
        answer = run("new", "Porter", "--guard", *flags)
        assert (answer.exit_code, words in answer.stderr) == (2, True), answer.stderr
    assert "--topic needs --guard" in run("new", "Porter", "--topic", "/x:std_msgs/Bool").stderr
    assert "--service is repeatable only with" in run("new", "Porter", "--service", "a", "--service", "b").stderr
    assert [path.name for path in tmp_path.iterdir()] == ["graph.json"]


def test_a_terminal_asks_for_commands(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, graph: Path) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(new, "_on_terminal", lambda: True)
    answers = "/cmd_vel\n/cmd_vel:geometry_msgs/Twist /led:std_msgs/Bool\n-\n/go:nav2_msgs/NavigateToPose\n/amcl_pose\n"
    done = CliRunner().invoke(main, ["new", "Porter", "--guard"], input=answers, catch_exceptions=False)
    assert done.exit_code == 0, done.stderr
    assert "`/cmd_vel` is not NAME:TYPE of a topic" in done.stderr
    assert identifiers(tmp_path) == ["/amcl_pose", "/cmd_vel", "/led", "/go"]
    call = ["new", "Porter", "--guard", "--from-graph", str(graph), "-o", "second"]
    done = CliRunner().invoke(main, call, input="\n\n\n\n", catch_exceptions=False)
    assert "[/cmd_vel:geometry_msgs/Twist]" in done.stderr
    assert done.stderr.count("\n") < 6, "the graph names the localization"
    same = CliRunner().invoke(main, [*call[:-1], "same", "--yes"], catch_exceptions=False)
    assert same.exit_code == 0
    for path in (tmp_path / "second").iterdir():
        assert path.read_text() == (tmp_path / "same" / path.name).read_text()


def layer_graph(*more: dict[str, object]) -> str:
    layer = {
        "name": "/porter_layer",
        "publishers": {"/cmd_vel": ["geometry_msgs/msg/Twist"]},
        "subscribers": {"/porter_layer/controller/cmd_vel": ["geometry_msgs/msg/Twist"]},
    }
    base = {"name": "/base", "subscribers": {"/cmd_vel": ["geometry_msgs/msg/Twist"]}}
    return json.dumps({"nodes": [layer, base, *more]})


def test_verify_names_the_node_that_goes_around(run: Run, tmp_path: Path) -> None:
    run("new", "Porter", "--guard", "--yes")
    graph = tmp_path / "graph.json"
    graph.write_text(layer_graph({"name": "/teleop", "publishers": {"/cmd_vel": ["geometry_msgs/Twist"]}}))
    call = ("verify", "porter/porter.rscd", "--guard", graph)
    answer = run(*call)
    assert answer.exit_code == 1
    assert "│ topic /cmd_vel │ goes around │ /teleop publishes it │" in answer.stdout
    assert answer.stdout.endswith("Porter: 1 around the layer, 0 through it\n")
    told = json.loads(run(*call, "--json").stdout)
    assert (told["complete"], told["passages"][0]["around"]) == (False, ["/teleop"])
    assert run(*call, "--except", "/cmd_vel").exit_code == 0


def test_verify_accepts_a_graph_without_a_way_around(run: Run, tmp_path: Path) -> None:
    run("new", "Porter", "--guard", "--yes")
    graph, junit = tmp_path / "graph.json", tmp_path / "guard.xml"
    graph.write_text(layer_graph())
    call = ("verify", "porter/porter.rscd", "--guard", graph)
    answer = run(*call, "--robot", "/base", "--junit", junit)
    assert answer.exit_code == 0, answer.output
    assert "from no node yet to /base" in answer.stdout
    (case,) = ElementTree.parse(junit).iter("testcase")  # noqa: S314
    assert (case.get("name"), case.find("failure")) == ("topic /cmd_vel", None)
    graph.write_text(layer_graph().replace("/porter_layer", "/other_layer"))
    answer = run(*call, "--junit", junit)
    assert answer.exit_code == 1
    assert "the graph has no node porter_layer: start the layer" in answer.stdout
    (case,) = ElementTree.parse(junit).iter("testcase")  # noqa: S314
    assert case.find("failure") is not None


def test_verify_reports_wrong_calls_and_graphs(run: Run, tmp_path: Path) -> None:
    run("new", "Porter", "--guard", "--yes")
    model = "porter/porter.rscd"
    assert "--robot and --except need --guard" in run("verify", model, "--robot", "/x").stderr
    graph = tmp_path / "graph.json"
    graph.write_text('{"nodes": [{"name": "base"}]}')
    answer = run("verify", model, "--guard", graph)
    assert answer.exit_code == 1
    assert "must be a full name" in answer.stderr
    assert "^^^^^^" in answer.stderr
    graph.write_text(layer_graph())
    assert "the graph has no node /nase" in run("verify", model, "--guard", graph, "--robot", "/nase").stderr
    assert run("verify", model, "--guard", "nowhere.json").exit_code == 2


@pytest.mark.parametrize(
    "call", [("graph",), ("graph", "-o", "graph.json"), ("new", "Porter", "--guard", "--yes", "--from-graph")]
)
def test_a_running_graph_needs_ros(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, call: tuple[str, ...]
) -> None:
    monkeypatch.setitem(sys.modules, "rclpy", None)
    for module in ("node", "node_graph"):
        monkeypatch.delitem(sys.modules, f"robosc.run.runtime.ros2.{module}", raising=False)
    answer = run(*call)
    assert answer.exit_code == 2
    assert "this Python has no ROS 2" in answer.stderr
    assert list(tmp_path.iterdir()) == []
