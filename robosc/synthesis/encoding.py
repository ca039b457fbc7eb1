"""Locations, variables, inputs and expressions of an SCT model as decision diagrams.

Everything that has a state is a finite domain: the location of a plant, a discrete variable, an input. A value's code
is its index in the domain, in binary, the most significant bit on top. Each bit of the state has a copy for the next
state right below it, and with wide integers in the model one in between, for a state halfway. Wide integers that are
computed from each other or compared, or are counted by the same event, take turns bit by bit: apart, the diagram of
`x = y` has a node for every value.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, TypeAlias

from robosc.diagnostics import Diagnostic, ModelError, Severity
from robosc.metamodel import expression as ex
from robosc.metamodel import sct
from robosc.metamodel.places import place
from robosc.metamodel.reflection import tree
from robosc.semantics import domains
from robosc.semantics.edges import edges_of
from robosc.semantics.walks import fold, operands
from robosc.synthesis import arithmetic
from robosc.synthesis.order import variable_order

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from robosc.synthesis.arithmetic import Vector
    from robosc.synthesis.bdd import Diagram, Diagrams

#: What a domain is of. A plant stands for its location.
Element: TypeAlias = "sct.Plant | sct.DiscreteVariable | sct.Input"
#: The number of values from which on an integer is wide.
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
    """A finite set of values, coded 0 … size-1, and the levels of its bits, most significant first.

    `rank` is its place in the model's text.
    """

    element: Element
    rank: int
    size: int
    levels: tuple[int, ...]
    halfway_levels: tuple[int, ...]
    next_levels: tuple[int, ...]


class Layout:
    """Which element takes which levels: the static order of a model's domains.

    `wide` are the wide integers of the state, each with those that its bits take turns with, itself included.
    """

    def __init__(self, model: sct.SupervisoryControlModel) -> None:
        elements = [element for plant in model.plants for element in _elements(plant)]
        index = {element: vertex for vertex, element in enumerate(elements)}
        order = variable_order(
            len(elements), [[index[element] for element in edge] for edge in _couplings(model, index)]
        )
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
        for vertex in order:
            if elements[vertex] not in self.domains:
                self._add([(element, index[element]) for element in together.get(elements[vertex], [elements[vertex]])])
        #: The domains that make up the state, from the top.
        self.state = [domain for domain in self.domains.values() if not isinstance(domain.element, sct.Input)]

    def _add(self, elements: Sequence[tuple[Element, int]]) -> None:
        """Domains whose bits take turns, those of the same weight side by side."""
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
    """What is raised at an expression that no sct model holds."""
    message = f"a {type(expression).__name__} has no place in an sct model"
    return ModelError([Diagnostic(*place(expression), Severity.ERROR, "type", message)])


def domain_size(element: Element) -> int:
    """The number of an element's values."""
    return domains.domain(element if isinstance(element, sct.Plant) else element.type).size


def smallest(element: Element) -> int:
    """The integer that code 0 stands for; 0 for what has no integers."""
    return domains.domain(element if isinstance(element, sct.Plant) else element.type).low


def referenced(expression: ex.Expression | None) -> Iterator[Element]:
    """The elements whose values the expression reads, once per reference."""
    for _, node in tree(expression) if expression is not None else ():
        match node:
            case sct.LocationReference():
                yield node.location.eContainer()
            case sct.VariableReference():
                yield node.variable
            case sct.InputReference():
                yield node.input


