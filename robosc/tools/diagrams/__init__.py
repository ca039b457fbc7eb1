"""Diagrams of the metamodels, and of robots: behavior of components, plants, ROS graph."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.tools.diagrams import notations
from robosc.tools.diagrams.automata import behaviour_graph, plants_graph
from robosc.tools.diagrams.class_drawing import draw
from robosc.tools.diagrams.classes import ClassDiagram
from robosc.tools.diagrams.ros_graph import connections, ros_graph

if TYPE_CHECKING:
    from robosc.tools.diagrams.graph import Graph

__all__ = ["behaviour_graph", "connections", "diagram", "metamodel_diagram", "plants_graph", "ros_graph"]

METAMODELS = ("robosc", "sct", "rosgraph", "engine", "expression")
NOTATIONS = ("mermaid", "plantuml", "svg")
GRAPH_NOTATIONS = {"mermaid": notations.mermaid, "dot": notations.dot, "svg": notations.svg}


def diagram(graph: Graph, notation: str) -> str:
    """Return the text of a `behaviour_graph`, `plants_graph` or `ros_graph` in one of GRAPH_NOTATIONS.

    The text is reproducible. Mermaid and Graphviz (`dot`) leave the layout to their own tools; SVG is laid out here.
    Raises ValueError for another notation.
    """
    if notation not in GRAPH_NOTATIONS:
        raise ValueError(f"no diagram in {notation}: it is {', '.join(GRAPH_NOTATIONS)}")
    return GRAPH_NOTATIONS[notation](graph)


def metamodel_diagram(name: str, notation: str) -> str:
    """Return the class diagram of one of METAMODELS in one of NOTATIONS, from its .ecore file.

    The text is reproducible. Mermaid and PlantUML leave the layout to their own tools; SVG is laid out here. Raises
    ValueError for another name or notation.
    """
    if name not in METAMODELS or notation not in NOTATIONS:
        raise ValueError(f"no diagram of {name} in {notation}: it is {METAMODELS} in {NOTATIONS}")
    classes = ClassDiagram.of(name)
    if notation == "svg":
        return notations.render("picture.svg.j2", picture=draw(classes))
    return notations.render(f"classes.{notation}.j2", diagram=classes)
