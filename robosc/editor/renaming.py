"""Renaming, which never changes what a model means: the new texts are read before anything is answered."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from robosc.editor.places import to_offset, to_range
from robosc.editor.project import Document, Snapshot, edited
from robosc.editor.reading import occurrences
from robosc.language.tokens import is_name
from robosc.semantics.naming import written

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.editor.project import Analysis
    from robosc.language import Reference

_FAILED = int(types.LSPErrorCodes.RequestFailed)


def prepare_rename(
    snapshot: Snapshot, analysis: Analysis, params: types.PrepareRenameParams
) -> types.PrepareRenamePlaceholder | None:
    """The name at a position that can be renamed; None where none stands there."""
    name = analysis.file.name_at(to_offset(analysis.text, params.position))
    if name is None or name.target is None:
        return None
    _require_own(snapshot, analysis, name)
    return types.PrepareRenamePlaceholder(to_range(analysis.text, name.start, name.end), name.name)


def rename(snapshot: Snapshot, analysis: Analysis, params: types.RenameParams) -> types.WorkspaceEdit | None:
    """The edits that give the element at a position a new name, in all files of the project.

    Raises JsonRpcException, which the editor shows, where the name can't be one, or the texts would mean something
    else.
    """
    new, offset = params.new_name.removeprefix("^"), to_offset(analysis.text, params.position)
    name = analysis.file.name_at(offset)
    if name is None or name.target is None:
        return None
    _require_own(snapshot, analysis, name)
    if not is_name(new):
        raise _refused(f"`{new}` is no name: it has letters from a to z and A to Z, digits and `_`")
    edits: dict[str, list[types.TextEdit]] = {}
    for file, reference in occurrences(snapshot, analysis, offset):
        place = to_range(file.text, reference.start, reference.end)
        edits.setdefault(file.text.file, []).append(types.TextEdit(place, written(new)))
    _require_same(snapshot, analysis, name.name, edits)
    return types.WorkspaceEdit({snapshot.uri(file): found for file, found in edits.items()})


def _require_own(snapshot: Snapshot, analysis: Analysis, name: Reference) -> None:
    declared = analysis.declarations.get(name.target)
    if declared is None:
        raise _refused(f"`{name.name}` is a name of ROS")
    if Path(declared[0].text.file).resolve() not in snapshot.models():
        raise _refused(f"`{name.name}` is declared in {declared[0].text.file}, which is not in the editor's folders")


def _require_same(
    snapshot: Snapshot, analysis: Analysis, word: str, edits: Mapping[str, Sequence[types.TextEdit]]
) -> None:
    """Reads the texts as they would be, and refuses what would make names stand for something else, or draw findings.

    A text that can't be read in part is no basis where the word stands in that part.
    """
    analyses = {analysis.path: analysis} | {found.path: found for found in snapshot.analyses_with(word)}
    for found in analyses.values():
        for file in found.reading.files.values():
            skipped = (file.text.content[start:end] for start, end in file.skipped)
            if any(re.search(rf"\b{re.escape(word)}\b", part) for part in skipped):
                raise _refused(f"mend {file.text.file} first: `{word}` stands in what can't be read")
    documents = dict(snapshot.documents)
    for name, changes in edits.items():
        path = Path(name).resolve()
        before = documents.get(path) or Document(path.as_uri(), None, snapshot.texts.read(path).decode())
        documents[path] = replace(before, content=edited(before.content, changes))
    after = snapshot.with_documents(documents)
    for path, found in analyses.items():
        renamed = after.analysis(path)
        if renamed is None or _meaning(renamed) != _meaning(found):
            raise _refused(f"this would change what {path.name} means{_why(found, renamed)}")


def _meaning(analysis: Analysis) -> object:
    """Which name stands for what, in the order of the texts, and which findings stand in which lines."""
    numbers = {
        (file.text.file, name.start): index
        for file in analysis.reading.files.values()
        for index, name in enumerate(file.names)
    }

    def number(target: object) -> object:
        key = analysis.key(target)
        return (key[0], numbers[key]) if key is not None else target is not None

    names = [number(name.target) for file in analysis.reading.files.values() for name in file.names]
    return names, Counter((finding.file, finding.span.line, finding.rule) for finding in analysis.findings)


def _why(before: Analysis, after: Analysis | None) -> str:
    known = Counter((finding.file, finding.span.line, finding.rule) for finding in before.findings)
    for finding in after.findings if after is not None else ():
        if (finding.file, finding.span.line, finding.rule) not in known:
            return f": line {finding.span.line}: {finding.message}"
    return ""


def _refused(why: str) -> JsonRpcException:
    return JsonRpcException(why, _FAILED)
