"""Automata as groups of a diagram: behaviors of components as in their text, and the plants of an sct model."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.base.diagnostics.visible import visible
from robosc.model import expression as ex
from robosc.model import robosc, sct
from robosc.model.semantics.communication import event_of
from robosc.model.semantics.durations import timer_text
from robosc.model.semantics.edges import edges_from
from robosc.model.semantics.instances import Instances
from robosc.model.semantics.naming import escape_keyword
from robosc.model.semantics.printing import RoboscPrinter, SctPrinter
from robosc.model.semantics.roles import event_name, plant_of
from robosc.tools.diagrams.graph import Arrow, DiagramNode, Graph, Group

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.model.semantics.instances import Instance
    from robosc.tools.diagrams.graph import Label

    State = robosc.State | sct.Location


def behaviour_graph(base: robosc.Base) -> Graph:
    """Return the components of a robot or library that have a behavior, including imported ones, each as a group."""
    instances = Instances(base)
    shown = [instance for instance in instances if instance.automaton is not None]
    groups = [_Component(instance, instances).group(f"c{number}") for number, instance in enumerate(shown, 1)]
    return Graph(f"{visible(base.name)}: behaviour", groups)


def plants_graph(model: sct.SupervisoryControlModel) -> Graph:
    """Return all plants of an sct model, each as a group, in the order of the model."""
    groups = [_Plant(plant).group(f"p{number}") for number, plant in enumerate(model.plants, 1)]
    return Graph(f"{visible(model.name)}: plants", groups)


@dataclass(frozen=True)
class _DiagramStep:
    """A step from a state (None: from every state) to another one (None: it stays)."""

    source: State | None
    target: State | None
    label: Label

    @property
    def stays(self) -> bool:
        return self.target is None or self.source is self.target


def _automaton(
    key: str, title: str, remarks: Sequence[str], states: Sequence[State], steps: Sequence[_DiagramStep]
) -> Group:
    """Return the group of an automaton: steps that stay are rows of their state, steps between two states one arrow.

    The keys of the group's nodes begin with the key of the group.
    """
    keys: dict[State | None, str] = {None: f"{key}_every"}
    keys |= {state: f"{key}_{number}" for number, state in enumerate(states, 1)}
    rows: dict[State | None, list[Label]] = {state: [] for state in keys}
    between: dict[tuple[str, str], list[Label]] = {}
    for step in steps:
        label = tuple(map(visible, step.label))
        if step.stays:
            rows[step.source].append(label)
        else:
            between.setdefault((keys[step.source], keys[step.target]), []).append(label)
    nodes = [
        DiagramNode(keys[state], "state", visible(state.name), rows[state], initial=state.initial, marked=state.marked)
        for state in states
    ]
    if any(step.source is None for step in steps):
        nodes.insert(0, DiagramNode(keys[None], "every", "everywhere", rows[None]))
    arrows = [Arrow(source, target, tuple(labels)) for (source, target), labels in between.items()]
    return Group(key, visible(title), list(map(visible, remarks)), nodes, arrows)


class _Component(RoboscPrinter):
    """Prints the behavior of one component; its own names are not qualified."""

    def __init__(self, instance: Instance, instances: Instances) -> None:
        self.instance = instance
        self.instances = instances

    def group(self, key: str) -> Group:
        assert self.instance.automaton is not None
        definitions = self.instance.automaton.definitions
        states = [definition for definition in definitions if isinstance(definition, robosc.State)]
        sources: list[tuple[robosc.State | None, robosc.Transition]] = [
            (None, definition) for definition in definitions if isinstance(definition, robosc.Transition)
        ]
        sources += [(state, transition) for state in states for transition in state.transitions]
        return _automaton(
            key,
            self.instance.name,
            [self.variable(definition) for definition in definitions if isinstance(definition, robosc.Variable)],
            states,
            [_DiagramStep(source, transition.target, self.label(transition)) for source, transition in sources],
        )

    def variable(self, variable: robosc.Variable) -> str:
        initial = "" if variable.initial is None else f" = {self(variable.initial)}"
        return f"{variable.name}: {_type(variable.type)}{initial}"

    def label(self, transition: robosc.Transition) -> Label:
        match transition:
            case robosc.ResultTransition():
                row = event_of(transition.communicationType, transition.resultType)
                word = row.preposition if row is not None else "from"
                first = f"on {transition.resultType} {word} {self.communication(transition.communicationType)}"
            case robosc.TauTransition():
                first = "transition"
            case robosc.TimedTransition():
                first = f"after {self(transition.duration)} {transition.unit}"
                if transition.without:
                    first += f" without {', '.join(map(self.communication, transition.without))}"
        if isinstance(transition, robosc.GuardedTransition) and transition.guard is not None:
            first += f" if {self(transition.guard)}"
        return (first, *self.assignments(transition.assignments))

    def assignments(self, assignments: Sequence[robosc.Assignment]) -> list[str]:
        texts = [f"{self(assignment.item)} := {self(assignment.value)}" for assignment in assignments]
        # One line per assignment, ended by the comma before the next one.
        return ("do " + ",\n".join(texts)).split("\n") if texts else []

    def communication(self, reference: robosc.CommunicationReference) -> str:
        """Return the name of a communication, qualified if it is of another component and the name is ambiguous."""
        port = self.instances.port(reference, self.instance)
        assert port is not None
        name = escape_keyword(port.communication.name)
        others = sum(other.communication.name == port.communication.name for other in self.instances.ports())
        return name if port.instance is self.instance or others == 1 else f"{escape_keyword(port.instance.name)}.{name}"

    def owner(self, component: robosc.Component) -> str:
        """Return the qualifier of a name, which is empty for the component itself."""
        own = self.instances.instance(component, self.instance) is self.instance
        return "" if own else super().owner(component)


class _Plant(SctPrinter):
    """Prints the behavior of one plant; its own names are not qualified."""

    def __init__(self, plant: sct.Plant) -> None:
        self.plant = plant

    def group(self, key: str) -> Group:
        locations = self.plant.locations
        steps = [
            _DiagramStep(location, edge.target, self.label(edge))
            for location in locations
            for edge in edges_from(location)
        ]
        return _automaton(
            key,
            self.plant.name,
            [
                f"{variable.name}: {_type(variable.type)}"
                + (f" = {self(variable.initial)}" if variable.initial else "")
                for variable in self.plant.variables
            ],
            locations,
            _joined(steps, len(locations), alike=self.plant.kind == sct.PlantKind.data),
        )

    def label(self, edge: sct.Edge) -> Label:
        own = plant_of(edge.event) is self.plant
        guard = [] if edge.guard is None else [f"if {self(edge.guard)}"]
        updates = [
            f"{self(sct.VariableReference(variable=update.variable))} := {self(update.value)}"
            for update in edge.updates
        ]
        timer = [f"after {timer_text(edge.event.timer)}"] if own and edge.event.timer else []
        return (edge.event.name if own else event_name(edge.event), *timer, *guard, *updates)

    def atom(self, expression: ex.Expression) -> str:
        """Print an atom.

        Locations and variables of the plant itself, and inputs of the event, are not qualified.
        """
        match expression:
            case sct.LocationReference() if expression.location.eContainer() is self.plant:
                return expression.location.name
            case sct.VariableReference() if expression.variable.eContainer() is self.plant:
                return expression.variable.name
            case sct.InputReference():
                return expression.input.name
        return super().atom(expression)


def _joined(steps: list[_DiagramStep], locations: int, *, alike: bool) -> list[_DiagramStep]:
    """Merge steps that every location has into one, if all lead to the same location or all stay.

    With two locations a cycle between them would look like that, so they are only merged if they are `alike` on
    purpose.
    """
    if locations < (2 if alike else 3):
        return steps
    ways: dict[tuple[Label, State | None], set[State | None]] = {}
    for step in steps:
        ways.setdefault((step.label, step.target), set()).add(step.source)
        if step.stays:
            ways.setdefault((step.label, None), set()).add(step.source)
    common = [way for way, sources in ways.items() if len(sources) == locations]
    rest = [
        step
        for step in steps
        if (step.label, step.target) not in common and not (step.stays and (step.label, None) in common)
    ]
    return [*(_DiagramStep(None, target, label) for label, target in common), *rest]


def _type(kind: robosc.DataType | ex.Type) -> str:
    match kind:
        case ex.EnumerationType():
            return kind.enumeration.name
        case robosc.ComplexDataTypeReference():
            return escape_keyword(kind.type.name)
        case robosc.Array():
            return f"array({_type(kind.type)})"
        case ex.IntegerType() | robosc.IntegerDataType() if kind.minimum is not None:
            return f"integer({kind.minimum}..{kind.maximum})"
    return type(kind).__name__.removesuffix("Type").removesuffix("Data").lower()