class Encoding:
    """The decision diagrams of a model's elements and expressions."""

    def __init__(self, layout: Layout, diagrams: Diagrams) -> None:
        self.layout = layout
        self.diagrams = diagrams
        self._model = layout.model
        self._codes: dict[tuple[Element, int], Diagram] = {}
        #: Of locations and literals, among those beside them.
        self._places: dict[ex.NamedElement, int] = {}
        self._between: dict[tuple[Element, int, int], Diagram] = {}
        self._vectors: dict[ex.Expression, Vector] = {}
        self._reads: dict[Element, Vector] = {}
        self._kept: dict[Element, Diagram] = {}
        self._next: dict[sct.Location, Diagram] = {}

    def bits(self, element: Element) -> tuple[Diagram, ...]:
        """The bits of an element's code, least significant first."""
        return tuple(self.diagrams.variable(level) for level in reversed(self.layout.domains[element].levels))

    def next_bits(self, element: Element) -> tuple[Diagram, ...]:
        """The same of the next state."""
        return tuple(self.diagrams.variable(level) for level in reversed(self.layout.domains[element].next_levels))

    def has_code(self, element: Element, code: int) -> Diagram:
        """Where the element has the value with that code."""
        known = self._codes.get((element, code))
        if known is None:
            known = self._codes[element, code] = self._same(
                self.bits(element), arithmetic.constant(self.diagrams, code)
            )
        return known

    def in_domain(self, element: Element) -> Diagram:
        """Where the element's bits are a code at all."""
        size = self.layout.domains[element].size
        code = (*self.bits(element), self.diagrams.false)
        return arithmetic.less(code, arithmetic.constant(self.diagrams, size))

    def whole(self, elements: Iterable[Element]) -> Diagram:
        """Where the bits of all these elements are codes."""
        return self.diagrams.all_of(map(self.in_domain, dict.fromkeys(elements)))

    def between(self, element: Element, first: int, last: int) -> Diagram:
        """Where the element's code is one of first … last."""
        known = self._between.get((element, first, last))
        if known is None:
            code = (*self.bits(element), self.diagrams.false)
            known = ~arithmetic.less(code, arithmetic.constant(self.diagrams, first))
            known &= ~arithmetic.less(arithmetic.constant(self.diagrams, last), code)
            self._between[element, first, last] = known
        return known

    def becomes(self, element: Element, code: Vector) -> Diagram:
        """Where the element's next code is the given one."""
        return self._same(self.next_bits(element), code)

    def keeps(self, element: Element) -> Diagram:
        """Where the element's next value is its present one."""
        if element not in self._kept:
            self._kept[element] = self.becomes(element, self.bits(element))
        return self._kept[element]

    def _same(self, bits: Sequence[Diagram], code: Vector) -> Diagram:
        result = self.diagrams.true
        padded = (*code, *(code[-1] for _ in bits))
        for bit, wanted in zip(bits, padded, strict=False):
            result = bit.equiv(wanted) & result
        return result

    def location(self, location: sct.Location) -> Diagram:
        """Where the location's plant is in it."""
        return self.has_code(location.eContainer(), self.location_code(location))

    def source(self, edge: sct.Edge) -> Diagram:
        """Where the edge's plant is in a location that the edge leaves."""
        around = edge.eContainer()
        return self.in_domain(around) if isinstance(around, sct.Plant) else self.location(around)

    def next_location(self, location: sct.Location) -> Diagram:
        """Where the location's plant will be in it."""
        if location not in self._next:
            code = arithmetic.constant(self.diagrams, self.location_code(location))
            self._next[location] = self.becomes(location.eContainer(), code)
        return self._next[location]

    def marked(self, plant: sct.Plant) -> Diagram:
        """Where the plant is in a marked location."""
        marked = (code for code, location in enumerate(plant.locations) if location.marked)
        return self.diagrams.any_of(self.has_code(plant, code) for code in marked)

    def state(self, codes: Mapping[Element, int]) -> Diagram:
        """The one state in which every element has the given code."""
        elements = [domain.element for domain in reversed(self.layout.state)]
        return self.diagrams.all_of(self.has_code(element, codes[element]) for element in elements)

    def count(self, states: Diagram) -> int:
        """How many states there are in a set of them."""
        return states.sat_count(sum(len(domain.levels) for domain in self.layout.state))

    def count_plants(self, states: Diagram) -> int:
        """How many states of the plants there are in a set, wherever requirement automata are."""
        watching = {plant for plant in self.layout.plants if plant.kind == sct.PlantKind.requirement}
        others = [domain for domain in self.layout.state if _plant(domain.element) in watching]
        states = states.exists(self.diagrams.cube(level for domain in others for level in domain.levels))
        counted = sum(len(domain.levels) for domain in self.layout.state if domain not in others)
        return states.sat_count(counted) if others else self.count(states)

    @cached_property
    def initial(self) -> Diagram:
        """The initial states."""
        elements = [domain.element for domain in reversed(self.layout.state)]
        return self._narrowed(self.diagrams.all_of(map(self._starts, elements)), self._model.initialPredicates)

    @cached_property
    def all_marked(self) -> Diagram:
        """The states in which every plant is in a marked location, and all marker predicates hold."""
        # From the bottom: each conjunction makes the diagram above it anew.
        plants = sorted(self.layout.plants, key=lambda plant: self.layout.domains[plant].levels, reverse=True)
        return self._narrowed(self.diagrams.all_of(map(self.marked, plants)), self._model.markerPredicates)

    @cached_property
    def initial_codes(self) -> dict[Element, int]:
        """The code of every element of the state in an initial state, always the same one."""
        return pick(self.initial, self.layout.state)

    def _starts(self, element: Element) -> Diagram:
        """Where an element has a value with which it may start."""
        if isinstance(element, sct.Plant):
            initial = (code for code, location in enumerate(element.locations) if location.initial)
            return self.diagrams.any_of(self.has_code(element, code) for code in initial)
        assert isinstance(element, sct.DiscreteVariable)
        if element.initial is None:
            return self.in_domain(element)
        return self._same(self.bits(element), self.code(element.initial, element))

    def _narrowed(self, states: Diagram, conditions: Iterable[ex.Expression]) -> Diagram:
        """Those of some states in which conditions hold."""
        for condition in conditions:
            states &= self.holds(condition)
        return states

    def code(self, value: ex.Expression, element: sct.DiscreteVariable) -> Vector:
        """The code that the variable has after it was given the value: an integer saturates at its range."""
        vector = self.vector(value)
        if not isinstance(element.type, ex.IntegerType):
            return vector
        last = arithmetic.constant(self.diagrams, domain_size(element) - 1)
        none = arithmetic.constant(self.diagrams, 0)
        code = arithmetic.subtract(vector, arithmetic.constant(self.diagrams, smallest(element)))
        code = arithmetic.choose(arithmetic.less(code, none), none, code)
        return arithmetic.choose(arithmetic.less(last, code), last, code)

    def holds(self, expression: ex.Expression | None) -> Diagram:
        """Where a boolean expression is true; an absent one is true everywhere."""
        return self.diagrams.true if expression is None else self.vector(expression)[0]

    def permits(self, requirement: sct.Requirement) -> Diagram:
        """Where a requirement lets its event happen."""
        holds = self.holds(requirement.condition)
        return ~holds if requirement.kind == sct.RequirementKind.disables else holds

    def vector(self, expression: ex.Expression) -> Vector:
        """The value of an expression: an integer's own, else its code; a boolean's is 0 or 1.

        Known from the first time that it is asked for, but for sums and products: who asks for all parts of an
        expression looks at each operator once.
        """
        return fold(self._combined, expression, lambda part: () if part in self._vectors else operands(part))

    def _combined(self, expression: ex.Expression, parts: Sequence[Vector]) -> Vector:
        """The value of an expression from those of its operands."""
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
        """A function of its arguments."""
        match function:
            case "mod":
                return self._divided(value, *others)[1]
            case "abs":
                other = arithmetic.negate(value)
                return arithmetic.choose(arithmetic.less(value, other), other, value)
        [other] = others
        least, most = (value, other) if function == "min" else (other, value)
        return arithmetic.choose(arithmetic.less(least, most), value, other)

    def _divided(self, value: Vector, divisor: Vector) -> tuple[Vector, Vector]:
        """How often a constant goes into what is not negative, and the remainder of whatever sign.

        From the sign down, each bit doubles what is left of those above it.
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
        """The code of a location among those of its plant."""
        return self._place(location, location.eContainer().locations)

    def _code_of(self, literal: ex.EnumerationLiteral) -> int:
        return self._place(literal, literal.eContainer().literals)

    def _place(self, element: ex.NamedElement, siblings: Iterable[ex.NamedElement]) -> int:
        if element not in self._places:
            self._places.update({sibling: place for place, sibling in enumerate(siblings)})
        return self._places[element]


def pick(diagram: Diagram, domains: Iterable[Domain]) -> dict[Element, int]:
    """The codes in one of the diagram's satisfying assignments, always the same: small codes first, from the top."""
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
    found: sct.Plant = element if isinstance(element, sct.Plant) else element.eContainer()
    return found


