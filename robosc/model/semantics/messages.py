"""Message data that a node reads, and headers that it fills: shared by interpreted and generated nodes.

A node reads only the data that the transitions of the present state need: guards up to the first that holds, and the
values assigned there. If any of that cannot be read, the event happens for no component. An input of the supervisor
that cannot be read and that no transition needs has its first value.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

from robosc.base.ros_types import Section
from robosc.model import expression as ex
from robosc.model import rosgraph, sct
from robosc.model.reflection import contents, tree
from robosc.model.semantics.evaluation import Value, saturate
from robosc.model.semantics.operators import operator_of
from robosc.model.semantics.roles import event_name
from robosc.model.semantics.walks import operands

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

#: Names of fields and positions in arrays, from the message inwards.
Path: TypeAlias = tuple[str, ...]
#: Stands for every position of an array.
EACH = "*"


@dataclass(frozen=True)
class MessageRead:
    """A part of a message that is read: a value of a type, or the argument of a conversion.

    `reference` is the first expression that reads it. Without type and conversion the part is an object, and none
    of its fields is read.
    """

    reference: ex.Expression
    type: ex.Type | None = None
    conversion: rosgraph.Conversion | None = None

    @property
    def is_value(self) -> bool:
        """Whether the part is a value, not an object."""
        return self.type is not None or self.conversion is not None


#: Parts read of a message. An array whose elements are all read has the parts of an element.
Shown: TypeAlias = "dict[Path, MessageRead | Shown]"


def receptions(graph: rosgraph.RosGraph) -> list[rosgraph.Reception]:
    """Return all receptions of data, and the errors of services, which have a reason."""
    errors = [service.error for service in graph.serviceClients]
    return [*(reception for _, _, several in received_messages(graph) for reception in several), *errors]


def received_messages(
    graph: rosgraph.RosGraph,
) -> Iterator[tuple[rosgraph.Interface, Section, Sequence[rosgraph.Reception]]]:
    """Yield each kind of incoming ROS message: its interface, the section, and its receptions."""
    for topic in graph.subscriptions:
        yield topic.interface, Section.MESSAGE, topic.receptions
    for service in graph.serviceClients:
        yield service.interface, Section.RESPONSE, [service.response]
    for action in graph.actionClients:
        yield action.interface, Section.FEEDBACK, [action.feedback]
        for end in (action.response, action.error, action.canceled):
            yield action.interface, Section.RESULT, [end]
    for served in graph.serviceServers:
        yield served.interface, Section.REQUEST, [served.request]
    for performed in graph.actionServers:
        yield performed.interface, Section.GOAL, [performed.request]


def sent_messages(
    graph: rosgraph.RosGraph,
) -> Iterator[tuple[rosgraph.Interface, Section, rosgraph.Sending]]:
    """Yield each command with data: its interface, the section, and its sending."""
    for publisher in graph.publishers:
        yield from ((publisher.interface, Section.MESSAGE, sending) for sending in publisher.sendings)
    for service in graph.serviceClients:
        yield service.interface, Section.REQUEST, service.request
    for action in graph.actionClients:
        yield action.interface, Section.GOAL, action.request
    for served in graph.serviceServers:
        if served.response is not None:
            yield served.interface, Section.RESPONSE, served.response
    for performed in graph.actionServers:
        if performed.feedback is not None:
            yield performed.interface, Section.FEEDBACK, performed.feedback
        for end in (performed.response, performed.error, performed.canceled):
            if end is not None:
                yield performed.interface, Section.RESULT, end


def decides_with_data(graph: rosgraph.RosGraph) -> bool:
    """Return whether the supervisor decides on a command with its data."""
    return any(sending.inputs for _, _, sending in sent_messages(graph))


def sections(graph: rosgraph.RosGraph) -> dict[str, tuple[str, str, Section]]:
    """Return package, type and section of each event with data, by the name of the event.

    The error of a service has the data of an answer that cannot be read.
    """
    known = {
        event_name(reception.event): (interface.package, interface.type, section)
        for interface, section, several in received_messages(graph)
        for reception in several
    }
    known |= {
        event_name(sending.event): (interface.package, interface.type, section)
        for interface, section, sending in sent_messages(graph)
        if sending.inputs
    }
    answers = {event_name(client.error.event): event_name(client.response.event) for client in graph.serviceClients}
    return {**{error: known[answer] for error, answer in answers.items()}, **known}


def reads_elements(expression: ex.Expression) -> bool:
    """Return whether an expression reads array elements or partial operators, which can fail.

    The rules of enumerations are not considered, nor are values within `IfReadable`.
    """
    return any(
        isinstance(part, rosgraph.IndexStep | rosgraph.SliceStep) or _is_partial(part)
        for part in _unconditional(expression)
    )


def _unconditional(expression: ex.Expression) -> Iterator[ex.Located]:
    """Yield all parts of an expression except those within an `IfReadable`."""
    pending: list[ex.Located] = [expression]
    while pending:
        part = pending.pop()
        if not isinstance(part, rosgraph.IfReadable):
            yield part
            pending += [inside for _, inside in contents(part)]


def reads_parameters(conversion: rosgraph.Conversion) -> bool:
    """Return whether a rule of an enumeration reads a parameter, directly or through another enumeration."""
    for rule in conversion.rules:
        for _, part in tree(rule.condition):
            if isinstance(part, rosgraph.NodeVariableReference):
                return True
            if isinstance(part, rosgraph.ConversionCall) and reads_parameters(part.conversion):
                return True
    return False


def _is_partial(part: ex.Located) -> bool:
    row = operator_of(part) if isinstance(part, ex.FunctionCall) else None
    return row is not None and row.is_partial


def first_value(kind: ex.Type) -> Value:
    """Return the value of an input before any data: `false`, the first literal, or the integer nearest to zero."""
    match kind:
        case ex.EnumerationType():
            return kind.first or kind.enumeration.literals[0]
        case ex.IntegerType():
            return saturate(0, kind.minimum, kind.maximum)
    return False


def is_structured(kind: ex.Type) -> bool:
    """Return whether a type is an array or an object. Reports omit variables of these types."""
    return isinstance(kind, rosgraph.ArrayType | rosgraph.ObjectType)


def holds_objects(kind: ex.Type) -> bool:
    """Return whether a type is an object or an array of objects, which the node forwards unchanged."""
    if isinstance(kind, rosgraph.ArrayType):
        return kind.element is None or isinstance(kind.element, rosgraph.ObjectType)
    return isinstance(kind, rosgraph.ObjectType)


def source_of(access: rosgraph.WireAccess) -> rosgraph.NodeVariable | None:
    """Return the variable that an access reads, also within an element of an array; None for incoming data."""
    while access.quantifier is not None:
        access = access.quantifier.array
    return access.variable


def reads_stored(expression: ex.Expression) -> bool:
    """Return whether an expression reads variables that the node stores. Parameters do not count."""
    for _, part in tree(expression):
        variable = part.variable if isinstance(part, rosgraph.NodeVariableReference) else None
        if isinstance(part, rosgraph.WireAccess):
            variable = source_of(part)
        if variable is not None and not isinstance(variable, rosgraph.Parameter):
            return True
    return False


def reads_state(expression: ex.Expression) -> bool:
    """Return whether an expression reads more than data and parameters: stored data, or the supervisor's state."""
    references = (sct.LocationReference, sct.VariableReference)
    return reads_stored(expression) or any(isinstance(part, references) for _, part in tree(expression))


