"""What can be generated: each target is a room of `robosc.m2t`, found by its name."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Protocol, cast

if TYPE_CHECKING:
    from robosc.config import Configuration
    from robosc.diagnostics import Diagnostic
    from robosc.models import Models


class Generator(Protocol):
    """What the module of a target offers."""

    def preconditions(self, models: Models, configuration: Configuration) -> list[Diagnostic]:
        """What keeps the target from these models, or is doubtful about them."""

    def generate(self, models: Models, configuration: Configuration) -> dict[str, str]:
        """Files: POSIX path in the target's folder to text. The models have a supervisor; the preconditions hold."""


@dataclass(frozen=True)
class Target:
    """A target: what it is, what it reads, and where its files go."""

    name: str
    description: str
    _folder: str = ""
    #: The setting in the configuration's `output` that names a folder for a copy, of a target that is a ROS package.
    location: str | None = None

    @property
    def needs_graph(self) -> bool:
        """Whether it reads the ROS graph beside the sct model."""
        return self.location is not None

    def folder(self, models: Models, configuration: Configuration) -> str:
        """Where its files go below the output folder: POSIX path, empty for that folder itself.

        ROS packages stand beside those of other robots in one folder, so that this can be a workspace's `src`.
        """
        return f"{self._folder}/{configuration.package_name(models.sct)}" if self.location else self._folder

    def findings(self, models: Models, configuration: Configuration) -> list[Diagnostic]:
        """What keeps the target from these models and settings, and what is doubtful about them."""
        found = self.generator().preconditions(models, configuration)
        graph = models.rosgraph
        if not self.needs_graph or graph is None:
            return found
        topics = [each.topic for each in graph.subscriptions] + [each.topic for each in graph.publishers]
        topics += [each.identifier for each in graph.serviceClients] + [each.identifier for each in graph.actionClients]
        messages = [each.name for publisher in graph.publishers for each in publisher.sendings]
        return [*found, *configuration.unknown_names([each.removeprefix("/") for each in topics], messages)]

    def generator(self) -> Generator:
        """The module that generates it; loaded when it is asked for."""
        return cast("Generator", import_module(f"robosc.m2t.{self.name.replace('-', '_')}"))


TARGETS = {
    target.name: target
    for target in (
        Target("cif", "plants and requirements, and the supervised system, in CIF 3"),
        Target("supervisor", "the supervisor and its control loop in C99", "supervisor"),
        Target("ros1", "a controller node for ROS 1", "ros1", "ros1_controller_node_location"),
        Target("ros2", "a controller node for ROS 2", "ros2", "ros2_controller_node_location"),
        Target("xmi", "the models between the steps"),
    )
}
