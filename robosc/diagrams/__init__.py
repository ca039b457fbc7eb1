"""Diagrams of the metamodels: classes with their features, and how they inherit, contain and refer."""

from __future__ import annotations

from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from robosc.diagrams.classes import ClassDiagram
from robosc.diagrams.drawing import draw

METAMODELS = ("robosc", "sct", "rosgraph", "expression")
NOTATIONS = ("mermaid", "plantuml", "svg")


def metamodel_diagram(name: str, notation: str) -> str:
    """The class diagram of one of METAMODELS in one of NOTATIONS, made of its .ecore file; the same text every time.

    Mermaid and PlantUML leave the layout to their own tools; SVG is laid out here. Raises ValueError for a name or a
    notation that is none of these.
    """
    if name not in METAMODELS or notation not in NOTATIONS:
        raise ValueError(f"no diagram of {name} in {notation}: it is {METAMODELS} in {NOTATIONS}")
    diagram = ClassDiagram.of(name)
    templates = Environment(
        loader=FileSystemLoader(Path(__file__).with_name("templates")),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=notation == "svg",  # noqa: S701 - the other notations are no XML
    )
    template = templates.get_template(f"classes.{notation}.j2")
    return template.render(diagram=diagram, drawing=draw(diagram) if notation == "svg" else None)
