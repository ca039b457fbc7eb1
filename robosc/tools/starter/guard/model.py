"""The model of a guard."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.base.ros_types import Section
from robosc.tools.starter.guard.choices import VELOCITIES

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from robosc.base.ros_types import RosTypes
    from robosc.tools.starter.guard.choices import Command, GuardChoices

BUTTONS = {"periodic": "PeriodicEmergencyStop", "latched": "LatchedEmergencyStop"}
#: Largest variance of a position, in square meters, with which the robot counts as localized.
VARIANCE = 0.25
#: Parts of each kind of type, by the words of the language.
_PARTS = {
    "topic": {"type": Section.MESSAGE},
    "service": {"request": Section.REQUEST, "response": Section.RESPONSE},
    "action": {"request": Section.GOAL, "response": Section.RESULT, "feedback": Section.FEEDBACK},
}
_DECLARED = {"topic": "incoming message", "service": "service", "action": "action"}
_SPEEDS = """
  // Meters per second, and radians per second.
  parameter max_speed: double(0.0..5.0) = 0.5
  parameter max_turn: double(0.0..5.0) = 1.0

  function within(speed: double, most: double): double = max(-most, min(speed, most))
"""
_LOCALIZATION = """
  // The robot knows its place while the variance of its position is small.
  component Localization {{
    outgoing message pose with identifier: "{pose}", type: geometry_msgs/PoseWithCovarianceStamped

    behaviour {{
      variable precise: boolean = false

      initial marked state reporting {{
        on response from pose
          do precise := value.pose.covariance[0] < {variance} and value.pose.covariance[7] < {variance}
      }}
    }}
  }}
"""
_REQUIREMENTS = """
  // While the robot is stopped, the layer blocks these commands and cancels goals. Leave out commands that stop the
  // robot: they must always pass.
  requirement Stopped "the robot is stopped": {commands} needs EmergencyStop.in_service
{localized}
  // Add your own requirements here, one per line, such as:
  // requirement Slow "slow while a person is near": {example} needs Person.far
"""


def model(choices: GuardChoices, types: RosTypes) -> str:
    """Return the text of the robot, not yet formatted. A type whose definition is unknown gets an interface."""
    unknown = [command for command in choices.commands if not _is_known(command, types)]
    interfaces = _interfaces(unknown, choices)
    words = [command.word for command in choices.commands]
    goals = [command.word for command in choices.goals]
    parts = [
        f"// The guard of {choices.robot}: the layer forwards a command only if all requirements on it hold.",
        f"robot {choices.robot} {{",
        "".join(_declarations(unknown, interfaces)),
        _SPEEDS if choices.velocities else "",
        f"component EmergencyStop from EmergencyStopLibrary import {BUTTONS[choices.button]}\n",
        _LOCALIZATION.format(pose=choices.pose, variance=VARIANCE) if choices.goals else "",
        "// The commands of the robot: its topics, services and actions.",
        "component Commands {",
        *(_communication(command, interfaces.get(command)) for command in choices.commands),
        "}",
        _REQUIREMENTS.format(
            commands=_set(words),
            localized=f"requirement Localized: {_set(goals)} needs Localization.precise\n" if goals else "",
            example=words[0],
        ),
        *(_limit(command) for command in choices.velocities),
        "}\n",
    ]
    return "\n".join(filter(None, parts))


def _is_known(command: Command, types: RosTypes) -> bool:
    return all(
        types.distribution(2).defines(command.package, command.type, section)
        for section in _PARTS[command.kind].values()
    )


def _interfaces(unknown: Sequence[Command], choices: GuardChoices) -> dict[Command, str]:
    """Return the names of interfaces for commands: one for each type and kind."""
    names: dict[tuple[str, str], str] = {}
    words = {command.word for command in choices.commands}
    for command in unknown:
        key = (command.kind, command.ros_type)
        name = f"{command.word}_type"
        while key not in names and (name in words or name in names.values()):
            name += "_"
        names.setdefault(key, name)
    return {command: names[command.kind, command.ros_type] for command in unknown}


def _declarations(unknown: Sequence[Command], interfaces: dict[Command, str]) -> Iterator[str]:
    if not unknown:
        return
    used = {interfaces[command]: command for command in unknown}
    for name, command in used.items():
        yield f"interface {name} use {command.type} from {command.package}\n"
    yield "\n// Data of types whose definitions RoboSC does not know: the layer forwards it unchanged.\n"
    yield "datatype object Forwarded {}\n\n"


def _communication(command: Command, interface: str | None) -> str:
    data = "Forwarded" if interface else command.ros_type
    links = f" links {interface}" if interface else ""
    types = ", ".join(f"{word}: {data}" for word in _PARTS[command.kind])
    return f'{_DECLARED[command.kind]} {command.word} with identifier: "{command.name}", {types}{links}'


def _set(words: Sequence[str]) -> str:
    return words[0] if len(words) == 1 else f"{{ {', '.join(words)} }}"


def _limit(command: Command) -> str:
    path = VELOCITIES[command.ros_type]
    vectors = []
    for vector, most in (("linear", "max_speed"), ("angular", "max_turn")):
        source = ".".join(["value", *path, vector])
        fields = ", ".join(f"{axis}: within({source}.{axis}, {most})" for axis in "xyz")
        vectors.append(f"{vector}: {{ {fields} }}")
    data = f"{{ {', '.join(vectors)} }}"
    for outer in reversed(path):
        data = f"{{ {outer}: {data} }}"
    return f"limit {command.word} with {data}"
