"""What the elements of a ROS graph are called in C++; the sct model's are called as in C."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

from robosc.configuration.parameters import topic_words
from robosc.m2t.c.names import TAKEN, CNames, identifier
from robosc.metamodel import expression as ex
from robosc.metamodel import rosgraph, sct
from robosc.semantics.naming import Names
from robosc.semantics.operators import PRECEDENCE
from robosc.semantics.printing import Printed

if TYPE_CHECKING:
    from collections.abc import Sequence

_Element = TypeVar("_Element", bound=ex.NamedElement)


class CppNames:
    """The C++ names of the elements of one graph. No two in one scope are the same, none is a keyword."""

    def __init__(self, graph: rosgraph.RosGraph) -> None:
        self.c = CNames(graph.model)
        self._enumerations = _fresh(graph.enumerations)
        self._literals = {
            literal: name
            for enumeration in graph.enumerations
            for literal, name in _fresh(enumeration.literals).items()
        }
        self._conversions = _fresh(graph.conversions)
        #: The variables that a node keeps, by component.
        self.kept: dict[str, list[rosgraph.NodeVariable]] = {}
        for variable in graph.variables:
            self.kept.setdefault(variable.component or "", []).append(variable)
        components = Names(TAKEN)
        self.components = {name: components.fresh(identifier(name)) for name in self.kept}
        #: What is set on the robot stands beside the components.
        self.parameters = components.fresh("parameters")
        self._variables = {
            variable: name for variables in self.kept.values() for variable, name in _fresh(variables).items()
        } | _fresh(graph.parameters)
        self._words = topic_words(graph)

    def enumeration(self, enumeration: ex.Enumeration) -> str | None:
        """The type of an enumeration that only the node knows; None for one of the sct model."""
        return f"model::{self.within(enumeration)}" if enumeration in self._enumerations else None

    def literal(self, literal: ex.EnumerationLiteral) -> str:
        """A literal, wherever it is used."""
        if literal not in self._literals:
            return self.c.enumerator(literal)
        return f"{self.enumeration(literal.eContainer())}::{self.within(literal)}"

    def within(self, element: ex.Enumeration | ex.EnumerationLiteral) -> str:
        """An enumeration that only the node knows, or a literal of one, where it is declared."""
        return self._literals[element] if isinstance(element, ex.EnumerationLiteral) else self._enumerations[element]

    def literal_name(self, enumeration: ex.Enumeration) -> str:
        """The function that gives the model's name of a literal."""
        return self.c.lookup(enumeration) if self.enumeration(enumeration) is None else "literal_name"

    def conversion(self, conversion: rosgraph.Conversion) -> str:
        """The function that makes a literal of data."""
        return f"to_{self._conversions[conversion]}"

    def member(self, variable: rosgraph.NodeVariable) -> str:
        """A variable of the node, in its component."""
        return self._variables[variable]

    def variable(self, variable: rosgraph.NodeVariable) -> str:
        """A variable of the node, in the struct of all."""
        if isinstance(variable, rosgraph.Parameter):
            return f"{self.parameters}.{self.member(variable)}"
        return f"{self.components[variable.component or '']}.{self.member(variable)}"

    def word(self, topic: rosgraph.Subscription | rosgraph.Publisher) -> str:
        """A word for a subscription or publisher: its topic's name, as far as C++ can write it."""
        return self._words[topic]

    def state(self, element: sct.Plant | sct.DiscreteVariable) -> str:
        """A variable of the supervisor's state, or the location of a plant that has several."""
        return f"supervisor_.state.{self.c.member(element)}"

    def is_in(self, location: sct.Location) -> str:
        """Whether a plant is in a location; without parentheses."""
        return self.location(location).text

    def location(self, location: sct.Location) -> Printed:
        """The same, with its precedence."""
        plant: sct.Plant = location.eContainer()
        if len(plant.locations) == 1:
            return Printed("true")
        return Printed(f"{self.state(plant)} == {self.c.enumerator(location)}", PRECEDENCE[ex.Equation])


def _fresh(elements: Sequence[_Element]) -> dict[_Element, str]:
    names = Names(TAKEN)
    return {element: names.fresh(identifier(element.name)) for element in elements}
