"""A requirement holds: wherever its event happens, its condition allows it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.analysis.supervision.wording import words
from robosc.analysis.verification.system import counted, happening
from robosc.analysis.verification.verdict import Outcome, Verdict
from robosc.diagnostics import Span
from robosc.metamodel import expression as ex
from robosc.metamodel import sct
from robosc.semantics.printing import RobotPrinter, copied
from robosc.semantics.roles import event_name
from robosc.synthesis.encoding import referenced

if TYPE_CHECKING:
    from robosc.analysis.verification.system import SupervisedSystem


def requirement_name(requirement: sct.Requirement) -> str:
    """The requirement in the robot model's words, and its line there."""
    span = Span.parse(requirement.source)
    said = requirement.text or f"requirement on {event_name(requirement.event)}"
    return f"{said} (line {span.line})" if span else said


def _asked(requirement: sct.Requirement) -> str:
    """What has to hold where the event happens, as the model has it."""
    condition = copied(requirement.condition)
    wanted = requirement.kind == sct.RequirementKind.needs
    return RobotPrinter()(condition if wanted else ex.Negation(operand=condition))


def requirement_holds(system: SupervisedSystem, requirement: sct.Requirement) -> Verdict:
    """The supervisor lets the event happen in no reachable state in which the requirement forbids it.

    The evidence shows what was proved: the condition of the model, which was made of the author's words.
    """
    relation = next(each for each in system.relations if each.event is requirement.event)
    happens = system.reachable & system.allowed[relation]
    broken = happens & ~relation.asked[requirement]
    states = counted(system.encoding.count(happens), "state")
    evidence, said = f"happens in {states}, asks for `{_asked(requirement)}`", requirement_name(requirement)
    if not broken.satisfiable():
        return Verdict(said, Outcome.PROVED, evidence)
    path = system.path_to(broken)
    where = system.where(path.states[-1], referenced(requirement.condition))
    explanation = f"{words(requirement.event)} can happen" + (f" where `{where}`" if where else "")
    return Verdict(said, Outcome.REFUTED, evidence, explanation, (*system.trace(path), happening(relation)))
