"""The automaton of each component, as its text has it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.diagnostics.visible import visible
from robosc.diagrams.automata import EVERY, State, Step, automaton
from robosc.diagrams.graph import Graph
from robosc.metamodel import expression as ex
from robosc.metamodel import robosc
from robosc.semantics.instances import Instances
from robosc.semantics.naming import written
from robosc.semantics.printing import RoboscPrinter

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.diagrams.graph import Group, Label
    from robosc.semantics.instances import Instance


def behaviour_graph(base: robosc.Base) -> Graph:
    """The components of a robot or a library that have a behaviour, imported ones included, each as a group."""
    instances = Instances(base)
    shown = [instance for instance in instances if instance.automaton is not None]
    groups = [_Component(instance, instances).group(f"c{number}") for number, instance in enumerate(shown, 1)]
    return Graph(f"{visible(base.name)}: behaviour", groups)


class _Component(RoboscPrinter):
    """Says what one component does, its own names without the component before them."""

    def __init__(self, instance: Instance, instances: Instances) -> None:
        self.instance = instance
        self.instances = instances

    def group(self, key: str) -> Group:
        automaton_model = self.instance.automaton
        assert automaton_model is not None
        definitions = automaton_model.definitions
        states = [definition for definition in definitions if isinstance(definition, robosc.State)]
        numbers = {state: number for number, state in enumerate(states)}
        sources = [(EVERY, definition) for definition in definitions if isinstance(definition, robosc.Transition)]
        sources += [(numbers[state], transition) for state in states for transition in state.transitions]
        return automaton(
            key,
            self.instance.name,
            [self.variable(definition) for definition in definitions if isinstance(definition, robosc.Variable)],
            [State(state.name, state.initial, state.marked) for state in states],
            [
                Step(source, None if transition.target is None else numbers[transition.target], self.label(transition))
                for source, transition in sources
            ],
        )

    def variable(self, variable: robosc.Variable) -> str:
        initial = "" if variable.initial is None else f" = {self(variable.initial)}"
        return f"{variable.name}: {_type(variable.type)}{initial}"

    def label(self, transition: robosc.Transition) -> Label:
        match transition:
            case robosc.ResultTransition():
                kind = transition.resultType.name
                word = "to" if kind == "request" else "from"
                first = f"on {kind} {word} {self.communication(transition.communicationType)}"
            case robosc.TauTransition():
                first = "transition" if transition.guard is None else f"transition if {self(transition.guard)}"
        return (first, *self.assignments(transition.assignments))

    def assignments(self, assignments: Sequence[robosc.Assignment]) -> list[str]:
        texts = [f"{self(assignment.item)} := {self(assignment.value)}" for assignment in assignments]
        # A line for each, with the comma that parts it from the next.
        return ("do " + ",\n".join(texts)).split("\n") if texts else []

    def communication(self, reference: robosc.CommunicationReference) -> str:
        """Its name; with its component where two share the name and it is the other's."""
        port = self.instances.port(reference, self.instance)
        assert port is not None
        name = written(port.communication.name)
        others = sum(other.communication.name == port.communication.name for other in self.instances.ports())
        own = port.instance is self.instance
        return name if own or others == 1 else f"{written(port.instance.name)}.{name}"

    def atom(self, expression: ex.Expression) -> str:
        """A name of the component itself without the component."""
        text = super().atom(expression)
        if isinstance(expression, robosc.Access) and expression.component is not None:
            owner = self.instances.instance(expression.component, self.instance)
            if owner is self.instance:
                return text.removeprefix(f"{written(expression.component.name)}.")
        return text


def _type(data_type: robosc.DataType) -> str:
    match data_type:
        case robosc.ComplexDataTypeReference():
            return written(data_type.type.name)
        case robosc.IntegerDataType():
            limits = "" if data_type.minimum is None else f"({data_type.minimum}..{data_type.maximum})"
            return f"integer{limits}"
        case robosc.Array():
            return f"array({_type(data_type.type)})"
    return type(data_type).__name__.removesuffix("DataType").lower()
