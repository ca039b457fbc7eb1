"""The model of a new robot."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.tools.starter.choices import camel

if TYPE_CHECKING:
    from robosc.tools.starter.choices import Choices

_SENSOR = """
  // Allows or forbids `{command}` on /{name}. Until the first message, it forbids it.
  component {component} {{
    outgoing message {name} with identifier: "/{name}", type: boolean

    behaviour {{
      initial marked state inactive {{ on response from {name} if value goto active }}

      state active {{ on response from {name} if !value goto inactive }}
    }}
  }}
"""
_SERVICE = """
  // The controller calls it at the start, and again until it succeeds.
  component {component} {{
    service {name} with identifier: "/{name}", request: none, response: std_srvs/Trigger

    behaviour {{
      initial marked state waiting {{ on request to {name} goto called }}

      state called {{
        on response from {name} if value.success goto done
        on response from {name} goto waiting
        on error from {name} goto waiting
      }}

      marked state done {{ }}
    }}
  }}
"""
_SPEED = """
  // Meters per second.
  parameter speed: double(0.0..1.0) = 0.2
"""


def sensor_component(name: str) -> str:
    """Return the name of the component of a sensor's message."""
    return f"{camel(name)}Sensor"


def service_component(name: str) -> str:
    """Return the name of the component of a service."""
    return f"{camel(name)}Service"


def model(choices: Choices) -> str:
    """Return the text of the robot, not yet formatted."""
    parts = [
        f"// The supervisory controller of {choices.robot} sends `{choices.command}` while all conditions hold.",
        f"robot {choices.robot} {{",
        _SPEED if choices.twist else "",
        *(
            _SENSOR.format(name=name, component=sensor_component(name), command=choices.command)
            for name in choices.sensors
        ),
        _SERVICE.format(name=choices.service, component=service_component(choices.service)) if choices.service else "",
        _base(choices),
        _requirements(choices),
        _provided(choices) if choices.twist else "",
        "}\n",
    ]
    return "\n".join(filter(None, parts))


def _base(choices: Choices) -> str:
    interface = (
        'identifier: "/cmd_vel", type: geometry_msgs/Twist' if choices.twist else 'identifier: "/{}", type: none'
    )
    messages = "\n".join(f"incoming message {name} with {interface.format(name)}" for name in choices.commands)
    return f"  component Base {{\n{messages}\n}}\n"


def _requirements(choices: Choices) -> str:
    needed = [f"{sensor_component(name)}.active" for name in choices.sensors]
    missing = [f"{sensor_component(name)}.inactive" for name in choices.sensors]
    if choices.service:
        needed.append(f"{service_component(choices.service)}.done")
        missing.append(f"!{service_component(choices.service)}.done")
    lines = [f"requirement {choices.command} needs {' and '.join(needed)}"]
    if choices.stop:
        lines.append(f"requirement {choices.stop} needs {' or '.join(missing)}")
    return "\n".join(lines) + "\n"


def _provided(choices: Choices) -> str:
    speeds = ["speed", "0.0"]
    return "\n".join(
        f"provide {name} with {{ linear: {{ x: {speed} }}, angular: {{ z: 0.0 }} }}"
        for name, speed in zip(choices.commands, speeds, strict=False)
    )


def condition(choices: Choices) -> str:
    """Return the condition for the command in words."""
    conditions = [f"`/{name}` has last said true" for name in choices.sensors]
    if choices.service:
        conditions.append(f"`/{choices.service}` has succeeded")
    *others, last = conditions
    return f"{', '.join(others)} and {last}" if others else last
