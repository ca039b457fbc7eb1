"""Locations, variables, inputs and expressions of an SCT model as decision diagrams.

Each element with a state is a finite domain: the location of a plant, a discrete variable, an input. The code of a
value is its index in the domain, in binary, with the most significant bit on top. Each bit of the state has a copy for
the next state directly below it. In a model with wide integers, there is one more copy in between, for a state halfway.
The bits of wide integers are interleaved if these are computed from each other, compared, or counted by the same event.
Without that, the diagram of `x = y` has a node for every value.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Literal, TypeAlias

from robosc.base.diagnostics import Diagnostic, ModelError, Severity
from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.places import place
from robosc.model.reflection import tree
from robosc.model.semantics import domains
from robosc.model.semantics.edges import edges_of
from robosc.model.semantics.walks import fold, operands
from robosc.synthesis import arithmetic
from robosc.synthesis.order import variable_order

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from robosc.synthesis.arithmetic import Vector
    from robosc.synthesis.bdd import Diagram, Diagrams

#: Element with a finite domain. A plant stands for its location.
Element: TypeAlias = "sct.Plant | sct.DiscreteVariable | sct.Input"
#: "automatic", "text", or names of elements.
Order: TypeAlias = "Literal['automatic', 'text'] | Sequence[str]"
#: Minimum number of values of a wide integer.
_WIDE = 1 << 10
_LOGICAL: Mapping[type[ex.Expression], Callable[..., Diagram]] = {
    ex.Negation: lambda operand: ~operand,
    ex.Conjunction: lambda left, right: left & right,
    ex.Disjunction: lambda left, right: left | right,
    ex.Implication: lambda left, right: left.imp(right),
}
_COMPARISON: Mapping[type[ex.Expression], Callable[[Vector, Vector], Diagram]] = {
    ex.Equation: arithmetic.equal,
    ex.Inequation: lambda left, right: ~arithmetic.equal(left, right),
    ex.LessThan: arithmetic.less,
    ex.LessOrEqual: lambda left, right: ~arithmetic.less(right, left),
    ex.GreaterThan: lambda left, right: arithmetic.less(right, left),
    ex.GreaterOrEqual: lambda left, right: ~arithmetic.less(left, right),
}
_ARITHMETIC: Mapping[type[ex.Expression], Callable[..., Vector]] = {
    ex.UnaryMinus: arithmetic.negate,
    ex.Addition: arithmetic.add,
    ex.Subtraction: arithmetic.subtract,
    ex.Multiplication: arithmetic.multiply,
}


@dataclass(frozen=True, eq=False)
class Domain:
    """Finite set of values, coded 0 … size-1, with the levels of its bits, most significant first.

    `rank` is its place in the model's text.
    """

    element: Element
    rank: int
    size: int
    levels: tuple[int, ...]
    halfway_levels: tuple[int, ...]
    next_levels: tuple[int, ...]


class BitLayout:
    """Static order of a model's domains: the levels of each element.

    `wide` maps each wide integer of the state to the integers that its bits are interleaved with, itself included.
    """

    def __init__(self, model: sct.SupervisoryControlModel, order: Order = "automatic") -> None:
        """Choose the levels in an order (see `robosc.synthesis.Tuning`).

        Raises ValueError if the order names an element that the model does not have.
        """
        elements = [element for plant in model.plants for element in _elements(plant)]
        index = {element: vertex for vertex, element in enumerate(elements)}
        vertices = _order(model, index, order)
        self.model = model
        self.plants = list(model.plants)
        self.domains: dict[Element, Domain] = {}
        self.levels = 0
        wide = [element for element in elements if domain_size(element) >= _WIDE]
        together = _groups_of_wide(model) if wide else {}
        self.wide: dict[Element, list[Element]] = {
            element: [other for other in together.get(element, [element]) if not isinstance(other, sct.Input)]
            for element in wide
            if not isinstance(element, sct.Input)
        }
        for vertex in vertices:
            if elements[vertex] not in self.domains:
                self._add([(element, index[element]) for element in together.get(elements[vertex], [elements[vertex]])])
        #: Domains of the state, from the top.
        self.state = [domain for domain in self.domains.values() if not isinstance(domain.element, sct.Input)]

    def _add(self, elements: Sequence[tuple[Element, int]]) -> None:
        """Add domains with interleaved bits: bits of the same weight are neighbors."""
        bits = {element: (domain_size(element) - 1).bit_length() for element, _ in elements}
        levels: dict[Element, list[int]] = {element: [] for element, _ in elements}
        for weight in reversed(range(max(bits.values()))):
            for element, _ in elements:
                if weight < bits[element]:
                    levels[element].append(self.levels)
                    self.levels += self._copies(element)
        for element, rank in elements:
            halfway, following = (
                tuple(level + copy for level in levels[element]) for copy in (1, self._copies(element) - 1)
            )
            self.domains[element] = Domain(
                element, rank, domain_size(element), tuple(levels[element]), halfway, following
            )

    def _copies(self, element: Element) -> int:
        if isinstance(element, sct.Input):
            return 1
        return 3 if self.wide else 2


def foreign(expression: ex.Expression) -> ModelError:
    """Return the error for an expression that no SCT model contains."""
    message = f"a {type(expression).__name__} is not allowed in an sct model"
    return ModelError([Diagnostic(*place(expression), Severity.ERROR, "type", message)])


def domain_size(element: Element) -> int:
    """Return the number of values of an element."""
    return domains.domain(element if isinstance(element, sct.Plant) else element.type).size


def smallest(element: Element) -> int:
    """Return the integer of code 0; 0 for an element without integers."""
    return domains.domain(element if isinstance(element, sct.Plant) else element.type).low


def referenced_elements(expression: ex.Expression | None) -> Iterator[Element]:
    """Yield the elements whose values the expression reads, once per reference."""
    for _, node in tree(expression) if expression is not None else ():
        match node:
            case sct.LocationReference():
                yield node.location.eContainer()
            case sct.VariableReference():
                yield node.variable
            case sct.InputReference():
                yield node.input


class Encoding:
    """Decision diagrams of a model's elements and expressions."""

    def __init__(self, layout: BitLayout, diagrams: Diagrams) -> None:
        self.layout = layout
        self.diagrams = diagrams
        self._model = layout.model
        self._codes: dict[tuple[Element, int], Diagram] = {}
        #: Indices of locations and literals among their siblings.
        self._places: dict[ex.NamedElement, int] = {}
        self._between: dict[tuple[Element, int, int], Diagram] = {}
        self._vectors: dict[ex.Expression, Vector] = {}
        self._reads: dict[Element, Vector] = {}
        self._unchanged: dict[Element, Diagram] = {}
        self._next: dict[sct.Location, Diagram] = {}

    def bits(self, element: Element) -> tuple[Diagram, ...]:
        """Return the bits of an element's code, least significant first."""
        return tuple(self.diagrams.variable(level) for level in reversed(self.layout.domains[element].levels))

    def next_bits(self, element: Element) -> tuple[Diagram, ...]:
        """Return the bits of an element's next code, least significant first."""
        return tuple(self.diagrams.variable(level) for level in reversed(self.layout.domains[element].next_levels))

    def has_code(self, element: Element, code: int) -> Diagram:
        """Return the states in which the element has the value with that code."""
        known = self._codes.get((element, code))
        if known is None:
            known = self._codes[element, code] = self._same(
                self.bits(element), arithmetic.constant(self.diagrams, code)
            )
        return known

    def in_domain(self, element: Element) -> Diagram:
        """Return the assignments in which the element's bits form a valid code."""
        size = self.layout.domains[element].size
        code = (*self.bits(element), self.diagrams.false)
        return arithmetic.less(code, arithmetic.constant(self.diagrams, size))

    def whole(self, elements: Iterable[Element]) -> Diagram:
        """Return the assignments in which the bits of all these elements form valid codes."""
        return self.diagrams.all_of(map(self.in_domain, dict.fromkeys(elements)))

    def between(self, element: Element, first: int, last: int) -> Diagram:
        """Return the states in which the element's code is one of first … last."""
        known = self._between.get((element, first, last))
        if known is None:
            code = (*self.bits(element), self.diagrams.false)
            known = ~arithmetic.less(code, arithmetic.constant(self.diagrams, first))
            known &= ~arithmetic.less(arithmetic.constant(self.diagrams, last), code)
            self._between[element, first, last] = known
        return known

    def becomes(self, element: Element, code: Vector) -> Diagram:
        """Return the condition that the element's next code equals `code`."""
        return self._same(self.next_bits(element), code)

    def equal(self, first: sct.DiscreteVariable | sct.Input, second: sct.DiscreteVariable | sct.Input) -> Diagram:
        """Return the condition that two elements of one type have the same value."""
        return self._same(self.bits(first), self.bits(second))

    def keeps(self, element: Element) -> Diagram:
        """Return the condition that the element keeps its value."""
        if element not in self._unchanged:
            self._unchanged[element] = self.becomes(element, self.bits(element))
        return self._unchanged[element]

    def _same(self, bits: Sequence[Diagram], code: Vector) -> Diagram:
        result = self.diagrams.true
        padded = (*code, *(code[-1] for _ in bits))
        for bit, other_bit in zip(bits, padded, strict=False):
            result = bit.equiv(other_bit) & result
        return result

    def location(self, location: sct.Location) -> Diagram:
        """Return the states in which the location's plant is in this location."""
        return self.has_code(location.eContainer(), self.location_code(location))

    def source(self, edge: sct.Edge) -> Diagram:
        """Return the states in which the edge's plant is in a location that the edge leaves."""
        around = edge.eContainer()
        return self.in_domain(around) if isinstance(around, sct.Plant) else self.location(around)

    def next_location(self, location: sct.Location) -> Diagram:
        """Return the condition that the location's plant is in this location next."""
        if location not in self._next:
            code = arithmetic.constant(self.diagrams, self.location_code(location))
            self._next[location] = self.becomes(location.eContainer(), code)
        return self._next[location]

    def marked(self, plant: sct.Plant) -> Diagram:
        """Return the states in which the plant is in a marked location."""
        marked = (code for code, location in enumerate(plant.locations) if location.marked)
        return self.diagrams.any_of(self.has_code(plant, code) for code in marked)

    def state(self, codes: Mapping[Element, int]) -> Diagram:
        """Return the single state in which every element has the given code."""
        elements = [domain.element for domain in reversed(self.layout.state)]
        return self.diagrams.all_of(self.has_code(element, codes[element]) for element in elements)

    def count(self, states: Diagram) -> int:
        """Return the number of states of a set."""
        return states.sat_count(sum(len(domain.levels) for domain in self.layout.state))

    def count_plants(self, states: Diagram) -> int:
        """Return the number of states of a set, ignoring the locations of requirement automata."""
        watching = {plant for plant in self.layout.plants if plant.kind == sct.PlantKind.requirement}
        others = [domain for domain in self.layout.state if _plant(domain.element) in watching]
        states = states.exists(self.diagrams.cube(level for domain in others for level in domain.levels))
        counted = sum(len(domain.levels) for domain in self.layout.state if domain not in others)
        return states.sat_count(counted) if others else self.count(states)

    @cached_property
    def initial(self) -> Diagram:
        """Initial states."""
        elements = [domain.element for domain in reversed(self.layout.state)]
        return self._narrowed(self.diagrams.all_of(map(self._starts, elements)), self._model.initialPredicates)

    @cached_property
    def all_marked(self) -> Diagram:
        """States in which every plant is in a marked location and all marker predicates hold."""
        # From the bottom: each conjunction rebuilds the diagram above it.
        plants = sorted(self.layout.plants, key=lambda plant: self.layout.domains[plant].levels, reverse=True)
        return self._narrowed(self.diagrams.all_of(map(self.marked, plants)), self._model.markerPredicates)

    @cached_property
    def initial_codes(self) -> dict[Element, int]:
        """Codes of all elements in one initial state, always the same one."""
        return pick(self.initial, self.layout.state)

    def _starts(self, element: Element) -> Diagram:
        """Return the states in which an element has one of its initial values."""
        if isinstance(element, sct.Plant):
            initial = (code for code, location in enumerate(element.locations) if location.initial)
            return self.diagrams.any_of(self.has_code(element, code) for code in initial)
        assert isinstance(element, sct.DiscreteVariable)
        if element.initial is None:
            return self.in_domain(element)
        return self._same(self.bits(element), self.code(element.initial, element))

    def _narrowed(self, states: Diagram, conditions: Iterable[ex.Expression]) -> Diagram:
        """Return those of `states` in which all conditions hold."""
        for condition in conditions:
            states &= self.holds(condition)
        return states

    def code(self, value: ex.Expression, element: sct.DiscreteVariable) -> Vector:
        """Return the code of the variable after the assignment of `value`; an integer saturates at its range."""
        vector = self.vector(value)
        if not isinstance(element.type, ex.IntegerType):
            return vector
        last = arithmetic.constant(self.diagrams, domain_size(element) - 1)
        none = arithmetic.constant(self.diagrams, 0)
        code = arithmetic.subtract(vector, arithmetic.constant(self.diagrams, smallest(element)))
        code = arithmetic.choose(arithmetic.less(code, none), none, code)
        return arithmetic.choose(arithmetic.less(last, code), last, code)

    def holds(self, expression: ex.Expression | None) -> Diagram:
        """Return the states in which a boolean expression is true; all states for None."""
        return self.diagrams.true if expression is None else self.vector(expression)[0]

    def permits(self, requirement: sct.Requirement) -> Diagram:
        """Return the states in which a requirement allows its event."""
        holds = self.holds(requirement.condition)
        return ~holds if requirement.kind == sct.RequirementKind.disables else holds

    def vector(self, expression: ex.Expression) -> Vector:
        """Return the value of an expression: the integer itself, a code, or 0 or 1 for a boolean.

        The value is cached, except for sums and products. A caller that requests all parts of an expression therefore
        visits each operator once.
        """
        return fold(self._combined, expression, lambda part: () if part in self._vectors else operands(part))

    def _combined(self, expression: ex.Expression, parts: Sequence[Vector]) -> Vector:
        """Return the value of an expression, computed from those of its operands."""
        known = self._vectors.get(expression)
        if known is not None:
            return known
        kind = type(expression)
        if kind in _ARITHMETIC:
            return _ARITHMETIC[kind](*parts)
        if isinstance(expression, ex.FunctionCall):
            return self._called(expression.function, *parts)
        if isinstance(expression, sct.Quotient):
            return self._divided(*parts)[0]
        if kind in _LOGICAL:
            vector: Vector = (_LOGICAL[kind](*(part[0] for part in parts)), self.diagrams.false)
        elif kind in _COMPARISON:
            vector = (_COMPARISON[kind](*parts), self.diagrams.false)
        elif isinstance(expression, ex.Conditional):
            condition, then, otherwise = parts
            vector = arithmetic.choose(condition[0], then, otherwise)
        else:
            vector = self._atom(expression)
        self._vectors[expression] = vector
        return vector

    def _called(self, function: str, value: Vector, *others: Vector) -> Vector:
        """Return the value of a function call."""
        match function:
            case "mod":
                return self._divided(value, *others)[1]
            case "abs":
                other = arithmetic.negate(value)
                return arithmetic.choose(arithmetic.less(value, other), other, value)
            case "min":
                [other] = others
                return arithmetic.choose(arithmetic.less(value, other), value, other)
            case "max":
                [other] = others
                return arithmetic.choose(arithmetic.less(other, value), value, other)
        raise ValueError(f"no relation for `{function}`")

    def _divided(self, value: Vector, divisor: Vector) -> tuple[Vector, Vector]:
        """Divide a value by a positive constant; return the quotient and the remainder.

        The quotient is right only for a non-negative value, the remainder for any value. From the sign down, each step
        doubles the remainder and adds a bit.
        """
        number = arithmetic.value_of(divisor)
        assert number is not None
        none = arithmetic.constant(self.diagrams, 0)
        *bits, sign = value
        left = arithmetic.choose(sign, arithmetic.constant(self.diagrams, number - 1), none)
        quotient: list[Diagram] = [self.diagrams.false]
        for bit in reversed(bits):
            doubled = (bit, *left)
            fits = ~arithmetic.less(doubled, divisor)
            left = arithmetic.choose(fits, arithmetic.subtract(doubled, divisor), doubled)
            quotient.insert(0, fits)
        return tuple(quotient), left

    def _atom(self, expression: ex.Expression) -> Vector:
        match expression:
            case ex.BooleanLiteral():
                return arithmetic.constant(self.diagrams, int(expression.value))
            case ex.IntegerLiteral():
                return arithmetic.constant(self.diagrams, expression.value)
            case ex.EnumerationLiteralReference():
                return arithmetic.constant(self.diagrams, self._code_of(expression.literal))
            case sct.LocationReference():
                return (self.location(expression.location), self.diagrams.false)
            case sct.VariableReference():
                return self._read(expression.variable)
            case sct.InputReference():
                return self._read(expression.input)
        raise foreign(expression)

    def _read(self, element: sct.DiscreteVariable | sct.Input) -> Vector:
        if element not in self._reads:
            code = (*self.bits(element), self.diagrams.false)
            self._reads[element] = arithmetic.add(code, arithmetic.constant(self.diagrams, smallest(element)))
        return self._reads[element]

    def location_code(self, location: sct.Location) -> int:
        """Return the code of a location among those of its plant."""
        return self._place(location, location.eContainer().locations)

    def _code_of(self, literal: ex.EnumerationLiteral) -> int:
        return self._place(literal, literal.eContainer().literals)

    def _place(self, element: ex.NamedElement, siblings: Iterable[ex.NamedElement]) -> int:
        if element not in self._places:
            self._places.update({sibling: place for place, sibling in enumerate(siblings)})
        return self._places[element]


