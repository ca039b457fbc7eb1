"""From the automata of a specification to an sct model with the semantics of CIF's synthesis.

Implicit rules of CIF's synthesis become explicit. An automaton that monitors an event stays in its location if it has
no edge for the event. A requirement automaton monitors all of its events, and its restrictions become requirements on
its locations. Supervisors of the text are requirements. A requirement forbids each edge that would assign a value out
of range. An input variable becomes a variable to which an uncontrollable event assigns any value.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.language.cif import plant_invariants
from robosc.language.cif.channels import VOID, Channels, EventEdge, at, sent_value
from robosc.language.cif.faults import (
    CONDITIONAL_UPDATES,
    TAU,
    CifFaultError,
    construct,
    place_of,
    span,
    text_of,
)
from robosc.language.cif.parsing import identifier
from robosc.language.cif.reachability import reachability_requirement
from robosc.language.cif.scopes import RESTRICTIONS, Declaration, Scope, Specification, plain
from robosc.language.cif.static_values import constant_value, default, literal
from robosc.language.cif.values import Values, computed_from_itself
from robosc.language.syntax_messages import closest, offer_name
from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.cif_types import Type, compatible, contains, format_type, overlap
from robosc.model.semantics.domains import domain
from robosc.model.semantics.edges import edges_by_event
from robosc.model.semantics.naming import Names
from robosc.model.semantics.printing import conjunction, disjunction
from robosc.model.semantics.walks import copy_tree

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from robosc.language.cif.static_values import TypedNode


def to_sct(names: Specification, name: str) -> sct.SupervisoryControlModel:
    """Return the sct model of a specification; its faults are added to the findings of `names`."""
    return _CifToSct(names, name).model


class _CifToSct:
    def __init__(self, names: Specification, name: str) -> None:
        self._names = names
        self._values = Values(names)
        self.model = sct.SupervisoryControlModel(name=name)
        self._event_edges: dict[Scope, list[EventEdge]] = {}
        self._exclusions: dict[sct.Event, list[tuple[Any, ex.Expression]]] = {}
        self._plant_invariants: list[tuple[Any, ex.Expression]] = []
        scopes = list(_inside(names.root))
        for scope in scopes:
            self._declare(scope)
        for scope in scopes:
            with names.reporting():
                self._fill(scope)
        events = (declared for scope in scopes for declared in scope.events)
        self._channels = Channels(names, self._values, self._updates, events)
        for scope, taken in self._channels.resolve(self._event_edges).items():
            with names.reporting():
                self._edges_of(taken, scope)
        for scope in scopes:
            with names.reporting():
                self._predicates(scope)
        self._keep_invariants([scope.plant for scope in scopes if scope.plant])
        self._exclude()
        used = {edge.event for scope in scopes if scope.plant for edge in _edges(scope.plant)}
        for scope in scopes:
            self._keep(scope, used)
        self._enumerations()
        self._identify()
        if not any(plant.kind != sct.PlantKind.requirement for plant in self.model.plants) and not names.findings:
            with names.reporting():
                hint = "write `plant` before at least one automaton"
                raise CifFaultError(names.first, "cif-construct", "there is no plant", hint)

    # Declarations

    def _declare(self, scope: Scope) -> None:
        """Create the events, variables and inputs of a scope."""
        if scope.kind == "supervisor":
            self.model.supervised = True
        if scope.kind == "":
            with self._names.reporting():
                raise construct(scope.node, "automata of no kind", "write `plant` or `requirement` before it")
        for declared in scope.events:
            control = declared.outer.control
            kind = sct.EventKind.plain
            event = sct.Event(
                name=declared.name, controllable=control == "controllable", kind=kind, source=place_of(declared.node)
            )
            declared.element = event
            with self._names.reporting():
                self._channel(declared, scope)
        for known in scope.names.values():
            if isinstance(known, Declaration) and known.kind in ("Variables", "Inputs"):
                # Until the type is known, only expressions in the type itself can read the variable.
                known.fault = computed_from_itself(known)
                try:
                    self._variable(known, scope)
                except CifFaultError as fault:
                    known.fault = fault
                    with self._names.reporting():
                        raise

    def _channel(self, declared: Declaration, scope: Scope) -> None:
        """Set the type of an event that is a channel."""
        kind = declared.outer.type
        if kind is not None:
            declared.type = VOID if kind.type is None else self._values.synthesized_type(kind.type, scope)

    def _plant(self, scope: Scope) -> sct.Plant:
        """Return the plant of a scope; a group has one if it declares events or inputs."""
        if scope.plant is None:
            scope.plant = sct.Plant(name=scope.path, kind=sct.PlantKind.behaviour)
            scope.plant.locations.append(sct.Location(name="L", initial=True, marked=True))
        return scope.plant

    def _variable(self, declared: Declaration, scope: Scope) -> None:
        declared.type = self._values.synthesized_type(declared.outer.type, scope)
        if declared.type == "int":
            raise construct(declared.outer.type, "an int without range", "write `int[lowest..highest]`")
        plant = self._plant(scope)
        source = place_of(declared.node)
        variable = sct.DiscreteVariable(name=declared.name, type=_type(declared.type), source=source)
        plant.variables.append(variable)
        declared.element = variable
        if declared.kind == "Inputs":
            value = sct.Input(name=declared.name, type=_type(declared.type), source=source)
            plant.inputs.append(value)
            event = sct.Event(
                name=declared.name, controllable=False, kind=sct.EventKind.input, inputs=[value], source=source
            )
            plant.events.append(event)
            for location in plant.locations:
                edge = sct.Edge(event=event, target=location, source=source)
                edge.updates.append(sct.Update(variable=variable, value=sct.InputReference(input=value), source=source))
                location.edges.append(edge)

    def _keep(self, scope: Scope, used: set[sct.Event]) -> None:
        """Add the scope's plant to the model, with those of its events that can happen."""
        declared = (event for declared in scope.events for event in self._channels.events_of(declared.element))
        events = [event for event in declared if event in used]
        if events:
            plant = self._plant(scope)
            inputs = list(plant.events)
            del plant.events[:]
            plant.events.extend([*events, *inputs])
        if scope.plant is not None:
            self.model.plants.append(scope.plant)

    def _identify(self) -> None:
        """Give plants and enumerations unique names that are identifiers; `origin` is their absolute name."""
        names = Names()
        for plant in self.model.plants:
            plant.origin = plant.name or None
            plant.name = names.fresh(plant.name.replace(".", "_") or "specification")
        names = Names()
        for enumeration in self.model.enumerations:
            around = f"{enumeration.origin}." if enumeration.origin else ""
            enumeration.name = names.fresh(f"{around}{enumeration.name}".replace(".", "_"))

    def _enumerations(self) -> None:
        for scope in _inside(self._names.root):
            for declared in scope.names.values():
                if (
                    isinstance(declared, Declaration)
                    and declared.kind == "Enumeration"
                    and declared.element is not None
                ):
                    self.model.enumerations.append(declared.element)

    # Automata

    def _fill(self, scope: Scope) -> None:
        """Create the initial values and edges of an automaton."""
        for declared in scope.names.values():
            with self._names.reporting():
                if isinstance(declared, Declaration) and declared.kind in ("Constants", "Algebraics"):
                    self._define(declared)
                elif (
                    isinstance(declared, Declaration) and declared.kind == "Variables" and declared.element is not None
                ):
                    self._initialise(declared, scope)
        taken: list[EventEdge] = []
        if _is_automaton(scope):
            self._event_edges[scope] = taken
        initial = False
        for location, element in _elements(scope):
            initial = initial or type(element).__name__ == "LocationInitial"
            if type(element).__name__ == "Edge":
                with self._names.reporting():
                    taken += self._taken(element, location, scope)
        if _is_automaton(scope) and not initial:
            message = f"`{scope.path}` has no initial location"
            raise CifFaultError(scope.node, "initial-state", message, "write `initial;` in one location")

    def _define(self, declared: Declaration) -> None:
        """Read a constant or an algebraic variable. Outside of synthesis, a variable may have any value."""
        try:
            self._values.known(declared)
        except CifFaultError as fault:
            if declared.kind == "Constants" or fault.rule != "cif-construct":
                raise

    def _edges_of(self, taken: list[EventEdge], scope: Scope) -> None:
        """Create the edges and the requirements of an automaton."""
        used = self._alphabet([edge for edge in taken if not edge.use], scope)
        watched = self._events(scope, "Monitor")
        if watched == []:
            watched = used
        requirement = scope.kind in RESTRICTIONS
        for event in used:
            edges = [edge for edge in taken if edge.event is event]
            self._place(edges, event, scope, watching=requirement or event in (watched or ()))
            if requirement and event not in (watched or ()):
                self._require(edges, event, scope)
        for event in dict.fromkeys(edge.event for edge in taken if edge.use):
            self._place([edge for edge in taken if edge.event is event], event, scope, watching=False)

    def _alphabet(self, taken: Iterable[EventEdge], scope: Scope) -> list[sct.Event]:
        """Return the events in which an automaton takes part."""
        declared = self._events(scope, "Alphabet")
        for edge in taken:
            if declared is not None and edge.event not in declared:
                message = f"`{edge.event.name}` is not in the alphabet of `{scope.path}`"
                with self._names.reporting():
                    raise CifFaultError(edge.node, "cif-declaration", message, "add it there")
        return list(dict.fromkeys(edge.event for edge in taken)) if declared is None else declared

    def _events(self, scope: Scope, rule: str) -> list[sct.Event] | None:
        events = [
            event
            for declaration in scope.declarations(rule)
            for name in declaration.events
            for event in self._channels.events_of(self._event(name, scope))
        ]
        return list(dict.fromkeys(events)) if any(True for _ in scope.declarations(rule)) else None

    def _event(self, name: Any, scope: Scope) -> sct.Event:
        declared = self._names.find(name, scope)
        if not isinstance(declared, Declaration) or declared.kind != "Events":
            raise CifFaultError(name, "type", f"`{name.text}` is not an event")
        if not declared.outer.control:
            hint = f"declare `{declared.name}` as `controllable` or as `uncontrollable`"
            raise construct(name, "events that are neither controllable nor uncontrollable", hint)
        event: sct.Event = declared.element
        return event

    def _taken(self, node: Any, location: sct.Location, scope: Scope) -> Iterator[EventEdge]:
        if not node.events or any(edge_event.tau for edge_event in node.events):
            raise construct(node, "edges without an event", TAU)
        events = [self._edge_event(edge_event, scope) for edge_event in node.events]
        uses = {use for _, use, _ in events}
        if "?" in uses and len(uses) > 1:
            raise CifFaultError(node, "type", "all events of an edge that receives must receive", "write two edges")
        target = location
        if node.target is not None:
            name = plain(node.target.name)
            location_named = scope.names.get(name)
            if not isinstance(location_named, sct.Location):
                known = [sibling.name for sibling in location.eContainer().locations]
                raise CifFaultError(node.target, "unresolved-reference", *_missing(name, known))
            target = location_named
        guard = self._values.condition(node.guards, scope)
        updates, fits = ([], {}) if "?" in uses else self._updates(node, scope)
        for event, use, sent in dict.fromkeys(events):
            yield EventEdge(location, event, guard, fits, updates, target, node, use, sent)

    def _edge_event(self, node: Any, scope: Scope) -> tuple[sct.Event, str, TypedNode | None]:
        """Return an event of an edge, its use, and the value that it sends."""
        event = self._event(node.event, scope)
        declared = self._names.find(node.event, scope)
        assert isinstance(declared, Declaration)
        return event, (node.use or "").strip(), sent_value(node, declared, scope, self._values)

    def _updates(
        self, node: Any, scope: Scope
    ) -> tuple[list[tuple[sct.DiscreteVariable, ex.Expression, Any]], dict[sct.DiscreteVariable, ex.Expression]]:
        """Return the updates of an edge, and the conditions under which variables stay in range."""
        updates: list[tuple[sct.DiscreteVariable, ex.Expression, Any]] = []
        fits: dict[sct.DiscreteVariable, ex.Expression] = {}
        for update in node.updates:
            variable, value, kind = self._update(update, scope)
            if any(variable is other for other, _, _ in updates):
                raise CifFaultError(update, "repeated-assignment", f"`{variable.name}` is assigned twice")
            updates.append((variable, value, update))
            within = conjunction(_fitting(variable, value, kind))
            if within is not None:
                fits[variable] = within
        return updates, fits

    def _update(self, node: Any, scope: Scope) -> tuple[sct.DiscreteVariable, ex.Expression, Type]:
        if node.conditional:
            raise construct(node, "conditional updates", CONDITIONAL_UPDATES)
        if node.several or node.projections:
            raise construct(node, "updates of tuples and lists", "write a variable for each element")
        declared = self._names.find(node.variable, scope)
        if not isinstance(declared, Declaration) or declared.kind != "Variables":
            raise CifFaultError(node, "type", f"`{node.variable.text}` is not a discrete variable")
        if declared.element is None:
            raise declared.fault
        if declared.element.eContainer() is not scope.plant:
            message = f"`{node.variable.text}` is assigned by `{declared.scope.path}` only, which declares it"
            raise CifFaultError(node, "assignment-scope", message)
        value = self._values.whole(node.value, scope)
        # The type of a received value is that of the channel; the sent value may be out of the variable's range.
        fits = compatible if self._values.received is not None else overlap
        if not fits(declared.type, value.type):
            message = f"`{declared.name}` is {format_type(declared.type)}, the assigned value {format_type(value.type)}"
            raise CifFaultError(node, "type", message)
        return declared.element, value.expression, value.type

    def _place(self, edges: list[EventEdge], event: sct.Event, scope: Scope, *, watching: bool) -> None:
        """Create the edges of an event in a plant; if it monitors the event, it stays if no edge can be taken."""
        plant = scope.plant
        assert plant is not None
        for edge in edges:
            guard = None if edge.guard is None else copy_tree(edge.guard)
            placed = sct.Edge(event=event, guard=guard, target=edge.target, source=place_of(edge.node))
            for variable, value, node in edge.updates:
                placed.updates.append(sct.Update(variable=variable, value=copy_tree(value), source=place_of(node)))
            edge.location.edges.append(placed)
            if edge.fits:
                self._stay_in_range(edge, plant, alone=len(edges) == 1 and not watching)
        if watching:
            for location in plant.locations:
                guards = [edge.guard for edge in edges if edge.location is location]
                if all(guard is not None for guard in guards):
                    others = [ex.Negation(operand=copy_tree(guard)) for guard in guards if guard is not None]
                    stay = sct.Edge(
                        event=event, guard=conjunction(others), target=location, source=place_of(scope.node)
                    )
                    location.edges.append(stay)
        elif not edges:
            never = ex.BooleanLiteral(value=False)
            location = plant.locations[0]
            location.edges.append(sct.Edge(event=event, guard=never, target=location, source=place_of(scope.node)))

    def _stay_in_range(self, edge: EventEdge, plant: sct.Plant, *, alone: bool) -> None:
        """Add the requirement that forbids an event if an edge would assign a value out of range.

        `alone` means that the plant has no other edge for the event, so that the event always takes this edge.
        """
        fits = conjunction(map(copy_tree, edge.fits.values()))
        assert fits is not None
        premises = [*at(edge.location, plant), *(copy_tree(part) for part in (edge.guard,) if part is not None)]
        premise = None if alone else conjunction(premises)
        self.model.requirements.append(
            sct.Requirement(
                event=edge.event,
                kind=sct.RequirementKind.needs,
                condition=fits if premise is None else ex.Implication(left=premise, right=fits),
                ranges=list(edge.fits),
                text=f"range of {', '.join(variable.name for variable in edge.fits)}: {_words(edge.node)}",
                source=place_of(edge.node),
            )
        )

    def _require(self, edges: list[EventEdge], event: sct.Event, scope: Scope) -> None:
        """Add the requirement that an event happens only if a requirement automaton has an edge for it."""
        plant = scope.plant
        assert plant is not None
        allowed = []
        for edge in edges:
            guard = [copy_tree(part) for part in (edge.guard,) if part is not None]
            here = conjunction([*at(edge.location, plant), *guard])
            if here is None:
                return
            allowed.append(here)
        self.model.requirements.append(
            sct.Requirement(
                event=event,
                kind=sct.RequirementKind.needs,
                condition=disjunction(allowed) or ex.BooleanLiteral(value=False),
                automaton=plant,
                name=scope.path,
                text=f"{scope.kind} {scope.path}",
                source=place_of(scope.node),
            )
        )

    def _initialise(self, declared: Declaration, scope: Scope) -> None:
        """Set the initial value of a variable, or add an initial predicate if it can have several."""
        variable, node = declared.element, declared.node
        if node.any:
            return
        if not node.values:
            variable.initial = literal(default(declared.type))
            return
        several = []
        for value in node.values:
            typed = self._values.whole(value, scope)
            if not contains(declared.type, typed.type):
                constant = constant_value(typed.expression)
                if not isinstance(declared.type, range) or constant is None or constant not in declared.type:
                    kind, value_kind = format_type(declared.type), format_type(typed.type)
                    message = f"`{declared.name}` is {kind}, its initial value {value_kind}"
                    raise CifFaultError(value, "integer-range" if isinstance(typed.type, range) else "type", message)
            several.append(typed.expression)
        constants = [constant_value(value) for value in several]
        if len(several) == 1 and constants[0] is not None:
            variable.initial = literal(constants[0])
            return
        either = disjunction(
            ex.Equation(left=sct.VariableReference(variable=variable), right=value) for value in several
        )
        assert either is not None
        self.model.initialPredicates.append(either)

    # Predicates

    def _predicates(self, scope: Scope) -> None:
        """Translate initial and marked states and the invariants."""
        for node in scope.declarations("Initial", "Marked", "Invariants"):
            with self._names.reporting():
                if type(node).__name__ == "Invariants":
                    self._invariants(node, scope, None)
                    continue
                predicate = self._values.condition(node.conditions, scope)
                assert predicate is not None
                initial = type(node).__name__ == "Initial"
                (self.model.initialPredicates if initial else self.model.markerPredicates).append(predicate)
        for annotation in (annotation for body in scope.bodies for annotation in getattr(body, "annotations", ())):
            if type(annotation).__name__ == "Reachable":
                with self._names.reporting():
                    required = reachability_requirement(annotation, scope, self._values)
                    required.text, required.source = _words(annotation), place_of(annotation)
                    self.model.reachabilityRequirements.append(required)
        for location, element in _elements(scope):
            with self._names.reporting():
                self._element(element, location, scope)

    def _element(self, node: Any, location: sct.Location, scope: Scope) -> None:
        match type(node).__name__:
            case "Invariants":
                self._invariants(node, scope, location)
            case "LocationInitial" | "LocationMarked" as kind:
                initial = kind == "LocationInitial"
                if initial:
                    location.initial = True
                else:
                    location.marked = True
                condition = self._values.condition(node.conditions, scope)
                if condition is not None:
                    here = sct.LocationReference(location=location)
                    implication = ex.Implication(left=here, right=condition)
                    (self.model.initialPredicates if initial else self.model.markerPredicates).append(implication)

    def _invariants(self, node: Any, scope: Scope, location: sct.Location | None) -> None:
        if not node.kind:
            what = "invariants of no kind"
            raise construct(node, what, "write `requirement` before it, or `plant` if the system itself ensures it")
        if node.kind == "supervisor":
            self.model.supervised = True
        for invariant in node.invariants:
            with self._names.reporting():
                self._invariant(invariant, node.kind == "plant", scope, location)

    def _invariant(self, node: Any, plant: bool, scope: Scope, location: sct.Location | None) -> None:
        restriction = node.restriction
        condition = self._values.condition([restriction.condition], scope)
        assert condition is not None
        here = sct.LocationReference(location=location) if location is not None else None
        attributes: dict[str, Any] = {
            "name": scope.absolute(plain(node.name)) if node.name else None,
            "text": _words(node.parent if len(node.parent.invariants) == 1 else node),
            "source": place_of(node),
        }
        rule = type(restriction).__name__
        if rule == "Condition":
            condition = condition if here is None else ex.Implication(left=here, right=condition)
            if plant:
                self._plant_invariants.append((node, condition))
                return
            self.model.invariants.append(sct.StateInvariant(condition=condition, **attributes))
            return
        needs = rule == "Needs"
        if here is not None:
            combine = ex.Implication if needs else ex.Conjunction
            condition = combine(left=here, right=condition)
        named = (self._event(name, scope) for name in restriction.events)
        for event in [divided for whole in named for divided in self._channels.events_of(whole)]:
            if plant:
                own = copy_tree(condition)
                self._exclusions.setdefault(event, []).append((node, own if needs else ex.Negation(operand=own)))
                continue
            kind = sct.RequirementKind.needs if needs else sct.RequirementKind.disables
            self.model.requirements.append(
                sct.Requirement(event=event, kind=kind, condition=copy_tree(condition), **attributes)
            )

    def _keep_invariants(self, plants: list[sct.Plant]) -> None:
        """Make the system start in and never leave its plant invariants."""
        edges = edges_by_event(plants)
        for node, condition in self._plant_invariants:
            for event, excluding in plant_invariants.keep(condition, edges):
                with self._names.reporting():
                    overlap = [edge for own in edges[event].values() for edge in own]
                    if excluding is None or (not event.controllable and _several(overlap)):
                        raise construct(node, f"this plant invariant with `{event.name}`", "write it as guards")
                    self._exclusions.setdefault(event, []).append((node, excluding))
            self.model.initialPredicates.append(condition)

    def _exclude(self) -> None:
        """Exclude events by plant invariants in a plant with one location; drop requirements on unused events."""
        used = {edge.event for scope in _inside(self._names.root) if scope.plant for edge in _edges(scope.plant)}
        for requirement in [requirement for requirement in self.model.requirements if requirement.event not in used]:
            self.model.requirements.remove(requirement)
        if not self._exclusions:
            return
        names = {scope.path for scope in _inside(self._names.root)}
        name = next(
            name for number in range(len(names) + 1) if (name := f"plant_invariants{number or ''}") not in names
        )
        plant = sct.Plant(name=name, kind=sct.PlantKind.behaviour)
        location = sct.Location(name="L", initial=True, marked=True)
        plant.locations.append(location)
        for event, exclusions in self._exclusions.items():
            if event in used:
                guard = conjunction(condition for _, condition in exclusions)
                source = place_of(exclusions[0][0])
                location.edges.append(sct.Edge(event=event, guard=guard, target=location, source=source))
        if location.edges:
            self.model.plants.append(plant)


