"""Parses a file; where it has faults, all that it can."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from robosc.language.building import Builder
from robosc.language.grammar import Failure, parse

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robosc.diagnostics import Diagnostic
    from robosc.language.building import Name
    from robosc.language.text import Text
    from robosc.metamodel import robosc as rsc


@dataclass(frozen=True)
class Parsed:
    """The model of a text, its names not linked.

    `references`: the names by element and feature; `unread`: names that skipped text seems to declare.
    """

    base: rsc.Base | None
    references: Mapping[Any, Mapping[str, Name]] = field(default_factory=dict)
    findings: list[Diagnostic] = field(default_factory=list)
    unread: frozenset[str] = frozenset()


def parse_file(text: Text) -> Parsed:
    """Parses the text of a file."""
    tree = parse(text.content, "Base")
    if isinstance(tree, Failure):
        message = f"expected {' or '.join(tree.expected)}"
        return Parsed(None, findings=[text.error("syntax", tree.position, tree.position + 1, message)])
    builder = Builder(text)
    return Parsed(builder.build(tree), builder.references, builder.findings)