def pick(diagram: Diagram, domains: Iterable[Domain]) -> dict[Element, int]:
    """Return the codes of one satisfying assignment, always the same: small codes first, from the top."""
    true = set()
    while (cofactors := diagram.cofactors()) is not None:
        high, low = cofactors
        if not low.satisfiable():
            true.add(diagram.node_level())
        diagram = low if low.satisfiable() else high
    return {
        domain.element: sum(1 << place for place, level in enumerate(reversed(domain.levels)) if level in true)
        for domain in domains
    }


def _plant(element: Element) -> sct.Plant:
    plant: sct.Plant = element if isinstance(element, sct.Plant) else element.eContainer()
    return plant


def _elements(plant: sct.Plant) -> Iterator[Element]:
    yield plant
    yield from plant.variables
    yield from plant.inputs


def element_name(element: Element) -> str:
    """Return the name of an element in a file of `--order`: that of its plant, a dot and its own if it has one.

    The new value of an input variable of CIF has the name of the variable with a `+`, as in CIF's own output.
    """
    if isinstance(element, sct.Plant):
        return element.name
    plant = element.eContainer()
    is_new = isinstance(element, sct.Input) and element.name in {variable.name for variable in plant.variables}
    return f"{plant.name}.{element.name}{'+' if is_new else ''}"


