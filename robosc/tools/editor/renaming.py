"""Renaming that preserves the meaning of models: the new texts are read and checked before the answer."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from robosc.base.diagnostics import Edit
from robosc.language.checks.automatic_edits import objection
from robosc.language.tokens import is_name
from robosc.model import robosc as rsc
from robosc.model.semantics.naming import escape_keyword
from robosc.tools.editor.places import to_edits, to_offset, to_range
from robosc.tools.editor.reading import occurrences

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

    from robosc.base.diagnostics import Diagnostic
    from robosc.language.scopes import File, Reference
    from robosc.tools.editor.project import Analysis, Snapshot

_FAILED = int(types.LSPErrorCodes.RequestFailed)


def prepare_rename(
    snapshot: Snapshot, analysis: Analysis, params: types.PrepareRenameParams
) -> types.PrepareRenamePlaceholder | None:
    """Return the name at a position if it can be renamed, or None if there is no name."""
    name = analysis.file.name_at(to_offset(analysis.text, params.position))
    if name is None or name.target is None:
        return None
    _require_own(snapshot, analysis, name)
    return types.PrepareRenamePlaceholder(to_range(analysis.text, name.start, name.end), name.name)


def rename(snapshot: Snapshot, analysis: Analysis, params: types.RenameParams) -> types.WorkspaceEdit | None:
    """Return the edits that rename the element at a position, in all files of the project.

    Raises JsonRpcException, which the editor shows, if the new name is invalid or the texts would change their meaning.
    """
    new, offset = params.new_name.removeprefix("^"), to_offset(analysis.text, params.position)
    name = analysis.file.name_at(offset)
    if name is None or name.target is None:
        return None
    _require_own(snapshot, analysis, name)
    if not is_name(new):
        raise _refused(f"`{new}` is not a name: it has letters from a to z and A to Z, digits and `_`")
    return rename_everywhere(snapshot, analysis, Renaming(name, new))


class Renaming(NamedTuple):
    """A name of the element to rename, the new name, and further edits of the text that belong to the renaming."""

    name: Reference
    new: str
    others: Sequence[Edit] = ()


def rename_everywhere(
    snapshot: Snapshot, analysis: Analysis, renaming: Renaming, mended: Sequence[Diagnostic] = ()
) -> types.WorkspaceEdit:
    """Return the edits that rename an element in all files of the project; they must fix the findings `mended`.

    Raises JsonRpcException if the texts would change their meaning.
    """
    name, new, others = renaming
    texts = {analysis.text.file: analysis.text}
    edits = {analysis.text.file: list(others)}
    for file, reference in occurrences(snapshot, analysis, name.start):
        texts[file.text.file] = file.text
        place = file.text.span(reference.start, reference.end)
        edits.setdefault(file.text.file, []).append(Edit(place, escape_keyword(new)))
    _require_same(snapshot, analysis, name.name, edits, mended)
    changes = {file: to_edits(texts[file], edits_of_file) for file, edits_of_file in edits.items() if edits_of_file}
    return types.WorkspaceEdit({snapshot.uri(file): edits_of_file for file, edits_of_file in changes.items()})


def renaming_of(file: File, edits: Collection[Edit]) -> Renaming | None:
    """Return the renaming that edits amount to, or None if they do not replace a declared name and all its uses."""
    texts = {edit.span: edit.text for edit in edits}
    for name in file.names:
        new = texts.get(file.text.span(name.start, name.end)) if name.is_declaration else None
        if new is not None:
            spans = [file.text.span(other.start, other.end) for other in file.occurrences(name.target)]
            if all(texts.get(span) == new for span in spans):
                others = [edit for edit in edits if edit.span not in spans]
                return Renaming(name, new.removeprefix("^"), others)
    return None


def _require_own(snapshot: Snapshot, analysis: Analysis, name: Reference) -> None:
    declared = analysis.declarations.get(name.target)
    if declared is None:
        of_language = isinstance(name.target, rsc.FormalParameter)  # `number` in a fleet
        raise _refused(f"`{name.name}` is a name of {'the language' if of_language else 'ROS'}")
    if Path(declared[0].text.file).resolve() not in snapshot.models():
        raise _refused(f"`{name.name}` is declared in {declared[0].text.file}, which is not in the editor's folders")


def _require_same(
    snapshot: Snapshot,
    analysis: Analysis,
    word: str,
    edits: Mapping[str, Sequence[Edit]],
    mended: Sequence[Diagnostic],
) -> None:
    """Check the texts after the edits, and reject edits that make a model worse.

    They are also rejected if the word occurs in an unreadable part of a text.
    """
    analyses = {analysis.path: analysis} | {dependent.path: dependent for dependent in snapshot.analyses_with(word)}
    by_path = {Path(name).resolve(): changes for name, changes in edits.items()}
    analyses |= {importer.path: importer for importer in snapshot.importers(by_path)}
    for later in analyses.values():
        for file in later.reading.files.values():
            skipped = (file.text.content[start:end] for start, end in file.skipped)
            if any(re.search(rf"\b{re.escape(word)}\b", part) for part in skipped):
                raise _refused(f"correct {file.text.file} first: `{word}` is in an unreadable part")
    after = snapshot.apply_edits(by_path)
    for path, later in analyses.items():
        renamed = after.analysis(path)
        own = {name: by_path[at] for name in later.reading.files if (at := Path(name).resolve()) in by_path}
        why = "" if renamed is None else objection(later, renamed, own, mended if later is analysis else ())
        if why is not None:
            raise _refused(f"this would change the meaning of {path.name}{why and f': {why}'}")


def _refused(why: str) -> JsonRpcException:
    return JsonRpcException(why, _FAILED)
