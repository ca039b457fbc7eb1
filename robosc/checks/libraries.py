"""What a robot or library imports."""

from __future__ import annotations

from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from robosc.checks.facts import fact, keeping_facts
from robosc.checks.rule import Finding, on_line
from robosc.semantics.expansion import constant_value
from robosc.semantics.instances import Instances, imported, libraries

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from robosc.checks.mending import Hint
    from robosc.metamodel import expression as ex
    from robosc.metamodel import robosc as rsc
    from robosc.semantics.evaluation import Value
    from robosc.semantics.instances import Instance, Resolved

    #: Says whether a robot or library by itself has what a rule looks for.
    Holds = Callable[[rsc.Base], bool]


@dataclass
class _Memory:
    """What the rules have found out about the bases of one check, each of which most of them look at."""

    instances: dict[rsc.Base, Instances] = field(default_factory=dict)
    resolved: Resolved = field(default_factory=dict)
    reachable: dict[tuple[rsc.Base, Holds], Cell | None] = field(default_factory=dict)


@dataclass(frozen=True)
class Cell:
    """A list that several lists go on with: a library, and what comes after it."""

    library: rsc.Library
    after: Cell | None


_MEMORY: ContextVar[_Memory] = ContextVar("_MEMORY")


@contextmanager
def remembering() -> Iterator[None]:
    """Within the `with` block no model changes, so that what is found out of one holds until the end."""
    token = _MEMORY.set(_Memory())
    try:
        with keeping_facts():
            yield
    finally:
        _MEMORY.reset(token)


def _memory() -> _Memory:
    return _MEMORY.get(None) or _Memory()


def instances(base: rsc.Base) -> Instances:
    """The instances of a robot or library."""
    memory = _memory()
    if base not in memory.instances:
        memory.instances[base] = Instances(base, memory.resolved)
    return memory.instances[base]


@dataclass(frozen=True)
class Meaning:
    """The text of a robot or library; or that of a template, as an instance of it means it by its arguments."""

    definitions: Sequence[rsc.Definition]
    made: Instance | None = None

    def values(self, *expressions: ex.Expression | None) -> list[Value | None]:
        """The value of each constant expression, None where it has none.

        An instance has values only where arguments take part: of all others the template's own text has them.
        """
        alone = [constant_value(expression) for expression in expressions]
        if self.made is None or None not in alone:
            return alone if self.made is None else [None] * len(alone)
        return [constant_value(expression, self.made) for expression in expressions]

    def finding(self, element: ex.Located, message: str, hint: Hint) -> Finding:
        """Found at an element; what the arguments of an instance lead to is found there."""
        if self.made is None:
            return Finding(element, message, hint)
        message = f"with these arguments, {message}{on_line(element)}"
        return Finding(self.made.component, message, "give other arguments", related=element)


def meanings(base: rsc.Base) -> Iterator[Meaning]:
    """The text of a robot or library, then that of each component in it that is made with arguments."""
    yield Meaning(base.definitions)
    for instance in instances(base):
        if instance.arguments:
            yield Meaning([instance.definition], instance)


def imports(base: rsc.Base) -> list[tuple[rsc.Component, rsc.Library]]:
    """Each imported component with its library, in the order of the text; unresolved libraries are left out."""
    return fact(imported, base)


def anything(_: rsc.Base) -> bool:
    """Any library will do."""
    return True


def reachable(base: rsc.Base, holds: Holds = anything) -> list[rsc.Library]:
    """Every library that the base's imports reach, each once, without the base itself: those for which `holds` is true.

    The near ones come first. In a chain of imports the libraries of each base are those of the next one and it: only
    where a base imports several libraries all are visited anew.
    """
    known = _memory().reachable
    chain: list[tuple[rsc.Base, rsc.Library]] = []
    found: Cell | None = None
    current, passed = base, {base}
    while (current, holds) not in known:
        direct = list(dict.fromkeys(library for _, library in imports(current)))
        if len(direct) == 1 and direct[0] not in passed:
            chain.append((current, direct[0]))
            current = direct[0]
            passed.add(current)
            continue
        for library in reversed(libraries(current, imports)):
            found = Cell(library, found) if fact(holds, library) else found
        known[current, holds] = found
    found = known[current, holds]
    for importing, library in reversed(chain):
        found = known[importing, holds] = Cell(library, found) if fact(holds, library) else found
    return [library for library in dict.fromkeys(_each(found)) if library is not base]


def _each(cell: Cell | None) -> Iterable[rsc.Library]:
    while cell is not None:
        yield cell.library
        cell = cell.after
