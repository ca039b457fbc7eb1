"""The robots of the examples, each with its supervisor."""

from functools import cache
from pathlib import Path

import robosc
from robosc.m2t.models import Models

EXAMPLES = Path(__file__).parents[2] / "examples"
#: Every model of one robot, by its name; `test_fleet.py` is about the fleet, and `test_guards.py` about the guards.
#: The workspaces contain copies of one of them.
ELSEWHERE = {"workspace", "fleet", "guards"}
MODELS = {path.stem: path for path in sorted(EXAMPLES.rglob("*.rscd")) if not ELSEWHERE & {*path.parts}}
#: Robots of the second edition, with too many states to enumerate.
SHOWCASES = ["sprayer", "warehouse_robot"]
#: All examples: folders with a page.
PAGES = sorted(path.parent.name for path in EXAMPLES.glob("*/README.md") if path.parent.name in MODELS)
#: The eight scenarios of the thesis.
SCENARIOS = [name for name in PAGES if name not in SHOWCASES]


@cache
def models_of(name: str) -> Models:
    """Return the models of an example."""
    robot = robosc.load(MODELS[name])
    plants = robosc.to_sct(robot)
    robosc.synthesize(plants)
    return Models(plants, robosc.to_rosgraph(robot), robot)
