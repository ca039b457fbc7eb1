"""What a diagram of a robot shows: groups of nodes, with arrows between the nodes of a group."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    #: What is said about one transition, or one use of a topic: a line, and lines that belong to it.
    Label = Sequence[str]


@dataclass(frozen=True)
class Node:
    """A state, or what stands for all states (`every`); the `controller`; a `topic`, a `service`, an `action`.

    `key` is unique in the diagram, and a name in every notation. Rows say what happens without leaving a state, or what
    a topic is used for.
    """

    key: str
    kind: str
    title: str
    rows: Sequence[Label] = ()
    initial: bool = False
    marked: bool = False


@dataclass(frozen=True)
class Arrow:
    """From one node to another, or `both` ways; each label is a way to go."""

    source: str
    target: str
    labels: Sequence[Label] = ()
    both: bool = False


@dataclass(frozen=True)
class Group:
    """What belongs together, under a title with remarks."""

    key: str
    title: str
    remarks: Sequence[str]
    nodes: Sequence[Node]
    arrows: Sequence[Arrow]


@dataclass(frozen=True)
class Graph:
    """A diagram; its groups have frames around them where they have titles."""

    title: str
    groups: Sequence[Group]

    @property
    def nodes(self) -> list[Node]:
        """Those of all groups."""
        return [node for group in self.groups for node in group.nodes]
