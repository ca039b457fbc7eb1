"""Usable names by place: the scoping rules of the language reference, and the names that skipped text may declare."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, field
from enum import Enum, auto
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from robosc.model import robosc as rsc
from robosc.model.semantics.instances import definition_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from robosc.base.diagnostics import Diagnostic, Span
    from robosc.language.builder import Name
    from robosc.language.text import Text

#: Elements by name. The first of several equal names counts (the uniqueness rules report the second).
Names: TypeAlias = "Mapping[str, Any]"


def by_name(elements: Iterable[Any]) -> dict[str, Any]:
    """Return the elements by their names."""
    names: dict[str, Any] = {}
    for element in elements:
        names.setdefault(element.name, element)
    return names


class NameKind(Enum):
    """Kind of a declared name."""

    COMPONENT = auto()
    INTERFACE = auto()
    DATA_TYPE = auto()
    PROPERTY = auto()
    ENUM_VALUE = auto()
    COMMUNICATION = auto()
    MEMBER = auto()  # a variable or a state
    NAMED = auto()  # a constant, a parameter, a condition or a function


#: Definitions whose names an expression can read.
NAMED_VALUES = (rsc.Constant, rsc.Parameter, rsc.Condition)


@dataclass
class SkippedRegions:
    """Ranges of skipped text and the names that it seems to declare.

    `nameless` lists skipped declarations whose name is unknown, by kind and place. `mended` is true if braces were
    added or removed. `skipped` are the skipped ranges, `uncertain` those of complete items that are followed by unknown
    text (offsets, the end exclusive).
    """

    names: set[str] = field(default_factory=set)
    nameless: list[tuple[NameKind, Span]] = field(default_factory=list)
    mended: bool = False
    skipped: list[tuple[int, int]] = field(default_factory=list)
    uncertain: list[tuple[int, int]] = field(default_factory=list)

    def may_declare(self, name: str, kinds: tuple[NameKind, ...], within: Span | None = None) -> bool:
        """Return whether skipped text may declare an unknown name of one of these kinds.

        Only a declaration within a definition can declare a member of it. If braces were mended, the intended nesting
        is unknown, and any skipped text counts.
        """
        if name in self.names:
            return True
        span = None if self.mended else within
        return any(kind in kinds and (span is None or span.contains(place)) for kind, place in self.nameless)

    def is_uncertain(self, offset: int) -> bool:
        """Return whether an offset lies in an item whose end is uncertain, because unreadable text follows it."""
        return any(start <= offset < end for start, end in self.uncertain)


@dataclass(frozen=True)
class Reference:
    """A name in a text: its offsets (the end exclusive) and the element that it refers to.

    `target` is None if the name is not resolved. The `source` of a target is its whole declaration; the reference with
    `is_declaration` is the name in this declaration. `user` is the element whose `feature` refers to the target.
    """

    name: str
    start: int
    end: int
    target: Any
    user: Any = None
    feature: str = ""

    @property
    def is_declaration(self) -> bool:
        """Whether this is the name in the declaration of its target."""
        return self.user is None


@dataclass(eq=False)
class File:
    """One file that was read: its text, and the model of its readable parts.

    `base` is None if the first line is unreadable. `references` maps element and feature to the referring name,
    `declared_names` maps elements to the names in their declarations.
    """

    text: Text
    base: rsc.Base | None
    references: dict[Any, dict[str, Name]] = field(default_factory=dict)
    declared_names: Mapping[Any, Name] = field(default_factory=dict)
    #: Types whose bounds are expressions.
    bounded: list[rsc.IntegerDataType] = field(default_factory=list)
    regions: SkippedRegions = field(default_factory=SkippedRegions)
    #: The predefined library; None if the file does not use it.
    predefined: File | None = None
    #: Files of the imported libraries by the libraries' names; None for a library that cannot be used.
    libraries: dict[str, File | None] = field(default_factory=dict)
    #: Faults of the text itself, in order.
    findings: list[Diagnostic] = field(default_factory=list)

    @cached_property
    def names(self) -> list[Reference]:
        """All names in the text that refer to an element, in order; skipped text is not included."""
        references = [
            Reference(name.text, name.start, name.end, element) for element, name in self.declared_names.items()
        ]
        references += (
            Reference(name.text, name.start, name.end, getattr(element, feature), element, feature)
            for element, names in self.references.items()
            for feature, name in names.items()
        )
        return sorted(references, key=lambda name: name.start)

    def occurrences(self, element: Any) -> list[Reference]:
        """Return the references of the text to an element, including its declaration, in order."""
        return [name for name in self.names if name.target is element]

    def name_at(self, offset: int) -> Reference | None:
        """Return the name that contains an offset or ends at it, or None if there is none."""
        after = bisect_right(self.names, offset, key=lambda name: name.start)
        candidate = self.names[after - 1] if after else None
        return candidate if candidate is not None and offset <= candidate.end else None

    @property
    def skipped(self) -> list[tuple[int, int]]:
        """Ranges of the text that were skipped because of their faults: offsets, in order."""
        return sorted(self.regions.skipped)

    @cached_property
    def declared(self) -> Mapping[type[Any], Names]:
        """Definitions and enum values that other places can name, by kind and name."""
        definitions = self.base.definitions if self.base is not None else ()
        kinds = (rsc.Component, rsc.ComplexDataType, rsc.Interface, rsc.Function)
        enums = [definition for definition in definitions if isinstance(definition, rsc.EnumDataType)]
        return {
            **{
                kind: by_name(definition for definition in definitions if isinstance(definition, kind))
                for kind in kinds
            },
            rsc.NamedExpression: by_name(
                definition for definition in definitions if isinstance(definition, NAMED_VALUES)
            ),
            rsc.EnumValue: by_name(rule.value for enum in enums for rule in enum.rules if rule.value),
        }

    @cached_property
    def enum_values(self) -> Mapping[str, list[rsc.EnumValue]]:
        """Enum values by name: from each enum the first value with that name."""
        values: dict[str, list[rsc.EnumValue]] = {}
        for definition in self.base.definitions if self.base is not None else ():
            if isinstance(definition, rsc.EnumDataType):
                for name, value in by_name(rule.value for rule in definition.rules if rule.value).items():
                    values.setdefault(name, []).append(value)
        return values

    def may_declare(self, name: str, *kinds: NameKind, imported: bool = True) -> bool:
        """Return whether unreadable text may declare an unknown name.

        The text can be in this file or, if `imported`, in a library that it imports from.
        """
        if self.regions.may_declare(name, kinds):
            return True
        files = self._files if imported else ()
        return any(None in file.libraries.values() or file.regions.may_declare(name, kinds) for file in files)

    def may_declare_within(self, definition: rsc.Definition, name: str, kind: NameKind) -> bool:
        """Return whether unreadable text of a definition, in this file or a library, may declare a name."""
        regions = self._file_of[definition.eContainer()].regions
        return regions.may_declare(name, (kind,), definition.source.span if definition.source else None)

    @cached_property
    def _files(self) -> list[File]:
        """The file itself, all files that it imports directly or indirectly, and the predefined library."""
        reached, pending = {self: None}, [self]
        while pending:
            current = pending.pop()
            libraries = [*current.libraries.values(), current.predefined]
            imported = [file for file in libraries if file is not None and file not in reached]
            reached |= dict.fromkeys(imported)
            pending += imported
        return list(reached)

    @cached_property
    def _file_of(self) -> dict[rsc.Base | None, File]:
        return {file.base: file for file in self._files}


class _Content(NamedTuple):
    """Declarations of a component by name."""

    communications: Names
    members: Names
    states: Names
    functions: Names


_NOTHING = _Content({}, {}, {}, {})


class Scope:
    """Names of one robot or library whose imports are linked."""

    def __init__(self, file: File, base: rsc.Base) -> None:
        self.components: Names = file.declared[rsc.Component]
        self._file = file
        self._imports = [library for library in file.libraries.values() if library is not None]
        self._predefined = [] if file.predefined is None else [file.predefined]
        # A component with the name of another one counts, too.
        self._parts = [
            definition
            for definition in base.definitions
            if isinstance(definition, rsc.Component) and not definition.parameters
        ]
        self._contents: dict[rsc.Component, _Content | None] = {}
        #: Whether an imported component is unknown.
        self.incomplete = any(self.members(component) is None for component in self.components.values())

    def find(self, kind: type[Any], name: str) -> list[tuple[File, Any]]:
        """Return the definitions of a kind with a name, with their files.

        The own definition takes precedence over those of imported libraries, and these over the predefined one.
        """
        own = self._file.declared[kind].get(name)
        if own is not None:
            return [(self._file, own)]
        for libraries in (self._imports, self._predefined):
            definitions = [
                (library, library.declared[kind][name]) for library in libraries if name in library.declared[kind]
            ]
            if definitions:
                return definitions
        return []

    def values(self, name: str) -> list[rsc.EnumValue]:
        """Return the enum values with a name, one per enum: those of the own file, else those of imported libraries."""
        own = self._file.enum_values.get(name)
        return own or [value for library in self._imports for value in library.enum_values.get(name, ())]

    def usable(self, kind: type[Any]) -> list[str]:
        """Return the names of all usable definitions of a kind, imported ones included."""
        return [name for file in (self._file, *self._imports) for name in file.declared[kind]]

    def members(self, component: rsc.Component) -> Names | None:
        """Return the variables and states of a component, or None if its import is broken."""
        content = self._content(component)
        return None if content is None else content.members

    def functions(self, component: rsc.Component) -> Names:
        """Return the functions of a component; empty if its import is broken."""
        return (self._content(component) or _NOTHING).functions

    def states(self, component: rsc.Component) -> Names:
        """Return the states of a component; empty if its import is broken."""
        return (self._content(component) or _NOTHING).states

    def communications(self, component: rsc.Component) -> Names | None:
        """Return the communications of a component, or None if its import is broken."""
        content = self._content(component)
        return None if content is None else content.communications

    def _content(self, component: rsc.Component) -> _Content | None:
        if component not in self._contents:
            definition = definition_of(component)
            local = None if definition is None else definition.type
            self._contents[component] = _content(local) if isinstance(local, rsc.LocalComponent) else None
        return self._contents[component]

    def origin(self, component: rsc.Component) -> rsc.Component:
        """Return the component whose text declares the members of a component with an intact import."""
        return definition_of(component) or component

    def communicating(self, name: str) -> list[tuple[rsc.Component, rsc.CommunicationType]]:
        """Return each component that has a communication of a name, with the communication."""
        return self._communicating.get(name, [])

    @cached_property
    def _communicating(self) -> dict[str, list[tuple[rsc.Component, rsc.CommunicationType]]]:
        by_name: dict[str, list[tuple[rsc.Component, rsc.CommunicationType]]] = {}
        for component in self._parts:
            for name, communication in (self.communications(component) or {}).items():
                by_name.setdefault(name, []).append((component, communication))
        return by_name

    def all_communications(self) -> list[str]:
        """Return the names of the communications of all components."""
        return [name for component in self._parts for name in self.communications(component) or ()]


def _content(local: rsc.LocalComponent) -> _Content:
    # Another rule reports a component with two behaviours; the names of both are usable.
    behaviours = [part for part in local.definitions if isinstance(part, rsc.ComponentBehaviour)]
    definitions = [definition for behaviour in behaviours for definition in behaviour.automaton.definitions]
    states = [definition for definition in definitions if isinstance(definition, rsc.State)]
    variables = [definition for definition in definitions if isinstance(definition, rsc.Variable)]
    named = [definition for definition in local.definitions if isinstance(definition, NAMED_VALUES)]
    return _Content(
        by_name(part for part in local.definitions if isinstance(part, rsc.CommunicationType)),
        by_name([*variables, *states, *named]),
        by_name(states),
        by_name(part for part in local.definitions if isinstance(part, rsc.Function)),
    )
