"""Diagrams of robots as text in each notation, with the contents of models escaped."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from robosc.base.files.templates import environment
from robosc.tools.diagrams.graph_drawing import draw

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.tools.diagrams.graph import DiagramNode, Graph, Label

_MERMAID_SHAPES = {
    "controller": ("[", "]"),
    "topic": ("([", "])"),
    "service": ("[[", "]]"),
    "action": ("{{", "}}"),
}
_DOT_SHAPES = {
    "state": "shape=box style=rounded",
    "every": 'shape=box style="rounded,dashed"',
    "controller": "shape=box style=bold",
    "topic": "shape=ellipse",
    "service": "shape=component",
    "action": "shape=hexagon",
}
#: Characters other than those that all grammars of Mermaid read literally.
_PLAIN = re.compile(r"[^A-Za-z0-9_ .,/()=+*-]")


def mermaid(graph: Graph) -> str:
    """Return a state diagram if groups have titles, else a flow chart."""
    name = "states" if _is_states(graph) else "ros"
    return render(f"{name}.mermaid.j2", graph=graph, shapes=_MERMAID_SHAPES)


def dot(graph: Graph) -> str:
    """Return a graph for Graphviz, with a cluster for each group that has a title."""
    return render("graph.dot.j2", graph=graph, shapes=_DOT_SHAPES, states=_is_states(graph))


def svg(graph: Graph) -> str:
    """Return a picture with its own layout."""
    return render("picture.svg.j2", picture=draw(graph))


def _is_states(graph: Graph) -> bool:
    return all(group.title for group in graph.groups)


def render(template: str, **values: object) -> str:
    """Render a template of this package; values are escaped in SVG."""
    templates = environment("robosc.tools.diagrams", escapes=".svg." in template)
    templates.filters |= {"dot": _dot, "dot_labels": _dot_labels, "dot_node": _dot_node, "mermaid": _mermaid}
    return templates.get_template(template).render(**values)


def _mermaid(text: str | Label) -> str:
    """Return text for a label: lines joined by `<br/>`, and codes for all characters that may have a meaning."""
    lines = [text] if isinstance(text, str) else text
    return "<br/>".join(_PLAIN.sub(lambda match: f"#{ord(match[0])};", line) for line in lines)


def _dot(text: str) -> str:
    """Return a quoted string in which backslashes, quotes and entities have no meaning."""
    return f'"{_dot_line(text)}"'


def _dot_line(text: str) -> str:
    return text.replace("\\", "\\\\").replace('"', r"\"").replace("&", "&amp;")


def _dot_labels(labels: Sequence[Label]) -> str:
    return f'"{_dot_rows(labels)}"'


def _dot_node(node: DiagramNode) -> str:
    rows = _dot_rows(node.rows)
    return f'"{_dot_line(node.title)}{chr(92) + "n" if rows else ""}{rows}"'


def _dot_rows(labels: Sequence[Label]) -> str:
    """Return left-aligned lines; continuation lines are indented."""
    lines = [("" if number == 0 else "  ") + text for label in labels for number, text in enumerate(label)]
    return "".join(rf"{_dot_line(line)}\l" for line in lines)
