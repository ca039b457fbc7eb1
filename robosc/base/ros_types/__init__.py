"""Definitions of ROS messages, services and actions, for ROS 1 and ROS 2.

A definition is searched in the folders of the call, in those of ROBOSC_INTERFACE_PATH, in the ROS installation of the
computer, and among the shipped types. Both ROS versions are searched, because they differ in some types.
"""

from __future__ import annotations

import os
from difflib import get_close_matches
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from robosc.base.files.resources import locate
from robosc.base.ros_types.folders import MOST_FOLDERS, Share, Workspace
from robosc.base.ros_types.wire import FOLDERS, DefinitionError, Fields, NestedType, Section, Sequence, Value, WireType

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from os import PathLike

    from robosc.base.ros_types.rosbags_types import ShippedTypes

__all__ = ["DefinitionError", "Fields", "RosDistribution", "RosTypes", "Section", "WireType"]

REPAIR = "correct it: until then, its fields are not checked"
MAKE_KNOWN = (
    "source the setup of the ROS installation or workspace that has its package, or name a folder above the package"
    " with --interface-path or ROBOSC_INTERFACE_PATH; until then, its fields are not checked"
)
#: Hint for the data of a service or action in a place that can only name messages.
OWN_OBJECT = "for the data of a service or action, declare an object with the fields that you use and an enum over it"
#: Default field for a basic value, if its section has several fields.
_DATA = "data"
#: Shipped definitions. Types that are the same in both ROS versions are in the folder `both`.
_SHIPPED = locate("base/ros_types/definitions")
#: Folder of the installations on Ubuntu, and the folder in `share` that shows the version of each.
_INSTALLATIONS = Path("/opt/ros")
_MARKS = {"ROS 2": "ament_index", "ROS 1": "catkin"}
#: Known packages that ROS 1 does not have. An unknown one, such as `tf2_msgs`, may still exist there.
_NOT_IN_ROS_1 = frozenset(
    [
        "action_msgs",
        "example_interfaces",
        "lifecycle_msgs",
        "nav2_msgs",
        "rcl_interfaces",
        "service_msgs",
        "statistics_msgs",
        "type_description_interfaces",
        "unique_identifier_msgs",
    ]
)
_SHIPPED_FOLDERS = {"ROS 2": ("ros2", "both"), "ROS 1": ("ros1", "both")}


class RosDistribution:
    """All types of one ROS version."""

    def __init__(self, ros: str, own: Iterable[Share], installed: Iterable[Share]) -> None:
        """Search the user's own folders of `ros` (`ROS 1` or `ROS 2`), then the installation, then shipped definitions.

        The first folder with a type counts.
        """
        self.name = ros
        self._installed = list(installed)
        self._folders = [*own, *self._installed]
        self._shipped = [Share(_SHIPPED / folder) for folder in _SHIPPED_FOLDERS[ros]]
        self._known: dict[tuple[str, str, Section], Fields | None] = {}
        self._named: dict[tuple[str, str], list[str]] = {}

    @property
    def folders(self) -> list[Path]:
        """The user's own folders and those of the installation."""
        return [share.folder for share in self._folders]

    @cached_property
    def _sources(self) -> list[Share | ShippedTypes]:
        from robosc.base.ros_types.rosbags_types import ShippedTypes  # takes long to load

        return [*self._folders, *self._shipped, ShippedTypes(self.name)]

    def _sources_of(self, package: str) -> list[Share | ShippedTypes]:
        """Return the sources of a package; an installed package needs no shipped definitions."""
        if any(share.defines(package) for share in self._installed):
            return [source for source in self._sources if source not in self._shipped]
        return self._sources

    def fields(self, package: str, name: str, section: Section) -> Fields | None:
        """Return the fields of a section of a type, or None if the type is unknown.

        Raises DefinitionError if the text of the definition cannot be parsed.
        """
        if not (package.isidentifier() and name.isidentifier()):
            return None  # Names become parts of paths.
        key = package, name, section
        if key not in self._known:
            definitions = (source.fields(package, name, section) for source in self._sources_of(package))
            self._known[key] = next((fields for fields in definitions if fields is not None), None)
        return self._known[key]

    def type_at(
        self, package: str, name: str, section: Section, path: Iterable[str]
    ) -> tuple[WireType, Section] | None:
        """Return the type at the end of a path of fields and positions, with its section, or None if unknown."""
        wire_type: WireType | None = NestedType(package, name)
        for step in path:
            if step.isdigit():
                wire_type = wire_type.at(int(step)) if isinstance(wire_type, Sequence) else None
            elif isinstance(wire_type, NestedType):
                try:
                    fields = self.fields(wire_type.package, wire_type.name, section)
                except DefinitionError:
                    return None
                wire_type, section = None if fields is None else fields.get(step), Section.MESSAGE
            else:
                return None
        return None if wire_type is None else (wire_type, section)

    def defines(self, package: str, name: str, section: Section) -> bool:
        """Return whether a section of a type exists, even if its definition is invalid."""
        try:
            return self.fields(package, name, section) is not None
        except DefinitionError:
            return True

    def names(self, package: str, kind: str) -> list[str]:
        """Return the known types of a kind (`message`, `service`, `action`) in a package, sorted by name."""
        key = package, kind
        if key not in self._named:
            self._named[key] = sorted(
                {name for source in self._sources_of(package) for name in source.names(package, kind)}
            )
        return self._named[key]

    def lacks_package(self, package: str) -> bool:
        """Return whether a package exists in the other ROS version only."""
        return self.name == "ROS 1" and package in _NOT_IN_ROS_1 and not self.has_package(package)

    def has_package(self, package: str) -> bool:
        """Return whether a type of a package is known."""
        return any(self.names(package, kind) for kind in FOLDERS)

    def packages(self) -> set[str]:
        """Return the names of all packages with a known type."""
        return {package for source in self._sources for package in source.packages()}


