"""A scripted client of the public library writes a robot through the tools of one server."""

import json
from collections.abc import Iterator
from pathlib import Path

import pytest

from robosc.tools.cli import main
from robosc.tools.mcp.catalog import TOOLS
from tests.tools.mcp.assistant import ROOT, Assistant, assistant

pytestmark = pytest.mark.xdist_group("mcp")

FOLLOWER = ROOT / "examples" / "line_follower" / "line_follower.rscd"
SCENARIOS = """\
scenario "drives only while the way is clear"
  response from calibrate with {"success": true}
  response from clear with true
  expect drive sent
  response from clear with false
  expect drive forbidden by ClearSensor.active
  expect halt sent

scenario "drives at once"
  expect drive sent
"""


@pytest.fixture(scope="module")
def desk(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of the user, with an example."""
    folder = tmp_path_factory.mktemp("robots")
    (folder / FOLLOWER.name).write_text(FOLLOWER.read_text())
    return folder


@pytest.fixture(scope="module")
def robosc(desk: Path) -> Iterator[Assistant]:
    with assistant(desk) as client:
        yield client


def printed(capsys: pytest.CaptureFixture[str], *arguments: str | Path) -> str:
    """Return the standard output of a command."""
    main([str(argument) for argument in arguments], standalone_mode=False)
    return capsys.readouterr().out


def test_the_tools_describe_themselves(robosc: Assistant, desk: Path) -> None:
    tools = robosc.wait(robosc.client.list_tools()).tools
    assert [tool.name for tool in tools] == list(TOOLS)
    assert {tool.name for tool in tools if tool.annotations and not tool.annotations.read_only_hint} == {"fix", "new"}
    undescribed = [
        f"{tool.name}.{name}"
        for tool in tools
        for name, schema in tool.input_schema["properties"].items()
        if not schema.get("description")
    ]
    assert undescribed == []
    assert str(desk) in (robosc.client.instructions or "")


def test_an_assistant_writes_a_guard(robosc: Assistant, desk: Path) -> None:
    topics, actions = ["/cmd_vel:geometry_msgs/Twist"], ["/navigate_to_pose:nav2_msgs/NavigateToPose"]
    made = robosc.answer("new", name="Gate", guard=True, topics=topics, actions=actions, pose="/amcl_pose")
    assert "gate.scenarios" in made["files"]
    assert "limit cmd_vel with" in (desk / "gate" / "gate.rscd").read_text()
    assert robosc.answer("check", path="gate/gate.rscd")["findings"] == []
    assert robosc.answer("verify", path="gate/gate.rscd")["exit_status"] == 0
    assert robosc.answer("test", path="gate/gate.rscd", scenarios=["gate/gate.scenarios"])["exit_status"] == 0


def test_an_assistant_writes_a_robot_from_nothing(robosc: Assistant, desk: Path) -> None:
    made = robosc.answer("new", name="Porter", sensors=["clear"], service="calibrate")
    assert made["folder"] == "porter"
    assert {path.name for path in (desk / "porter").iterdir()} == set(made["files"])

    model = desk / "porter" / "porter.rscd"
    text = model.read_text()
    assert robosc.answer("check", path="porter/porter.rscd")["findings"] == []
    wrong = text.replace("ClearSensor.active", "ClearSensor.actve", 1).replace('"/clear", type', '"/clear" type')
    answer = robosc.answer("check", path="porter/porter.rscd", text=wrong)
    assert answer["exit_status"] == 1
    assert {finding["file"] for finding in answer["findings"]} == {"porter/porter.rscd"}
    assert any(finding["edits"] for finding in answer["findings"])
    assert model.read_text() == text, "a text in a call is never written"

    model.write_text(wrong)
    fixed = robosc.answer("fix", path="porter/porter.rscd")
    assert fixed["result"]["edits"] == 1
    assert model.read_text() == fixed["result"]["text"] == wrong.replace('"/clear" ', '"/clear" , ')
    (finding,) = fixed["findings"]
    assert finding["rule"] == "unresolved-reference"
    assert "did you mean `active`?" in finding["hint"]
    (way,) = finding["alternatives"]
    (edit,) = way["edits"]
    lines = model.read_text().split("\n")
    line = lines[edit["line"] - 1]
    lines[edit["line"] - 1] = line[: edit["column"] - 1] + edit["text"] + line[edit["end_column"] - 1 :]
    model.write_text("\n".join(lines))
    assert model.read_text() == text.replace('"/clear",', '"/clear" ,')
    assert robosc.answer("check", path="porter/porter.rscd")["exit_status"] == 0

    guards = {
        event["name"]: event["guard"]
        for event in robosc.answer("synthesize", path="porter/porter.rscd")["result"]["events"]
    }
    assert guards["message_drive.c_trigger"] == "component_ClearSensor.active and component_CalibrateService.done"
    why = robosc.answer("explain", path="porter/porter.rscd", event="drive")["result"]
    assert (why["allowed"], [note["line"] for note in why["requirements"]] != []) == (False, True)
    proved = robosc.answer("verify", path="porter/porter.rscd")
    assert (proved["exit_status"], proved["result"]["proved"]) == (0, True)
    script = 'message_drive.c_trigger\nmessage_clear.u_response {"value": true}\n'
    lines = robosc.answer("simulate", path="porter/porter.rscd", script=script)["result"]["lines"]
    assert [line["accepted"] for line in lines] == [False, True]
    played = robosc.answer("test", path="porter/porter.rscd", scenarios_text=SCENARIOS)
    assert [scenario["passed"] for scenario in played["result"]["scenarios"]] == [True, False]
    assert [(finding["file"], finding["rule"]) for finding in played["findings"]] == [
        ("<text>/test.scenarios", "scenario")
    ]


def test_results_are_those_of_the_commands(
    robosc: Assistant, desk: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(desk)
    name = FOLLOWER.name
    synthesis = json.loads(printed(capsys, "synthesize", name, "--json"))
    answer = robosc.answer("synthesize", path=name)["result"]
    assert answer.keys() == synthesis.keys()
    same = ("robot", "controlled_states", "uncontrolled_states", "requirements", "events")
    assert [answer[key] for key in same] == [synthesis[key] for key in same]
    counts = json.loads(printed(capsys, "synthesize", name, "--json", "--counts"))
    assert robosc.answer("synthesize", path=name, counts=True)["result"].keys() == counts.keys()
    why = json.loads(printed(capsys, "explain", name, "--event", "move", "--json"))
    assert robosc.answer("explain", path=name, event="move")["result"] == why
    never = json.loads(printed(capsys, "explain", name, "--why-never", "halt", "--json"))
    assert robosc.answer("explain", path=name, why_never="halt")["result"] == never
    walk = [json.loads(line) for line in printed(capsys, "simulate", name, "--random", "9", "--seed", "3").splitlines()]
    assert robosc.answer("simulate", path=name, random=9, seed=3)["result"]["lines"] == walk


def test_a_text_needs_no_file(robosc: Assistant, desk: Path) -> None:
    before = sorted(desk.rglob("*"))
    text = FOLLOWER.read_text()
    assert robosc.answer("check", text=text) == {"exit_status": 0, "error": None, "findings": [], "result": {}}
    assert robosc.answer("synthesize", text=text, counts=True)["result"]["robot"] == "LineFollower"
    mended = robosc.answer("fix", text=text.replace("x: 0.0", "x: 0"))
    assert mended["result"] == {"edits": 1, "text": text}
    assert sorted(desk.rglob("*")) == before


def test_the_documentation_is_read(robosc: Assistant) -> None:
    resources = robosc.wait(robosc.client.list_resources()).resources
    uris = {resource.uri for resource in resources}
    assert {"robosc://docs/llms.txt", "robosc://docs/language.md"} <= uris
    example = f"robosc://examples/line_follower/{FOLLOWER.name}"
    (templates,) = robosc.wait(robosc.client.list_resource_templates()).resource_templates
    for uri in (example, "robosc://docs/language.md", templates.uri_template.replace("{rule}", "marked-state")):
        (content,) = robosc.wait(robosc.client.read_resource(uri)).contents
        assert content.text == (ROOT / uri.removeprefix("robosc://")).read_text()
    (result,) = robosc.answer("search_docs", query="marked state", most=1)["results"]
    assert result["uri"] == "robosc://docs/rules/marked-state.md"
    assert robosc.answer("rule", name="marked-state")["page"] == (ROOT / "docs/rules/marked-state.md").read_text()


def test_a_text_has_no_configuration_but_libraries(robosc: Assistant, desk: Path) -> None:
    """Two configurations below the first folder would be an error for a file in it."""
    for name in ("one", "two"):
        (desk / name).mkdir()
        (desk / name / "controller-config.json").write_text("{}")
    (desk / "parts.rscd").write_text(
        'library Parts {\n  component Bell { incoming message ring with identifier: "/ring", type: none }\n}\n'
    )
    text = "robot Tower {\n  component Own from Parts import Bell\n}\n"
    assert robosc.answer("verify", text=text)["exit_status"] == 0
    played = robosc.answer("test", text=text, scenarios_text='scenario "rings"\n  expect ring sent\n')
    assert played["result"]["scenarios"][0]["passed"]
    (finding,) = robosc.answer("verify", path=FOLLOWER.name)["findings"]
    assert finding["rule"] == "configuration"


def test_a_robot_without_a_supervisor(robosc: Assistant) -> None:
    text = FOLLOWER.read_text().rstrip().removesuffix("}") + "  requirement never EmergencyStop.stopped\n}\n"
    answer = robosc.answer("synthesize", text=text)
    assert (answer["exit_status"], [finding["rule"] for finding in answer["findings"]]) == (3, ["empty-supervisor"])
    assert robosc.answer("explain", text=text, why_empty=True)["result"]["empty"] is True
