"""`requirement-target`."""

from collections.abc import Iterator

from robosc.checks.declarations import DIRECTIONS
from robosc.checks.rule import Finding, rule
from robosc.metamodel import robosc as rsc


@rule("requirement-target")
def requirement_target(base: rsc.Base) -> Iterator[Finding]:
    """A requirement restricts something, and something that the controller sends."""
    for requirement in base.definitions:
        if not isinstance(requirement, rsc.Requirement) or requirement.target is None:
            continue
        if not requirement.target.communicationTypes:
            yield Finding(
                requirement.target,
                "the requirement restricts nothing, expected at least one message, service or action in the braces",
                "name what it restricts, or leave the requirement out",
                relies_on=requirement,
            )
        for reference in requirement.target.communicationTypes:
            message = reference.communicationType
            if isinstance(message, rsc.Message) and str(message.direction) == "outgoing":
                yield Finding(
                    reference,
                    f"`{message.name}` comes from its component whenever that sends it, expected a communication that"
                    " the controller starts: an incoming message, a service or an action",
                    f"restrict what the controller does about it; {DIRECTIONS.format(message.name)}",
                )
