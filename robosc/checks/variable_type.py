"""`variable-type` (thesis 4.5.14)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.checks.declarations import variables
from robosc.checks.rule import Finding, rule
from robosc.checks.supervised import Fault, data_reads, supervised_faults
from robosc.semantics.cone_of_influence import ConeOfInfluence, Reason
from robosc.semantics.printing import RoboscPrinter
from robosc.semantics.typing import DOUBLE, NONE, STRING, ArrayType, ObjectType, access_types, declared_type, value_type

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.metamodel import robosc as rsc
    from robosc.semantics.instances import Instances


@rule("variable-type")
def variable_type(base: rsc.Base) -> Iterator[Finding]:
    """A variable holds one value, and what the supervisor needs has finitely many values and comes from such data."""
    for _, variable in variables(base):
        found = declared_type(variable.type)
        if found == NONE or isinstance(found, (ArrayType, ObjectType)):
            what = "no value" if found == NONE else f"data of type {found}"
            yield Finding(
                variable,
                f"variable `{variable.name}` holds {what}, expected one boolean, integer, double, string or enum value",
                "leave it out, or declare it boolean to remember that something happened"
                if found == NONE
                else "declare a variable for each part that is used, such as `do part := value.…`",
            )
    yield from supervised_faults(base, _faults)


def _faults(_: Instances, result: ConeOfInfluence) -> Iterator[Fault]:
    for owned, reason in result.variables.items():
        found = declared_type(owned.variable.type)
        if found in {DOUBLE, STRING}:
            name = f"{owned.instance.name}.{owned.variable.name}"
            yield Fault(
                owned.variable,
                reason,
                f"variable `{name}` is {found}, and the supervisor needs it, expected boolean, an integer with a range"
                " or an enum: its states are finitely many",
                _enum_repair(str(found)),
            )
    for assigned, access in data_reads(result):
        types = access_types(access, value_type(access))
        is_array = any(isinstance(kind, ArrayType) for kind in types)
        if is_array or types[-1] in {DOUBLE, STRING}:
            assert assigned.variable is not None
            kind = "array data" if is_array else f"a {types[-1]}"
            yield Fault(
                access,
                Reason(access, assigned.instance, assigned.variable),
                f"`{assigned.variable.variable.name}`, which the supervisor needs, is computed from {kind},"
                f" `{RoboscPrinter()(access)}`, expected booleans, integers with a range or enums",
                _enum_repair(
                    types[0].definition.name if isinstance(types[0], ObjectType) and is_array else str(types[-1])
                ),
            )


def _enum_repair(base: str) -> str:
    enum = f"datatype enum … from {base} to {{ value … -> … default -> … }}"
    return f"turn it into an enum, `{enum}`, as the type of the data"
