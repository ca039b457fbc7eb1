"""No dead events: whatever the controller may do by the model, it can do somewhere."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.analysis.supervision.wording import listed, words
from robosc.analysis.verification.system import counted
from robosc.analysis.verification.verdict import Outcome, Verdict
from robosc.metamodel import sct

if TYPE_CHECKING:
    from robosc.analysis.verification.system import SupervisedSystem

NAME = "no dead events"
#: An action that is restricted by nothing that changes is never cancelled, and data may always be at hand: of cancels
#: and data events, which no user wrote, some are dead on purpose.
_LIVE = (sct.EventKind.trigger, sct.EventKind.reset, sct.EventKind.tau)


def no_dead_events(system: SupervisedSystem) -> Verdict:
    """Each trigger, each silent transition and each reset can happen in some reachable state."""
    controllable = [each for each in system.relations if each.event.kind in _LIVE]
    dead = [each.event for each in controllable if not (system.reachable & system.allowed[each]).satisfiable()]
    evidence = f"{system.size}, {counted(len(controllable), 'event')}"
    if not dead:
        return Verdict(NAME, Outcome.PROVED, evidence)
    return Verdict(NAME, Outcome.REFUTED, evidence, f"{listed([words(each) for each in dead])} can never happen")
