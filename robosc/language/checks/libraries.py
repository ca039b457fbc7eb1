"""Imports of a robot or library."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.base.cache import cached
from robosc.language.checks.rule import Finding, on_line
from robosc.model.semantics.expansion import constant_value
from robosc.model.semantics.instances import Instances, imported_components, libraries

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from robosc.language.checks.edits import Hint
    from robosc.model import expression as ex
    from robosc.model import robosc as rsc
    from robosc.model.semantics.evaluation import Value
    from robosc.model.semantics.instances import Instance

    #: Predicate on a robot or library by itself.
    Holds = Callable[[rsc.Base], bool]


@dataclass(frozen=True)
class Cell:
    """Linked list of libraries. Several lists may share their end."""

    library: rsc.Library
    after: Cell | None


def instances(base: rsc.Base) -> Instances:
    """Return the instances of a robot or library."""
    return cached((Instances, base), lambda: Instances(base, cached("resolved", dict)))


@dataclass(frozen=True)
class Meaning:
    """Text of a robot or library, or text of a template with the arguments of one instance."""

    definitions: Sequence[rsc.Definition]
    instance: Instance | None = None

    def values(self, *expressions: ex.Expression | None) -> list[Value | None]:
        """Return the value of each constant expression; None if it has none.

        For an instance, only expressions that depend on arguments have values. The others get theirs from the
        template's own text.
        """
        alone = [constant_value(expression) for expression in expressions]
        if self.instance is None or None not in alone:
            return alone if self.instance is None else [None] * len(alone)
        return [constant_value(expression, self.instance) for expression in expressions]

    def finding(self, element: ex.Located, message: str, hint: Hint) -> Finding:
        """Return a finding at an element. If arguments of an instance cause it, the place is the instance."""
        if self.instance is None:
            return Finding(element, message, hint)
        message = f"with these arguments, {message}{on_line(element)}"
        return Finding(self.instance.component, message, "change the arguments", related=element)


def meanings(base: rsc.Base) -> Iterator[Meaning]:
    """Yield the text of a robot or library, then that of each of its components with arguments."""
    yield Meaning(base.definitions)
    for instance in instances(base):
        if instance.arguments:
            yield Meaning([instance.definition], instance)


def imports(base: rsc.Base) -> list[tuple[rsc.Component, rsc.Library]]:
    """Return each imported component with its library, in the order of the text, without unresolved libraries."""
    return cached((imported_components, base), lambda: imported_components(base))


def anything(_: rsc.Base) -> bool:
    """Accept every library."""
    return True


def reachable(base: rsc.Base, holds: Holds = anything) -> list[rsc.Library]:
    """Return every library reachable by imports from the base that satisfies `holds`, without the base itself.

    Each library occurs once, the near ones first. In a chain of imports, the libraries of a base are the next library
    and the libraries of that one. All libraries are visited again only if a base imports several.
    """
    known: dict[tuple[rsc.Base, Holds], Cell | None] = cached(Cell, dict)
    chain: list[tuple[rsc.Base, rsc.Library]] = []

    def satisfies(library: rsc.Library) -> bool:
        return cached((holds, library), lambda: holds(library))

    cell: Cell | None = None
    current, passed = base, {base}
    while (current, holds) not in known:
        direct = list(dict.fromkeys(library for _, library in imports(current)))
        if len(direct) == 1 and direct[0] not in passed:
            chain.append((current, direct[0]))
            current = direct[0]
            passed.add(current)
            continue
        for library in reversed(libraries(current, imports)):
            cell = Cell(library, cell) if satisfies(library) else cell
        known[current, holds] = cell
    cell = known[current, holds]
    for importing, library in reversed(chain):
        cell = known[importing, holds] = Cell(library, cell) if satisfies(library) else cell
    return [library for library in dict.fromkeys(_each(cell)) if library is not base]


def _each(cell: Cell | None) -> Iterable[rsc.Library]:
    while cell is not None:
        yield cell.library
        cell = cell.after
