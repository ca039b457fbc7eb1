"""The control loop reaches every condition that decision diagrams report as reachable."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import robosc
from robosc.engine import ControlLoop
from robosc.model import sct
from robosc.model.semantics.roles import event_name
from robosc.run.node_tests.coverage import goals
from robosc.run.node_tests.guide import Guide
from robosc.synthesis import use_encoding

if TYPE_CHECKING:
    from robosc.synthesis.encoding import Encoding

EXAMPLES = Path(__file__).parents[3] / "examples"


@pytest.mark.slow
def test_every_condition_of_the_sprayer_can_be_seen() -> None:
    """Each condition is false alone in a state without a due cancel, since `drive` runs until its goal ends.

    A cancel comes before all else: no tick and no message reaches the controller while one is due.
    """
    model = robosc.to_sct(robosc.load(EXAMPLES / "sprayer" / "sprayer.rscd"))
    robosc.synthesize(model)

    def ask(encoding: Encoding) -> tuple[int, list[str]]:
        guide = Guide(model, encoding, goals(ControlLoop(model)), {})
        (cancel,) = [states for event, states in guide._system.allowed.items() if event.kind == sct.EventKind.cancel]
        alone = {goal: states for goal, states in guide._where.items() if goal.cause is not None}
        return len(alone), [
            event_name(goal.of) for goal, states in alone.items() if not (states & ~cancel).satisfiable()
        ]

    count, unseen = use_encoding(model, ask)
    assert count > 7
    assert unseen == []
