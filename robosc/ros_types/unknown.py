"""Why nothing is known of a ROS type, and how to change that."""

from __future__ import annotations

from difflib import get_close_matches
from typing import TYPE_CHECKING

from robosc.ros_types.wire import FOLDERS, DefinitionError, Section

if TYPE_CHECKING:
    from robosc.ros_types import RosDistribution, RosTypes

REPAIR = "repair it: until then nothing is checked against it"
MAKE_KNOWN = (
    "give the folder of its package with --interface-path, or list it in ROBOSC_INTERFACE_PATH; until then nothing is"
    " checked against it"
)
#: How to read the data of a service or action where only a message can be named.
OWN_OBJECT = "for the data of a service or action, declare an object with the fields that you use and an enum over it"


def other_kinds(types: RosTypes, package: str, name: str, kind: str) -> list[str]:
    """The other kinds of which there is a type of that name: `service`, `action`."""
    return [
        other
        for other in FOLDERS
        if other != kind and any(name in distribution.names(package, other) for distribution in types.distributions)
    ]


def why_unknown(types: RosTypes, package: str, name: str, section: Section) -> tuple[str, str]:
    """A message and a hint about a type of which no distribution gives this section."""
    kind = section.kind
    for distribution in types.distributions:
        try:
            distribution.fields(package, name, section)
        except DefinitionError as fault:
            return f"the definition of {package}/{name} can't be read: {fault}", REPAIR
    for other in Section:
        if other.kind != kind and any(_has(known, package, name, other) for known in types.distributions):
            message = f"{package}/{name} is of kind {other.kind}, expected a type of kind {kind}"
            return message, f"name a type of kind {kind}"
    if not any(known.names(package, other) for known in types.distributions for other in FOLDERS):
        known = sorted({name for distribution in types.distributions for name in distribution.packages()})
        close = get_close_matches(package, known, n=1, cutoff=0.8)
        return (
            f"the package `{package}` is unknown",
            f"did you mean `{close[0]}`? Else {MAKE_KNOWN}" if close else MAKE_KNOWN,
        )
    names = sorted({known for distribution in types.distributions for known in distribution.names(package, kind)})
    close = get_close_matches(name, names, n=1)
    hint = f"did you mean `{close[0]}`?" if close else MAKE_KNOWN
    return f"no {kind} type `{name}` of the package `{package}` is known", hint


def _has(distribution: RosDistribution, package: str, name: str, section: Section) -> bool:
    try:
        return distribution.fields(package, name, section) is not None
    except DefinitionError:
        return True
