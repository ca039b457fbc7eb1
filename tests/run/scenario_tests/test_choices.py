"""The controller in Python sends the object or array that provided data chooses."""

from __future__ import annotations

from pathlib import Path

from click.testing import CliRunner

from robosc.tools.cli import main

MODEL = Path(__file__).parents[2] / "m2t" / "cpp" / "chooser.rscd"
SCENARIO = """scenario "a person comes"
  wait 200 ms
  expect velocity sent with {"linear": {"x": 0.3}, "angular": {"z": 1.0}}
  expect nested sent with {"linear": {"x": 0.1}, "angular": {"z": 0.5}}
  expect gain not sent
  first_seen with message {"position": {"x": 1.0}}
  second_seen with message {"position": {"x": 2.0}}
  measured with message {"linear": {"z": 7.0}}
  measured_gains with message {"data": [2.0, 5.0]}
  range with message {"data": 2.0}
  wait 200 ms
  expect nested sent with {"linear": {"x": 0.0, "y": 3.0}}
  expect aim sent with {"position": {"x": 2.0}, "orientation": {"w": 1.0}}
  expect gain sent with [2.0, 5.0]
  seen with message {"data": true}
  wait 200 ms
  expect velocity sent with {"linear": {"x": 0.1}, "angular": {}}
  expect nested sent with {"linear": {"y": 0.0, "z": 7.0}}
  expect aim sent with {"position": {"x": 1.0}}
  expect gain sent with []
  measured_gains with message {"data": [0.5]}
  wait 200 ms
  expect gain sent with [1.0, 0.5]
"""


def test_the_chosen_data_is_sent(tmp_path: Path) -> None:
    (tmp_path / "person.scenarios").write_text(SCENARIO)
    answer = CliRunner().invoke(main, ["test", str(MODEL), str(tmp_path / "person.scenarios")], catch_exceptions=False)
    assert answer.exit_code == 0, answer.output
