"""The generators of ROS 2 process the package with the type of a robot's state; ROS 1 builds it with the courier."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tests.ros.running import Runner

TYPED = Path(__file__).parents[1] / "m2t" / "typed_state"
SCRIPT = """
from courier_msgs.msg import State
state = State(scanner=State.SCANNER_IS_TURNING, scanner_seen=State.SCANNER_SEEN_IS_NOTHING, counter_text="a")
print(state.scanner, state.scanner_seen, state.counter_limited, state.counter_text)
print(len(State.get_fields_and_field_types()))
"""


def test_it_is_a_type_of_ros_2(run_ros2: Runner, tmp_path: Path) -> None:
    environment = run_ros2.environment()
    package = tmp_path / "courier_msgs"
    shutil.copytree(TYPED / "ros2" / "courier_msgs", package)
    (package / "msg").mkdir()
    shutil.copy(TYPED / "State.msg", package / "msg")
    command = [run_ros2.ros.python, "-m", "robosc", "interfaces", "build", package, "-o", tmp_path / "modules"]
    subprocess.run(command, env=environment, check=True, capture_output=True)
    environment["PYTHONPATH"] = f"{tmp_path / 'modules'}:{environment['PYTHONPATH']}"
    done = subprocess.run(
        [run_ros2.ros.python, "-c", SCRIPT], env=environment, check=True, capture_output=True, text=True
    )
    fields = [line for line in (TYPED / "State.msg").read_text().splitlines() if line and line[0] != "#"]
    assert done.stdout.split() == ["1", "3", "0", "a", str(sum("=" not in line for line in fields))]
