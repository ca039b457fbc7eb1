"""Where generated code speaks of a requirement: generators write what it says into a comment beside its event."""

from __future__ import annotations

import re
from pathlib import PurePath
from typing import TYPE_CHECKING

from robosc.m2t.c.comments import comment_text

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robosc.metamodel import sct

_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
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


def places(requirement: sct.StatedRequirement, files: Mapping[str, list[tuple[int, str]]]) -> dict[str, list[int]]:
    """The files, by path and with their comments, that cite the requirement, and in which lines."""
    if not requirement.text:
        return {}
    file = requirement.source.file if requirement.source else None
    cited = comment_text(f"{requirement.text}{f' ({PurePath(file.name).name})' if file else ''}")
    found = {path: [number for number, text in told if cited in text] for path, told in files.items()}
    return {path: lines for path, lines in found.items() if lines}
