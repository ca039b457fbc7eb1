"""Automata as groups of a diagram, whatever model they come from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.diagnostics.visible import visible
from robosc.diagrams.graph import Arrow, Group, Node

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.diagrams.graph import Label

#: Stands for the source of what may happen in every state.
EVERY = -1


@dataclass(frozen=True)
class State:
    """A state by its name."""

    name: str
    initial: bool
    marked: bool


@dataclass(frozen=True)
class Step:
    """From one state, or EVERY, to another, by their numbers; None stays where it is."""

    source: int
    target: int | None
    label: Label


def automaton(key: str, title: str, remarks: Sequence[str], states: Sequence[State], steps: Sequence[Step]) -> Group:
    """The group that shows an automaton: steps that stay are rows of their state, those between two states one arrow.

    The group's nodes have keys that begin with its own.
    """
    nodes = [_node(key, number, state, steps) for number, state in enumerate(states)]
    common = _rows(EVERY, steps)
    if any(step.source == EVERY for step in steps):
        nodes.insert(0, Node(_key(key, EVERY), "every", "everywhere", common))
    between: dict[tuple[int, int], list[Label]] = {}
    for step in steps:
        if step.target is not None and step.source != step.target:
            between.setdefault((step.source, step.target), []).append(_visible(step.label))
    arrows = [
        Arrow(_key(key, source), _key(key, target), tuple(labels)) for (source, target), labels in between.items()
    ]
    return Group(key, visible(title), [visible(remark) for remark in remarks], nodes, arrows)


def _node(key: str, number: int, state: State, steps: Sequence[Step]) -> Node:
    return Node(
        _key(key, number),
        "state",
        visible(state.name),
        _rows(number, steps),
        initial=state.initial,
        marked=state.marked,
    )


def _rows(source: int, steps: Sequence[Step]) -> list[Label]:
    return [_visible(step.label) for step in steps if step.source == source and step.target in (None, source)]


def _visible(label: Label) -> Label:
    return tuple(visible(line) for line in label)


def _key(group: str, number: int) -> str:
    return f"{group}_every" if number == EVERY else f"{group}_{number + 1}"