def _elements(plant: sct.Plant) -> Iterator[Element]:
    yield plant
    yield from plant.variables
    yield from plant.inputs


def _couplings(model: sct.SupervisoryControlModel, index: Mapping[Element, int]) -> Iterable[list[Element]]:
    """Which elements meet: for each event, all that its edges and requirements touch; what each predicate reads."""
    touched: dict[sct.Event, dict[Element, None]] = {}
    for plant in model.plants:
        for edge in edges_of(plant):
            own = touched.setdefault(edge.event, {})
            own[plant] = None
            own.update(dict.fromkeys(referenced(edge.guard)))
            for update in edge.updates:
                own[update.variable] = None
                own.update(dict.fromkeys(referenced(update.value)))
    for requirement in model.requirements:
        touched.setdefault(requirement.event, {}).update(dict.fromkeys(referenced(requirement.condition)))
    conditions = [invariant.condition for invariant in model.invariants]
    conditions += [*model.initialPredicates, *model.markerPredicates]
    together = [*touched.values(), *(dict.fromkeys(referenced(condition)) for condition in conditions)]
    return [sorted(elements, key=index.__getitem__) for elements in together]


def _groups_of_wide(model: sct.SupervisoryControlModel) -> dict[Element, list[Element]]:
    """The wide integers that are compared or computed together, directly or through others, for each of them."""
    groups: dict[Element, list[Element]] = {}
    for together in _computations(model):
        wide = dict.fromkeys(element for element in together if domain_size(element) >= _WIDE)
        merged = list(dict.fromkeys(member for element in wide for member in groups.get(element, [element])))
        groups |= dict.fromkeys(merged, merged)
    return groups


def _computations(model: sct.SupervisoryControlModel) -> Iterator[list[Element]]:
    """What each comparison reads, what each assignment reads and writes, and what each edge counts."""
    inner: set[object] = set()
    for _, node in tree(model):
        if isinstance(node, sct.Update):
            yield [node.variable, *referenced(node.value)]
        elif isinstance(node, sct.Edge):
            yield [update.variable for update in node.updates if update.variable in referenced(update.value)]
        elif type(node) in _COMPARISON and node not in inner:
            # It reads what the comparisons in it read: they need no look of their own.
            inner.update(operand for _, operand in tree(node) if type(operand) in _COMPARISON)
            yield list(referenced(node))
