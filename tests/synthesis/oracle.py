"""Synthesis by the definition: one state at a time, over sets. Deliberately slow and independent of the tool."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import Any

from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.edges import edges_from, edges_of

#: The location of each plant and the value of each variable, in the order of the model.
State = tuple[Any, ...]


@dataclass(frozen=True)
class Oracle:
    """The expected results of synthesis for a model."""

    model: sct.SupervisoryControlModel

    @cached_property
    def events(self) -> list[sct.Event]:
        return [event for plant in self.model.plants for event in plant.events]

    @cached_property
    def places(self) -> dict[Any, int]:
        """The index of each element's value in a state."""
        return {e: index for index, e in enumerate(e for plant in self.model.plants for e in (plant, *plant.variables))}

    @cached_property
    def initial(self) -> State:
        return tuple(
            next(location for location in place.locations if location.initial)
            if isinstance(place, sct.Plant)
            else self.value(place.initial, (), {})
            for place in self.places
        )

    def value(self, expression: ex.Expression | None, state: State, inputs: dict[sct.Input, Any]) -> Any:  # noqa: C901, PLR0912
        """Return the value of an expression: for an enumeration the literal itself, for None true."""

        def of(child: ex.Expression) -> Any:
            return self.value(child, state, inputs)

        match expression:
            case None:
                return True
            case ex.BooleanLiteral() | ex.IntegerLiteral():
                return expression.value
            case ex.EnumerationLiteralReference():
                return expression.literal
            case sct.VariableReference():
                return state[self.places[expression.variable]]
            case sct.InputReference():
                return inputs[expression.input]
            case sct.LocationReference():
                return state[self.places[expression.location.eContainer()]] is expression.location
            case ex.Negation():
                return not of(expression.operand)
            case ex.UnaryMinus():
                return -of(expression.operand)
            case ex.FunctionCall():
                return {"abs": abs, "min": min, "max": max}[expression.function](*map(of, expression.arguments))
            case ex.Conditional():
                return of(expression.then) if of(expression.condition) else of(expression.otherwise)
            case ex.BinaryExpression():
                left, right = of(expression.left), of(expression.right)
        match expression:
            case ex.Conjunction():
                return left and right
            case ex.Disjunction():
                return left or right
            case ex.Implication():
                return right if left else True
            case ex.Equation():
                return left == right
            case ex.Inequation():
                return left != right
            case ex.LessThan():
                return left < right
            case ex.LessOrEqual():
                return left <= right
            case ex.GreaterThan():
                return left > right
            case ex.GreaterOrEqual():
                return left >= right
            case ex.Addition():
                return left + right
            case ex.Subtraction():
                return left - right
            case ex.Multiplication():
                return left * right
        raise TypeError(expression)

    def inputs(self, event: sct.Event) -> list[dict[sct.Input, Any]]:
        """Return all combinations of input values of an event."""
        values = product(*(values_of(parameter.type) for parameter in event.inputs))
        return [dict(zip(event.inputs, chosen, strict=True)) for chosen in values]

    def enabled(self, event: sct.Event, state: State) -> bool:
        """Return whether the plants permit the event with some data."""
        return any(self.edges(event, state, inputs) is not None for inputs in self.inputs(event))

    def edges(self, event: sct.Event, state: State, inputs: dict[sct.Input, Any]) -> list[sct.Edge] | None:
        """Return the edges that the plants take together, or None if the event is not enabled with this data."""
        taken = []
        for plant in self.model.plants:
            if not any(edge.event is event for edge in edges_of(plant)):
                continue
            possible = [
                edge
                for edge in edges_from(state[self.places[plant]])
                if edge.event is event and self.value(edge.guard, state, inputs)
            ]
            if not possible:
                return None
            taken += possible
        return taken

    def successors(self, event: sct.Event, state: State) -> dict[State, dict[sct.Input, Any]]:
        """Return the states after the event, each with input values that lead to it."""
        reached: dict[State, dict[sct.Input, Any]] = {}
        for inputs in self.inputs(event):
            if self.edges(event, state, inputs) is not None:
                reached.setdefault(self.successor(event, state, inputs), inputs)
        return reached

    def successor(self, event: sct.Event, state: State, inputs: dict[sct.Input, Any]) -> State:
        """Return the state after an enabled event."""
        after = list(state)
        for edge in self.edges(event, state, inputs) or ():
            after[self.places[edge.target.eContainer()]] = edge.target
            for update in edge.updates:
                value = self.value(update.value, state, inputs)
                after[self.places[update.variable]] = _saturated(value, update.variable.type)
        return tuple(after)

    def required(self, event: sct.Event, state: State) -> bool:
        """Return whether the requirements permit the event."""
        return all(
            self.value(requirement.condition, state, {}) == (requirement.kind == sct.RequirementKind.needs)
            for requirement in self.model.requirements
            if requirement.event is event
        )

    def violates(self, state: State) -> bool:
        """Return whether an invariant is violated or a forbidden uncontrollable event is enabled."""
        forbidden = (event for event in self.events if not event.controllable and not self.required(event, state))
        return any(self.enabled(event, state) for event in forbidden) or not all(
            self.value(invariant.condition, state, {}) for invariant in self.model.invariants
        )

    def is_marked(self, state: State) -> bool:
        return all(state[self.places[plant]].marked for plant in self.model.plants)

    def reach(self, start: State, *, requirements: bool, within: set[State] | None = None) -> set[State]:
        """Return all states that are reachable from a state."""
        seen, pending = {start}, [start]
        while pending:
            state = pending.pop()
            for event in self.events:
                if requirements and not self.required(event, state):
                    continue
                for after in self.successors(event, state):
                    if after not in seen and (within is None or after in within):
                        seen.add(after)
                        pending.append(after)
        return seen

    @cached_property
    def uncontrolled(self) -> set[State]:
        return self.reach(self.initial, requirements=False)

    @cached_property
    def uncontrolled_states(self) -> int:
        """The number of states of the plants, without requirement automata."""
        kept = [
            index
            for place, index in self.places.items()
            if (place if isinstance(place, sct.Plant) else place.eContainer()).kind != sct.PlantKind.requirement
        ]
        return len({tuple(state[index] for index in kept) for state in self.uncontrolled})

    @cached_property
    def controlled(self) -> set[State]:
        good = self.reach(self.initial, requirements=True)
        next_states = {
            state: [
                (event, after)
                for event in self.events
                if self.required(event, state)
                for after in self.successors(event, state)
            ]
            for state in good
        }
        before = None
        while good != before:
            before = good
            good = {state for state in good if not self.violates(state)}
            good &= reaching(good, next_states, self.is_marked)
            for required in self.model.reachabilityRequirements:
                along = {state for state in good if self.value(required.pathCondition, state, {})}
                reach = reaching(
                    along,
                    next_states,
                    lambda state, goal=required: self.value(goal.condition, state, {}),
                    required.bound,
                )
                due = {state for state in along if self.value(required.premise, state, {})}
                good -= due - reach
            good = {
                state
                for state in good
                if all(event.controllable or after in good for event, after in next_states[state])
            }
        return self.reach(self.initial, requirements=True, within=good) if self.initial in good else set()

    def allows(self, event: sct.Event, state: State) -> bool:
        """Return whether the event can happen in a controlled state under the supervisor."""
        after = self.successors(event, state)
        return (
            bool(after) and self.required(event, state) and all(state_after in self.controlled for state_after in after)
        )


def reaching(
    states: set[State],
    next_states: dict[State, list[tuple[sct.Event, State]]],
    is_goal: Callable[[State], bool],
    bound: int | None = None,
) -> set[State]:
    """Return the states that reach a goal in at most `bound` events without leaving the set."""
    found = {state for state in states if is_goal(state)}
    steps = 0
    while steps != bound and (
        more := {s for s in states - found if any(after in found for _, after in next_states[s])}
    ):
        found |= more
        steps += 1
    return found


def values_of(kind: ex.Type) -> list[Any]:
    """Return all values of a type."""
    match kind:
        case ex.BooleanType():
            return [False, True]
        case ex.IntegerType():
            return list(range(kind.minimum, kind.maximum + 1))
    literals = list(kind.enumeration.literals)
    first = 0 if kind.first is None else literals.index(kind.first)
    return literals[first:] if kind.last is None else literals[first : literals.index(kind.last) + 1]


def _saturated(value: Any, kind: ex.Type) -> Any:
    return min(max(value, kind.minimum), kind.maximum) if isinstance(kind, ex.IntegerType) else value
