"""The built-in defaults of ROS types equal those of the installed ROS 2."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from robosc.base.ros_types import RosTypes, Section
from robosc.base.ros_types.wire import Basic, Sequence

if TYPE_CHECKING:
    from tests.ros.running import Runner

#: Prints the fields of all installed messages and requests: package, type, section, field, and its default value.
NEW = """
import importlib, json, site
from pathlib import Path
for kind, parts in (("msg", {"MESSAGE": None}), ("srv", {"REQUEST": "Request", "RESPONSE": "Response"})):
    for path in sorted(Path(site.getsitepackages()[0]).glob(f"*/{kind}/__init__.py")):
        package = path.parents[1].name
        types = importlib.import_module(f"{package}.{kind}")
        for name in dir(types):
            for section, part in parts.items():
                made = getattr(getattr(types, name), part, None) if part else getattr(types, name)
                if "_" in name or not hasattr(made, "get_fields_and_field_types"):
                    continue
                for field in made.get_fields_and_field_types():
                    value = getattr(made(), field)
                    value = value.tolist() if hasattr(value, "tolist") else value
                    if isinstance(value, (bool, int, float, str)) or (isinstance(value, list) and len(value) < 100):
                        print(json.dumps([package, name, section, field, value], default=lambda _: None))
"""


@pytest.mark.parametrize("shipped", [False, True])
def test_new_messages(run_ros2: Runner, monkeypatch: pytest.MonkeyPatch, *, shipped: bool) -> None:
    """The defaults are equal for types from the installed definitions, and for types that the tool ships."""
    command = [run_ros2.ros.python, "-c", NEW]
    done = subprocess.run(command, env=run_ros2.ros.environment, capture_output=True, text=True, check=True)
    prefix = Path(run_ros2.ros.python).parents[1]
    monkeypatch.setenv("AMENT_PREFIX_PATH", "" if shipped else str(prefix))
    types = RosTypes().distribution(2)
    differing, known = [], 0
    for package, name, section, field, value in map(json.loads, done.stdout.splitlines()):
        reached = types.type_at(package, name, Section[section], [field])
        match reached and reached[0]:
            case Basic() as basic:
                initial: object = basic.initial
            case Sequence(element=Basic() as element) as array:
                initial = list(array.default or [element.initial] * array.initial_length)
            case _:
                continue
        known += 1
        if initial != value:
            differing.append((package, name, field, initial, value))
    assert known > 200
    assert differing == []