def element_names(model: sct.SupervisoryControlModel) -> list[str]:
    """Return the names of all elements, in the order of the text."""
    return [element_name(element) for plant in model.plants for element in _elements(plant)]


def _order(model: sct.SupervisoryControlModel, index: Mapping[Element, int], order: Order) -> list[int]:
    """Return the indices of the elements in an order."""
    if order == "text":
        return list(index.values())
    chosen = [] if isinstance(order, str) else _named(index, order)
    couplings = [[index[element] for element in coupling] for coupling in couplings_of(model, index)]
    return list(dict.fromkeys([*chosen, *variable_order(len(index), couplings)]))


def _named(index: Mapping[Element, int], names: Sequence[str]) -> list[int]:
    by_name = {element_name(element): vertex for element, vertex in index.items()}
    for name in names:
        if name not in by_name:
            raise ValueError(f"the model has no element `{name}`")
    return [by_name[name] for name in names]


def couplings_of(model: sct.SupervisoryControlModel, index: Mapping[Element, int]) -> Iterable[list[Element]]:
    """Return the sets of elements that occur together.

    There is one set for each event, with all that its edges and requirements touch, and one for each predicate.
    """
    touched: dict[sct.Event, dict[Element, None]] = {}
    for plant in model.plants:
        for edge in edges_of(plant):
            own = touched.setdefault(edge.event, {})
            own[plant] = None
            own.update(dict.fromkeys(referenced_elements(edge.guard)))
            for update in edge.updates:
                own[update.variable] = None
                own.update(dict.fromkeys(referenced_elements(update.value)))
    for requirement in model.requirements:
        touched.setdefault(requirement.event, {}).update(dict.fromkeys(referenced_elements(requirement.condition)))
    conditions = [invariant.condition for invariant in model.invariants]
    for required in model.reachabilityRequirements:
        parts = (required.condition, required.premise, required.pathCondition)
        conditions += [part for part in parts if part is not None]
    conditions += [*model.initialPredicates, *model.markerPredicates]
    together = [*touched.values(), *(dict.fromkeys(referenced_elements(condition)) for condition in conditions)]
    return [sorted(elements, key=index.__getitem__) for elements in together]


def _groups_of_wide(model: sct.SupervisoryControlModel) -> dict[Element, list[Element]]:
    """Return, for each wide integer, those that it is compared or computed with, directly or indirectly."""
    groups: dict[Element, list[Element]] = {}
    for together in _computations(model):
        wide = dict.fromkeys(element for element in together if domain_size(element) >= _WIDE)
        merged = list(dict.fromkeys(member for element in wide for member in groups.get(element, [element])))
        groups |= dict.fromkeys(merged, merged)
    return groups


def _computations(model: sct.SupervisoryControlModel) -> Iterator[list[Element]]:
    """Yield the elements of each comparison, of each assignment, and those that each edge counts."""
    inner: set[object] = set()
    for _, node in tree(model):
        if isinstance(node, sct.Update):
            yield [node.variable, *referenced_elements(node.value)]
        elif isinstance(node, sct.Edge):
            yield [update.variable for update in node.updates if update.variable in referenced_elements(update.value)]
        elif type(node) in _COMPARISON and node not in inner:
            # The outer comparison reads all that the inner ones read, so these are skipped.
            inner.update(operand for _, operand in tree(node) if type(operand) in _COMPARISON)
            yield list(referenced_elements(node))