def path_of(access: rosgraph.WireAccess) -> Path:
    """Return the path of an access, with EACH if it may read any element of an array."""
    path: list[str] = [*path_of(access.quantifier.array), EACH] if access.quantifier else []
    sliced = False
    for step in access.steps:
        match step:
            case rosgraph.FieldStep():
                path.append(step.name)
            case rosgraph.IndexStep():
                path.append(EACH if sliced or step.position is not None else str(step.index))
        sliced = isinstance(step, rosgraph.SliceStep)
    return tuple(path)


def whole(value: ex.Expression) -> ex.Expression:
    """Return a value without its replacement for missing data."""
    return value.value if isinstance(value, rosgraph.IfReadable) else value


def origins(graph: rosgraph.RosGraph) -> dict[rosgraph.NodeVariable, dict[tuple[rosgraph.Reception, Path], None]]:
    """Return the incoming data, with the path in it, that each stored array or object may be a copy of.

    Copies of copies count, too.
    """
    known = {reception.event: reception for reception in receptions(graph)}
    stored = [
        (reaction.event, assignment.variable, value)
        for reaction in graph.reactions
        for assignment in reaction.assignments
        if is_structured(assignment.variable.type) and isinstance(value := whole(assignment.value), rosgraph.WireAccess)
    ]
    by_variable: dict[rosgraph.NodeVariable, dict[tuple[rosgraph.Reception, Path], None]] = {}
    changed = True
    while changed:
        changed = False
        for event, variable, access in stored:
            starts = by_variable.get(access.variable, {}) if access.variable else {(known[event], ()): None}
            places = {(reception, (*path, *path_of(access))): None for reception, path in starts}
            changed = changed or not places.keys() <= by_variable.get(variable, {}).keys()
            by_variable.setdefault(variable, {}).update(places)
    return {variable: places for variable, places in by_variable.items() if places}


