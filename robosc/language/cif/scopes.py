"""Names of a specification: groups, automata, instances of definitions, and their declarations.

`Specification` declares all names and creates every instance of a definition. An instance is a scope like a group or an
automaton, but its names are looked up around the definition. A declaration is a `Declaration`. The element behind a
parameter is looked up around the instance.
"""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TypeAlias

from robosc.base.diagnostics import Repair
from robosc.language.cif.faults import CifFaultError, construct, place_of
from robosc.language.cif.parsing import identifier
from robosc.language.syntax_messages import closest, offer_name
from robosc.model import sct

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from robosc.base.diagnostics import Diagnostic
    from robosc.model import expression as ex

#: Kinds of automata that restrict the plants instead of being one.
RESTRICTIONS = ("requirement", "supervisor")
#: Maximum number of groups, automata and instances of a specification.
_MOST = 20_000
_LISTS = {
    "Inputs": "names",
    "Constants": "constants",
    "Algebraics": "variables",
    "Variables": "variables",
    "Types": "types",
}


@dataclass(eq=False)
class Declaration:
    """A named element; `kind` is the grammar rule of its declaration.

    `node` is its own object of the grammar. `outer` is the object of the statement that has its type. `element` is the
    element of the sct metamodel that was created for it.
    """

    kind: str
    name: str
    node: Any
    outer: Any
    scope: Scope
    element: Any = None
    #: Type of a variable or a channel.
    type: Any = None
    #: Fault for which a variable was not created.
    fault: Any = None


@dataclass(eq=False)
class Argument:
    """An argument of an instance: its expression, and the element that the expression names (`named`)."""

    node: Any
    scope: Scope
    parameter: Any
    named: Name | CifFaultError | None = None


@dataclass(eq=False)
class Scope:
    """A group, an automaton, or an instance of a definition; `kind` is the kind of an automaton, None for a group.

    `path` is its absolute name, and `around` the scope whose text contains it. `bodies` are the objects of the grammar
    with its contents: several files can contribute to one group.
    """

    path: str
    around: Scope | None
    node: Any
    kind: str | None = None
    bodies: list[Any] = field(default_factory=list)
    names: dict[str, Name] = field(default_factory=dict)
    children: list[Scope] = field(default_factory=list)
    events: list[Declaration] = field(default_factory=list)
    plant: sct.Plant | None = None
    definition: Any = None
    #: The enclosing scope by its absolute name.
    parent: Scope | None = None

    def absolute(self, name: str) -> str:
        """Return the absolute name of an element in the scope."""
        return f"{self.path}.{name}" if self.path else name

    def declarations(self, *rules: str) -> Iterator[Any]:
        """Yield the declarations of the scope by these rules of the grammar."""
        for body in self.bodies:
            for declaration in body.declarations:
                if type(declaration).__name__ in rules:
                    yield declaration


Name: TypeAlias = "Declaration | Argument | Scope | sct.Location | ex.EnumerationLiteral"


def plain(identifier: str) -> str:
    """Return an identifier without the dollar signs that distinguish it from keywords."""
    return identifier.replace("$", "")


def _similar_name(name: str, position: int, known: Iterable[str]) -> Repair | None:
    """Return the repair that replaces one part of a name by the closest known name, or None if none is close."""
    absolute = name[0] if name[0] in ".^" else ""
    parts = name.lstrip(".^").split(".")
    close = closest(parts[position], known, cutoff=0.7)
    if close is None:
        return None
    whole = absolute + ".".join([*parts[:position], close, *parts[position + 1 :]])
    return offer_name(identifier(whole))


