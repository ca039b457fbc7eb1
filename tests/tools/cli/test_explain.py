"""`robosc explain`: its exact output, the names of events and states, and questions without an answer."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.run.runtime.fake import World
from tests.tools.cli.conftest import Run

EXPLAINED = Path(__file__).parent / "explained"
TANK = EXPLAINED / "tank.rscd"


def test_wording(run: Run, golden: Callable[[Path, str], None]) -> None:
    told = []
    for arguments in (
        "--event refill",
        "--event refill --state Gauge=full,Gauge.level=4,Valve=open",
        "--event refill --state Gauge=metering,wet=true",
        "--event rinse --state rinse=error",
        "--event rinse --state rinse=ready",
        "--event rinse.response",
        "--event Gauge.c_tau1 --state level=5",
        "--event level",
        "--why-never refill",
        "--why-empty",
    ):
        answer = run("explain", TANK, *arguments.split())
        assert answer.exit_code == 0, answer.output
        told.append(f"$ {arguments}\n{answer.output.replace(f'{EXPLAINED}/', '')}")
    golden(EXPLAINED / "tank.txt", "\n".join(told))


def test_as_json(run: Run) -> None:
    answer = run("explain", TANK, "--event", "refill", "--state", "Gauge.level=2,Valve=open", "--json")
    assert answer.exit_code == 0, answer.output
    assert json.loads(answer.stdout) == {
        "event": "message_refill.c_trigger",
        "allowed": False,
        "by": "requirement",
        "reach": "supervised",
        "state": {
            "message_level": "ready",
            "message_refill": "ready",
            "component_Gauge": "metering",
            "Gauge.level": 2,
            "Gauge.wet": False,
            "service_rinse": "wait_for_response",
            "component_Valve": "open",
        },
        "trace": [
            {"event": "service_rinse.c_trigger", "inputs": {}},
            {"event": "message_level.u_response", "inputs": {"i_response": 2}},
        ],
        "data": [],
        "plants": [],
        "requirements": [
            {
                "file": str(TANK),
                "line": 34,
                "column": 3,
                "text": "requirement refill needs Gauge.level < 3 and !(Valve.open or Gauge.wet)",
                "details": ["`Valve.open` holds"],
            }
        ],
        "counterexample": None,
        "changes": [
            {
                "file": str(TANK),
                "line": line,
                "column": 9,
                "text": f"`Valve` goes from `open` to `closed` by {event} from `Valve.rinse`",
                "details": [],
            }
            for line, event in ((28, "response"), (29, "error"))
        ],
        "way": [{"event": "service_rinse.u_response", "inputs": {}}],
        "refusal": None,
    }


@pytest.mark.parametrize(
    "name",
    ["message_refill.c_trigger", "refill", "Gauge.refill", "refill.request", "Gauge.refill.trigger", "message_refill"],
)
def test_an_event_has_several_names(run: Run, name: str) -> None:
    assert json.loads(run("explain", TANK, "--event", name, "--json").stdout)["event"] == "message_refill.c_trigger"


@pytest.mark.parametrize(
    ("name", "event"),
    [
        ("level", "message_level.u_response"),
        ("rinse.error", "service_rinse.u_error"),
        ("error from rinse", "service_rinse.u_error"),
        ("response from Gauge.level", "message_level.u_response"),
        ("request to Valve.rinse", "service_rinse.c_trigger"),
        ("Valve.rinse.reset", "service_rinse.c_reset"),
        ("Gauge.c_tau2", "component_Gauge.c_tau2"),
    ],
)
def test_so_have_the_others(run: Run, name: str, event: str) -> None:
    assert json.loads(run("explain", TANK, "--why-never", name, "--json").stdout)["event"] == event


def test_a_state_as_simulate_prints_it(run: Run) -> None:
    Path("script").write_text('message_level.u_response {"value": 8}\ncomponent_Gauge.c_tau1\n')
    *_, last = run("simulate", TANK, "--script", "script").stdout.splitlines()
    for state in (last, json.dumps(json.loads(last)["state"])):
        told = json.loads(run("explain", TANK, "--event", "refill", "--state", state, "--json").stdout)
        assert told["state"] == json.loads(last)["state"]
        assert [step["event"] for step in told["trace"]] == ["message_level.u_response", "component_Gauge.c_tau1"]


REPORT = {
    "robot": "Tank",
    "time": 1795174473.5,
    "components": {
        "Gauge": {"state": "full", "variables": {"level": 4, "wet": True, "seen by the node alone": None}},
        "Valve": {"state": "open", "variables": {}},
    },
    "transitions": ["message_level.u_response", "component_Gauge.c_tau1"],
}
ECHOED = json.dumps(REPORT)


@pytest.mark.parametrize(
    "state",
    [
        ECHOED,
        f"{ECHOED}\n---\n",
        "data: '" + json.dumps(REPORT | {"it''s": "known"}) + "'\n---",
        f"data: 'a first one'\n---\ndata: '{ECHOED}'\n---\n\n",
        f"data: {json.dumps(ECHOED)}\n---",
    ],
    ids=["bare", "as a field", "quoted", "several", "as ROS 1 does"],
)
def test_a_state_as_a_node_tells_it(run: Run, state: str) -> None:
    answer = run("explain", TANK, "--event", "refill", "--state", state, "--json")
    assert answer.exit_code == 0, answer.output
    told = json.loads(answer.stdout)["state"]
    chosen = {"component_Gauge": "full", "Gauge.level": 4, "Gauge.wet": True, "component_Valve": "open"}
    assert {name: told[name] for name in chosen} == chosen


def test_what_a_node_publishes_is_understood(run: Run, tmp_path: Path) -> None:
    world = World(TANK, tmp_path / "log").start()
    world.wait(1.0)
    states = [text for topic, text in world.port.told if topic == "state"]
    assert states
    answer = run("explain", TANK, "--event", "refill", "--state", states[-1], "--json")
    assert json.loads(answer.stdout)["state"]["component_Gauge"] == "metering", answer.output


@pytest.mark.parametrize(
    ("state", "complaint"),
    [
        (json.dumps(REPORT | {"robot": "Tonk"}), "the state is one of the robot `Tonk`; the model is `Tank`"),
        (ECHOED.replace("Valve", "Value"), "there is no component `Value`; did you mean `Valve`?"),
        (json.dumps({"components": {"Valve": "open"}}), "the state has no value for `Valve`; it needs `state`"),
        (ECHOED.replace('"level": 4', '"level": null'), "`Gauge.level` cannot be `None`; it is an integer from 0 to 9"),
        (f"data: '{ECHOED[:128]}...'\n---", "the state was cut short; `ros2 topic echo --full-length` prints it whole"),
    ],
)
def test_what_no_node_of_it_tells(run: Run, state: str, complaint: str) -> None:
    answer = run("explain", TANK, "--event", "refill", "--state", state)
    assert (answer.exit_code, answer.stdout) == (2, "")
    assert complaint in answer.stderr


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        ("--event refil", "there is no event `refil`; did you mean `refill`?"),
        ("--event zzz", "there is no event `zzz`; `robosc synthesize --json` lists the events"),
        ("--event refill --state Gage=full", "the state has no `Gage`; did you mean `Gauge`?"),
        ("--event refill --state Gauge=ful", "`Gauge` cannot be `ful`; did you mean `full`?"),
        ("--event refill --state Gauge.level=10", "`Gauge.level` cannot be `10`; it is an integer from 0 to 9"),
        ("--event refill --state Gauge.level=low", "`Gauge.level` cannot be `low`; it is an integer from 0 to 9"),
        (
            "--event refill --state Gauge=full,component_Gauge=metering",
            "the state has two values for `component_Gauge`",
        ),
        ("--event refill --state wet=3", "`wet` cannot be `3`; it is one of false, true"),
        ("--event refill --state full", "`full` is not part of a state; write `Component=state,Component.variable=3`"),
        ("--event refill --state {", "the state cannot be read; not JSON: "),
        (f"--event refill --state {{{'[' * 100_000}", "the state cannot be read; nested too deeply"),
        ("--event refill --why-empty", "give one of --event, --why-empty and --why-never"),
        ("", "give one of --event, --why-empty and --why-never"),
        ("--why-empty --state Gauge=full", "--state needs --event"),
    ],
)
def test_what_it_does_not_understand(run: Run, arguments: str, complaint: str) -> None:
    answer = run("explain", TANK, *arguments.split())
    assert (answer.exit_code, answer.stdout) == (2, "")
    assert complaint in answer.stderr


def test_a_name_of_several_events(run: Run) -> None:
    twice = Path("twice.rscd")
    twice.write_text(
        """robot Twice {
  component Front from EmergencyStopLibrary import EmergencyStop
  component Rear from EmergencyStopLibrary import EmergencyStop with { stop: "/rear/stop", continue: "/rear/continue" }
}
"""
    )
    answer = run("explain", twice, "--event", "stop")
    assert answer.exit_code == 2
    assert "`stop` can be several events; say which: `Front.stop`, `Rear.stop`" in answer.stderr
    assert run("explain", twice, "--event", "Rear.stop").exit_code == 0


def test_no_supervisor(run: Run, stuck: Path) -> None:
    for question in (("--event", "open"), ("--why-never", "open")):
        answer = run("explain", stuck, *question)
        assert (answer.exit_code, answer.stdout) == (3, "")
        assert "[empty-supervisor]" in answer.stderr
    answer = run("explain", stuck, "--why-empty", "--json")
    assert answer.exit_code == 0
    told = json.loads(answer.stdout)
    assert told["empty"] is True
    assert [step["event"] for step in told["trace"]] == ["message_open.c_trigger"]
    assert [(loosening["texts"], loosening["states"]) for loosening in told["loosenings"]] == [
        ([requirement["text"] for requirement in told["requirements"]], 2)
    ]
    assert run("explain", TANK, "--why-empty", "--json").stdout == '{\n  "empty": false\n}\n'


def test_errors_come_first(run: Run, broken: Path) -> None:
    answer = run("explain", broken, "--why-empty")
    assert (answer.exit_code, answer.stdout) == (1, "")
    assert "[initial-state]" in answer.stderr


def test_a_library_has_no_events(run: Run, library: Path) -> None:
    assert run("explain", library, "--why-empty").exit_code == 2


def test_a_saved_model_is_explained_as_its_text_is(run: Run) -> None:
    Path("tank.rscd").write_text(TANK.read_text())
    assert run("transform", "tank.rscd", "--to", "xmi", "-o", "saved").exit_code == 0
    arguments = ("--event", "refill", "--state", "Valve=open")
    assert run("explain", "saved/Tank.sct.xmi", *arguments).stdout == run("explain", "tank.rscd", *arguments).stdout


def test_idle_services_stand_in_one_line(run: Run, tmp_path: Path) -> None:
    services = "".join(
        f'    service {name} with identifier: "/{name}", request: none, response: none\n' for name in ("load", "drop")
    )
    (tmp_path / "arm.rscd").write_text(
        f"robot Arm {{\n  component Arm {{\n{services}\n    behaviour {{\n      "
        "initial marked state up { on request to load goto low }\n      marked state low {}\n    }\n  }\n}\n"
    )
    shown = run("explain", "arm.rscd", "--event", "drop").stdout
    assert "  `Arm` is in `up`\n  `Arm.load` and `Arm.drop` are in `idle`\n" in shown
