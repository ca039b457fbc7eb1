"""Contents of a diagram of a robot: groups of nodes, with arrows between the nodes of a group."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    #: Text of one transition, or of one use of a topic: a line, and further lines that belong to it.
    Label = Sequence[str]


@dataclass(frozen=True)
class DiagramNode:
    """A state or the node for all states (`every`); the `controller`; a `topic`, a `service` or an `action`.

    `key` is unique in the diagram, and a valid name in every notation. Rows are the steps that stay in a state, or the
    uses of a topic.
    """

    key: str
    kind: str
    title: str
    rows: Sequence[Label] = ()
    initial: bool = False
    marked: bool = False


@dataclass(frozen=True)
class Arrow:
    """An arrow between two nodes, or `both` ways; each label is one transition."""

    source: str
    target: str
    labels: Sequence[Label] = ()
    both: bool = False


@dataclass(frozen=True)
class Group:
    """Nodes and arrows that belong together, under a title with remarks."""

    key: str
    title: str
    remarks: Sequence[str]
    nodes: Sequence[DiagramNode]
    arrows: Sequence[Arrow]


@dataclass(frozen=True)
class Graph:
    """A diagram; groups with titles have frames."""

    title: str
    groups: Sequence[Group]

    @property
    def nodes(self) -> list[DiagramNode]:
        """The nodes of all groups."""
        return [node for group in self.groups for node in group.nodes]
