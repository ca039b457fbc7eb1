"""Instances of components: one for each component of a robot's text, and one for each number of a fleet.

A fleet has no meaning beyond its instances: `Instances` creates them, and resolves an index after the name of a fleet.
It also writes a definition with `each` once for every instance.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Generic, TypeAlias, TypeVar

from robosc.model import expression as ex
from robosc.model import robosc, sct
from robosc.model.reflection import contents
from robosc.model.semantics.communication import ANSWERS, event_of, events
from robosc.model.semantics.evaluation import literal
from robosc.model.semantics.expansion import Expansion, constant, constant_value
from robosc.model.semantics.naming import escape_keyword
from robosc.model.semantics.walks import copy_tree, parts

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from robosc.model.semantics.communication import PortEvent
    from robosc.model.semantics.expansion import Arguments

_Element = TypeVar("_Element", bound="ex.Located")


@dataclass(frozen=True, eq=False)
class Instance:
    """A component of a robot, or of a library that is analyzed by itself.

    `definition` is the component whose text defines it, in the robot or library `unit`. Names in this text resolve in
    `unit`. `arguments` are the values of its parameters. `member` stands for an instance of a fleet in expanded
    expressions: a component with its name.
    """

    component: robosc.Component
    local: robosc.LocalComponent
    unit: robosc.Base
    definition: robosc.Component
    topics: dict[robosc.CommunicationType, str] = field(default_factory=dict)
    arguments: dict[robosc.FormalParameter, ex.Expression] = field(default_factory=dict)
    member: robosc.Component | None = None
    _types: dict[robosc.DataType, robosc.DataType] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """Name of the component in the robot."""
        return self.referent.name

    @property
    def referent(self) -> robosc.Component:
        """Component that refers to the instance in expanded expressions."""
        return self.member or self.component

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


#: The cancel of a client, and the end of a goal after it.
_CANCELS = (sct.EventKind.cancelRequest, sct.EventKind.replyCanceled)
#: Maximum count of an event in a requirement that counts.
MOST = 1000
#: Maximum number of instances of a fleet.
LARGEST_FLEET = 1000
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
        self._fleets: dict[robosc.Component, dict[int, Instance]] = {}
        self._copies: dict[tuple[robosc.StatedDefinition, Instance], robosc.StatedDefinition] = {}
        self._originals: dict[robosc.InstanceQuantifier, robosc.InstanceQuantifier] = {}
        resolved = {} if resolved is None else resolved
        self.expanded = Expansion(self)
        #: Expanded conditions of requirements on a communication, with `value` of the type of its data.
        self.of_commands: dict[tuple[ex.Expression, robosc.CommunicationType], ex.Expression] = {}
        for definition in base.definitions:
            if isinstance(definition, robosc.Component) and definition.first is not None:
                fleet = self._fleets[definition] = _fleet(definition, base, resolved)
                self._of |= {instance.referent: instance for instance in fleet.values()}
            elif isinstance(definition, robosc.Component):
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

    def is_named(self, port: PortInstance, event: PortEvent) -> bool:
        """Return whether a transition of an instance names an event of a communication."""
        return event in self._named.get(port, ())

    def possible_events(self, port: PortInstance) -> list[PortEvent]:
        """Return the events of a communication that exist in the robot, in the order of its plant.

        An answer of the controller exists only if a transition names it. A client can cancel a goal only if a
        transition names the cancel or the end after it.
        """
        rows = events(port.communication)
        named = self._named.get(port, set())
        is_canceled = any(row.kind in _CANCELS for row in named)
        conditional = {row: row in named for row in rows if row.kind in ANSWERS}
        conditional |= {row: is_canceled for row in rows if row.kind == sct.EventKind.cancelRequest}
        return [row for row in rows if conditional.get(row, True)]

    def provide_statements(
        self, port: PortInstance, event: PortEvent | None = None
    ) -> list[Statement[robosc.ProvideStatement]]:
        """Return the statements on the data of an event of a communication, in the order of the text.

        None: the event with which the controller sends data. Every end of a goal that the controller serves has the
        data of its response. Statements outside of components override those inside.
        """
        feedback = event is not None and event.kind == sct.EventKind.replyFeedback
        statements = self._provided.get((port, feedback), [])
        outside = [statement for statement in statements if statement.within is None]
        return outside or statements

    def limits(self, port: PortInstance) -> list[Statement[robosc.LimitStatement]]:
        """Return the limits of a message in the order in which they apply: in components, then outside."""
        statements = self.statements(robosc.LimitStatement)
        mine = [limit for limit in statements if self.port(limit.element.communicationType, limit.within) == port]
        return sorted(mine, key=lambda limit: limit.within is None)

    def statements(self, kind: type[_Element]) -> list[Statement[_Element]]:
        """Return the requirements, or other definitions of a kind: outside of components, then in each instance.

        A definition with `each` is written out once for every instance of its template. In the text of the template
        itself, this is the instance whose text it is.
        """
        statements: list[Statement[_Element]] = []
        texts: list[tuple[Iterable[Any], Instance | None]] = [(self.base.definitions, None)]
        texts += ((instance.local.definitions, instance) for instance in self)
        if issubclass(robosc.Assumption, kind):
            texts += ((assumptions, instance) for instance, assumptions in self._library_assumptions.items())
        for definitions, within in texts:
            for definition in definitions:
                if isinstance(definition, kind):
                    statements += [Statement(each, within) for each in self._each(definition, within)]
        return statements

    @cached_property
    def _library_assumptions(self) -> dict[Instance, list[robosc.Assumption]]:
        """Assumptions about each imported component that are outside of components in its library."""
        about: dict[robosc.Component, list[robosc.Assumption]] = {}
        for library in dict.fromkeys(instance.unit for instance in self if instance.unit is not self.base):
            for assumption in library.definitions:
                if isinstance(assumption, robosc.Assumption):
                    for component in assumed_components(assumption, self):
                        about.setdefault(component, []).append(assumption)
        imported = (instance for instance in self if instance.unit is not self.base)
        return {instance: about[instance.definition] for instance in imported if instance.definition in about}

    def _each(self, definition: Any, within: Instance | None) -> Iterable[Any]:
        if not isinstance(definition, robosc.StatedDefinition) or definition.template is None:
            return [definition]
        is_own = within is not None and within.definition is definition.template
        instances = [within] if within is not None and is_own else self.of(definition.template)
        return [self._for_instance(definition, instance) for instance in instances]

    def _for_instance(self, definition: robosc.StatedDefinition, instance: Instance) -> robosc.StatedDefinition:
        """Return a definition with `each` as written for one instance. Equal arguments give the same object."""
        if (definition, instance) not in self._copies:
            copy, originals = _copy_for(definition, instance)
            self._copies[definition, instance] = copy
            self._originals |= originals
        return self._copies[definition, instance]

    def original(self, quantifier: robosc.InstanceQuantifier) -> robosc.InstanceQuantifier | None:
        """Return the quantifier in the text of `each` that one in a written-out copy has the meaning of.

        None if it is no such copy, or its meaning depends on the instance of the copy.
        """
        return self._originals.get(quantifier)

    def requirement_state(
        self, access: robosc.Access, within: Instance | None, current: Mapping[robosc.Component, Instance]
    ) -> robosc.RequirementState | None:
        """Return the state of a requirement automaton that an access reads. None if its instance is unresolved.

        For an automaton with `each`, this is a state of the automaton as written for the instance of the index, or for
        the `current` instance of its template.
        """
        state = access.item
        assert isinstance(state, robosc.RequirementState)
        automaton = state.eContainer()
        assert isinstance(automaton, robosc.AutomatonRequirement)
        if automaton.template is None:
            return state
        index = access.index
        instance = current.get(automaton.template)
        if isinstance(index, robosc.Access) and isinstance(index.item, robosc.Component):
            instance = current.get(index.item) or self.instance(index.item, within, index.index)
        if instance is None or instance.definition is not automaton.template:
            return None
        copy = self._for_instance(automaton, instance)
        assert isinstance(copy, robosc.AutomatonRequirement)
        return copy.states[list(automaton.states).index(state)]

    def of(self, component: robosc.Component) -> list[Instance]:
        """Return the instances that a component's text defines."""
        return self._by_definition.get(component, [])

    @cached_property
    def _by_definition(self) -> dict[robosc.Component, list[Instance]]:
        by_definition: dict[robosc.Component, list[Instance]] = {}
        for instance in self:
            by_definition.setdefault(instance.definition, []).append(instance)
        return by_definition

    def instance(
        self, component: robosc.Component | None, within: Instance | None, index: ex.Expression | None = None
    ) -> Instance | None:
        """Return the instance that a text refers to by a component, and by the index after the name of a fleet.

        `within` is the instance whose behaviour the text is.
        """
        if within is not None and (component is None or component is within.definition):
            return within
        if component is None or index is None:
            return None if component is None else self._of.get(component)
        number = constant_value(index, within)
        return self._fleets[component].get(number) if component in self._fleets and type(number) is int else None

    def instance_of(
        self, reference: robosc.CommunicationReference | robosc.Access, within: Instance | None
    ) -> Instance | None:
        """Return the instance that an access or a reference names."""
        return self.instance(reference.component, within, reference.index)

    def fleet(self, component: robosc.Component) -> Mapping[int, Instance]:
        """Return the instances of a fleet by number."""
        return self._fleets.get(component, {})

    def port(self, reference: robosc.CommunicationReference | None, within: Instance | None) -> PortInstance | None:
        """Return the communication that a reference refers to. None if it is unresolved."""
        instance = self.instance_of(reference, within) if reference else None
        if instance is None or reference is None or reference.communicationType is None:
            return None
        return PortInstance(instance, reference.communicationType)

    def variable(self, access: robosc.Access, within: Instance | None) -> InstanceVariable | None:
        """Return the variable that an access reads. None if it reads something else."""
        instance = self.instance_of(access, within)
        if instance is None or not isinstance(access.item, robosc.Variable):
            return None
        return InstanceVariable(instance, access.item)

    @property
    def fleet_texts(self) -> Mapping[str, str]:
        """Texts that name the instances of fleets in a model, by their names: `Cell[2]` for `Cell2`."""
        members = ((number, instance) for fleet in self._fleets.values() for number, instance in fleet.items())
        return {instance.name: instance_text(instance.component, number) for number, instance in members}

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
        return InstanceParameter(self.instance_of(access, within) if is_member else None, parameter)

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
    def _named(self) -> dict[PortInstance, set[PortEvent]]:
        named: dict[PortInstance, set[PortEvent]] = {}
        for instance in self:
            for transition, _ in instance.transitions:
                if isinstance(transition, robosc.ResultTransition):
                    port = self.port(transition.communicationType, instance)
                    row = event_of(transition.communicationType, transition.resultType)
                    if port is not None and row is not None:
                        named.setdefault(port, set()).add(row)
        return named

    @cached_property
    def _provided(self) -> dict[tuple[PortInstance, bool], list[Statement[robosc.ProvideStatement]]]:
        provided: dict[tuple[PortInstance, bool], list[Statement[robosc.ProvideStatement]]] = {}
        for statement in self.statements(robosc.ProvideStatement):
            port = self.port(statement.element.communicationType, statement.within)
            if port is not None:
                provided.setdefault((port, bool(statement.element.feedback)), []).append(statement)
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


