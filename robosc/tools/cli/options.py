"""Options and arguments that several commands share."""

from __future__ import annotations

import os
from contextlib import suppress
from dataclasses import dataclass
from difflib import get_close_matches
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from robosc.base.extensions import extensions

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from robosc.base.extensions import Extension


class _File(click.Path):
    """An existing file. If it does not exist, the error suggests a similar name in its folder."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        try:
            return super().convert(value, param, ctx)
        except click.BadParameter as error:
            path = Path(os.fsdecode(value))
            names: list[str] = []
            with suppress(OSError):
                names = sorted(other.name for other in path.parent.iterdir())
            close = get_close_matches(path.name, names, n=1)
            if close and path.name not in names:
                self.fail(f"{error.message} Did you mean '{path.with_name(close[0])}'?", param, ctx)
            raise


#: An existing file.
FILE = _File(exists=True, dir_okay=False, readable=True)

#: Value of options for a node graph: the running one.
LIVE = "live"


class _GraphSource(_File):
    """An existing file with a node graph, or `live`."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        return value if value == LIVE else super().convert(value, param, ctx)


#: An existing file with a node graph, or `live`.
GRAPH = _GraphSource(exists=True, dir_okay=False, readable=True)

#: Names of the nodes that are the robot, for commands with a graph.
robot_nodes = click.option(
    "--robot", "robot", multiple=True, metavar="NODE", help="Node of the robot, with `*` for any text; repeatable."
)

model = click.argument("model", type=FILE)

_library_path = click.option(
    "-I",
    "--library-path",
    "library_paths",
    multiple=True,
    type=click.Path(exists=True, file_okay=False),
    help="Search this folder for libraries, after the model's folder and before ROBOSC_PATH; repeatable.",
)

_interface_path = click.option(
    "--interface-path",
    "interface_paths",
    multiple=True,
    type=click.Path(exists=True, file_okay=False),
    help="Search the ROS packages below this folder for .msg, .srv and .action files, before"
    " ROBOSC_INTERFACE_PATH; repeatable.",
)

configuration = click.option(
    "--config", "chosen", type=FILE, help="The configuration file.  [default: controller-config.json near the model]"
)

findings_format = click.option(
    "--format",
    "form",
    type=click.Choice(["text", "json", "sarif"]),
    default="text",
    show_default=True,
    help="The format of findings.",
)

memory = click.option(
    "--memory",
    "megabytes",
    type=click.IntRange(min=1),
    metavar="MB",
    default=4096,
    show_default=True,
    help="The memory limit for synthesis and generation, in megabytes of 2^20 bytes.",
)


#: Option of commands whose parts can run in processes. Call `require_own_synthesis` with its value.
jobs = click.option(
    "--jobs",
    type=click.IntRange(min=1),
    default=1,
    show_default=True,
    metavar="N",
    help="Use N processes. The output is the same.",
)


def require_own_synthesis(jobs: int) -> None:
    """Raise UsageError if processes, which synthesize themselves, would not use the synthesizer in the call."""
    if jobs > 1 and chosen_synthesizer() is not None:
        raise click.UsageError("--jobs needs RoboSC's own synthesis: remove it or --synthesizer")


def over_ros(text: str) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Return a decorator that adds the flag `--ros2` to a command, which receives it as `live`. `text` is its help."""
    return click.option("--ros2", "live", is_flag=True, help=text)


_SYNTHESIZER = "robosc.synthesizer"


def _keep(context: click.Context, _parameter: click.Parameter, name: str | None) -> None:
    if name is not None:
        known = extensions("robosc.synthesizers")
        if name not in known:
            others = ", ".join(known) or "none"
            raise click.BadParameter(f"{name!r} is not an installed synthesizer; installed: {others}")
        context.meta[_SYNTHESIZER] = known[name]


#: Option of commands that synthesize. `chosen_synthesizer` returns its value.
synthesizer = click.option(
    "--synthesizer",
    metavar="NAME",
    expose_value=False,
    callback=_keep,
    help="Use the synthesizer NAME of an installed package (entry point robosc.synthesizers).",
)


def chosen_synthesizer() -> Extension | None:
    """Return the synthesizer in the call of the running command, if any."""
    context = click.get_current_context(silent=True)
    chosen: Extension | None = None if context is None else context.meta.get(_SYNTHESIZER)
    return chosen


@dataclass(frozen=True)
class Paths:
    """Folders with the libraries and the ROS types of a model."""

    libraries: Sequence[str] = ()
    interfaces: Sequence[str] = ()


def paths(command: Callable[..., None]) -> Callable[..., None]:
    """Add the options for search folders to a command, which receives them as `paths`."""

    @_library_path
    @_interface_path
    @wraps(command)
    def with_paths(*, library_paths: Sequence[str], interface_paths: Sequence[str], **options: Any) -> None:
        command(paths=Paths(library_paths, interface_paths), **options)

    return with_paths
