"""C++ names for the elements of a ROS graph. The sct model's elements have their C names."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

from robosc.language.configuration.parameters import topic_words
from robosc.m2t.c.names import TAKEN, CNames, identifier
from robosc.model import expression as ex
from robosc.model import rosgraph, sct
from robosc.model.semantics.naming import Names
from robosc.model.semantics.operators import PRECEDENCE
from robosc.model.semantics.printing import Printed

if TYPE_CHECKING:
    from collections.abc import Sequence

_Element = TypeVar("_Element", bound=ex.NamedElement)


class CppNames:
    """C++ names for the elements of one graph. They are unique within a scope and no keywords."""

    def __init__(self, graph: rosgraph.RosGraph) -> None:
        self.c = CNames(graph.model)
        self._enumerations = _fresh(graph.enumerations)
        self._literals = {
            literal: name
            for enumeration in graph.enumerations
            for literal, name in _fresh(enumeration.literals).items()
        }
        self._conversions = _fresh(graph.conversions)
        #: Variables of the node by component.
        self.stored: dict[str, list[rosgraph.NodeVariable]] = {}
        for variable in graph.variables:
            self.stored.setdefault(variable.component or "", []).append(variable)
        components = Names(TAKEN)
        self.components = {name: components.fresh(identifier(name)) for name in self.stored}
        #: The parameters share the scope of the components.
        self.parameters = components.fresh("parameters")
        self._variables = {
            variable: name for variables in self.stored.values() for variable, name in _fresh(variables).items()
        } | _fresh(graph.parameters)
        self._words = topic_words(graph)

    def enumeration(self, enumeration: ex.Enumeration) -> str | None:
        """Return the type of an enumeration that only the node has. None for an enumeration of the sct model."""
        return f"model::{self.within(enumeration)}" if enumeration in self._enumerations else None

    def literal(self, literal: ex.EnumerationLiteral) -> str:
        """Return a literal as it is used everywhere."""
        if literal not in self._literals:
            return self.c.enumerator(literal)
        return f"{self.enumeration(literal.eContainer())}::{self.within(literal)}"

    def within(self, element: ex.Enumeration | ex.EnumerationLiteral) -> str:
        """Return an enumeration that only the node has, or a literal of one, as it is declared."""
        return self._literals[element] if isinstance(element, ex.EnumerationLiteral) else self._enumerations[element]

    def literal_name(self, enumeration: ex.Enumeration) -> str:
        """Return the function that returns the model's name of a literal."""
        return self.c.lookup(enumeration) if self.enumeration(enumeration) is None else "literal_name"

    def conversion(self, conversion: rosgraph.Conversion) -> str:
        """Return the function that converts data to a literal."""
        return f"to_{self._conversions[conversion]}"

    def member(self, variable: rosgraph.NodeVariable) -> str:
        """Return a variable of the node as a member of its component."""
        return self._variables[variable]

    def variable(self, variable: rosgraph.NodeVariable) -> str:
        """Return a variable of the node as a member of the struct of all variables."""
        if isinstance(variable, rosgraph.Parameter):
            return f"{self.parameters}.{self.member(variable)}"
        return f"{self.components[variable.component or '']}.{self.member(variable)}"

    def word(self, topic: rosgraph.Subscription | rosgraph.Publisher) -> str:
        """Return a word for a subscription or publisher: its topic's name in characters that C++ allows."""
        return self._words[topic]

    def state(self, element: sct.Plant | sct.DiscreteVariable) -> str:
        """Return a variable of the supervisor's state, or the location of a plant with several."""
        return f"supervisor_.state.{self.c.member(element)}"

    def is_in(self, location: sct.Location) -> str:
        """Return the condition that a plant is in a location, without parentheses."""
        return self.location(location).text

    def location(self, location: sct.Location) -> Printed:
        """Return the condition that a plant is in a location, with its precedence."""
        plant: sct.Plant = location.eContainer()
        if len(plant.locations) == 1:
            return Printed("true")
        return Printed(f"{self.state(plant)} == {self.c.enumerator(location)}", PRECEDENCE[ex.Equation])


def _fresh(elements: Sequence[_Element]) -> dict[_Element, str]:
    names = Names(TAKEN)
    return {element: names.fresh(identifier(element.name)) for element in elements}
