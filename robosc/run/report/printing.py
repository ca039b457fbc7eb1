"""Places of a requirement in generated code: generators write its text beside its event.

It appears as a comment with the file of the model, in C and at each place where a C++ node sends. A node also cites it
where it sends regardless, and in the reason that it reports if the condition does not hold.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.m2t.c.comments import comment, string_literal
from robosc.m2t.ros.rendering import line_comment
from robosc.model.semantics.printing import remark

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robosc.model import sct

#: Indentations of comments, and margins of their lines.
_INDENTS = (2, 4, 6)
_MARGINS = ("/* ", "* ", "// ")


class Sources:
    """Generated files by path, for looking up requirements."""

    def __init__(self, outputs: Mapping[str, str]) -> None:
        self._files = {path: _File(text) for path, text in outputs.items() if path.endswith((".c", ".h", ".cpp"))}

    def places(self, requirement: sct.StatedRequirement) -> dict[str, list[int]]:
        """Return the files that cite a requirement, and the lines in which the citations begin."""
        if not requirement.text:
            return {}
        citation = remark(requirement)
        printed = [f"reasons.add_requirement({string_literal(requirement.text)});"]
        for indent in _INDENTS:
            printed += [comment([citation], indent), line_comment(citation, indent)]
            printed.append(line_comment(f"Overrides: {requirement.text}", indent))
        lines_by_path = {
            path: sorted({line for text in printed for line in lines.places(text)})
            for path, lines in self._files.items()
        }
        return {path: lines for path, lines in lines_by_path.items() if lines}


class _File:
    """The lines of a file without margins, and their numbers by their text."""

    def __init__(self, text: str) -> None:
        lines = text.split("\n")
        self._bare = [_bare(line) for line in lines]
        self._numbers: dict[str, list[int]] = {}
        #: First line of the comment of each line; a line outside of C comments begins by itself.
        self._begins: list[int] = []
        for number, line in enumerate(lines):
            self._numbers.setdefault(self._bare[number], []).append(number)
            self._begins.append(self._begins[-1] if line.lstrip().startswith("* ") else number)

    def places(self, printed: str) -> list[int]:
        """Return the numbers, from 1, of the places at which all lines of a printed text follow each other."""
        lines = [_bare(line) for line in printed.split("\n")]
        return [
            self._begins[number] + 1
            for number in self._numbers.get(lines[0], ())
            if self._bare[number : number + len(lines)] == lines
        ]


def _bare(line: str) -> str:
    """Return a line without its indentation and its comment margin."""
    line = line.strip()
    margin = next((margin for margin in _MARGINS if line.startswith(margin)), "")
    return line.removeprefix(margin).removesuffix(" */")
