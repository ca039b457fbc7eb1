"""Options of commands that synthesize: the variable order and the strategy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from robosc.base.diagnostics import ModelError
from robosc.base.files import reading as files
from robosc.language.syntax_messages import closest
from robosc.language.text import decode
from robosc.synthesis import Strategy, Tuning
from robosc.synthesis.encoding import element_names
from robosc.tools.cli import CallError

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.model import sct
    from robosc.synthesis.encoding import Order

_ORDER, _STRATEGY = "robosc.order", "robosc.strategy"


def _keep(context: click.Context, parameter: click.Parameter, value: Any) -> None:
    context.meta[f"robosc.{parameter.name}"] = value


def tuning(command: Callable[..., None]) -> Callable[..., None]:
    """Add the options `--order` and `--strategy` to a command. `chosen_tuning` returns their values."""
    order = click.option(
        "--order",
        metavar="ORDER",
        default="automatic",
        show_default=True,
        expose_value=False,
        callback=_keep,
        help="The order of the decision diagrams: automatic, text, or a file with a name of an element on each line.",
    )
    strategy = click.option(
        "--strategy",
        type=click.Choice(["automatic", *map(str, Strategy)]),
        default="automatic",
        show_default=True,
        expose_value=False,
        callback=_keep,
        help="Search for good states among the reachable ones (forward), those reachable without a state from which a"
        " violation cannot be prevented (safe), or all (backward).",
    )
    return order(strategy(command))


def chosen_tuning(model: sct.SupervisoryControlModel, *, longest: int | None = None) -> Tuning:
    """Return the tuning in the call of the running command. `longest` is the limit of printed guards.

    Raises CallError with all lines of the file of the order that name no element of the model.
    """
    context = click.get_current_context(silent=True)
    meta = {} if context is None else context.meta
    order, strategy = meta.get(_ORDER, "automatic"), meta.get(_STRATEGY, "automatic")
    return Tuning(
        _order(order, model),
        None if strategy == "automatic" else Strategy(strategy),
        longest,
    )


def _order(chosen: str, model: sct.SupervisoryControlModel) -> Order:
    if chosen in {"automatic", "text"}:
        return chosen
    text, faults = decode(chosen, files.read(chosen))
    if faults:
        raise ModelError(faults)
    known = element_names(model)
    names, unknown = [], []
    for number, line in enumerate(text.content.splitlines(), 1):
        name = line.partition("#")[0].strip()
        if name in known:
            names.append(name)
        elif name:
            similar = closest(name, known, cutoff=0.6)
            hint = f"did you mean `{similar}`?" if similar else "`synthesize --explain-cost` prints all names"
            unknown.append(f"{chosen}:{number}:{line.index(name) + 1}: the model has no element `{name}`; {hint}")
    if unknown:
        raise CallError("\n".join(unknown))
    return tuple(dict.fromkeys(names))
