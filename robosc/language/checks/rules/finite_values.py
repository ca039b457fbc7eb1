"""Rules `variable-type` and `integer-range` (thesis 4.5.14 and 4.5.3): the supervisor's values are finite."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.base.ros_types.wire import INTEGER_RANGES
from robosc.language.checks.definitions import (
    assigned_variable,
    communication_of,
    data_types,
    of_kind,
    sends_message,
    statements,
    transitions,
    variables,
)
from robosc.language.checks.edits import Choice, Removal, Replacement, Together, part_of
from robosc.language.checks.fleets import bounds
from robosc.language.checks.libraries import Meaning, meanings
from robosc.language.checks.rule import Finding, rule
from robosc.language.checks.supervisor_limits import Fault, function_faults, readings, supervised_faults, table_faults
from robosc.model import robosc as rsc
from robosc.model.semantics.communication import sent_type
from robosc.model.semantics.cone_of_influence import ConeOfInfluence, accesses, all_assignments
from robosc.model.semantics.expansion import CLAMP
from robosc.model.semantics.inputs import ComputedValue, Data, property_path
from robosc.model.semantics.instances import MOST
from robosc.model.semantics.printing import RoboscPrinter
from robosc.model.semantics.typing import (
    DOUBLE,
    INTEGER,
    NONE,
    STRING,
    ArrayType,
    ObjectType,
    Type,
    access_types,
    declared_type,
    infer,
)
from robosc.model.semantics.walks import branches

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from robosc.language.checks.edits import Hint
    from robosc.model import expression as ex
    from robosc.model.semantics.cone_of_influence import InputRead
    from robosc.model.semantics.instances import Instances, InstanceVariable

LEAST, LARGEST = INTEGER_RANGES["int64"]


@rule("variable-type")
def variable_type(base: rsc.Base) -> Iterator[Finding]:
    """Each variable holds one value; those that the supervisor needs have a finite type and finite data."""
    stored = _stored(base)
    for variable in variables(base):
        value_type = declared_type(variable.type)
        if value_type == NONE:
            yield Finding(
                variable,
                f"variable `{variable.name}` has no value, expected data",
                Choice(
                    "leave it out, or declare it boolean to remember that something happened",
                    (
                        Removal("leave it out", variable),
                        Replacement("declare it boolean", "boolean", variable.type),
                    ),
                ),
            )
        elif isinstance(value_type, ArrayType | ObjectType):
            starts = (
                "an array starts empty" if isinstance(value_type, ArrayType) else "each field starts as a variable does"
            )
            if variable.initial is not None:
                message = f"variable `{variable.name}` is {value_type} and takes no initial value: {starts}"
                hint = Removal(
                    f"write `variable {variable.name}: …` without `=`",
                    part_of(variable.initial).preceded_by("="),
                )
                yield Finding(variable.initial, message, hint)
            if _has_objects(value_type) and variable not in stored:
                message = f"variable `{variable.name}` is {value_type}, and no event stores anything in it"
                yield Finding(
                    variable,
                    message,
                    Removal(
                        f"write `do {variable.name} := value` at the event that carries it, or leave it out", variable
                    ),
                )
    yield from supervised_faults(base, _without_domain)
    yield from supervised_faults(base, function_faults)


def _has_objects(kind: Type) -> bool:
    return isinstance(kind, ObjectType) or (isinstance(kind, ArrayType) and _has_objects(kind.element))


def _stored(base: rsc.Base) -> set[rsc.Variable]:
    """Return the variables that store received data, directly or through other variables."""
    assigned = [
        (variable, value)
        for _, transition in transitions(base)
        # If a transition assigns a variable several times, the last assignment takes effect.
        for variable, value in {
            assigned_variable(assignment): assignment.value for assignment in transition.assignments
        }.items()
    ]
    stored: set[rsc.Variable] = set()
    more = True
    while more:
        reached = {
            variable
            for variable, value in assigned
            if variable is not None and any(access.value or access.item in stored for access in accesses(value))
        }
        more = not reached <= stored
        stored |= reached
    return stored


#: Repair for a variable of the node with too many values.
_KEPT_REPAIR = "store the relevant part in a variable, such as `do some := size(value.…) > 0`"


#: Examples of conditions on data that the supervisor does not hold, with the name of a variable for each.
_EXAMPLES: Mapping[Type, tuple[str, str]] = {DOUBLE: ("near", "< 0.5"), STRING: ("known", '= "…"')}


def _variable_repair(owned: InstanceVariable, value_type: Type, instances: Instances) -> str:
    """Return the repair for a variable that the supervisor cannot hold: another that the event sets."""
    if isinstance(value_type, ArrayType | ObjectType):
        return _KEPT_REPAIR
    values = (place.value for place in all_assignments(instances) if place.variable == owned)
    access = next((access for value in values for access in accesses(value) if access.value), None)
    if access is None:
        return _enum_repair(str(value_type))
    name, condition = _EXAMPLES[value_type]
    return f"set another variable where the data arrives, such as `do {name} := {RoboscPrinter()(access)} {condition}`"


def _without_domain(instances: Instances, result: ConeOfInfluence) -> Iterator[Fault]:
    for owned, reason in result.variables.items():
        value_type = declared_type(owned.type)
        if value_type in {DOUBLE, STRING} or isinstance(value_type, ArrayType | ObjectType):
            name = f"{owned.instance.name}.{owned.variable.name}"
            yield Fault(
                owned.variable,
                reason,
                f"variable `{name}` is {value_type}, and the supervisor needs it, expected boolean, "
                "an integer with a range or an enum: its states are finitely many",
                _variable_repair(owned, value_type, instances),
            )
    for reading in readings(result):
        access = reading.reason.access
        if reading.source is not None or not isinstance(access, rsc.Access):
            continue
        types = access_types(access, reading.value)
        is_array = any(isinstance(kind, ArrayType) for kind in types)
        if is_array or types[-1] in {DOUBLE, STRING}:
            kind = "array data" if is_array else f"a {types[-1]}"
            yield Fault(
                access,
                reading.reason,
                f"{_needed(reading)} is computed from {kind}, `{RoboscPrinter()(access)}`, and from changing"
                " values, expected data that is compared only with literals, constants and other data",
                _enum_repair(
                    types[0].definition.name if isinstance(types[0], ObjectType) and is_array else str(types[-1])
                ),
            )


def _needed(reading: InputRead) -> str:
    variable = reading.reason.variable
    return "this guard" if variable is None else f"`{variable.variable.name}`, which the supervisor needs,"


def _enum_repair(base: str) -> str:
    enum = f"datatype enum … from {base} to {{ value … -> … default -> … }}"
    return f"convert it to an enum, `{enum}`, as the type of the data"


@rule("integer-range")
def integer_range(base: rsc.Base) -> Iterator[Finding]:
    """Integers that the supervisor needs have a range, ranges are not empty, and constants are within them."""
    yield from supervised_faults(base, _without_range)
    yield from supervised_faults(base, table_faults)
    yield from bounds(base)
    for meaning in meanings(base):
        yield from _too_large(meaning)
        yield from _parameters(meaning)
        for declared in of_kind(rsc.IntegerDataType, data_types(meaning)):
            low, high = _bounds(declared, meaning)
            if low is not None and high is not None and low > high:
                yield meaning.finding(
                    declared,
                    f"the range {low}..{high} is empty, expected the lower bound first",
                    Replacement(f"write `integer({high}..{low})`", f"integer({high}..{low})", declared, is_choice=True),
                )
        for count in statements(rsc.CountRequirement, meaning):
            (most,) = meaning.values(count.bound)
            if type(most) is int and not 1 <= most <= MOST:
                message = f"`at most` counts to {most}, expected a number from 1 to {MOST:,}"
                hint = "write a larger one" if most < 1 else "write a smaller one"
                yield meaning.finding(count.bound, message, f"{hint}, or another requirement")
        for constant, kind, name in _constants(meaning):
            yield from _outside(constant, kind, name, meaning)


def _parameters(meaning: Meaning) -> Iterator[Finding]:
    """Report integer parameters without a range and values outside of a parameter's range."""
    for parameter in statements(rsc.Parameter, meaning):
        if meaning.instance is None and declared_type(parameter.type) == INTEGER and _is_unranged(parameter.type):
            yield Finding(
                parameter.type,
                f"parameter `{parameter.name}` is an integer without range, expected the values that can be set",
                Replacement(
                    "write a range, such as `integer(0..100)`", "integer(0..100)", parameter.type, is_choice=True
                ),
            )
        elif meaning.instance is None and parameter.lowest is not None and declared_type(parameter.type) != DOUBLE:
            message = f"parameter `{parameter.name}` is {declared_type(parameter.type)} and has no range"
            yield Finding(parameter.lowest, message, _unranged(parameter))
        low, value, high = meaning.values(parameter.lowest, parameter.value, parameter.highest)
        lowest, highest = parameter.lowest, parameter.highest
        if isinstance(low, float) and isinstance(high, float) and lowest is not None and highest is not None:
            if low > high:
                message = f"the range {low}..{high} is empty, expected the lower bound first"
                swapped = (
                    Replacement("", f"{high}", lowest),
                    Replacement("", f"{low}", highest),
                )
                yield meaning.finding(
                    lowest, message, Together(f"write `double({high}..{low})`", swapped, is_choice=True)
                )
            elif isinstance(value, float) and parameter.value is not None and not low <= value <= high:
                message = f"{value} is not in the range {low}..{high} of `{parameter.name}`, expected a value in it"
                nearest = low if value < low else high
                way = Replacement(f"write `{nearest}`, or widen it", f"{nearest}", parameter.value, is_choice=True)
                yield meaning.finding(parameter.value, message, way)