def kept_reads(graph: rosgraph.RosGraph) -> Iterator[tuple[rosgraph.Reception, Path, MessageRead]]:
    """Yield the reads of stored data, as reads of the message that the data came in."""
    known = origins(graph)
    for _, part in tree(graph):
        if isinstance(part, rosgraph.WireAccess | rosgraph.ConversionCall):
            access = part.argument if isinstance(part, rosgraph.ConversionCall) else part
            variable = source_of(access)
            conversion = part.conversion if isinstance(part, rosgraph.ConversionCall) else None
            kind, inside = access.type, path_of(access)
            if isinstance(kind, rosgraph.ArrayType) and conversion is None:
                kind, inside = kind.element, (*inside, EACH)
            for reception, path in known.get(variable, ()) if variable else ():
                yield reception, (*path, *inside), MessageRead(part, kind, conversion)


def reads_reason(values: Iterable[ex.Expression]) -> bool:
    """Return whether an expression reads the failure reason of a service or action."""
    return any(isinstance(part, rosgraph.ErrorReason) for value in values for _, part in tree(value))


def reads(values: Iterable[ex.Expression]) -> Iterator[tuple[Path, MessageRead]]:
    """Yield the paths of a message that expressions read. The argument of a conversion is one read, its conversion.

    A stored object counts as a read of all its known fields: they may be read or sent later.
    """
    for value in map(whole, values):
        owner = value.eContainer()
        if isinstance(owner, rosgraph.IfReadable):
            owner = owner.eContainer()
        stored_type = owner.variable.type if isinstance(owner, rosgraph.NodeAssignment) else None
        if (
            isinstance(value, rosgraph.WireAccess)
            and value.variable is None
            and stored_type
            and holds_objects(stored_type)
        ):
            for inside, kind in parts_of(stored_type):
                path = (*path_of(value), *inside)
                yield path, MessageRead(value if EACH in path else access_to(path, type(kind)()), kind)
        argument = None
        for _, part in tree(value):
            if isinstance(part, rosgraph.ConversionCall):
                argument = part.argument
                if source_of(argument) is None:
                    yield path_of(argument), MessageRead(part, conversion=part.conversion)
            elif isinstance(part, rosgraph.WireAccess) and part is not argument and source_of(part) is None:
                if isinstance(part.type, rosgraph.ArrayType):
                    yield (*path_of(part), EACH), MessageRead(part, part.type.element)
                else:
                    yield path_of(part), MessageRead(part, part.type)


def parts_of(kind: ex.Type | None, path: Path = ()) -> Iterator[tuple[Path, ex.Type]]:
    """Yield the known basic values of a type at the end of a path: the path to each, and its type."""
    if isinstance(kind, rosgraph.ArrayType):
        inner = parts_of(kind.element, path[1:])
        yield from inner if path else (((EACH, *way), part) for way, part in inner)
    elif isinstance(kind, rosgraph.ObjectType):
        for field in kind.fields:
            if path:
                yield from parts_of(field.type, path[1:]) if field.name == path[0] else ()
            else:
                yield from (((field.name, *way), part) for way, part in parts_of(field.type))
    elif kind is not None:
        yield (), kind


def access_to(path: Path, kind: ex.Type | None = None) -> rosgraph.WireAccess:
    """Return the expression that reads the value at a path of a message."""
    steps: list[rosgraph.WireStep] = [
        rosgraph.IndexStep(index=int(step)) if step.isdigit() else rosgraph.FieldStep(name=step) for step in path
    ]
    return rosgraph.WireAccess(steps=steps, type=kind)


def logged_data(values: Iterable[ex.Expression]) -> Shown:
    """Return the data that expressions read, as the event log shows it.

    A read of an element at any position shows the whole array.
    """
    reads_by_path: dict[Path, MessageRead] = {}
    for path, message_read in reads(values):
        if path not in reads_by_path or not reads_by_path[path].is_value:
            reads_by_path[path] = message_read
    objects = [path for path, message_read in reads_by_path.items() if not message_read.is_value]
    for path in objects:
        if any(other[: len(path)] == path for other in reads_by_path if other != path):
            del reads_by_path[path]  # something is read of it
    return _in_arrays(reads_by_path)


def _in_arrays(reads_by_path: dict[Path, MessageRead]) -> Shown:
    arrays = {path[: path.index(EACH)] for path in reads_by_path if EACH in path}
    nested: Shown = {}
    elements: dict[Path, dict[Path, MessageRead]] = {}
    for path, message_read in reads_by_path.items():
        array = next((path[:length] for length in range(len(path)) if path[:length] in arrays), None)
        if array is None:
            nested[path] = message_read
        else:
            nested.setdefault(array, {})
            rest = tuple(EACH if step.isdigit() else step for step in path[len(array) + 1 :])
            elements.setdefault(array, {}).setdefault(rest, message_read)
    for array, inside in elements.items():
        nested[array] = _in_arrays(inside)
    return nested


