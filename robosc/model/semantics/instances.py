"""Instances of components: one for each component of a robot's text, and one for each import from a library."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Generic, TypeAlias, TypeVar

from robosc.model import robosc
from robosc.model.semantics.expansion import Expansion, constant, constant_value
from robosc.model.semantics.walks import parts

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from robosc.model import expression as ex

_Element = TypeVar("_Element", bound="ex.Located")


@dataclass(frozen=True, eq=False)
class Instance:
    """A component of a robot, or of a library that is analyzed by itself.

    `definition` is the component whose text defines it, in the robot or library `unit`. Names in this text resolve in
    `unit`. `arguments` are the values of its parameters.
    """

    component: robosc.Component
    local: robosc.LocalComponent
    unit: robosc.Base
    definition: robosc.Component
    topics: dict[robosc.CommunicationType, str] = field(default_factory=dict)
    arguments: dict[robosc.FormalParameter, ex.Expression] = field(default_factory=dict)
    _types: dict[robosc.DataType, robosc.DataType] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """Name of the component in the robot."""
        return self.component.name

    @property
    def communications(self) -> list[robosc.CommunicationType]:
        """Messages, services and actions, in the order of the text."""
        return [definition for definition in self.local.definitions if isinstance(definition, robosc.CommunicationType)]

    @property
    def automaton(self) -> robosc.Automaton | None:
        """Behaviour of the component, if it has one."""
        behaviours = (
            definition for definition in self.local.definitions if isinstance(definition, robosc.ComponentBehaviour)
        )
        return next((behaviour.automaton for behaviour in behaviours), None)

    @property
    def states(self) -> list[robosc.State]:
        """States of the behaviour, in the order of the text."""
        return [definition for definition in self._definitions if isinstance(definition, robosc.State)]

    @property
    def variables(self) -> list[InstanceVariable]:
        """Variables of the behaviour, in the order of the text."""
        declared = (definition for definition in self._definitions if isinstance(definition, robosc.Variable))
        return [InstanceVariable(self, variable) for variable in declared]

    @property
    def transitions(self) -> list[tuple[robosc.Transition, robosc.State | None]]:
        """Transitions of the behaviour in the order of the text, each with its state. None: every state has it."""
        transitions: list[tuple[robosc.Transition, robosc.State | None]] = []
        for definition in self._definitions:
            if isinstance(definition, robosc.State):
                transitions += ((transition, definition) for transition in definition.transitions)
            elif isinstance(definition, robosc.Transition):
                transitions.append((definition, None))
        return transitions

    @property
    def _definitions(self) -> Iterable[robosc.AutomatonDefinition]:
        return self.automaton.definitions if self.automaton else ()

    def topic(self, communication: robosc.CommunicationType) -> str:
        """Return the ROS name of a communication: remapped, given, or the communication's own name."""
        computed = communication.computedIdentifier
        if communication in self.topics or computed is None:
            return self.topics.get(communication) or communication.identifier or communication.name
        topic = constant_value(computed, self)
        return topic if isinstance(topic, str) and topic else communication.name

    def data_type(self, declared: robosc.DataType) -> robosc.DataType:
        """Return a type in the instance's text. Integer bounds that depend on arguments are computed."""
        if not isinstance(declared, robosc.IntegerDataType) or declared.lower is None or declared.minimum is not None:
            return declared
        if declared not in self._types:
            low, high = constant_value(declared.lower, self), constant_value(declared.upper, self)
            self._types[declared] = bounded_type = robosc.IntegerDataType(source=declared.source)
            if isinstance(low, int) and isinstance(high, int):
                bounded_type.minimum, bounded_type.maximum = low, high
        return self._types[declared]


#: Maximum count of an event in a requirement that counts.
MOST = 1000
#: Instance of each component that imports one. None if its import is broken.
Resolved: TypeAlias = "dict[robosc.Component, Instance | None]"


@dataclass(frozen=True)
class PortInstance:
    """A communication of one instance."""

    instance: Instance
    communication: robosc.CommunicationType


@dataclass(frozen=True)
class InstanceVariable:
    """A variable of one instance."""

    instance: Instance
    variable: robosc.Variable

    @property
    def type(self) -> robosc.DataType:
        """Type of the variable, with the bounds of an integer computed."""
        return self.instance.data_type(self.variable.type)


@dataclass(frozen=True)
class InstanceParameter:
    """A parameter of one instance; None: of the robot or a library."""

    instance: Instance | None
    parameter: robosc.Parameter

    @property
    def name(self) -> str:
        """Name of the parameter on the robot: `speed`, or `Base.speed` in a component."""
        return self.parameter.name if self.instance is None else f"{self.instance.name}.{self.parameter.name}"


@dataclass(frozen=True)
class Statement(Generic[_Element]):
    """A definition, such as a requirement, and the instance whose text contains it.

    None: it is outside of components.
    """

    element: _Element
    within: Instance | None


