"""Completion proposals at an offset of a text: words of the language, and names by the kind of their reference.

The grammar determines the words that it accepts there. To determine the names, the text is read with an unused name
at the offset, and the missing rest of the definition around it is added. Every element to which this name could refer
is a proposal.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from robosc.language.grammar import Failure, parse, pattern
from robosc.language.interface_types import is_made, ros_properties
from robosc.language.name_findings import first_instance
from robosc.language.outline import Outline
from robosc.language.scopes import by_name
from robosc.language.surroundings import Surroundings
from robosc.language.tokens import Kind, Tokens, too_complex
from robosc.model import robosc as rsc
from robosc.model.reflection import literals
from robosc.model.semantics.communication import (
    LASTING,
    RUNNING_WORD,
    data_type,
    event_names,
    feedback_event,
    sending_event,
    sent_type,
)
from robosc.model.semantics.failures import FAILURE, FAILURES, reasons
from robosc.model.semantics.naming import ROBOSC_QUANTIFIERS, TEXT_FUNCTION, escape_keyword
from robosc.model.semantics.operators import FUNCTIONS
from robosc.model.semantics.typing import ObjectType, access_types, object_value_type, value_type

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from robosc.base.ros_types import RosTypes
    from robosc.language.outline import Block
    from robosc.language.reading import Reading

#: Declarations that can have the type `Failure`.
_KEEPS = (rsc.Variable, rsc.Constant, rsc.FormalParameter, rsc.Function)
_NAME = "robosc_completes_here"
#: The word before an offset, matched on the reversed text.
_WORD = re.compile(r"\w*\^?")
_STRING_OR_COMMENT = re.compile(rf"{pattern('Comment')}|{pattern('String')}|/\*[\s\S]*|[\"'][^\n]*")
#: Start of a topic name, in the declaration of a communication or in the `with` clause of an import.
_TOPIC = re.compile(r"""(?:\bidentifier|\bimport\b.*\bwith\s*\{[^}]*)\s*:\s*(["'])([^"']*)\Z""")
#: Words that are keywords only before the name of a template.
_BEFORE_TEMPLATE = re.compile(rf"(?<![\w^])(?:{'|'.join((*ROBOSC_QUANTIFIERS, 'each'))})\s+\Z")
#: Words that continue an incomplete definition, best first, and the text inserted for each.
_GOING_ON = {
    **{word: word for word in ("needs", "disables", "with", "from", "import", "use", "to", "then", "else", "in", "->")},
    **{symbol: symbol for symbol in (")", "]", "}", ":", ":=", "=", "..")},
    "=(?!>)": "=",
    **{word: word for word in ("boolean", "true", "s", "never", "type", "request", "response", "feedback", "state")},
    "UnreservedName": "x",
    "Name": "x",
    "LoneString": '""',
    "String": '""',
    "Integer": "1",
    **{word: word for word in ("object", "message", "since", "most", "default", "identifier", "after", "(", "{")},
}


@dataclass(frozen=True)
class Proposal:
    """A completion proposal: its text, and its element if it is a name.

    `starts` marks a word of the language that begins a definition.
    """

    text: str
    element: Any = None
    starts: bool = False
    is_ros: bool = False


def proposals(
    content: str,
    offset: int,
    read_text: Callable[[str], Reading],
    ros_types: RosTypes,
    libraries: Callable[[], Iterable[str]],
) -> tuple[int, int, list[Proposal]]:
    """Return the range (offsets) of the word at or right before an offset, and the proposals that can replace it.

    `read` reads the file with another text. `libraries` returns the names of the libraries that it could import from.
    """
    start = offset - len(_WORD.match(content[:offset][::-1])[0])  # type: ignore[index]
    end = offset + len(re.match(r"\w*", content[offset:])[0])  # type: ignore[index]
    if any(match.start() < start < _end(match) for match in _STRING_OR_COMMENT.finditer(content)):
        return start, end, []
    block, expected = _expected_words(content[:start])
    results = dict.fromkeys(_words(block, expected))
    if {"Name", "UnreservedName"} & expected or _BEFORE_TEMPLATE.search(content[:start]):
        for text in dict.fromkeys(_with_name(content, start, end)):
            results |= dict.fromkeys(_named(read_text(text), start, ros_types, libraries))
    results |= dict.fromkeys(_ros_names(content, start, ros_types))
    return start, end, list(results)


def topic_at(content: str, offset: int) -> tuple[int, int] | None:
    """Return the range of the name of a topic, service or action around an offset, or None.

    The range excludes the quotes.
    """
    before = _TOPIC.search(content[content.rfind("\n", 0, offset) + 1 : offset])
    if before is None:
        return None
    behind = re.match(rf"[^{before[1]}\n]*(?={before[1]})|", content[offset:])
    return offset - len(before[2]), offset + (behind.end() if behind else 0)


def _end(match: re.Match[str]) -> int:
    """Return the offset behind a string or comment; one that reaches the end of its line includes that end."""
    is_open = match[0].startswith("//") or not match[0].endswith(("*/", '"', "'")) or len(match[0]) == 1
    return match.end() + is_open


# Words


def _expected_words(before: str) -> tuple[Block | None, set[str]]:
    """Return the item in which a text ends, and the words and rules that the grammar accepts there."""
    tokens = Tokens(before)
    if too_complex(tokens) is not None:
        return None, set()
    block = _block(tokens, len(tokens))
    items = block.items
    text = list(before[block.start :])
    for item in items:
        text[item.start - block.start : item.end - block.start] = " " * (item.end - item.start)
    own = "".join(text)
    parsed = parse(f"{own} \0", block.level.rule if block.level else "Base")
    at_end = isinstance(parsed, Failure) and parsed.position >= len(own.rstrip())
    return block, set(parsed.expected) if at_end else set()


def _block(tokens: Tokens, index: int) -> Block:
    """Return the innermost item that contains a token or ends right before it."""
    block = Outline(tokens).file()
    while True:
        inner = next((item for item in block.items if item.first < index <= item.after), None)
        if inner is None:
            return block
        block = inner


def _words(block: Block | None, expected: Iterable[str]) -> Iterator[Proposal]:
    for word in sorted(expected):
        if word.isalpha() and word.islower() and word != "end":
            yield Proposal(word, starts=bool(block and any(word in level.starters for level in _levels(block))))
        elif word == "Quantifier":
            yield from map(Proposal, literals(rsc.Quantifier))
        elif word == "BuiltIn":
            yield from map(Proposal, (*FUNCTIONS, TEXT_FUNCTION))
        elif word == "Each":
            yield Proposal("each")
        elif word == "FeedbackTo":
            yield Proposal("feedback")
    if "end" in expected and block is not None and block.level is not None:
        yield from (Proposal(word, starts=True) for word in sorted(block.level.starters))


def _levels(block: Block) -> list[Any]:
    inner = [] if block.level is None else list(block.level.bodies.values())
    return [*block.levels, *inner, *([block.level] if block.level else [])]


# Names


def _with_name(content: str, start: int, end: int) -> Iterator[str]:
    """Yield the text with a name at an offset and the missing rest behind it, once for each possible continuation."""
    before, after = content[:start] + _NAME, content[end:]
    tokens = Tokens(before + after)
    if too_complex(tokens) is not None:
        return
    block = _block(tokens, tokens.index_at(start) + 1)
    rule = block.level.rule if block.level else "Base"
    whole = _own_text(before + after, block)
    if not isinstance(parse(whole, rule), Failure):
        yield before + after
        return
    own = before[block.start :]
    for preferred in ("needs", "disables"):
        going_on = _going_on(_own_text(before, block, len(before)), rule, preferred)
        if going_on is not None:
            yield before + going_on + (content[end:] if block.level is None else _rest(before + after, block, own))


def _own_text(content: str, block: Block, end: int | None = None) -> str:
    text = list(content[block.start : block.end if end is None else end])
    for item in block.items:
        if item.end <= block.start + len(text):
            text[item.start - block.start : item.end - block.start] = " " * (item.end - item.start)
    return "".join(text)


def _rest(content: str, block: Block, own: str) -> str:
    """Return the text behind an item whose tail is omitted."""
    return " " + content[max(block.end, block.start + len(own)) :]


def _going_on(text: str, rule: str, preferred: str) -> str | None:
    """Return the missing rest of an item of a rule, or None if it cannot be determined."""
    added = ""
    for _ in range(20):
        parsed = parse(text + added, rule)
        if not isinstance(parsed, Failure):
            return added
        if parsed.position < len((text + added).rstrip()):
            return None
        expected = set(parsed.expected)
        words = {preferred: preferred, **_GOING_ON}
        following = next((phrase for word, phrase in words.items() if word in expected), None)
        if following is None:
            return None
        added += f" {following}"
    return None


def _named(
    reading: Reading, start: int, ros_types: RosTypes, libraries: Callable[[], Iterable[str]]
) -> Iterator[Proposal]:
    """Yield the proposals for the name at an offset."""
    file = reading.file
    if file.base is None:
        return
    surroundings = Surroundings(file)
    surroundings.open_scope()
    for element, names in list(file.references.items()):
        for feature, name in names.items():
            if _NAME in name.text and name.start <= start < name.end:
                if isinstance(element, rsc.ImportedComponent) and feature == "library":
                    yield from map(Proposal, libraries())
                for key, candidate in _candidates(surroundings, element, feature, names, ros_types):
                    yield Proposal(".".join(map(escape_keyword, key.split("."))), candidate)


def _candidates(
    surroundings: Surroundings, element: Any, feature: str, names: Mapping[str, Any], ros_types: RosTypes
) -> Iterator[tuple[str, Any]]:
    match element:
        case rsc.CommunicationReference():
            yield from _communications(surroundings, element, feature, names)
        case rsc.Access():
            yield from _accessible(surroundings, element, feature, names)
        case rsc.PropertySegment():
            access = element.eContainer()
            before = access_types(access, value_type(access))[list(access.segments).index(element)]
            yield from _properties(before, ros_types)
        case rsc.ObjectPropertyValue():
            yield from _properties(object_value_type(element.eContainer()), ros_types)
        case rsc.Transition():
            own = surroundings.around(element, rsc.Component)
            yield from (surroundings.scope.states(own) if own is not None else {}).items()
        case rsc.RequirementTransition():
            yield from by_name(element.eContainer().eContainer().states).items()
        case rsc.Argument():
            yield from _parameters(element).items()
        case _:
            yield from _definitions(surroundings, element, feature)


def _parameters(argument: rsc.Argument) -> dict[str, Any]:
    """Return the parameters that an argument can set, by name."""
    user: Any = argument.eContainer()
    made_of: Any = user.type if isinstance(user, rsc.ComplexDataTypeReference) else user.definition
    return {} if made_of is None else by_name(made_of.parameters)


def _definitions(surroundings: Surroundings, element: Any, feature: str) -> Iterator[tuple[str, Any]]:
    components = surroundings.file.declared[rsc.Component]
    match element:
        case rsc.ComplexDataTypeReference():
            yield from _usable(surroundings, rsc.ComplexDataType)
            if isinstance(element.eContainer(), _KEEPS):
                yield FAILURE, None
        case rsc.CommunicationType():
            yield from _usable(surroundings, rsc.Interface)
        case rsc.Call():
            yield from _usable(surroundings, rsc.Function)
        case rsc.ImportedComponent() if feature == "definition":
            yield from by_name(_components_of(element.library)).items()
        case rsc.InstantiatedComponent():
            yield from ((name, component) for name, component in components.items() if component.parameters)
        case rsc.InstanceQuantifier() | rsc.StatedDefinition():
            yield from ((name, component) for name, component in components.items() if component.parameters)
        case rsc.TopicRemapping():
            own = surroundings.around(element, rsc.Component)
            yield from ((surroundings.scope.communications(own) if own is not None else None) or {}).items()


def _components_of(library: Any) -> list[Any]:
    return (
        []
        if library is None
        else [definition for definition in library.definitions if isinstance(definition, rsc.Component)]
    )


def _usable(surroundings: Surroundings, kind: type[Any]) -> Iterator[tuple[str, Any]]:
    for name in dict.fromkeys(surroundings.scope.usable(kind)):
        yield name, surroundings.scope.find(kind, name)[0][1]


def _communications(
    surroundings: Surroundings, reference: rsc.CommunicationReference, feature: str, names: Mapping[str, Any]
) -> Iterator[tuple[str, Any]]:
    if feature == "communicationType" and "component" in names:
        component = reference.component
        communications = (surroundings.scope.communications(component) if component is not None else None) or {}
        yield from ((name, other) for name, other in communications.items() if _fits(reference, other))
        return
    own = surroundings.around(reference, rsc.Component)
    inner = (surroundings.scope.communications(own) if own is not None else None) or {}
    known: dict[str, list[tuple[Any, Any]]] = {name: [(own, other)] for name, other in inner.items()}
    for name in surroundings.scope.all_communications():
        known.setdefault(name, list(surroundings.scope.communicating(name)))
    for name, ports in known.items():
        for component, other in ports:
            if _fits(reference, other):
                is_alone = len(ports) == 1 and component.first is None
                yield name if is_alone else f"{first_instance(component)}.{name}", other


def _fits(reference: rsc.CommunicationReference, communication: Any) -> bool:
    """Return whether a communication has the event or data that the reference needs."""
    user = reference.eContainer()
    if isinstance(user, rsc.CommunicationTypeSet):
        user = user.eContainer()
    match user:
        case rsc.ResultTransition() | rsc.NamedEvent():
            return str(user.resultType) in event_names(communication)
        case rsc.ProvideStatement():
            row = feedback_event(communication) if user.feedback else sending_event(communication)
            return data_type(communication, row) is not None
        case rsc.LimitStatement():
            return isinstance(communication, rsc.Message) and sent_type(communication) is not None
        case rsc.CommunicationRequirement():
            return sending_event(communication) is not None
        case rsc.TimedTransition():
            return isinstance(communication, rsc.Message) and event_names(communication) == ["response"]
    return True


def _accessible(
    surroundings: Surroundings, access: rsc.Access, feature: str, names: Mapping[str, Any]
) -> Iterator[tuple[str, Any]]:
    first = names.get("component")
    if feature == "item" and first is not None:
        known = {**surroundings.components(access), **surroundings.templates(access)}
        if first.text in known:
            yield from (surroundings.scope.members(known[first.text]) or {}).items()
            yield from _running(surroundings, known[first.text])
        elif access.enumeration is not None:
            yield from by_name(rule.value for rule in access.enumeration.rules if rule.value).items()
        elif first.text in (automata := surroundings.automata(access)):
            yield from by_name(automata[first.text].states).items()
        return
    accessible: dict[str, Any] = {}
    if surroundings.expects_failure(access):
        accessible |= dict.fromkeys(_reasons(access))
    accessible |= {**surroundings.elements(access), **surroundings.parameters(access)}
    user = access.eContainer()
    if isinstance(user, rsc.Argument):
        accessible |= _parameters(user)
    elif surroundings.around(access, rsc.EnumDataType) is None:
        own = surroundings.around(access, rsc.Component)
        members = (surroundings.scope.members(own) if own is not None else None) or {}
        accessible |= {
            **surroundings.templates(access),
            **members,
            **surroundings.components(access),
            **surroundings.automata(access),
        }
        accessible |= dict(_running(surroundings, own)) if own is not None else {}
    for kind in (rsc.NamedExpression, rsc.EnumValue, rsc.Function):
        for name, element in _usable(surroundings, kind):
            accessible.setdefault(name, element)
    yield from accessible.items()


def _reasons(access: rsc.Access) -> Sequence[str]:
    """Return the reasons of an error that are valid here: those of the service or action, else all."""
    around: Any = access
    while around is not None and not isinstance(around, rsc.ResultTransition | rsc.RequirementTransition):
        around = around.eContainer()
    named = around.event if isinstance(around, rsc.RequirementTransition) else around
    reference = named.communicationType if named is not None else None
    return reasons(reference.communicationType if reference else None) or sorted(FAILURES)


def _running(surroundings: Surroundings, component: rsc.Component) -> Iterator[tuple[str, Any]]:
    """Yield the names that read whether a service or action of a component is running."""
    for name, communication in (surroundings.scope.communications(component) or {}).items():
        if isinstance(communication, LASTING):
            yield f"{name}.{RUNNING_WORD}", communication


def _properties(of: Any, ros_types: RosTypes) -> Iterator[tuple[str, Any]]:
    if isinstance(of, ObjectType):
        if is_made(of.definition):
            yield from ((name, None) for name in ros_properties(of.definition, ros_types))
        else:
            yield from by_name(of.definition.properties).items()


# Names of ROS


def _ros_names(content: str, start: int, ros_types: RosTypes) -> Iterator[Proposal]:
    """Yield packages and types that only ROS knows: in an interface, and behind the `/` of a type."""
    tokens = Tokens(content)
    index = tokens.index_at(start)
    before, earlier = (tokens[max(index - step, 0)] for step in (1, 2))
    if index < 2:
        return
    kinds = ("message", "service", "action")
    if before.is_keyword("/") and earlier.kind is Kind.WORD:
        yield from _types(ros_types, earlier.text, kinds)
    elif before.is_keyword("use"):
        package = next((tokens[at + 1].text for at in range(index, index + 3) if tokens[at].is_keyword("from")), None)
        if package is not None:
            yield from _types(ros_types, package, kinds)
    elif before.is_keyword("from") and any(tokens[max(index - step, 0)].is_keyword("use") for step in (2, 3)):
        for package in sorted({name for known in ros_types.distributions for name in known.packages()}):
            yield Proposal(package, is_ros=True)


def _types(ros_types: RosTypes, package: str, kinds: Iterable[str]) -> Iterator[Proposal]:
    names = {name for known in ros_types.distributions for kind in kinds for name in known.names(package, kind)}
    yield from (Proposal(name, is_ros=True) for name in sorted(names))
