"""Why nothing is known of a ROS type, and how to change that."""

from __future__ import annotations

from difflib import get_close_matches
from typing import TYPE_CHECKING

from robosc.ros_types.wire import FOLDERS, DefinitionError, Part

if TYPE_CHECKING:
    from robosc.ros_types import Edition, Interfaces

REPAIR = "repair it: until then nothing is checked against it"
MAKE_KNOWN = (
    "give the folder of its package with --interface-path, or list it in ROBOSC_INTERFACE_PATH; until then nothing is"
    " checked against it"
)
#: How to read the data of a service or action where only a message can be named.
OWN_OBJECT = "for the data of a service or action, declare an object with the fields that you use and an enum over it"


def other_kinds(interfaces: Interfaces, package: str, name: str, kind: str) -> list[str]:
    """The other kinds of which there is a type of that name: `service`, `action`."""
    return [
        other
        for other in FOLDERS
        if other != kind and any(name in edition.names(package, other) for edition in interfaces.editions)
    ]


def why_unknown(interfaces: Interfaces, package: str, name: str, part: Part) -> tuple[str, str]:
    """A message and a hint about a type of which no edition gives this part."""
    kind = part.kind
    for edition in interfaces.editions:
        try:
            edition.fields(package, name, part)
        except DefinitionError as fault:
            return f"the definition of {package}/{name} can't be read: {fault}", REPAIR
    for other in Part:
        if other.kind != kind and any(_has(each, package, name, other) for each in interfaces.editions):
            message = f"{package}/{name} is of kind {other.kind}, expected a type of kind {kind}"
            return message, f"name a type of kind {kind}"
    if not any(each.names(package, other) for each in interfaces.editions for other in FOLDERS):
        known = sorted({name for edition in interfaces.editions for name in edition.packages()})
        close = get_close_matches(package, known, n=1, cutoff=0.8)
        return (
            f"the package `{package}` is unknown",
            f"did you mean `{close[0]}`? Else {MAKE_KNOWN}" if close else MAKE_KNOWN,
        )
    names = sorted({known for each in interfaces.editions for known in each.names(package, kind)})
    close = get_close_matches(name, names, n=1)
    hint = f"did you mean `{close[0]}`?" if close else MAKE_KNOWN
    return f"no {kind} type `{name}` of the package `{package}` is known", hint


def _has(edition: Edition, package: str, name: str, part: Part) -> bool:
    try:
        return edition.fields(package, name, part) is not None
    except DefinitionError:
        return True
