"""Command `robosc lsp`."""

from __future__ import annotations

import click

from robosc import __version__
from robosc.tools.cli import CallError
from robosc.tools.cli.options import Paths, paths


@click.command("lsp")
@click.option(
    "--port",
    type=click.IntRange(0, 65535),
    metavar="PORT",
    help="Listen on this TCP port (0: a free port, which is printed) instead of the standard input and output.",
)
@paths
def command(port: int | None, paths: Paths) -> None:
    """Serve an editor with the Language Server Protocol, over standard input and output.

    The editor starts this command. docs/editor.md describes the setup of Neovim, Helix and Emacs. It needs extra
    packages: pip install 'robosc[editor]'.

    \b
    Examples:
      robosc lsp
      robosc lsp -I libraries --port 2087
    """
    try:
        from robosc.tools.editor.server import Server, serve
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] not in {"pygls", "lsprotocol", "attrs", "cattrs"}:
            raise
        raise CallError(f"{error.name} is not installed: run pip install 'robosc[editor]'") from error
    serve(Server(__version__, paths.libraries, paths.interfaces), port)
