"""Compare a model read back from CIF with the one it was generated from."""

from collections.abc import Callable, Iterator
from itertools import product, zip_longest
from typing import Any

from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.reflection import contents, tree
from robosc.model.semantics.edges import edges_from, edges_of
from robosc.model.semantics.evaluation import Program, saturate
from robosc.model.semantics.printing import conjunction
from robosc.model.semantics.walks import copy_tree

#: The number of valuations for comparing two expressions.
_MOST = 400


def differences(
    mine: sct.SupervisoryControlModel, yours: sct.SupervisoryControlModel, *, exact: bool = False
) -> list[str]:
    """Return the differences between two models in the elements that CIF has.

    Expressions are equal if they have the same value in all states; updates are compared after saturation. With many
    states, the comparison takes a sample that includes the first and last. With `exact`, expressions are equal if they
    are the same tree.
    """
    return list(_Comparison(mine, yours, exact).run())


class _Comparison:
    def __init__(self, mine: Any, yours: Any, exact: bool) -> None:
        self.mine, self.yours, self.exact = mine, yours, exact
        events = {_name(event) for plant in yours.plants for event in plant.events}
        #: Events that can never happen: CIF may omit them.
        self.absent = {
            event
            for plant in mine.plants
            for event in plant.events
            if _name(event) not in events and _never(event, mine.plants)
        }

    def run(self) -> Iterator[str]:
        yield from self.names("the model", [self.mine], [self.yours])
        yield from self.names("enumerations", self.mine.enumerations, self.yours.enumerations)
        for mine, yours in zip(self.mine.enumerations, self.yours.enumerations, strict=False):
            yield from self.names(f"literals of {mine.name}", mine.literals, yours.literals)
        yield from self.names("plants", self.mine.plants, self.yours.plants)
        for mine, yours in zip(self.mine.plants, self.yours.plants, strict=False):
            yield from self.plant(mine, yours)
        supervised = self.yours.supervisor is not None
        if not supervised:
            yield from self.requirements()
        if supervised:
            guards = [guard for guard in self.mine.supervisor.guards if guard.event not in self.absent]
            for mine, yours in zip_longest(guards, self.yours.supervisor.guards):
                if _name(mine.event) != _name(yours.event):
                    yield f"guard of {_name(mine.event)} is of {_name(yours.event)}"
                yield from self.expression("requirement part", mine.requirement, yours.requirement)
                yield from self.expression("synthesis part", mine.synthesis, yours.synthesis)

    def requirements(self) -> Iterator[str]:
        """Compare requirements; two equal ones on one event may be merged."""
        mine, yours = [], list(self.yours.requirements)
        for requirement in self.mine.requirements:
            again = [
                earlier
                for earlier in mine
                if (earlier.event, str(earlier.kind)) == (requirement.event, str(requirement.kind))
            ]
            if not any(_shape(earlier.condition) == _shape(requirement.condition) for earlier in again):
                mine.append(requirement)
        for requirement, other in zip_longest(mine, yours):
            if _name(requirement.event) != _name(other.event) or str(requirement.kind) != str(other.kind):
                yield f"{requirement.kind} {_name(requirement.event)} is {other.kind} {_name(other.event)}"
            yield from self.expression("requirement", requirement.condition, other.condition)

    def names(self, what: str, mine: Any, yours: Any) -> Iterator[str]:
        first, second = [own.name for own in mine], [your.name for your in yours]
        if first != second:
            yield f"{what} {first} are {second}"

    def plant(self, mine: sct.Plant, yours: sct.Plant) -> Iterator[str]:
        for members in ("events", "inputs", "variables", "locations"):
            if mine.kind == sct.PlantKind.message and members == "locations":
                continue  # the only location has no name in CIF
            there = [member for member in getattr(mine, members) if member not in self.absent]
            yield from self.names(f"{members} of {mine.name}", there, getattr(yours, members))
        events = [event for event in mine.events if event not in self.absent]
        for event, other in zip(events, yours.events, strict=False):
            if event.controllable != other.controllable:
                yield f"{_name(event)} is controllable or not"
        for variable, other in zip([*mine.inputs, *mine.variables], [*yours.inputs, *yours.variables], strict=False):
            if _domain(variable.type) != _domain(other.type):
                yield f"the type of {_name(variable)} differs"
        for variable, other in zip(mine.variables, yours.variables, strict=False):
            yield from self.expression(f"initial value of {variable.name}", variable.initial, other.initial)
        for location, other in zip(mine.locations, yours.locations, strict=False):
            yield from self.location(location, other)

    def location(self, mine: sct.Location, yours: sct.Location) -> Iterator[str]:
        if (mine.initial, mine.marked) != (yours.initial, yours.marked):
            yield f"location {_name(mine)} is marked or initial or not"
        present = [edge for edge in edges_from(mine) if edge.event not in self.absent]
        for edge, other in zip_longest(present, edges_from(yours)):
            where = f"{_name(mine)} -{_name(edge.event)}->"
            if _name(edge.event) != _name(other.event) or _index(edge.target) != _index(other.target):
                yield f"{where} is for {_name(other.event)} to {_name(other.target)}"
            yield from self.expression(f"guard of {where}", _guard(edge), other.guard)
            for update, counterpart in zip_longest(edge.updates, other.updates):
                if update.variable.name != counterpart.variable.name:
                    yield f"{where} updates {counterpart.variable.name}"
                yield from self.expression(f"update of {where}", update.value, counterpart.value, update.variable.type)

    def expression(self, what: str, mine: Any, yours: Any, target: Any = None) -> Iterator[str]:
        if mine is None or yours is None:
            if mine is not yours:
                yield f"{what} is there or not"
        elif self.exact:
            if _shape(mine) != _shape(yours):
                yield f"{what} is {_shape(yours)}, not {_shape(mine)}"
        else:
            programs = [_program(side) for side in (mine, yours)]
            for state in _states(mine, yours):
                first, second = (_fitted(program(state), target) for program in programs)
                if first != second:
                    yield f"{what} is {second}, not {first}, where {state}"
                    return


