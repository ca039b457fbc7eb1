"""The configuration: its settings, its location, and the findings about its faults."""

import json
import os
from collections.abc import Callable
from pathlib import Path

import jsonschema
import pytest

from robosc.base.diagnostics import ModelError
from robosc.base.files.resources import locate
from robosc.language import configuration as config
from robosc.language.configuration import Configuration

EVERYTHING = {
    "publishStateInformation": False,
    "typedState": True,
    "writeEventsToLog": True,
    "diagnosticsMs": 500,
    "output": {
        "ros1ControllerNodeLocation": "one",
        "ros2ControllerNodeLocation": "two",
        "ros2SupervisorNodeLocation": "three",
    },
    "supervisor": {
        "controller": {
            "run": {"packageName": "robot", "executable": "drive", "name": "driver", "namespace": "front"},
            "launch": {"packageName": "robot", "file": "drive.launch"},
        }
    },
    "controlLoop": {"periodMs": 20, "eventsPerTick": 1, "reactImmediately": False, "reactionsPerTick": 3},
    "services": {"timeoutMs": 2000},
    "actions": {"timeoutMs": 3000},
    "retryMs": 400,
    "absoluteNames": False,
    "frameId": {"/scan": "laser"},
    "qos": {"scan": {"reliability": "best_effort", "durability": "volatile", "depth": 3}},
    "watchdogMs": {"/scan": 500},
    "watchdogStops": True,
    "onShutdown": ["halt"],
    "onWithheld": ["halt"],
    "onBlocked": ["velocity"],
    "waitFor": ["/scan"],
    "onViolation": "report",
    "lifecycle": {"bond": True},
    "parameters": "library",
    "package": {
        "name": "my_robot",
        "version": "1.2.3",
        "maintainer": "A. Person",
        "email": "a.person@example.org",
        "license": "MIT",
        "url": "https://example.org/robot",
        "description": "Drives.",
    },
}


def read(folder: Path, text: str) -> Configuration:
    (folder / config.FILE_NAME).write_text(text)
    return config.read(folder / config.FILE_NAME)


def test_every_key(tmp_path: Path) -> None:
    read_back = read(tmp_path, json.dumps(EVERYTHING)).model_dump(by_alias=True)
    without_slashes = {**EVERYTHING, "frameId": {"scan": "laser"}, "watchdogMs": {"scan": 500}}
    assert read_back == without_slashes


def test_all_is_optional(tmp_path: Path) -> None:
    configuration = read(tmp_path, "{}")
    assert configuration.model_dump() == Configuration().model_dump()
    assert configuration.publish_state_information
    assert not configuration.write_events_to_log
    assert configuration.control_loop.period_ms == 100
    assert configuration.control_loop.events_per_tick == 0
    assert configuration.control_loop.reactions_per_tick == 10
    assert configuration.services.timeout_ms == 5000
    assert configuration.retry_ms == 1000


@pytest.mark.parametrize(
    ("text", "managed", "bond"),
    [
        ("false", False, False),
        ("true", True, False),
        ("{}", True, False),
        ('{"bond": false}', True, False),
        ('{"bond": true}', True, True),
    ],
)
def test_a_lifecycle_may_have_a_bond(tmp_path: Path, text: str, managed: bool, bond: bool) -> None:
    configuration = read(tmp_path, f'{{"lifecycle": {text}}}')
    assert (configuration.lifecycle is not None, configuration.has_bond) == (managed, bond)


@pytest.mark.parametrize(
    ("text", "line", "column", "message"),
    [
        ('{"controlLoop": {"periodMS": 3}}', 1, 18, 'unknown key "controlLoop.periodMS"'),
        ('{\n  "control_loop": {}\n}', 2, 3, 'unknown key "control_loop"'),
        ('{"qos": {"a": {}, "/b": {"deep": 1}}}', 1, 26, 'unknown key "qos./b.deep"'),
        ('{"watchdogStops": "yes"}', 1, 2, '"watchdogStops" must be a valid boolean'),
        ('{"retryMs": true}', 1, 2, '"retryMs" must be a valid integer'),
        ('{"retryMs": "7"}', 1, 2, '"retryMs" must be a valid integer'),
        ('{"retryMs": 1.5}', 1, 2, '"retryMs" must be a valid integer'),
        ('{"retryMs": 0}', 1, 2, '"retryMs" must be greater than or equal to 1'),
        ('{"controlLoop": {"eventsPerTick": 65536}}', 1, 18, '"controlLoop.eventsPerTick" must be less than or equal'),
        ('{"watchdogMs": {"/scan": 100, "scan": 100}}', 1, 2, '"watchdogMs" names scan twice'),
        ('{"onShutdown": ["halt",\n 3]}', 2, 2, '"onShutdown.1" must be a valid string'),
        ('{"onShutdown": "halt"}', 1, 2, '"onShutdown" must be an array'),
        ('{"lifecycle": 1}', 1, 2, '"lifecycle" must be true, false or an object, such as {"bond": true}'),
        ('{"lifecycle": {"bound": true}}', 1, 16, 'unknown key "lifecycle.bound"'),
        ('{"package": []}', 1, 2, '"package" must be an object'),
        ('{"package": {"name": "Robot"}}', 1, 14, '"package.name" must match pattern'),
        ('{"supervisor": {"controller": {"launch": {"file": "x"}}}}', 1, 32, "launch.packageName"),
        ('{"retryMs": 1, "é": {}, "retryMs": 2}', 1, 25, 'the key "retryMs" occurs twice'),
        ("[]", 1, 1, "the file must be an object"),
        ('{"retryMs": 1,\n}', 2, 1, "not JSON"),
        ("", 1, 1, "not JSON"),
        ("[" * 100_000, 1, 1, "nested too deeply"),
    ],
)
def test_a_fault_is_located_and_names_its_key(tmp_path: Path, text: str, line: int, column: int, message: str) -> None:
    with pytest.raises(ModelError) as raised:
        read(tmp_path, text)
    found = [diagnostic for diagnostic in raised.value.diagnostics if message in diagnostic.message]
    assert [(finding.span.line, finding.span.column) for finding in found] == [(line, column)]
    assert found[0].file == str(tmp_path / config.FILE_NAME)
    assert found[0].rule == config.RULE


