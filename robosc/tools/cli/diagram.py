"""Command `robosc diagram`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from robosc.base.files.writing import refuse, write_file
from robosc.model import robosc as rsc
from robosc.tools.cli import CallError, interruption, put
from robosc.tools.cli.options import FILE, Paths, paths
from robosc.tools.cli.reading import read, read_models
from robosc.tools.cli.report import Report
from robosc.tools.diagrams import (
    GRAPH_NOTATIONS,
    METAMODELS,
    NOTATIONS,
    behaviour_graph,
    diagram,
    metamodel_diagram,
    plants_graph,
    ros_graph,
)

if TYPE_CHECKING:
    from robosc.tools.diagrams.graph import Graph

_KINDS = ("behaviour", "ros-graph", "plants")


@click.command("diagram")
@click.argument("model", type=FILE, required=False)
@click.option("--kind", type=click.Choice(_KINDS), help="The part of MODEL to draw.  [default: behaviour]")
@click.option("--metamodel", "name", type=click.Choice(METAMODELS), help="Draw a metamodel instead.")
@click.option(
    "--format",
    "notation",
    type=click.Choice(tuple(dict.fromkeys([*GRAPH_NOTATIONS, *NOTATIONS]))),
    default="mermaid",
    show_default=True,
    help="The output format; dot only for models, plantuml only for metamodels.",
)
@click.option(
    "-o",
    "--output",
    type=click.Path(dir_okay=False),
    help="Write the diagram to this file instead of the standard output.",
)
@paths
def command(
    model: str | None,
    kind: str | None,
    name: str | None,
    notation: str,
    output: str | None,
    paths: Paths,
) -> None:
    """Draw a model, or a metamodel.

    MODEL is a .rscd file, or an .xmi file written by `transform --to xmi`. `behaviour` shows the automata of the
    components in the text, `ros-graph` the controller's node with its topics, services and actions, `plants` the input
    of synthesis.

    \b
    Examples:
      robosc diagram line_follower.rscd
      robosc diagram line_follower.rscd --kind ros-graph --format svg -o line_follower.svg
      robosc diagram line_follower.rscd --kind plants --format dot | dot -Tpdf -o plants.pdf
      robosc diagram --metamodel sct --format svg -o sct.svg

    Exit status: 0 success, 1 errors in the model, 2 a wrong call.
    """
    if model is None and name is None and kind is None:
        raise CallError("give a MODEL or --metamodel NAME")
    if (model is None) == (name is None) or (model is None and kind is not None):
        raise CallError("give either a MODEL, with or without --kind, or a --metamodel")
    allowed = tuple(GRAPH_NOTATIONS) if model else NOTATIONS
    if notation not in allowed:
        raise CallError(f"a {'' if model else 'meta'}model is drawn in {', '.join(allowed)}, not in {notation}")
    if output is not None:
        refuse(output)
    if model is None:
        assert name is not None
        text = metamodel_diagram(name, notation)
    else:
        with Report(aside=True) as report:
            text = diagram(_graph(model, kind or "behaviour", paths, report), notation)
    if output is None:
        put(text, nl=False)
        return
    interruption.check()
    write_file(output, text)


def _graph(path: str, kind: str, paths: Paths, report: Report) -> Graph:
    """Return the graph of a kind for the model in a file. Ends the report if there are errors."""
    if kind == "behaviour":
        base = read(path, paths, report)
        report.stop_on_errors()
        if not isinstance(base, rsc.Base):
            raise CallError(f"{path} has no components: use --kind plants")
        return behaviour_graph(base)
    models = read_models(path, paths, report, cif=True)
    if kind == "plants":
        return plants_graph(models.sct)
    if models.rosgraph is None:
        raise CallError(f"{path} has no ROS graph: use --kind plants")
    return ros_graph(models.rosgraph)
