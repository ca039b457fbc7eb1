"""`robosc diagram`."""

from __future__ import annotations

from pathlib import Path

import click

from robosc.cli import CallError
from robosc.diagrams import METAMODELS, NOTATIONS, metamodel_diagram
from robosc.output import OutputError, write


@click.command("diagram")
@click.option("--metamodel", "name", required=True, type=click.Choice(METAMODELS), help="What is drawn.")
@click.option(
    "--format", "notation", type=click.Choice(NOTATIONS), default="mermaid", show_default=True, help="How it is drawn."
)
@click.option("-o", "--output", type=click.Path(dir_okay=False), help="The file to write, instead of printing it.")
def command(name: str, notation: str, output: str | None) -> None:
    """Draw the class diagram of a metamodel.

    \b
    Examples:
      robosc diagram --metamodel sct
      robosc diagram --metamodel robosc --format svg -o robosc.svg
    """
    text = metamodel_diagram(name, notation)
    if output is None:
        click.echo(text, nl=False)
        return
    path = Path(output)
    try:
        write({path.parent: {path.name: text}})
    except OutputError as error:
        raise CallError(str(error)) from error
