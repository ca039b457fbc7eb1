"""A target of RoboSC: the supervisor as a function block in Structured Text (IEC 61131-3:2013).

Call the block with the number of an event. If the event is possible and allowed, it happens. The outputs report that,
and the events that can happen next. The program of the controller selects the next event. In each of its cycles it
first calls the events from the robot, then silent events until none is enabled, then its commands.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import robosc
from robosc.base.diagnostics import Diagnostic, Severity
from robosc.model import engine, sct
from robosc.model import expression as ex
from robosc.model.places import place
from robosc.model.reflection import tree
from robosc.model.semantics.operators import PRECEDENCE, SYMBOLS
from robosc.model.semantics.printing import Printed, Printer

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from robosc.language.configuration import Configuration
    from robosc.m2t.models import Models

#: The width of all integers: no standard function saturates in a conversion.
_BITS = 32


def preconditions(models: Models, configuration: Configuration) -> list[Diagnostic]:  # noqa: ARG001
    """Return diagnostics for timers and for integers of more than 32 bits, which the function block cannot express."""
    if models.sct.supervisor is None:
        return []  # a call of `generate` needs a supervisor
    model = robosc.to_engine(models.sct)
    found = []
    if model.timers:
        found.append(_refused(model.timers[0].event.event, "a time has no form in the function block"))
    for declared in (*model.variables, *model.inputs):
        if declared.minimum < -(2**31) or declared.maximum >= 2**31:
            wide = declared.input if isinstance(declared, engine.Input) else declared.variable
            found.append(_refused(wide, f"`{declared.name}` needs more than {_BITS} bits"))
    wide_events = (event for event in model.events if any(_is_wide(node) for _, node in tree(event)))
    found += [_refused(event.event, f"`{event.name}` computes with more than {_BITS} bits") for event in wide_events]
    return found


def _refused(element: object, reason: str) -> Diagnostic:
    hint = "leave it out, or choose another target"
    return Diagnostic(*place(element), Severity.ERROR, "structured-text", reason, hint)


def _is_wide(node: object) -> bool:
    match node:
        case engine.Conversion(bits=bits, signed=signed):
            return bool(bits > _BITS or (bits == _BITS and not signed))
        case engine.Saturation(bits=bits):
            return bool(bits > _BITS)
    return False


def generate(models: Models, configuration: Configuration) -> dict[str, str]:  # noqa: ARG001
    """Return one file with a function block that has the robot's name."""
    model = robosc.to_engine(models.sct)
    return {f"{model.name}.st": "\n".join([*_block(model, _Names(model)), ""])}


class _Names:
    """Names in Structured Text: not case-sensitive, without two consecutive underscores."""

    def __init__(self, model: engine.EngineModel) -> None:
        self._of: dict[object, str] = {}
        taken: set[str] = set()
        for prefix, declared in (
            *(("s", variable) for variable in model.variables),
            *(("i", given) for given in model.inputs),
            *(("c", condition) for condition in model.conditions),
        ):
            plain = re.sub(r"_+", "_", re.sub(r"[^A-Za-z0-9]", "_", f"{prefix}_{declared.name}")).strip("_")
            name, number = plain, 2
            while name.lower() in taken:
                name, number = f"{plain}_{number}", number + 1
            taken.add(name.lower())
            self._of[declared] = name

    def __getitem__(self, declared: object) -> str:
        return self._of[declared]


class _Printer(Printer):
    """Printer of an engine model's expressions. A condition that several guards share is a variable."""

    symbols = {  # noqa: RUF012  # a ClassVar in the base class
        **SYMBOLS,
        ex.Equation: "=",
        ex.Inequation: "<>",
        ex.Negation: "NOT ",
        engine.Remainder: "MOD",
        sct.Quotient: "/",
        engine.And: "AND",
        engine.Or: "OR",
    }

    def __init__(self, names: _Names) -> None:
        self._names = names

    def write(self, expression: ex.Expression, given: Sequence[Printed]) -> Printed:
        match expression:
            case engine.And() | engine.Or():
                operands = f" {self.symbols[type(expression)]} ".join(part.tight for part in given)
                return Printed(operands, PRECEDENCE[ex.Conjunction])
            case engine.Conversion():
                return given[0]
            case engine.Saturation(minimum=low, maximum=high):
                return Printed(f"LIMIT({_number(low)}, {given[0].text}, {_number(high)})")
            case ex.Conditional():
                condition, then, otherwise = (part.text for part in given)
                return Printed(f"SEL({condition}, {otherwise}, {then})")
        return super().write(expression, given)

    def binary(self, expression: ex.BinaryExpression, left: Printed, right: Printed) -> Printed:
        return Printed(f"{left.tight} {self.symbols[type(expression)]} {right.tight}", PRECEDENCE[type(expression)])

    def atom(self, expression: ex.Expression) -> str:
        match expression:
            case engine.VariableReference(variable=variable, before=before):
                return f"old_{self._names[variable]}" if before else self._names[variable]
            case engine.InputReference(input=declared):
                return self._names[declared]
            case engine.ConditionReference(condition=condition):
                return self._names[condition]
            case engine.LocationLiteral(location=location):
                return str(list(location.eContainer().locations).index(location))
            case ex.EnumerationLiteralReference(literal=literal):
                return str(list(literal.eContainer().literals).index(literal))
            case ex.BooleanLiteral(value=value):
                return "TRUE" if value else "FALSE"
        return super().atom(expression)