class Instances:
    """All instances of a base, in the order of its text, and the targets of references among them.

    The target of an unresolved reference is None.
    """

    def __init__(self, base: robosc.Base, resolved: Resolved | None = None) -> None:
        """Create the instances of a base.

        `resolved` caches the instances of imported components across several bases. New instances are added to it.
        """
        self.base = base
        self._of: dict[robosc.Component, Instance] = {}
        resolved = {} if resolved is None else resolved
        self.expanded = Expansion(self)
        for definition in base.definitions:
            if isinstance(definition, robosc.Component):
                instance = _instantiate(definition, base, resolved)
                if instance is not None:
                    self._of[definition] = instance

    def __iter__(self) -> Iterator[Instance]:
        return iter(self._of.values())

    def ports(self) -> Iterator[PortInstance]:
        """Iterate over the communications of all instances, in the order of the text."""
        for instance in self:
            for communication in instance.communications:
                yield PortInstance(instance, communication)

    def is_shared(self, communication: robosc.CommunicationType) -> bool:
        """Return whether another instance has a communication of the same name."""
        return self._names[communication.name] > 1

    def provide_statements(self, port: PortInstance) -> list[Statement[robosc.ProvideStatement]]:
        """Return the statements on the data of a communication, in the order of the text.

        Statements outside of components override those inside.
        """
        statements = self._provided.get(port, [])
        outside = [statement for statement in statements if statement.within is None]
        return outside or statements

    def statements(self, kind: type[_Element]) -> list[Statement[_Element]]:
        """Return the requirements, or other definitions of a kind: outside of components, then in each instance."""
        statements: list[Statement[_Element]] = []
        texts: list[tuple[Iterable[Any], Instance | None]] = [(self.base.definitions, None)]
        texts += ((instance.local.definitions, instance) for instance in self)
        texts += ((self._library_assumptions(instance), instance) for instance in self)
        for definitions, within in texts:
            statements += [Statement(definition, within) for definition in definitions if isinstance(definition, kind)]
        return statements

    def _library_assumptions(self, instance: Instance) -> list[robosc.Assumption]:
        """Return the assumptions about an imported component that are outside of components in its library."""
        if instance.unit is self.base:
            return []
        outside = (definition for definition in instance.unit.definitions if isinstance(definition, robosc.Assumption))
        return [assumption for assumption in outside if instance.definition in assumed_components(assumption, self)]

    def of(self, component: robosc.Component) -> list[Instance]:
        """Return the instances that a component's text defines."""
        return [instance for instance in self if instance.definition is component]

    def instance(self, component: robosc.Component | None, within: Instance | None) -> Instance | None:
        """Return the instance that a text refers to by a component.

        `within` is the instance whose behaviour the text is.
        """
        if within is not None and (component is None or component is within.definition):
            return within
        return None if component is None else self._of.get(component)

    def port(self, reference: robosc.CommunicationReference | None, within: Instance | None) -> PortInstance | None:
        """Return the communication that a reference refers to. None if it is unresolved."""
        instance = self.instance(reference.component, within) if reference else None
        if instance is None or reference is None or reference.communicationType is None:
            return None
        return PortInstance(instance, reference.communicationType)

    def variable(self, access: robosc.Access, within: Instance | None) -> InstanceVariable | None:
        """Return the variable that an access reads. None if it reads something else."""
        instance = self.instance(access.component, within)
        if instance is None or not isinstance(access.item, robosc.Variable):
            return None
        return InstanceVariable(instance, access.item)

    @property
    def parameters(self) -> list[InstanceParameter]:
        """Parameters that are set on the robot: of its own text, of its libraries, and of each instance."""
        texts: list[tuple[Iterable[Any], Instance | None]] = [
            (base.definitions, None) for base in (self.base, *libraries(self.base))
        ]
        texts += ((instance.local.definitions, instance) for instance in self)
        return [
            InstanceParameter(within, definition)
            for definitions, within in texts
            for definition in definitions
            if isinstance(definition, robosc.Parameter)
        ]

    def parameter(self, access: robosc.Access, within: Instance | None) -> InstanceParameter:
        """Return the parameter that an access reads."""
        parameter = access.item
        assert isinstance(parameter, robosc.Parameter)
        is_member = isinstance(parameter.eContainer(), robosc.LocalComponent)
        return InstanceParameter(self.instance(access.component, within) if is_member else None, parameter)

    def assignments(self, transition: robosc.Transition, within: Instance) -> dict[InstanceVariable, robosc.Assignment]:
        """Return the assignments of a transition by variable. The last assignment to a variable counts."""
        owned = (
            (self.variable(assignment.item, within), assignment)
            for assignment in transition.assignments
            if assignment.item
        )
        return {variable: assignment for variable, assignment in owned if variable is not None}

    @cached_property
    def _names(self) -> Counter[str]:
        return Counter(port.communication.name for port in self.ports())

    @cached_property
    def _provided(self) -> dict[PortInstance, list[Statement[robosc.ProvideStatement]]]:
        provided: dict[PortInstance, list[Statement[robosc.ProvideStatement]]] = {}
        for statement in self.statements(robosc.ProvideStatement):
            port = self.port(statement.element.communicationType, statement.within)
            if port is not None:
                provided.setdefault(port, []).append(statement)
        return provided


