"""Interpreter of function blocks in Structured Text, parsed by blark, for the constructs that the example generates."""

import operator
import re
from collections.abc import Mapping
from typing import Any

import blark.transform as st
from blark.parse import parse_source_code

_OPERATORS = {
    "AND": lambda left, right: left and right,
    "OR": lambda left, right: left or right,
    "=": operator.eq,
    "<>": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": lambda left, right: abs(left) // abs(right) * (1 if (left < 0) == (right < 0) else -1),
    "MOD": lambda left, right: left - right * _OPERATORS["/"](left, right),
}
_FUNCTIONS = {
    "LIMIT": lambda low, value, high: min(max(low, value), high),
    "SEL": lambda condition, no, yes: yes if condition else no,
}
_DECLARED = re.compile(r"^ +(\w+) : (BOOL|DINT)(?: := (\S+))?;", re.MULTILINE)
#: Integers have 32 bits.
_RANGE = range(-(2**31), 2**31)


class Block:
    """An instance of the function block in a text, with readable and writable variables."""

    def __init__(self, text: str) -> None:
        items = parse_source_code(text).transform().items
        self._block = next(item for item in items if isinstance(item, st.FunctionBlock))
        self.variables: dict[str, Any] = {"enabled": {}}
        for name, kind, value in _DECLARED.findall(text):
            assert name.lower() not in {other.lower() for other in self.variables}, name
            self.variables[name] = value == "TRUE" if kind == "BOOL" else int(value or 0)

    def call(self, inputs: Mapping[str, Any]) -> None:
        """Call the block once."""
        self.variables |= inputs
        self._run(self._block.body)

    def _run(self, statements: st.StatementList | None) -> None:
        for statement in statements.statements if statements else ():
            match statement:
                case st.AssignmentStatement(variables=[variable], expression=expression):
                    self._assign(variable, self._value(expression))
                case st.ForStatement():
                    for turn in range(self._value(statement.from_), self._value(statement.to) + 1):
                        self._assign(statement.control, turn)
                        self._run(statement.statements)
                case st.IfStatement():
                    self._branch(statement)
                case st.CaseStatement():
                    chosen = self._value(statement.expression)
                    for case in statement.cases:
                        if chosen in [self._value(match) for match in case.matches]:
                            self._run(case.statements)
                case _:
                    raise TypeError(statement)

    def _branch(self, statement: st.IfStatement) -> None:
        branches = [(statement.if_expression, statement.statements)]
        branches += [(branch.if_expression, branch.statements) for branch in statement.else_ifs]
        for condition, statements in branches:
            if self._value(condition):
                self._run(statements)
                return
        if statement.else_clause is not None:
            self._run(statement.else_clause.statements)

    def _assign(self, variable: Any, value: Any) -> None:
        if isinstance(variable, st.MultiElementVariable):
            self.variables[str(variable.name.name)][self._index(variable)] = value
        else:
            assert isinstance(value, bool) == isinstance(self.variables[str(variable.name)], bool), variable
            assert isinstance(value, bool) or value in _RANGE
            self.variables[str(variable.name)] = value

    def _index(self, variable: st.MultiElementVariable) -> int:
        return self._value(variable.elements[0].subscripts[0])

    def _value(self, expression: Any) -> Any:
        match expression:
            case st.ParenthesizedExpression(expr=inner):
                return self._value(inner)
            case st.Boolean(value=value):
                return str(value).upper() == "TRUE"
            case st.Integer(value=value):
                return int(value)
            case st.MultiElementVariable():
                return self.variables[str(expression.name.name)][self._index(expression)]
            case st.SimpleVariable(name=name):
                return self.variables[str(name)]
            case st.UnaryOperation(op=op, expr=inner):
                return not self._value(inner) if str(op).upper() == "NOT" else -self._value(inner)
            case st.BinaryOperation(left=left, op=op, right=right):
                return _OPERATORS[str(op)](self._value(left), self._value(right))
            case st.FunctionCall(name=name, parameters=parameters):
                return _FUNCTIONS[str(name.name)](*(self._value(parameter.value) for parameter in parameters))
        raise TypeError(expression)
