"""`unique-topic` (thesis 4.5.12)."""

from collections.abc import Iterator

from robosc.checks.libraries import instances
from robosc.checks.rule import Finding, rule
from robosc.diagnostics import Severity
from robosc.metamodel import expression as ex
from robosc.metamodel import robosc as rsc
from robosc.semantics.instances import PortInstance


@rule("unique-topic", Severity.WARNING)
def unique_topic(base: rsc.Base) -> Iterator[Finding]:
    """No two components send messages on one topic, with or without a `/` before it, no import gives a name two."""
    yield from _remapped_twice(base)
    firsts: dict[str, PortInstance] = {}
    for second in instances(base).ports():
        message = second.communication
        if not isinstance(message, rsc.Message) or str(message.direction) != "outgoing":
            continue
        topic = second.instance.topic(message)
        first = firsts.setdefault(topic.removeprefix("/"), second)
        if first.instance is not second.instance:
            yield Finding(
                _place(second, base),
                f"message `{message.name}` of `{second.instance.name}` and `{first.communication.name}` of"
                f" `{first.instance.name}` share the topic `{topic}`, expected one each: what either component sends"
                " arrives as both",
                _repair(second, base),
            )


def _remapped_twice(base: rsc.Base) -> Iterator[Finding]:
    for component in base.definitions:
        if not isinstance(component, rsc.Component) or not isinstance(component.type, rsc.ImportedComponent):
            continue
        firsts: dict[rsc.CommunicationType, rsc.TopicRemapping] = {}
        for second in component.type.remappings:
            if second.communicationType is None:
                continue  # a name that is nothing, and that may be meant to be any other
            first = firsts.setdefault(second.communicationType, second)
            if first is not second:
                yield Finding(
                    second,
                    f"`{second.communicationType.name}` of `{component.name}` has the topic `{first.identifier}`"
                    f" already, expected one topic: `{second.identifier}` has no effect",
                    "remove one of the two",
                )


def _place(port: PortInstance, base: rsc.Base) -> ex.Located:
    if port.instance.unit is base:
        return port.communication
    component = port.instance.component
    assert isinstance(component.type, rsc.ImportedComponent)
    remapped = (
        remapping for remapping in component.type.remappings if remapping.communicationType is port.communication
    )
    return next(remapped, component)


def _repair(port: PortInstance, base: rsc.Base) -> str:
    name, instance = port.communication.name, port.instance
    topic = f"/{instance.name.lower()}/{name}"
    if instance.unit is base:
        return f'give it a topic of its own, such as `identifier: "{topic}"`'
    return f'give it a topic of its own, such as `with {{ {name}: "{topic}" }}` after the import'
