"""Gives a model its supervisor, or says why there is none."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.diagnostics import Diagnostic, ModelError, Severity
from robosc.metamodel.places import place
from robosc.synthesis import Synthesis, synthesize

if TYPE_CHECKING:
    from robosc.metamodel import sct


class EmptySupervisorError(ModelError):
    """No behaviour of the robot keeps to its requirements; `synthesis.reason` says why."""

    def __init__(self, model: sct.SupervisoryControlModel, synthesis: Synthesis) -> None:
        self.synthesis = synthesis
        assert synthesis.reason is not None
        reason = synthesis.reason
        trace = f"; a shortest trace: {', '.join(map(str, reason.trace))}" if reason.trace else ""
        file, span = place(reason.event or model)
        message = f"the supervisor is empty: {reason.message}{trace}"
        super().__init__([Diagnostic(file, span, Severity.ERROR, "empty-supervisor", message)])


def supervise(model: sct.SupervisoryControlModel) -> Synthesis:
    """Synthesizes the supervisor of a model and makes it the model's own.

    Raises EmptySupervisorError where there is none, ModelError and MemoryError as `robosc.synthesis.synthesize` does.
    """
    synthesis = synthesize(model)
    if synthesis.supervisor is None:
        raise EmptySupervisorError(model, synthesis)
    model.supervisor = synthesis.supervisor
    return synthesis
