"""Rules `data-provisioning` (thesis 4.5.1) and `requirement-target` on communications that the controller sends."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.language.checks.definitions import communication_of, restricted_events, statements
from robosc.language.checks.edits import Choice, Removal, Replacement, part_of
from robosc.language.checks.rule import Finding, rule
from robosc.model import robosc as rsc
from robosc.model.semantics.communication import kind_text, provided_event, sending_event
from robosc.model.semantics.naming import escape_keyword
from robosc.model.semantics.typing import NONE, UNKNOWN, provided_data_type, provided_type

if TYPE_CHECKING:
    from collections.abc import Iterator

#: Part of a hint for users who confuse the directions of messages.
_DIRECTIONS = (
    "or, if the controller sends it, declare it as `incoming message {}`: a component receives incoming messages"
)
_NAMELESS = "name what it restricts, or leave the requirement out"


def _as_incoming(communication: rsc.CommunicationType) -> Replacement:
    name = escape_keyword(communication.name)
    return Replacement(f"declare `incoming message {name}`", "incoming", part_of(communication).find("outgoing"))


@rule("data-provisioning")
def data_provisioning(base: rsc.Base) -> Iterator[Finding]:
    """Each `provide` names a communication that the controller sends with data, each `limit` a message of these."""
    yield from _limits(base)
    for statement in statements(rsc.ProvideStatement, base):
        communication = communication_of(statement.communicationType)
        if communication is not None and sending_event(communication) is None:
            yield Finding(
                statement.communicationType,
                f"data is provided to `{communication.name}`, which the controller receives, expected a communication"
                " that it sends: an incoming message, a service or an action",
                Choice(
                    "leave the provide statement out: the data of an outgoing message comes from its component;"
                    f" {_DIRECTIONS.format(communication.name)}",
                    (Removal("leave the provide statement out", statement), _as_incoming(communication)),
                ),
            )
        elif communication is not None and provided_event(statement) is None:
            yield Finding(
                statement.communicationType,
                f"`{communication.name}` sends no feedback, expected an outgoing action",
                Removal("leave `feedback to` out", part_of(statement).find("feedback", "to")),
            )
        elif communication is not None and provided_type(statement) == NONE:
            what = "it" if isinstance(communication, rsc.Message) else f"its {_sent(statement)}"
            yield Finding(
                statement.data or statement,
                f"data is provided to `{communication.name}`, expected none: {what} is declared with the type `none`",
                Removal("leave the provide statement out: it has no data to send", statement),
            )


def _sent(statement: rsc.ProvideStatement) -> str:
    """Return the word for the event whose data a statement provides."""
    row = provided_event(statement)
    return row.name if row is not None else ""


def _limits(base: rsc.Base) -> Iterator[Finding]:
    for limit in statements(rsc.LimitStatement, base):
        communication = communication_of(limit.communicationType)
        is_message = isinstance(communication, rsc.Message)
        if communication is None or (is_message and provided_data_type(communication) not in {NONE, UNKNOWN}):
            continue
        if not is_message:
            why = f"the {kind_text(communication)} `{communication.name}`"
        elif sending_event(communication) is None:
            why = f"`{communication.name}`, which the controller receives"
        elif provided_data_type(communication) == NONE:
            why = f"`{communication.name}`, which is declared with the type `none`"
        else:
            continue
        yield Finding(
            limit.communicationType,
            f"a limit changes the data of {why}, expected an incoming message with data",
            Removal("leave the limit out", limit),
        )


@rule("requirement-target")
def requirement_target(base: rsc.Base) -> Iterator[Finding]:
    """Each requirement restricts at least one communication, and only those that the controller sends."""
    for events in restricted_events(base):
        if events is not None and not events.events:
            message = "the requirement restricts nothing, expected at least one event in the braces"
            yield Finding(events, message, Removal(_NAMELESS, events.eContainer()))
    for requirement in statements(rsc.CommunicationRequirement, base):
        if requirement.target is None:
            continue
        if not requirement.target.communicationTypes:
            yield Finding(
                requirement.target,
                "the requirement restricts nothing, expected at least one message, service or action in the braces",
                Removal(_NAMELESS, requirement),
                relies_on=requirement,
            )
        for reference in requirement.target.communicationTypes:
            communication = communication_of(reference)
            if communication is not None and sending_event(communication) is None:
                yield Finding(
                    reference,
                    f"`{communication.name}` comes from its component at any time, expected a communication"
                    " that the controller starts: an incoming message, a service or an action",
                    Choice(
                        f"restrict the reaction of the controller; {_DIRECTIONS.format(communication.name)}",
                        (_as_incoming(communication),),
                    ),
                )
