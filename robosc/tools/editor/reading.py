"""Symbols, folds, hovers, references and formatting of a text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types

from robosc.language.document_symbols import around, folds, outline
from robosc.language.formatting import format_edits
from robosc.language.hover import describe
from robosc.model import robosc as rsc
from robosc.tools.editor.places import location, to_offset, to_range

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from robosc.language.document_symbols import Item
    from robosc.language.scopes import File, Reference
    from robosc.language.text import Text
    from robosc.tools.editor.project import Analysis, Snapshot

_KINDS: dict[type, types.SymbolKind] = {
    rsc.Base: types.SymbolKind.Module,
    rsc.Component: types.SymbolKind.Class,
    rsc.ComponentBehaviour: types.SymbolKind.Namespace,
    rsc.Message: types.SymbolKind.Event,
    rsc.Service: types.SymbolKind.Method,
    rsc.Action: types.SymbolKind.Method,
    rsc.OutgoingService: types.SymbolKind.Method,
    rsc.OutgoingAction: types.SymbolKind.Method,
    rsc.Variable: types.SymbolKind.Variable,
    rsc.State: types.SymbolKind.EnumMember,
    rsc.RequirementState: types.SymbolKind.EnumMember,
    rsc.Interface: types.SymbolKind.Interface,
    rsc.ObjectDataType: types.SymbolKind.Struct,
    rsc.ObjectProperty: types.SymbolKind.Field,
    rsc.EnumDataType: types.SymbolKind.Enum,
    rsc.EnumValue: types.SymbolKind.EnumMember,
    rsc.Constant: types.SymbolKind.Constant,
    rsc.Parameter: types.SymbolKind.Property,
    rsc.Condition: types.SymbolKind.Boolean,
    rsc.Function: types.SymbolKind.Function,
    rsc.Requirement: types.SymbolKind.Operator,
    rsc.Property: types.SymbolKind.Key,
    rsc.Assumption: types.SymbolKind.Key,
    rsc.DataStatement: types.SymbolKind.Object,
}


def _kind(element: object) -> types.SymbolKind:
    return next(kind for element_kind, kind in _KINDS.items() if isinstance(element, element_kind))


def symbols(_: Snapshot, analysis: Analysis, params: types.DocumentSymbolParams) -> list[types.DocumentSymbol]:
    """Return the definitions of a text, nested as in the text."""
    return _symbols(analysis.text, outline(analysis.file))


def _symbols(text: Text, items: Iterable[Item]) -> list[types.DocumentSymbol]:
    return [
        types.DocumentSymbol(
            name=item.name,
            kind=_kind(item.element),
            range=to_range(text, item.start, item.end),
            selection_range=to_range(text, item.name_start, item.name_end),
            children=_symbols(text, item.items),
        )
        for item in items
    ]


def workspace_symbols(snapshot: Snapshot, query: str) -> list[types.WorkspaceSymbol]:
    """Return the named definitions of the project whose names contain the letters of a query in this order."""
    results = []
    for path in snapshot.models():
        analysis = snapshot.analysis(path)
        if analysis is None:
            continue
        for item, holder in _flat(outline(analysis.file)):
            if item.element in analysis.file.declared_names and _matches(query, item.name):
                place = location(snapshot, analysis.text, item.name_start, item.name_end)
                results.append(types.WorkspaceSymbol(place, item.name, _kind(item.element), container_name=holder))
    return results


def _flat(items: Iterable[Item], holder: str | None = None) -> Iterator[tuple[Item, str | None]]:
    for item in items:
        yield item, holder
        yield from _flat(item.items, item.name)


def _matches(query: str, name: str) -> bool:
    letters = iter(name.lower())
    return all(letter in letters for letter in query.lower())


def folding_ranges(_: Snapshot, analysis: Analysis, params: types.FoldingRangeParams) -> list[types.FoldingRange]:
    """Return the foldable ranges of a text, including blocks of comments."""
    text = analysis.text
    lines = {
        (text.to_utf16(start)[0], text.to_utf16(end)[0]): types.FoldingRangeKind.Region
        for start, end in folds(analysis.file)
    }
    ranges = [types.FoldingRange(first, last - 1) for first, last in sorted(lines) if last - first > 1]
    comments = [index for index, line in enumerate(text.content.split("\n")) if line.lstrip().startswith("//")]
    start = None
    for index, line in enumerate(comments):
        start = line if start is None else start
        if index + 1 == len(comments) or comments[index + 1] != line + 1:
            if line > start:
                ranges.append(types.FoldingRange(start, line, kind=types.FoldingRangeKind.Comment))
            start = None
    return ranges


def selection_ranges(_: Snapshot, analysis: Analysis, params: types.SelectionRangeParams) -> list[types.SelectionRange]:
    """Return, for each position of the request, the ranges around it, each within the next one."""
    return [_selection(analysis, position) for position in params.positions]


def _selection(analysis: Analysis, position: types.Position) -> types.SelectionRange:
    selection: types.SelectionRange | None = None
    for start, end in reversed(around(analysis.file, to_offset(analysis.text, position))):
        selection = types.SelectionRange(to_range(analysis.text, start, end), selection)
    assert selection is not None
    return selection


def hover(snapshot: Snapshot, analysis: Analysis, params: types.HoverParams) -> types.Hover | None:
    """Return the description of the name at a position."""
    name = analysis.file.name_at(to_offset(analysis.text, params.position))
    description = describe(analysis.reading, name.target, snapshot.ros_types) if name is not None else None
    if name is None or description is None:
        return None
    shown = types.MarkupContent(types.MarkupKind.Markdown, description)
    return types.Hover(shown, to_range(analysis.text, name.start, name.end))


def definition(snapshot: Snapshot, analysis: Analysis, params: types.DefinitionParams) -> list[types.LocationLink]:
    """Return the declaration of the name at a position; for the name of a library, its file."""
    name = analysis.file.name_at(to_offset(analysis.text, params.position))
    if name is None or name.target is None:
        return []
    declaration = analysis.declarations.get(name.target)
    if declaration is None:
        return []
    file, declared = declaration
    selection = to_range(file.text, declared.start, declared.end)
    origin = to_range(analysis.text, name.start, name.end)
    return [types.LocationLink(snapshot.uri(file.text.file), selection, selection, origin)]


def occurrences(snapshot: Snapshot, analysis: Analysis, offset: int) -> list[tuple[File, Reference]]:
    """Return all references in the project to the element named at an offset; empty if there is no name."""
    name = analysis.file.name_at(offset)
    key = analysis.key(name.target) if name is not None and name.target is not None else None
    if name is None or key is None:
        return []
    by_place: dict[tuple[str, int], tuple[File, Reference]] = {}
    for other in [analysis, *snapshot.analyses_with(name.name)]:
        for file in other.reading.files.values():
            for reference in file.names:
                if reference.name == name.name and other.key(reference.target) == key:
                    by_place.setdefault((file.text.file, reference.start), (file, reference))
    return [by_place[place] for place in sorted(by_place)]


def references(snapshot: Snapshot, analysis: Analysis, params: types.ReferenceParams) -> list[types.Location]:
    """Return the references to the element named at a position."""
    return [
        location(snapshot, file.text, name.start, name.end)
        for file, name in occurrences(snapshot, analysis, to_offset(analysis.text, params.position))
        if params.context.include_declaration or not name.is_declaration
    ]


def highlights(_: Snapshot, analysis: Analysis, params: types.DocumentHighlightParams) -> list[types.DocumentHighlight]:
    """Return the references within the text to the element named at a position."""
    name = analysis.file.name_at(to_offset(analysis.text, params.position))
    if name is None or name.target is None:
        return []
    return [
        types.DocumentHighlight(
            to_range(analysis.text, other.start, other.end),
            types.DocumentHighlightKind.Write if other.is_declaration else types.DocumentHighlightKind.Read,
        )
        for other in analysis.file.names
        if other.target is name.target
    ]


def formatting(_: Snapshot, analysis: Analysis, params: types.DocumentFormattingParams) -> list[types.TextEdit]:
    """Return the edits that format a text; none if it has syntax errors."""
    return _edits(analysis, 0, len(analysis.text.content))


def range_formatting(
    _: Snapshot, analysis: Analysis, params: types.DocumentRangeFormattingParams
) -> list[types.TextEdit]:
    """Return the edits that format a range of a text; none if the text has syntax errors."""
    text = analysis.text
    return _edits(analysis, to_offset(text, params.range.start), to_offset(text, params.range.end))


def _edits(analysis: Analysis, start: int, end: int) -> list[types.TextEdit]:
    text = analysis.text
    if analysis.file.findings:  # These are its syntax errors, reported when it was read.
        return []
    return [types.TextEdit(to_range(text, first, last), new) for first, last, new in format_edits(text, start, end)]
