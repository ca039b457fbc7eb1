"""Markdown descriptions of model elements: declaration, type, and effect on the robot."""

from __future__ import annotations

import re
from textwrap import dedent
from typing import TYPE_CHECKING, Any

from robosc.base.ros_types import DefinitionError, Section
from robosc.language.document_symbols import span
from robosc.language.interface_types import is_made
from robosc.model import expression as ex
from robosc.model import robosc as rsc
from robosc.model import sct
from robosc.model.semantics.communication import SERVED, carrying_events, event_of, events, ros_kind, section_of
from robosc.model.semantics.expansion import constant_value
from robosc.model.semantics.instances import fleet_numbers, instance_text
from robosc.model.semantics.naming import enumeration

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.base.ros_types import RosTypes
    from robosc.language.reading import Reading
    from robosc.language.scopes import File, Reference

#: Limits of a description: lines of a declaration, fields of a ROS type.
_LINES, _FIELDS = 12, 40


def describe(reading: Reading, element: Any, ros_types: RosTypes) -> str | None:
    """Return the description of an element that a name in a reading refers to, or None if there is none."""
    if element is None:
        return None
    if isinstance(element, rsc.ObjectProperty) and is_made(element.eContainer()):
        declared = element.type
        return f"```robosc\n{element.name}: {type_text(declared)}\n```\nA field of the ROS type {_ros_name(element)}."
    if isinstance(element, rsc.FormalParameter) and element.source is None:
        return f"```robosc\n{element.name}: {type_text(element.type)}\n```\nThe number of the instance of the fleet."
    file = _file_of(reading, element)
    if file is None:
        return None
    reference = element if isinstance(element, rsc.InterfaceTypeReference) else element.eContainer()
    if isinstance(reference, rsc.InterfaceTypeReference):
        return ros_definition(reference.package, reference.rosType, section_of(reference), ros_types)
    parts = [f"```robosc\n{_declaration(file, element)}\n```"]
    comment = file.text.comment_above(span(file, element)[0])
    if comment:
        parts.append(comment)
    parts += _meaning(reading, file, element)
    if isinstance(element, rsc.Interface):
        parts += [
            definition
            for section in Section
            for definition in [ros_definition(element.package, element.type, section, ros_types)]
            if definition is not None
        ]
    if file is not reading.file and file.base is not None:
        parts.append(f"From library `{file.base.name}`.")
    return "\n\n".join(parts)


def summary(element: Any) -> str:
    """Return a short description of an element: its type if it has one, else its kind."""
    declared = getattr(element, "type", None)
    if isinstance(declared, rsc.DataType) and not isinstance(element, rsc.EnumDataType):
        return type_text(declared)
    if isinstance(element, rsc.EnumValue):
        return f"value of {element.eContainer().eContainer().name}"
    words = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", type(element).__name__).lower()
    return words.removesuffix(" data type").removeprefix("formal ")


def event_text(transition: rsc.Transition, file: File) -> str:
    """Return the trigger of a transition, such as `response from scan`."""
    match transition:
        case rsc.ResultTransition():
            reference = transition.communicationType
            named = _source(file, reference) if reference is not None else "…"
            return f"{transition.resultType} {direction(transition)} {named}"
        case rsc.TimedTransition():
            without = ", ".join(_source(file, reference) for reference in transition.without)
            time = f"after {_source(file, transition.duration)} {transition.unit}"
            return f"{time} without {without}" if without else time
    return "by itself"


def direction(transition: rsc.ResultTransition) -> str:
    """Return the preposition between an event's name and its communication."""
    row = event_of(transition.communicationType, transition.resultType)
    is_sent = transition.resultType == rsc.ResultType.request if row is None else row.is_sent
    return "to" if is_sent or (row is not None and row.kind == sct.EventKind.cancel) else "from"


def type_text(declared: rsc.DataType | None) -> str:
    """Return a data type as a text declares it."""
    match declared:
        case rsc.Array():
            return f"array({type_text(declared.type)})"
        case rsc.InterfaceTypeReference():
            return f"{declared.package}/{declared.rosType}"
        case rsc.ComplexDataTypeReference():
            return str(declared.type.name) if declared.type is not None else "…"
        case rsc.IntegerDataType() if declared.minimum is not None and declared.maximum is not None:
            return f"integer({declared.minimum}..{declared.maximum})"
        case None:
            return "…"
    return str(type(declared).__name__).removesuffix("DataType").lower()