def fields_set(sending: rosgraph.Sending) -> list[rosgraph.FieldAssignment]:
    """Return the assignments of provided data and of limits, in the order of the model."""
    return [field for data in (sending.alternatives, sending.limits) for one in data for field in one.fields]


def limit_expressions(sending: rosgraph.Sending) -> list[ex.Expression]:
    """Return the conditions and values of the limits of a message."""
    fields = [field for limit in sending.limits for field in limit.fields]
    conditions = [*(limit.condition for limit in sending.limits), *(field.condition for field in fields)]
    return [*(condition for condition in conditions if condition is not None), *(field.value for field in fields)]


def sent_values(sending: rosgraph.Sending) -> list[ex.Expression]:
    """Return the conditions and values of provided data and of limits."""
    fields = [field for data in sending.alternatives for field in data.fields]
    parts = [part for field in fields for part in (field.condition, field.value)]
    return [*(part for part in parts if part is not None), *limit_expressions(sending)]


def is_constant(sending: rosgraph.Sending) -> bool:
    """Return whether `provide` statements always give a command the same data. Limits do not count."""
    if len(sending.alternatives) > 1:
        return False
    literals = (ex.BooleanLiteral, ex.IntegerLiteral, ex.DoubleLiteral, ex.StringLiteral)
    constants = (*literals, ex.UnaryMinus, ex.DoubleConversion, rosgraph.ArrayLiteral)
    fields = [field for data in sending.alternatives for field in data.fields]
    return all(
        field.condition is None and all(isinstance(part, constants) for part in _expressions(field.value))
        for field in fields
    )


def _expressions(value: ex.Expression) -> Iterator[ex.Expression]:
    return (part for _, part in tree(value) if isinstance(part, ex.Expression))


def paths_set(sending: rosgraph.Sending) -> list[Path]:
    """Return the fields that the model sets, in the order of the model; `()` is the whole message."""
    return list(dict.fromkeys(tuple(field.path) for field in fields_set(sending)))


def doubles_read(sending: rosgraph.Sending) -> list[Path]:
    """Return the paths of the doubles that the limits and the inputs of a command read, each once."""
    paths: dict[Path, None] = {}
    for expression in [*limit_expressions(sending), *(assignment.value for assignment in sending.inputs)]:
        for _, part in tree(expression):
            if isinstance(part, rosgraph.WireAccess) and source_of(part) is None:
                path, kind = path_of(part), part.type
                if isinstance(kind, rosgraph.ArrayType):
                    path, kind = (*path, EACH), kind.element
                if isinstance(kind, ex.DoubleType):
                    paths[path] = None
    return list(paths)


def stored_doubles(sending: rosgraph.Sending) -> dict[str, ex.Expression]:
    """Return the stored doubles, and arrays of them, that the limits of a message read, by their names."""
    stored: dict[str, ex.Expression] = {}
    for _, part in (inner for expression in limit_expressions(sending) for inner in tree(expression)):
        if isinstance(part, rosgraph.NodeVariableReference) and not isinstance(part.variable, rosgraph.Parameter):
            variable = part.variable
            path: Path = ()
            kind: ex.Type | None = variable.type
        elif isinstance(part, rosgraph.WireAccess) and part.variable is not None and not operands(part):
            variable, path, kind = part.variable, path_of(part), part.type
        else:
            continue
        kind = kind.element if isinstance(kind, rosgraph.ArrayType) else kind
        if isinstance(kind, ex.DoubleType):
            stored[".".join((variable.component or "", variable.name, *path))] = part
    return stored


def parts_with_headers(sending: rosgraph.Sending) -> list[tuple[str, ...]]:
    """Return the paths of all parts on the way to fields that the model sets, sorted; `()` is the whole message.

    A goal with `pose.pose.position.x` has `pose`, `pose.pose` and `pose.pose.position`: each part with a field `header`
    gets the time and the frame. A part is left out if provided data sets a field of its `header`.
    """
    paths = paths_set(sending)
    parts = {()} | {path[:length] for path in paths for length in range(1, len(path))}
    provided = (tuple(field.path) for data in sending.alternatives for field in data.fields)
    with_header = {path[: path.index("header")] for path in provided if "header" in path}
    return sorted(part for part in parts - with_header if "header" not in part)


def find_message(graph: rosgraph.RosGraph, name: str) -> rosgraph.Sending | None:
    """Return the message that the node sends with this name or `Component.name`; None unless there is exactly one."""
    sendings = [sending for publisher in graph.publishers for sending in publisher.sendings]
    matches = [sending for sending in sendings if name in (sending.name, sending.event.eContainer().origin)]
    return matches[0] if len(matches) == 1 else None
