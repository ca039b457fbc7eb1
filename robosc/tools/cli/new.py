"""Command `robosc new`."""

from __future__ import annotations

import os
import sys
from functools import partial
from pathlib import Path
from typing import Any

import click

from robosc.base.diagnostics.visible import visible
from robosc.base.files.writing import write
from robosc.base.ros_types import RosTypes
from robosc.language.formatting import format_text
from robosc.language.text import Text
from robosc.tools.cli import CallError, say
from robosc.tools.cli.graph import node_graph, require_nodes
from robosc.tools.cli.options import GRAPH, LIVE, Paths, robot_nodes
from robosc.tools.cli.reading import read
from robosc.tools.cli.report import Report
from robosc.tools.starter import Choices, files
from robosc.tools.starter.guard import GuardChoices, suggestion
from robosc.tools.starter.guard import files as guard_files

#: Questions on a terminal, by the choice that they set.
_QUESTIONS = {
    "sensors": "Messages that allow or forbid driving (std_msgs/Bool)",
    "command": "Command to send while all of them allow it",
    "stop": "Command to send otherwise; `-` for none",
    "services": "Service to call first (std_srvs/Trigger); `-` for none",
}
#: Questions for a guard, by the choice that they set.
_GUARD_QUESTIONS = {
    "topics": "Topics to the robot (NAME:TYPE ...); `-` for none",
    "services": "Services of the robot (NAME:TYPE ...); `-` for none",
    "actions": "Actions of the robot (NAME:TYPE ...); `-` for none",
}
_POSE_QUESTION = "Topic of the localization without which no goal passes; `-` for none"
_COMMANDS = tuple(_GUARD_QUESTIONS)
#: Topic of a guard if neither the call nor a graph has a command.
_TOPIC = "/cmd_vel:geometry_msgs/Twist"
#: Options by their choices: those of a controller only, and those of a guard only.
_CONTROLLER_OPTIONS = {
    "ros": "--ros",
    "sensors": "--sensor",
    "command": "--command",
    "stop": "--stop",
    "twist": "--twist",
}
_GUARD_OPTIONS = {
    "topics": "--topic",
    "actions": "--action",
    "button": "--button",
    "pose": "--pose",
    "source": "--from-graph",
    "robot": "--robot",
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
@click.option(
    "--service",
    "services",
    multiple=True,
    metavar="SERVICE",
    help="Service to call first, until it succeeds. With --guard: a service of the robot as NAME:TYPE; repeatable.",
)
@click.option("--twist", is_flag=True, help="Send commands as velocities on /cmd_vel.")
@click.option("--guard", is_flag=True, help="Create a supervisory layer in front of a robot.")
@click.option("--topic", "topics", multiple=True, metavar="NAME:TYPE", help="Topic of the robot; repeatable.")
@click.option("--action", "actions", multiple=True, metavar="NAME:TYPE", help="Action of the robot; repeatable.")
@click.option(
    "--button", type=click.Choice(["periodic", "latched"]), help="Emergency stop of the guard.  [default: periodic]"
)
@click.option("--pose", metavar="TOPIC", help="Topic of the localization without which no goal passes; `-` for none.")
@click.option(
    "--from-graph",
    "source",
    is_flag=False,
    flag_value=LIVE,
    type=GRAPH,
    metavar="FILE|live",
    help="Read the commands of the robot from a ROS graph: the running one, or that of a JSON file (`robosc graph`).",
)
@robot_nodes
@click.option("-o", "--output", "folder", type=click.Path(), help="The new folder.  [default: the robot's name]")
@click.option("-y", "--yes", is_flag=True, help="Do not prompt; use the defaults.")
def command(name: str, folder: str | None, yes: bool, guard: bool, **options: Any) -> None:
    """Create a model of a robot: a folder with model, configuration, README.md and test.

    On a terminal, the command prompts for all choices that no option sets. The model passes `check`, `format --check`
    and `verify`. With `--guard`, the model is that of a layer that forwards only permitted commands to the robot.

    \b
    Examples:
      robosc new Porter
      robosc new Porter --sensor clear --sensor docked --twist --yes
      robosc new Lift --ros 1 --command raise --stop hold --service calibrate
      robosc new Porter --guard --topic /cmd_vel:geometry_msgs/Twist
      robosc new Porter --guard --from-graph graph.json --robot /base

    Exit status: 0 success, 2 a wrong call, such as a folder that is not empty.
    """
    _refuse_options(guard, options)
    asks = not yes and _on_terminal()
    if guard:
        choices: Choices | GuardChoices = _guard_choices(name, options, asks=asks)
    else:
        # Reject invalid names in the call before any prompt.
        _choices(name, options)
        choices = _choices(name, _ask(options) if asks else options)
    target = Path(folder or choices.stem)
    texts = create(choices, target)
    model = f"{choices.stem}.rscd"
    say(f"{visible(str(target))}: {', '.join(texts)}")
    if guard:
        with Report(aside=True) as report:
            read(str(target / model), Paths(), report)
    following = "check" if guard else "simulate"
    say(f"next: cd {visible(str(target))}; robosc {following} {model}")


def create(choices: Choices | GuardChoices, target: Path) -> list[str]:
    """Write the files of a new model to a folder, and return their names. Raises CallError if it is not empty."""
    if os.path.lexists(target) and (not target.is_dir() or any(target.iterdir())):
        raise CallError(f"{visible(str(target))} exists already and is not overwritten; choose another folder")
    texts = dict(guard_files(choices, RosTypes()) if isinstance(choices, GuardChoices) else files(choices))
    model = f"{choices.stem}.rscd"
    laid_out, _ = format_text(Text(model, texts[model]))
    assert laid_out is not None
    write({target: texts | {model: laid_out}})
    return list(texts)


def _refuse_options(guard: bool, options: dict[str, Any]) -> None:
    """Raise UsageError for options of the other kind of model."""
    others = _CONTROLLER_OPTIONS if guard else _GUARD_OPTIONS
    wrong = next((option for choice, option in others.items() if options[choice]), None)
    if wrong and guard:
        raise click.UsageError(f"{wrong} has no meaning with --guard")
    if wrong:
        raise click.UsageError(f"{wrong} needs --guard")
    if not guard and len(options["services"]) > 1:
        raise click.UsageError("--service is repeatable only with --guard")
    if options["robot"] and not options["source"]:
        raise click.UsageError("--robot needs --from-graph")


def _choices(name: str, options: dict[str, Any]) -> Choices:
    chosen_options = {key: options[key] for key in _CONTROLLER_OPTIONS if options.get(key)}
    if options.get("services"):
        chosen_options["service"] = options["services"][0]
    chosen_options |= {key: None for key in ("stop", "service") if chosen_options.get(key) == _NONE}
    choices = Choices(name, **{**chosen_options, "ros": int(chosen_options.get("ros", 2))})
    fault = choices.fault()
    if fault is not None:
        raise CallError(fault)
    return choices


def _guard_choices(name: str, options: dict[str, Any], *, asks: bool) -> GuardChoices:
    """Return the choices for a guard: those of the call, else of the graph, else of the user or the defaults."""
    chosen = {choice: options[choice] for choice in ("topics", "services", "actions", "pose", "button")}
    if options["source"]:
        with Report(aside=True) as report:
            if options["source"] != LIVE:
                report.may_quote(options["source"])
            graph = node_graph(options["source"])
        require_nodes(graph, options["robot"])
        suggested = suggestion(graph, options["robot"])
        chosen = {choice: value or getattr(suggested, choice, None) for choice, value in chosen.items()}
        for text in suggested.left_out:
            say(f"left out: {visible(text)}", err=True)
    elif not any(chosen[choice] for choice in _COMMANDS) and not asks:
        chosen["topics"] = (_TOPIC,)
    _check_guard(name, chosen)
    if asks:
        for choice, question in _GUARD_QUESTIONS.items():
            if not options[choice]:
                default = " ".join(chosen[choice] or ()) or (_TOPIC if choice == "topics" else _NONE)
                checked = partial(_checked_commands, name, choice)
                chosen[choice] = click.prompt(question, default=default, value_proc=checked, err=True)
        if not chosen["pose"] and chosen["actions"]:
            chosen["pose"] = click.prompt(_POSE_QUESTION, default=_NONE, err=True)
    choices = _check_guard(name, chosen)
    fault = choices.fault()
    if fault is not None:
        raise CallError(fault)
    return choices


def _checked_commands(name: str, choice: str, answer: str) -> tuple[str, ...]:
    """Return the commands of an answer. Raises UsageError for a fault, so that the prompt repeats."""
    commands = () if answer == _NONE else tuple(answer.split())
    chosen: dict[str, Any] = {choice: commands}
    fault = GuardChoices(name, **chosen).fault() if commands else None
    if fault is not None:
        raise click.UsageError(fault)
    return commands


def _check_guard(name: str, chosen: dict[str, Any]) -> GuardChoices:
    """Return the choices for a guard. Raises CallError for a fault, except that a command may be missing."""
    own = {choice: value for choice, value in chosen.items() if value and value != _NONE}
    choices = GuardChoices(name, **own)
    fault = choices.fault()
    if fault is not None and any(chosen[choice] for choice in _COMMANDS):
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
            default = getattr(Choices(""), choice.replace("services", "service"))
            shown = " ".join(default) if isinstance(default, tuple) else default or _NONE
            answer = click.prompt(question, default=shown, err=True)
            answers[choice] = tuple(answer.split()) if choice in ("sensors", "services") else answer
    if not answers["twist"]:
        answers["twist"] = click.confirm("Are the commands velocities (geometry_msgs/Twist on /cmd_vel)?", err=True)
    return answers
