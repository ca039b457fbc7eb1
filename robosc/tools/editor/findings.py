"""Findings as diagnostics of the protocol."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from robosc.base.diagnostics import Severity, in_order
from robosc.base.diagnostics.rules import address
from robosc.base.interruption import checkpoint
from robosc.language.checks.automatic_edits import Safety, safe_edits, safety_of
from robosc.language.libraries import declared_name
from robosc.model import robosc as rsc
from robosc.tools.editor.places import span_range, to_edits, to_range
from robosc.tools.editor.renaming import rename_everywhere, renaming_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from robosc.base.diagnostics import Diagnostic, Edit
    from robosc.language.scopes import Reference
    from robosc.language.text import Text
    from robosc.tools.editor.project import Analysis, Snapshot

#: The command that adds a folder, by its URI, to the folders searched for libraries.
ADD_LIBRARY_FOLDER = "robosc.addLibraryFolder"
#: Maximum number of fixes that are tried for one request: each reads the model again.
_MOST_WAYS = 20
_MEND_ALL = "source.fixAll.robosc"
CODE_ACTION_OPTIONS = types.CodeActionOptions([types.CodeActionKind.QuickFix, _MEND_ALL])
_SEVERITIES = {
    Severity.ERROR: types.DiagnosticSeverity.Error,
    Severity.WARNING: types.DiagnosticSeverity.Warning,
}


def findings_by_path(snapshot: Snapshot, analyses: Iterable[Analysis]) -> dict[Path, list[types.Diagnostic]]:
    """Return the findings in each text that these analyses read, by its path, each finding once."""
    findings: dict[str, list[Diagnostic]] = {}
    texts: dict[str, Text] = {}
    for analysis in analyses:
        texts |= {file: source.text for file, source in analysis.reading.files.items()}
        for finding in analysis.findings:
            findings.setdefault(finding.file, []).append(finding)
    return {
        Path(file): [diagnostic(snapshot, finding, texts) for finding in in_order(findings.get(file, ()))]
        for file in texts
    }


def abandoned_diagnostic(why: str) -> types.Diagnostic:
    """Return the diagnostic of a text whose analysis was abandoned."""
    place = types.Range(types.Position(0, 0), types.Position(0, 1))
    message = f"{why}: the findings of this file are missing\nhint: run `robosc check` on it"
    return types.Diagnostic(place, message, severity=types.DiagnosticSeverity.Warning, source="robosc")


def quickly(snapshot: Snapshot, path: Path) -> list[types.Diagnostic] | None:
    """Return the findings in a large text before it is read as a whole, or None if that is impossible."""
    quick = snapshot.quick_findings(path)
    if quick is None:
        return None
    text, texts, findings = quick
    return [diagnostic(snapshot, finding, texts) for finding in findings if finding.file == text.file]


def diagnostic(snapshot: Snapshot, finding: Diagnostic, texts: Mapping[str, Text]) -> types.Diagnostic:
    """Return a finding as a diagnostic with its hint, the page of its rule as a link, and its related places."""
    page = address(finding.rule)
    related = []
    for other in finding.related:
        if other.file in texts:
            place = types.Location(snapshot.uri(other.file), span_range(texts[other.file], other.span))
            related.append(types.DiagnosticRelatedInformation(place, other.message))
    return types.Diagnostic(
        range=span_range(texts[finding.file], finding.span),
        message=finding.message + (f"\nhint: {finding.hint}" if finding.hint else ""),
        severity=_SEVERITIES[finding.severity],
        code=finding.rule,
        code_description=types.CodeDescription(page) if page else None,
        source="robosc",
        related_information=related or None,
    )


def code_actions(snapshot: Snapshot, analysis: Analysis, params: types.CodeActionParams) -> list[types.CodeAction]:
    """Return the fixes for each finding in a range and, on request, the edit that applies all of them."""
    only = params.context.only
    text, uri = analysis.text, params.text_document.uri
    own = [finding for finding in analysis.findings if finding.file == text.file]
    actions: list[types.CodeAction] = []
    if only is None or types.CodeActionKind.QuickFix in only:
        places = ((finding, span_range(text, finding.span)) for finding in own)
        there = [
            finding for finding, place in places if place.start <= params.range.end and params.range.start <= place.end
        ]
        actions += _quick_fixes(snapshot, analysis, params, there)
        actions += _library_folders(snapshot, analysis, params.range)
    if only is not None and any(kind == _MEND_ALL or _MEND_ALL.startswith(f"{kind}.") for kind in only):
        certain = safe_edits(analysis, partial(_checked, snapshot, analysis))
        if certain:
            whole = types.WorkspaceEdit({uri: to_edits(text, certain)})
            actions.append(types.CodeAction("Apply all hints", kind=_MEND_ALL, edit=whole))
    return actions


def _quick_fixes(
    snapshot: Snapshot, analysis: Analysis, params: types.CodeActionParams, findings: Sequence[Diagnostic]
) -> Iterator[types.CodeAction]:
    """Yield the fixes of findings that do no harm, at most `_MOST_WAYS`.

    The edit of a hint is preferred if `check --fix` may apply it, too.
    """
    ways = ((finding, title, edits) for finding in findings for title, edits in _ways(finding))
    for finding, title, edits in islice(ways, _MOST_WAYS):
        checkpoint()
        safety = _safety(snapshot, analysis, finding, edits)
        change = None if safety is Safety.HARMFUL else _change(snapshot, analysis, params, finding, edits)
        if change is not None:
            mended = [diagnostic(snapshot, finding, {analysis.text.file: analysis.text})]
            preferred = edits is finding.edits and safety is Safety.SAFE
            yield types.CodeAction(title, types.CodeActionKind.QuickFix, mended, is_preferred=preferred, edit=change)


def _ways(finding: Diagnostic) -> list[tuple[str, Sequence[Edit]]]:
    own: list[tuple[str, Sequence[Edit]]] = [(finding.hint or finding.message, finding.edits)] if finding.edits else []
    return own + [(way.title, way.edits) for way in finding.alternatives]


def _safety(snapshot: Snapshot, analysis: Analysis, finding: Diagnostic, edits: Sequence[Edit]) -> Safety:
    return safety_of(finding, edits, analysis, partial(_checked, snapshot, analysis))


def _change(
    snapshot: Snapshot,
    analysis: Analysis,
    params: types.CodeActionParams,
    finding: Diagnostic,
    edits: Sequence[Edit],
) -> types.WorkspaceEdit | None:
    """Return edits as a workspace edit, extended to the whole project if they rename.

    Returns None if a text of the project would change its meaning.
    """
    renaming = renaming_of(analysis.file, edits)
    if renaming is None:
        return types.WorkspaceEdit({params.text_document.uri: to_edits(analysis.text, edits)})
    try:
        return rename_everywhere(snapshot, analysis, renaming, [finding])
    except JsonRpcException:
        return None


def _checked(snapshot: Snapshot, analysis: Analysis, content: str) -> Analysis:
    """Return the analysis with another content of the text."""
    document = snapshot.documents[analysis.path]
    after = snapshot.replace_documents({**snapshot.documents, analysis.path: replace(document, content=content)})
    checked = after.analysis(analysis.path)
    assert checked is not None
    return checked


def _library_folders(snapshot: Snapshot, analysis: Analysis, place: types.Range) -> list[types.CodeAction]:
    """Return an action for each folder of the project with a library in a range that the search did not find."""
    actions = []
    for name in analysis.file.names:
        at = to_range(analysis.text, name.start, name.end)
        missing = isinstance(name.user, rsc.ImportedComponent) and name.feature == "library" and name.target is None
        if missing and at.start <= place.end and place.start <= at.end:
            for folder in dict.fromkeys(path.parent for path in snapshot.models() if _declares(snapshot, path, name)):
                title = f"also search libraries in {folder}"
                command = types.Command(title, command=ADD_LIBRARY_FOLDER, arguments=[snapshot.uri(str(folder))])
                actions.append(types.CodeAction(title, kind=types.CodeActionKind.QuickFix, command=command))
    return actions


def _declares(snapshot: Snapshot, path: Path, name: Reference) -> bool:
    try:
        return declared_name(snapshot.texts.read(path, is_input=False)) == name.name
    except OSError:
        return False
