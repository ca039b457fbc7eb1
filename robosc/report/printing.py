"""Where generated code speaks of a requirement: generators write what it says beside its event.

That is a comment in C, with the file of the model. A node in C++ has it in a comment where it sends, and as what it
tells where the condition does not hold.
"""

from __future__ import annotations

import re
from pathlib import PurePath
from typing import TYPE_CHECKING

from robosc.m2t.c.comments import comment_text, string_literal
from robosc.m2t.ros.rendering import line_comment

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robosc.metamodel import sct

_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
#: How far comments of a node are indented, and what may stand before what a requirement says.
_INDENTS = (2, 4, 6)
_SAID = ("", "Overrides: ")
_MARGIN = re.compile(r"\n\s*\* ")


def comments(text: str) -> list[tuple[int, str]]:
    """The block comments of a C text, each on one line, with the numbers of the lines that they begin in."""
    found = []
    line = start = 0
    for match in _COMMENT.finditer(text):
        line += text.count("\n", start, match.start())
        start = match.start()
        found.append((line + 1, " ".join(_MARGIN.sub(" ", match[0]).split())))
    return found


class Sources:
    """What was generated, by path, in which requirements are looked for."""

    def __init__(self, outputs: Mapping[str, str]) -> None:
        self._comments = {path: comments(text) for path, text in outputs.items() if path.endswith((".c", ".h"))}
        self._nodes = {path: text for path, text in outputs.items() if path.endswith(".cpp")}

    def places(self, requirement: sct.StatedRequirement) -> dict[str, list[int]]:
        """The files that cite the requirement, and the lines in which what cites it begins."""
        if not requirement.text:
            return {}
        file = requirement.source.file if requirement.source else None
        cited = comment_text(f"{requirement.text}{f' ({PurePath(file.name).name})' if file else ''}")
        found = {
            path: [number for number, text in comments if cited in text] for path, comments in self._comments.items()
        }
        wanted = _in_node(requirement.text)
        for path, text in self._nodes.items():
            found[path] = [text.count("\n", 0, match.start()) + 1 for match in wanted.finditer(text)]
        return {path: lines for path, lines in found.items() if lines}


def _in_node(requirement: str) -> re.Pattern[str]:
    """What a node says that speaks of this requirement."""
    comments = {line_comment(phrase + requirement, indent) for phrase in _SAID for indent in _INDENTS}
    cited = [rf"^{re.escape(comment)}$" for comment in sorted(comments)]
    cited.append(rf"^.*\badd_requirement\(\s*{re.escape(string_literal(requirement))}\)")
    return re.compile("|".join(cited), re.MULTILINE)
