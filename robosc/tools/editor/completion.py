"""Completion and signature help."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from lsprotocol import types

from robosc.language.completion import proposals, topic_at
from robosc.language.hover import summary
from robosc.language.libraries import LibraryPath
from robosc.language.reading import read
from robosc.language.semantic_tokens import what_of
from robosc.language.signatures import signature
from robosc.model import robosc as rsc
from robosc.tools.editor.places import to_offset, to_range
from robosc.tools.editor.snippets import SNIPPETS

if TYPE_CHECKING:
    from robosc.language.completion import Proposal
    from robosc.language.reading import Reading
    from robosc.tools.editor.project import Analysis, Snapshot

OPTIONS = types.CompletionOptions(trigger_characters=[".", "/"])
SIGNATURE_OPTIONS = types.SignatureHelpOptions(trigger_characters=["(", ","])
_KINDS = {
    "namespace": types.CompletionItemKind.Module,
    "class": types.CompletionItemKind.Class,
    "event": types.CompletionItemKind.Event,
    "enumMember": types.CompletionItemKind.EnumMember,
    "variable": types.CompletionItemKind.Variable,
    "parameter": types.CompletionItemKind.Variable,
    "interface": types.CompletionItemKind.Interface,
    "enum": types.CompletionItemKind.Enum,
    "struct": types.CompletionItemKind.Struct,
    "property": types.CompletionItemKind.Field,
    "function": types.CompletionItemKind.Function,
}


def completion(snapshot: Snapshot, analysis: Analysis, params: types.CompletionParams) -> types.CompletionList:
    """Return the completions at a position."""
    text = analysis.text
    offset = to_offset(text, params.position)
    topic = topic_at(text.content, offset)
    if topic is not None:
        return types.CompletionList(is_incomplete=False, items=_topics(snapshot, to_range(text, *topic)))

    def reread(content: str) -> Reading:
        document = snapshot.documents.get(analysis.path)
        documents = {**snapshot.documents}
        if document is not None:
            documents[analysis.path] = replace(document, content=content)
        with_text = snapshot.replace_documents(documents)
        return read(analysis.path, snapshot.libraries, snapshot.ros_types, with_text.texts)

    def libraries() -> list[str]:
        return LibraryPath(snapshot.libraries, snapshot.texts).library_names(analysis.path)

    start, end, proposed = proposals(text.content, offset, reread, snapshot.ros_types, libraries)
    place = to_range(text, start, end)
    items = [item for proposal in proposed for item in _items(proposal, place)]
    return types.CompletionList(is_incomplete=False, items=items)


def _topics(snapshot: Snapshot, place: types.Range) -> list[types.CompletionItem]:
    """Return the names of topics, services and actions in the project and its libraries."""
    details: dict[str, str] = {}
    analyses = [analysis for path in snapshot.models() if (analysis := snapshot.analysis(path)) is not None]
    for file in (file for analysis in analyses for file in analysis.reading.files.values()):
        for element in file.declared_names:
            if isinstance(element, rsc.CommunicationType) and element.identifier:
                details.setdefault(element.identifier, summary(element))
    return [
        types.CompletionItem(
            name, kind=types.CompletionItemKind.Value, detail=details[name], text_edit=types.TextEdit(place, name)
        )
        for name in sorted(details)
    ]


def _items(proposal: Proposal, place: types.Range) -> list[types.CompletionItem]:
    kind = types.CompletionItemKind.Keyword
    if proposal.element is not None:
        kind = _KINDS.get(what_of(proposal.element) or "", types.CompletionItemKind.Text)
    elif proposal.is_ros:
        kind = types.CompletionItemKind.Struct
    edit = types.TextEdit(place, proposal.text)
    # Names come before words of the language, and these before whole definitions.
    order = "0" if kind is not types.CompletionItemKind.Keyword else "1"
    detail = summary(proposal.element) if proposal.element is not None else None
    items = [
        types.CompletionItem(proposal.text, kind=kind, detail=detail, text_edit=edit, sort_text=order + proposal.text)
    ]
    if proposal.starts:
        items += (
            types.CompletionItem(
                label,
                kind=types.CompletionItemKind.Snippet,
                filter_text=proposal.text,
                sort_text=f"2{label}",
                insert_text_format=types.InsertTextFormat.Snippet,
                insert_text_mode=types.InsertTextMode.AdjustIndentation,
                text_edit=types.TextEdit(place, body),
            )
            for label, body, _ in SNIPPETS.get(proposal.text, ())
        )
    return items


def signature_help(_: Snapshot, analysis: Analysis, params: types.SignatureHelpParams) -> types.SignatureHelp | None:
    """Return the signature of the call around a position."""
    called = signature(analysis.reading, to_offset(analysis.text, params.position))
    if called is None:
        return None
    parameters = [types.ParameterInformation(parameter) for parameter in called.parameters]
    shown = types.SignatureInformation(called.label, parameters=parameters, active_parameter=called.active)
    return types.SignatureHelp([shown], active_signature=0, active_parameter=called.active)
