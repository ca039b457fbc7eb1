"""Guards of the supervisor for each controllable event, as readable expressions."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.printing import conjunction
from robosc.model.semantics.walks import copy_tree
from robosc.synthesis.cover import separating_expression
from robosc.synthesis.encoding import referenced_elements
from robosc.synthesis.simplification import simplify

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Domain, Encoding
    from robosc.synthesis.projection import Projection
    from robosc.synthesis.relation import EventRelation


@dataclass(frozen=True)
class Permission:
    """Controlled states in which a controllable event is allowed, and its guard.

    A controlled state allows the event exactly if it is in `where`; `where` may contain other states, too. If `where`
    is satisfiable, some controlled state allows the event. The same is true of a conjunction of `where` and a condition
    on the elements that the event touches. If `unwritten`, the guard is too long and lacks the condition
    that synthesis added.
    """

    relation: EventRelation
    guard: sct.EventGuard
    controlled: Diagram
    where: Diagram
    unwritten: bool = False

    @cached_property
    def held_back(self) -> Diagram:
        """Controlled states in which only synthesis forbids the event, or some of its data."""
        relation, step = self.relation, self.relation.step
        if relation.has_data and step is not None:
            return self.controlled & step.preimage(~self.controlled)
        return self.controlled & (relation.enabled & relation.requirement & ~self.where)

    @cached_property
    def allowed(self) -> Diagram:
        """Controlled states in which the event is allowed."""
        return self.controlled & self.where


def permission(
    relation: EventRelation, controlled: Projection, encoding: Encoding, *, restricts: bool, longest: int | None = None
) -> Permission:
    """Return the guard of a controllable event over the states that are reachable under the supervisor.

    `restricts`: whether synthesis removed any state. If not, it added nothing to any event. `longest` is the
    maximum length of the condition that synthesis adds.

    In each of these states, the plants enable the event and both parts of the guard hold exactly if the requirements
    hold and the event leads to such a state again. The guard of a command with inputs reads them. `someRequired` and
    `someData` hold where both parts allow some inputs.
    """
    step = relation.step if restricts else None
    states, domains = controlled.factor(relation.concerned)
    if step is None:
        states = controlled.onto(relation.concerned)
    enabled = states & (relation.happens if relation.has_data else relation.enabled)
    required = enabled & relation.permitted
    allowed = required
    if step is not None:
        allowed = required & (relation.leading_to(states) if relation.has_data else step.preimage(states))
    guard = sct.EventGuard(event=relation.event, everEnabled=allowed.satisfiable())
    if enabled != required:
        condition = conjunction(_condition(requirement) for requirement in relation.requirements)
        assert condition is not None
        # Only the elements that the requirements read matter: without the others, the diagrams are small.
        referenced = set(referenced_elements(condition))
        others = (domain for domain in domains if domain.element not in referenced)
        mattering = enabled.exists(encoding.diagrams.cube(level for domain in others for level in domain.levels))
        guard.requirement = simplify(condition, mattering, encoding)
        guard.requirements.extend(
            requirement
            for requirement in relation.requirements
            if (mattering & ~relation.condition_of(requirement)).satisfiable()
        )
    where = allowed
    if relation.has_data:
        available = states & relation.available
        permitted, where = relation.allowed_by(required), relation.allowed_by(allowed)
        guard.someRequired = _separated(encoding, permitted, available & ~permitted, domains)
        guard.someData = _separated(encoding, where, permitted & ~where, domains)
    domains = [*domains, *(encoding.layout.domains[carried] for carried in relation.event.inputs)]
    if allowed != required:
        guard.synthesis = (
            separating_expression(encoding, allowed, required & ~allowed, domains, longest)
            if guard.everEnabled
            else ex.BooleanLiteral(value=False)
        )
    encoding.diagrams.tidy()
    return Permission(
        relation, guard, controlled.states, where, unwritten=allowed != required and guard.synthesis is None
    )


def _separated(
    encoding: Encoding, inside: Diagram, outside: Diagram, domains: Sequence[Domain]
) -> ex.Expression | None:
    """Return a condition that holds in all states of `inside` and in none of `outside`; None if that is always so."""
    if not outside.satisfiable():
        return None
    return (
        separating_expression(encoding, inside, outside, domains)
        if inside.satisfiable()
        else ex.BooleanLiteral(value=False)
    )


def _condition(requirement: sct.Requirement) -> ex.Expression:
    """Return a copy of the condition that must hold for the event."""
    condition = copy_tree(requirement.condition)
    if requirement.kind == sct.RequirementKind.needs:
        return condition
    return condition.operand if isinstance(condition, ex.Negation) else ex.Negation(operand=condition)
