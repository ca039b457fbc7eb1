"""Sample messages with different meanings for a node, found by random search."""

from __future__ import annotations

import math
import random
import struct
from dataclasses import dataclass, field
from itertools import islice, product
from typing import TYPE_CHECKING, Any

from robosc.base.ros_types.wire import INTEGER_RANGES
from robosc.engine import Engine
from robosc.engine.state import Domain
from robosc.model import expression as ex
from robosc.model import rosgraph
from robosc.model.reflection import tree
from robosc.model.semantics import messages
from robosc.model.semantics.communication import happens_anyway
from robosc.model.semantics.domains import domain
from robosc.model.semantics.messages import reads_elements, reads_state, reads_stored
from robosc.model.semantics.operators import UnreadableError
from robosc.model.semantics.roles import event_name
from robosc.run.node_tests.messages import Definition, Field, Leaf, Path, data_read, message
from robosc.run.runtime.core.event_log import ReceivedData
from robosc.run.runtime.core.node_data import NodeData
from robosc.run.runtime.core.port import Failure

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping, Sequence

    from robosc.base.ros_types import RosDistribution, Section
    from robosc.engine.state import Value
    from robosc.model import sct

    #: Events of a message, each with the values of its inputs by name.
    _Events = tuple[tuple[str, tuple[tuple[str, Any], ...]], ...]

#: Number of trials without a new sample after which the search ends.
_TRIALS = 500
_SAMPLES_PER_CLASS = 4
_SEED = 1
#: Maximum number of classes.
_CLASSES = 64


@dataclass(frozen=True)
class LoggedValue:
    """Value of a message in the event log: unchanged, or after a conversion."""

    path: Path
    conversion: rosgraph.Conversion | None


@dataclass
class Class:
    """Messages with the same meaning: equal literals of the conversions, and events with equal inputs."""

    literals: tuple[str, ...]
    events: tuple[tuple[str, tuple[tuple[str, Any], ...]], ...]
    samples: list[dict[Path, Leaf]] = field(default_factory=list)


@dataclass
class IncomingKind:
    """Kind of incoming data: its events with their logged reads, all fields read, and sample messages.

    `samples`: some messages for each tuple of literals that the conversions make of them, in the order of the events.
    `classes`: fully readable messages, grouped by the inputs of the supervisor.
    """

    events: list[tuple[str, list[LoggedValue]]]
    fields: dict[Path, Field]
    #: Events that a message may not cause, since array elements that they need may be missing.
    unreadable: set[str]
    samples: dict[tuple[str, ...], list[dict[Path, Leaf]]] = field(default_factory=dict)
    classes: list[Class] = field(default_factory=list)
    #: Elements of arrays that a new message has.
    initial: dict[Path, Leaf] = field(default_factory=dict)

    def message(self, values: Mapping[Path, Leaf]) -> Any:
        """Return data with these values, and the defaults of ROS elsewhere."""
        return message(self.fields, {**self.initial, **values})

    def defaults(self, values: Mapping[Path, Leaf]) -> dict[Path, Leaf]:
        """Return the other fields whose default is not zero, `false` or empty."""
        initial_values: dict[Path, Leaf] = {}
        for path, known in self.fields.items():
            if known.initial:
                ways = {_along(path, other_path) for other_path in values} if any(map(str.isdigit, path)) else {path}
                initial_values |= {way: known.initial for way in ways if way is not None and way not in values}
        return initial_values

    @property
    def conversions(self) -> list[LoggedValue]:
        """The values that the log shows as literals."""
        return [logged for _, shown in self.events for logged in shown if logged.conversion is not None]

    @property
    def direct(self) -> list[Path]:
        """The paths of the values that the log shows unchanged."""
        return list(
            dict.fromkeys(logged.path for _, shown in self.events for logged in shown if logged.conversion is None)
        )


