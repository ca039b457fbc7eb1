"""Choices of a user for a guard."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property

from robosc.base.node_graph import KINDS
from robosc.base.ros_types.wire import FOLDERS
from robosc.model.semantics.naming import ROBOSC_FUNCTIONS, ROBOSC_KEYWORDS, ROBOSC_QUANTIFIERS, snake_case
from robosc.tools.starter.choices import RobotName, robot_fault

#: Kinds of ROS types, by the kind of the name that has them.
TYPE_KINDS = {"topic": "message", "service": "service", "action": "action"}
_NAME = re.compile(r"/?[A-Za-z_][A-Za-z0-9_]*(?:/[A-Za-z_][A-Za-z0-9_]*)*")
_TYPE = re.compile(r"([a-z][a-z0-9_]*)/(?:(msg|srv|action)/)?([A-Z][A-Za-z0-9]*)")
_EXAMPLES = {
    "topic": "/cmd_vel:geometry_msgs/Twist",
    "service": "/gripper/release:std_srvs/Trigger",
    "action": "/navigate_to_pose:nav2_msgs/NavigateToPose",
}
#: Types of a velocity, and the objects around its fields.
VELOCITIES = {"geometry_msgs/Twist": (), "geometry_msgs/TwistStamped": ("twist",)}
#: Types whose default data stops the robot.
STOPS = {*VELOCITIES, "trajectory_msgs/JointTrajectory"}
#: Names that the model gives itself.
_TAKEN = {"pressed", "continue", "pose", "within", "max_speed", "max_turn"}


@dataclass(frozen=True)
class Command:
    """A topic, service or action of the robot, and its word in the model."""

    kind: str
    name: str
    package: str
    type: str
    word: str

    @property
    def ros_type(self) -> str:
        """The type as models name it: `geometry_msgs/Twist`."""
        return f"{self.package}/{self.type}"


@dataclass(frozen=True)
class GuardChoices(RobotName):
    """A robot's name, and its topics, services and actions, each as NAME:TYPE.

    `button` is `periodic` or `latched`: whether the emergency stop repeats its state. `pose` is the topic of the
    localization, without which no goal passes.
    """

    topics: tuple[str, ...] = ()
    services: tuple[str, ...] = ()
    actions: tuple[str, ...] = ()
    button: str = "periodic"
    pose: str | None = None

    @property
    def package(self) -> str:
        """The name of the layer's package, node and executable."""
        return self.stem if self.stem.endswith("_layer") else f"{self.stem}_layer"

    @property
    def _named(self) -> list[tuple[str, str]]:
        return [(kind, text) for kind in KINDS for text in getattr(self, f"{kind}s")]

    @cached_property
    def commands(self) -> list[Command]:
        """The topics, services and actions of the robot. Precondition: `fault` returns None."""
        taken = {*ROBOSC_KEYWORDS, *ROBOSC_FUNCTIONS, *ROBOSC_QUANTIFIERS, *_TAKEN}
        commands = []
        for kind, text in self._named:
            name, _, type_name = text.partition(":")
            match = _TYPE.fullmatch(type_name)
            assert match
            word = _word(name, taken)
            taken.add(word)
            commands.append(Command(kind, name, match[1], match[3], word))
        return commands

    @property
    def velocities(self) -> list[Command]:
        """The topics of velocities."""
        return [command for command in self.commands if command.kind == "topic" and command.ros_type in VELOCITIES]

    @property
    def stopping(self) -> list[Command]:
        """The topics whose default data stops the robot."""
        return [command for command in self.commands if command.kind == "topic" and command.ros_type in STOPS]

    @property
    def goals(self) -> list[Command]:
        """The actions that need a localization, if there is one."""
        return [command for command in self.commands if command.kind == "action" and self.pose]

    def fault(self) -> str | None:
        """Return the fault of a choice with a hint, or None if all are valid."""
        fault = robot_fault(self.name)
        if fault:
            return fault
        if not self._named:
            return "a guard needs a topic, service or action of the robot: name at least one"
        for kind, text in self._named:
            name, _, type_name = text.partition(":")
            match = _TYPE.fullmatch(type_name)
            if not _NAME.fullmatch(name) or not match:
                return f"`{text}` is not NAME:TYPE of {_article(kind)}: write it as `{_EXAMPLES[kind]}`"
            if match[2] not in (None, FOLDERS[TYPE_KINDS[kind]]):
                return f"`{text}` names another kind of type: {_article(kind)} has a type such as `{_EXAMPLES[kind]}`"
        names = [text.partition(":")[0] for _, text in self._named]
        twice = next((name for name in names if names.count(name) > 1), None)
        if twice:
            return f"`{twice}` is used twice: use different names"
        if self.pose and not _NAME.fullmatch(self.pose):
            return f"`{self.pose}` cannot name a topic: write a name such as `/amcl_pose`"
        return None


def _article(kind: str) -> str:
    return f"an {kind}" if kind == "action" else f"a {kind}"


def _word(name: str, taken: set[str]) -> str:
    """Return the shortest end of a name that is free, as a word of the model."""
    parts = [snake_case(part).strip("_") or "command" for part in name.strip("/").split("/")]
    ends = ["_".join(parts[start:]) for start in reversed(range(len(parts)))]
    words = [*ends, *(f"{ends[-1]}_{number}" for number in range(2, len(taken) + 3))]
    return next(word for word in words if word not in taken)