def test_a_number_without_end_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="not JSON"):
        read(tmp_path, f'{{"retryMs": {"9" * 5000}}}')


def test_all_faults_at_once(tmp_path: Path) -> None:
    with pytest.raises(ModelError) as raised:
        read(tmp_path, '{"retryMs": 1, "retryMs": "x", "colour": 1, "periodMs": 5, "package": {"versoin": "1"}}')
    messages = {diagnostic.message: diagnostic.hint for diagnostic in raised.value.diagnostics}
    assert messages == {
        'the key "retryMs" occurs twice': None,
        '"retryMs" must be a valid integer': None,
        'unknown key "colour"': f"known here: {', '.join(EVERYTHING)}",
        'unknown key "package.versoin"': 'did you mean "version"?',
        'unknown key "periodMs"': 'did you mean "controlLoop.periodMs", which is written'
        ' {"controlLoop": {"periodMs": …}}?',
    }


def test_a_file_in_another_encoding(tmp_path: Path) -> None:
    (tmp_path / "latin.json").write_bytes('{"é": 1}'.encode("latin-1"))
    with pytest.raises(ModelError, match="not UTF-8"):
        config.read(tmp_path / "latin.json")


def test_later_findings_stand_at_their_key(tmp_path: Path) -> None:
    configuration = read(tmp_path, '{"onShutdown": ["halt", "jump"]}')
    finding = configuration.error(("onShutdown", 1), "there is no message jump", "there are: halt")
    assert (finding.span.line, finding.span.column, finding.span.end_column) == (1, 25, 31)
    assert finding.file == str(tmp_path / config.FILE_NAME)
    around = configuration.error(("onShutdown", 7, "x"), "not there")
    assert around.span.column == 2
    assert Configuration().error(("onShutdown", 0), "not from a file").span.column == 1


def test_settings_for_what_the_robot_does_not_have(tmp_path: Path) -> None:
    text = '{"frameId": {"/scam": "a", "/scan": "b"}, "qos": {"odom": {}}, "onShutdown": ["holt"]}'
    configuration = read(tmp_path, text)
    found = configuration.unknown_names(["scan", "stop"])
    assert [(finding.severity, finding.span.column, finding.message, finding.hint) for finding in found] == [
        ("warning", 14, '"frameId": the robot has no scam', 'did you mean "scan"?'),
        ("warning", 51, '"qos": the robot has no odom', "known here: scan, stop"),
    ]
    # The generators report unsendable shutdown messages, not this function.
    assert {unknown_name.hint for unknown_name in configuration.unknown_names([])} == {None}


def test_found_beside_the_model_or_below(tmp_path: Path) -> None:
    assert config.find(tmp_path) is None
    far = tmp_path / "a" / "b" / config.FILE_NAME
    far.parent.mkdir(parents=True)
    far.write_text("{}")
    assert config.find(tmp_path) == far
    near = tmp_path / "z" / config.FILE_NAME
    near.parent.mkdir()
    near.write_text("{}")
    assert config.find(tmp_path) == near
    beside = tmp_path / config.FILE_NAME
    beside.write_text("{}")
    assert config.find(tmp_path) == beside


def test_hidden_linked_and_distant_folders_are_left_out(tmp_path: Path) -> None:
    for folder in (".hidden", "a/b/c/d"):
        (tmp_path / folder).mkdir(parents=True)
        (tmp_path / folder / config.FILE_NAME).write_text("{}")
    (tmp_path / "link").symlink_to(tmp_path / ".hidden")
    assert config.find(tmp_path) is None


def test_two_equally_near_are_an_error(tmp_path: Path) -> None:
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / config.FILE_NAME).write_text("{}")
    with pytest.raises(ModelError, match=r"a/controller-config\.json and b/controller-config\.json"):
        config.find(tmp_path)


def test_the_shipped_schema_is_up_to_date_and_agrees(golden: Callable[[Path, str], None]) -> None:
    shipped = locate("schemas/controller-config.schema.json")
    golden(shipped, config.schema())
    validator = jsonschema.Draft202012Validator(json.loads(shipped.read_text()))
    validator.check_schema(validator.schema)
    assert list(validator.iter_errors(EVERYTHING)) == []
    for wrong in ({"colour": 1}, {"controlLoop": {"periodMs": 0}}, {"qos": {"scan": {"depth": "1"}}}):
        assert list(validator.iter_errors(wrong))


def test_every_key_is_explained() -> None:
    manual = (Path(__file__).parents[3] / "docs" / "configuration.md").read_text()

    def keys(values: dict[str, object], before: str = "") -> list[str]:
        below = [(f"{before}{name}", value) for name, value in values.items()]
        maps = ("frameId", "qos", "watchdogMs", "supervisor.controller.run", "supervisor.controller.launch")
        return [
            key
            for name, value in below
            for key in (keys(value, f"{name}.") if isinstance(value, dict) and name not in maps else [name])
        ]

    assert [key for key in keys(EVERYTHING) if f"`{key}`" not in manual and f"`{key}.<topic>`" not in manual] == []


def test_a_pipe_is_found_and_refused(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "controller-config.json")
    file = config.find(tmp_path)
    assert file == tmp_path / "controller-config.json"
    with pytest.raises(OSError, match="only regular files are read"):
        config.read(file)
