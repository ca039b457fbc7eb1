"""What ROS knows of the types that interfaces name.

A definition is looked for in the folders of the call, in those of ROBOSC_INTERFACE_PATH, in the ROS installation of the
computer, and among the standard types. Both ROS are asked: they disagree about some types.
"""

from __future__ import annotations

import os
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING

from robosc.files.resources import locate
from robosc.ros_types.folders import Share, Workspace
from robosc.ros_types.wire import DefinitionError, Fields, Part, WireType

if TYPE_CHECKING:
    from collections.abc import Iterable
    from os import PathLike

__all__ = ["DefinitionError", "Edition", "Fields", "Interfaces", "Part", "WireType"]

#: The field that holds a basic value of a part with several fields.
_DATA = "data"
_SHIPPED = locate("ros_types/definitions")


class Edition:
    """All types as one of the two ROS has them."""

    def __init__(self, ros: str, sources: Iterable[Share]) -> None:
        """`ros` is `ROS 1` or `ROS 2`; of several `sources` with a type the first one counts."""
        self.name = ros
        self._sources = list(sources)
        self._known: dict[tuple[str, str, Part], Fields | None] = {}
        self._named: dict[tuple[str, str], list[str]] = {}

    def fields(self, package: str, name: str, part: Part) -> Fields | None:
        """The fields of a part of a type; None where the type is unknown.

        Raises DefinitionError where the text of the definition can't be read.
        """
        if not (package.isidentifier() and name.isidentifier()):
            return None  # Names are parts of paths.
        key = package, name, part
        if key not in self._known:
            self._known[key] = self._find(package, name, part)
        return self._known[key]

    def _find(self, package: str, name: str, part: Part) -> Fields | None:
        for source in self._sources:
            found = source.fields(package, name, part)
            if found is not None:
                return found
        from robosc.ros_types import type_stores  # loads rosbags

        return type_stores.fields(self.name, package, name, part)

    def names(self, package: str, kind: str) -> list[str]:
        """The names of the types of a kind (`message`, `service`, `action`) that are known of a package, in order."""
        key = package, kind
        if key not in self._named:
            from robosc.ros_types import type_stores

            found = chain.from_iterable(source.names(package, kind) for source in self._sources)
            self._named[key] = sorted({*found, *type_stores.names(self.name, package, kind)})
        return self._named[key]

    def packages(self) -> set[str]:
        """The names of all packages of which a type is known."""
        from robosc.ros_types import type_stores

        return type_stores.packages(self.name).union(*(source.packages() for source in self._sources))


class Interfaces:
    """All types of both ROS."""

    def __init__(self, paths: Iterable[str | PathLike[str]] = ()) -> None:
        """`paths` are folders with packages below them, searched before all others."""
        given = [Path(each) for each in paths] + _environment("ROBOSC_INTERFACE_PATH")
        installed = {
            "ROS 2": [Share(each / "share") for each in _environment("AMENT_PREFIX_PATH")],
            "ROS 1": [
                *(Workspace(each, "ROS 1") for each in _environment("ROS_PACKAGE_PATH")),
                Share(Path("/usr/share")),  # where Debian installs it
            ],
        }
        #: ROS 2, then ROS 1.
        self.editions = [
            Edition(ros, [*(Workspace(each, ros) for each in given), *shares, Share(_SHIPPED)])
            for ros, shares in installed.items()
        ]

    def field_of_basic(self, package: str, name: str, part: Part) -> str:
        """The field in which a basic value travels: the only one of the part in one of the two ROS, else `data`."""
        for edition in self.editions:
            try:
                fields = edition.fields(package, name, part)
            except DefinitionError:
                continue
            if fields is not None and len(fields) == 1:
                return next(iter(fields))
        return _DATA


def _environment(variable: str) -> list[Path]:
    return [Path(each) for each in os.environ.get(variable, "").split(os.pathsep) if each]
