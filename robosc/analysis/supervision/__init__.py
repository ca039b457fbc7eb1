"""Gives a model its supervisor, or says why there is none, and what is doubtful about it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.analysis.supervision.findings import findings_of
from robosc.analysis.supervision.wording import blocking, forbid, in_words, trouble_in_words
from robosc.diagnostics import Diagnostic, ModelError, Severity, has_errors
from robosc.metamodel.places import place
from robosc.semantics.recursion import deep_recursion
from robosc.synthesis import MEMORY, Statistics, Synthesis, synthesize

if TYPE_CHECKING:
    from robosc.metamodel import sct


@dataclass(frozen=True)
class Supervision:
    """The result of synthesis, and what its rules find."""

    synthesis: Synthesis
    findings: list[Diagnostic]


class EmptySupervisorError(ModelError):
    """No behaviour of the robot keeps to its requirements; `synthesis.reason` says why."""

    def __init__(self, model: sct.SupervisoryControlModel, synthesis: Synthesis) -> None:
        self.synthesis = synthesis
        assert synthesis.reason is not None
        reason = synthesis.reason
        trace = f"; a shortest trace: {in_words(reason.trace, model)}" if reason.trace else ""
        file, span = place(reason.event or model)
        message = f"the supervisor is empty: {blocking(reason)}{trace}"
        if reason.requirements and not (reason.event and reason.event.controllable):
            message += f"; from there on {forbid(reason.requirements, 'something')}"
        hint = (
            "loosen a requirement, or give every component a way back to a marked state; `robosc explain --why-empty`"
            " tells more"
        )
        super().__init__([Diagnostic(file, span, Severity.ERROR, "empty-supervisor", message, hint)])


@deep_recursion()
def supervise(
    model: sct.SupervisoryControlModel, *, memory: int = MEMORY, statistics: Statistics | None = None
) -> Supervision:
    """Synthesizes the supervisor of a model, and makes it the model's own unless the findings have an error.

    Its guards say why synthesis added something, where that is told at reasonable cost.

    `memory` and `statistics` are those of `robosc.synthesis.synthesize`. Raises EmptySupervisorError where there is no
    supervisor, ModelError and MemoryError as it does.
    """
    synthesis = synthesize(model, memory=memory, statistics=statistics)
    if synthesis.observations is None:
        raise EmptySupervisorError(model, synthesis)
    found = findings_of(model, synthesis.observations)
    assert synthesis.supervisor is not None
    for guard in synthesis.supervisor.guards:
        trouble = synthesis.observations.troubles.get(guard.event)
        if trouble is not None:
            guard.explanation = trouble_in_words(trouble, model)
    if not has_errors(found):
        model.supervisor = synthesis.supervisor
    return Supervision(synthesis, found)
