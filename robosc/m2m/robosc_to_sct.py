"""Transformation of a robot model to plants and requirements: thesis 5.2, made exact by the semantics specification."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

from robosc.m2m.declarations import Declarations, first_value
from robosc.m2m.expressions import SctExpressions
from robosc.m2m.requirement_automata import RequirementAutomaton
from robosc.m2m.trace import Trace
from robosc.model import expression as ex
from robosc.model import robosc, sct
from robosc.model.semantics.communication import (
    CANCELING,
    CONTROLLABLE,
    ERROR,
    EXECUTING,
    IDLE,
    OPEN,
    READY,
    RUNNING,
    SERVED,
    WAITING,
    feedback_event,
    port_event_of,
    ros_kind,
    sending_event,
)
from robosc.model.semantics.cone_of_influence import commands, cone_of_influence, guard_of
from robosc.model.semantics.durations import UNITS, bounds, milliseconds, set_milliseconds, set_on_robot
from robosc.model.semantics.expansion import constant_value
from robosc.model.semantics.inputs import Data, FailureReason
from robosc.model.semantics.instances import Instance, Instances, InstanceVariable, PortInstance, Statement
from robosc.model.semantics.naming import Names, escape_keyword
from robosc.model.semantics.printing import RoboscPrinter, conjunction, disjunction
from robosc.model.semantics.roles import plant_of
from robosc.model.semantics.walks import copy_tree, fold, with_operands

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from robosc.model.places import Place
    from robosc.model.semantics.communication import PortEvent
    from robosc.model.semantics.inputs import InputSource

_Definition = TypeVar("_Definition", bound=robosc.StatedDefinition)
_Claim = TypeVar("_Claim", robosc.Property, robosc.ReachabilityRequirement)

#: Events from the robot, or events that must always be possible. A component ignores them in all other states.
_NEVER_BLOCKED = (
    sct.EventKind.response,
    sct.EventKind.error,
    sct.EventKind.feedback,
    sct.EventKind.cancel,
    sct.EventKind.canceled,
    sct.EventKind.cancelRequest,
)

_SERVICE = (
    (IDLE, sct.EventKind.trigger, WAITING),
    (WAITING, sct.EventKind.response, READY),
    (WAITING, sct.EventKind.error, ERROR),
    (READY, sct.EventKind.reset, IDLE),
    (ERROR, sct.EventKind.reset, IDLE),
)
_ACTION = (
    (IDLE, sct.EventKind.trigger, EXECUTING),
    (EXECUTING, sct.EventKind.feedback, EXECUTING),
    (EXECUTING, sct.EventKind.response, READY),
    (EXECUTING, sct.EventKind.error, ERROR),
    (EXECUTING, sct.EventKind.cancel, CANCELING),
    (CANCELING, sct.EventKind.feedback, CANCELING),
    (CANCELING, sct.EventKind.response, READY),
    (CANCELING, sct.EventKind.error, ERROR),
    (CANCELING, sct.EventKind.canceled, IDLE),
    (READY, sct.EventKind.reset, IDLE),
    (ERROR, sct.EventKind.reset, IDLE),
)
_OUTGOING_SERVICE = ((IDLE, sct.EventKind.request, OPEN), (OPEN, sct.EventKind.reply, IDLE))
_OUTGOING_ACTION = (
    (IDLE, sct.EventKind.request, EXECUTING),
    (EXECUTING, sct.EventKind.replyFeedback, EXECUTING),
    (EXECUTING, sct.EventKind.reply, IDLE),
    (EXECUTING, sct.EventKind.replyError, IDLE),
    (EXECUTING, sct.EventKind.cancelRequest, CANCELING),
    (CANCELING, sct.EventKind.replyFeedback, CANCELING),
    (CANCELING, sct.EventKind.reply, IDLE),
    (CANCELING, sct.EventKind.replyError, IDLE),
    (CANCELING, sct.EventKind.replyCanceled, IDLE),
)
_MESSAGE = ((READY, sct.EventKind.trigger, READY), (READY, sct.EventKind.response, READY))
#: Transitions with an event of their own: its kind, and its name before a number.
_OWN_EVENTS = (
    (robosc.TauTransition, sct.EventKind.tau, "tau"),
    (robosc.TimedTransition, sct.EventKind.timeout, "after"),
)
#: Edges of the plant of each communication (thesis, listings 5.1 and 5.2). Unlike listing 5.3, an action ends when its
#: server reports the end. The first location is the initial one. It is the only marked one, unless the controller
#: serves: then all are, because a client that waits does not make the robot's work incomplete.
_PLANTS = {
    robosc.Message: (sct.PlantKind.message, _MESSAGE),
    robosc.Service: (sct.PlantKind.service, _SERVICE),
    robosc.Action: (sct.PlantKind.action, _ACTION),
    robosc.OutgoingService: (sct.PlantKind.serviceServer, _OUTGOING_SERVICE),
    robosc.OutgoingAction: (sct.PlantKind.actionServer, _OUTGOING_ACTION),
}


def transform(robot: robosc.Robot) -> tuple[sct.SupervisoryControlModel, Trace]:
    """Return the plants and requirements of a valid robot, and the trace of the transformation.

    Plants are in the order of the text, component by component: communication, then behaviour; data plants are last.
    Raises ModelError if a comparison of doubles ranges over too many integers.
    """
    return _RoboscToSct(robot).run()


class _RoboscToSct:
    def __init__(self, robot: robosc.Robot) -> None:
        self.robot = robot
        self.instances = Instances(robot)
        self.model = sct.SupervisoryControlModel(name=robot.name, source=robot.source)
        self.declarations = Declarations(self.model)
        self.trace = Trace(self.instances, cone_of_influence(self.instances), self.model, self.declarations)
        self.expressions = SctExpressions(self.trace)
        self.print = RoboscPrinter()
        self.plant_names = Names()
        self.fleet_texts = self.instances.fleet_texts
        self.input_sources: dict[PortInstance, list[InputSource]] = {}
        for carried in self.trace.cone.data:
            self.input_sources.setdefault(carried.port, []).append(carried)
        #: For each command, the data that requirements on it read, in the order of discovery.
        self.required_data: dict[PortInstance, dict[InputSource, None]] = {}
        for reading in self.trace.cone.readings:
            if reading.is_required and reading.source is not None:
                self.required_data.setdefault(reading.source.port, {})[reading.source] = None

    def run(self) -> tuple[sct.SupervisoryControlModel, Trace]:
        # Create referenced elements first: a guard may name any component's state.
        for instance in self.instances:
            for communication in instance.communications:
                self.communication(PortInstance(instance, communication))
            if instance.automaton is not None:
                self.behaviour(instance)
        for instance in self.instances:
            for variable in self.variables(instance):
                self.trace.variables[variable].initial = self.declarations.initial(variable)
            if instance.automaton is not None:
                self.edges(instance)
        for port in self.instances.ports():
            self.data_plant(port, sending_event(port.communication))
            self.data_plant(port, feedback_event(port.communication))
        for number, assumption in enumerate(self.instances.statements(robosc.Assumption), start=1):
            self.assumption(assumption, number)
        self.requirements()
        return self.model, self.trace

    # Communication

    def communication(self, port: PortInstance) -> None:
        instance, communication = port.instance, port.communication
        kind, rows = _PLANTS[type(communication)]
        served = isinstance(communication, SERVED)
        plant = self.plant(
            f"{ros_kind(communication)}_{self.communication_name(port)}",
            kind,
            f"{instance.name}.{communication.name}",
            communication.source,
        )
        if instance.name in self.fleet_texts:
            plant.reference = f"{self.fleet_texts[instance.name]}.{escape_keyword(communication.name)}"
        plant.topic = instance.topic(communication)
        self.trace.plants[port] = plant
        self.trace.origins[plant] = communication
        events_by_kind: dict[sct.EventKind, sct.Event] = {}
        for row in self.instances.possible_events(port):
            event = _event(plant, row.event_name, row.kind, plant.source)
            events_by_kind[row.kind] = self.trace.events[port, row.kind.name] = event
        edges: list[tuple[str, sct.Event, str]] = []
        reached = {rows[0][0]}
        for origin, event_kind, end in rows:
            if event_kind in events_by_kind and origin in reached:
                edges.append((origin, events_by_kind[event_kind], end))
                reached.add(end)
        names = dict.fromkeys(name for origin, _, end in edges for name in (origin, end))
        first = next(iter(names))
        places = {name: _location(plant, name, initial=name == first, marked=name == first or served) for name in names}
        self.inputs(plant, port)
        goal = self.goal(plant, port)
        for origin, event, end in edges:
            edge = _edge(places[origin], event, places[end])
            if event.kind == sct.EventKind.request and not self.is_accepted(port):
                edge.guard = ex.BooleanLiteral(value=False)
            for input_element, variable in goal.items():
                if event.kind == sct.EventKind.trigger:
                    edge.updates.append(sct.Update(variable=variable, value=sct.InputReference(input=input_element)))
                elif origin in RUNNING and end not in RUNNING:
                    edge.updates.append(sct.Update(variable=variable, value=copy_tree(variable.initial)))

    def is_accepted(self, port: PortInstance) -> bool:
        """Return whether a request can happen: a goal of an action that the controller serves needs a transition."""
        rows = self.instances.possible_events(port)
        return isinstance(port.communication, robosc.OutgoingService) or self.instances.is_named(port, rows[0])

    def goal(self, plant: sct.Plant, port: PortInstance) -> dict[sct.Input, sct.DiscreteVariable]:
        """Add the variables that hold the data of an action's goal while requirements judge it, by their inputs.

        They have their first value when no goal is running.
        """
        if not isinstance(port.communication, robosc.Action):
            return {}
        goal = {}
        for source in self.required_data.get(port, ()):
            carried = self.trace.inputs[source]
            name = f"goal_{carried.name.removeprefix(f'i_{source.event.event_name}_')}"
            goal[carried] = sct.DiscreteVariable(
                name=name, type=copy_tree(carried.type), initial=first_value(carried.type), source=plant.source
            )
        plant.variables.extend(goal.values())
        self.trace.goals |= goal
        return goal

    def plant(self, name: str, kind: sct.PlantKind, origin: str | None, source: Place | None) -> sct.Plant:
        plant = sct.Plant(name=self.plant_names.fresh(name), kind=kind, origin=origin, source=source)
        self.model.plants.append(plant)
        return plant

    def communication_name(self, port: PortInstance) -> str:
        name = port.communication.name
        shared = self.instances.is_shared(port.communication)
        return f"{port.instance.name}_{name}" if shared else name

    def inputs(self, plant: sct.Plant, port: PortInstance) -> None:
        """Add the inputs of a plant (Algorithm 1) for data in the cone of influence."""
        names = Names()
        computed = 0
        for carried in self.input_sources.get(port, ()):
            input_element = sct.Input()
            if isinstance(carried, Data):
                parts = [part.name for part in carried.path]
                assert carried.type is not None
                input_element.type = self.declarations.type(carried.type)
            elif isinstance(carried, FailureReason):
                parts = ["reason"]
                input_element.type = self.declarations.reason(carried)
                input_element.text = RoboscPrinter()(robosc.ErrorReason())
            else:
                computed += 1
                parts = [f"c{computed}"]
                input_element.type = self.declarations.computed(carried)
                input_element.text = carried.text
            input_element.name = names.fresh("_".join([f"i_{carried.event.event_name}", *parts]))
            plant.inputs.append(input_element)
            self.trace.event(port, carried.event.kind).inputs.append(input_element)
            self.trace.inputs[carried] = input_element

    # Behaviour

    def behaviour(self, instance: Instance) -> None:
        """Add locations, variables and silent events of section 5.2.1. The edges need all targets and follow later."""
        assert instance.automaton is not None
        kind = sct.PlantKind.behaviour
        plant = self.plant(f"component_{instance.name}", kind, instance.name, instance.component.source)
        plant.reference = self.fleet_texts.get(instance.name)
        self.trace.behaviours[instance] = plant
        self.trace.origins[plant] = instance.component
        names = Names()
        for state in instance.states:
            location = _location(plant, names.fresh(state.name), initial=state.initial, marked=state.marked)
            location.source = state.source
            self.trace.locations[instance, state] = location
            self.trace.origins[location] = state
        for owned in self.variables(instance):
            variable = sct.DiscreteVariable(
                name=names.fresh(owned.variable.name),
                type=self.declarations.type(owned.type),
                source=owned.variable.source,
            )
            plant.variables.append(variable)
            self.trace.variables[owned] = variable
            self.trace.origins[variable] = owned.variable
        for transitions, event_kind, name in _OWN_EVENTS:
            own = (transition for transition, _ in instance.transitions if isinstance(transition, transitions))
            for number, transition in enumerate(own, start=1):
                event = _event(plant, f"{name}{number}", event_kind, transition.source)
                event.name = names.fresh(event.name)
                self.trace.own[instance, transition] = event
                self.trace.origins[event] = transition

    def variables(self, instance: Instance) -> list[InstanceVariable]:
        """Return the variables of an instance in the cone of influence."""
        return [variable for variable in instance.variables if variable in self.trace.cone.variables]

    def edges(self, instance: Instance) -> None:
        everywhere = [transition for transition, state in instance.transitions if state is None]
        reacted = dict.fromkeys(self.trace.event_of(transition, instance) for transition, _ in instance.transitions)
        mentioned = [event for event in reacted if _is_never_blocked(event)]
        for state in instance.states:
            location = self.trace.locations[instance, state]
            tried: dict[sct.Event, list[robosc.Transition]] = {event: [] for event in mentioned}
            for transition in [*state.transitions, *everywhere]:
                before = tried.setdefault(self.trace.event_of(transition, instance), [])
                self.edge(location, transition, instance, before)
                before.append(transition)
            for event in mentioned:
                if all(guard_of(transition) is not None for transition in tried[event]):
                    _edge(location, event, location).guard = self.none_of(tried[event], instance)
        self.timers(instance)

    def edge(
        self,
        location: sct.Location,
        transition: robosc.Transition,
        instance: Instance,
        others: Sequence[robosc.Transition],
    ) -> None:
        """Add the edge of a transition.

        It is taken only if the guards of `others`, which come before it, do not hold.
        """
        target = location if transition.target is None else self.trace.locations[instance, transition.target]
        edge = _edge(location, self.trace.event_of(transition, instance), target)
        edge.source = transition.source
        self.trace.origins[edge] = transition
        edge.guard = self.first(transition, others, instance)
        for owned, assignment in self.instances.assignments(transition, instance).items():
            if owned in self.trace.variables:
                value = self.expressions(assignment.value, instance, transition, owned)
                variable = self.trace.variables[owned]
                edge.updates.append(sct.Update(variable=variable, value=value, source=assignment.source))

    def timers(self, instance: Instance) -> None:
        """Set the durations of an instance's timers and the events that restart them."""
        entries: dict[sct.Location, list[sct.Edge]] = {}
        for location in self.trace.behaviours[instance].locations:
            for edge in location.edges:
                transition = self.trace.origins.get(edge)
                named = isinstance(transition, robosc.Transition) and transition.target is not None
                if named or edge.target is not location:
                    entries.setdefault(edge.target, []).append(edge)
        for transition, state in instance.transitions:
            if isinstance(transition, robosc.TimedTransition):
                within = None if state is None else self.trace.locations[instance, state]
                ports = (self.instances.port(reference, instance) for reference in transition.without)
                without = (self.trace.event(port, sct.EventKind.response) for port in ports if port is not None)
                self.trace.own[instance, transition].timer = sct.Timer(
                    milliseconds=milliseconds(transition, instance),
                    duration=self.duration(transition, instance),
                    location=within,
                    entries=[] if within is None else entries.get(within, []),
                    without=list(dict.fromkeys(without)),
                    source=transition.source,
                )

    def duration(self, transition: robosc.TimedTransition, instance: Instance) -> sct.Duration | None:
        """Return the duration of a transition if it is set on the robot, else None."""
        access = set_on_robot(transition.duration)
        if access is None:
            return None
        owned, unit = self.instances.parameter(access, instance), UNITS[transition.unit]
        if (owned, unit) not in self.trace.durations:
            values = (constant_value(owned.parameter.value, owned.instance), *bounds(owned.parameter, owned.instance))
            numbers = (value for value in values if isinstance(value, int | float))
            length, shortest, longest = (set_milliseconds(number, unit) for number in numbers)
            duration = sct.Duration(
                parameter=owned.name, milliseconds=length, shortest=shortest, longest=longest, unit=unit
            )
            duration.source = owned.parameter.source
            self.trace.durations[owned, unit] = duration
            self.trace.model.durations.append(duration)
        return self.trace.durations[owned, unit]

    def first(
        self, transition: robosc.Transition, others: Sequence[robosc.Transition], instance: Instance
    ) -> ex.Expression | None:
        """Return the condition that a transition is the first whose guard holds."""
        guard = guard_of(transition)
        if guard is None:
            return self.none_of(others, instance)
        own = self.expressions(guard, instance, transition)
        return conjunction(filter(None, (self.none_of(others, instance), own)))

    def none_of(self, transitions: Sequence[robosc.Transition], instance: Instance) -> ex.Expression | None:
        """Return the condition that no guard of the transitions holds. None if there are no guards."""
        guards = ((guard_of(transition), transition) for transition in transitions)
        conditions = [
            self.expressions(guard, instance, transition) for guard, transition in guards if guard is not None
        ]
        return conjunction(ex.Negation(operand=guard) for guard in conditions)

    # Provided data

    def data_plant(self, port: PortInstance, row: PortEvent | None) -> None:
        """Add the plant that selects provided data (listing 5.4). Its names are stable from run to run."""
        statements = [] if row is None else self.instances.provide_statements(port, row)
        if row is None or not statements:
            return
        name, origin = f"data_{self.communication_name(port)}", self.trace.plants[port].origin
        if row.kind == sct.EventKind.replyFeedback:
            name, origin = f"{name}_{row.name}", f"{origin}.{row.name}"
        plant = self.plant(name, sct.PlantKind.data, origin, statements[0].element.source)
        nothing = _location(plant, "none", initial=True, marked=True)
        for number, statement in enumerate(statements, start=1):
            location = _location(plant, f"d{number}", marked=True)
            location.source = statement.element.source
            event = _event(plant, f"d{number}", sct.EventKind.data, location.source)
            _edge(plant, event, location).guard = self.holds(statement)
            self.trace.provided[statement] = location
            self.trace.origins[location] = statement.element
        edge = _edge(plant, _event(plant, "none", sct.EventKind.data, plant.source), nothing)
        edge.guard = self.none_holds(statements)

    def holds(self, statement: Statement[robosc.ProvideStatement]) -> ex.Expression | None:
        condition = statement.element.condition
        return None if condition is None else self.expressions(condition, statement.within)

    def none_holds(self, statements: list[Statement[robosc.ProvideStatement]]) -> ex.Expression | None:
        conditions = [self.holds(statement) for statement in statements]
        if None in conditions:
            return ex.BooleanLiteral(value=False)
        return conjunction(ex.Negation(operand=condition) for condition in conditions if condition is not None)

    # Assumptions

    def assumption(self, statement: Statement[robosc.Assumption], number: int) -> None:
        """Add the plant of an assumption: one location, where its events are possible only if the condition holds."""
        assumption, within, name = statement.element, statement.within, _statement_name(statement)
        plant = self.plant(
            f"assumption_{_identifier(name) if name else number}",
            sct.PlantKind.assumption,
            name,
            assumption.source,
        )
        readable = self.print(self.instances.expanded(assumption.condition, within, readable=True))
        plant.text = f"{self.heading(statement)} {self.events_said(assumption.target, statement)} needs {readable}"
        self.trace.origins[plant] = assumption
        location = _location(plant, "holding", initial=True, marked=True)
        for event in dict.fromkeys(self.named_event(event, statement) for event in assumption.target.events):
            _edge(location, event, location).guard = self.expressions(assumption.condition, within)

    def named_event(self, reference: robosc.EventReference, statement: Statement[robosc.Assumption]) -> sct.Event:
        port, named = self.instances.port(reference.communicationType, statement.within), port_event_of(reference)
        assert port is not None
        assert named is not None
        return self.trace.event(port, named.kind)

    # Requirements

    def requirements(self) -> None:
        """Add the requirements of section 5.2.2: on the trigger of each named communication, and on cancels."""
        automata = list(self.requirement_automata())
        on_action: dict[PortInstance, list[Statement[robosc.CommunicationRequirement]]] = {
            port: [] for port in self.instances.ports() if isinstance(port.communication, robosc.Action)
        }
        for requirement in self.instances.statements(robosc.CommunicationRequirement):
            for port in commands(self.instances, requirement):
                self.requirement(requirement, port)
                if port in on_action:
                    on_action[port].append(requirement)
        for port, requirements in on_action.items():
            self.cancelling(port, requirements)
        for automaton in automata:
            automaton.fill(self.expressions)
            self.restrictions(automaton)
        for invariant in self.instances.statements(robosc.StateInvariant):
            self.invariant(invariant)
        for required in self.instances.statements(robosc.ReachabilityRequirement):
            self.claim(required)
        for claimed in self.instances.statements(robosc.Property):
            self.claim(claimed)

    def requirement(self, statement: Statement[robosc.CommunicationRequirement], port: PortInstance) -> None:
        requirement, within = statement.element, statement.within
        restricted = sending_event(port.communication)
        assert restricted is not None
        disables = isinstance(requirement, robosc.DisablesRequirement)
        readable = self.instances.expanded(requirement.condition, within, readable=True)
        name, condition, begin = self.shown(port), self.print(readable), self.heading(statement)
        target = sct.Requirement(
            event=self.trace.event(port, restricted.kind),
            kind=sct.RequirementKind.disables if disables else sct.RequirementKind.needs,
            condition=self.expressions(requirement.condition, within, port),
            name=_statement_name(statement),
            text=f"{begin} {condition} disables {name}" if disables else f"{begin} {name} needs {condition}",
            source=requirement.source,
        )
        self.model.requirements.append(target)
        self.trace.origins[target] = requirement

    def requirement_automata(self) -> Iterator[RequirementAutomaton]:
        """Create the automata of orders, counts and automata, without edges.

        Conditions on the edges need the locations of all automata.
        """
        kinds = (robosc.OrderRequirement, robosc.CountRequirement, robosc.AutomatonRequirement)
        statements = (
            statement
            for statement in self.instances.statements(robosc.Requirement)
            if isinstance(statement.element, kinds)
        )
        for number, statement in enumerate(statements, start=1):
            name = _statement_name(statement)
            plant = self.plant(
                f"requirement_{_identifier(name) if name else number}",
                sct.PlantKind.requirement,
                name,
                statement.element.source,
            )
            self.trace.origins[plant] = statement.element
            automaton = RequirementAutomaton(self.trace, statement, plant)
            automaton.declare()
            yield automaton

    def restrictions(self, automaton: RequirementAutomaton) -> None:
        """Add the requirements on the locations of a requirement automaton, one for each event that it restricts."""
        statement = automaton.statement
        for event, condition in automaton.allowed.items():
            target = sct.Requirement(
                event=event,
                kind=sct.RequirementKind.needs,
                condition=condition,
                automaton=automaton.plant,
                name=_statement_name(statement),
                text=f"{self.heading(statement)} {self.describe_statement(statement)}",
                source=statement.element.source,
            )
            self.model.requirements.append(target)
            self.trace.origins[target] = statement.element

    def describe_statement(self, statement: Statement[robosc.Requirement]) -> str:
        """Return the text of an order, a count or an automaton."""
        match statement.element:
            case robosc.OrderRequirement() as order:
                fresh = "each " if order.each else ""
                anchor = self.event_said(order.anchor, statement)
                return f"{self.events_said(order.target, statement)} after {fresh}{anchor}"
            case robosc.CountRequirement() as count:
                bound = self.print(self.instances.expanded(count.bound, statement.within, readable=True))
                events = self.events_said(count.target, statement)
                return f"at most {bound} {events} since {self.event_said(count.anchor, statement)}"
        return "automaton"

    def events_said(self, events: robosc.EventSet, statement: Statement[_Definition]) -> str:
        texts = [self.event_said(event, statement) for event in events.events]
        return texts[0] if len(texts) == 1 else f"{{ {', '.join(texts)} }}"

    def event_said(self, reference: robosc.EventReference, statement: Statement[_Definition]) -> str:
        port = self.instances.port(reference.communicationType, statement.within)
        assert port is not None
        if not isinstance(reference, robosc.NamedEvent):
            return self.shown(port)
        row = port_event_of(reference)
        assert row is not None
        return f"{row.name} {row.preposition} {self.shown(port)}"

    def invariant(self, statement: Statement[robosc.StateInvariant]) -> None:
        invariant, within = statement.element, statement.within
        readable = self.instances.expanded(invariant.condition, within, readable=True)
        condition = self.expressions(invariant.condition, within)
        never = invariant.kind == robosc.InvariantKind.never
        target = sct.StateInvariant(
            condition=ex.Negation(operand=condition) if never else condition,
            name=_statement_name(statement),
            text=f"{self.heading(statement)} {invariant.kind.name} {self.print(readable)}",
            source=invariant.source,
        )
        self.model.invariants.append(target)
        self.trace.origins[target] = invariant

    def claim(self, statement: Statement[_Claim]) -> None:
        """Add a property, or the requirement that has the form of one."""
        claimed, within = statement.element, statement.within
        condition = self.expressions(claimed.condition, within)
        text = self.print(self.instances.expanded(claimed.condition, within, readable=True))
        claim: sct.Property | sct.ReachabilityRequirement
        if isinstance(claimed, robosc.InvariantProperty):
            never = claimed.kind == robosc.InvariantKind.never
            claim = sct.InvariantProperty(condition=ex.Negation(operand=condition) if never else condition)
            text = f"{claimed.kind.name} {text}"
        else:
            assert isinstance(claimed, robosc.ReachabilityProperty | robosc.ReachabilityRequirement)
            is_enforced = isinstance(claimed, robosc.ReachabilityRequirement)
            claim = sct.ReachabilityRequirement() if is_enforced else sct.ReachabilityProperty()
            claim.condition, text = condition, f"reachable {text}"
            if claimed.premise is not None:
                claim.premise = self.expressions(claimed.premise, within)
                text += f" from {self.print(self.instances.expanded(claimed.premise, within, readable=True))}"
        claim.name, claim.source = _statement_name(statement), claimed.source
        claim.text = f"{self.heading(statement)} {text}"
        if isinstance(claim, sct.ReachabilityRequirement):
            self.model.reachabilityRequirements.append(claim)
        else:
            self.model.properties.append(claim)
        self.trace.origins[claim] = claimed

    def heading(self, statement: Statement[_Definition]) -> str:
        """Return the first words of the text of a requirement, property or assumption: its name and its own text."""
        text = statement.element.text
        words = [_statement_name(statement), None if text is None else self.print(ex.StringLiteral(value=text))]
        named = " ".join(filter(None, words))
        words_by_kind = ((robosc.Property, "property"), (robosc.Assumption, "assume"), (object, "requirement"))
        word = next(word for kind, word in words_by_kind if isinstance(statement.element, kind))
        return f"{word} {named}:" if named else word

    def cancelling(self, port: PortInstance, requirements: list[Statement[robosc.CommunicationRequirement]]) -> None:
        """Add the requirement on an action's cancel: allowed exactly if the action could not be started any more.

        This is Algorithm 2, with the initial value false.
        """
        broken: list[ex.Expression] = []
        for requirement in requirements:
            condition = _with_goal(
                self.expressions(requirement.element.condition, requirement.within, port), self.trace.goals
            )
            disables = isinstance(requirement.element, robosc.DisablesRequirement)
            broken.append(condition if disables else ex.Negation(operand=condition))
        name = self.shown(port)
        self.model.requirements.append(
            sct.Requirement(
                event=self.trace.event(port, sct.EventKind.cancel),
                kind=sct.RequirementKind.needs,
                condition=disjunction(broken) or ex.BooleanLiteral(value=False),
                text=f"{name} is cancelled where a requirement on it no longer holds"
                if broken
                else f"{name} is never cancelled: no requirement restricts it",
                source=self.trace.plants[port].source,
            )
        )

    def shown(self, port: PortInstance) -> str:
        name = port.communication.name
        return f"{port.instance.name}.{name}" if self.communication_name(port) != name else name


