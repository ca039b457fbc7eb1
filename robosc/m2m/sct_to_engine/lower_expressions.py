"""Pass: lowers expressions of an sct model to terms. Negations move to the leaves."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.m2m.sct_to_engine.terms import COMPLEMENTS, Term, Terms
from robosc.model import engine, sct
from robosc.model import expression as ex
from robosc.model.semantics.walks import operands

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

#: An expression, and its polarity (false: its negation).
_Key = tuple[ex.Expression, bool]


class Lowering:
    """Lowers expressions to terms. Each expression is lowered only once.

    `variables` and `inputs` map the model's elements to the engine's. A plant with one location has no variable.
    """

    def __init__(
        self,
        terms: Terms,
        variables: Mapping[sct.Plant | sct.DiscreteVariable, engine.StateVariable],
        inputs: Mapping[sct.Input, engine.Input],
    ) -> None:
        self.terms = terms
        self.variables = variables
        self._inputs = inputs
        self._done: dict[_Key, Term] = {}

    def __call__(self, expression: ex.Expression | None, *, positive: bool = True) -> Term:
        """Return the term of an expression, or of its negation. None means no condition and gives `true`.

        Raises ValueError for an expression that no sct model has: doubles, strings, division.
        """
        if expression is None:
            return self.terms.true if positive else self.terms.false
        pending: list[tuple[_Key, list[_Key] | None]] = [((expression, positive), None)]
        while pending:
            key, parts = pending.pop()
            if parts is not None:
                self._done[key] = self._combine(key, [self._done[part] for part in parts])
            elif key not in self._done:
                parts = _parts(key)
                pending.append((key, parts))
                pending += [(part, None) for part in reversed(parts)]
        return self._done[expression, positive]

    def within(
        self,
        plant: sct.Plant,
        locations: Collection[sct.Location | None],
        possible: Sequence[sct.Location | None] | None = None,
    ) -> Term:
        """Return the condition that a plant is in one of the locations, in its shorter form.

        The plant must be in one of the `possible` locations; None stands for all locations. `locations` is a subset of
        `possible`, without duplicates.
        """
        possible = plant.locations if possible is None else possible
        holds = 2 * len(locations) <= len(possible)
        chosen = set(locations)
        variable = self.variables.get(plant)
        return self.terms.junction(
            engine.Or if holds else engine.And,
            [self.terms.at(variable, place, holds=holds) for place in possible if place and (place in chosen) is holds],
        )

    def where(
        self,
        plant: sct.Plant,
        guards: Mapping[sct.Location | None, Term],
        possible: Sequence[sct.Location | None] | None = None,
    ) -> Term:
        """Return the condition that a plant is in one of the locations and its guard holds.

        Equal guards are combined.
        """
        by_guard: dict[Term, list[sct.Location | None]] = {}
        for location, guard in guards.items():
            by_guard.setdefault(guard, []).append(location)
        return self.terms.junction(
            engine.Or,
            [
                self.terms.junction(engine.And, [self.within(plant, locations, possible), guard])
                for guard, locations in by_guard.items()
            ],
        )

    def _combine(self, key: _Key, parts: list[Term]) -> Term:
        expression, positive = key
        kind = _junction(key)
        if kind is not None:
            return self.terms.junction(kind, parts)
        if isinstance(expression, ex.Negation):
            return parts[0]
        if isinstance(expression, ex.FunctionCall):
            return self.terms.call(expression.function, *parts)
        if isinstance(expression, (ex.BinaryExpression, ex.UnaryMinus, ex.Conditional)):
            operator = type(expression)
            return self.terms.operation(operator if positive else COMPLEMENTS.get(operator, operator), *parts)
        atom = self._atom(expression)
        return atom if positive else self.terms.negation(atom)

    def _atom(self, expression: ex.Expression) -> Term:
        match expression:
            case ex.BooleanLiteral():
                return self.terms.constant(None, int(expression.value))
            case ex.IntegerLiteral():
                return self.terms.constant(int, expression.value)
            case ex.EnumerationLiteralReference():
                owner: ex.Enumeration = expression.literal.eContainer()
                return self.terms.constant(owner, list(owner.literals).index(expression.literal))
            case sct.VariableReference():
                return self.terms.reference(self.variables[expression.variable])
            case sct.InputReference():
                return self.terms.reference(self._inputs[expression.input])
            case sct.LocationReference():
                return self.terms.at(self.variables.get(expression.location.eContainer()), expression.location)
        raise ValueError(f"an sct model holds no {type(expression).__name__}")


def _junction(key: _Key) -> type[engine.And | engine.Or] | None:
    """Return the class for a conjunction, disjunction, implication or its negation. None for other expressions."""
    match key:
        case (ex.Conjunction(), positive):
            return engine.And if positive else engine.Or
        case (ex.Disjunction() | ex.Implication(), positive):
            return engine.Or if positive else engine.And
    return None


def _parts(key: _Key) -> list[_Key]:
    """Return the parts to lower first. All operands of nested junctions of one class are parts of the outermost."""
    kind = _junction(key)
    if kind is None:
        return _children(key)
    parts: list[_Key] = []
    pending = [key]
    while pending:
        part = pending.pop()
        if _junction(part) is kind or isinstance(part[0], ex.Negation):
            pending += reversed(_children(part))
        else:
            parts.append(part)
    return parts


def _children(key: _Key) -> list[_Key]:
    match key:
        case (ex.Implication(left=left, right=right), positive):
            return [(left, not positive), (right, positive)]
        case (ex.Conjunction(left=left, right=right) | ex.Disjunction(left=left, right=right), positive):
            return [(left, positive), (right, positive)]
        case (ex.Negation(operand=operand), positive):
            return [(operand, not positive)]
        case (ex.Conditional(condition=condition, then=then, otherwise=otherwise), positive):
            return [(condition, True), (then, positive), (otherwise, positive)]
    return [(operand, True) for operand in operands(key[0])]
