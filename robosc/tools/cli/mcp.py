"""Command `robosc mcp`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from robosc.tools.cli import CallError
from robosc.tools.cli.options import Paths, memory, paths

if TYPE_CHECKING:
    from collections.abc import Sequence


@click.command("mcp")
@click.argument("folders", type=click.Path(exists=True, file_okay=False), nargs=-1, required=True, metavar="FOLDER...")
@click.option(
    "--seconds",
    type=click.FloatRange(min=1),
    default=120,
    show_default=True,
    metavar="SECONDS",
    help="The time limit of a call.",
)
@memory
@paths
def command(folders: Sequence[str], seconds: float, megabytes: int, paths: Paths) -> None:
    """Serve an assistant with the Model Context Protocol, over standard input and output.

    The assistant's program starts this command. docs/mcp.md describes the setup. The tools read and write files below
    the FOLDERs only, and use no network. The command needs an extra package: pip install 'robosc[mcp]'.

    \b
    Examples:
      robosc mcp .
      robosc mcp robots libraries --seconds 600
    """
    try:
        from robosc.tools.mcp.server import Settings, create
        from robosc.tools.mcp.stdio import serve
    except ModuleNotFoundError as error:
        missing = (error.name or "").partition(".")[0]
        if missing == "robosc":
            raise
        raise CallError(f"{missing} is not installed: run pip install 'robosc[mcp]'") from error
    roots = [str(Path(folder).resolve()) for folder in folders]
    serve(create(Settings(roots, paths.libraries, paths.interfaces, megabytes << 20), seconds))