def _with_goal(condition: ex.Expression, goals: Mapping[sct.Input, sct.DiscreteVariable]) -> ex.Expression:
    """Return a condition on a command's data as a condition on the data of the running goal."""

    def replaced(original: ex.Expression, inside: list[ex.Expression]) -> ex.Expression:
        if isinstance(original, sct.InputReference):
            return sct.VariableReference(variable=goals[original.input])
        return with_operands(original, inside) if inside else copy_tree(original)

    return fold(replaced, condition)


def _statement_name(statement: Statement[_Definition]) -> str | None:
    """Return the name of a requirement, property or assumption, with its component if it is inside one."""
    name = statement.element.name
    return f"{statement.within.name}.{name}" if name and statement.within else name


def _identifier(name: str) -> str:
    """Return the name of a requirement as an identifier: `Left.R` gives `Left_R`, `R[Cell2]` gives `R_Cell2`."""
    return name.replace(".", "_").replace("[", "_").replace("]", "")


def _location(plant: sct.Plant, name: str, *, initial: bool = False, marked: bool = False) -> sct.Location:
    location = sct.Location(name=name, initial=initial, marked=marked, source=plant.source)
    plant.locations.append(location)
    return location


def _edge(leaving: sct.Location | sct.Plant, event: sct.Event, target: sct.Location) -> sct.Edge:
    """Add an edge that leaves a location, or every location of a plant."""
    edge = sct.Edge(event=event, target=target)
    leaving.edges.append(edge)
    return edge


def _is_never_blocked(event: sct.Event) -> bool:
    """Return whether components ignore an event in the states without a transition for it.

    A component without a transition for the goal of an action that the controller serves rejects the goal.
    """
    if event.kind == sct.EventKind.request:
        return plant_of(event).kind == sct.PlantKind.serviceServer
    return event.kind in _NEVER_BLOCKED


def _event(plant: sct.Plant, name: str, kind: sct.EventKind, source: Place | None) -> sct.Event:
    """Add an event. Its name starts with `c_` if it is controllable, else with `u_`."""
    controllable = kind in CONTROLLABLE
    event = sct.Event(
        name=f"{'c' if controllable else 'u'}_{name}", kind=kind, controllable=controllable, source=source
    )
    plant.events.append(event)
    return event
