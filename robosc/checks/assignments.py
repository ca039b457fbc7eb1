"""`assignment-on-message-to-node` and `assignment-scope` (thesis 4.5.5 and 4.5.6), and `repeated-assignment`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.checks.automata import assigned_variable, behaviours, sends_message, transitions
from robosc.checks.rule import Finding, rule
from robosc.diagnostics import Severity
from robosc.metamodel import robosc as rsc

if TYPE_CHECKING:
    from collections.abc import Iterator


@rule("assignment-on-message-to-node")
def assignment_on_message_to_node(base: rsc.Base) -> Iterator[Finding]:
    """Sending a message to a component assigns nothing: no data comes in with it."""
    for component, behaviour in behaviours(base):
        for transition in transitions(behaviour.automaton):
            if transition.assignments and isinstance(transition, rsc.ResultTransition) and sends_message(transition):
                name = transition.communicationType.communicationType.name
                yield Finding(
                    transition.assignments[0],
                    f"`{component.name}` assigns a value when it is sent `{name}`, expected no assignment: a message"
                    " to a component brings no data back",
                    "leave `do …` out; a state that the transition goes to can remember that the message was sent",
                )


@rule("assignment-scope")
def assignment_scope(base: rsc.Base) -> Iterator[Finding]:
    """Only variables of the own component are assigned; those of others can be read."""
    for component, behaviour in behaviours(base):
        for transition in transitions(behaviour.automaton):
            for assignment in transition.assignments:
                target = assignment.item
                unresolved = target is None or (target.item is None and not target.value)
                if not unresolved and assigned_variable(assignment) is None:
                    yield Finding(
                        target,
                        f"{_describe(target)} is assigned a value, expected a variable of `{component.name}`",
                        _repair(target, component),
                    )


@rule("repeated-assignment", Severity.WARNING)
def repeated_assignment(base: rsc.Base) -> Iterator[Finding]:
    """A transition assigns a variable once."""
    for _, behaviour in behaviours(base):
        for transition in transitions(behaviour.automaton):
            assigned = set()
            for assignment in transition.assignments:
                variable = assigned_variable(assignment)
                if variable is not None and variable in assigned:
                    yield Finding(
                        assignment,
                        f"`{variable.name}` is assigned a value by this transition already, expected one: the last"
                        " one counts",
                        "leave out the one that is not meant: assignments of one transition are simultaneous",
                    )
                assigned.add(variable)


def _describe(target: rsc.Access) -> str:
    item = target.item
    if item is None:
        return "`value`"
    if isinstance(item, rsc.EnumValue):
        return f"enum value `{item.name}`"
    owner = f" of `{target.component.name}`" if target.component and not isinstance(item, rsc.Component) else ""
    return f"{type(item).__name__.lower()} `{item.name}`{owner}"


def _repair(target: rsc.Access, component: rsc.Component) -> str:
    item = target.item
    if isinstance(item, rsc.State) and target.component is component:
        return f"write `goto {item.name}`"
    if isinstance(item, rsc.Variable) and target.component:
        return f"assign it in `{target.component.name}`, by a transition of its own that reads `{component.name}`"
    return f"declare `variable … : …` in the behaviour of `{component.name}` and assign that"