def _number(value: int) -> str:
    return str(value)


def _comment(text: str) -> str:
    """Return a text that can neither end its comment nor begin another."""
    return text.replace("(*", "( *").replace("*)", "* )")


def _values(declared: engine.Declaration) -> str:
    """Return the meanings of a variable's numbers."""
    match declared.type:
        case engine.LocationType(plant=plant):
            return ", ".join(f"{number}: {location.name}" for number, location in enumerate(plant.locations))
        case ex.EnumerationType(enumeration=enumeration):
            return ", ".join(f"{number}: {literal.name}" for number, literal in enumerate(enumeration.literals))
        case ex.BooleanType():
            return declared.name
    return f"{declared.minimum} to {declared.maximum}"


def _declared(declared: engine.Declaration, name: str) -> str:
    boolean = isinstance(declared.type, ex.BooleanType)
    initial = ("FALSE", "TRUE")[declared.initial] if boolean else _number(declared.initial)
    kind = "BOOL" if boolean else "DINT"
    return f"    {name} : {kind} := {initial}; (* {_comment(_values(declared))} *)"


def _block(model: engine.EngineModel, names: _Names) -> Iterable[str]:
    printer = _Printer(names)
    last = max(len(model.events) - 1, 0)
    copied = dict.fromkeys(variable for event in model.events for variable in event.effect.copied)
    yield f"(* The supervisor of {_comment(model.name)}. Generated by RoboSC; changes are lost when it is made anew."
    yield ""
    yield "   Call it with the number of an event, and its inputs set; with -1 it only tells what is enabled."
    yield ""
    for number, event in enumerate(model.events):
        yield f"   {number:>3}  {event.role.name:<8} {_comment(event.name)}: {_comment(event.description)}"
    yield "*)"
    yield f"FUNCTION_BLOCK FB_{model.name}"
    yield "VAR_INPUT"
    yield "    event : DINT := -1; (* what is to happen *)"
    yield from (_declared(declared, names[declared]) for declared in model.inputs)
    yield "END_VAR"
    yield "VAR_OUTPUT"
    yield "    happened : BOOL; (* whether it has: it was possible and allowed *)"
    yield f"    enabled : ARRAY [0..{last}] OF BOOL; (* what can happen now *)"
    yield "END_VAR"
    yield "VAR"
    yield from (_declared(variable, names[variable]) for variable in model.variables)
    yield from (_declared(variable, f"old_{names[variable]}") for variable in copied)
    yield from (f"    {names[condition]} : BOOL;" for condition in model.conditions)
    yield "    turn : DINT;"
    yield "END_VAR"
    yield ""
    yield "happened := FALSE;"
    yield "FOR turn := 1 TO 2 DO"
    yield from (f"    {line}" for line in _guards(model, names, printer))
    yield f"    IF (turn = 1) AND (event >= 0) AND (event <= {last}) THEN"
    yield "        happened := enabled[event];"
    yield "        IF happened THEN"
    yield from (f"            {line}" for line in _effects(model, names, printer))
    yield "        END_IF;"
    yield "    END_IF;"
    yield "END_FOR;"
    yield "END_FUNCTION_BLOCK"


def _guards(model: engine.EngineModel, names: _Names, printer: _Printer) -> Iterable[str]:
    for condition in model.conditions:
        yield f"{names[condition]} := {printer(condition.value)};"
    for number, event in enumerate(model.events):
        yield from (f"(* {_comment(remark)} *)" for remark in event.remarks)
        terms = [printer.printed(term.condition).tight for term in event.guard.terms]
        yield f"enabled[{number}] := {' AND '.join(terms) or 'TRUE'};"
    if not model.events:
        yield "enabled[0] := FALSE;"


def _effects(model: engine.EngineModel, names: _Names, printer: _Printer) -> Iterable[str]:
    changing = [(number, event) for number, event in enumerate(model.events) if event.effect.steps]
    if not changing:
        return
    yield "CASE event OF"
    for number, event in changing:
        yield f"    {number}: (* {_comment(event.name)} *)"
        for variable in event.effect.copied:
            yield f"        old_{names[variable]} := {names[variable]};"
        for step in event.effect.steps:
            yield from (f"        {line}" for line in _step(step, names, printer))
    yield "END_CASE;"


def _step(step: engine.Step, names: _Names, printer: _Printer) -> Iterable[str]:
    if isinstance(step, engine.Assignment):
        yield f"{names[step.variable]} := {printer(step.value)};"
        return
    assert isinstance(step, engine.Switch)
    for position, case in enumerate(step.cases):
        if case.condition is None and position:
            yield "ELSE"
        else:
            condition = "TRUE" if case.condition is None else printer(case.condition)
            yield f"{'ELSIF' if position else 'IF'} {condition} THEN"
        for assignment in case.assignments:
            yield from (f"    {line}" for line in _step(assignment, names, printer))
    yield "END_IF;"
