"""Changes without effect on a robot leave its generated files unchanged."""

from pathlib import Path

import pytest

import robosc
from robosc.m2t.models import Models
from robosc.m2t.targets import TARGETS

MODEL = Path(__file__).parents[2] / "examples/supervised_line_follower/supervised_line_follower.rscd"


@pytest.mark.parametrize("target", sorted(set(TARGETS) - {"xmi"}))
def test_a_comment_changes_nothing(target: str, tmp_path: Path) -> None:
    changed = tmp_path / MODEL.name
    text = MODEL.read_text(encoding="utf-8")
    changed.write_text(f"// What it is for.\n\n{text.replace('requirement', '  requirement')}", encoding="utf-8")
    plain, commented = (robosc.generate(target, _models(path)) for path in (MODEL, changed))
    assert plain == commented


def _models(path: Path) -> Models:
    robot = robosc.load(path)
    made = robosc.to_sct(robot)
    robosc.synthesize(made)
    return Models(made, robosc.to_rosgraph(robot))
