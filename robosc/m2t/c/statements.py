"""Guards and effects of an engine model as lines of C."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.m2t.c.expressions import around
from robosc.metamodel import engine
from robosc.metamodel import expression as ex
from robosc.semantics.operators import PRECEDENCE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.m2t.c.expressions import CPrinter

_INDENT = "    "


def guard_lines(guard: engine.Guard, printer: CPrinter) -> list[str]:
    """A guard, one part a line, with what synthesis added to the rest."""
    terms = list(guard.terms)
    if not terms:
        return ["true"]
    if len(terms) == 1 and isinstance(terms[0].condition, engine.Or):
        symbol, parts = printer.joined(terms[0].condition)
        marks = [""] * len(parts)
    else:
        symbol, marks = "&&", [_mark(term) for term in terms]
        least = PRECEDENCE[ex.Conjunction] + 1 if len(terms) > 1 else 0
        parts = [around(printer.written(term.condition), least) for term in terms]
    lines = [f"{part}{mark}" for part, mark in zip(parts, marks, strict=True)]
    return [lines[0], *(f"{symbol} {line}" for line in lines[1:])]


def _mark(term: engine.Term) -> str:
    if engine.Origin.synthesis not in term.origins:
        return ""
    partly = len(term.origins) > 1
    return f" /* {'partly ' if partly else ''}added by synthesis */"


def effect_lines(effect: engine.Effect, printer: CPrinter) -> list[str]:
    """The statements of an effect; those with values from before read them from `old`, a copy of the state."""
    return [line for step in effect.steps for line in _step(step, printer)]


def _step(step: engine.Step, printer: CPrinter) -> Sequence[str]:
    if isinstance(step, engine.Assignment):
        return [f"{printer.target(step.variable)} = {printer(step.value)};"]
    assert isinstance(step, engine.Switch)
    lines: list[str] = []
    for position, case in enumerate(step.cases):
        opening = "{" if case.condition is None else f"if ({printer(case.condition)}) {{"
        lines.append(f"}} else {opening}" if position else opening)
        lines += [f"{_INDENT}{line}" for assignment in case.assignments for line in _step(assignment, printer)]
    if len(step.cases) > 1 and step.cases[-1].condition is not None:
        lines += ["} else {", f"{_INDENT}/* Elsewhere nothing changes. */"]
    return [*lines, "}"]