def instance_text(component: robosc.Component, number: object) -> str:
    """Return the text that names an instance: `Base`, or `Cell[2]` in a fleet. `…` stands for an unknown number."""
    name = escape_keyword(component.name)
    if component.first is None:
        return name
    return f"{name}[{number if isinstance(number, int) else '…'}]"


def fleet_numbers(component: robosc.Component) -> range:
    """Return the numbers of the instances of a fleet. Empty if its bounds are invalid (rule `integer-range`)."""
    first, last = constant_value(component.first), constant_value(component.last)
    if type(first) is not int or type(last) is not int or first < 0 or last - first >= LARGEST_FLEET:
        return range(0)
    return range(first, last + 1)


def _fleet(component: robosc.Component, base: robosc.Base, resolved: Resolved) -> dict[int, Instance]:
    """Return the instances of a fleet by number."""
    kind = component.type
    if not isinstance(kind, robosc.InstantiatedComponent | robosc.ImportedComponent) or component.number is None:
        return {}
    unit = kind.library if isinstance(kind, robosc.ImportedComponent) else base
    definition = kind.definition
    is_usable = unit is not None and definition is not None and definition.first is None
    # An instance of the definition itself, also of a template, which has no arguments yet.
    made_of = _instantiate(definition, unit, resolved, is_template=True) if is_usable else None
    if made_of is None:
        return {}
    fleet: dict[int, Instance] = {}
    for number in fleet_numbers(component):
        member = robosc.Component(name=f"{component.name}{number}", source=component.source)
        own = {component.number: literal(number)}
        fleet[number] = replace(_user(made_of, component, kind, own), member=member)
    return fleet