def _never(event: Any, plants: Any) -> bool:
    guards = [edge.guard for plant in plants for edge in edges_of(plant) if edge.event is event]
    return bool(guards) and not any(
        guard is None or any(map(_program(guard), _states(guard, guard))) for guard in guards
    )


def _name(element: Any) -> str:
    owner = element.eContainer()
    if isinstance(owner, sct.Plant):
        place = f"{_index(element)}" if isinstance(element, sct.Location) else element.name
        return f"{owner.name}.{place}"
    return str(element.name)


def _index(element: Any) -> int:
    position: int = element.eContainer().locations.index(element)
    return position


def _domain(kind: Any) -> list[Any]:
    match kind:
        case ex.BooleanType():
            return [False, True]
        case ex.IntegerType():
            low, high = kind.minimum, kind.maximum
            values = range(low, high + 1)
            return list(values) if len(values) < 30 else [*values[:10], values[len(values) // 2], *values[-10:]]
    return [literal.name for literal in kind.enumeration.literals]


def _cells(expression: Any) -> dict[str, list[Any]]:
    cells: dict[str, list[Any]] = {}
    for _, element in tree(expression):
        match element:
            case sct.VariableReference():
                cells[_name(element.variable)] = _domain(element.variable.type)
            case sct.InputReference():
                cells[_name(element.input)] = _domain(element.input.type)
            case sct.LocationReference():
                owner = element.location.eContainer()
                cells[owner.name] = list(range(len(owner.locations)))
    return cells


def _states(mine: Any, yours: Any) -> list[dict[str, Any]]:
    cells = _cells(mine) | _cells(yours)
    all_states = list(product(*cells.values()))
    step = max(1, len(all_states) // _MOST)
    return [dict(zip(cells, values, strict=True)) for values in [*all_states[::step], all_states[-1]]]


def _program(expression: Any) -> Program[Any]:
    """Return the expression as a program over a state."""

    def reader(reference: Any) -> Callable[[dict[str, Any]], Any]:
        match reference:
            case sct.VariableReference():
                variable = _name(reference.variable)
                return lambda state: state[variable]
            case sct.InputReference():
                given = _name(reference.input)
                return lambda state: state[given]
            case sct.LocationReference():
                plant, location = reference.location.eContainer().name, _index(reference.location)
                return lambda state: state[plant] == location
        return lambda _state: reference.literal.name

    return Program(expression, reader)


def _fitted(value: Any, target: Any) -> Any:
    if isinstance(target, ex.IntegerType):
        assert isinstance(value, int)
        return saturate(value, target.minimum, target.maximum)
    return value


def _shape(expression: Any) -> Any:
    match expression:
        case sct.VariableReference():
            return _name(expression.variable)
        case sct.InputReference():
            return _name(expression.input)
        case sct.LocationReference():
            return _name(expression.location)
        case ex.EnumerationLiteralReference():
            return expression.literal.name
        case ex.BooleanLiteral() | ex.IntegerLiteral():
            return expression.value
    children = [child for _, child in contents(expression)]
    return (type(expression).__name__, *map(_shape, children))


def _guard(edge: sct.Edge) -> ex.Expression | None:
    """Return an edge's guard after conditions that exclude impossible values of the plant's own inputs."""
    excluded: list[ex.Expression] = []
    for carried in edge.event.inputs if edge.eContainer() in edge.event.eContainer().locations else ():
        kind = carried.type
        if isinstance(kind, ex.EnumerationType) and kind.first is not None and kind.last is not None:
            literals = list(kind.enumeration.literals)
            possible = literals[literals.index(kind.first) : literals.index(kind.last) + 1]
            for literal in literals:
                if literal not in possible:
                    read = sct.InputReference(input=carried)
                    excluded.append(ex.Inequation(left=read, right=ex.EnumerationLiteralReference(literal=literal)))
    return conjunction([*excluded, *([copy_tree(edge.guard)] if edge.guard is not None else [])])
