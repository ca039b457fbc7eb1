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
        """The files: relative POSIX path to text. The models have a supervisor and meet the preconditions."""


@dataclass(frozen=True)
class Target:
    """A target: what it is, where its files go below the output folder, and what it reads."""

    name: str
    description: str
    folder: str = ""
    needs_graph: bool = False
    #: The setting in the configuration's `output` that names a folder for a copy of the package.
    location: str | None = None

    def generator(self) -> Generator:
        """The module that generates it; loaded when it is asked for."""
        return cast("Generator", import_module(f"robosc.m2t.{self.name.replace('-', '_')}"))


TARGETS = {
    target.name: target
    for target in (
        Target("cif", "plants and requirements, and the supervised system, in CIF 3"),
        Target("supervisor", "the supervisor and its control loop in C99", "supervisor"),
        Target("ros1", "a controller node for ROS 1", "ros1", True, "ros1_controller_node_location"),
        Target("ros2", "a controller node for ROS 2", "ros2", True, "ros2_controller_node_location"),
        Target("xmi", "the models between the steps"),
    )
}
