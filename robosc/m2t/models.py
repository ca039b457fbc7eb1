"""Models of one robot for a generator."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.m2m import sct_to_engine

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from robosc.base.ros_types import RosTypes
    from robosc.model import engine, robosc, rosgraph, sct


@dataclass(frozen=True)
class Models:
    """The models of one robot: the supervisor's view, the ROS side, and the source of both.

    `ros_types` are the ROS types that the models were read with; None: those of the environment. `folder` is the folder
    of the generated texts, if it is known.
    """

    sct: sct.SupervisoryControlModel
    rosgraph: rosgraph.RosGraph | None = None
    robosc: robosc.Base | None = None
    ros_types: RosTypes | None = None
    folder: Path | None = None

    @property
    def engine(self) -> engine.EngineModel:
        """Program of the controller, newly created on each access; within `robosc.m2t.targets.together`, created once.

        Raises ValueError if the model has no supervisor, or a supervisor without a guard for a controllable event.
        """
        return sct_to_engine.transform(self.sct)


@dataclass(frozen=True)
class TraceTest:
    """Test of a package with traces: parameters of its node, and files for its folder `test`."""

    parameters: Mapping[str, bool | int]
    files: Mapping[str, str]
    #: Share of the robot that the traces cover, in words, and the parts that they miss.
    coverage: str
    missed: Sequence[str]
