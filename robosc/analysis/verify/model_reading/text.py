"""Meaning of a robot's text by the pages of the language: its communications, components and requirements."""

from __future__ import annotations

from fractions import Fraction
from functools import partial
from math import floor
from typing import TYPE_CHECKING, Any

from robosc.analysis.verify.model_reading.machine import (
    BOOLEANS,
    SERVERS,
    At,
    Claim,
    Condition,
    Event,
    EventEffect,
    EventInput,
    EventName,
    Length,
    Machine,
    Meaning,
    Participant,
    Plant,
    ProvidedConstant,
    Restriction,
    Slot,
    Timer,
    choice_of,
    compile_condition,
    saturate,
)
from robosc.analysis.verify.model_reading.names import (
    OBSERVERS,
    Data,
    Environment,
    Instance,
    Names,
    NotReadError,
    kind_of,
    words_of,
)
from robosc.analysis.verify.model_reading.sent_data import computed_input, constant_data
from robosc.model import expression as ex
from robosc.model import robosc
from robosc.model.semantics.walks import operands, walk, with_operands

if TYPE_CHECKING:
    from collections.abc import Generator, Iterable, Mapping, Sequence

    from robosc.analysis.verify.model_reading.machine import Domain, Value

    _Port = tuple[Instance, robosc.CommunicationType]
    #: Transition of a requirement automaton: its condition, its target and its source in the text.
    _Way = tuple[Condition | None, str, ex.Located]

#: Phases of a service (thesis listing 5.2) and of an action, which ends when its server reports the end.
_SERVICE = {
    "c_trigger": {"idle": "wait_for_response"},
    "u_response": {"wait_for_response": "ready"},
    "u_error": {"wait_for_response": "error"},
    "c_reset": {"ready": "idle", "error": "idle"},
}
_ACTION = {
    "c_trigger": {"idle": "executing"},
    "u_feedback": {"executing": "executing", "canceling": "canceling"},
    "u_response": {"executing": "ready", "canceling": "ready"},
    "u_error": {"executing": "error", "canceling": "error"},
    "c_cancel": {"executing": "canceling"},
    "u_canceled": {"canceling": "idle"},
    "c_reset": {"ready": "idle", "error": "idle"},
}
#: Phases of a service and of an action that others call: the controller answers.
_SERVICE_SERVER = {"u_request": {"idle": "open"}, "c_response": {"open": "idle"}}
_ACTION_SERVER = {
    "u_request": {"idle": "executing"},
    "u_cancel": {"executing": "canceling"},
    "c_feedback": {"executing": "executing", "canceling": "canceling"},
    "c_response": {"executing": "idle", "canceling": "idle"},
    "c_error": {"executing": "idle", "canceling": "idle"},
    "c_canceled": {"canceling": "idle"},
}
#: Kinds of their events, which have other kinds than those of a service or action that the controller calls.
_SERVER_KINDS = {
    "u_request": "request",
    "u_cancel": "cancelRequest",
    "c_response": "reply",
    "c_feedback": "replyFeedback",
    "c_error": "replyError",
    "c_canceled": "replyCanceled",
}
#: Phases of each kind of communication but messages, by its plant.
_PHASES = {
    "service": _SERVICE,
    "action": _ACTION,
    "serviceServer": _SERVICE_SERVER,
    "actionServer": _ACTION_SERVER,
}
#: Event names by the keyword of a transition (thesis table 5.1).
_NAMED = {
    robosc.ResultType.request: "c_trigger",
    robosc.ResultType.response: "u_response",
    robosc.ResultType.error: "u_error",
    robosc.ResultType.feedback: "u_feedback",
    robosc.ResultType.cancel: "c_cancel",
    robosc.ResultType.canceled: "u_canceled",
}
#: Values of the predefined enum with which each kind of communication fails.
_REASONS = {
    "service": ("unavailable", "timeout", "unreadable", "failed"),
    "action": ("rejected", "lost", "aborted", "canceled", "unavailable", "timeout", "unreadable"),
}
#: Events that happen even if their data cannot be read.
_ENDS = ("u_error", "u_canceled")
#: Operators that join conditions of the node to one input.
_JOINS = (ex.Conjunction, ex.Disjunction, ex.Implication)
#: Events after which an action has no goal.
_WITHOUT_GOAL = ("u_response", "u_error", "u_canceled", "c_reset")
_UNITS = {robosc.TimeUnit.ms: 1, robosc.TimeUnit.s: 1000, robosc.TimeUnit.min: 60_000}


class UnlikeError(Exception):
    """The plants lack an element that the text reads, or disagree about it; `source` is the reading element."""

    def __init__(self, message: str, source: ex.Located | None = None) -> None:
        super().__init__(message)
        self.source = source


