"""Rules `cyclic-definition`, `argument` and `unused-template` on named expressions and templates."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from robosc.base.diagnostics import Severity
from robosc.language.checks.definitions import circles, communication_of, of_kind, statements
from robosc.language.checks.edits import Choice, Insertion, Removal, Replacement, part_of
from robosc.language.checks.expression_types import CONSTANT, ExpressionCheck, Place
from robosc.language.checks.fleets import indices
from robosc.language.checks.libraries import Meaning, instances, meanings
from robosc.language.checks.rule import Finding, on_line, rule
from robosc.language.checks.type_repairs import repair
from robosc.model import expression as ex
from robosc.model import robosc as rsc
from robosc.model.reflection import contents, tree
from robosc.model.semantics.communication import kind_text
from robosc.model.semantics.cone_of_influence import accesses, conditions
from robosc.model.semantics.durations import bounds, set_on_robot
from robosc.model.semantics.expansion import LARGEST, Expansion, constant_value, is_unreadable
from robosc.model.semantics.failures import is_failure, reasons
from robosc.model.semantics.instances import bound_arguments, definition_of
from robosc.model.semantics.naming import enumeration, escape_keyword
from robosc.model.semantics.operators import operator_of
from robosc.model.semantics.typing import INTEGER, UNKNOWN, declared_type, type_of

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Sequence

    from robosc.model.semantics.instances import Instances
    from robosc.model.semantics.operators import Operator


_ARGUMENT = replace(CONSTANT, what="an argument", instead="")
_ENUM_ARGUMENT = replace(_ARGUMENT, instead="; a parameter of the node must be the only operand")


@rule("cyclic-definition")
def cyclic_definition(base: rsc.Base) -> Iterator[Finding]:
    """No constant, condition or function refers to itself or becomes too large after expansion."""
    named = list(statements(rsc.NamedExpression, base))
    uses = {definition: _used(definition) for definition in named}
    known = {
        definition: [(definition, used) for used in used_definitions if used in uses]
        for definition, used_definitions in uses.items()
    }
    for definition, circle in circles(named, known.__getitem__):
        names = [step.name for step in (*circle, circle[0])]
        yield Finding(
            definition,
            f"`{names[0]}` is defined in terms of itself: {' -> '.join(names)}",
            "leave one of these uses out, or write a value in its place",
        )
    yield from _too_large(base)


def _used(definition: rsc.NamedExpression) -> list[Any]:
    references = (
        part.item if isinstance(part, rsc.Access) else part.function if isinstance(part, rsc.Call) else None
        for _, part in tree(definition.value or definition)
    )
    return list(dict.fromkeys(part for part in references if isinstance(part, rsc.NamedExpression)))


def _too_large(base: rsc.Base) -> Iterator[Finding]:
    for _ in conditions(instances(base)):
        pass
    for _, part in tree(base):
        # A function or condition is reported where it is used.
        within = part.eContainer()
        if isinstance(part, ex.Expression) and not isinstance(within, ex.Expression | rsc.Function | rsc.Condition):
            instances(base).expanded.is_too_large(part)
    for expression in instances(base).expanded.too_large:
        yield Finding(
            expression,
            f"this has more than {LARGEST} parts after names are expanded",
            "store the condition in a variable",
        )


@rule("argument")
def arguments(base: rsc.Base) -> Iterator[Finding]:
    """Each parameter gets an argument of its type, and each divisor is a positive constant."""
    for _, element in tree(base):
        match element:
            case ex.FunctionCall():
                yield from _built_in(element)
            case ex.Equation() | ex.Inequation():
                yield from _reason(element)
            case rsc.Call() if element.function is not None:
                parameters = element.function.parameters
                if len(element.arguments) != len(parameters):
                    names = [parameter.name for parameter in parameters]
                    yield _wrong_number(element, element.function.name, len(element.arguments), names)
                yield from _called(element)
            case rsc.InstantiatedComponent() | rsc.ImportedComponent() if element.definition is not None:
                yield from _argument_findings(element, element.definition, element.arguments)
            case rsc.ComplexDataTypeReference() if isinstance(element.type, rsc.EnumDataType | rsc.ObjectDataType):
                yield from _of_type(element)
    yield from _defaults(base)
    for meaning in meanings(base):
        yield from _of_enums(meaning, instances(base))
        yield from indices(meaning, instances(base))
        yield from _unreadable(meaning)
        if meaning.instance is not None:
            yield from _instance_findings(meaning)


def _reason(comparison: ex.Equation | ex.Inequation) -> Iterator[Finding]:
    """Report comparisons of `error` with an impossible reason of the service or action."""
    for other, communication in _beside_reason(comparison):
        fault = _impossible_reason(constant_value(other), communication)
        if fault is not None:
            ways = tuple(Replacement(f"write `{name}`", name, other) for name in reasons(communication))
            yield Finding(other, fault, Choice(_possible(communication), ways))


def _beside_reason(
    comparison: ex.Equation | ex.Inequation,
) -> Iterator[tuple[ex.Expression, rsc.CommunicationType | None]]:
    """Yield the other operand of each comparison with `error`, and the service or action that has failed."""
    for side, other in ((comparison.left, comparison.right), (comparison.right, comparison.left)):
        if isinstance(side, rsc.ErrorReason) and isinstance(other, rsc.Access | rsc.Call | ex.Conditional):
            yield other, _failing(side)


def _impossible_reason(value: object, communication: rsc.CommunicationType | None) -> str | None:
    """Return the fault of a value compared with `error`; None if it is a possible reason."""
    possible = reasons(communication)
    if not isinstance(value, rsc.EnumValue) or not possible or value.name in possible:
        return None
    if not is_failure(value.eContainer().eContainer()):
        return None
    kind = kind_text(communication) if communication is not None else ""
    return f"no {kind} fails because `{value.name}`, expected a reason that {kind}s have"


def _possible(communication: rsc.CommunicationType | None) -> str:
    return f"write one of {enumeration(f'`{name}`' for name in reasons(communication))}"


def _failing(element: ex.Located) -> rsc.CommunicationType | None:
    """Return the service or action of the error transition that contains an element."""
    around: ex.Located | None = element
    while around is not None and not isinstance(around, rsc.ResultTransition | rsc.RequirementTransition):
        around = around.eContainer()
    reference = around.event if isinstance(around, rsc.RequirementTransition) else around
    if not isinstance(reference, rsc.ResultTransition | rsc.NamedEvent) or reference.resultType != rsc.ResultType.error:
        return None
    return communication_of(reference.communicationType)


def _called(call: rsc.Call) -> Iterator[Finding]:
    for parameter, argument in zip(call.function.parameters, call.arguments, strict=False):
        expected, actual = declared_type(parameter.type), type_of(argument)
        if UNKNOWN not in {actual, expected} and actual != expected:
            message = f"the argument for `{parameter.name}` must be {expected}, found {actual}"
            yield Finding(argument, message, repair(argument, actual, expected))


def _of_type(reference: rsc.ComplexDataTypeReference) -> Iterator[Finding]:
    named = reference.type
    keeps = isinstance(reference.eContainer(), rsc.Variable | rsc.NamedExpression | rsc.FormalParameter)
    if isinstance(named, rsc.EnumDataType) and named.parameters and not keeps:
        yield from _argument_findings(reference, named, reference.arguments)
    elif reference.arguments:
        what = f"a {type(reference.eContainer()).__name__.lower()}" if keeps else f"`{named.name}`"
        yield Finding(
            reference.arguments[0],
            f"{what} takes no arguments, expected the type alone",
            Replacement(f"write `{named.name}`", f"{named.name}", reference),
        )


def _argument_findings(
    user: ex.Located, definition: rsc.Component | rsc.EnumDataType, arguments: Sequence[rsc.Argument]
) -> Iterator[Finding]:
    """Report faults in the arguments of a template or an enum; a parameter with a default needs none."""
    parameters = list(definition.parameters)
    bound: dict[rsc.FormalParameter, rsc.Argument] = {}
    named = False
    for position, argument in enumerate(arguments):
        named = named or argument.parameter is not None
        parameter = argument.parameter or (parameters[position] if position < len(parameters) and not named else None)
        if parameter is None:
            if not named:
                names = [parameter.name for parameter in parameters]
                yield _wrong_number(argument, definition.name, len(arguments), names)
                return
            message = "an argument without name follows one with a name"
            yield Finding(argument, message, _naming(argument, parameters, bound, arguments))
        elif parameter in bound:
            message = f"parameter `{parameter.name}` has an argument already{on_line(bound[parameter])}"
            first = bound[parameter]
            ways = (
                Removal(f"leave this one out{on_line(argument)}", argument),
                Removal(f"leave the other one out{on_line(first)}", first),
            )
            yield Finding(argument, message, Choice("leave one of the two out", ways), related=first)
        else:
            bound[parameter] = argument
            yield from _typed(argument.value, parameter, settable=isinstance(definition, rsc.EnumDataType))
    missing = [parameter for parameter in parameters if parameter not in bound and parameter.default is None]
    if missing:
        lacking = ", ".join(f"`{parameter.name}`" for parameter in missing)
        hint = f"write `{definition.name}({', '.join(f'{parameter.name}: ...' for parameter in missing)})`"
        yield Finding(user, f"`{definition.name}` gets no argument for {lacking}", hint)


def _naming(
    argument: rsc.Argument,
    parameters: Sequence[rsc.FormalParameter],
    bound: Collection[rsc.FormalParameter],
    arguments: Sequence[rsc.Argument],
) -> Choice:
    """Return the parameters that an argument can be for, as a choice of names before it."""
    named = {other.parameter for other in arguments}
    free = [parameter for parameter in parameters if parameter not in bound and parameter not in named]
    ways = (
        Insertion(f"write `{escape_keyword(other.name)}:` before it", f"{escape_keyword(other.name)}: ", argument)
        for other in free
    )
    return Choice("name its parameter", tuple(ways))


def _typed(value: ex.Expression | None, parameter: rsc.FormalParameter, *, settable: bool = False) -> Iterator[Finding]:
    """Report faults of an argument or a default value; `settable`: it may be a parameter of the node."""
    constant = _ENUM_ARGUMENT if settable else _ARGUMENT
    check = ExpressionCheck(Place(None) if settable and set_on_robot(value) else constant)
    check.expect(value, declared_type(parameter.type), f"the argument for `{parameter.name}`")
    yield from check.findings
    number = constant_value(value)
    kind = parameter.type
    if type(number) is not int or value is None or not isinstance(kind, rsc.IntegerDataType):
        return
    if not _fits(number, number, parameter):
        message, hint = _out_of_range(str(number), parameter)
        low = kind.minimum or 0
        nearest = low if number < low else kind.maximum
        yield Finding(value, message, Replacement(f"{hint}, such as `{nearest}`", str(nearest), value, is_choice=True))


def _fits(lowest: float | None, highest: float | None, parameter: rsc.FormalParameter) -> bool:
    """Return whether all numbers between two bounds are values of a parameter; unknown bounds fit."""
    kind = parameter.type
    if not isinstance(kind, rsc.IntegerDataType) or kind.minimum is None or kind.maximum is None:
        return True
    return (lowest is None or kind.minimum <= lowest) and (highest is None or highest <= kind.maximum)


def _out_of_range(values: str, parameter: rsc.FormalParameter) -> tuple[str, str]:
    kind = parameter.type
    assert isinstance(kind, rsc.IntegerDataType)
    message = f"the argument for `{parameter.name}` is {values}, expected {kind.minimum} to {kind.maximum}"
    return message, "write a number that is in the range"


def _of_enums(meaning: Meaning, known_instances: Instances) -> Iterator[Finding]:
    for definition in meaning.definitions:
        for _, element in tree(definition):
            if isinstance(element, rsc.ComplexDataTypeReference) and isinstance(element.type, rsc.EnumDataType):
                yield from _of_enum(element, element.type, meaning, known_instances)


def _of_enum(
    reference: rsc.ComplexDataTypeReference, enum: rsc.EnumDataType, meaning: Meaning, known_instances: Instances
) -> Iterator[Finding]:
    """Report faults in the arguments and the divisors of an enum, with the arguments of a template around it."""
    bound = bound_arguments(enum.parameters, reference.arguments)
    for parameter, value in bound.items():
        access = set_on_robot(value)
        if access is None:
            (number,) = meaning.values(value)
            if meaning.instance and type(number) is int and not _fits(number, number, parameter):
                yield meaning.finding(value, *_out_of_range(str(number), parameter))
            continue
        owned = known_instances.parameter(access, meaning.instance)
        lowest, highest = bounds(owned.parameter, None)
        if lowest is None and meaning.instance:
            lowest, highest = bounds(owned.parameter, owned.instance)
        elif meaning.instance:
            continue  # The template's own text has the finding.
        if not _fits(lowest, highest, parameter):
            yield meaning.finding(value, *_out_of_range(f"{lowest} to {highest} on the robot", parameter))
    for row, position, divisor in _divisors(enum):
        written = Expansion(None).expand_with(divisor, bound)
        (number,) = meaning.values(written)
        is_known = number is not None if meaning.instance or _reads_parameter(written) else _reads_parameter(divisor)
        if is_known and not _is_positive(number):
            yield meaning.finding(reference, *_wrong_divisor(row, position))


def _divisors(root: ex.Located) -> Iterator[tuple[Operator, int, ex.Expression]]:
    """Yield the divisors in function calls: the function, the position of the argument, and the argument."""
    for _, call in tree(root):
        row = operator_of(call) if isinstance(call, ex.FunctionCall) else None
        if row is not None and len(call.arguments) == row.parameters:
            yield from ((row, position, call.arguments[position]) for position in sorted(row.divisors))


def _defaults(base: rsc.Base) -> Iterator[Finding]:
    for owner in base.definitions:
        if isinstance(owner, rsc.Component | rsc.EnumDataType):
            for parameter in owner.parameters:
                yield from _typed(parameter.default, parameter)
    for function in statements(rsc.Function, base):
        for parameter in function.parameters:
            if parameter.default is not None:
                message = f"parameter `{parameter.name}` of a function has a default value"
                hint = Removal(
                    "leave it out: each call has all arguments",
                    part_of(parameter.default).preceded_by("="),
                    is_choice=False,
                )
                yield Finding(parameter.default, message, hint)


def _wrong_number(where: ex.Located, name: str, count: int, names: Sequence[str]) -> Finding:
    noun = "argument" if len(names) == 1 else "arguments"
    return Finding(where, f"`{name}` has {len(names)} {noun}, found {count}", f"write `{name}({', '.join(names)})`")


@rule("unused-template", Severity.WARNING)
def unused_template(base: rsc.Base) -> Iterator[Finding]:
    """Every template of a robot has an instance."""
    if isinstance(base, rsc.Robot):
        components = of_kind(rsc.Component, base.definitions)
        instantiated = {definition_of(component) for component in components if not component.parameters}
        for component in components:
            if (
                component.parameters
                and isinstance(component.type, rsc.LocalComponent)
                and component not in instantiated
            ):
                yield Finding(
                    component,
                    f"the template `{component.name}` has no instance, so it is not part of the robot",
                    Removal(f"write `component ... is {component.name}(...)`, or leave the template out", component),
                    relies_on=base,
                )


def _built_in(element: ex.FunctionCall) -> Iterator[Finding]:
    row, arguments = operator_of(element), list(element.arguments)
    assert row is not None
    if len(arguments) != row.parameters:
        yield _wrong_number(element, row.symbol, len(arguments), "abcdef"[: row.parameters])
        return
    for position in sorted(row.divisors):
        divisor = arguments[position]
        if not _reads_parameter(divisor) and type_of(divisor) == INTEGER and not _is_positive(constant_value(divisor)):
            message, hint = _wrong_divisor(row, position)
            yield Finding(divisor, message, Replacement(hint, "10", divisor, is_choice=True))


def _instance_findings(meaning: Meaning) -> Iterator[Finding]:
    """Report divisors and reasons beside `error` that are wrong for the arguments of a template."""
    assert meaning.instance is not None
    for _, part in tree(meaning.instance.local):
        for other, communication in _beside_reason(part) if isinstance(part, ex.Equation | ex.Inequation) else ():
            (value,) = meaning.values(other) if _reads_parameter(other) else (None,)
            fault = _impossible_reason(value, communication)
            if fault is not None:
                yield meaning.finding(other, fault, _possible(communication))
    for row, position, divisor in _divisors(meaning.instance.local):
        (value,) = meaning.values(divisor)
        if type(value) is int and value < 1:
            yield meaning.finding(divisor, *_wrong_divisor(row, position))


def _unreadable(meaning: Meaning) -> Iterator[Finding]:
    """Report constant expressions that round a value that is no number.

    For an instance of a template, only those are reported that its arguments cause.
    """
    waiting: list[Any] = list(meaning.definitions)[::-1] if meaning.instance is None else [meaning.instance.local]
    if not any(_may_round(part) for root in waiting for _, part in tree(root)):
        return
    while waiting:
        part = waiting.pop()
        inside = [child for _, child in contents(part)][::-1]
        unreadable = is_unreadable(part, meaning.instance) if isinstance(part, ex.Expression) else None
        if unreadable:
            inside = [child for child in inside if is_unreadable(child, meaning.instance)]
        if unreadable is None or (unreadable and inside):
            waiting += inside
        elif (
            unreadable
            and not isinstance(part, rsc.Access)
            and (meaning.instance is None or is_unreadable(part) is None)
        ):
            yield meaning.finding(part, "this rounds a value that is not a number", "write another expression")


def _may_round(part: ex.Located) -> bool:
    row = operator_of(part) if isinstance(part, ex.FunctionCall) else None
    return isinstance(part, rsc.Call) or (row is not None and row.is_partial)


def _wrong_divisor(row: Operator, position: int) -> tuple[str, str]:
    message = f"argument {position + 1} of `{row.symbol}` must be a positive constant"
    return message, "write an integer from 1 on, such as `10`"


def _is_positive(value: object) -> bool:
    return type(value) is int and value > 0


def _reads_parameter(expression: ex.Expression) -> bool:
    return any(isinstance(access.item, rsc.FormalParameter) for access in accesses(expression))
