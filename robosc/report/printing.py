"""Where generated code speaks of a requirement: generators write what it says beside its event.

That is a comment with the file of the model, in C and where a node in C++ sends. A node also has it where it sends all
the same, and as what it tells where the condition does not hold.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.m2t.c.comments import comment, string_literal
from robosc.m2t.ros.rendering import line_comment
from robosc.semantics.printing import remark

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robosc.metamodel import sct

#: How far comments are indented, and what makes a line one of a comment.
_INDENTS = (2, 4, 6)
_MARGINS = ("/* ", "* ", "// ")


class Sources:
    """What was generated, by path, in which requirements are looked up."""

    def __init__(self, outputs: Mapping[str, str]) -> None:
        self._files = {path: _File(text) for path, text in outputs.items() if path.endswith((".c", ".h", ".cpp"))}

    def places(self, requirement: sct.StatedRequirement) -> dict[str, list[int]]:
        """The files that cite the requirement, and the lines in which what cites it begins."""
        if not requirement.text:
            return {}
        said = remark(requirement)
        printed = [f"reasons.add_requirement({string_literal(requirement.text)});"]
        for indent in _INDENTS:
            printed += [comment([said], indent), line_comment(said, indent)]
            printed.append(line_comment(f"Overrides: {requirement.text}", indent))
        found = {
            path: sorted({line for text in printed for line in lines.places(text)})
            for path, lines in self._files.items()
        }
        return {path: lines for path, lines in found.items() if lines}


class _File:
    """The lines of a file, without margins, and their numbers by their text."""

    def __init__(self, text: str) -> None:
        lines = text.split("\n")
        self._bare = [_bare(line) for line in lines]
        self._numbers: dict[str, list[int]] = {}
        #: In which line a comment of C begins; every other line begins by itself.
        self._begins: list[int] = []
        for number, line in enumerate(lines):
            self._numbers.setdefault(self._bare[number], []).append(number)
            self._begins.append(self._begins[-1] if line.lstrip().startswith("* ") else number)

    def places(self, printed: str) -> list[int]:
        """Where all lines of what is printed stand one behind the other: the numbers, from 1."""
        lines = [_bare(line) for line in printed.split("\n")]
        return [
            self._begins[number] + 1
            for number in self._numbers.get(lines[0], ())
            if self._bare[number : number + len(lines)] == lines
        ]


def _bare(line: str) -> str:
    """A line without its indentation, and without what makes it one of a comment."""
    line = line.strip()
    margin = next((margin for margin in _MARGINS if line.startswith(margin)), "")
    return line.removeprefix(margin).removesuffix(" */")
