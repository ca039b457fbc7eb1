"""The models of one robot that a generator can read."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.m2m import sct_to_engine

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from robosc.metamodel import engine, robosc, rosgraph, sct
    from robosc.ros_types import RosTypes


@dataclass(frozen=True)
class Models:
    """The models of one robot: what the supervisor sees, the ROS side of it, and the model that both came from.

    `ros_types` are the definitions of ROS types that they were read with; None: those of the environment.
    `folder` is where the texts go that are generated from them, where that is known.
    """

    sct: sct.SupervisoryControlModel
    rosgraph: rosgraph.RosGraph | None = None
    robosc: robosc.Base | None = None
    ros_types: RosTypes | None = None
    folder: Path | None = None

    @property
    def engine(self) -> engine.EngineModel:
        """What a controller executes: made anew each time, but within `robosc.m2t.targets.together` once.

        Raises ValueError where the model has no supervisor, or one without a guard for a controllable event.
        """
        return sct_to_engine.transform(self.sct)


@dataclass(frozen=True)
class TraceTest:
    """What a package needs to be tested with traces: parameters for its node, and files for its folder `test`."""

    parameters: Mapping[str, bool | int]
    files: Mapping[str, str]
    #: How much of the robot its traces show, in words, and what they miss.
    coverage: str
    missed: Sequence[str]
