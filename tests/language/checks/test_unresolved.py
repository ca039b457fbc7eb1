"""Rules accept models with unresolved names and do not report those names again."""

from pathlib import Path

import pytest
from click.testing import CliRunner

from robosc.tools.cli import main

ROBOT = """
robot R {{
  interface scan use LaserScan from sensor_msgs
  datatype object Scan {{ range_min: double }}
  component Lidar {{
    outgoing message scan with identifier: "/scan", type: Scan links scan
    behaviour {{
      variable seen: boolean = false
      variable far: double
      initial marked state clear {{ {transition} }}
      marked state blocked {{ on response from scan if seen goto clear }}
    }}
  }}
}}
"""


@pytest.mark.parametrize(
    "transition",
    [
        "on response from scan if value.near < 0.5 goto blocked",
        "on response from scan do seen := value.near < 0.5 goto blocked",
        "on response from scan do far := value.near goto blocked",
        "on response from scan if value.range_min.near < 0.5 goto blocked",
        "on response from scan if near(value.range_min) < 0.5 goto blocked",
    ],
)
def test_what_is_not_there_is_one_finding(tmp_path: Path, transition: str) -> None:
    path = tmp_path / "robot.rscd"
    path.write_text(ROBOT.format(transition=transition))
    answer = CliRunner().invoke(main, ["check", str(path)])
    assert answer.exit_code == 1
    assert answer.output.count("[unresolved-reference]") == 1, answer.output
    assert "1 error" in answer.output
