"""Annotations that require states to be reachable, as requirements of an sct model.

The arguments are those of CIF 13: `from`, `avoid`, `stay` and `bound`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.language.cif.faults import CifFaultError, construct
from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.printing import conjunction

if TYPE_CHECKING:
    from robosc.language.cif.scopes import Scope
    from robosc.language.cif.values import Values

_ARGUMENTS = ("from", "avoid", "stay", "bound")
#: Largest bound: that of an `int` in CIF.
_LARGEST = 2**31 - 1


def reachability_requirement(node: Any, scope: Scope, values: Values) -> sct.ReachabilityRequirement:
    """Return the requirement of an annotation; its names are those inside of `scope`. Raises CifFaultError."""
    is_outermost = type(node.parent).__name__ == "Specification"
    if node.name.startswith("@@") != is_outermost:
        sign = "two `@` before the first declaration" if is_outermost else "one `@` before a group or an automaton"
        raise CifFaultError(node, "cif-construct", f"`{node.name}` stands in a wrong place", f"write {sign}")
    arguments: dict[str | None, Any] = {}
    for argument in node.arguments:
        if argument.name not in (None, *_ARGUMENTS):
            hint = f"the arguments with a name are {', '.join(f'`{known}`' for known in _ARGUMENTS)}"
            raise construct(argument, f"the argument `{argument.name}` of `{node.name}`", hint)
        if argument.name in arguments:
            raise CifFaultError(argument, "cif-construct", f"`{node.name}` has this argument twice", "leave one out")
        arguments[argument.name] = argument.value
    if None not in arguments:
        message = f"`{node.name}` has no condition"
        raise CifFaultError(node, "cif-construct", message, "write the condition as its first argument")

    def condition(name: str | None) -> ex.Expression | None:
        return values.condition([arguments[name]], scope) if name in arguments else None

    avoided = condition("avoid")
    outside = None if avoided is None else ex.Negation(operand=avoided)
    return sct.ReachabilityRequirement(
        condition=condition(None),
        premise=condition("from"),
        pathCondition=conjunction(part for part in (condition("stay"), outside) if part is not None),
        bound=_bound(arguments["bound"], scope, values) if "bound" in arguments else None,
    )


def _bound(node: Any, scope: Scope, values: Values) -> int:
    value, kind = values.constant(node, scope)
    if not isinstance(kind, range) or not 0 <= value <= _LARGEST:
        raise CifFaultError(node, "type", f"a bound is an integer constant from 0 to {_LARGEST}")
    return int(value)
