"""The models of one robot that a generator can read."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robosc.metamodel import robosc, rosgraph, sct


@dataclass(frozen=True)
class Models:
    """The models of one robot: what the supervisor sees, the ROS side of it, and the model that both came from."""

    sct: sct.SupervisoryControlModel
    rosgraph: rosgraph.RosGraph | None = None
    robosc: robosc.Base | None = None