def _inside(scope: Scope) -> Iterator[Scope]:
    """Yield a scope and all scopes in it, in the order of the text."""
    pending = [scope]
    while pending:
        here = pending.pop()
        yield here
        pending += reversed(here.children)


def _is_automaton(scope: Scope) -> bool:
    return scope.kind is not None and bool(scope.bodies)


def _elements(scope: Scope) -> Iterator[tuple[sct.Location, Any]]:
    """Yield the elements in the locations of an automaton, each with its location."""
    if _is_automaton(scope) and scope.plant is not None:
        for location, node in zip(scope.plant.locations, scope.bodies[0].locations, strict=True):
            for element in node.elements:
                yield location, element


def _edges(plant: sct.Plant) -> Iterable[sct.Edge]:
    return (edge for location in plant.locations for edge in location.edges)


def _several(edges: Iterable[sct.Edge]) -> bool:
    """Return whether several of the edges leave the same location."""
    left = [edge.eContainer() for edge in edges]
    return len(left) > len(set(left))


def _fitting(variable: sct.DiscreteVariable, value: ex.Expression, kind: Type) -> Iterator[ex.Expression]:
    """Yield the conditions for a value to be in the range of its variable, unless its type guarantees them.

    A subtrahend is moved to the other side, because CIF's synthesis supports `-` in assignments only.
    """
    if not isinstance(kind, range):
        return
    own = domain(variable.type)
    bounds: list[tuple[type[ex.BinaryExpression], int]] = []
    if kind.start < own.low:
        bounds.append((ex.GreaterOrEqual, own.low))
    if kind.stop - 1 > own.high:
        bounds.append((ex.LessOrEqual, own.high))
    for comparison, bound in bounds:
        left, right = copy_tree(value), literal(bound)
        if isinstance(left, ex.Subtraction):
            if isinstance(left.right, ex.IntegerLiteral):
                right = literal(left.right.value + bound)
            else:
                right = left.right if bound == 0 else ex.Addition(left=left.right, right=right)
            left = left.left
        yield comparison(left=left, right=right)


def _type(kind: Type) -> ex.Type:
    if isinstance(kind, range):
        return ex.IntegerType(minimum=kind.start, maximum=kind.stop - 1)
    return ex.EnumerationType(enumeration=kind) if isinstance(kind, ex.Enumeration) else ex.BooleanType()


def _words(node: Any) -> str:
    """Return the text of an element in one line."""
    start, end = span(node)
    return " ".join(text_of(node).content[start:end].split()).rstrip(";").strip()


def _missing(name: str, known: list[str]) -> tuple[str, Any]:
    close = closest(name, known, cutoff=0.6)
    repair = offer_name(identifier(close)) if close else None
    return f"there is no location `{name}` here", repair