def read_text(robot: robosc.Base, plants: Machine) -> Machine:
    """Return the reading of a linked robot.

    It takes from the plants which variables and inputs they hold, because all others exist only in the node. It also
    takes the range of values that the node computes; if such a value is assigned to a variable, the range must be the
    variable's.
    """
    return _TextReading(robot, plants).run()


class _TextReading:
    def __init__(self, robot: robosc.Base, plants: Machine) -> None:
        self.names = Names(robot)
        self.plants = plants
        self.machine = Machine()
        self.ports: dict[Plant, _Port] = {}
        #: Events that a transition of a component names.
        self.named_events: set[EventName] = set()
        self.statements: dict[Plant, Sequence[tuple[robosc.ProvideStatement, Environment]]] = {}

    def run(self) -> Machine:
        self.collect_named_events()
        for instance in self.names:
            for communication in instance.of(robosc.CommunicationType):
                self.communication(instance, communication)
            self.machine.order.append(instance.plant)
        for instance in self.names:
            self.slots(instance)
        self.observer_slots()
        for instance in self.names:
            if instance.of(robosc.ComponentBehaviour):
                self.behaviour(instance)
        self.provided()
        self.assumed()
        self.required()
        for requirement, place in self.names.definitions(robosc.Requirement):
            if isinstance(requirement, OBSERVERS):
                self.observer(requirement, place, self.names.observer(requirement, place))
        self.claims()
        for plant, statements in self.statements.items():
            self.machine.provided[plant] = [self.provided_constant(*statement) for statement in statements]
        return self.machine

    def collect_named_events(self) -> None:
        for instance in self.names:
            transitions: list[robosc.Transition] = [*instance.behaviour(robosc.ResultTransition)]
            transitions += (
                transition for state in instance.behaviour(robosc.State) for transition in state.transitions
            )
            for transition in transitions:
                if isinstance(transition, robosc.ResultTransition):
                    named = self.of(transition.communicationType, transition.resultType, instance.place)
                    self.named_events.add(named)

    # Communication

    def communication(self, instance: Instance, communication: robosc.CommunicationType) -> None:
        plant = _plant(instance, communication)
        self.ports[plant] = instance, communication
        self.machine.topics[plant] = self.names.topic(instance, communication)
        self.machine.order.append(plant)
        if isinstance(communication, robosc.Message):
            comes = communication.direction == robosc.MessageDirection.outgoing
            steps = {"u_response" if comes else "c_trigger": {"ready": "ready"}}
        else:
            steps = {
                name: step for name, step in _PHASES[plant.kind].items() if self.is_possible(EventName(plant, name))
            }
        places = dict.fromkeys(name for step in steps.values() for pair in step.items() for name in pair)
        if "canceling" in places and "u_cancel" not in steps and plant.kind in SERVERS:
            del places["canceling"]  # no client cancels a goal
        first = next(iter(places))
        # A client that waits does not make the work of the robot incomplete.
        marked = [*places] if plant.kind in SERVERS else [first]
        slot = self.locations(plant, tuple(places), first, marked, communication)
        for name, step in steps.items():
            event = self.event(plant, name, communication)
            known = {origin: end for origin, end in step.items() if origin in places}
            is_rejected = plant.kind == "actionServer" and name == "u_request"
            is_rejected = is_rejected and EventName(plant, name) not in self.named_events
            event.participants.append(_phases(slot, {} if is_rejected else known, communication))

    def is_possible(self, name: EventName) -> bool:
        """Return whether an event exists: an answer of the controller only if a transition names it.

        A client can cancel a goal if a transition names the cancel or the end after it.
        """
        if name.plant.kind not in SERVERS or name.name == "u_request":
            return True
        causes = {name, EventName(name.plant, "c_canceled")} if name.name == "u_cancel" else {name}
        return bool(causes & self.named_events)

    def locations(
        self, plant: Plant, names: tuple[str, ...], initial: str, marked: Iterable[str], source: ex.Located
    ) -> Slot:
        slot = Slot(plant)
        self.slot(slot, names, initial, source)
        self.machine.marked[slot] = frozenset(marked)
        return slot

    def slot(self, slot: Slot, domain: Domain, initial: Value, source: ex.Located) -> None:
        self.machine.domains[slot] = domain
        self.machine.initial[slot] = initial
        self.machine.sources[slot] = source

    def event(self, plant: Plant, name: str, element: ex.Located) -> Event:
        kind = name.partition("_")[2]
        kind = {"after": "timeout"}.get(kind.rstrip("0123456789"), kind.rstrip("0123456789"))
        kind = _SERVER_KINDS[name] if plant.kind in SERVERS else "data" if plant.kind == "data" else kind
        event = Event(kind, controllable=name.startswith("c_"), element=element)
        self.machine.events[EventName(plant, name)] = event
        return event

    def of(self, reference: robosc.CommunicationReference, named: robosc.ResultType, place: Environment) -> EventName:
        """Return the event that a transition names."""
        plant = _plant(*self.names.port(reference, place))
        if plant.kind not in SERVERS:
            return EventName(plant, _NAMED[named])
        sender = "u" if named in (robosc.ResultType.request, robosc.ResultType.cancel) else "c"
        return EventName(plant, f"{sender}_{named}")

    def sending(self, reference: robosc.CommunicationReference, place: Environment) -> EventName:
        """Return the event with which the controller sends: the request, or the response of a server."""
        return self.sending_of(_plant(*self.names.port(reference, place)))

    @staticmethod
    def sending_of(plant: Plant) -> EventName:
        return EventName(plant, "c_response" if plant.kind in SERVERS else "c_trigger")

    # Components

    def slots(self, instance: Instance) -> None:
        states = instance.behaviour(robosc.State)
        if instance.of(robosc.ComponentBehaviour):
            initial = next(state.name for state in states if state.initial)
            marked = [state.name for state in states if state.marked]
            source = instance.of(robosc.ComponentBehaviour)[0]
            self.locations(instance.plant, tuple(state.name for state in states), initial, marked, source)
        for variable in instance.behaviour(robosc.Variable):
            slot = Slot(instance.plant, variable.name)
            if slot in self.plants.domains:
                domain = self.names.domain(variable.type, instance.place)
                if domain is None:
                    raise UnlikeError(f"the plants hold `{instance.name}.{variable.name}`, which has no end", variable)
                self.slot(slot, domain, self.first_value(variable, domain, instance), variable)

    def first_value(self, variable: robosc.Variable, domain: Domain, instance: Instance) -> Value:
        if variable.initial is not None:
            value = self.names.constant(variable.initial, instance.place)
            return saturate(value, domain)
        if isinstance(variable.type, robosc.ComplexDataTypeReference):
            assert isinstance(variable.type.type, robosc.EnumDataType)
            rules = variable.type.type.rules
            return next(rule.value.name for rule in rules if isinstance(rule, robosc.EnumDefaultRule))
        return saturate(0, domain) if isinstance(domain, range) else False

    def behaviour(self, instance: Instance) -> None:
        tried: dict[EventName, dict[str, list[robosc.Transition]]] = {}
        numbers = {robosc.TauTransition: 0, robosc.TimedTransition: 0}
        states = [state.name for state in instance.behaviour(robosc.State)]
        for definition in instance.behaviour(robosc.AutomatonDefinition):
            if isinstance(definition, robosc.Variable):
                continue
            state = definition if isinstance(definition, robosc.State) else None
            for transition in [definition] if state is None else state.transitions:
                assert isinstance(transition, robosc.Transition)
                if isinstance(transition, robosc.ResultTransition):
                    name = self.of(transition.communicationType, transition.resultType, instance.place)
                else:
                    kind = type(transition)
                    numbers[kind] += 1
                    prefix = "c_tau" if kind is robosc.TauTransition else "u_after"
                    name = EventName(instance.plant, f"{prefix}{numbers[kind]}")
                    event = self.event(*name, transition)
                    if isinstance(transition, robosc.TimedTransition):
                        event.timer = self.timer(transition, state.name if state else None, instance)
                places = tried.setdefault(name, {})
                for place in states if state is None else [state.name]:
                    places.setdefault(place, []).append(transition)
        for name, places in tried.items():
            # Transitions of every state are tried after those of a state itself.
            ordered = {
                place: sorted(transitions, key=lambda transition: not isinstance(transition.eContainer(), robosc.State))
                for place, transitions in places.items()
            }
            ignored = name.plant != instance.plant and not _is_permitted(name)
            self.machine.events[name].participants.append(self.reaction(name, ordered, instance, ignored))

    def timer(self, transition: robosc.TimedTransition, where: str | None, instance: Instance) -> Timer:
        without = frozenset(
            self.of(message, robosc.ResultType.response, instance.place) for message in transition.without
        )
        environment, unit = instance.place, _UNITS[transition.unit]
        parameter = self.names.parameter(transition.duration, environment)
        if parameter is not None:
            # The node rounds parameter values like doubles, halves up.
            values = self.names.settings(transition.duration, environment)
            first, shortest, longest = (floor(value * unit + 0.5) for value in values)
            return Timer(Length(first, parameter, unit, shortest, longest), where, without)
        exact = Fraction(self.names.constant(transition.duration, environment)) * unit
        return Timer(Length(int(exact + Fraction(1, 2))), where, without)

    def reaction(
        self,
        name: EventName,
        tried: Mapping[str, Sequence[robosc.Transition]],
        instance: Instance,
        ignored: bool,
    ) -> Participant:
        """Return the participant that takes the first transition of the state with a true guard.

        If no guard holds, the event may be `ignored`.
        """
        location = Slot(instance.plant)
        reads = {location}
        ways: dict[str, list[tuple[Condition | None, EventEffect, list[tuple[Slot, Condition]]]]] = {}
        known: dict[robosc.Transition, Any] = {}
        for state, transitions in tried.items():
            for transition in transitions:
                if transition not in known:
                    known[transition] = self.way(transition, name, instance)
                guard, fixed, assigned = known[transition]
                reads.update(
                    *(condition.reads for condition in [guard, *(value for _, value in assigned)] if condition)
                )
                ways.setdefault(state, []).append((guard, fixed, assigned))
        domains = self.machine.domains
        nothing = EventEffect({}, None)

        def step(state: Mapping[Slot, Value], inputs: Mapping[str, Value]) -> EventEffect | None:
            for guard, fixed, assigned in ways.get(str(state[location]), ()):
                if guard is None or guard.compute(state, inputs):
                    values = {slot: saturate(value.compute(state, inputs), domains[slot]) for slot, value in assigned}
                    return EventEffect({**fixed.writes, **values}, fixed.source)
            return nothing if ignored else None

        source = next(iter(tried.values()))[0]
        return Participant(step, frozenset(reads), source, instance.plant)

    def way(
        self, transition: robosc.Transition, name: EventName, instance: Instance
    ) -> tuple[Condition | None, EventEffect, list[tuple[Slot, Condition]]]:
        guard = transition.guard if isinstance(transition, robosc.GuardedTransition) else None
        condition = None if guard is None else self.condition(guard, instance.place, name)
        writes = {} if transition.target is None else {Slot(instance.plant): transition.target.name}
        assigned: dict[Slot, Condition] = {}
        for assignment in transition.assignments:
            slot = Slot(instance.plant, assignment.item.item.name if assignment.item.item else "")
            if slot in self.plants.domains:
                assigned[slot] = self.condition(assignment.value, instance.place, name, slot)
        return condition, EventEffect(writes, transition), list(assigned.items())

    # Expressions

    def condition(
        self,
        expression: ex.Expression,
        place: Environment,
        name: EventName | None = None,
        assigned: Slot | None = None,
        *,
        of_goal: bool = False,
    ) -> Condition:
        """Return an expression in the text of an instance as a condition.

        `name` is the event whose data it reads. `of_goal`: it reads the data of the running goal instead, as the
        action's plant holds them.
        """
        written = self.names.written_out(expression, place)
        if name is not None:
            present = None if assigned is None else self.present(written, name)
            is_guard = assigned is None
            written = walk(lambda part: self.replace_inputs(part[0], name, part[1], is_guard), (written, assigned))
            if present is not None and assigned is not None:
                written = ex.Conditional(condition=present, then=written, otherwise=self.names.leaf(assigned))

        def meaning(reference: ex.Expression) -> Meaning:
            target = self.names.meaning(reference)
            slot = target.slot if isinstance(target, At) else target
            if isinstance(slot, Slot) and slot not in self.machine.domains:
                variable = f"{slot.plant.origin}.{slot.variable}"
                raise UnlikeError(f"the text reads `{variable}`, which the plants do not have", expression)
            if isinstance(target, Data):
                words = "".join(target.words)
                raise UnlikeError(f"the text reads `{words}`, for which the plants have no input", expression)
            if of_goal and isinstance(target, EventInput):
                assert name is not None
                return self.goal(name, target.name)
            return target

        return compile_condition(written, meaning)

    def present(self, value: ex.Expression, name: EventName) -> ex.Expression | None:
        """Return the input that indicates whether a value of an error or a canceled goal is readable.

        Returns None if the value is always readable.
        """
        event = self.plants.events.get(name)
        words = self.words(value, name) or ()
        for carried in event.element.inputs if event is not None and name.name in _ENDS else ():
            if carried.text is not None and words_of(carried.text) == (*words, "=", *words):
                self.machine.events[name].inputs[carried.name] = BOOLEANS
                return self.names.leaf(EventInput(carried.name))
        if name.name in _ENDS and "[" in words:
            raise UnlikeError(f"the plants have no input for whether `{''.join(words)}` can be read", value)
        return None

    def words(self, part: ex.Expression, name: EventName) -> tuple[str, ...] | None:
        """Return the text of a part that the node computes for the event; None if the supervisor computes it.

        Where an end reads an array, the whole condition is false without the array. The node computes it.
        """
        words = self.names.words(part)
        if words is not None or name.name.startswith("c_"):
            return words
        words = self.names.words_of_node(part)
        if words is None and name.name in _ENDS:
            whole = self.names.all_words(part)
            words = whole if "[" in whole else None
        return words

    def replace_inputs(
        self, part: ex.Expression, name: EventName, assigned: Slot | None, is_guard: bool
    ) -> Generator[Any, Any, ex.Expression]:
        """Return the expression with its largest parts replaced by inputs of the event.

        The node computes conditions that are joined as one input. Where an end reads an array, only the operands of
        `and` in a guard are inputs of their own.
        """
        event = self.plants.events.get(name)
        inputs = event.element.inputs if event is not None else []
        computed = [(words_of(carried.text), carried.name) for carried in inputs if carried.text is not None]
        words = self.words(part, name) if computed else None
        alike = {input_name: event.inputs[input_name] for text, input_name in computed if event and text == words}
        if alike:
            slot_range = None if assigned is None else self.machine.domains[assigned]
            if not isinstance(slot_range, range):
                slot_range = self.declared(part, name)
            # Inputs of the same text differ in their range.
            alike = {
                input_name: domain
                for input_name, domain in alike.items()
                if not isinstance(domain, range) or domain == slot_range
            }
            if not alike:
                raise UnlikeError("the plants have another range for a value computed from data", part)
            candidate = next(iter(alike))
            domain = _REASONS[name.plant.kind] if words == ("error",) else alike[candidate]
            self.machine.events[name].inputs[candidate] = domain
            self.machine.events[name].parts[candidate] = part
            return self.names.leaf(EventInput(candidate))
        target = self.names.meaning(part) if isinstance(part, robosc.Access) else None
        if isinstance(target, Data) and target.path is not None:
            expected_name = "_".join(["i", name.name.partition("_")[2], *target.path])
            fitted = [
                carried.name
                for carried in inputs
                if carried.text is None and carried.name.rstrip("_") == expected_name.rstrip("_")
            ]
            if len(fitted) == 1:
                self.machine.events[name].inputs[fitted[0]] = self.carried(name, target.path)
                self.machine.events[name].parts[fitted[0]] = part
                return self.names.leaf(EventInput(fitted[0]))
        inside = operands(part)
        if not inside:
            return part
        reads_array = name.name in _ENDS and "[" in self.names.all_words(part)
        if reads_array and not (is_guard and isinstance(part, ex.Conjunction)):
            raise UnlikeError("the plants have no input for a value computed from an array that may be missing", part)
        parts: list[ex.Expression] = []
        for number, operand in enumerate(inside):
            branch = isinstance(part, ex.Conditional) and number > 0
            parts.append((yield operand, assigned if branch else None))
        if isinstance(part, _JOINS) and not reads_array and all(self.is_computed(operand, name) for operand in parts):
            raise UnlikeError("the plants have several inputs for a condition that the node computes as one", part)
        return with_operands(part, parts)

    def is_computed(self, part: ex.Expression, name: EventName) -> bool:
        """Return whether a part with inputs is a condition that the node computes, or its negation."""
        while isinstance(part, ex.Negation):
            part = part.operand
        target = self.names.meaning(part) if isinstance(part, robosc.Access) else None
        if not isinstance(target, EventInput):
            return False
        carried = next(own for own in self.plants.events[name].element.inputs if own.name == target.name)
        return carried.text is not None and self.machine.events[name].inputs[target.name] == BOOLEANS

    def declared(self, part: ex.Expression, name: EventName) -> Domain | None:
        """Return the values of the type with which the part of some data is declared; None if it has no finite type."""
        target = self.names.meaning(part) if isinstance(part, robosc.Access) else None
        if not isinstance(target, Data):
            return None
        if target.stored is not None:
            variable, instance = target.stored
            declared: Any = variable.type
        else:
            instance, declared = self.ports[name.plant][0], self.carried_type(name)
        for segment in target.segments:
            if isinstance(segment, robosc.PropertySegment):
                declared = segment.property.type
            elif isinstance(segment, robosc.IndexSegment) and segment.last is None:
                declared = declared.type
        return None if declared is None else self.names.domain(declared, instance.place)

    def carried(self, name: EventName, path: Sequence[str]) -> Domain:
        """Return the values of a part of an event's data."""
        declared = self.carried_type(name)
        for part in path:
            declared = next(field.type for field in declared.type.properties if field.name == part)
        domain = self.names.domain(declared, self.ports[name.plant][0].place)
        return () if domain is None else domain

    def carried_type(self, name: EventName) -> Any:
        """Return the declared type of an event's data; None if it has none."""
        communication: Any = self.ports[name.plant][1]
        if isinstance(communication, robosc.Message):
            return communication.type
        match name.name.partition("_")[2]:
            case "trigger" | "request":
                return communication.requestType
            case "feedback":
                return communication.feedbackType
            case "response" | "error" | "canceled":
                return communication.responseType
        return None

    # Provided data

    def provided(self) -> None:
        """Read `provide` statements: the first with a true condition applies.

        Statements outside of components replace those inside.
        """
        by_event: dict[EventName, list[tuple[robosc.ProvideStatement, Environment]]] = {}
        for statement, place in self.names.definitions(robosc.ProvideStatement):
            by_event.setdefault(self.provided_event(statement, place), []).append((statement, place))
        for name, statements in by_event.items():
            outside = [statement for statement in statements if statement[1].within is None]
            self.choice(choice_of(name), outside or statements)

    def provided_event(self, statement: robosc.ProvideStatement, place: Environment) -> EventName:
        """Return the event whose data a statement provides."""
        if statement.feedback:
            return self.of(statement.communicationType, robosc.ResultType.feedback, place)
        return self.sending(statement.communicationType, place)

    def choice(self, plant: Plant, statements: Sequence[tuple[robosc.ProvideStatement, Environment]]) -> None:
        self.statements[plant] = statements
        names = ("none", *(f"d{number}" for number in range(1, len(statements) + 1)))
        slot = self.locations(plant, names, "none", names, statements[0][0])
        conditions = [
            (None if statement.condition is None else self.condition(statement.condition, place), statement)
            for statement, place in statements
        ]
        for location, (condition, statement) in zip(names[1:], conditions, strict=True):
            event = self.event(plant, f"c_{location}", statement)
            event.participants.append(_chosen(Slot(plant), location, [(condition, True)], statement))
        denied = [(condition, False) for condition, _ in conditions]
        self.event(plant, "c_none", statements[0][0]).participants.append(
            _chosen(slot, "none", denied, statements[0][0])
        )

    def provided_constant(self, statement: robosc.ProvideStatement, place: Environment) -> ProvidedConstant:
        """Return a statement with the inputs that its command has if it sends these data."""
        event_name = self.provided_event(statement, place)
        sender = self.machine.events.get(event_name)
        sent = constant_data(statement.data, place, self.names)
        if sent is None:
            return ProvidedConstant(statement, None)
        if sender is None:  # No transition names the response: each goal ends otherwise.
            return ProvidedConstant(statement, {})
        declared = self.carried_type(event_name)
        inputs: dict[str, Value] = {}
        for name, part in sender.parts.items():
            value = computed_input(part, sent, declared, self.names)
            if value is not None:
                inputs[name] = saturate(value, sender.inputs[name])
        return ProvidedConstant(statement, inputs)

    # Assumptions

    def assumed(self) -> None:
        """Add assumptions: their events are possible only where the condition holds, whatever else allows them."""
        for number, (assumption, place) in enumerate(self.names.assumptions, start=1):
            plant, condition = Plant("assumption", str(number)), self.condition(assumption.condition, place)
            self.locations(plant, ("holding",), "holding", ["holding"], assumption)
            for name in dict.fromkeys(self.named(event, place) for event in assumption.target.events):
                self.machine.events[name].participants.append(_only_where(condition, assumption))
                self.machine.assumed.setdefault(name, {})[plant] = condition

    # Requirements

    def required(self) -> None:
        """Add requirements to the start of their communications, and to the cancel of actions.

        An action is canceled if one of its requirements does not hold with the data of its goal.
        """
        known = (robosc.CommunicationRequirement, robosc.StateInvariant, robosc.ReachabilityRequirement, *OBSERVERS)
        for requirement, _ in self.names.definitions(robosc.Requirement):
            if not isinstance(requirement, known):
                raise NotReadError(requirement)
        running: dict[Plant, list[Restriction]] = {}
        for statement, place in self.names.definitions(robosc.CommunicationRequirement):
            value = not isinstance(statement, robosc.DisablesRequirement)
            for name in dict.fromkeys(
                self.sending(reference, place) for reference in statement.target.communicationTypes
            ):
                condition = self.condition(statement.condition, place, name)
                self.machine.events[name].restrictions.append(Restriction(condition, value, statement))
                if name.plant.kind == "action":
                    condition = self.condition(statement.condition, place, name, of_goal=True)
                    running.setdefault(name.plant, []).append(Restriction(condition, value, statement))
        for name, event in self.machine.events.items():
            if event.kind == "cancel":
                event.restrictions.append(_broken(running.get(name.plant, []), event.element))

    def goal(self, name: EventName, input_name: str) -> Slot:
        """Return the variable that holds an input of an action's start while its goal is running.

        Without a goal, it has its first value.
        """
        slot = Slot(name.plant, f"goal_{input_name.removeprefix('i_trigger_')}")
        if slot not in self.machine.domains:
            trigger = self.machine.events[name]
            domain, source = trigger.inputs[input_name], trigger.element
            self.slot(slot, domain, domain[0], source)
            trigger.participants.append(_stored(slot, input_name, source))
            for ending in _WITHOUT_GOAL:
                self.machine.events[EventName(name.plant, ending)].participants.append(
                    _always({slot: domain[0]}, source, frozenset({slot}))
                )
        return slot

    def observer_slots(self) -> None:
        for requirement, place in self.names.definitions(robosc.Requirement):
            if not isinstance(requirement, OBSERVERS):
                continue
            plant = self.names.observer(requirement, place)
            if isinstance(requirement, robosc.OrderRequirement):
                self.locations(plant, ("waiting", "ready"), "waiting", ("waiting", "ready"), requirement)
            elif isinstance(requirement, robosc.CountRequirement):
                self.locations(plant, ("counting",), "counting", ["counting"], requirement)
                most = self.names.constant(requirement.bound, place)
                self.slot(Slot(plant, "count"), range(most + 1), 0, requirement)
            else:
                assert isinstance(requirement, robosc.AutomatonRequirement)
                names = tuple(state.name for state in requirement.states)
                initial = next(state.name for state in requirement.states if state.initial)
                marked = [state.name for state in requirement.states if state.marked] or names
                self.locations(plant, names, initial, marked, requirement)

    def named(self, reference: robosc.EventReference, place: Environment) -> EventName:
        """Return the named event, the request, or the arrival of an outgoing message."""
        if isinstance(reference, robosc.NamedEvent):
            return self.of(reference.communicationType, reference.resultType, place)
        communication = reference.communicationType.communicationType
        comes = (
            isinstance(communication, robosc.Message) and communication.direction == robosc.MessageDirection.outgoing
        )
        named = robosc.ResultType.response if comes else robosc.ResultType.request
        return self.of(reference.communicationType, named, place)

    def observer(self, requirement: robosc.Requirement, place: Environment, plant: Plant) -> None:
        if isinstance(requirement, robosc.AutomatonRequirement):
            self.automaton(requirement, place, Slot(plant))
            return
        assert isinstance(requirement, robosc.OrderRequirement | robosc.CountRequirement)
        anchor = self.named(requirement.anchor, place)
        targets = dict.fromkeys(self.named(event, place) for event in requirement.target.events)
        events = self.machine.events
        slot = Slot(plant) if isinstance(requirement, robosc.OrderRequirement) else Slot(plant, "count")
        allowed = At(slot, "ready")
        for name in targets:
            if isinstance(requirement, robosc.CountRequirement):
                holds = _below(slot, self.machine.domains[slot])
                events[name].participants.append(_one_more(slot, requirement))
            else:
                holds = self.is_at(allowed)
                if requirement.each and name != anchor:
                    events[name].participants.append(_always({slot: "waiting"}, requirement))
            events[name].restrictions.append(Restriction(holds, True, requirement))
        result: Value = "ready" if isinstance(requirement, robosc.OrderRequirement) else 0
        events[anchor].participants.append(_always({slot: result}, requirement))

    def is_at(self, place: At) -> Condition:
        return compile_condition(self.names.leaf(place), lambda _: place)

    def automaton(self, requirement: robosc.AutomatonRequirement, place: Environment, slot: Slot) -> None:
        """Add a requirement automaton: an event without a transition with a true condition is forbidden."""
        alphabet = {
            self.named(transition.event, place): transition
            for state in requirement.states
            for transition in state.transitions
        }
        for name in alphabet:
            ways = {
                state.name: [
                    (
                        None if transition.guard is None else self.condition(transition.guard, place, name),
                        transition.target.name if transition.target else state.name,
                        transition,
                    )
                    for transition in state.transitions
                    if self.named(transition.event, place) == name
                ]
                for state in requirement.states
            }
            conditions = (way[0] for alternatives in ways.values() for way in alternatives)
            reads = frozenset({slot}).union(*(condition.reads for condition in conditions if condition))
            event = self.machine.events[name]
            event.participants.append(_following(slot, ways, reads, requirement))
            possible = partial(_first, slot, ways)
            event.restrictions.append(Restriction(Condition(possible, reads), True, requirement))

    def claims(self) -> None:
        """Read the conditions of `never`, `always`, `reachable`, and of properties."""
        for invariant, place in self.names.definitions(robosc.StateInvariant):
            value = invariant.kind == robosc.InvariantKind.always
            self.claim("the condition of an invariant", invariant.condition, place, value, invariant)
        for required, place in self.names.definitions(robosc.ReachabilityRequirement):
            self.claim("the reachable condition of a requirement", required.condition, place, True, required)
            # Without `from`, a way to the condition exists in every state.
            where = ex.BooleanLiteral(value=True) if required.premise is None else required.premise
            self.claim("the condition after `from` of a requirement", where, place, True, required)
        for claimed, place in self.names.definitions(robosc.Property):
            if isinstance(claimed, robosc.InvariantProperty):
                value = claimed.kind == robosc.InvariantKind.always
                self.claim("the condition of a property", claimed.condition, place, value, claimed)
            elif isinstance(claimed, robosc.ReachabilityProperty):
                self.claim("the reachable condition of a property", claimed.condition, place, True, claimed)
                start = claimed.premise or ex.BooleanLiteral(value=True)
                self.claim("the start condition of a property", start, place, True, claimed)

    def claim(self, what: str, expression: ex.Expression, place: Environment, value: bool, source: ex.Located) -> None:
        self.machine.conditions.append(Claim(what, self.condition(expression, place), value, source))