def _unranged(parameter: rsc.Parameter) -> Choice:
    """Return the repairs for a range of a parameter that is no double."""
    double = Replacement("declare it double", "double", parameter.type)
    bounds = part_of(parameter.lowest).preceded_by("(").to(part_of(parameter.highest).followed_by(")"))
    return Choice("leave it out, or declare it double", (Removal("leave the range out", bounds), double))


def _is_unranged(declared: rsc.DataType) -> bool:
    return isinstance(declared, rsc.IntegerDataType) and declared.minimum is None and declared.lower is None


def _too_large(meaning: Meaning) -> Iterator[Finding]:
    """Report integers that do not fit into 64 bits."""
    computed: list[ex.Expression | None] = [constant.value for constant in statements(rsc.Constant, meaning)]
    for declared in of_kind(rsc.IntegerDataType, data_types(meaning)):
        computed += [declared.lower, declared.upper]
    for expression in computed:
        (value,) = meaning.values(expression)
        if expression is not None and type(value) is int and not LEAST <= value <= LARGEST:
            shown = value if abs(value) < CLAMP else ("far larger" if value > 0 else "far smaller")
            message = f"an integer lies between {LEAST} and {LARGEST}, and this is {shown}"
            yield meaning.finding(expression, message, "write another expression")


# Missing ranges


