"""What decision diagrams say of a supervised system is what its control loop can show."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import robosc
from robosc.engine import ControlLoop
from robosc.metamodel import sct
from robosc.node_tests.coverage import goals
from robosc.node_tests.guide import Guide
from robosc.semantics.roles import event_name
from robosc.synthesis import encoded

if TYPE_CHECKING:
    from robosc.synthesis.encoding import Encoding

EXAMPLES = Path(__file__).parents[2] / "examples"
#: What happens by itself in a control loop, cancels first: they are served after each message and in each tick.
OWN = {sct.EventKind.cancel, sct.EventKind.trigger, sct.EventKind.tau, sct.EventKind.reset, sct.EventKind.data}


def test_what_the_tour_of_the_sprayer_does_not_show_can_not_be_seen() -> None:
    """Seven conditions are false alone only in states where `drive` can be cancelled, which comes before all else.

    And no event of the controller's own leads to such a state from another one: in none does the loop come to rest.
    """
    model = robosc.to_sct(robosc.load(EXAMPLES / "sprayer" / "sprayer.rscd"))
    robosc.synthesize(model)

    def ask(encoding: Encoding) -> list[str]:
        guide = Guide(model, encoding, goals(ControlLoop(model)), {})
        system = guide._system
        (cancel,) = [states for event, states in system.allowed.items() if event.kind == sct.EventKind.cancel]
        for relation, step in system.moves:
            if relation.event.kind in OWN:
                after = step.image(system.controlled & system.allowed[relation.event] & ~cancel)
                assert not (after & system.controlled & cancel).satisfiable(), event_name(relation.event)
        alone = {goal: states for goal, states in guide._where.items() if goal.cause is not None}
        return [event_name(goal.of) for goal, states in alone.items() if not (states & ~cancel).satisfiable()]

    opened = [f"message_{nozzle}_open.c_trigger" for nozzle in ("Left", "Middle", "Right")]
    assert sorted(encoded(model, ask)) == sorted([*opened, *opened, "message_obey.c_trigger"])
