"""Rule `unknown-end`: after some errors, the service or action may still be running."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING, Any, NamedTuple

from robosc.base.diagnostics import Severity
from robosc.language.checks.commands import Places, command_conditions
from robosc.language.checks.definitions import assigned_variable
from robosc.language.checks.libraries import instances
from robosc.language.checks.rule import Finding, rule
from robosc.model import expression as ex
from robosc.model import robosc as rsc
from robosc.model.semantics.cone_of_influence import accesses, guard_of
from robosc.model.semantics.evaluation import evaluate
from robosc.model.semantics.failures import STILL_RUNNING, reasons
from robosc.model.semantics.naming import enumeration, escape_keyword
from robosc.model.semantics.operators import UnreadableError, operator_of
from robosc.model.semantics.printing import RoboscPrinter
from robosc.model.semantics.walks import fold, operands

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from robosc.language.checks.commands import CommandCondition
    from robosc.model.semantics.evaluation import Value
    from robosc.model.semantics.instances import Instance, Instances, PortInstance

#: Maximum number of unknown parts of a condition. A larger condition counts as one that can become true.
_MOST = 10
#: Maximum number of situations that silent transitions are followed to.
_MOST_SITUATIONS = 200
_CONNECTIVES = (ex.Conjunction, ex.Disjunction, ex.Implication, ex.Negation)


class _UnknownError(Exception):
    """Expression with an unknown value."""


@rule("unknown-end", Severity.WARNING)
def unknown_end(base: rsc.Base) -> Iterator[Finding]:
    """No requirement on another command treats an error as an end too early.

    After the error, the call or goal may still be running.
    """
    if not isinstance(base, rsc.Robot):
        return
    known = instances(base)
    conditions = [(condition, _owners(condition, known)) for condition in command_conditions(known)]
    places = Places(base)
    for instance in known if conditions else ():
        for transition, _ in instance.transitions:
            port = _failing(transition, instance, known)
            if port is None or not isinstance(transition, rsc.ResultTransition):
                continue
            # A transition of a component changes only conditions that read the component.
            others = [
                condition for condition, owners in conditions if condition.restricted - {port} and instance in owners
            ]
            for state, left in _reasons_left(transition, instance, port, known).items():
                misled = {
                    reason: (other, after.state)
                    for reason in left
                    for other in others
                    for after in _misleading(transition, _Situation(known, instance, state, reason), other)
                }
                place = places.new(transition, instance, port.communication) if misled else None
                if place is not None:
                    yield _finding(place, transition, instance, misled, port)


def _owners(condition: CommandCondition, known: Instances) -> set[Instance | None]:
    """Return the instances whose states, variables or calls a condition reads."""
    expression = known.expanded(condition.condition, condition.within)
    return {known.instance_of(access, condition.within) for access in accesses(expression)}


def _finding(
    place: ex.Located,
    transition: rsc.ResultTransition,
    instance: Instance,
    misled: Mapping[str, tuple[CommandCondition, rsc.State]],
    port: PortInstance,
) -> Finding:
    """Return the finding about a transition that misleads a condition.

    `misled` maps each reason of the error to the condition and to the state in which the component then rests.
    """
    name = escape_keyword(port.communication.name)
    whether = " or ".join(f"error = {reason}" for reason in misled)
    condition, state = next(iter(misled.values()))
    items = {access.item for access in accesses(condition.condition)}
    variables = [assigned_variable(assignment) for assignment in transition.assignments]
    variable = next((variable for variable in variables if variable is not None and variable in items), None)
    target = transition.target
    if variable is not None or target is None:
        does = f"assigns `{variable.name}`" if variable is not None else "assigns a variable"
    else:
        onwards = "" if state is target else f" and from there to `{instance.name}.{state.name}`"
        does = f"leads to `{instance.name}.{target.name}`{onwards}"
    return Finding(
        place,
        f"`error from {name}` {does}, which a requirement on another command reads: with the reason"
        f" {enumeration([f'`{reason}`' for reason in misled])} `{name}` may still be running",
        f"write `on error from {name} if {whether} goto …` before it, to a state in which the requirement does not"
        " hold",
        related=condition.requirement,
    )


def _failing(transition: rsc.Transition, instance: Instance, known: Instances) -> PortInstance | None:
    """Return the service or action of an error transition; None for other events."""
    if not isinstance(transition, rsc.ResultTransition) or transition.resultType != rsc.ResultType.error:
        return None
    port = known.port(transition.communicationType, instance)
    return port if port is not None and reasons(port.communication) else None


def _reasons_left(
    transition: rsc.ResultTransition, instance: Instance, port: PortInstance, known: Instances
) -> dict[rsc.State, list[str]]:
    """Return, by state, the reasons of an error that may take a transition while the call or goal still runs.

    States without such a reason are left out.
    """
    within = transition.eContainer()
    common = [other for other, where in instance.transitions if where is None]
    reasons_by_state: dict[rsc.State, list[str]] = {}
    for state in [within] if isinstance(within, rsc.State) else instance.states:
        tried = [other for other in [*state.transitions, *common] if _failing(other, instance, known) == port]
        for reason in STILL_RUNNING[type(port.communication)] if transition in tried else ():
            here = _Situation(known, instance, state, reason)
            earlier = tried[: tried.index(transition)]
            taken = any(here.holds(guard_of(other)) is True and not _may_be_unreadable(other) for other in earlier)
            if not taken and here.holds(transition.guard) is not False:
                reasons_by_state.setdefault(state, []).append(reason)
    return reasons_by_state


def _may_be_unreadable(transition: rsc.Transition) -> bool:
    """Return whether the guard of a transition reads an array element: the guard is false if it is missing."""
    return any(
        isinstance(segment, rsc.IndexSegment)
        for access in accesses(guard_of(transition))
        for segment in access.segments
    )


def _misleading(
    transition: rsc.ResultTransition, before: _Situation, condition: CommandCondition
) -> Iterator[_Situation]:
    """Yield situations after a transition, and silent ones after it, in which a condition has become true."""
    port = before.known.port(transition.communicationType, before.instance)
    return (after for after in _at_rest(_taken(transition, before), port) if _makes_true(condition, before, after))


def _taken(transition: rsc.Transition, before: _Situation) -> _Situation:
    """Return the situation after a transition."""
    assigned = dict(before.variables)
    for assignment in transition.assignments:
        variable = assigned_variable(assignment)
        if variable is not None:
            value = before.known.expanded(assignment.value, before.instance)
            assigned[variable] = before.value(value, before.instance)
    return before._replace(state=transition.target or before.state, reason=None, variables=assigned)


def _at_rest(first: _Situation, ended: PortInstance | None) -> list[_Situation]:
    """Return a situation and those that silent transitions certainly lead to."""
    common = [transition for transition, where in first.instance.transitions if where is None]
    reached = [first]
    for situation in reached:
        for transition in [*situation.state.transitions, *common]:
            if isinstance(transition, rsc.TauTransition) and situation._replace(ended=ended).holds(transition.guard):
                after = _taken(transition, situation)
                if after not in reached and len(reached) < _MOST_SITUATIONS:
                    reached.append(after)
    return reached


def _makes_true(condition: CommandCondition, before: _Situation, after: _Situation) -> bool:
    """Return whether a condition can become true between two situations."""
    known, instance = before.known, before.instance
    changed = _Changed(instance, frozenset(after.variables))
    expression, within = known.expanded(condition.condition, condition.within), condition.within
    earlier = before._replace(reason=None).formula(expression, within, changed, "before")
    later = after.formula(expression, within, changed, "after")
    parts = list(dict.fromkeys([*_unknown(earlier), *_unknown(later)]))
    if len(parts) > _MOST:
        return True
    for values in product((False, True), repeat=len(parts)):
        assignment = dict(zip(parts, values, strict=True))
        if _truth(later, assignment) is condition.value and _truth(earlier, assignment) is not condition.value:
            return True
    return False


#: Condition over parts of unknown value: a truth value, the name of a part, or a connective with its operands.
_Formula = Any


class _Changed(NamedTuple):
    """Variables of an instance whose values differ before and after a transition."""

    instance: Instance
    variables: frozenset[rsc.Variable]


class _Situation(NamedTuple):
    """Known facts of one component: its state, the reason of its error, and the values of some variables."""

    known: Instances
    instance: Instance
    state: rsc.State
    reason: str | None = None
    variables: Mapping[rsc.Variable, Value | None] = {}
    #: The call or goal that no longer runs for the model.
    ended: PortInstance | None = None

    def holds(self, guard: ex.Expression | None) -> bool | None:
        """Return whether a guard of the component holds; None if that depends on unknown values."""
        if guard is None:
            return True
        formula = self.formula(self.known.expanded(guard, self.instance), self.instance)
        parts = list(dict.fromkeys(_unknown(formula)))
        if len(parts) > _MOST:
            return None
        choices = product((False, True), repeat=len(parts))
        values = {_truth(formula, dict(zip(parts, choice, strict=True))) for choice in choices}
        return values.pop() if len(values) == 1 else None

    def formula(
        self, expression: ex.Expression, within: Instance | None, changed: _Changed | None = None, when: str = ""
    ) -> _Formula:
        """Return an expanded condition as a formula; `when` distinguishes parts that have `changed`."""

        def combine(part: ex.Expression, inside: list[_Formula]) -> _Formula:
            if isinstance(part, _CONNECTIVES):
                return part, inside
            value = self.value(part, within)
            if value is not None:
                return bool(value)
            owned_variables = (self.known.variable(access, within) for access in accesses(part))
            differs = changed is not None and any(
                owned and owned.instance == changed.instance and owned.variable in changed.variables
                for owned in owned_variables
            )
            return f"{RoboscPrinter()(part)} {when if differs else ''}"

        return fold(combine, expression, lambda part: operands(part) if isinstance(part, _CONNECTIVES) else ())

    def value(self, expression: ex.Expression, within: Instance | None) -> Value | None:
        """Return the value of an expanded expression; None if it reads an unknown value."""

        def read(reference: ex.Expression) -> Value:
            if isinstance(reference, rsc.ErrorReason) and self.reason is not None and reference.enumeration:
                rules = reference.enumeration.rules
                return next(rule.value for rule in rules if rule.value.name == self.reason)
            if isinstance(reference, rsc.Access) and not reference.value and not reference.segments:
                item = reference.item
                owner = self.known.instance(reference.component, within)
                if self.ended is not None and (owner, item) == (self.ended.instance, self.ended.communication):
                    return False
                if isinstance(item, rsc.EnumValue):
                    return item
                if isinstance(item, rsc.State) and owner == self.instance:
                    return item is self.state
                owned = self.known.variable(reference, within)
                known = self.variables.get(owned.variable) if owned and owned.instance == self.instance else None
                if known is not None:
                    return known
            raise _UnknownError

        try:
            return evaluate(expression, read)
        except (_UnknownError, UnreadableError, TypeError, ValueError, ArithmeticError):
            return None


def _unknown(formula: _Formula) -> list[str]:
    """Return the names of the parts of unknown value."""

    def combine(part: _Formula, inside: list[list[str]]) -> list[str]:
        return [part] if isinstance(part, str) else [name for names in inside for name in names]

    return fold(combine, formula, _inside)


def _truth(formula: _Formula, assignment: Mapping[str, bool]) -> bool:
    def combine(part: _Formula, inside: list[bool]) -> bool:
        if isinstance(part, bool):
            return part
        if isinstance(part, str):
            return assignment[part]
        row = operator_of(part[0])
        assert row is not None
        return bool(row.compute(*inside))

    return fold(combine, formula, _inside)


def _inside(formula: _Formula) -> list[_Formula]:
    return list(formula[1]) if isinstance(formula, tuple) else []
