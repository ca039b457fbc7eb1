"""Which names can be used where: the scoping rules of the language reference, and what skipped text may declare."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, field
from enum import Enum, auto
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from robosc.metamodel import robosc as rsc
from robosc.semantics.instances import Instances, definition_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from robosc.diagnostics import Diagnostic, Span
    from robosc.language.building import Name
    from robosc.language.text import Text
    from robosc.semantics.instances import Resolved

#: Elements by name; where a name is declared twice, the first one counts (the uniqueness rules report the second).
Names: TypeAlias = "Mapping[str, Any]"


def by_name(elements: Iterable[Any]) -> dict[str, Any]:
    """The elements by their names."""
    names: dict[str, Any] = {}
    for element in elements:
        names.setdefault(element.name, element)
    return names


class Declared(Enum):
    """What a declaration gives a name to."""

    COMPONENT = auto()
    INTERFACE = auto()
    DATA_TYPE = auto()
    PROPERTY = auto()
    ENUM_VALUE = auto()
    COMMUNICATION = auto()
    MEMBER = auto()  # a variable or a state
    NAMED = auto()  # a constant, a parameter, a condition or a function


#: Definitions that an expression reads by their names.
NAMED_VALUES = (rsc.Constant, rsc.Parameter, rsc.Condition)


@dataclass
class SkippedRegions:
    """The names that skipped text seems to declare, and where it stands.

    `nameless` are the kinds of which a declaration was skipped whose name can't be seen, and where; `mended` says
    whether braces had to be added or taken away. `skipped` are the ranges of the text that were skipped,
    `uncertain` those of items that are whole, but that something unknown follows (offsets, the end exclusive).
    """

    names: set[str] = field(default_factory=set)
    nameless: list[tuple[Declared, Span]] = field(default_factory=list)
    mended: bool = False
    skipped: list[tuple[int, int]] = field(default_factory=list)
    uncertain: list[tuple[int, int]] = field(default_factory=list)

    def may_declare(self, name: str, kinds: tuple[Declared, ...], within: Span | None = None) -> bool:
        """Whether a name of one of these kinds that is not found may be declared in skipped text.

        Only a declaration within a definition can declare a member of it, unless braces were mended: then nobody knows
        what was meant to stand where.
        """
        if name in self.names:
            return True
        span = None if self.mended else within
        return any(kind in kinds and (span is None or span.contains(place)) for kind, place in self.nameless)

    def is_uncertain(self, offset: int) -> bool:
        """Whether an offset lies in an item that is followed by text that could not be read and may belong to it."""
        return any(start <= offset < end for start, end in self.uncertain)


@dataclass(frozen=True)
class Reference:
    """A name in a text: where it stands (offsets, the end exclusive) and the element that it stands for.

    `target` is None where the name is not resolved. Its `source` is its whole declaration; the reference that
    `is_declaration` is the name in there. `user` is the element whose `feature` refers.
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
    """One file that was read: its text, and what could be read of it.

    `base` is None where not even the first line could be read. `references` has where names stand that refer to
    something, by element and feature, `declared_names` where the names of elements stand.
    """

    text: Text
    base: rsc.Base | None
    references: dict[Any, dict[str, Name]] = field(default_factory=dict)
    declared_names: Mapping[Any, Name] = field(default_factory=dict)
    #: The types whose bounds are expressions.
    bounded: list[rsc.IntegerDataType] = field(default_factory=list)
    regions: SkippedRegions = field(default_factory=SkippedRegions)
    #: The library that every model knows; None where the file names nothing of it.
    predefined: File | None = None
    #: The files of the libraries that it imports from, by the libraries' names; None: none that can be used.
    libraries: dict[str, File | None] = field(default_factory=dict)
    #: The faults of the text itself, in order.
    findings: list[Diagnostic] = field(default_factory=list)

    @cached_property
    def names(self) -> list[Reference]:
        """All names in the text that stand for something, in order; those in skipped text are not known."""
        found = [Reference(name.text, name.start, name.end, element) for element, name in self.declared_names.items()]
        found += (
            Reference(name.text, name.start, name.end, getattr(element, feature), element, feature)
            for element, names in self.references.items()
            for feature, name in names.items()
        )
        return sorted(found, key=lambda name: name.start)

    def occurrences(self, element: Any) -> list[Reference]:
        """Where the text declares and names an element, in order."""
        return [name for name in self.names if name.target is element]

    def name_at(self, offset: int) -> Reference | None:
        """The name that an offset lies in or right behind; None where there is none."""
        after = bisect_right(self.names, offset, key=lambda name: name.start)
        found = self.names[after - 1] if after else None
        return found if found is not None and offset <= found.end else None

    @property
    def skipped(self) -> list[tuple[int, int]]:
        """The ranges of the text that no element was made of because of their faults: offsets, in order."""
        return sorted(self.regions.skipped)

    @cached_property
    def declared(self) -> Mapping[type[Any], Names]:
        """What other places can name, by its kind."""
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
        """The enum values by name, of each enum the first with it."""
        found: dict[str, list[rsc.EnumValue]] = {}
        for definition in self.base.definitions if self.base is not None else ():
            if isinstance(definition, rsc.EnumDataType):
                for name, value in by_name(rule.value for rule in definition.rules if rule.value).items():
                    found.setdefault(name, []).append(value)
        return found

    def may_declare(self, name: str, *kinds: Declared, imported: bool = True) -> bool:
        """Whether a name that is not found may be declared by text that could not be read.

        That is text of this file or, if `imported`, of a library that it imports from.
        """
        if self.regions.may_declare(name, kinds):
            return True
        files = self._files if imported else ()
        return any(None in file.libraries.values() or file.regions.may_declare(name, kinds) for file in files)

    def may_declare_within(self, definition: rsc.Definition, name: str, kind: Declared) -> bool:
        """Whether a definition, of this file or of a library, may declare a name in text that could not be read."""
        regions = self._file_of[definition.eContainer()].regions
        return regions.may_declare(name, (kind,), definition.source.span if definition.source else None)

    @cached_property
    def _files(self) -> list[File]:
        """The file itself and those of all that it imports, directly or through others, and the predefined one."""
        found, pending = {self: None}, [self]
        while pending:
            current = pending.pop()
            libraries = [*current.libraries.values(), current.predefined]
            imported = [file for file in libraries if file is not None and file not in found]
            found |= dict.fromkeys(imported)
            pending += imported
        return list(found)

    @cached_property
    def _file_of(self) -> dict[rsc.Base | None, File]:
        return {file.base: file for file in self._files}