def ros_definition(package: str, name: str, section: Section, ros_types: RosTypes) -> str | None:
    """Return the fields of a section of a ROS type, or None if the type is unknown."""
    for distribution in ros_types.distributions:
        try:
            fields = distribution.fields(package, name, section)
        except DefinitionError:
            continue
        if fields is not None:
            lines = [f"{wire} {field}" for field, wire in fields.items()]
            shown = "\n".join([*lines[:_FIELDS], *(["…"] if len(lines) > _FIELDS else [])])
            part = "" if section is Section.MESSAGE else f", its {section.name.lower()}"
            return f"`{package}/{name}`{part}, as {distribution.name} defines it:\n```\n{shown}\n```"
    return None


def _ros_name(element: rsc.ObjectProperty) -> str:
    reference = element.eContainer().eContainer()
    return f"`{reference.package}/{reference.rosType}`"


def _file_of(reading: Reading, element: Any) -> File | None:
    if getattr(element, "source", None) is None or element.source.file is None:
        return None
    return reading.files.get(element.source.file.path)


def _source(file: File, element: Any) -> str:
    """Return the text of an element in one line."""
    if element is None or element.source is None:
        return "…"
    start, end = span(file, element)
    return " ".join(file.text.content[start:end].split())


def _declaration(file: File, element: Any) -> str:
    start, end = span(file, element)
    content = file.text.content
    line = content.rfind("\n", 0, start) + 1
    lead = " " * (start - line)
    lines = dedent(lead + content[start:end]).split("\n")
    if isinstance(element, rsc.Base):
        return f"{lines[0].rstrip()} … }}"
    return "\n".join(lines if len(lines) <= _LINES else [*lines[:_LINES], "…"])


def _uses(reading: Reading, element: Any) -> Iterator[tuple[File, Reference]]:
    for file in reading.files.values():
        yield from ((file, name) for name in file.names if name.target is element and not name.is_declaration)


def _meaning(reading: Reading, file: File, element: Any) -> Iterator[str]:  # noqa: C901 - a case a class
    match element:
        case rsc.State():
            yield from _state(reading, file, element)
        case rsc.RequirementState():
            yield _flags(element, "of the requirement")
        case rsc.Variable():
            assigned = [
                f"line {use_file.text.span(name.start, name.end).line}"
                for use_file, name in _uses(reading, element)
                if isinstance(name.user.eContainer(), rsc.Assignment) and name.user.eContainer().item is name.user
            ]
            yield f"Variable of `{_component_name(element)}`, " + (
                f"assigned in {enumeration(dict.fromkeys(assigned)).replace(' or ', ' and ')}."
                if assigned
                else "never assigned."
            )
        case rsc.CommunicationType():
            yield from _communication(file, element)
            yield from _restricted(reading, element)
        case rsc.Constant():
            value = constant_value(element.value)
            yield "Constant" + ("." if value is None else f", `{_value_text(value)}`.")
        case rsc.Parameter():
            yield "Parameter of the robot, a ROS parameter of its node. The value is its default."
        case rsc.Condition():
            yield "Condition: a name for its expression."
        case rsc.EnumDataType():
            values = dict.fromkeys(f"`{rule.value.name}`" for rule in element.rules if rule.value)
            if values:
                yield f"Converts data of type `{type_text(element.type)}` into {enumeration(values)}."
        case rsc.EnumValue():
            rule = element.eContainer()
            when = (
                f"where `{_source(file, rule.condition)}`" if hasattr(rule, "condition") else "if no other rule holds"
            )
            yield f"Value of enum `{rule.eContainer().name}`: {when}."
        case rsc.Component():
            yield from _component(element)
        case rsc.StatedDefinition():
            yield _statements(file, element)


def _component(component: rsc.Component) -> Iterator[str]:
    numbers = fleet_numbers(component)
    if component.parameters:
        yield "Template: components use it with `is` or `import`."
    elif numbers:
        ends = dict.fromkeys(f"`{instance_text(component, number)}`" for number in (numbers[0], numbers[-1]))
        yield f"Fleet of {len(numbers):,} instance{'s' * (len(numbers) > 1)}: {' … '.join(ends)}."


def _state(reading: Reading, file: File, state: rsc.State) -> Iterator[str]:
    yield _flags(state, f"of `{_component_name(state)}`")
    leaving = [
        f"{event_text(transition, file)} → `{transition.target.name}`"
        for transition in state.transitions
        if transition.target is not None
    ]
    if leaving:
        yield "Left on:\n" + "\n".join(f"- {line}" for line in leaving)
    reached = []
    for use_file, name in _uses(reading, state):
        if isinstance(name.user, rsc.Transition) and name.feature == "target":
            around = name.user.eContainer()
            source = f"`{around.name}`" if isinstance(around, rsc.State) else "any state"
            reached.append(f"{event_text(name.user, use_file)}, from {source}")
    if reached:
        yield "Reached on:\n" + "\n".join(f"- {line}" for line in reached)


