"""Rule `requirement-event`: events of requirements and assumptions, and readers of requirement automata."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.language.checks.automata import named_events
from robosc.language.checks.definitions import (
    communication_of,
    communications,
    of_kind,
    restricted_events,
    statements,
    transitions,
)
from robosc.language.checks.edits import Choice, Insertion, Removal, Replacement, part_of
from robosc.language.checks.libraries import instances
from robosc.language.checks.rule import Finding, rule
from robosc.model import robosc as rsc
from robosc.model import sct
from robosc.model.semantics.communication import CONTROLLABLE, REQUESTS, SERVED, port_event_of
from robosc.model.semantics.cone_of_influence import accesses
from robosc.model.semantics.instances import assumed_components, definition_of
from robosc.model.semantics.naming import enumeration, escape_keyword

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.language.checks.edits import Way
    from robosc.model import expression as ex


@rule("requirement-event")
def requirement_event(base: rsc.Base) -> Iterator[Finding]:
    """No order or count restricts an outgoing message, and only requirements read requirement automata.

    An assumption restricts messages, feedback and responses of the robot. In a library, it is about one component.
    """
    for events in restricted_events(base):
        for named in events.events if events else ():
            communication = communication_of(named.communicationType)
            if isinstance(communication, rsc.Message) and communication.direction == rsc.MessageDirection.outgoing:
                yield Finding(
                    named,
                    f"`{communication.name}` comes from its component at any time, expected a request or an answer",
                    "restrict the reaction of the controller",
                )
    for assumption in statements(rsc.Assumption, base):
        for named in assumption.target.events if assumption.target else ():
            yield from _assumed(named)
    if isinstance(base, rsc.Library):
        yield from _about_several(base)
    if any(True for _ in statements(rsc.AutomatonRequirement, base)):
        yield from _readers(base)
    yield from _sent_on_change(base)


#: Kinds of events that an assumption restricts.
_FROM_ROBOT = (sct.EventKind.response, sct.EventKind.feedback, *REQUESTS)


def _assumed(named: rsc.EventReference) -> Iterator[Finding]:
    """Report an event of an assumption that is not an outgoing message, feedback or a response."""
    event, communication = port_event_of(named), communication_of(named.communicationType)
    if event is None or communication is None or event.kind in _FROM_ROBOT:
        return
    maker = "the controller decides on" if event.kind in CONTROLLABLE else "the node itself makes"
    hint = "write a requirement" if isinstance(communication, rsc.Message) else _answers(named, communication)
    others = (
        "a request or a cancel" if isinstance(communication, SERVED) else "an outgoing message, feedback or a response"
    )
    yield Finding(named, f"{maker} the {event.name} of `{communication.name}`, expected {others}", hint)


def _answers(named: rsc.EventReference, communication: rsc.CommunicationType) -> Choice:
    """Return the choice of the answer that an assumption is about."""
    name, whole, communicated = escape_keyword(communication.name), part_of(named), part_of(named.communicationType)
    ways: list[Way] = []
    kinds = ("response", "feedback") if isinstance(communication, rsc.Action) else ("response",)
    if isinstance(communication, SERVED):
        kinds = ("request",)
    for kind in kinds:
        hint = f"write `{kind} from {name}`"
        if isinstance(named, rsc.NamedEvent):
            ways.append(Replacement(hint, f"{kind} from", whole.until(communicated), is_choice=True))
        else:
            ways.append(Insertion(hint, f"{kind} from ", named, is_choice=True))
    return Choice(f"write {enumeration(f'`{kind} from {name}`' for kind in kinds)}", tuple(ways))


def _about_several(library: rsc.Library) -> Iterator[Finding]:
    """Report assumptions outside of components that are not about one component with a text of its own.

    An import of a component with a text of its own keeps them, also that of a template.
    """
    for assumption in of_kind(rsc.Assumption, library.definitions):
        about = assumed_components(assumption, instances(library))
        names = " and ".join(f"`{component.name}`" for component in about)
        if len(about) > 1:
            message = f"this assumption is about {names}, expected one component: each import of it has the assumption"
            yield Finding(assumption, message, "write it in the robot")
        elif about and not isinstance(about[0].type, rsc.LocalComponent) and assumption.template is None:
            origin = definition_of(about[0])
            is_own = origin is not None and origin.eContainer() is library
            each = f"begin it with `each {origin.name}:`, or " if origin and origin.parameters and is_own else ""
            message = f"{names} takes its text from another component, expected a component with a text of its own"
            yield Finding(assumption, message, f"{each}write it in the robot")


def _sent_on_change(base: rsc.Base) -> Iterator[Finding]:
    """Report requirements and transitions on messages that are sent on change: these have no defined moment."""
    for message in communications(base):
        if isinstance(message, rsc.Message) and message.onChange and message.direction == rsc.MessageDirection.outgoing:
            what = f"`{message.name}` comes from its component at any time, expected an incoming message"
            hint = "leave `, send: change` out"
            yield Finding(message, f"{what} before `send: change`", _with_every_tick(hint, message))
    named: list[tuple[ex.Located, rsc.CommunicationReference]] = []
    named += [(event, event.communicationType) for event in named_events(base)]
    for _, transition in transitions(base):
        if isinstance(transition, rsc.ResultTransition):
            named.append((transition, transition.communicationType))
    for where, reference in named:
        sent = communication_of(reference)
        if isinstance(sent, rsc.Message) and sent.onChange and sent.direction == rsc.MessageDirection.incoming:
            ways: list[Way] = [_with_every_tick("leave `, send: change` out", sent)]
            if isinstance(where, rsc.Transition):
                ways.append(Removal("leave the transition out", where))
            yield Finding(
                where,
                f"`{sent.name}` is sent when its data changes, expected no transition, order, count or automaton that"
                " names it",
                Choice("leave `, send: change` out, or this", tuple(ways)),
            )


def _with_every_tick(hint: str, message: rsc.Message) -> Removal:
    return Removal(hint, part_of(message).find(",", "send", ":", "change"), is_choice=True)


def _readers(base: rsc.Base) -> Iterator[Finding]:
    """Report expressions outside of requirements that read a requirement automaton, also through definitions."""
    known = instances(base)
    for instance in known:
        for transition, _ in instance.transitions:
            if isinstance(transition, rsc.TauTransition) and transition.guard is not None:
                yield from _reading(transition.guard, known.expanded(transition.guard, instance), "a guard")
    for statement in known.statements(rsc.DataStatement):
        condition = statement.element.condition
        if condition is not None:
            expanded = known.expanded(condition, statement.within)
            what = "a limit" if isinstance(statement.element, rsc.LimitStatement) else "a provide statement"
            yield from _reading(condition, expanded, f"the condition of {what}")
    for assumed in known.statements(rsc.Assumption):
        condition = assumed.element.condition
        if condition is not None:
            yield from _reading(condition, known.expanded(condition, assumed.within), "an assumption")
    for _, transition in transitions(base):
        for assignment in transition.assignments:
            yield from _reading(assignment.value, assignment.value, "an assignment")


def _reading(expression: ex.Expression | None, expanded: ex.Expression | None, what: str) -> Iterator[Finding]:
    items = (access.item for access in accesses(expanded))
    state = next((item for item in items if isinstance(item, rsc.RequirementState)), None)
    if state is not None and expression is not None:
        name = f"{escape_keyword(state.eContainer().name)}.{escape_keyword(state.name)}"
        yield Finding(
            expression,
            f"{what} reads `{name}`, a state of a requirement, expected states and variables of components only",
            "write it as a requirement, or store it in a state of a component",
        )
