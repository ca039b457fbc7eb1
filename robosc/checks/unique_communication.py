"""`unique-communication` (thesis 4.5.12)."""

from collections.abc import Iterator

from robosc.checks.libraries import fact, instances, reachable
from robosc.checks.rule import Finding, rule
from robosc.metamodel import robosc as rsc
from robosc.semantics.instances import PortInstance


@rule("unique-communication")
def unique_communication(base: rsc.Base) -> Iterator[Finding]:
    """No two communications of a robot or library have one name, except those of instances of one component."""
    firsts: dict[str, PortInstance] = {}
    for second in instances(base).ports():
        if not second.communication.name:
            continue
        first = firsts.setdefault(second.communication.name, second)
        pair = {first.communication, second.communication}
        # Of two in one library, that library has the finding.
        if len(pair) == 2 and not any(pair <= fact(_communications, library) for library in reachable(base)):
            own = second.instance.unit is base
            yield Finding(
                second.communication if own else second.instance.component,
                f"{_describe(second)} has the name of {_describe(first)}, expected a name of its own",
                _repair(first, second, base),
            )


def _communications(base: rsc.Base) -> set[rsc.CommunicationType]:
    return {port.communication for port in instances(base).ports()}


def _describe(port: PortInstance) -> str:
    kind = type(port.communication).__name__.lower()
    return f"{kind} `{port.communication.name}` of `{port.instance.name}`"


def _repair(first: PortInstance, second: PortInstance, base: rsc.Base) -> str:
    own = [port for port in (second, first) if port.instance.unit is base]
    if not own:
        return "import only one of these components: names that come from libraries can't be changed here"
    name = own[0].communication.name
    new = f"{name}_2" if first.instance is second.instance else f"{name}_{own[0].instance.name.lower()}"
    topic = own[0].communication.identifier
    keep = "" if topic else f', and add `identifier: "{name}"` to keep its topic'
    return f"rename it in `{own[0].instance.name}`, such as `{new}`{keep}"
