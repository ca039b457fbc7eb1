"""The page that describes the folder of a new robot."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.tools.starter.model import condition, sensor_component, service_component

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.tools.starter.choices import Choices

_TEXT = """\
# {robot}

The controller sends `{command}` while {condition}.{otherwise}

| file | content |
|---|---|
| `{stem}.rscd` | the model: the components of the robot and the requirements of its commands |
| `controller-config.json` | settings of the generated node |
| `test_{stem}.py` | a test: `python -m unittest`, or `pytest` |

| component | {kind} | type | in or out of the controller |
|---|---|---|---|
{rows}

## Try it

```sh
robosc check {stem}.rscd        # errors and warnings
robosc synthesize {stem}.rscd   # the supervisor: states and guards
robosc verify {stem}.rscd       # proofs of its properties
robosc simulate {stem}.rscd     # by hand: `h` lists the commands
python -m unittest
```

## On the robot
{run}
As a package:

```sh
robosc transform {stem}.rscd --to ros{ros}
{build}
```
{warned}
## Next steps

Change the names of topics to those of your robot. Add the states of your components, and write a
`requirement` for each event that must not happen. `robosc rule` lists the rules of a model, each with
a wrong and a right model.
"""
_RUN = """
Without a build, on ROS 2:

```sh
robosc run {stem}.rscd
```
"""
_BUILD = {
    1: """\
cp -r build/{robot}/ros1/{package} ~/catkin_ws/src/
cd ~/catkin_ws && catkin_make && . devel/setup.sh
roslaunch {package} {package}.launch""",
    2: """\
cp -r build/{robot}/ros2/{package} ~/ros2_ws/src/
cd ~/ros2_ws && colcon build && . install/setup.sh
ros2 launch {package} {package}.launch.py""",
}
_WARNED = """
`transform` warns that `{stop}` is sent when the node ends, regardless of its requirement:
`onShutdown` in the configuration requests it.
"""


def page(choices: Choices) -> str:
    """Return the text of `README.md`."""
    return _TEXT.format(
        robot=choices.robot,
        stem=choices.stem,
        ros=choices.ros,
        command=choices.command,
        condition=condition(choices),
        otherwise=f" Otherwise, it sends `{choices.stop}`." if choices.stop else "",
        kind="topic or service" if choices.service else "topic",
        rows="\n".join(_rows(choices)),
        run=_RUN.format(stem=choices.stem) if choices.ros == 2 else "",
        build=_BUILD[choices.ros].format(robot=choices.robot, package=choices.package),
        warned=_WARNED.format(stop=choices.stop) if choices.stop else "",
    )


def _rows(choices: Choices) -> Iterator[str]:
    for name in choices.sensors:
        yield f"| `{sensor_component(name)}` | `/{name}` | `std_msgs/Bool` | in |"
    if choices.service:
        yield f"| `{service_component(choices.service)}` | `/{choices.service}` | `std_srvs/Trigger` | called |"
    for name in choices.commands:
        topic, kind = ("cmd_vel", "geometry_msgs/Twist") if choices.twist else (name, "std_msgs/Empty")
        yield f"| `Base` | `/{topic}`, `{name}` | `{kind}` | out |"
