"""Checks of rosgraph models before nodes are generated from them.

One of the checks is consistency: all reads and writes of one message must fit the same data.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, Any

from robosc.model import expression as ex
from robosc.model import rosgraph, sct
from robosc.model.reflection import tree
from robosc.model.semantics.failures import FAILURES
from robosc.model.semantics.messages import (
    EACH,
    fields_set,
    limit_expressions,
    path_of,
    reads_elements,
    source_of,
)
from robosc.model.semantics.typing import BOOLEAN, declared_type, infer
from robosc.model.validity.model_checks import check_type, demand, fitting_operands

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from robosc.model.validity.model_checks import Check, Checks, Fault, Model

#: Types of ROS fields in a model.
_BASIC = (ex.BooleanType, ex.IntegerType, ex.DoubleType, ex.StringType, rosgraph.ArrayType)


def _own_event(element: Any, model: Model) -> Iterator[Fault]:
    event = getattr(element, "event", None)
    if isinstance(event, sct.Event) and event.eContainer().eContainer() is not model.root.model:
        yield element, f"the event '{event.name}' belongs to another model"


def _interface(kind: rosgraph.InterfaceKind) -> Check:
    message = f"'{{0.interface.type}}' is a {{0.interface.kind}}, expected a {kind}"
    return demand(lambda user: user.interface.kind == kind, message)


def _literals(conversion: rosgraph.Conversion, _model: Model) -> Iterator[Fault]:
    for literal in dict.fromkeys([conversion.default, *(rule.literal for rule in conversion.rules)]):
        if literal.eContainer() is not conversion.enumeration:
            yield conversion, f"'{literal.name}' is not a literal of {conversion.enumeration.name}"


def _inputs(reception: rosgraph.Reception, _model: Model) -> Iterator[Fault]:
    for assignment in reception.inputs:
        if assignment.input not in reception.event.inputs:
            yield assignment, f"'{reception.event.name}' does not carry the input '{assignment.input.name}'"


def _reason(reason: rosgraph.ErrorReason, _model: Model) -> Iterator[Fault]:
    """Check that a reason is read only at an error, and that its enumeration has all reasons of the node."""
    user = reason.eContainer()
    while isinstance(user, ex.Expression | rosgraph.NodeAssignment | rosgraph.InputAssignment):
        user = user.eContainer()
    event = user.event if isinstance(user, rosgraph.Reaction | rosgraph.Reception) else None
    if event is None or event.kind != sct.EventKind.error:
        yield reason, "a reason can be read only at the error of a service or an action"
    missing = {*FAILURES} - {literal.name for literal in reason.enumeration.literals}
    if missing:
        yield reason, f"{reason.enumeration.name} has no literal '{min(missing)}'"


class _Shape:
    """Structure of one message: an object, an array or a basic value at the end of each path."""

    def __init__(self) -> None:
        self._kinds: dict[tuple[str | int, ...], str] = {}

    def add(self, element: Any, path: Sequence[str | int], kind: ex.Type | None) -> Iterator[Fault]:
        """Add the type at the end of a path. `kind` is None for a whole object or array."""
        for length, step in enumerate(path):
            yield from self._at(element, tuple(path[:length]), "an array" if isinstance(step, int) else "an object")
        if isinstance(kind, rosgraph.ArrayType):
            yield from self.add(element, [*path, -1], kind.element)
        elif kind is not None:
            yield from self._at(element, tuple(path), type(kind).__name__)

    def _at(self, element: Any, path: tuple[str | int, ...], kind: str) -> Iterator[Fault]:
        known = self._kinds.setdefault(path, kind)
        if known != kind:
            place = f"'{'.'.join(map(str, path))}'" if path else "the message"
            yield element, f"{place} has the type {kind} here, but {known} elsewhere"


def _converted_shape(conversion: rosgraph.Conversion, _model: Model) -> Iterator[Fault]:
    shape = _Shape()
    for access in _reads(rule.condition for rule in conversion.rules):
        yield from shape.add(access, _path(access), access.type)


def _sent_shape(sending: rosgraph.Sending, _model: Model) -> Iterator[Fault]:
    shape = _Shape()
    for field in fields_set(sending):
        kind = None if isinstance(field.type, rosgraph.ObjectType) else field.type
        yield from shape.add(field, list(field.path), kind)
    for access in _reads(limit_expressions(sending)):
        yield from _received(shape, access)


def _received_shapes(graph: rosgraph.RosGraph, _model: Model) -> Iterator[Fault]:
    sources = [list(subscription.receptions) for subscription in graph.subscriptions]
    sources += [[client.response] for client in graph.serviceClients]
    sources += [
        [reception]
        for client in graph.actionClients
        for reception in (client.feedback, client.response, client.error, client.canceled)
    ]
    sources += [[server.request] for server in graph.serviceServers]
    sources += [[server.request] for server in graph.actionServers]
    reactions: dict[Any, list[Any]] = defaultdict(list)
    for reaction in graph.reactions:
        reactions[reaction.event] += [*([reaction.guard] if reaction.guard else []), *reaction.needs]
        reactions[reaction.event] += [assignment.value for assignment in reaction.assignments]
    read_anywhere = set()
    for receptions in sources:
        shape = _Shape()
        for reception in receptions:
            read_anywhere.add(reception.event)
            for access in _reads([*(input_.value for input_ in reception.inputs), *reactions[reception.event]]):
                yield from _received(shape, access)
    for event, values in reactions.items():
        if event not in read_anywhere:
            yield from ((access, f"'{event.name}' has no data") for access in _reads(values))


def _received(shape: _Shape, access: rosgraph.WireAccess) -> Iterator[Fault]:
    path = _path(access)
    if access.type is not None and not path:
        yield access, "a message is not a basic value"
    yield from shape.add(access, path, access.type)
    owner = access.eContainer()
    if isinstance(owner, rosgraph.ConversionCall):
        for inner in _reads(rule.condition for rule in owner.conversion.rules):
            yield from shape.add(access, [*path, *_path(inner)], inner.type)


def _reads(values: Iterable[ex.Expression]) -> Iterator[rosgraph.WireAccess]:
    for value in values:
        accesses = (access for _, access in tree(value) if isinstance(access, rosgraph.WireAccess))
        yield from (access for access in accesses if source_of(access) is None)


def _path(access: rosgraph.WireAccess) -> list[str | int]:
    return [-1 if step == EACH else int(step) if step.isdigit() else step for step in path_of(access)]


_BASIC_FIELD = demand(
    lambda field: field.type is None or isinstance(field.type, _BASIC), "{0.type.eClass.name} is not a type of a field"
)
_FIELD = demand(
    lambda field: field.type is None or isinstance(field.type, (*_BASIC, rosgraph.ObjectType)),
    "{0.type.eClass.name} is not a type of a field",
)
_DATA = demand(
    lambda provided: provided.location.eContainer().kind == sct.PlantKind.data,
    "'{0.location.name}' is not a location of a data plant",
)
_ONE_PLANT = demand(
    lambda reaction: len({location.eContainer() for location in reaction.locations}) <= 1,
    "the locations belong to several plants",
)
_WHOLE = demand(
    lambda access: (
        access.type is not None
        or isinstance(access.eContainer(), rosgraph.ConversionCall | rosgraph.NodeAssignment)
        or (isinstance(access.eContainer(), rosgraph.FieldAssignment) and access.eContainer().value is access)
    ),
    "only inputs of conversions and data stored or sent as a whole may have no type",
)

_ALTERNATIVE = demand(
    lambda choice: (
        isinstance(choice.eContainer(), rosgraph.NodeAssignment | rosgraph.Reaction | ex.Expression)
        and not reads_elements(choice.otherwise)
        and infer(choice.value) == infer(choice.otherwise)
    ),
    "the replacement of a value must have its type and must not read an element of an array",
)

CHECKS: Checks = {
    ex.Expression: [fitting_operands],
    object: [_own_event],
    rosgraph.RosGraph: [_received_shapes],
    rosgraph.NodeVariable: [check_type("initial", lambda variable: declared_type(variable.type))],
    rosgraph.FieldAssignment: [
        check_type("value", lambda field: declared_type(field.type)),
        check_type("condition"),
        _FIELD,
    ],
    rosgraph.InputAssignment: [check_type("value", lambda assignment: declared_type(assignment.input.type))],
    rosgraph.NodeAssignment: [check_type("value", lambda assignment: declared_type(assignment.variable.type))],
    rosgraph.ConversionRule: [check_type("condition")],
    rosgraph.Conversion: [_literals, _converted_shape],
    rosgraph.Reception: [_inputs],
    rosgraph.Sending: [_sent_shape],
    rosgraph.ProvidedData: [_DATA],
    rosgraph.DataLimit: [check_type("condition")],
    rosgraph.Reaction: [_ONE_PLANT, check_type("guard", lambda _: BOOLEAN)],
    rosgraph.Subscription: [_interface(rosgraph.InterfaceKind.message)],
    rosgraph.Publisher: [_interface(rosgraph.InterfaceKind.message)],
    rosgraph.ServiceClient: [_interface(rosgraph.InterfaceKind.service)],
    rosgraph.ActionClient: [_interface(rosgraph.InterfaceKind.action)],
    rosgraph.ServiceServer: [_interface(rosgraph.InterfaceKind.service)],
    rosgraph.ActionServer: [_interface(rosgraph.InterfaceKind.action)],
    rosgraph.WireAccess: [_WHOLE, _BASIC_FIELD],
    rosgraph.ErrorReason: [_reason],
    rosgraph.IfReadable: [_ALTERNATIVE],
}
