"""Command `robosc rule`."""

from __future__ import annotations

import sys
from difflib import get_close_matches

import click
from rich.console import Console
from rich.markdown import Markdown

from robosc.base.diagnostics.rules import page, rules
from robosc.tools.cli import put


@click.command("rule")
@click.argument("rule", required=False)
def command(rule: str | None) -> None:
    """Explain a RULE, with a wrong and a right model. Without a RULE, list the names of all rules.

    \b
    Examples:
      robosc rule marked-state
      robosc rule
    """
    if rule is None:
        put("\n".join(rules()))
        return
    text = page(rule)
    if text is None:
        close = get_close_matches(rule, rules(), n=1)
        hint = f"did you mean {close[0]!r}?" if close else "`robosc rule` lists all rules."
        raise click.BadParameter(f"there is no rule {rule!r}; {hint}", param_hint="RULE")
    if sys.stdout.isatty():
        Console().print(Markdown(text))
    else:
        put(text, nl=False)