def assumed_components(assumption: robosc.Assumption, instances: Instances) -> list[robosc.Component]:
    """Return the components that an assumption outside of components names, in the order of its text."""
    named = [event.communicationType.component for event in assumption.target.events if event.communicationType]
    named += [
        access.item if isinstance(access.item, robosc.Component) else access.component
        for access in parts(instances.expanded(assumption.condition, None))
        if isinstance(access, robosc.Access)
    ]
    return list(dict.fromkeys(component for component in named if component is not None))


def imported_components(base: robosc.Base) -> list[tuple[robosc.Component, robosc.Library]]:
    """Return each imported component with its library, in the order of the text. Skips unresolved libraries."""
    return [
        (component, component.type.library)
        for component in base.definitions
        if isinstance(component, robosc.Component)
        and isinstance(component.type, robosc.ImportedComponent)
        and component.type.library
    ]


def libraries(
    base: robosc.Base,
    imports: Callable[[robosc.Base], list[tuple[robosc.Component, robosc.Library]]] = imported_components,
) -> list[robosc.Library]:
    """Return every library that a base imports, directly or indirectly, each once, the nearest first.

    The base itself is not included. `imports` returns the imports of a base, for callers that have them already.
    """
    imported_libraries: dict[robosc.Library, None] = {}
    queue: list[robosc.Base] = [base]
    for current in queue:
        for _, library in imports(current):
            if library not in imported_libraries and library is not base:
                imported_libraries[library] = None
                queue.append(library)
    return list(imported_libraries)


def definition_of(component: robosc.Component) -> robosc.Component | None:
    """Return the component whose text declares a component's members. None if an import on the way is broken."""
    seen = {component}
    while isinstance(component.type, robosc.InstantiatedComponent | robosc.ImportedComponent):
        component = component.type.definition
        if component is None or component in seen:
            return None
        seen.add(component)
    return component if isinstance(component.type, robosc.LocalComponent) else None


def bound_arguments(
    parameters: Sequence[robosc.FormalParameter], arguments: Sequence[robosc.Argument]
) -> dict[robosc.FormalParameter, ex.Expression]:
    """Return the expression of each parameter: by name, by position, or its default. The first of duplicates counts."""
    bound: dict[robosc.FormalParameter, ex.Expression] = {}
    for position, argument in enumerate(arguments):
        parameter = argument.parameter or (parameters[position] if position < len(parameters) else None)
        if parameter is not None and argument.value is not None:
            bound.setdefault(parameter, argument.value)
    defaults = ((parameter, parameter.default) for parameter in parameters if parameter.default is not None)
    return dict(defaults) | bound


def _instantiate(component: robosc.Component, base: robosc.Base, resolved: Resolved) -> Instance | None:
    """Follow `is` and imports to the component's definition. Outer remappings win."""
    if component.parameters:
        return None  # a template
    chain: list[tuple[robosc.Component, robosc.InstantiatedComponent | robosc.ImportedComponent]] = []
    unit, current, seen = base, component, {component}
    instance: Instance | None = None
    while current not in resolved:
        kind = current.type
        if isinstance(kind, robosc.LocalComponent):
            instance = Instance(current, kind, unit, current)
            break
        if not isinstance(kind, robosc.InstantiatedComponent | robosc.ImportedComponent):
            break
        chain.append((current, kind))
        unit, current = kind.library if isinstance(kind, robosc.ImportedComponent) else unit, kind.definition
        if unit is None or current is None or current in seen:
            break
        seen.add(current)
    else:
        instance = resolved[current]
    for importing, kind in reversed(chain):
        if instance is not None:
            topics: dict[robosc.CommunicationType, str] = {}
            for remapping in kind.remappings if isinstance(kind, robosc.ImportedComponent) else ():
                topics.setdefault(remapping.communicationType, _identifier(remapping))
            arguments = instance.arguments
            if instance.component.parameters:
                bound = bound_arguments(instance.component.parameters, kind.arguments)
                arguments = {parameter: constant(value) for parameter, value in bound.items()}
            topics |= instance.topics | topics
            instance = Instance(importing, instance.local, instance.unit, instance.definition, topics, arguments)
        resolved[importing] = instance
    return instance


def _identifier(remapping: robosc.TopicRemapping) -> str:
    computed = constant_value(remapping.computedIdentifier) if remapping.computedIdentifier else remapping.identifier
    return computed if isinstance(computed, str) else ""