class RosTypes:
    """All types of both ROS versions."""

    def __init__(self, paths: Iterable[str | PathLike[str]] = ()) -> None:
        """Search folders of packages below `paths` before all others."""
        folders = [Path(path) for path in paths] + _environment("ROBOSC_INTERFACE_PATH")
        installed: dict[str, list[Share]] = {
            "ROS 2": [Share(prefix / "share") for prefix in _environment("AMENT_PREFIX_PATH")],
            "ROS 1": [Workspace(folder, "ROS 1") for folder in _environment("ROS_PACKAGE_PATH")],
        }
        installed = {ros: shares or _not_sourced(ros) for ros, shares in installed.items()}
        installed["ROS 1"].append(Share(Path("/usr/share")))  # the location on Debian
        #: ROS 2, then ROS 1.
        self._workspaces = {ros: [Workspace(folder, ros) for folder in folders] for ros in installed}
        self.distributions = [RosDistribution(ros, self._workspaces[ros], shares) for ros, shares in installed.items()]

    def distribution(self, ros: int) -> RosDistribution:
        """Return the types of ROS 1 or ROS 2."""
        return next(known for known in self.distributions if known.name == f"ROS {ros}")

    def field_of_basic(self, package: str, name: str, section: Section) -> str:
        """Return the field that carries a basic value.

        That is the only field of the section in one of the ROS versions, else `data`.
        """
        for distribution in self.distributions:
            try:
                fields = distribution.fields(package, name, section)
            except DefinitionError:
                continue
            if fields is not None and len(fields) == 1:
                return next(iter(fields))
        return _DATA

    def _make_known(self) -> str:
        """Return the hint to make a type known.

        If a folder is too large to be searched, the hint is to name a smaller one.
        """
        large = next((workspace.folder for workspace in self._workspaces["ROS 2"] if workspace.is_too_large), None)
        if large is None:
            return MAKE_KNOWN
        return (
            f"only the first {MOST_FOLDERS:,} folders below `{large}` were searched: "
            "use --interface-path with a folder nearer to the package"
        )

    def constants(self, package: str, name: str, kind: str) -> list[Mapping[str, Value]]:
        """Return the constants of each section of a type of a kind, by name, in the ROS versions that have the type."""
        by_section: list[Mapping[str, Value]] = []
        for distribution in self.distributions:
            for section in Section:
                try:
                    fields = distribution.fields(package, name, section) if section.kind == kind else None
                except DefinitionError:
                    continue
                by_section += [fields.constants] if fields is not None else []
        return by_section

    def other_kinds(self, package: str, name: str, kind: str) -> list[str]:
        """Return the other kinds (`service`, `action`) that have a type of this name."""
        return [
            other
            for other in FOLDERS
            if other != kind and any(name in distribution.names(package, other) for distribution in self.distributions)
        ]

    def _names(self, package: str, kind: str) -> list[str]:
        return sorted({name for known in self.distributions for name in known.names(package, kind)})

    def why_unknown(self, package: str, name: str, section: Section) -> tuple[str, str, tuple[str, str] | None]:
        """Return the reason that no distribution has a section of a type, a hint, and the type that was probably meant.

        The meant type is its package and its name, or None if there is no close match.
        """
        kind = section.kind
        for distribution in self.distributions:
            try:
                distribution.fields(package, name, section)
            except DefinitionError as fault:
                return f"the definition of {package}/{name} cannot be read: {fault}", REPAIR, None
        for other in Section:
            if other.kind != kind and any(known.defines(package, name, other) for known in self.distributions):
                message = f"{package}/{name} is of kind {other.kind}, expected a type of kind {kind}"
                return message, f"name a type of kind {kind}", None
        packages = {package_name for known in self.distributions for package_name in known.packages()}
        having = sorted(other for other in packages if name in self._names(other, kind))
        if not any(known.has_package(package) for known in self.distributions):
            close = get_close_matches(package, having, n=1, cutoff=0.8)
            make_known = self._make_known()
            hint = f"did you mean `{close[0]}`? Else {make_known}" if close else make_known
            return f"the package `{package}` is unknown", hint, (close[0], name) if close else None
        message = f"no {kind} type `{name}` of the package `{package}` is known"
        if len(having) == 1:
            return message, f"did you mean `{having[0]}/{name}`?", (having[0], name)
        close = get_close_matches(name, self._names(package, kind), n=1)
        hint = f"did you mean `{close[0]}`?" if close else self._make_known()
        return message, hint, (package, close[0]) if close else None


def _environment(variable: str) -> list[Path]:
    return [Path(folder) for folder in os.environ.get(variable, "").split(os.pathsep) if folder]


def _not_sourced(ros: str) -> list[Share]:
    """Return the packages of the installations whose setup nobody has sourced, the newest first."""
    shares = [folder / "share" for folder in sorted(_INSTALLATIONS.glob("*"), reverse=True)]
    return [Share(share) for share in shares if (share / _MARKS[ros]).is_dir()]
