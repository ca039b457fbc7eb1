"""Parameters of the function, template or enum whose arguments surround an offset."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.language.hover import type_text
from robosc.language.tokens import Kind, Tokens
from robosc.model import robosc as rsc
from robosc.model.semantics.naming import TEXT_FUNCTION
from robosc.model.semantics.operators import FUNCTIONS

if TYPE_CHECKING:
    from robosc.language.reading import Reading

_CALLED = (rsc.Function, rsc.Component, rsc.EnumDataType)


@dataclass(frozen=True)
class Signature:
    """A label such as `gain(d: double): double`, its parameters as they appear in it, and the active index."""

    label: str
    parameters: list[str]
    active: int | None


def signature(reading: Reading, offset: int) -> Signature | None:
    """Return the signature for the innermost parentheses around an offset, or None if there is none."""
    call = _call(reading.file.text.content[:offset])
    if call is None:
        return None
    name, position, named = call
    if name in FUNCTIONS:
        count = FUNCTIONS[name].parameters
        parameters = ["a", "b"][:count] if count else ["a"]
        return Signature(f"{name}({', '.join(parameters)})", parameters, _active(position, parameters))
    if name == TEXT_FUNCTION and not any(
        isinstance(definition, rsc.Function) and definition.name == name
        for file in reading.files.values()
        for definition in file.declared_names
    ):
        return Signature(f"{name}(i: integer): string", ["i: integer"], _active(position, ["i"]))
    for file in reading.files.values():
        for definition in file.declared_names:
            if isinstance(definition, _CALLED) and definition.name == name and definition.parameters:
                shown = [f"{parameter.name}: {type_text(parameter.type)}" for parameter in definition.parameters]
                names = [parameter.name for parameter in definition.parameters]
                active = names.index(named) if named in names else _active(position, names)
                result = f": {type_text(definition.type)}" if isinstance(definition, rsc.Function) else ""
                return Signature(f"{name}({', '.join(shown)}){result}", shown, active)
    return None


def _active(position: int, parameters: list[str]) -> int | None:
    return position if position < len(parameters) else None


def _call(before: str) -> tuple[str, int, str | None] | None:
    """Return the name before the innermost open parenthesis, the commas behind it, and the argument's name."""
    tokens = Tokens(before)
    depth = commas = 0
    named: str | None = None
    for index in range(len(tokens) - 1, 0, -1):
        token = tokens[index]
        if token.is_keyword("{", "}"):
            return None
        if token.is_keyword(")", "]"):
            depth += 1
        elif token.is_keyword("(", "["):
            if depth == 0:
                name = tokens[index - 1]
                is_call = token.text == "(" and name.kind is Kind.WORD
                return (name.text.removeprefix("^"), commas, named) if is_call else None
            depth -= 1
        elif depth == 0 and token.is_keyword(","):
            commas += 1
        elif depth == 0 and token.is_keyword(":") and commas == 0 and named is None:
            named = tokens[index - 1].text.removeprefix("^")
    return None
