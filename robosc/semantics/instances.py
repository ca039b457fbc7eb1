"""Instances of components: each component of a robot's own text, and one of a library's component for each import."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, TypeAlias

from robosc.metamodel import robosc

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator


@dataclass(frozen=True, eq=False)
class Instance:
    """One component of a robot, or of a library looked at by itself.

    `unit` is the robot or library whose text defines it; names in that text mean what they mean there.
    """

    component: robosc.Component
    local: robosc.LocalComponent
    unit: robosc.Base
    topics: dict[robosc.CommunicationType, str] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """The component's name in the robot."""
        return self.component.name

    @property
    def communications(self) -> list[robosc.CommunicationType]:
        """Its messages, services and actions, in the order of the text."""
        return [definition for definition in self.local.definitions if isinstance(definition, robosc.CommunicationType)]

    @property
    def automaton(self) -> robosc.Automaton | None:
        """Its behaviour, if it has one."""
        behaviours = (
            definition for definition in self.local.definitions if isinstance(definition, robosc.ComponentBehaviour)
        )
        return next((behaviour.automaton for behaviour in behaviours), None)

    @property
    def states(self) -> list[robosc.State]:
        """The states of its behaviour, in the order of the text."""
        return [definition for definition in self._definitions if isinstance(definition, robosc.State)]

    @property
    def variables(self) -> list[InstanceVariable]:
        """The variables of its behaviour, in the order of the text."""
        declared = (definition for definition in self._definitions if isinstance(definition, robosc.Variable))
        return [InstanceVariable(self, variable) for variable in declared]

    @property
    def transitions(self) -> list[tuple[robosc.Transition, robosc.State | None]]:
        """The transitions of its behaviour in the order of the text, each with its state; None: every state has it."""
        found: list[tuple[robosc.Transition, robosc.State | None]] = []
        for definition in self._definitions:
            if isinstance(definition, robosc.State):
                found += ((transition, definition) for transition in definition.transitions)
            elif isinstance(definition, robosc.Transition):
                found.append((definition, None))
        return found

    @property
    def _definitions(self) -> Iterable[robosc.AutomatonDefinition]:
        return self.automaton.definitions if self.automaton else ()

    def topic(self, communication: robosc.CommunicationType) -> str:
        """The ROS name of one of its communications: re-mapped, given, or the communication's own name."""
        return self.topics.get(communication) or communication.identifier or communication.name


#: The instance of each component that imports one; None where its import is broken.
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


class Instances:
    """All instances of a base, in the order of its text, and what references in texts mean among them.

    References that linking could not resolve mean None.
    """

    def __init__(self, base: robosc.Base, resolved: Resolved | None = None) -> None:
        """`resolved` caches the instances of imported components across several bases; it is added to."""
        self.base = base
        self._of: dict[robosc.Component, Instance] = {}
        resolved = {} if resolved is None else resolved
        for definition in base.definitions:
            if isinstance(definition, robosc.Component):
                instance = _instantiate(definition, base, resolved)
                if instance is not None:
                    self._of[definition] = instance

    def __iter__(self) -> Iterator[Instance]:
        return iter(self._of.values())

    def ports(self) -> Iterator[PortInstance]:
        """Every communication of every instance, in the order of the text."""
        for instance in self:
            for communication in instance.communications:
                yield PortInstance(instance, communication)

    def is_shared(self, communication: robosc.CommunicationType) -> bool:
        """Whether another instance has a communication of the same name."""
        return self._names[communication.name] > 1

    def provided(self, port: PortInstance) -> list[robosc.ProvideStatement]:
        """The statements on the data of a communication, in the order of the text."""
        return self._provided.get(port, [])

    def instance(self, component: robosc.Component | None, within: Instance | None) -> Instance | None:
        """The instance that a text means by a component; `within` is the instance whose behaviour the text is."""
        if within is not None and within.unit is not self.base:
            return within  # A library's text speaks of its own component only.
        return within if component is None else self._of.get(component)

    def port(self, reference: robosc.CommunicationReference | None, within: Instance | None) -> PortInstance | None:
        """The communication that a reference means."""
        instance = self.instance(reference.component, within) if reference else None
        if instance is None or reference is None or reference.communicationType is None:
            return None
        return PortInstance(instance, reference.communicationType)

    def variable(self, access: robosc.Access, within: Instance | None) -> InstanceVariable | None:
        """The variable that an access reads; None where it reads something else."""
        instance = self.instance(access.component, within)
        if instance is None or not isinstance(access.item, robosc.Variable):
            return None
        return InstanceVariable(instance, access.item)

    def assignments(self, transition: robosc.Transition, within: Instance) -> dict[InstanceVariable, robosc.Assignment]:
        """What a transition of an instance assigns to which variable; of several to one variable the last counts."""
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
    def _provided(self) -> dict[PortInstance, list[robosc.ProvideStatement]]:
        provided: dict[PortInstance, list[robosc.ProvideStatement]] = {}
        for definition in self.base.definitions:
            if isinstance(definition, robosc.ProvideStatement):
                port = self.port(definition.communicationType, None)
                if port is not None:
                    provided.setdefault(port, []).append(definition)
        return provided


def imported(base: robosc.Base) -> list[tuple[robosc.Component, robosc.Library]]:
    """Each imported component with its library, in the order of the text; unresolved libraries are left out."""
    return [
        (component, component.type.library)
        for component in base.definitions
        if isinstance(component, robosc.Component)
        and isinstance(component.type, robosc.ImportedComponent)
        and component.type.library
    ]


def libraries(
    base: robosc.Base, imports: Callable[[robosc.Base], list[tuple[robosc.Component, robosc.Library]]] = imported
) -> list[robosc.Library]:
    """Every library that a base's imports reach, each once, the near ones first, without the base itself.

    `imports` says what a base imports, for callers that know it already.
    """
    found: dict[robosc.Library, None] = {}
    queue: list[robosc.Base] = [base]
    for current in queue:
        for _, library in imports(current):
            if library not in found and library is not base:
                found[library] = None
                queue.append(library)
    return list(found)


def _instantiate(component: robosc.Component, base: robosc.Base, resolved: Resolved) -> Instance | None:
    """Follows imports to the component's definition; outer re-mappings win."""
    chain: list[tuple[robosc.Component, robosc.ImportedComponent]] = []
    unit, current, seen = base, component, {component}
    found: Instance | None = None
    while current not in resolved:
        if isinstance(current.type, robosc.LocalComponent):
            found = Instance(current, current.type, unit)
            break
        if not isinstance(current.type, robosc.ImportedComponent):
            break
        chain.append((current, current.type))
        unit, current = current.type.library, current.type.definition
        if unit is None or current is None or current in seen:
            break
        seen.add(current)
    else:
        found = resolved[current]
    for importing, imported in reversed(chain):
        if found is not None:
            topics: dict[robosc.CommunicationType, str] = {}
            for remapping in imported.remappings:
                topics.setdefault(remapping.communicationType, remapping.identifier)
            found = Instance(importing, found.local, found.unit, topics | found.topics | topics)
        resolved[importing] = found
    return found
