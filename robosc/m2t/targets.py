"""The targets. Each is a part of `robosc.m2t` of its name; ROS packages share `ros`.

Other packages add targets by entry points (`robosc.targets`).
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any, Literal, Protocol, TypedDict, cast

from robosc.base.extensions import Extension, extensions

if TYPE_CHECKING:
    from contextlib import AbstractContextManager
    from typing import Unpack

    from robosc.base.diagnostics import Diagnostic
    from robosc.language.configuration import Configuration
    from robosc.m2t.models import Models, TraceTest


class Generator(Protocol):
    """Interface of a target's module."""

    def preconditions(self, models: Models, configuration: Configuration) -> list[Diagnostic]:
        """Return errors that make the target impossible for these models, and warnings."""

    def generate(self, models: Models, configuration: Configuration) -> dict[str, str]:
        """Return files: POSIX path in the target's folder to text.

        Preconditions: the models have a supervisor, and `preconditions` reports no error.
        """


class Options(TypedDict, total=False):
    """Options of some generators."""

    #: Tests for a generated package.
    tests: TraceTest
    #: Package, or CMake target, of the user that includes the generated code.
    into: str


class OptionalGenerator(Protocol):
    """Interface of the module of a target with options."""

    def generate(self, models: Models, configuration: Configuration, **options: Unpack[Options]) -> dict[str, str]:
        """Return the same files as without options, changed by the options."""


class PackageGenerator(Protocol):
    """Interface of the module of a target that is a ROS package."""

    def interfaces(self, models: Models, configuration: Configuration) -> dict[str, str]:
        """Return the package with its own types, if it needs one. Paths start with the package's name."""


@dataclass(frozen=True)
class Target:
    """A target: its description, its input, and the folder of its files."""

    name: str
    description: str
    #: Folder below the output folder. A ROS package has its own folder inside it.
    _folder: str = ""
    #: Kind of ROS package, if it is one, and its ROS version, 1 or 2.
    package: Literal["controller", "layer"] | None = None
    ros: int | None = None
    #: Setting in the configuration's `output` that names a folder for a copy.
    location: str | None = None

    @property
    def can_be_included(self) -> bool:
        """Whether the code can become part of a user's package or CMake project."""
        return bool(self._folder)

    @property
    def needs_graph(self) -> bool:
        """Whether it reads the ROS graph as well as the sct model."""
        return self.package is not None

    def folder(self, models: Models, configuration: Configuration) -> str:
        """Return the folder of the target's files below the output folder, as a POSIX path.

        The path is empty for the output folder itself. ROS packages of several robots share one folder, which can be a
        workspace's `src`.
        """
        if self.package is None:
            return self._folder
        named = configuration.layer_name if self.package == "layer" else configuration.package_name
        return f"{self._folder}/{named(models.sct)}"

    def beside(self, models: Models, configuration: Configuration) -> dict[str, str]:
        """Return the files outside of the target's folder, by POSIX path below the output folder."""
        if self.package is None:
            return {}
        texts = cast("PackageGenerator", self.generator()).interfaces(models, configuration)
        return {f"{self._folder}/{path}": text for path, text in texts.items()}

    def findings(self, models: Models, configuration: Configuration) -> list[Diagnostic]:
        """Return errors that make the target impossible for these models and settings, and warnings."""
        findings = self.generator().preconditions(models, configuration)
        graph = models.rosgraph
        if not self.needs_graph or graph is None:
            return findings
        names = [topic.topic for topics in (graph.subscriptions, graph.publishers) for topic in topics]
        for users in (graph.serviceClients, graph.actionClients, graph.serviceServers, graph.actionServers):
            names += [user.identifier for user in users]
        return [*findings, *configuration.unknown_names([name.removeprefix("/") for name in names])]

    @property
    def tested_ros(self) -> int | None:
        """ROS version, 1 or 2, in which traces can test its packages. None if they cannot."""
        return self.ros if self.package == "controller" else None

    def files(
        self,
        models: Models,
        configuration: Configuration,
        tests: TraceTest | None = None,
        *,
        into: str | None = None,
    ) -> dict[str, str]:
        """Generate the texts, with these tests.

        `into` names the user's package or CMake target that includes the code, if that is possible. The result then has
        a `fragment.cmake`, and neither `CMakeLists.txt` nor `package.xml`.
        """
        options: Options = {}
        if tests is not None:
            options["tests"] = tests
        if into is not None:
            options["into"] = into
        return cast("OptionalGenerator", self.generator()).generate(models, configuration, **options)

    def generator(self) -> Generator:
        """Return the generator: a module of its name, or a target of `robosc.m2t.ros`. It is loaded on first use."""
        if self.package is None:
            return cast("Generator", import_module(f"robosc.m2t.{self.name}"))
        return cast("Generator", import_module("robosc.m2t.ros").TARGETS[self.name])


TARGETS = {
    target.name: target
    for target in (
        Target("cif", "plants and requirements, and the supervised system, in CIF 3"),
        Target("supervisor", "the supervisor and its control loop in C99", "supervisor"),
        Target("ros1", "a controller node for ROS 1", "ros1", "controller", 1, "ros1_controller_node_location"),
        Target("ros2", "a controller node for ROS 2", "ros2", "controller", 2, "ros2_controller_node_location"),
        Target(
            "ros2-layer",
            "a supervisory layer before a controller for ROS 2",
            "ros2",
            "layer",
            2,
            "ros2_supervisor_node_location",
        ),
        Target("xmi", "the models between the steps"),
    )
}


@dataclass(frozen=True)
class ExtensionTarget(Target):
    """A target of another package: a module with `preconditions`, `generate`, and optionally `needs_graph`."""

    extension: Extension | None = None

    @property
    def can_be_included(self) -> bool:
        """Whether the code can be included: never, since plug-ins do not support it."""
        return False

    @property
    def needs_graph(self) -> bool:
        """Whether the module has `needs_graph = True`."""
        return bool(getattr(self._module, "needs_graph", False))

    @property
    def _module(self) -> Any:
        assert self.extension is not None
        return self.extension.load("preconditions", "generate")

    def generator(self) -> Generator:
        """Return the module. Its errors are reported as those of the extension."""
        assert self.extension is not None
        return _Guarded(self.extension, self._module)


@dataclass(frozen=True)
class _Guarded:
    """The module of an extension. Its exceptions and its results against the contract become findings."""

    extension: Extension
    module: Any

    def preconditions(self, models: Models, configuration: Configuration) -> list[Diagnostic]:
        with self.extension.report_exceptions():
            return list(self.module.preconditions(models, configuration))

    def generate(self, models: Models, configuration: Configuration) -> dict[str, str]:
        with self.extension.report_exceptions():
            files = dict(self.module.generate(models, configuration))
        for path, text in files.items():
            relative = isinstance(path, str) and not PurePosixPath(path).is_absolute() and ".." not in path.split("/")
            if not relative or not isinstance(text, str):
                raise self.extension.fault(f"it returns {path!r}, which is not a relative path with a text")
        return files


def targets() -> dict[str, Target]:
    """Return all targets by name: those of the tool, and those of other installed packages."""
    others = extensions("robosc.targets").values()
    extension_targets = (
        ExtensionTarget(other.name, other.description, other.name, extension=other) for other in others
    )
    return TARGETS | {target.name: target for target in extension_targets if target.name not in TARGETS}


def together() -> AbstractContextManager[None]:
    """Cache the results that several targets share. Models must not change in this context."""
    from robosc.base.cache import cache_results

    return cache_results()
