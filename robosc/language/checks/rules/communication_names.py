"""Rules `unique-communication` and `unique-topic` (thesis 4.5.12)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.base.cache import cached
from robosc.base.diagnostics import Severity
from robosc.language.checks.definitions import of_kind
from robosc.language.checks.edits import Choice, Insertion, Removal, Renaming, Replacement, Together, part_of
from robosc.language.checks.libraries import instances, reachable
from robosc.language.checks.rule import Finding, rule
from robosc.model import robosc as rsc
from robosc.model.semantics.communication import kind_text
from robosc.model.semantics.naming import NUMBER, TEXT_FUNCTION, escape_keyword

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.language.checks.edits import Hint
    from robosc.model import expression as ex
    from robosc.model.semantics.instances import PortInstance


@rule("unique-communication")
def unique_communication(base: rsc.Base) -> Iterator[Finding]:
    """No two communications of a robot or library share a name, except those of instances of one component."""
    firsts: dict[str, PortInstance] = {}
    reported: set[tuple[ex.Located, rsc.CommunicationType]] = set()
    for second in instances(base).ports():
        if not second.communication.name:
            continue
        first = firsts.setdefault(second.communication.name, second)
        pair = {first.communication, second.communication}
        # All instances of a template have the names of its text.
        place = second.communication if second.instance.unit is base else second.instance.component
        if len(pair) == 1 or (place, second.communication) in reported:
            continue
        reported.add((place, second.communication))
        # If both are in one library, the finding is in that library.
        if not any(pair <= _communications(library) for library in reachable(base)):
            yield Finding(
                place,
                f"{_describe(second, base)} has the name of {_describe(first, base)}, expected a name of its own",
                _new_name(first, second, base),
                related=first.communication,
            )


def _communications(base: rsc.Base) -> set[rsc.CommunicationType]:
    return cached((_communications, base), lambda: {port.communication for port in instances(base).ports()})


def _describe(port: PortInstance, base: rsc.Base) -> str:
    kind = kind_text(port.communication)
    return f"{kind} `{port.communication.name}` of `{_owner(port, base)}`"


def _owner(port: PortInstance, base: rsc.Base) -> str:
    """Return the name of the component whose text declares a communication; for a library, that of the import."""
    return port.instance.definition.name if port.instance.unit is base else port.instance.component.name


def _new_name(first: PortInstance, second: PortInstance, base: rsc.Base) -> Hint:
    own = [port for port in (second, first) if port.instance.unit is base]
    if not own:
        return "import only one of these components: names that come from libraries cannot be changed here"
    name = own[0].communication.name
    owner, is_one = _owner(own[0], base), first.instance.definition is second.instance.definition
    new = f"{name}_2" if is_one else f"{name}_{owner.lower()}"
    renamed = own[0].communication
    hint = f"rename it in `{owner}`, such as `{new}`"
    if renamed.identifier or renamed.computedIdentifier:
        return Renaming(hint, renamed, new)
    hint += f', and add `identifier: "{name}"` to keep its topic'
    return Together(hint, (Renaming(hint, renamed, new), _identified(hint, renamed, name)), is_choice=True)


def _identified(hint: str, communication: rsc.CommunicationType, topic: str) -> Insertion | Replacement:
    """Return a hint that gives a communication its own topic."""
    if communication.computedIdentifier:
        return Replacement(hint, f'"{topic}"', communication.computedIdentifier, is_choice=True)
    if communication.identifier:
        string = part_of(communication).find("identifier", ":").behind()
        return Replacement(hint, f'"{topic}"', string, is_choice=True)
    start = part_of(communication).find("with")
    return Insertion(hint, f' identifier: "{topic}",', start, behind=True, is_choice=True)


@rule("unique-topic", Severity.WARNING)
def unique_topic(base: rsc.Base) -> Iterator[Finding]:
    """No two components send messages on one topic, and no import gives a name two topics.

    A `/` before a topic makes no difference.
    """
    yield from _remapped_twice(base)
    firsts: dict[str, PortInstance] = {}
    for second in instances(base).ports():
        message = second.communication
        if not isinstance(message, rsc.Message) or message.direction != rsc.MessageDirection.outgoing:
            continue
        if {*second.instance.definition.parameters} - second.instance.arguments.keys():
            continue  # `argument` reports this.
        topic = second.instance.topic(message)
        first = firsts.setdefault(topic.removeprefix("/"), second)
        if first.instance is not second.instance:
            yield Finding(
                _place(second, base),
                f"message `{message.name}` of `{second.instance.name}` and `{first.communication.name}` of"
                f" `{first.instance.name}` share the topic `{topic}`, expected one each: data of either component"
                " arrives as both",
                _own_topic(second, base),
            )


def _remapped_twice(base: rsc.Base) -> Iterator[Finding]:
    for component in of_kind(rsc.Component, base.definitions):
        if not isinstance(component.type, rsc.ImportedComponent):
            continue
        firsts: dict[rsc.CommunicationType, rsc.TopicRemapping] = {}
        for second in component.type.remappings:
            if second.communicationType is None:
                continue  # An unresolved name may be meant to be any other.
            first = firsts.setdefault(second.communicationType, second)
            if first is not second:
                yield Finding(
                    second,
                    f"`{second.communicationType.name}` of `{component.name}` has the topic `{first.identifier}`"
                    f" already, expected one topic: `{second.identifier}` has no effect",
                    Choice(
                        "remove one of the two",
                        (
                            Removal(f"remove `{second.identifier}`", second),
                            Removal(f"remove `{first.identifier}`", first),
                        ),
                    ),
                )


def _place(port: PortInstance, base: rsc.Base) -> ex.Located:
    component = port.instance.component
    if port.instance.unit is base:
        return component if port.instance.member is not None else port.communication
    assert isinstance(component.type, rsc.ImportedComponent)
    remappings = component.type.remappings
    return next((mapped for mapped in remappings if mapped.communicationType is port.communication), component)


def _own_topic(port: PortInstance, base: rsc.Base) -> Hint:
    name = port.communication.name
    topic = f"/{port.instance.name.lower()}/{name}"
    if port.instance.member is not None:
        stem = f'"/{port.instance.component.name.lower()}" + {TEXT_FUNCTION}({NUMBER})'
        if port.instance.unit is base:
            template = port.instance.definition.name
            return f"name the topic with a parameter of `{template}`, and give it `{stem}` as its argument"
        return f'use a separate topic, such as `with {{ {name}: {stem} + "/{name}" }}` after the import'
    if port.instance.unit is base:
        return _identified(f'use a separate topic, such as `identifier: "{topic}"`', port.communication, topic)
    hint = f'use a separate topic, such as `with {{ {name}: "{topic}" }}` after the import'
    imported = port.instance.component.type
    assert isinstance(imported, rsc.ImportedComponent)
    place = _place(port, base)
    if isinstance(place, rsc.TopicRemapping):
        string = part_of(place.computedIdentifier) if place.computedIdentifier else part_of(place).end()
        return Replacement(hint, f'"{topic}"', string, is_choice=True)
    if imported.remappings:
        return Insertion(hint, f'{escape_keyword(name)}: "{topic}", ', imported.remappings[0], is_choice=True)
    return Insertion(hint, f' with {{ {escape_keyword(name)}: "{topic}" }}', imported, behind=True, is_choice=True)
