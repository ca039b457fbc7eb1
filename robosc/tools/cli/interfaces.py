"""Command `robosc interfaces`."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from robosc.tools.cli import CallError, put, say
from robosc.tools.cli.progress import progress

if TYPE_CHECKING:
    from collections.abc import Sequence


@click.group("interfaces")
def command() -> None:
    """Build messages, services and actions of your own.

    \b
    Examples:
      robosc interfaces build my_msgs
      robosc interfaces build --help

    Exit status: 0 success, 2 a wrong call, or packages that cannot be built.
    """


@command.command("build")
@click.argument("folders", nargs=-1, required=True, metavar="FOLDER...", type=click.Path(exists=True, file_okay=False))
@click.option(
    "-o",
    "--output",
    type=click.Path(file_okay=False),
    default="build/interfaces",
    show_default=True,
    help="The output folder for the modules. Add it to PYTHONPATH.",
)
def build(folders: Sequence[str], output: str) -> None:
    """Build the Python modules of all interface packages below FOLDER for the wheels of ROS 2, without colcon.

    This needs a Python with the wheels (pip install 'robosc[ros2]'), and compilers of C and C++. A package may use
    types of installed packages, and of the other packages in the same call.

    \b
    Examples:
      robosc interfaces build my_msgs
      robosc interfaces build ~/ros2_ws/src -o ~/ros2_modules
      PYTHONPATH=~/ros2_modules robosc run my_robot.rscd --ros2

    Exit status: 0 success, 2 a wrong call, or packages that cannot be built.
    """
    try:
        from robosc.run.runtime.ros2 import interfaces
    except ImportError as error:
        python = f"this Python ({sys.executable}) has no {error.name}"
        hint = "pip install 'robosc[ros2]' installs the wheels of ROS 2; then call robosc in that environment"
        raise CallError(f"{python}\n  {hint}") from error
    out = Path(output).resolve()
    try:
        with progress("building interfaces"):
            built = interfaces.build([Path(folder) for folder in folders], out)
    except interfaces.BuildError as error:
        raise CallError(str(error)) from error
    put("\n".join(built))
    say(f"{output}: {len(built)} {'package' if len(built) == 1 else 'packages'}; export PYTHONPATH={out}", err=True)
