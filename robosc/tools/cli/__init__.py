"""Command line: one module for each command, imported on its call."""

from __future__ import annotations

import gc
import os
import sys
import traceback
from contextlib import contextmanager
from difflib import get_close_matches
from importlib import import_module
from typing import TYPE_CHECKING, Any, NoReturn

import click

from robosc import __version__
from robosc.base.diagnostics.visible import visible, visible_lines
from robosc.base.files.reading import record_inputs
from robosc.base.files.resources import locate
from robosc.base.files.suffixes import MODELS
from robosc.tools.cli import interruption

if TYPE_CHECKING:
    from collections.abc import Iterator

#: Exit statuses other than 0.
ERRORS_FOUND = 1
WRONG_CALL = 2
EMPTY_SUPERVISOR = 3
INTERNAL_ERROR = 70
INTERRUPTED = 130

#: Commands and their summaries, by the heading in `robosc --help`.
_GROUPS = {
    "Write models": {
        "new": "Create a model of a robot.",
        "check": "Report errors and warnings in models.",
        "format": "Format models in the canonical layout.",
        "rule": "Explain a rule.",
        "diagram": "Draw a model or a metamodel.",
    },
    "Analyze": {
        "synthesize": "Synthesize the supervisor; print its states and guards.",
        "explain": "Explain why an event is forbidden.",
        "verify": "Prove the properties of the supervised robot.",
        "report": "Write a verification report for the person who signs off the robot.",
        "sweep": "Check, synthesize, verify or test many models and variants.",
    },
    "Simulate and test": {
        "simulate": "Simulate the supervised robot.",
        "view": "Show the decisions of a robot in a browser.",
        "test": "Run scenario tests.",
        "audit": "Judge a recorded run: forbidden commands, violated assumptions.",
    },
    "Generate and run": {
        "transform": "Generate code and models.",
        "run": "Run the controller as a ROS node, without building it.",
        "graph": "Write the nodes of the running ROS system as JSON.",
        "gate": "Let a language model or another program command a robot, behind its supervisor.",
        "interfaces": "Build ROS 2 types of your own, without colcon.",
    },
    "Editors": {
        "lsp": "Serve an editor: findings, completion, and more.",
        "dap": "Debug a robot in an editor.",
    },
    "Assistants": {
        "mcp": "Serve an assistant that writes models.",
    },
}
_COMMANDS = {name: summary for group in _GROUPS.values() for name, summary in group.items()}
#: Commands whose module has another name: the module `report` collects findings.
_MODULES = {"report": "safety_report"}


def say(text: str = "", *, err: bool = False, nl: bool = True) -> None:
    """Print text for people, to standard error if `err`. Escapes characters that control the terminal."""
    click.echo(visible_lines(text), err=err, nl=nl)


def put(text: str, *, err: bool = False, nl: bool = True) -> None:
    """Print text unchanged: output for programs, or text that is escaped and colored already."""
    click.echo(text, err=err, nl=nl)


class CallError(click.ClickException):
    """Error of a call that cannot be executed: a wrong file, a folder that is not writable."""

    exit_code = WRONG_CALL


class _InternalError(click.ClickException):
    exit_code = INTERNAL_ERROR


@contextmanager
def _visible_errors() -> Iterator[None]:
    """Escape characters that control the terminal in error messages, which may cite the call."""
    try:
        yield
    except click.ClickException as error:
        message = error.format_message()
        if visible_lines(message) == message:
            raise
        kind = _InternalError if isinstance(error, _InternalError) else CallError
        raise kind(visible_lines(message)) from error


