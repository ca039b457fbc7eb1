"""The page that describes the folder of a guard."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.tools.starter.guard.choices import GuardChoices

_TEXT = """\
# {robot}: guard

The supervisory layer `{package}` stands between your programs and the robot. It forwards a command only if all
requirements on it hold.

| file | content |
|---|---|
| `{stem}.rscd` | the model: the commands of the robot and their requirements |
| `controller-config.json` | settings of the layer |
| `{stem}.scenarios` | scenarios: what the layer blocks |

| command | type | send it to | name in the model |
|---|---|---|---|
{rows}

- The robot begins stopped. The emergency stop publishes `/emergency_stop` (`std_msgs/Bool`){repeats}. The robot
  continues after a message on `/continue` (`std_msgs/Empty`).
- While the robot is stopped, the layer blocks all these commands and cancels goals.
{further}
## Check it

```sh
robosc check {stem}.rscd  # errors and warnings
robosc verify {stem}.rscd  # proofs of the requirements
robosc test {stem}.rscd {stem}.scenarios  # the scenarios
```

## On the robot

```sh
robosc run {stem}.rscd --layer  # the layer, without a build
robosc graph -o graph.json  # the running ROS graph
robosc verify {stem}.rscd --guard graph.json  # commands that go around the layer
```

Your programs send to the names in the table above. `robosc transform {stem}.rscd --to ros2-layer` writes a package
whose launch file renames them for you.

## Next steps

- Add a requirement: one line in `{stem}.rscd`, and a scenario that shows what it blocks.
- A command that stops the robot must always pass: take it out of the requirement `Stopped`.
- `robosc rule` lists the rules of a model.
"""


def page(choices: GuardChoices) -> str:
    """Return the text of `README.md`."""
    return _TEXT.format(
        robot=choices.robot,
        stem=choices.stem,
        package=choices.package,
        rows="\n".join(_rows(choices)),
        repeats=" at least twice a second" if choices.button == "periodic" else " and keeps the last message",
        further="".join(f"- {line}\n" for line in _further(choices)),
    )


def _rows(choices: GuardChoices) -> Iterator[str]:
    for command in choices.commands:
        inside = f"/{choices.package}/controller/{command.name.removeprefix('/')}"
        yield f"| {command.kind} `{command.name}` | `{command.ros_type}` | `{inside}` | `{command.word}` |"


def _further(choices: GuardChoices) -> Iterator[str]:
    if choices.velocities:
        yield "The layer limits velocities to `max_speed` and `max_turn`, parameters of its node."
    if choices.stopping:
        yield "In place of the first message that it blocks, the layer sends one that stops the robot (`onBlocked`)."
    if choices.goals:
        yield f"A goal passes only while the variance of the position on `{choices.pose}` is small."