def _without_range(_: Instances, result: ConeOfInfluence) -> Iterator[Fault]:
    for owned, reason in result.variables.items():
        if _is_unbounded(owned.type) and not _has_wrong_bounds(owned.type):
            name = f"{owned.instance.name}.{owned.variable.name}"
            yield Fault(
                owned.variable,
                reason,
                f"variable `{name}` has no range, and the supervisor needs it, expected one: its states are finitely"
                " many",
                Replacement(
                    f"write a range, such as `variable {owned.variable.name}: integer(0..100)`",
                    "integer(0..100)",
                    owned.variable.type,
                    is_choice=True,
                ),
            )
    for reading in readings(result):
        source = reading.source
        if not isinstance(source, ComputedValue) or source.type != INTEGER or source.bounds is not None:
            continue
        element: ex.Located = reading.part
        hint: Hint = "compare it with a literal, or assign it unchanged to a variable, which limits its range"
        path = property_path(reading.part) if isinstance(reading.part, rsc.Access) else None
        declared = None if path is None else Data(source.port, source.event, path).type
        if _has_wrong_bounds(declared):
            continue
        if _is_unbounded(declared):
            assert declared is not None
            field = declared.eContainer()
            element = field if isinstance(field, rsc.ObjectProperty) else declared
            hint = (
                Replacement(
                    "write a range, such as `integer(0..100)`: other values become the nearest bound",
                    "integer(0..100)",
                    declared,
                    is_choice=True,
                )
                if not isinstance(field.eContainer().eContainer(), rsc.InterfaceTypeReference)
                else f"ROS defines it: declare an object in its place, with a `{field.name}: integer(0..100)`"
            )
        yield Fault(
            element,
            reading.reason,
            f"`{source.text}` is an integer without range, and {_needed(reading)} is computed from it"
            " and others, expected a range: the supervisor's inputs have finitely many values",
            hint,
        )