class Values:
    """Values to try: those around all constants in comparisons of the models."""

    def __init__(self, graph: rosgraph.RosGraph) -> None:
        elements = [element for root in (graph, graph.model) for _, element in tree(root)]
        texts = [literal.value for literal in elements if isinstance(literal, ex.StringLiteral)]
        integers = [literal.value for literal in elements if isinstance(literal, ex.IntegerLiteral)]
        doubles = [float(value) for value in integers]
        doubles += [literal.value for literal in elements if isinstance(literal, ex.DoubleLiteral)]
        self._texts = list(dict.fromkeys([*texts, "", "something"]))
        self._integers = sorted({0, 1, *(near for known in integers for near in (known - 1, known, known + 1, -known))})
        self._doubles = sorted({near for value in (0.0, 1.0, *doubles) for near in _around(value)})

    def of(self, field: Field) -> list[Leaf]:
        """Return values that a field can hold exactly in ROS."""
        match field.type:
            case ex.BooleanType():
                return [False, True]
            case ex.StringType():
                return list(self._texts)
            case rosgraph.ObjectType():
                return [{}]
            case ex.DoubleType() if field.wire_type.startswith(("float", "double")):
                precise = field.wire in ("float64", "double")
                return [number for number in self._doubles if precise or _is_single(number)]
        low, high = _bounds(field)
        integers = [number for number in self._integers if low <= number <= high]
        return [float(number) for number in integers] if isinstance(field.type, ex.DoubleType) else list(integers)


def _around(value: float) -> tuple[float, ...]:
    """Return the value, and numbers near it on both sides that a float32 holds."""
    if not math.isfinite(value) or abs(value) > 1e6:
        return ()
    below, above = math.ceil(value * 8 - 1) / 8, math.floor(value * 8 + 1) / 8
    return (value, below, above, -below)


def _is_single(value: float) -> bool:
    return bool(struct.unpack("f", struct.pack("f", value))[0] == value)


def _bounds(field: Field) -> tuple[int, int]:
    if field.wire in (None, "byte"):
        return 0, 127  # every type holds these, and a byte of either ROS
    return INTEGER_RANGES.get(field.wire, INTEGER_RANGES["int64"])


def _along(path: Path, other: Path) -> Path | None:
    """Return the path with the indices of another one through the same arrays; None if there are others."""
    last = max(number for number, step in enumerate(path) if step.isdigit())
    if len(other) <= last or any(
        ours != theirs and not (ours.isdigit() and theirs.isdigit())
        for ours, theirs in zip(path[: last + 1], other, strict=False)
    ):
        return None
    return other[: last + 1] + path[last + 1 :]


def incoming(
    distribution: RosDistribution,
    interface: rosgraph.Interface,
    part: Section,
    receptions: Sequence[
        tuple[str, messages.Shown, Collection[ex.Expression], Collection[tuple[Path, messages.MessageRead]]]
    ],
) -> IncomingKind:
    """Return one kind of incoming message: its events with their logged values, and the fields that are read."""
    definition = Definition(distribution, interface, part)
    fields: dict[Path, Field] = {}
    events = []
    unreadable = set()
    for event, shown, values, later in receptions:
        if any(map(reads_elements, values)):
            unreadable.add(event)
        for path, kind in data_read([*messages.reads(values), *later]):
            fields.setdefault(path, definition.field(path, kind))
        logged = [
            LoggedValue(path, part.conversion if isinstance(part, messages.MessageRead) else None)
            for path, part in shown.items()
        ]
        events.append((event, logged))
    inner = {(), *(path[:length] for path in fields for length in range(len(path)))} - {
        path for path, field in fields.items() if not isinstance(field.type, rosgraph.ObjectType)
    }
    fields = {path: field for path, field in fields.items() if path not in inner}
    return IncomingKind(events, fields, unreadable, initial=definition.initial(fields))


def all_incoming(graph: rosgraph.RosGraph, distribution: RosDistribution) -> dict[sct.Event, IncomingKind]:
    """Return the messages to choose from for each incoming event; the events of one topic share them."""
    data = NodeData(graph, Engine(graph.model))
    data.reason = Failure.ABORTED
    values, stored_reads = Values(graph), list(messages.kept_reads(graph))
    known: dict[sct.Event, IncomingKind] = {}
    for interface, part, receptions in messages.received_messages(graph):
        described = []
        for reception in receptions:
            values_read = [assigned.value for assigned in reception.inputs] + data.values_read(reception.event)
            later = [(path, inner) for owner, path, inner in stored_reads if owner is reception]
            later += _read_by_error(reception, data)
            described.append((event_name(reception.event), ReceivedData(values_read).parts, values_read, later))
        kind = incoming(distribution, interface, part, described)
        if any(happens_anyway(reception.event) for reception in receptions):
            kind.unreadable.clear()
        _find_samples(kind, values, data, receptions)
        known |= dict.fromkeys((reception.event for reception in receptions), kind)
    return known


