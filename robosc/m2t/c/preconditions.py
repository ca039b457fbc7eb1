"""What the engine in C asks of a model beyond what every sct model keeps."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.diagnostics import Diagnostic, Severity
from robosc.m2t.c.expressions import working_type
from robosc.m2t.c.nodes import Node, children_of, is_condition
from robosc.m2t.c.ranges import Ranges
from robosc.metamodel import expression as ex
from robosc.metamodel.places import place
from robosc.semantics.edges import edges_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.metamodel import sct

RULE = "c-overflow"


def preconditions(model: sct.SupervisoryControlModel) -> list[Diagnostic]:
    """An error for each computation whose intermediate values may not fit into 64 bits."""
    ranges = Ranges()
    return [
        Diagnostic(
            *place(element),
            Severity.ERROR,
            RULE,
            f"this computation can overflow in C: {fault}",
            "give its variables smaller ranges",
        )
        for element, expression in _expressions(model)
        for fault in _overflows(expression, ranges)
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
    requirements = {each.event: each for each in reversed(model.requirements)}
    for guard in model.supervisor.guards if model.supervisor else ():
        for part in (guard.requirement, guard.synthesis):
            if part is not None:
                yield requirements.get(guard.event, guard.event), part


def _overflows(expression: ex.Expression, ranges: Ranges) -> Iterator[str]:
    parts: list[Node] = []
    pending: list[Node] = [expression]
    while pending:
        parts.append(pending.pop())
        pending += children_of(parts[-1])
    # Operands before the operators on them, from left to right.
    for part in reversed(parts):
        if isinstance(part, ex.UnaryMinus) and isinstance(part.operand, ex.IntegerLiteral):
            continue  # a number, the least one too
        computes = isinstance(part, (ex.BinaryExpression, ex.UnaryExpression, ex.Conditional))
        if computes and not all(is_condition(child) for child in children_of(part)):
            assert isinstance(part, ex.Expression)
            try:
                working_type(part, ranges)
            except OverflowError as fault:
                yield str(fault)
