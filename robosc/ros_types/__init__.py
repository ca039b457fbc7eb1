"""Definitions of ROS messages, services and actions, as each of the two ROS has them.

A definition is looked for in the folders of the call, in those of ROBOSC_INTERFACE_PATH, in the ROS installation of the
computer, and among the standard types. Both ROS are asked: they disagree about some types.
"""

from __future__ import annotations

import os
from difflib import get_close_matches
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from robosc.files.resources import locate
from robosc.ros_types.folders import MOST_FOLDERS, Share, Workspace
from robosc.ros_types.wire import FOLDERS, DefinitionError, Fields, Nested, Section, Sequence, WireType

if TYPE_CHECKING:
    from collections.abc import Iterable
    from os import PathLike

    from robosc.ros_types.rosbags_types import ShippedTypes

__all__ = ["DefinitionError", "Fields", "RosDistribution", "RosTypes", "Section", "WireType"]

REPAIR = "repair it: until then nothing is checked against it"
MAKE_KNOWN = (
    "give the folder of its package with --interface-path, or list it in ROBOSC_INTERFACE_PATH; until then nothing is"
    " checked against it"
)
#: How to read the data of a service or action where only a message can be named.
OWN_OBJECT = "for the data of a service or action, declare an object with the fields that you use and an enum over it"
#: The field that holds a basic value of a section with several fields.
_DATA = "data"
_SHIPPED = locate("ros_types/definitions")


class RosDistribution:
    """All types as one of the two ROS has them."""

    def __init__(self, ros: str, folders: Iterable[Share]) -> None:
        """`ros` is `ROS 1` or `ROS 2`; of several `folders` with a type the first one counts."""
        self.name = ros
        self._folders = list(folders)
        self._known: dict[tuple[str, str, Section], Fields | None] = {}
        self._named: dict[tuple[str, str], list[str]] = {}

    @cached_property
    def _sources(self) -> list[Share | ShippedTypes]:
        from robosc.ros_types.rosbags_types import ShippedTypes  # takes long to load

        return [*self._folders, ShippedTypes(self.name)]

    def fields(self, package: str, name: str, section: Section) -> Fields | None:
        """The fields of a section of a type; None where the type is unknown.

        Raises DefinitionError where the text of the definition can't be read.
        """
        if not (package.isidentifier() and name.isidentifier()):
            return None  # Names are parts of paths.
        key = package, name, section
        if key not in self._known:
            found = (source.fields(package, name, section) for source in self._sources)
            self._known[key] = next((fields for fields in found if fields is not None), None)
        return self._known[key]

    def reached(
        self, package: str, name: str, section: Section, path: Iterable[str]
    ) -> tuple[WireType, Section] | None:
        """What stands at the end of a path of fields and positions, an object with its section; None: unknown."""
        found: WireType | None = Nested(package, name)
        for step in path:
            if step.isdigit():
                found = found.at(int(step)) if isinstance(found, Sequence) else None
            elif isinstance(found, Nested):
                try:
                    fields = self.fields(found.package, found.name, section)
                except DefinitionError:
                    return None
                found, section = None if fields is None else fields.get(step), Section.MESSAGE
            else:
                return None
        return None if found is None else (found, section)

    def defines(self, package: str, name: str, section: Section) -> bool:
        """Whether there is a section of a type, also one that can't be read."""
        try:
            return self.fields(package, name, section) is not None
        except DefinitionError:
            return True

    def names(self, package: str, kind: str) -> list[str]:
        """The names of the types of a kind (`message`, `service`, `action`) that are known of a package, sorted."""
        key = package, kind
        if key not in self._named:
            self._named[key] = sorted({name for source in self._sources for name in source.names(package, kind)})
        return self._named[key]

    def packages(self) -> set[str]:
        """The names of all packages of which a type is known."""
        return {package for source in self._sources for package in source.packages()}


