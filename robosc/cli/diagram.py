"""`robosc diagram`."""

import click


@click.command("diagram", short_help="Draw a metamodel.")
def command() -> None:
    """Draw."""
