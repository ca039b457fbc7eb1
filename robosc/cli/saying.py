"""Everything that commands print."""

from __future__ import annotations

import click

from robosc.diagnostics.visible import visible_lines


def say(text: str = "", *, err: bool = False, nl: bool = True) -> None:
    """Prints text for people, on the standard error output if `err`: nothing in it steers the terminal."""
    click.echo(visible_lines(text), err=err, nl=nl)


def put(text: str, *, err: bool = False, nl: bool = True) -> None:
    """Prints text as it is: what a program reads, or what is visible already and painted."""
    click.echo(text, err=err, nl=nl)
