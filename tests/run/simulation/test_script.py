"""Scripts: the form of each event, and their faults."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from robosc.tools.cli import main

MODEL = Path(__file__).parent / "gauge.rscd"


def simulate(*arguments: str, lines: str | bytes = "", model: Path = MODEL):
    return CliRunner().invoke(main, ["simulate", str(model), *arguments], input=lines)


def play(*lines: str, options: tuple[str, ...] = ()) -> list[dict]:
    done = simulate("--script", "-", *options, lines="\n".join(lines))
    assert done.exit_code == 0, done.stderr
    return [json.loads(line) for line in done.stdout.splitlines()]


def faults(*lines: str) -> list[str]:
    done = simulate("--script", "-", lines="\n".join(lines))
    assert done.exit_code == 1
    assert not done.stdout
    return [line for line in done.stderr.splitlines() if "[script]" in line]


def test_what_is_not_accepted_changes_nothing_and_the_script_goes_on() -> None:
    first, second, third = play(
        "message_refill.c_trigger", 'message_level.u_response {"value": 3}', "message_drain.c_trigger"
    )
    assert (first["accepted"], first["by"], first["state"]["Gauge.level"]) == (False, "requirement", 0)
    assert (second["accepted"], second["by"], second["state"]["Gauge.level"]) == (True, None, 3)
    assert (third["accepted"], third["state"]["component_Gauge"]) == (True, "drained")


def test_the_plant_goes_before_the_requirement() -> None:
    assert play("message_drain.c_trigger", "message_refill.c_trigger")[1]["by"] == "plant"


@pytest.mark.slow
def test_the_state_has_every_plant_and_variable() -> None:
    (answer,) = play("message_drain.c_trigger")
    assert answer["state"] == {
        "message_refill": "ready",
        "message_drain": "ready",
        "message_level": "ready",
        "message_report": "ready",
        "message_filling": "ready",
        "message_lamp": "ready",
        "component_Gauge": "drained",
        "Gauge.level": 0,
        "Gauge.slots": 0,
        "Gauge.filling": "partly",
        "Gauge.lamp": "other",
    }


@pytest.mark.parametrize(
    ("event", "value", "name", "result"),
    [
        ("level", 3, "level", 3),
        ("level", 99, "level", 10),
        ("level", -1, "level", 0),
        ("report", {"size": {"slots": 2}}, "slots", 2),
        ("report", {"name": "x"}, "slots", 0),
        ("lamp", "red", "lamp", "red"),
        ("lamp", "#f00", "lamp", "red"),
        ("lamp", "#0f0", "lamp", "other"),
        ("filling", "full", "filling", "full"),
        ("filling", {"size": {"rows": [0, 8]}}, "filling", "full"),
        ("filling", {"size": {"rows": {"1": 8}}}, "filling", "full"),
        ("filling", {"size": {"rows": [8]}}, "filling", "partly"),
        ("filling", {"size": {"rows": {"3": 8}}}, "filling", "partly"),
        ("filling", {"size": {"rows": {"999999999": 8}}}, "filling", "partly"),
        ("filling", {"size": {}}, "filling", "partly"),
        ("filling", {}, "filling", "partly"),
    ],
)
def test_data(event, value, name, result) -> None:
    (answer,) = play(f"message_{event}.u_response {json.dumps({'value': value})}")
    assert answer["state"][f"Gauge.{name}"] == result


def test_without_data_it_is_that_of_ros() -> None:
    answers = play('message_level.u_response {"value": 3}', "message_level.u_response", "message_lamp.u_response")
    assert [answer["state"]["Gauge.level"] for answer in answers] == [3, 0, 0]
    assert answers[-1]["state"]["Gauge.lamp"] == "other"


def test_a_saved_model_without_its_graph_reads_the_same_data(tmp_path) -> None:
    done = CliRunner().invoke(main, ["transform", str(MODEL), "--to", "xmi", "-o", str(tmp_path)])
    assert done.exit_code == 0
    lines = 'message_report.u_response {"value": {"size": {"slots": 2}}}\nmessage_level.u_response {"value": 4}'
    bare = simulate("--script", "-", lines=lines, model=tmp_path / "Tank.sct.xmi")
    assert bare.stdout == simulate("--script", "-", lines=lines).stdout


def test_all_faults_are_found_before_anything_is_played() -> None:
    found = faults(
        "message_level.u_response",
        "",
        "# a remark",
        "message_levle.u_response",
        'message_level.u_response {"value": "much"}',
        "message_level.u_response 3",
        'message_level.u_response {"value": 3',
        '{"data": {}}',
        'message_level.u_response {"level": 3}',
        'message_report.u_response {"value": 3}',
        'message_filling.u_response {"value": {"size": 1}}',
        'message_level.u_response {"value": NaN}',
        f'message_level.u_response {{"value": {"9" * 5000}}}',
    )
    assert [finding.split(": error: ")[0] for finding in found] == [
        "<stdin>:4:1",
        "<stdin>:5:1",
        "<stdin>:6:26",
        "<stdin>:7:37",
        "<stdin>:8:1",
        "<stdin>:9:1",
        "<stdin>:10:1",
        "<stdin>:11:1",
        "<stdin>:12:26",
        "<stdin>:13:26",
    ]


@pytest.mark.parametrize(
    ("value", "complaint"),
    [
        (3, "value is 3, expected full, partly, or an object"),
        ({"size": 1}, "value.size is 1, expected an object"),
        ({"size": {"rows": 1}}, "value.size.rows is 1, expected a list, or an object from index to element"),
        ({"size": {"rows": [0, "zzz"]}}, 'value.size.rows[1] is "zzz", expected an integer'),
        ({"size": {"rows": [0, 1.5]}}, "value.size.rows[1] is 1.5, expected an integer"),
        ("zzz", 'value is "zzz", expected full, partly, or an object'),
    ],
)
def test_data_that_tells_no_literal(value: object, complaint: str) -> None:
    (found,) = faults(f"message_filling.u_response {json.dumps({'value': value})}")
    assert found.endswith(f"message_filling.u_response: {complaint} [script]")


@pytest.mark.parametrize(
    ("value", "fault"),
    [
        ({"range": [1.0]}, "sensor_msgs/LaserScan has no field `range`"),
        ({"header": {"id": "a"}, "ranges": {"0": 1.0}}, "std_msgs/Header has no field `id` "),
        ({"header": {"stamp": {"nsec": 3}}}, None),
        ({"header": {"stamp": {"sec": 3}}, "ranges": [1.0]}, None),
    ],
)
def test_a_misspelt_field(value: object, fault: str | None) -> None:
    """A field of either ROS is accepted."""
    model = MODEL.parents[3] / "examples/line_follower/line_follower.rscd"
    event = json.dumps({"event": "message_scan.u_response", "data": {"value": value}})
    done = simulate("--script", "-", lines=event, model=model)
    assert done.exit_code == (fault is not None), done.stderr
    assert fault is None or fault in done.stderr
    assert ("hint: did you mean `ranges`?" in done.stderr) is ("range" in value)


DATA = """robot Data {
  datatype object Sent { error_code: integer(0..3) left: boolean }
  interface sent use Sent from data_msgs
  component Base {
    outgoing message level with type: integer(0..10)
    outgoing message sent with identifier: "/sent", type: Sent links sent
    outgoing message fix with type: sensor_msgs/NavSatFix
    outgoing message speed with type: double
    behaviour {
      variable code: integer(0..3)
      variable altitude: double
      initial marked state low {
        on response from level if value > 7 goto high
        on response from sent if value.left do code := value.error_code
        on response from fix do altitude := value.altitude
        on response from speed if value > 0.5 goto high
      }
      marked state high {}
    }
  }
}"""


@pytest.mark.parametrize(
    ("line", "fault"),
    [
        ("level with 9", None),
        ("level with 32767", None),
        ("level with 32768", "value is 32768, expected an integer from -32768 to 32767 (int16)"),
        ("level with 9.5", "value is 9.5, expected an integer"),
        ("level with true", "value is true, expected an integer"),
        ('level with {"data": "x"}', 'value.data is "x", expected an integer'),
        ('sent with {"error_code": 9}', None),
        ('sent with {"error_code": "x"}', 'value.error_code is "x", expected an integer'),
        ('sent with {"error_code": 1e3}', "value.error_code is 1000.0, expected an integer"),
        (f'sent with {{"error_code": {2**64}}}', f"value.error_code is {2**64}, expected an integer from"),
        ('sent with {"left": 1}', "value.left is 1, expected a boolean"),
        ("sent with 5", "value is 5, expected an object"),
        ('fix with {"altitude": "high"}', 'value.altitude is "high", expected a number'),
        # The model does not read these.
        ('fix with {"status": {"status": 127}, "position_covariance": [1, 2]}', None),
        ('fix with {"status": {"status": 128}}', "value.status.status is 128, expected an integer from -128 to 127"),
        ('fix with {"status": 1}', "value.status is 1, expected an object"),
        ('fix with {"position_covariance": 1}', "value.position_covariance is 1, expected a list, or an object"),
        (
            'fix with {"position_covariance": {"9": 0.5}}',
            'value.position_covariance is {"9": 0.5}, expected at most 9 elements',
        ),
        ('fix with {"position_covariance": [0.5, "x"]}', 'value.position_covariance[1] is "x", expected a number'),
        # Logs write numbers that are not finite this way.
        ('speed with {"data": null}', None),
    ],
)
@pytest.mark.parametrize("command", ["simulate", "test"])
def test_data_of_another_type(tmp_path: Path, command: str, line: str, fault: str | None) -> None:
    """Scripts and scenarios accept the same data."""
    model, text = tmp_path / "data.rscd", tmp_path / "text"
    model.write_text(DATA)
    steps = f"response from {line}\n"
    text.write_text(steps if command == "simulate" else f'scenario "one"\n{steps}  expect !Base.high or Base.high\n')
    script = ["--script"] if command == "simulate" else []
    done = CliRunner().invoke(main, [command, str(model), *script, str(text)], catch_exceptions=False)
    assert done.exit_code == (fault is not None), done.output
    assert fault is None or fault in done.output


def test_an_event_with_a_character_that_json_escapes() -> None:
    (found,) = faults(r'{"event": "message_level.u_response\u0000"}')
    assert found.startswith("<stdin>:1:12: error: ")
    (found,) = faults(r'{"event": "\u006dessage_levle.u_response"}')
    assert found.startswith("<stdin>:1:2: error: ")


def test_data_of_an_enum_that_reads_none(tmp_path: Path) -> None:
    model = tmp_path / "gauge.rscd"
    text = MODEL.read_text().replace('    value = "#f00" -> red\n', "").replace("default -> other", "default -> red")
    model.write_text(text)
    done = simulate("--script", "-", lines='message_lamp.u_response {"value": "#0f0"}', model=model)
    assert json.loads(done.stdout)["state"]["Gauge.lamp"] == "red"


@pytest.mark.parametrize("standard_input", [False, True])
def test_a_script_in_another_encoding(tmp_path: Path, standard_input: bool) -> None:
    script = tmp_path / "script"
    script.write_bytes(b"# \xff\n")
    name, lines = ("-", script.read_bytes()) if standard_input else (str(script), b"")
    done = simulate("--script", name, lines=lines)
    assert done.exit_code == 1
    assert ":1:3: error: the byte 0xff is not UTF-8 [script]" in done.stderr


def test_a_line_that_is_nested_too_deeply() -> None:
    (found,) = faults(f'message_level.u_response {{"value": {"[" * 100_000}')
    assert "nested too deeply" in found


def test_lines_of_the_other_kind_of_script() -> None:
    (tick,) = faults("tick")
    assert "`tick` is not a line of a script without the control loop" in tick
    done = simulate("--loop", "--script", "-", lines="message_refill.c_trigger")
    assert done.exit_code == 1
    assert "`message_refill.c_trigger` is not a line of a script with the control loop" in done.stderr


def test_a_log_is_a_script() -> None:
    line = {"time": 1.5, "direction": "in", "event": "message_level.u_response", "data": {"value": 7}}
    assert play(json.dumps(line))[0]["state"]["Gauge.level"] == 7


def test_random_events_are_the_same_for_the_same_seed_and_can_be_played() -> None:
    first = simulate("--random", "60", "--seed", "5").stdout
    assert first == simulate("--random", "60", "--seed", "5").stdout
    assert first != simulate("--random", "60", "--seed", "6").stdout
    answers = play(*first.splitlines())
    assert len(answers) == 60
    assert all(answer["accepted"] for answer in answers)
    assert len({json.dumps(answer["state"]) for answer in answers}) > 10


def test_the_control_loop_does_the_rest_itself() -> None:
    answers = play(
        'message_level.u_response {"value": 1}',
        "tick",
        "begin",
        'message_report.u_response {"value": {"size": {"slots": 3}}}',
        'message_lamp.u_response {"value": "red"}',
        "end",
        "tick",
        options=("--loop",),
    )
    happened = [answer["happened"] for answer in answers]
    assert happened[:2] == [["message_level.u_response"], ["message_drain.c_trigger"]]
    assert answers[3]["by"] is None
    assert answers[-1]["state"]["component_Gauge"] == "drained"
    assert play("tick", "message_level.u_response", options=("--loop",))[1]["happened"] == [
        "message_level.u_response",
        "message_drain.c_trigger",
    ]


@pytest.mark.parametrize("options", [["--loop"], ["--random", "1", "--script", "-"]])
def test_options_that_make_no_sense_together(options) -> None:
    assert simulate(*options).exit_code == 2


@pytest.fixture
def lamp(tmp_path: Path) -> Path:
    model = tmp_path / "lamp.rscd"
    model.write_text(
        """robot Lamp {
          component Button {
            outgoing message pressed with identifier: "/pressed", type: none
            behaviour {
              initial marked state dark { on response from pressed goto bright }
              state bright { after 30 s goto dark }
            }
          }
        }"""
    )
    return model


def test_a_time_is_an_event_as_any(lamp: Path) -> None:
    """A timeout such as `component_X.u_after1` is an event like any other."""
    lines = "component_Button.u_after1\nmessage_pressed.u_response\ncomponent_Button.u_after1"
    for options in ((), ("--loop",)):
        done = simulate("--script", "-", *options, lines=lines, model=lamp)
        answers = [json.loads(line) for line in done.stdout.splitlines()]
        assert [answer["accepted"] for answer in answers] == [False, True, True]
        assert [answer["state"]["component_Button"] for answer in answers] == ["dark", "bright", "dark"]


def test_a_script_lets_time_go_by(lamp: Path) -> None:
    """`--loop` scripts have `wait SECONDS`, also with a unit."""
    lines = 'message_pressed.u_response\nwait 29.999\nwait 1 ms\n{"event": "wait", "data": {"seconds": 100}}'
    done = simulate("--script", "-", "--loop", lines=lines, model=lamp)
    answers = [json.loads(line) for line in done.stdout.splitlines()]
    assert [answer["happened"] for answer in answers[1:]] == [[], ["component_Button.u_after1"], []]
    assert answers[1]["seconds"] == 29.999
    assert "it needs `--loop`" in simulate("--script", "-", lines="wait 3", model=lamp).stderr
    assert "`wait` needs a number" in simulate("--script", "-", "--loop", lines="wait -1", model=lamp).stderr