def _instantiate(
    component: robosc.Component, base: robosc.Base, resolved: Resolved, *, is_template: bool = False
) -> Instance | None:
    """Follow `is` and imports to the component's definition. Outer remappings win."""
    if (component.parameters and not is_template) or component.first is not None:
        return None
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
        if unit is None or current is None or current in seen or current.first is not None:
            break
        seen.add(current)
    else:
        instance = resolved[current]
    for importing, kind in reversed(chain):
        if instance is not None:
            instance = _user(instance, importing, kind, {})
        resolved[importing] = instance
    return instance


def _user(
    instance: Instance,
    component: robosc.Component,
    kind: robosc.InstantiatedComponent | robosc.ImportedComponent,
    own: Arguments,
) -> Instance:
    """Return the instance of a component that uses the component of another one by `is` or an import.

    `own` is the value of `number` in the text of the use.
    """
    topics: dict[robosc.CommunicationType, str] = {}
    for remapping in kind.remappings if isinstance(kind, robosc.ImportedComponent) else ():
        topics.setdefault(remapping.communicationType, _identifier(remapping, own))
    arguments = instance.arguments
    if instance.component.parameters:
        bound = bound_arguments(instance.component.parameters, kind.arguments)
        arguments = {parameter: constant(value, own) for parameter, value in bound.items()}
    topics |= instance.topics | topics
    return Instance(component, instance.local, instance.unit, instance.definition, topics, arguments)


