"""Files that a client may name: only those below folders of the user."""

from __future__ import annotations

from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from robosc.base.files.reading import read_only_below
from robosc.base.files.resources import locate
from robosc.base.ros_types import RosTypes
from robosc.language.libraries import search_folders
from robosc.tools.cli import CallError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence


class Folders:
    """Folders of the user. Relative paths start at the first one."""

    def __init__(self, folders: Iterable[str]) -> None:
        self.roots = [Path(folder).resolve() for folder in folders]

    def inside(self, path: str, suffixes: Sequence[str] = ()) -> str:
        """Return a path that does not lead out of the folders, as the client wrote it.

        Links and `..` may lead from one place below a folder to another. Raises CallError, also if the path ends with
        none of the suffixes.
        """
        try:
            real = Path(self.roots[0], path).resolve()
            is_inside = any(real.is_relative_to(root) for root in self.roots)
        except (OSError, ValueError, RuntimeError):  # a null character, or circular links
            is_inside = False
        if not is_inside:
            names = " and ".join(map(str, self.roots))
            raise CallError(f"{path} is outside of the folders of this server: name a file below {names}")
        if suffixes and not path.endswith(tuple(suffixes)):
            raise CallError(f"{path} must end with {' or '.join(suffixes)}")
        return path

    def file(self, path: str, suffixes: Sequence[str]) -> str:
        """Return the path of an existing file, as `inside` does."""
        if not Path(self.roots[0], self.inside(path, suffixes)).is_file():
            raise CallError(f"there is no file {path}; relative paths start at {self.roots[0]}")
        return path

    @contextmanager
    def guarded(self, libraries: Sequence[str], interfaces: Sequence[str]) -> Iterator[None]:
        """Read only files below these folders in the `with` block.

        Further files are those of the tool itself, and those in folders that the user has named in the command line or
        in the environment for libraries and ROS types.
        """
        types = [folder for known in RosTypes(interfaces).distributions for folder in known.folders]
        with read_only_below(self.roots, [*search_folders(libraries), *types, locate("stdlib").parent]):
            yield
