"""Whether all that a graph reads of one message, or writes into one, can be parts of one and the same data."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, Any

from robosc.metamodel import expression as ex
from robosc.metamodel import rosgraph
from robosc.metamodel.reflection import tree

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

Fault = tuple[Any, str]
#: What a field of ROS is in a model.
_BASIC = (ex.BooleanType, ex.IntegerType, ex.DoubleType, ex.StringType)


class _Shape:
    """What is known of one message: an object, an array or a basic value at the end of each path."""

    def __init__(self) -> None:
        self._kinds: dict[tuple[str | int, ...], str] = {}

    def add(self, element: Any, path: Sequence[str | int], kind: ex.Type | None) -> Iterator[Fault]:
        """Adds what is at the end of a path; `kind` is None where that is an object or an array as a whole."""
        for length, step in enumerate(path):
            yield from self._at(element, tuple(path[:length]), "an array" if isinstance(step, int) else "an object")
        if kind is not None:
            yield from self._at(element, tuple(path), type(kind).__name__)

    def _at(self, element: Any, path: tuple[str | int, ...], kind: str) -> Iterator[Fault]:
        known = self._kinds.setdefault(path, kind)
        if known != kind:
            place = f"'{'.'.join(map(str, path))}'" if path else "the message"
            yield element, f"{place} is read or written as {kind} here, but as {known} elsewhere"


def shape_faults(graph: rosgraph.RosGraph, elements: Sequence[Any]) -> Iterator[Fault]:
    """The places whose view of a message does not fit that of another place, or that of any message."""
    for element in elements:
        match element:
            case rosgraph.WireAccess():
                yield from _access_faults(element)
            case rosgraph.FieldAssignment() if not isinstance(element.type, _BASIC):
                yield element, f"{type(element.type).__name__} is no type of a field"
            case rosgraph.Sending():
                yield from _sent_faults(element)
            case rosgraph.Conversion():
                shape = _Shape()
                for read in _reads(rule.condition for rule in element.rules):
                    yield from shape.add(read, _path(read), read.type)
    yield from _received_faults(graph)


def _sent_faults(sending: rosgraph.Sending) -> Iterator[Fault]:
    shape = _Shape()
    for alternative in sending.alternatives:
        for field in alternative.fields:
            yield from shape.add(field, list(field.path), field.type)


def _reads(values: Iterable[ex.Expression]) -> Iterator[rosgraph.WireAccess]:
    for value in values:
        yield from (access for _, access in tree(value) if isinstance(access, rosgraph.WireAccess))


def _access_faults(access: rosgraph.WireAccess) -> Iterator[Fault]:
    owner = access.eContainer()
    whole = isinstance(owner, rosgraph.ConversionCall)
    if access.type is None and not whole:
        yield access, "only what a conversion takes may be without a type"
    elif access.type is not None and not isinstance(access.type, _BASIC):
        yield access, f"{type(access.type).__name__} is no type of a field"


def _received_faults(graph: rosgraph.RosGraph) -> Iterator[Fault]:
    sources = [list(subscription.receptions) for subscription in graph.subscriptions]
    sources += [[client.response] for client in graph.serviceClients]
    sources += [[reception] for client in graph.actionClients for reception in (client.feedback, client.response)]
    reactions: dict[Any, list[Any]] = defaultdict(list)
    for reaction in graph.reactions:
        reactions[reaction.event] += [assignment.value for assignment in reaction.assignments]
    read_anywhere = set()
    for receptions in sources:
        shape = _Shape()
        for reception in receptions:
            read_anywhere.add(reception.event)
            for access in _reads([*(input_.value for input_ in reception.inputs), *reactions[reception.event]]):
                yield from _seen(shape, access)
    for event, values in reactions.items():
        if event not in read_anywhere:
            yield from ((read, f"'{event.name}' comes with no data") for read in _reads(values))


def _seen(shape: _Shape, access: rosgraph.WireAccess) -> Iterator[Fault]:
    path = _path(access)
    if access.type is not None and not path:
        yield access, "a message is no basic value"
    yield from shape.add(access, path, access.type)
    owner = access.eContainer()
    if isinstance(owner, rosgraph.ConversionCall):
        for read in _reads(rule.condition for rule in owner.conversion.rules):
            yield from shape.add(access, [*path, *_path(read)], read.type)


def _path(access: rosgraph.WireAccess) -> list[str | int]:
    return [
        step.index if isinstance(step, rosgraph.IndexStep) else str(getattr(step, "name", "")) for step in access.steps
    ]