def _identifier(remapping: robosc.TopicRemapping, own: Arguments) -> str:
    if remapping.computedIdentifier is None:
        return remapping.identifier or ""
    computed = constant(remapping.computedIdentifier, own)
    return computed.value if isinstance(computed, ex.StringLiteral) else ""


def _copy_for(
    definition: robosc.StatedDefinition, instance: Instance
) -> tuple[robosc.StatedDefinition, dict[robosc.InstanceQuantifier, robosc.InstanceQuantifier]]:
    """Return a copy of a definition with `each` in which the template is an instance.

    A quantifier over the template ranges over all instances anew. The quantifiers of the copy that do not depend on the
    instance are returned with their originals.
    """
    copy = copy_tree(definition)
    template, copy.template = copy.template, None
    copy.name = f"{definition.name}[{instance.name}]" if definition.name else None
    originals: dict[robosc.InstanceQuantifier, robosc.InstanceQuantifier] = {}
    waiting: list[tuple[Any, Any]] = [(copy, definition)]
    while waiting:
        part, original = waiting.pop()
        if isinstance(part, robosc.InstanceQuantifier):
            originals[part] = original
            if part.template is template:
                continue
        pairs = zip(contents(part), contents(original), strict=True)
        waiting += [(child, original_child) for (_, child), (_, original_child) in pairs]
        is_changed = False
        if isinstance(part, robosc.CommunicationReference | robosc.Access) and part.component is template:
            part.component, is_changed = instance.referent, True
        if isinstance(part, robosc.Access) and part.item is template:
            part.item, is_changed = instance.referent, True
        elif isinstance(part, robosc.Access) and isinstance(part.item, robosc.RequirementState) and part.index is None:
            automaton = part.item.eContainer()
            if isinstance(automaton, robosc.AutomatonRequirement) and automaton.template is template:
                part.index, is_changed = robosc.Access(item=instance.referent), True
        around = part if is_changed else None
        while around is not None:
            originals.pop(around, None)
            around = around.eContainer()
    return copy, originals
