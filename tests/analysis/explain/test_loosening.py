"""The states without one requirement are those of the model's text without it."""

from pathlib import Path

import pytest

import robosc
from robosc.analysis.explain.explanations import explore
from robosc.analysis.system import SynthesizedSystem
from robosc.m2m import robosc_to_sct
from robosc.model import expression as ex
from robosc.model import robosc as rsc
from robosc.model.semantics.instances import Instances
from robosc.synthesis import synthesize
from tests.searching import slow_but

EXAMPLES = sorted(
    path for path in (Path(__file__).parents[3] / "examples").glob("*/*.rscd") if path.parent.name != "fleet"
)
#: An action that is canceled if one of two requirements no longer holds.
USHER = Path(__file__).parents[2] / "m2t" / "layer" / "usher.rscd"


@pytest.mark.parametrize(
    "path", slow_but((path.stem for path in EXAMPLES[:4]), [*EXAMPLES, USHER]), ids=lambda path: path.stem
)
def test_without_each_requirement(path: Path) -> None:
    robot = robosc.load(path)
    written = [statement.element for statement in Instances(robot).statements(rsc.Requirement)]
    written = list({requirement.source: requirement for requirement in written}.values())

    def look(system: SynthesizedSystem) -> list[tuple[int, int]]:
        texts = system.group_requirements()
        assert len(texts) == len(written)
        counts = []
        for text in texts:
            other = system.without(frozenset(text))
            left_out = next(requirement for requirement in written if text[0].source == requirement.source)
            counts.append((system.encoding.count(other.controlled), states_without(robot, left_out)))
        return counts

    for left, expected in explore(robosc_to_sct.transform(robot)[0], look):
        assert left == expected


def states_without(robot: rsc.Robot, left_out: rsc.Requirement) -> int:
    """Count the states if the requirement is always true but keeps its references."""
    condition = left_out.condition
    if isinstance(left_out, rsc.DisablesRequirement) or getattr(left_out, "kind", None) == rsc.InvariantKind.never:
        left_out.condition = ex.Conjunction(left=condition, right=ex.BooleanLiteral(value=False))
    else:
        left_out.condition = ex.Disjunction(left=condition, right=ex.BooleanLiteral(value=True))
    try:
        return synthesize(robosc_to_sct.transform(robot)[0]).controlled_states
    finally:
        left_out.condition = condition