def _flags(state: Any, owner: str) -> str:
    words = [word for word, is_set in (("initial", state.initial), ("marked", state.marked)) if is_set]
    phrase = f"{' and '.join(words).capitalize()} state" if words else "State"
    marked = ": the supervisor ensures that a marked state can always be reached" if state.marked else ""
    return f"{phrase} {owner}{marked}."


def _communication(file: File, communication: rsc.CommunicationType) -> Iterator[str]:
    if isinstance(communication, rsc.Message):
        incoming = communication.direction == rsc.MessageDirection.incoming
        yield (
            "Message to the robot's nodes. The controller decides when to send it; requirements can forbid it."
            if incoming
            else "Message from the robot's nodes, sent at any time. No requirement can prevent it."
        )
    elif isinstance(communication, SERVED):
        rows = enumeration(f"`{row.name} {row.preposition}`" for row in events(communication))
        yield (
            f"{ros_kind(communication).capitalize()} that the controller serves. Requirements can forbid its response."
            f" Its events are {rows}."
        )
    else:
        kind = "Service" if isinstance(communication, rsc.Service) else "Action"
        names = enumeration(f"`{row.name}`" for row in events(communication) if row.name)
        yield f"{kind} that the controller calls. Requirements can forbid the request. Its events are {names}."
    for row, declared in carrying_events(communication):
        if not isinstance(declared, rsc.NoneDataType):
            yield f"- data of its {row.name}: `{type_text(declared)}`"
    if communication.identifier:
        yield f"ROS name: `{communication.identifier}`."
    elif communication.computedIdentifier is not None:
        yield f"ROS name: `{_source(file, communication.computedIdentifier)}`."


def _restricted(reading: Reading, communication: rsc.CommunicationType) -> Iterator[str]:
    """List the requirements, assumptions and limits that mention a communication."""
    texts: dict[Any, str] = {}
    for file, name in _uses(reading, communication):
        around = name.user
        while around is not None and not isinstance(around, rsc.Requirement | rsc.Assumption | rsc.LimitStatement):
            around = around.eContainer()
        if around is not None:
            where = f"line {file.text.span(name.start, name.end).line}"
            if file is not reading.file and file.base is not None:
                where += f" of `{file.base.name}`"
            texts.setdefault(around, f"- `{_source(file, around)}`, {where}")
    if texts:
        yield "Restricted by:\n" + "\n".join(texts.values())


def _statements(file: File, element: Any) -> str:
    """Return the demand of a requirement, property or assumption as a sentence."""
    target = _source(file, getattr(element, "target", None)).strip("{} ")
    condition = _source(file, getattr(element, "condition", None))
    anchor = _source(file, getattr(element, "anchor", None))
    match element:
        case rsc.NeedsRequirement():
            return f"The supervisor lets `{target}` start only while `{condition}` holds."
        case rsc.DisablesRequirement():
            return f"The supervisor does not let `{target}` start while `{condition}` holds."
        case rsc.StateInvariant():
            never = element.kind == rsc.InvariantKind.never
            return f"The supervised robot is {'never' if never else 'always'} in a state in which `{condition}` holds."
        case rsc.OrderRequirement():
            fresh = f"since the last `{target}`" if element.each else "at least once"
            return f"`{target}` happens only after `{anchor}` has happened {fresh}."
        case rsc.CountRequirement():
            bound = _source(file, element.bound)
            return f"`{target}` happens at most {bound} times until `{anchor}` happens again."
        case rsc.AutomatonRequirement():
            return "An event that it names may happen only if its current state has a transition for it."
        case rsc.Assumption():
            return f"The robot causes `{target}` only while `{condition}` holds. The node checks this."
        case rsc.InvariantProperty():
            never = element.kind == rsc.InvariantKind.never
            return f"`verify` proves that `{condition}` {'never' if never else 'always'} holds, or refutes it."
    premise = _source(file, element.premise) if element.premise is not None else None
    start = "every state" if premise is None else f"every state with `{premise}`"
    if isinstance(element, rsc.ReachabilityRequirement):
        return f"From {start}, the supervised robot can reach a state with `{condition}`."
    return f"`verify` proves that from {start}, a state with `{condition}` can be reached, or refutes it."


def _component_name(element: Any) -> str:
    around = element
    while around is not None and not isinstance(around, rsc.Component):
        around = around.eContainer()
    return "…" if around is None else str(around.name)


def _value_text(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return str(getattr(value, "name", value)) if isinstance(value, ex.NamedElement) else repr(value).replace("'", '"')