class Specification:
    """All names of a specification. `findings` are the faults of their declarations."""

    def __init__(self) -> None:
        self.root = Scope("", None, None)
        #: The specification of the file that imports all others.
        self.first: Any = None
        self.findings: dict[Diagnostic, None] = {}
        self._instances: list[tuple[Any, Scope, Scope]] = []
        self._scopes = 0

    def add(self, specification: Any) -> None:
        """Declare the names of a file."""
        scope = self.root
        self.first = self.first or specification
        try:
            for declaration in specification.declarations:
                if type(declaration).__name__ == "Namespace":
                    for part in plain(declaration.name.text).lstrip(".^").split("."):
                        scope = self._inner(part, scope, declaration)
        except CifFaultError as fault:
            self.findings[fault.finding()] = None
            return  # Without its namespace, the file has no scope for its declarations.
        scope.bodies.append(specification)
        self._declare(scope, specification)

    def make_instances(self) -> None:
        """Declare the contents of the instances of definitions."""
        for node, around, scope in self._instances:  # `_instantiate` extends the list during the loop.
            with self.reporting():
                self._instantiate(node, around, scope)
        # The outermost instance comes first, so that each argument is looked up only once.
        for _, _, scope in self._instances:
            for argument in scope.around.names.values() if scope.around else ():
                if isinstance(argument, Argument) and not _is_algebraic(argument):
                    try:
                        argument.named = self.resolve(argument)
                    except CifFaultError as fault:
                        argument.named = fault

    @contextmanager
    def reporting(self) -> Iterator[None]:
        """Turn a fault within the block into a finding, one for all instances of a definition."""
        try:
            yield
        except CifFaultError as fault:
            self.findings[fault.finding()] = None

    def find(self, node: Any, scope: Scope) -> Name:
        """Return the element that a name of the grammar refers to in a scope. Raises CifFaultError."""
        return self.lookup(plain(node.text), node, scope)

    def lookup(self, name: str, node: Any, scope: Scope) -> Name:
        """Return the element that a name as text refers to in a scope. Raises CifFaultError."""
        first, *others = name.lstrip(".^").split(".")
        known: Scope | None = self._beginning(name, scope)
        named: Name | None = None
        seen: set[str] = set()
        while known is not None and named is None:
            named = known.names.get(first)
            seen.update(known.names)
            known = None if name[0] in ".^" else known.around
        if named is None:
            repair = _similar_name(name, 0, seen)
            if repair is None and name[0] == "." and first in self.root.names:
                repair = Repair(
                    f"in a definition, `.` starts there; from the root of the file, write `^{name[1:]}`", f"^{name[1:]}"
                )
            raise CifFaultError(node, "unresolved-reference", f"there is no `{first}` here", repair)
        whole = first
        for position, part in enumerate(others, 1):
            inside = self.resolve(named)
            if not isinstance(inside, Scope):
                raise CifFaultError(
                    node, "unresolved-reference", f"`{whole}` is neither a group nor an automaton: it has no members"
                )
            if part not in inside.names:
                message, repair = (
                    f"there is no `{part}` in `{inside.path}`",
                    _similar_name(name, position, inside.names),
                )
                raise CifFaultError(node, "unresolved-reference", message, repair)
            named, whole = inside.names[part], f"{whole}.{part}"
        return self.resolve(named)

    def _beginning(self, name: str, scope: Scope) -> Scope:
        """Return the scope in which the search for a name begins.

        That is the root for `^`, the definition around the scope (or the root) for `.`, and otherwise the scope itself.
        """
        if name[0] == "^":
            return self.root
        while name[0] == "." and scope.definition is None and scope.around is not None:
            scope = scope.around
        return scope

    def resolve(self, name: Name) -> Name:
        """Return the element behind a parameter that is not algebraic, through all instances."""
        while isinstance(name, Argument) and not _is_algebraic(name):
            if isinstance(name.named, CifFaultError):
                raise name.named
            if name.named is not None:
                return name.named
            value = name.node.first.value
            is_name = not name.node.others and not name.node.first.openings and not name.node.first.closings
            if not is_name or type(value).__name__ != "Reference" or value.suffixes:
                raise CifFaultError(name.node, "type", "the parameter expects a name")
            name = self.find(value.name, name.scope)
        return name

    # Declarations

    def _declare(self, scope: Scope, body: Any) -> None:
        for declaration in body.declarations:
            with self.reporting():
                self._declare_one(scope, declaration)

    def _declare_one(self, scope: Scope, node: Any) -> None:
        rule = type(node).__name__
        match rule:
            case "Group":
                group = self._inner(plain(node.name), scope, node)
                group.bodies.append(node)
                self._declare(group, node)
            case "Automaton":
                self._automaton(self._scope(plain(node.name), scope, node), node)
            case "Instance":
                instance = self._scope(plain(node.name), scope, node, bare=True)
                self._instances.append((node, scope, instance))
            case "Continuous":
                raise construct(node, "continuous variables", "use them only in simulation, or model time by events")
            case "Function":
                self._name(rule, node, node, scope)
            case _:
                self._declare_names(scope, node, rule)

    def _declare_names(self, scope: Scope, node: Any, rule: str) -> None:
        """Declare the named elements that are neither groups nor automata."""
        match rule:
            case "GroupDefinition" | "AutomatonDefinition" | "Enumeration":
                whole = self._name(rule, node, node, scope)
                for literal in node.literals if rule == "Enumeration" else ():
                    self._name("Literal", literal, whole, scope)
            case "Events":
                for name in node.names:
                    scope.events.append(self._name(rule, name, node, scope))
            case _ if rule in _LISTS:
                for declaration in getattr(node, _LISTS[rule]):
                    self._name(rule, declaration, node, scope)

    @staticmethod
    def _name(rule: str, node: Any, outer: Any, scope: Scope) -> Declaration:
        declared = Declaration(rule, plain(node.name), node, outer, scope)
        _once(scope, declared.name, node)
        scope.names[declared.name] = declared
        return declared

    def _inner(self, name: str, scope: Scope, node: Any) -> Scope:
        """Return the group of a name; contributions of several texts to one group are merged."""
        known = scope.names.get(name)
        if not isinstance(known, Scope) or known.kind is not None or known.definition is not None:
            known = self._scope(name, scope, node, bare=True)
        return known

    def _scope(self, name: str, scope: Scope, node: Any, *, bare: bool = False) -> Scope:
        _once(scope, name, node)
        inner = Scope(scope.absolute(name), scope, node, parent=scope)
        self._scopes += 1
        if self._scopes > _MOST:
            raise CifFaultError(node, "cif-construct", f"there are more than {_MOST} groups, automata and instances")
        scope.names[name] = inner
        scope.children.append(inner)
        if not bare:
            inner.bodies.append(node)
        return inner

    def _automaton(self, scope: Scope, node: Any) -> None:
        """Declare an automaton or an instance of one, including its locations, which are names too."""
        scope.kind = node.kind or ""
        plant_kind = sct.PlantKind.requirement if node.kind in RESTRICTIONS else sct.PlantKind.behaviour
        scope.plant = sct.Plant(name=scope.path, kind=plant_kind, source=place_of(scope.node))
        self._declare(scope, node)
        for number, location in enumerate(node.locations):
            name = plain(location.name) if location.name else "L"
            element = sct.Location(name=name, initial=False, marked=False, source=place_of(location))
            scope.plant.locations.append(element)
            if location.name:
                with self.reporting():
                    _once(scope, name, location)
                scope.names[name] = element
            elif len(node.locations) > 1:
                element.name = f"L{number}"
                with self.reporting():
                    message = "a location without a name is the only one"
                    raise CifFaultError(location, "cif-declaration", message, "write a name")

    def _instantiate(self, node: Any, around: Scope, scope: Scope) -> None:
        named = self.find(node.definition, around)
        if not isinstance(named, Declaration) or named.kind not in ("GroupDefinition", "AutomatonDefinition"):
            raise CifFaultError(node.definition, "type", f"`{node.definition.text}` is not a definition")
        definition = named.node
        inside: Scope | None = around
        while inside is not None:
            if inside.definition is definition:
                raise CifFaultError(node, "cyclic-definition", f"`{plain(definition.name)}` contains itself")
            inside = inside.parent
        parameters = [(parameter, name) for parameter in definition.parameters for name in parameter.names]
        if len(parameters) != len(node.arguments):
            expectation = f"{len(parameters)} argument{'' if len(parameters) == 1 else 's'}"
            raise CifFaultError(
                node, "argument", f"`{node.definition.text}` takes {expectation}, found {len(node.arguments)}"
            )
        scope.bodies.append(definition)
        scope.definition = definition
        # Names in the definition are looked up around the definition. Its parameters take precedence.
        inner = Scope(scope.path, named.scope, node)
        for (parameter, name), argument in zip(parameters, node.arguments, strict=True):
            inner.names[plain(name.name)] = Argument(argument, around, parameter)
        scope.around = inner
        if named.kind == "AutomatonDefinition":
            self._automaton(scope, definition)
        else:
            self._declare(scope, definition)


def _is_algebraic(argument: Argument) -> bool:
    return type(argument.parameter).__name__ == "AlgebraicParameter"


def _once(scope: Scope, name: str, node: Any) -> None:
    if name in scope.names:
        raise CifFaultError(node, "cif-declaration", f"the name `{name}` is declared twice", "rename one of them")