def _plant(instance: Instance, communication: robosc.CommunicationType) -> Plant:
    return Plant(kind_of(communication), f"{instance.name}.{communication.name}")


def _is_permitted(name: EventName) -> bool:
    """Return whether an event of a communication needs a transition in each component that names it.

    All others are ignored where there is none. A goal for the controller is accepted only by such transitions.
    """
    if name.plant.kind in SERVERS:
        return name.name.startswith("c_") or (name.plant.kind == "actionServer" and name.name == "u_request")
    return name.name == "c_trigger"


def _phases(slot: Slot, step: Mapping[str, str], source: ex.Located) -> Participant:
    def taken(state: Mapping[Slot, Value], _: Mapping[str, Value]) -> EventEffect | None:
        target = step.get(str(state[slot]))
        return None if target is None else EventEffect({slot: target}, source)

    return Participant(taken, frozenset({slot}), source)


def _chosen(
    slot: Slot, location: str, conditions: Sequence[tuple[Condition | None, bool]], source: ex.Located
) -> Participant:
    """Return a choice of data that needs each condition to have its value; a missing condition is true."""

    def step(state: Mapping[Slot, Value], inputs: Mapping[str, Value]) -> EventEffect | None:
        holds = (
            (True if condition is None else bool(condition.compute(state, inputs))) is value
            for condition, value in conditions
        )
        return EventEffect({slot: location}, source) if all(holds) else None

    return Participant(step, frozenset().union(*(condition.reads for condition, _ in conditions if condition)), source)


