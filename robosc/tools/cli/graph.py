"""Command `robosc graph`, and the graph that other commands take."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from robosc.base.diagnostics.visible import visible
from robosc.base.files.writing import refuse, write_file
from robosc.tools.cli import CallError, put
from robosc.tools.cli.options import LIVE
from robosc.tools.cli.progress import progress

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.base.node_graph import NodeGraph


def node_graph(source: str) -> NodeGraph:
    """Return the graph in a file, or that of the running ROS 2 system. Raises ModelError, OSError and CallError."""
    if source != LIVE:
        from robosc.base.node_graph.reading import read

        return read(source)
    from robosc.run.runtime.core.node import StartError

    try:
        from robosc.run.runtime.ros2.node_graph import read_running

        with progress("reading the running ROS graph"):
            return read_running()
    except StartError as error:
        raise CallError(f"{error}\n  {error.hint}" if error.hint else str(error)) from error


def require_nodes(graph: NodeGraph, patterns: Sequence[str]) -> None:
    """Raise CallError for a pattern that names no node of a graph."""
    for pattern in patterns:
        if not graph.named([pattern]):
            names = ", ".join(visible(node.name) for node in graph.nodes)
            raise CallError(f"the graph has no node {visible(pattern)}; it has {names or 'no nodes'}")


@click.command("graph")
@click.option("-o", "--output", type=click.Path(dir_okay=False), help="Write to FILE.  [default: standard output]")
def command(output: str | None) -> None:
    """Write the nodes of the running ROS 2 system with their topics, services and actions, as JSON.

    `verify --guard` and `new --from-graph` read the file without ROS. The command waits until the graph has not changed
    for four seconds.

    \b
    Examples:
      robosc graph -o graph.json
      ROS_DOMAIN_ID=7 robosc graph | jq .nodes[].name

    Exit status: 0 success, 2 a wrong call, or no ROS 2.
    """
    if output:
        refuse(output)
    text = node_graph(LIVE).as_json()
    if output:
        write_file(output, text)
    else:
        put(text, nl=False)
