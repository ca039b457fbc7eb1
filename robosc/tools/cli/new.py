"""Command `robosc new`."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

import click

from robosc.base.diagnostics.visible import visible
from robosc.base.files.writing import write
from robosc.language.formatting import format_text
from robosc.language.text import Text
from robosc.tools.cli import CallError, say
from robosc.tools.starter import Choices, files

#: Questions on a terminal, by the choice that they set.
_QUESTIONS = {
    "sensors": "Messages that allow or forbid driving (std_msgs/Bool)",
    "command": "Command to send while all of them allow it",
    "stop": "Command to send otherwise; `-` for none",
    "service": "Service to call first (std_srvs/Trigger); `-` for none",
}
_NONE = "-"


@click.command("new")
@click.argument("name")
@click.option("--ros", type=click.Choice(["1", "2"]), help="The ROS version in README.md.  [default: 2]")
@click.option(
    "--sensor", "sensors", multiple=True, metavar="MESSAGE", help="Message that allows or forbids driving; repeatable."
)
@click.option("--command", "command", metavar="MESSAGE", help="Command to send while all sensors allow it.")
@click.option("--stop", metavar="MESSAGE", help="Command to send otherwise; `-` for none.")
@click.option("--service", metavar="SERVICE", help="Service to call first, until it succeeds.")
@click.option("--twist", is_flag=True, help="Send commands as velocities on /cmd_vel.")
@click.option("-o", "--output", "folder", type=click.Path(), help="The new folder.  [default: the robot's name]")
@click.option("-y", "--yes", is_flag=True, help="Do not prompt; use the defaults.")
def command(name: str, folder: str | None, yes: bool, **options: Any) -> None:
    """Create a model of a robot: a folder with model, configuration, README.md and test.

    On a terminal, the command prompts for all choices that no option sets. The model passes `check`, `format --check`
    and `verify`.

    \b
    Examples:
      robosc new Porter
      robosc new Porter --sensor clear --sensor docked --twist --yes
      robosc new Lift --ros 1 --command raise --stop hold --service calibrate

    Exit status: 0 success, 2 a wrong call, such as a folder that is not empty.
    """
    # Reject invalid names in the call before any prompt.
    _choices(name, options)
    choices = _choices(name, options if yes or not _on_terminal() else _ask(options))
    target = Path(folder or choices.stem)
    texts = create(choices, target)
    say(f"{visible(str(target))}: {', '.join(texts)}")
    say(f"next: cd {visible(str(target))}; robosc simulate {choices.stem}.rscd")


def create(choices: Choices, target: Path) -> list[str]:
    """Write the files of a new robot to a folder, and return their names. Raises CallError if it is not empty."""
    if os.path.lexists(target) and (not target.is_dir() or any(target.iterdir())):
        raise CallError(f"{visible(str(target))} exists already and is not overwritten; choose another folder")
    texts = dict(files(choices))
    model = f"{choices.stem}.rscd"
    laid_out, _ = format_text(Text(model, texts[model]))
    assert laid_out is not None
    write({target: texts | {model: laid_out}})
    return list(texts)


def _choices(name: str, options: dict[str, Any]) -> Choices:
    chosen_options = {key: value for key, value in options.items() if value}
    chosen_options |= {key: None for key in ("stop", "service") if chosen_options.get(key) == _NONE}
    choices = Choices(name, **{**chosen_options, "ros": int(chosen_options.get("ros", 2))})
    fault = choices.fault()
    if fault is not None:
        raise CallError(fault)
    return choices


def _on_terminal() -> bool:
    return sys.stdin.isatty() and sys.stdout.isatty()


def _ask(options: dict[str, Any]) -> dict[str, Any]:
    """Return the options of the call, with the user's answers for all missing choices."""
    answers = dict(options)
    if not answers["ros"]:
        answers["ros"] = click.prompt("ROS", type=click.Choice(["1", "2"]), default="2", err=True)
    for choice, question in _QUESTIONS.items():
        if not answers[choice]:
            default = getattr(Choices(""), choice)
            shown = " ".join(default) if isinstance(default, tuple) else default or _NONE
            answer = click.prompt(question, default=shown, err=True)
            answers[choice] = tuple(answer.split()) if choice == "sensors" else answer
    if not answers["twist"]:
        answers["twist"] = click.confirm("Are the commands velocities (geometry_msgs/Twist on /cmd_vel)?", err=True)
    return answers