def _always(writes: Mapping[Slot, Value], source: ex.Located, reads: frozenset[Slot] = frozenset()) -> Participant:
    return Participant(lambda *_: EventEffect(writes, source), reads, source)


def _stored(slot: Slot, input_name: str, source: ex.Located) -> Participant:
    return Participant(lambda _, inputs: EventEffect({slot: inputs[input_name]}, source), frozenset({slot}), source)


def _only_where(condition: Condition, source: ex.Located) -> Participant:
    """Return a participant without a state that takes part only where a condition holds."""

    def step(state: Mapping[Slot, Value], inputs: Mapping[str, Value]) -> EventEffect | None:
        return EventEffect({}, source) if condition.compute(state, inputs) else None

    return Participant(step, condition.reads, source)


def _one_more(slot: Slot, source: ex.Located) -> Participant:
    return Participant(lambda state, _: EventEffect({slot: int(state[slot]) + 1}, source), frozenset({slot}), source)


def _broken(starting: Sequence[Restriction], source: ex.Located) -> Restriction:
    """Return the restriction that a requirement on the start of an action does not hold.

    Without any requirement, it is never satisfied.
    """

    def compute(state: Mapping[Slot, Value], inputs: Mapping[str, Value]) -> bool:
        return any(
            bool(restriction.condition.compute(state, inputs)) is not restriction.value for restriction in starting
        )

    reads = frozenset().union(*(restriction.condition.reads for restriction in starting))
    return Restriction(Condition(compute, reads), True, starting[0].source if starting else source)


def _below(slot: Slot, domain: Domain) -> Condition:
    """Return the condition that a count is below its bound."""
    return Condition(lambda state, _: state[slot] != domain[-1], frozenset({slot}))


def _first(
    slot: Slot, ways: Mapping[str, Sequence[_Way]], state: Mapping[Slot, Value], inputs: Mapping[str, Value]
) -> _Way | None:
    """Return the first transition of a requirement automaton's state whose condition holds."""
    tried = ways.get(str(state[slot]), ())
    return next((way for way in tried if way[0] is None or way[0].compute(state, inputs)), None)


def _following(
    slot: Slot, ways: Mapping[str, Sequence[_Way]], reads: frozenset[Slot], source: ex.Located
) -> Participant:
    def step(state: Mapping[Slot, Value], inputs: Mapping[str, Value]) -> EventEffect:
        way = _first(slot, ways, state, inputs)
        return EventEffect({}, source) if way is None else EventEffect({slot: way[1]}, way[2])

    return Participant(step, reads, source)
