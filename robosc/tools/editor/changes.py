"""Inlay hints, and the call hierarchy of states: a state "calls" the states to which its transitions lead."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from lsprotocol import types

from robosc.language.document_symbols import span
from robosc.language.hover import event_text
from robosc.language.inlay_hints import notes
from robosc.model import robosc as rsc
from robosc.tools.editor.places import to_offset, to_range

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.language.scopes import File
    from robosc.tools.editor.project import Analysis, Snapshot


def inlay_hints(snapshot: Snapshot, analysis: Analysis, params: types.InlayHintParams) -> list[types.InlayHint]:
    """Return the types of `value`, the parameters of arguments and the units of data in a range."""
    text = analysis.text
    start, end = to_offset(text, params.range.start), to_offset(text, params.range.end)
    return [
        types.InlayHint(
            to_range(text, note.offset, note.offset).start,
            note.text,
            kind=types.InlayHintKind.Type if note.is_type else types.InlayHintKind.Parameter,
            padding_right=not note.is_type,
        )
        for note in notes(analysis.file, snapshot.ros_types)
        if start <= note.offset <= end
    ]


def prepare_call_hierarchy(
    snapshot: Snapshot, analysis: Analysis, params: types.CallHierarchyPrepareParams
) -> list[types.CallHierarchyItem]:
    """Return the state at a position."""
    name = analysis.file.name_at(to_offset(analysis.text, params.position))
    state = name.target if name is not None else None
    declaration = analysis.declarations.get(state) if isinstance(state, rsc.State) else None
    return [] if declaration is None else [_item(snapshot, declaration[0], state)]


def incoming_calls(
    snapshot: Snapshot, analysis: Analysis, params: types.CallHierarchyIncomingCallsParams
) -> list[types.CallHierarchyIncomingCall]:
    """Return the states with transitions to a state, with these transitions.

    The component stands for transitions from every state.
    """
    by_source: dict[Any, list[rsc.Transition]] = {}
    state = _state(analysis, params.item)
    for transition in _transitions(state):
        if transition.target is state:
            by_source.setdefault(_source(transition), []).append(transition)
    return [
        types.CallHierarchyIncomingCall(_item(snapshot, analysis.file, source, leading), _ranges(analysis, leading))
        for source, leading in by_source.items()
    ]


def outgoing_calls(
    snapshot: Snapshot, analysis: Analysis, params: types.CallHierarchyOutgoingCallsParams
) -> list[types.CallHierarchyOutgoingCall]:
    """Return the states to which transitions lead from a state, with these transitions."""
    by_target: dict[Any, list[rsc.Transition]] = {}
    state = _state(analysis, params.item)
    for transition in _transitions(state):
        if transition.target is not None and _source(transition) in {state, _component(state)}:
            by_target.setdefault(transition.target, []).append(transition)
    return [
        types.CallHierarchyOutgoingCall(_item(snapshot, analysis.file, target, leading), _ranges(analysis, leading))
        for target, leading in by_target.items()
        if target is not state
    ]


def _state(analysis: Analysis, item: types.CallHierarchyItem) -> Any:
    """Return the state of an item as declared in the text, or None if the text has changed."""
    name = analysis.file.name_at(to_offset(analysis.text, item.selection_range.start))
    state = name.target if name is not None else None
    return state if isinstance(state, rsc.State) and state in analysis.file.declared_names else None


def _component(element: Any) -> Any:
    around = element
    while around is not None and not isinstance(around, rsc.Component):
        around = around.eContainer()
    return around


def _source(transition: rsc.Transition) -> Any:
    around = transition.eContainer()
    return around if isinstance(around, rsc.State) else _component(transition)


def _transitions(state: Any) -> Iterator[rsc.Transition]:
    """Yield the transitions of the behavior that contains a state."""
    for definition in state.eContainer().definitions if state is not None else ():
        if isinstance(definition, rsc.Transition):
            yield definition
        elif isinstance(definition, rsc.State):
            yield from definition.transitions


def _item(
    snapshot: Snapshot, file: File, element: Any, transitions: list[rsc.Transition] | None = None
) -> types.CallHierarchyItem:
    name = file.declared_names[element]
    owner = _component(element)
    label = element.name if owner is element else f"{owner.name}.{element.name}"
    return types.CallHierarchyItem(
        name=label,
        kind=types.SymbolKind.Class if owner is element else types.SymbolKind.EnumMember,
        uri=snapshot.uri(file.text.file),
        range=to_range(file.text, *span(file, element)),
        selection_range=to_range(file.text, name.start, name.end),
        detail=", ".join(dict.fromkeys(event_text(transition, file) for transition in transitions or ())) or None,
    )


def _ranges(analysis: Analysis, transitions: list[rsc.Transition]) -> list[types.Range]:
    return [to_range(analysis.text, *span(analysis.file, transition)) for transition in transitions]
