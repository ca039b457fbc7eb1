"""Findings about names without an element, and their hints."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.base.diagnostics import Repair
from robosc.language.surroundings import Surroundings
from robosc.language.syntax_messages import did_you_mean
from robosc.model.semantics.expansion import constant_value
from robosc.model.semantics.instances import instance_text
from robosc.model.semantics.naming import enumeration, escape_keyword

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from robosc.base.diagnostics import Diagnostic
    from robosc.language.builder import Name
    from robosc.language.scopes import File
    from robosc.model import robosc as rsc

RULE = "unresolved-reference"
#: Maximum number of names that a hint lists.
_FEW = 6
IMPORT = "import it: "
#: Minimum length of a name for the import hint: shorter names are parts of too many others.
_SHORTEST = 4


class NameFindings(Surroundings):
    """Findings about names without an element, with hints to the names that may be meant."""

    def __init__(self, file: File, importable: Callable[[], Mapping[str, str]]) -> None:
        super().__init__(file)
        self.findings: list[Diagnostic] = []
        self._importable = importable

    def _missing(
        self,
        name: Name,
        message: str,
        known: Iterable[str],
        hint: Repair | str | None = None,
        *,
        listed: bool = True,
    ) -> None:
        names = list(dict.fromkeys(known))
        repair = hint or did_you_mean(name.text, names, cutoff=0.6)
        if repair is None and listed and 0 < len(names) <= _FEW:
            texts = tuple(escape_keyword(other) for other in names)
            repair = Repair(f"there is {enumeration(f'`{text}`' for text in texts)}", choices=texts)
        self._report(name, f"{message} `{name.text}`", repair)

    def _report(self, name: Name, message: str, repair: Repair | str | None = None, rule: str = RULE) -> None:
        if not self.file.regions.is_uncertain(name.start):
            self.findings.append(self.file.text.error(rule, name.start, name.end, message, repair))

    def _ambiguous(self, what: str, name: Name, files: Iterable[File]) -> None:
        libraries = " and ".join(f"`{file.base.name}`" for file in files if file.base)
        message = f"{what} `{name.text}` is declared by the libraries {libraries}"
        self._report(name, message, f"declare `{name.text}` in this file")

    def _made_of(self, name: Name) -> Repair | None:
        """Return the repair that replaces the name of a template of the robot by the name of an instance."""
        template = None if self._is_library else self.scope.components.get(name.text)
        if template is None:
            return None
        choice, texts = self._instances_text(template)
        return Repair(f"`{escape_keyword(template.name)}` is a template: write {choice}", choices=texts)

    def _member_text(self, name: Name) -> Repair | None:
        """Return the repair that writes `Cell[2]` for `Cell2`, if `Cell` is a fleet."""
        fleet = self.scope.components.get(name.text.rstrip("0123456789"))
        if self._is_library or fleet is None or fleet.first is None or fleet.name == name.text:
            return None
        text = instance_text(fleet, int(name.text[len(fleet.name) :]))
        return Repair(f"write `{text}`", text)

    def _import_of(self, name: Name, known: Iterable[str]) -> str | None:
        """Return the import that may be missing; None if a known name is close or no library has the component."""
        if self._is_library or len(name.text) < _SHORTEST or did_you_mean(name.text, known, cutoff=0.6):
            return None
        word, importable = name.text.lower(), self._importable()
        like = [component for component in importable if word in component.lower() or component.lower() in word]
        component = min(like, key=lambda other: (abs(len(other) - len(word)), other), default=None)
        if component is None:
            return None
        library = escape_keyword(importable[component])
        return f"{IMPORT}`component {escape_keyword(name.text)} from {library} import {escape_keyword(component)}`"

    def _instances_text(self, template: rsc.Component) -> tuple[str, tuple[str, ...]]:
        """Return the instances of a template, or of a new component, as a phrase and as texts."""
        texts = [first_instance(part) for part in self._parts.values() if self.scope.origin(part) is template]
        choice, choices = first_few(texts or [f"component other is {escape_keyword(template.name)}(…)"])
        return choice, choices if texts else ()


def first_instance(component: rsc.Component) -> str:
    """Return the text that names a component, or the first instance of a fleet."""
    first = constant_value(component.first)
    return instance_text(component, max(first, 0) if type(first) is int else None)


def first_few(texts: Iterable[str]) -> tuple[str, tuple[str, ...]]:
    """Return the possible replacements of a name, as a phrase and as texts, at most `_FEW` of them."""
    texts = tuple(dict.fromkeys(texts))
    shown = [f"`{text}`" for text in texts[:_FEW]]
    others = len(texts) - len(shown)
    return enumeration([*shown, *([f"that of {others} more"] if others else [])]), texts[:_FEW]
