"""The rule book of each scenario."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .driving import LineFollower, MazeSolver, ObjectFinder, PersonFollower, PushBall, Stepper
from .navigating import ObstacleNavigation, SimpleNavigation
from .showcases import Sprayer, WarehouseRobot

if TYPE_CHECKING:
    from .judging import RuleBook

BOOKS: dict[str, type[RuleBook]] = {
    "line_follower": LineFollower,
    "simple_navigation": SimpleNavigation,
    "obstacle_navigation": ObstacleNavigation,
    "object_finder": ObjectFinder,
    "maze_solver": MazeSolver,
    "push_ball": PushBall,
    "person_follower": PersonFollower,
    "supervised_line_follower": Stepper,
    "warehouse_robot": WarehouseRobot,
    "sprayer": Sprayer,
}
