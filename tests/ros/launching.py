"""Evaluation of a ROS 2 launch file without the launch system: a stand-in for the parts that generated files use."""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass, field
from types import ModuleType
from typing import Any
from unittest.mock import patch


@dataclass(frozen=True)
class Context:
    """Context in which a launch file is evaluated."""

    launch_configurations: dict[str, str]


@dataclass(frozen=True)
class Made:
    """An action or a substitution: its kind and its arguments."""

    kind: str
    positional: tuple[Any, ...] = ()
    named: dict[str, Any] = field(default_factory=dict)

    def perform(self, context: Context) -> str:
        """Return the value of a launch configuration. The path of an installed file is that of an empty file."""
        value = context.launch_configurations[self.positional[0]]
        return value if isinstance(value, str) else os.devnull


@dataclass(frozen=True)
class Launched:
    """Contents of a launch file: the arguments with their values, and the actions in their order."""

    arguments: dict[str, str]
    actions: list[Made]

    def of(self, kind: str) -> list[Made]:
        """Return the actions of a kind, such as `Node`."""
        return [action for action in self.actions if action.kind == kind]


_MODULES = {
    "launch": ["LaunchDescription"],
    "launch.actions": [
        "DeclareLaunchArgument",
        "GroupAction",
        "IncludeLaunchDescription",
        "OpaqueFunction",
        "UnsetLaunchConfiguration",
    ],
    "launch.launch_description_sources": ["AnyLaunchDescriptionSource"],
    "launch.substitutions": ["LaunchConfiguration", "PathJoinSubstitution"],
    "launch_ros": [],
    "launch_ros.actions": ["LoadComposableNodes", "Node", "SetRemap"],
    "launch_ros.descriptions": ["ComposableNode"],
    "launch_ros.parameter_descriptions": ["ParameterValue"],
    "launch_ros.substitutions": ["FindPackageShare"],
}


def launched(text: str, **arguments: str) -> Launched:
    """Evaluate the text of a launch file with these arguments."""
    modules = {name: ModuleType(name) for name in _MODULES}
    for name, members in _MODULES.items():
        for member in members:
            setattr(modules[name], member, _maker(member))
    file: dict[str, Any] = {}
    with patch.dict(sys.modules, modules):
        exec(compile(text, "launch", "exec"), file)  # noqa: S102  # our own text
        entities = file["generate_launch_description"]().positional[0]
    declared = [entity for entity in entities if entity.kind == "DeclareLaunchArgument"]
    values = {argument.positional[0]: argument.named["default_value"] for argument in declared} | arguments
    return Launched(values, [action for entity in entities for action in _unfolded(entity, values)])


def _maker(kind: str) -> Any:
    return lambda *positional, **named: Made(kind, positional, named)


def _unfolded(entity: Made, values: dict[str, str]) -> list[Made]:
    match entity.kind:
        case "OpaqueFunction":
            inner = entity.named["function"](Context(values))
        case "GroupAction":
            inner = entity.positional[0]
        case _:
            return [entity]
    return [action for part in inner for action in _unfolded(part, values)]
