"""The plants of an sct model: locations, events, guards, updates."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.diagnostics.visible import visible
from robosc.diagrams.automata import EVERY, State, Step, automaton
from robosc.diagrams.graph import Graph
from robosc.metamodel import expression as ex
from robosc.metamodel import sct
from robosc.semantics.edges import edges_from
from robosc.semantics.printing import SctPrinter
from robosc.semantics.roles import event_name, plant_of

if TYPE_CHECKING:
    from robosc.diagrams.graph import Group, Label


def plants_graph(model: sct.SupervisoryControlModel) -> Graph:
    """All plants, each as a group, in the order of the model."""
    groups = [_Plant(plant).group(f"p{number}") for number, plant in enumerate(model.plants, 1)]
    return Graph(f"{visible(model.name)}: plants", groups)


class _Plant(SctPrinter):
    """Says what one plant does, its own names without the plant before them."""

    def __init__(self, plant: sct.Plant) -> None:
        self.plant = plant

    def group(self, key: str) -> Group:
        locations = list(self.plant.locations)
        numbers = {location: number for number, location in enumerate(locations)}
        steps = [
            Step(number, numbers[edge.target], self.label(edge))
            for location, number in numbers.items()
            for edge in edges_from(location)
        ]
        return automaton(
            key,
            self.plant.name,
            [
                f"{variable.name}: {_type(variable.type)} = {self(variable.initial)}"
                for variable in self.plant.variables
            ],
            [State(location.name, location.initial, location.marked) for location in locations],
            _joined(steps, locations, alike=self.plant.kind == sct.PlantKind.data),
        )

    def label(self, edge: sct.Edge) -> Label:
        own = plant_of(edge.event) is self.plant
        guard = [] if edge.guard is None else [f"if {self(edge.guard)}"]
        updates = [
            f"{self(sct.VariableReference(variable=update.variable))} := {self(update.value)}"
            for update in edge.updates
        ]
        return (edge.event.name if own else event_name(edge.event), *guard, *updates)

    def atom(self, expression: ex.Expression) -> str:
        """A location or variable of the plant itself by its bare name; an input by its own, as its event is near."""
        match expression:
            case sct.LocationReference() if expression.location.eContainer() is self.plant:
                return expression.location.name
            case sct.VariableReference() if expression.variable.eContainer() is self.plant:
                return expression.variable.name
            case sct.InputReference():
                return expression.input.name
        return super().atom(expression)


def _joined(steps: list[Step], locations: list[sct.Location], *, alike: bool) -> list[Step]:
    """What happens in every location in one way, said once: it leads to the same one from all, or stays in each.

    With two locations a cycle between them is told apart from that, unless the locations are `alike` on purpose.
    """
    if len(locations) < (2 if alike else 3):
        return steps
    ways: dict[tuple[Label, int | None], set[int]] = {}
    for step in steps:
        ways.setdefault((step.label, step.target), set()).add(step.source)
        if step.source == step.target:
            ways.setdefault((step.label, None), set()).add(step.source)
    common = [way for way, sources in ways.items() if len(sources) == len(locations)]
    rest = [
        step
        for step in steps
        if (step.label, step.target) not in common and not (step.source == step.target and (step.label, None) in common)
    ]
    return [*(Step(EVERY, target, label) for label, target in common), *rest]


def _type(value_type: ex.Type) -> str:
    match value_type:
        case ex.EnumerationType():
            return value_type.enumeration.name
        case ex.IntegerType() if value_type.minimum is not None:
            return f"integer({value_type.minimum}..{value_type.maximum})"
    return type(value_type).__name__.removesuffix("Type").lower()
