"""`argument`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.checks.rule import Finding, rule
from robosc.metamodel import expression as ex
from robosc.metamodel.reflection import tree
from robosc.semantics.cone_of_influence import accesses
from robosc.semantics.evaluation import evaluate
from robosc.semantics.operators import FUNCTIONS
from robosc.semantics.typing import INTEGER, type_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.metamodel import robosc as rsc


@rule("argument")
def arguments(base: rsc.Base) -> Iterator[Finding]:
    """A function gets as many arguments as it has parameters, and a positive constant to divide by."""
    for _, element in tree(base):
        if not isinstance(element, ex.FunctionCall):
            continue
        row, given = FUNCTIONS[element.function], list(element.arguments)
        names = [f"`{name}`" for name in "abcdef"[: row.parameters]]
        if len(given) != row.parameters:
            wanted = "argument" if row.parameters == 1 else "arguments"
            yield Finding(
                element,
                f"`{row.symbol}` has {row.parameters} {wanted}, found {len(given)}",
                f"write `{row.symbol}({', '.join(name.strip('`') for name in names)})`",
            )
            continue
        for position in sorted(row.divisors):
            if _is_no_divisor(given[position]):
                yield Finding(
                    given[position],
                    f"argument {position + 1} of `{row.symbol}` must be a positive constant",
                    "write an integer from 1 on, such as `10`",
                )


def _is_no_divisor(expression: ex.Expression) -> bool:
    """Whether an integer is read from somewhere, or below 1; what is no integer the rule `type` reports."""
    if type_of(expression) != INTEGER:
        return False
    return next(accesses(expression), None) is not None or evaluate(expression, lambda access: access) < 1  # type: ignore[operator]