class _Commands(click.Group):
    """The commands, each in a module of this package with its name, and their common behavior."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(_COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in _COMMANDS:
            return None
        command: click.Command = import_module(f"{__name__}.{_MODULES.get(cmd_name, cmd_name)}").command
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        if args and args[0] not in _COMMANDS and not args[0].startswith("-"):
            close = get_close_matches(args[0], _COMMANDS, n=1)
            meant = f"robosc check {args[0]}" if args[0].endswith(MODELS) else close[0] if close else ""
            hint = f" Did you mean '{meant}'?" if meant else ""
            raise click.UsageError(f"No such command '{args[0]}'.{hint}", ctx)
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        # Like click, but without loading the commands.
        width = max(map(len, _COMMANDS))
        for heading, group in _GROUPS.items():
            with formatter.section(heading):
                formatter.write_dl([(name.ljust(width), summary) for name, summary in group.items()])

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        with _visible_errors():
            return super().parse_args(ctx, args)

    def invoke(self, ctx: click.Context) -> Any:
        with _visible_errors():
            return self._invoked(ctx)

    def _invoked(self, ctx: click.Context) -> Any:
        for stream in (sys.stdout, sys.stderr):
            if hasattr(stream, "reconfigure"):
                # A missing character in the terminal's encoding, or an undecodable file name, must not cause an error.
                stream.reconfigure(errors="backslashreplace")
        try:
            with record_inputs():
                return super().invoke(ctx)
        except (click.ClickException, click.exceptions.Exit, click.Abort, BrokenPipeError):
            raise
        except KeyboardInterrupt:
            raise click.exceptions.Exit(INTERRUPTED) from None
        except Exception as error:
            if interruption.was_interrupted():
                raise click.exceptions.Exit(INTERRUPTED) from None
            raise as_call_error(error, show=ctx.params["traceback"]) from error


def as_call_error(error: Exception, *, show: bool = False) -> click.ClickException:
    """Return the error message for an exception that no command handles. With `show`, also print its traceback."""
    if isinstance(error, OSError):
        named = bool(error.filename)
        return CallError(f"{visible(str(error.filename))}: {error.strerror}" if named else str(error))
    if isinstance(error, MemoryError):
        return CallError(f"the model is too large: {str(error) or 'out of memory'}")
    if show:
        traceback.print_exc()
    hint = "" if show else "; `robosc --traceback ...` shows the place"
    return _InternalError(f"internal error of robosc, please report it: {type(error).__name__}: {error}{hint}")


def _cmake_dir(context: click.Context, _parameter: click.Parameter, is_requested: bool) -> None:
    if is_requested:
        put(str(locate("cmake")))
        context.exit()


_EPILOG = """`robosc COMMAND --help` describes a command. The documentation begins at docs/index.md in the repository.

Shell completion: add `eval "$(_ROBOSC_COMPLETE=bash_source robosc)"` to ~/.bashrc. docs/cli.md has the lines for zsh
and fish.
"""


@click.command(cls=_Commands, context_settings={"help_option_names": ["-h", "--help"]}, epilog=_EPILOG)
@click.version_option(__version__, prog_name="robosc")
@click.option(
    "--cmake-dir",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_cmake_dir,
    help="Print the folder of RoboSC's CMake packages, for CMAKE_PREFIX_PATH, and exit.",
)
@click.option("--traceback", is_flag=True, envvar="ROBOSC_TRACEBACK", help="Print the traceback of an internal error.")
def main(**_: Any) -> None:
    """Generate a ROS controller that provably does only what a model of the robot allows.

    \b
    Examples:
      robosc new Porter
      robosc check line_follower.rscd
      robosc transform line_follower.rscd --to ros2,cif
      robosc synthesize line_follower.rscd
      robosc verify line_follower.rscd
      robosc run line_follower.rscd --ros2
      robosc rule marked-state

    Exit status: 0 success, 1 errors in the model, 2 a wrong call, 3 an empty supervisor.
    """


def run() -> NoReturn:
    """Run the program `robosc`.

    Loaded objects live until the process ends. Collecting the objects of the metamodels and freeing them one by one
    would take a third of the time of a short run.
    """
    interruption.note()
    gc.set_threshold(500_000, 20, 20)
    sys.set_int_max_str_digits(0)  # the number of states of a robot may have many digits
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:  # closed by the caller, who does not need it
            setattr(sys, name, open(os.devnull, mode, encoding="utf-8"))  # noqa: PTH123, SIM115
    status = ERRORS_FOUND
    try:
        try:
            main(prog_name="robosc")
        except SystemExit as end:
            status = end.code if isinstance(end.code, int) else 0
        if not sys.stdout.closed:  # a server closes it when its editor ends
            sys.stdout.flush()
    except KeyboardInterrupt:
        pass  # reported below
    except BrokenPipeError:
        pass  # the reader needs no more output
    except OSError as error:
        status = WRONG_CALL
        say(f"Error: cannot write the output: {error.strerror}", err=True)
    os._exit(INTERRUPTED if interruption.was_interrupted() else status)
