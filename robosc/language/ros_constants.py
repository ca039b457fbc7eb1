"""Constants of ROS types: `BatteryState.POWER_SUPPLY_STATUS_CHARGING` in an expression."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.base.ros_types.wire import FOLDERS
from robosc.model import expression as ex
from robosc.model import robosc as rsc
from robosc.model.semantics.communication import section_of

if TYPE_CHECKING:
    from robosc.base.ros_types import RosTypes
    from robosc.base.ros_types.wire import Value
    from robosc.language.scopes import File
    from robosc.model.places import Place


def used_types(file: File, name: str) -> set[tuple[str, str]]:
    """Return the package and the kind of each ROS type of a name that an interface or a type of a text names."""
    definitions = file.base.definitions if file.base is not None else []
    interfaces = [one for one in definitions if isinstance(one, rsc.Interface) and one.type == name]
    references = [one for one in file.references if isinstance(one, rsc.InterfaceTypeReference) and one.rosType == name]
    return {
        *((one.package, kind) for one in interfaces for kind in FOLDERS),
        *((one.package, section_of(one).kind) for one in references),
    }


def constants_of(types: set[tuple[str, str]], name: str, interfaces: RosTypes) -> dict[str, dict[str, set[Value]]]:
    """Return the constants of types of a name: for each constant, the values in each type.

    A constant with several values in a type differs between the ROS versions.
    """
    known: dict[str, dict[str, set[Value]]] = {}
    for package, kind in sorted(types):
        for constants in interfaces.constants(package, name, kind):
            for constant, value in constants.items():
                whole_name = f"{package}/{FOLDERS[kind]}/{name}"
                known.setdefault(constant, {}).setdefault(whole_name, set()).add(value)
    return known


def literal(value: Value, source: Place | None) -> ex.Expression:
    """Return the literal of a value at a place."""
    match value:
        case bool():
            return ex.BooleanLiteral(value=value, source=source)
        case str():
            return ex.StringLiteral(value=value, source=source)
        case int():
            number: ex.Expression = ex.IntegerLiteral(value=abs(value), source=source)
        case float():
            number = ex.DoubleLiteral(value=abs(value), source=source)
    return ex.UnaryMinus(operand=number, source=source) if value < 0 else number
