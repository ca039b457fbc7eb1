"""Requirements of the C engine on a model, beyond the rules for sct models."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.base.diagnostics import Diagnostic, Severity
from robosc.m2m.sct_to_engine import lowering
from robosc.model import expression as ex
from robosc.model.places import place
from robosc.model.reflection import contents
from robosc.model.semantics.domains import Width
from robosc.model.semantics.edges import edges_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.m2m.sct_to_engine.lower_expressions import Lowering
    from robosc.model import sct

RULE = "c-overflow"
_LOGICAL = (ex.Conjunction, ex.Disjunction, ex.Implication, ex.Negation)
_WIDEST = Width(64, signed=True).values


def preconditions(model: sct.SupervisoryControlModel) -> list[Diagnostic]:
    """Return an error for every computation whose intermediate values may exceed 64 bits."""
    lower = lowering(model)
    return [
        Diagnostic(
            *place(element),
            Severity.ERROR,
            RULE,
            f"this computation can overflow in C: {fault}",
            "use smaller ranges for its variables",
        )
        for element, expression in _expressions(model)
        for fault in _overflows(expression, lower)
    ]


def _expressions(model: sct.SupervisoryControlModel) -> Iterator[tuple[ex.Located, ex.Expression]]:
    """Return every expression that the engine computes, with the element to report it at."""
    for plant in model.plants:
        for edge in edges_of(plant):
            if edge.guard is not None:
                yield edge, edge.guard
            for update in edge.updates:
                yield update, update.value
    # The author can change a guard only through a requirement on its event.
    requirements = {requirement.event: requirement for requirement in reversed(model.requirements)}
    for guard in model.supervisor.guards if model.supervisor else ():
        for part in (guard.requirement, guard.synthesis):
            if part is not None:
                yield requirements.get(guard.event, guard.event), part


def _overflows(expression: ex.Expression, lower: Lowering) -> Iterator[str]:
    lower(expression)
    parts = [expression]
    for part in parts:
        parts += [child for _, child in contents(part)]
    # Operands before their operators, from left to right.
    for part in reversed(parts):
        if isinstance(part, _LOGICAL) or (
            isinstance(part, ex.UnaryMinus) and isinstance(part.operand, ex.IntegerLiteral)
        ):
            continue  # There is nothing to compute, or it is a literal number, including the lowest one.
        numbers = [lower(number) for _, number in [("", part), *contents(part)] if isinstance(number, ex.Expression)]
        if isinstance(part, ex.FunctionCall):
            numbers += lower(part).operands  # the operands of a remainder
        values = [term.values for term in numbers if term.sort is int]
        if len(numbers) > 1 and values:
            union = values[0]
            for interval in values[1:]:
                union = union.union(interval)
            if not _WIDEST.holds(union):
                yield f"a value between {union.low} and {union.high} does not fit into 64 bits"
