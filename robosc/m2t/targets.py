"""The targets: each is a part of `robosc.m2t` of its name; those that are ROS packages share `ros`.

Packages of others add targets by entry points (`robosc.targets`).
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any, Literal, Protocol, TypedDict, cast

from robosc.extensions import Extension, extensions

if TYPE_CHECKING:
    from contextlib import AbstractContextManager
    from typing import Unpack

    from robosc.configuration import Configuration
    from robosc.diagnostics import Diagnostic
    from robosc.m2t.models import Models, TraceTest


class Generator(Protocol):
    """The interface of a target's module."""

    def preconditions(self, models: Models, configuration: Configuration) -> list[Diagnostic]:
        """Return the findings that keep the target from these models, or warn of them."""

    def generate(self, models: Models, configuration: Configuration) -> dict[str, str]:
        """Files: POSIX path in the target's folder to text. The models have a supervisor; the preconditions hold."""


class Options(TypedDict, total=False):
    """Options of some generators."""

    #: What a package of theirs is tested with.
    tests: TraceTest
    #: The package, or the target of CMake, of the user's own that their code becomes part of.
    into: str


class OptionalGenerator(Protocol):
    """The interface of the module of a target with options."""

    def generate(self, models: Models, configuration: Configuration, **options: Unpack[Options]) -> dict[str, str]:
        """The files that it generates without options, but as these ask for."""


class PackageGenerator(Protocol):
    """The interface of the module of a target that is a ROS package."""

    def interfaces(self, models: Models, configuration: Configuration) -> dict[str, str]:
        """The package with the types of its own, if it needs any: paths begin with its name."""


@dataclass(frozen=True)
class Target:
    """A target: what it is, what it reads, and where its files go."""

    name: str
    description: str
    #: Its folder below the output folder; a ROS package has a folder of its own in there.
    _folder: str = ""
    #: What kind of ROS package it is, if it is one, and for which ROS, 1 or 2.
    package: Literal["controller", "layer"] | None = None
    ros: int | None = None
    #: The setting in the configuration's `output` that names a folder for a copy.
    location: str | None = None

    @property
    def can_be_included(self) -> bool:
        """Whether it is code that can become part of a package, or of a project of CMake, of the user's own."""
        return bool(self._folder)

    @property
    def needs_graph(self) -> bool:
        """Whether it reads the ROS graph beside the sct model."""
        return self.package is not None

    def folder(self, models: Models, configuration: Configuration) -> str:
        """Where its files go below the output folder: POSIX path, empty for that folder itself.

        ROS packages stand beside those of other robots in one folder, so that this can be a workspace's `src`.
        """
        if self.package is None:
            return self._folder
        named = configuration.layer_name if self.package == "layer" else configuration.package_name
        return f"{self._folder}/{named(models.sct)}"

    def beside(self, models: Models, configuration: Configuration) -> dict[str, str]:
        """The texts beside that folder, by POSIX path below the output folder."""
        if self.package is None:
            return {}
        made = cast("PackageGenerator", self.generator()).interfaces(models, configuration)
        return {f"{self._folder}/{path}": text for path, text in made.items()}

    def findings(self, models: Models, configuration: Configuration) -> list[Diagnostic]:
        """Return the findings that keep the target from these models and settings, and warnings."""
        found = self.generator().preconditions(models, configuration)
        graph = models.rosgraph
        if not self.needs_graph or graph is None:
            return found
        names = [topic.topic for topics in (graph.subscriptions, graph.publishers) for topic in topics]
        names += [service.identifier for service in graph.serviceClients]
        names += [action.identifier for action in graph.actionClients]
        return [*found, *configuration.unknown_names([name.removeprefix("/") for name in names])]

    @property
    def tested_ros(self) -> int | None:
        """The ROS, 1 or 2, on which its packages can be tested with traces; None where they can't."""
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

        `into` names what of the user's own the code becomes part of, where it can be included: a package, or a target
        of CMake. Then there is a `fragment.cmake`, and neither `CMakeLists.txt` nor `package.xml`.
        """
        options: Options = {}
        if tests is not None:
            options["tests"] = tests
        if into is not None:
            options["into"] = into
        return cast("OptionalGenerator", self.generator()).generate(models, configuration, **options)

    def generator(self) -> Generator:
        """The generator: a module of its name, or a target of `robosc.m2t.ros`; loaded on first use."""
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
    """A target of another package: a module with `preconditions` and `generate`, and perhaps `needs_graph = True`."""

    extension: Extension | None = None

    @property
    def can_be_included(self) -> bool:
        """Not called for this target."""
        return False

    @property
    def needs_graph(self) -> bool:
        """Whether the module says so."""
        return bool(getattr(self._module, "needs_graph", False))

    @property
    def _module(self) -> Any:
        assert self.extension is not None
        return self.extension.load("preconditions", "generate")

    def generator(self) -> Generator:
        """The module, whose faults are told as such."""
        assert self.extension is not None
        return _Guarded(self.extension, self._module)


@dataclass(frozen=True)
class _Guarded:
    """The module of an extension: what it raises, or gives back against the contract, is a finding."""

    extension: Extension
    module: Any

    def preconditions(self, models: Models, configuration: Configuration) -> list[Diagnostic]:
        with self.extension.working():
            return list(self.module.preconditions(models, configuration))

    def generate(self, models: Models, configuration: Configuration) -> dict[str, str]:
        with self.extension.working():
            files = dict(self.module.generate(models, configuration))
        for path, text in files.items():
            relative = isinstance(path, str) and not PurePosixPath(path).is_absolute() and ".." not in path.split("/")
            if not relative or not isinstance(text, str):
                raise self.extension.fault(f"it gives {path!r}, which is no relative path with a text")
        return files


def targets() -> dict[str, Target]:
    """All targets by name: those of the tool, and those of other packages that are installed."""
    others = extensions("robosc.targets").values()
    made = (ExtensionTarget(other.name, other.description, other.name, extension=other) for other in others)
    return TARGETS | {target.name: target for target in made if target.name not in TARGETS}


def together() -> AbstractContextManager[None]:
    """While it lasts, what several targets have in common is made once; nobody changes the models meanwhile."""
    from robosc.m2m.remembering import remembered

    return remembered()
