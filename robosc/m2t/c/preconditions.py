"""What the engine in C asks of a model beyond what every sct model keeps."""

from __future__ import annotations

from functools import reduce
from typing import TYPE_CHECKING

from robosc.diagnostics import Diagnostic, Severity
from robosc.m2m.sct_to_engine import lowering
from robosc.metamodel.places import place
from robosc.semantics.domains import Interval, Width
from robosc.semantics.edges import edges_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.m2m.sct_to_engine.lower_expressions import Lowering
    from robosc.metamodel import expression as ex
    from robosc.metamodel import sct

RULE = "c-overflow"
_WIDEST = Width(64, signed=True).values


def preconditions(model: sct.SupervisoryControlModel) -> list[Diagnostic]:
    """An error for every computation whose intermediate values may not fit into 64 bits."""
    lower = lowering(model)
    return [
        Diagnostic(
            *place(element),
            Severity.ERROR,
            RULE,
            f"this computation can overflow in C: {fault}",
            "give its variables smaller ranges",
        )
        for element, expression in _expressions(model)
        for fault in _overflows(expression, lower)
    ]


def _expressions(model: sct.SupervisoryControlModel) -> Iterator[tuple[ex.Located, ex.Expression]]:
    """Every expression that the engine computes, with what it stands in."""
    for plant in model.plants:
        for edge in edges_of(plant):
            if edge.guard is not None:
                yield edge, edge.guard
            for update in edge.updates:
                yield update, update.value
    # What the author can change about a guard is a requirement on its event.
    requirements = {requirement.event: requirement for requirement in reversed(model.requirements)}
    for guard in model.supervisor.guards if model.supervisor else ():
        for part in (guard.requirement, guard.synthesis):
            if part is not None:
                yield requirements.get(guard.event, guard.event), part


def _overflows(expression: ex.Expression, lower: Lowering) -> Iterator[str]:
    """What is wrong with each operator, operands before those on them, from left to right."""
    for term in lower(expression).below():
        values = [number.values for number in (term, *term.operands) if number.sort is int]
        if term.operands and values:
            union = reduce(Interval.union, values)
            if not _WIDEST.holds(union):
                yield f"a value between {union.low} and {union.high} does not fit into 64 bits"
