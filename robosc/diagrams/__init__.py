"""Diagrams of the metamodels, and of robots: the behaviour of components, the plants, the ROS graph."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.diagrams import notations
from robosc.diagrams.automata import behaviour_graph, plants_graph
from robosc.diagrams.class_drawing import draw
from robosc.diagrams.classes import ClassDiagram
from robosc.diagrams.ros_graph import connections, ros_graph

if TYPE_CHECKING:
    from robosc.diagrams.graph import Graph

__all__ = ["behaviour_graph", "connections", "diagram", "metamodel_diagram", "plants_graph", "ros_graph"]

METAMODELS = ("robosc", "sct", "rosgraph", "engine", "expression")
NOTATIONS = ("mermaid", "plantuml", "svg")
GRAPH_NOTATIONS = {"mermaid": notations.mermaid, "dot": notations.dot, "svg": notations.svg}


def diagram(graph: Graph, notation: str) -> str:
    """What `behaviour_graph`, `plants_graph` or `ros_graph` made, in one of GRAPH_NOTATIONS; the same text every time.

    Mermaid and Graphviz (`dot`) leave the layout to their own tools; SVG is laid out here. Raises ValueError for a
    notation that is none of these.
    """
    if notation not in GRAPH_NOTATIONS:
        raise ValueError(f"no diagram in {notation}: it is {', '.join(GRAPH_NOTATIONS)}")
    return GRAPH_NOTATIONS[notation](graph)


def metamodel_diagram(name: str, notation: str) -> str:
    """The class diagram of one of METAMODELS in one of NOTATIONS, made of its .ecore file; the same text every time.

    Mermaid and PlantUML leave the layout to their own tools; SVG is laid out here. Raises ValueError for a name or a
    notation that is none of these.
    """
    if name not in METAMODELS or notation not in NOTATIONS:
        raise ValueError(f"no diagram of {name} in {notation}: it is {METAMODELS} in {NOTATIONS}")
    classes = ClassDiagram.of(name)
    if notation == "svg":
        return notations.render("picture.svg.j2", picture=draw(classes))
    return notations.render(f"classes.{notation}.j2", diagram=classes)
