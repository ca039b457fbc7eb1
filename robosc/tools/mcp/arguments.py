"""Checks the arguments of a tool against its JSON Schema, and describes faults in words."""

from __future__ import annotations

import json
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

from jsonschema import Draft202012Validator

if TYPE_CHECKING:
    from collections.abc import Mapping

    from jsonschema import ValidationError

#: Maximum length of a value in a message.
_LONGEST = 60
_TYPES = {
    "array": "an array",
    "boolean": "true or false",
    "integer": "an integer",
    "number": "a number",
    "object": "an object",
    "string": "a string",
}


def faults(schema: Mapping[str, Any], arguments: Any) -> list[str]:
    """Return the faults of arguments, in the order of their names; empty if they fit the schema."""
    errors = Draft202012Validator(schema).iter_errors(arguments)
    return [_words(error) for error in sorted(errors, key=lambda error: (error.json_path, str(error.validator)))]


def _words(error: ValidationError) -> str:
    name = error.json_path.removeprefix("$").removeprefix(".")
    where = f"`{name}`" if name else "the arguments"
    limit: Any = error.validator_value
    match error.validator:
        case "type":
            kinds = [limit] if isinstance(limit, str) else limit
            return f"{where} must be {' or '.join(_TYPES.get(kind, kind) for kind in kinds)}, not {_shown(error)}"
        case "required":
            missing = [key for key in limit if key not in error.instance]
            return f"{where} must have {' and '.join(f'`{key}`' for key in missing)}"
        case "additionalProperties":
            return f"{where} must not have {_unknown(error)}"
        case "enum":
            return f"{where} must be one of {', '.join(map(json.dumps, limit))}, not {_shown(error)}"
        case "minimum":
            return f"{where} must be at least {limit}, not {_shown(error)}"
        case "maximum":
            return f"{where} must be at most {limit}, not {_shown(error)}"
        case "maxLength" | "maxItems":
            unit = "characters" if error.validator == "maxLength" else "entries"
            return f"{where} has {len(error.instance):,} {unit}; the most is {limit:,}"
        case "minLength" | "minItems":
            return f"{where} must not be empty"
    return f"{where} does not fit {json.dumps(error.validator)}: {json.dumps(limit)}"


def _unknown(error: ValidationError) -> str:
    known = list(error.schema.get("properties", ()))
    others = [key for key in error.instance if key not in known]
    unknown = others[0][:_LONGEST]
    close = get_close_matches(unknown, known, n=1)
    if close:
        return f"`{unknown}`; did you mean `{close[0]}`?"
    return f"`{unknown}`; expected {' or '.join(f'`{key}`' for key in known) or 'no arguments'}"


def _shown(error: ValidationError) -> str:
    text = json.dumps(error.instance, default=str)
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 1]}…"