def _read_by_error(response: rosgraph.Reception, data: NodeData) -> Iterator[tuple[Path, messages.MessageRead]]:
    """Yield data of a result that the error of an action reads: a response that can't be read is an error."""
    client = response.eContainer()
    if isinstance(client, rosgraph.ActionClient) and client.response is response:
        values = [assigned.value for assigned in client.error.inputs]
        yield from messages.reads([*values, *data.values_read(client.error.event)])


def _find_samples(kind: IncomingKind, values: Values, data: NodeData, receptions: Sequence[rosgraph.Reception]) -> None:
    """Fill in `samples` and `classes`: try messages until no new ones appear within a number of trials."""
    choice = random.Random(_SEED)  # noqa: S311  # reproducible
    pools = {path: values.of(field) for path, field in kind.fields.items()}
    paths = [path for path in pools if pools[path]]
    conversions = kind.conversions
    classes: dict[object, Class] = {}
    seen: list[dict[Path, Leaf]] = [{}]
    in_vain = 0
    while in_vain < _TRIALS:
        tried = _tried(choice, paths, pools, seen)
        message = kind.message(tried)
        literals = tuple(_literal(conversion, message, data) for conversion in conversions)
        sample_lists = [kind.samples.setdefault(literals, [])]
        sample_lists += [
            classes.setdefault((literals, events), Class(literals, events)).samples
            for events in _events(receptions, message, data)
            if (literals, events) in classes or len(classes) < _CLASSES
        ]
        in_vain += 1
        for samples in sample_lists:
            if len(samples) < _SAMPLES_PER_CLASS and tried not in samples:
                samples.append(tried)
                seen.append(tried)
                in_vain = 0
    kind.samples = {
        literals: sorted(candidates, key=len, reverse=True) for literals, candidates in kind.samples.items()
    }
    kind.classes = list(classes.values())


def _events(receptions: Sequence[rosgraph.Reception], message: Any, data: NodeData) -> Iterator[_Events]:
    """Yield the events of a message with their inputs; none if some of them can't be read.

    An input that depends on the robot's state may have any value with this message.
    """
    choices: list[list[tuple[str, Any]]] = []
    try:
        for reception in receptions:
            for value in data.values_read(reception.event):
                if not reads_stored(value):
                    data.value(value, message)
            for assignment in reception.inputs:
                name = assignment.input.name
                if reads_state(assignment.value):
                    choices.append([(name, value) for value in _possible(assignment.input.type)])
                    continue
                if not happens_anyway(reception.event):
                    data.value(assignment.value, message)
                choices.append([(name, data.input(assignment, message))])
    except UnreadableError:
        return
    for inputs in islice(product(*choices), _CLASSES):
        rest = iter(inputs)
        yield tuple(
            (event_name(reception.event), tuple(islice(rest, len(reception.inputs)))) for reception in receptions
        )


def _possible(kind: ex.Type) -> list[Value]:
    known = Domain(kind)
    low, high = domain(kind)
    return [known.external(code) for code in range(low, min(high, low + _CLASSES) + 1)]


def _tried(
    choice: random.Random,
    paths: Sequence[Path],
    pools: Mapping[Path, Sequence[Leaf]],
    seen: Sequence[dict[Path, Leaf]],
) -> dict[Path, Leaf]:
    """Return a message: all fields at one place of their pools, each at random, or a kept one with a few changes."""
    if not paths:
        return {}
    place = choice.random()
    match choice.randrange(4):
        case 0:
            leaves = {path: pools[path][int(place * len(pools[path]))] for path in paths}
        case 1:
            leaves = {path: choice.choice(pools[path]) for path in paths}
        case _:
            leaves = dict(choice.choice(seen))
            for path in choice.sample(paths, min(len(paths), choice.randint(1, 3))):
                leaves[path] = choice.choice(pools[path])
    if choice.random() < 1 / 16:
        leaves = shorten(leaves, choice)
    return {path: leaves[path] for path in paths if path in leaves}


def shorten(values: Mapping[Path, Leaf], choice: random.Random) -> dict[Path, Leaf]:
    """Return some of the values, so that an array may be too short."""
    return dict(islice(values.items(), choice.randrange(len(values) + 1)))


def _literal(logged: LoggedValue, argument: Any, data: NodeData) -> str:
    assert logged.conversion is not None
    for step in logged.path:
        try:
            argument = argument[int(step)] if step.isdigit() else getattr(argument, step)
        except IndexError:
            return logged.conversion.default.name
    return data.convert(logged.conversion, argument).name