def _is_unbounded(declared: rsc.DataType | None) -> bool:
    return isinstance(declared, rsc.IntegerDataType) and (declared.minimum is None or declared.maximum is None)


def _has_wrong_bounds(declared: rsc.DataType | None) -> bool:
    """Return whether the bounds of an instance's range are unknown.

    The finding is then about the expressions of the bounds.
    """
    return declared is not None and _is_unbounded(declared) and declared.eContainer() is None


def _bounds(declared: rsc.IntegerDataType, meaning: Meaning) -> tuple[int | None, int | None]:
    """Return the bounds of a range; None if they are unknown or the template's own text has them."""
    if declared.lower is None:
        return (None, None) if meaning.instance else (declared.minimum, declared.maximum)
    low, high = meaning.values(declared.lower, declared.upper)
    return (low, high) if type(low) is int and type(high) is int else (None, None)


# Constants outside of their range


def _constants(base: Meaning) -> Iterator[tuple[ex.Expression | None, rsc.DataType | None, str]]:
    """Yield every assigned expression with the type and the name of its target."""
    for variable in variables(base):
        yield variable.initial, variable.type, variable.name
    for declared in statements(rsc.Constant, base):
        yield declared.value, declared.type, declared.name
    for parameter in statements(rsc.Parameter, base):
        yield parameter.value, parameter.type, parameter.name
    for _, transition in transitions(base):
        for assignment in transition.assignments if not sends_message(transition) else ():
            assigned = assigned_variable(assignment)
            if assigned is not None:
                yield assignment.value, assigned.type, assigned.name
    for statement in statements(rsc.DataStatement, base):
        communication = communication_of(statement.communicationType)
        if communication is not None:
            yield from _provided(statement.data, sent_type(communication), communication.name)


def _provided(
    data: ex.Expression | None, declared: rsc.DataType | None, name: str
) -> Iterator[tuple[ex.Expression | None, rsc.DataType | None, str]]:
    objects = [branch for _, branch in branches(data) if isinstance(branch, rsc.ObjectValue)] if data else []
    if not objects:
        yield data, declared, name
    for field in (field for branch in objects for field in branch.properties):
        if field.property is not None:
            yield from _provided(field.value, field.property.type, field.property.name)


def _outside(
    constant: ex.Expression | None, declared: rsc.DataType | None, name: str, meaning: Meaning
) -> Iterator[Finding]:
    if constant is None or not isinstance(declared, rsc.IntegerDataType) or infer(constant) != INTEGER:
        return
    if declared.lower is not None:
        value, low, high = meaning.values(constant, declared.lower, declared.upper)
    else:
        (value,), low, high = meaning.values(constant), declared.minimum, declared.maximum
    if type(value) is int and type(low) is int and type(high) is int and not low <= value <= high and low <= high:
        yield meaning.finding(
            constant,
            f"{value} is not in the range {low}..{high} of `{name}`, expected a value in it",
            Replacement(
                f"write `{low if value < low else high}`, or widen the range of `{name}`",
                f"{low if value < low else high}",
                constant,
                is_choice=True,
            ),
        )