class RosTypes:
    """All types of both ROS."""

    def __init__(self, paths: Iterable[str | PathLike[str]] = ()) -> None:
        """`paths` are folders with packages below them, searched before all others."""
        given = [Path(path) for path in paths] + _environment("ROBOSC_INTERFACE_PATH")
        installed = {
            "ROS 2": [Share(prefix / "share") for prefix in _environment("AMENT_PREFIX_PATH")],
            "ROS 1": [
                *(Workspace(folder, "ROS 1") for folder in _environment("ROS_PACKAGE_PATH")),
                Share(Path("/usr/share")),  # where Debian installs it
            ],
        }
        #: ROS 2, then ROS 1.
        self._given = {ros: [Workspace(folder, ros) for folder in given] for ros in installed}
        self.distributions = [
            RosDistribution(ros, [*self._given[ros], *shares, Share(_SHIPPED)]) for ros, shares in installed.items()
        ]

    def distribution(self, ros: int) -> RosDistribution:
        """All types as ROS 1 or ROS 2 has them."""
        return next(known for known in self.distributions if known.name == f"ROS {ros}")

    def field_of_basic(self, package: str, name: str, section: Section) -> str:
        """The field in which a basic value travels: the only one of the section in one of the two ROS, else `data`."""
        for distribution in self.distributions:
            try:
                fields = distribution.fields(package, name, section)
            except DefinitionError:
                continue
            if fields is not None and len(fields) == 1:
                return next(iter(fields))
        return _DATA

    def _make_known(self) -> str:
        """How to make a type known: where a folder is too large to be searched, by a smaller one."""
        large = next((found.folder for found in self._given["ROS 2"] if found.is_too_large), None)
        if large is None:
            return MAKE_KNOWN
        return (
            f"only the first {MOST_FOLDERS:,} folders below `{large}` were searched: "
            "give a folder nearer to the package with --interface-path"
        )

    def other_kinds(self, package: str, name: str, kind: str) -> list[str]:
        """The other kinds of which there is a type of that name: `service`, `action`."""
        return [
            other
            for other in FOLDERS
            if other != kind and any(name in distribution.names(package, other) for distribution in self.distributions)
        ]

    def _names(self, package: str, kind: str) -> list[str]:
        return sorted({found for known in self.distributions for found in known.names(package, kind)})

    def why_unknown(self, package: str, name: str, section: Section) -> tuple[str, str, tuple[str, str] | None]:
        """Why no distribution has this section of a type: a message, a hint, and the type that was probably meant.

        That is its package and its name; None: there is no close match.
        """
        kind = section.kind
        for distribution in self.distributions:
            try:
                distribution.fields(package, name, section)
            except DefinitionError as fault:
                return f"the definition of {package}/{name} can't be read: {fault}", REPAIR, None
        for other in Section:
            if other.kind != kind and any(known.defines(package, name, other) for known in self.distributions):
                message = f"{package}/{name} is of kind {other.kind}, expected a type of kind {kind}"
                return message, f"name a type of kind {kind}", None
        if not any(known.names(package, other) for known in self.distributions for other in FOLDERS):
            packages = {found for known in self.distributions for found in known.packages()}
            having = sorted(other for other in packages if name in self._names(other, kind))
            close = get_close_matches(package, having, n=1, cutoff=0.8)
            make_known = self._make_known()
            hint = f"did you mean `{close[0]}`? Else {make_known}" if close else make_known
            return f"the package `{package}` is unknown", hint, (close[0], name) if close else None
        close = get_close_matches(name, self._names(package, kind), n=1)
        hint = f"did you mean `{close[0]}`?" if close else self._make_known()
        meant = (package, close[0]) if close else None
        return f"no {kind} type `{name}` of the package `{package}` is known", hint, meant


def _environment(variable: str) -> list[Path]:
    return [Path(folder) for folder in os.environ.get(variable, "").split(os.pathsep) if folder]
