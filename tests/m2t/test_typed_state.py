"""The package with the type of a robot's state; `tests/ros` shows that it builds and that nodes publish it."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from catkin_pkg.package import parse_package_string
from rosbags.typesys import get_types_from_msg

import robosc
from robosc.base.diagnostics import ModelError
from robosc.language.configuration import Configuration
from robosc.m2t.models import Models
from robosc.m2t.targets import TARGETS

if TYPE_CHECKING:
    from collections.abc import Callable

HERE = Path(__file__).parent
TYPED = Configuration(typed_state=True)
#: Names that clash, are keywords of C++ or Python, or are invalid in ROS; an enumeration larger than a byte.
ODD = """\
robot Odd {{
  datatype enum Wide from integer to {{ {rules} default -> none }}

  component class {{
    outgoing message told with identifier: "/told", type: Wide
    behaviour {{
      variable b__: Wide
      variable b: boolean
      on response from told do b__ := value
      initial marked state atna_ {{ }}
    }}
  }}
  component Class {{
    outgoing message heard with identifier: "/heard", type: none
    behaviour {{
      initial marked state is_a {{ on response from heard goto is__a }}
      state is__a {{ on response from heard goto is_a }}
    }}
  }}
  component header {{
    outgoing message seen with identifier: "/seen", type: none
    behaviour {{ initial marked state _1 {{ on response from seen }} }}
  }}
}}
"""


def models_of(text: str) -> Models:
    robot = robosc.load(text=text)
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    return Models(model, robosc.to_rosgraph(robot), robot)


@pytest.mark.parametrize("target", ["ros1", "ros2"])
def test_every_file(courier: robosc.Models, target: str, golden: Callable[[Path, str], None]) -> None:
    files = TARGETS[target].beside(courier, TYPED)
    assert list(files) == [
        f"{target}/courier_msgs/{name}" for name in ("package.xml", "CMakeLists.txt", "msg/State.msg")
    ]
    for path, text in files.items():
        # The type is the same in each ROS and has one golden file for both.
        golden(HERE / "typed_state" / path.removeprefix(f"{target}/courier_msgs/msg/"), text)
    if target == "ros2":
        assert TARGETS["ros2-layer"].beside(courier, TYPED) == files
    assert TARGETS[target].beside(courier, Configuration()) == {}
    node = robosc.generate(target, courier, TYPED)
    assert "courier_msgs" in node["CMakeLists.txt"]
    assert "courier_msgs" in [depend.name for depend in parse_package_string(node["package.xml"]).build_depends]
    plain = robosc.generate(target, courier, Configuration())
    assert "typed" not in plain["src/courier_controller_node.cpp"]


@pytest.mark.slow
@pytest.mark.parametrize("target", ["ros1", "ros2"])
def test_the_image_of_a_package_with_tests_builds_both(courier: robosc.Models, target: str) -> None:
    typed, plain = (
        robosc.generate(target, courier, configuration, with_tests=True)["Dockerfile"].splitlines()
        for configuration in (TYPED, Configuration())
    )
    assert [line for line in plain if line.startswith("COPY . ")] == ["COPY . src/courier_controller"]
    assert [line for line in typed if line.startswith("COPY courier")] == [
        "COPY courier_controller src/courier_controller",
        "COPY courier_msgs src/courier_msgs",
    ]
    assert any("docker build -t courier_controller -f Dockerfile .. " in line for line in typed)


def test_the_platform_s_linter_is_content(courier: robosc.Models, tmp_path: Path) -> None:
    for path, text in TARGETS["ros1"].beside(courier, TYPED).items():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(text, encoding="utf-8")
    command = [sys.executable, "-m", "catkin_lint", "-W2", "--strict", tmp_path / "ros1" / "courier_msgs"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, ""), done.stderr


def test_any_name_becomes_one_of_both_ros() -> None:
    models = models_of(ODD.format(rules=" ".join(f"value = {number} -> v{number}" for number in range(300))))
    text = TARGETS["ros2"].beside(models, TYPED)["ros2/odd_msgs/msg/State.msg"]
    found = re.findall(r"^(\w+) (\w+)(=\d+)?$", text, re.MULTILINE)
    constants = [name for _, name, value in found if value]
    fields = [name for _, name, value in found if not value]
    assert len(set(constants)) == len(constants) == 301 + 1 + 2 + 1
    assert len(set(fields)) == len(fields) == 5
    for pattern, names in ((r"[A-Z](_?[A-Z0-9]+)*", constants), (r"[a-z](_?[a-z0-9]+)*", fields)):
        assert [name for name in names if not re.fullmatch(pattern, name)] == []
    assert {"class", "header"}.isdisjoint(fields)
    assert "uint16 class_2_b" in text
    (definition,) = get_types_from_msg(text, "odd_msgs/msg/State").values()
    assert len(definition[0]) == len(constants)


def test_it_needs_what_it_is_a_form_of(courier: robosc.Models) -> None:
    with pytest.raises(ModelError, match="publishStateInformation"):
        robosc.generate("ros1", courier, Configuration(typed_state=True, publish_state_information=False))