class _Content(NamedTuple):
    """What a component declares, by name."""

    communications: Names
    members: Names
    states: Names
    functions: Names


_NOTHING = _Content({}, {}, {}, {})


class Scope:
    """The names of one robot or library, whose imports are linked already."""

    def __init__(self, file: File, base: rsc.Base, resolved: Resolved | None = None) -> None:
        self.components: Names = file.declared[rsc.Component]
        self._file = file
        self._imports = [library for library in file.libraries.values() if library is not None]
        self._predefined = [] if file.predefined is None else [file.predefined]
        self._instances = Instances(base, resolved)
        self._contents: dict[rsc.Component, _Content | None] = {}
        #: Whether a component is imported of which nothing is known.
        self.incomplete = any(self.members(component) is None for component in self.components.values())

    def find(self, kind: type[Any], name: str) -> list[tuple[File, Any]]:
        """The definitions of a kind with a name, with their files.

        They are the own one, else those of imported libraries, else the predefined one.
        """
        own = self._file.declared[kind].get(name)
        if own is not None:
            return [(self._file, own)]
        for libraries in (self._imports, self._predefined):
            found = [(library, library.declared[kind][name]) for library in libraries if name in library.declared[kind]]
            if found:
                return found
        return []

    def values(self, name: str) -> list[rsc.EnumValue]:
        """The enum values with a name, of each enum the first: those of the own file, else of imported libraries."""
        own = self._file.enum_values.get(name)
        return own or [value for library in self._imports for value in library.enum_values.get(name, ())]

    def usable(self, kind: type[Any]) -> list[str]:
        """The names of all definitions of a kind that can be used, imported ones included."""
        return [name for file in (self._file, *self._imports) for name in file.declared[kind]]

    def members(self, component: rsc.Component) -> Names | None:
        """The variables and states of a component; None where its import is broken."""
        content = self._content(component)
        return None if content is None else content.members

    def functions(self, component: rsc.Component) -> Names:
        """The functions of a component; empty where its import is broken."""
        return (self._content(component) or _NOTHING).functions

    def states(self, component: rsc.Component) -> Names:
        """The states of a component; empty where its import is broken."""
        return (self._content(component) or _NOTHING).states

    def communications(self, component: rsc.Component) -> Names | None:
        """The communications of a component; None where its import is broken."""
        content = self._content(component)
        return None if content is None else content.communications

    def _content(self, component: rsc.Component) -> _Content | None:
        if component not in self._contents:
            definition = definition_of(component)
            local = None if definition is None else definition.type
            self._contents[component] = _content(local) if isinstance(local, rsc.LocalComponent) else None
        return self._contents[component]

    def origin(self, component: rsc.Component) -> rsc.Component:
        """The component whose text declares the members of a component that is not broken."""
        return definition_of(component) or component

    def communicating(self, name: str) -> list[tuple[rsc.Component, rsc.CommunicationType]]:
        """Each component that has a communication of a name, and the communication."""
        return self._communicating.get(name, [])

    @cached_property
    def _communicating(self) -> dict[str, list[tuple[rsc.Component, rsc.CommunicationType]]]:
        found: dict[str, list[tuple[rsc.Component, rsc.CommunicationType]]] = {}
        for instance in self._instances:
            for name, communication in (self.communications(instance.component) or {}).items():
                found.setdefault(name, []).append((instance.component, communication))
        return found

    def all_communications(self) -> list[str]:
        """The names of the communications of all components."""
        return [name for instance in self._instances for name in self.communications(instance.component) or ()]


def _content(local: rsc.LocalComponent) -> _Content:
    # A component with two behaviours is an error of another rule; its names are still names.
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
