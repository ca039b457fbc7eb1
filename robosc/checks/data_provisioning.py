"""`data-provisioning` (thesis 4.5.1)."""

from collections.abc import Iterator

from robosc.checks.declarations import DIRECTIONS
from robosc.checks.rule import Finding, rule
from robosc.metamodel import robosc as rsc
from robosc.semantics.typing import NONE, provided_data_type


@rule("data-provisioning")
def data_provisioning(base: rsc.Base) -> Iterator[Finding]:
    """Data is provided only to what the controller sends, and only where data goes along."""
    for statement in base.definitions:
        if not isinstance(statement, rsc.ProvideStatement) or statement.communicationType is None:
            continue
        communication = statement.communicationType.communicationType
        if isinstance(communication, rsc.Message) and str(communication.direction) == "outgoing":
            yield Finding(
                statement.communicationType,
                f"data is provided to `{communication.name}`, which the controller receives, expected a communication"
                " that it sends: an incoming message, a service or an action",
                "leave the provide statement out: the data of an outgoing message comes from its component;"
                f" {DIRECTIONS.format(communication.name)}",
            )
        elif communication is not None and provided_data_type(communication) == NONE:
            what = "it" if isinstance(communication, rsc.Message) else "its request"
            yield Finding(
                statement.data or statement,
                f"data is provided to `{communication.name}`, expected none: {what} is declared with the type `none`",
                "leave the provide statement out: there is no data to send along",
            )
