"""Supervisors from other synthesis tools."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.analysis.system import GuardedSystem
from robosc.base.diagnostics import Diagnostic, ModelError, Severity
from robosc.model import sct
from robosc.model.places import place
from robosc.model.semantics.roles import event_name
from robosc.model.validity import faults
from robosc.synthesis import MEMORY, Statistics, Synthesis, use_encoding

if TYPE_CHECKING:
    from robosc.base.extensions import Extension
    from robosc.synthesis.encoding import Encoding


def supervise_by(extension: Extension, model: sct.SupervisoryControlModel, *, memory: int = MEMORY) -> Synthesis:
    """Give the model the supervisor that the function `synthesize` of another package returns for it.

    Only its guards are used, and they are only checked to be well-formed: one for each controllable event. States are
    counted again. Raises ModelError if the package fails or finds no supervisor, and MemoryError if decision diagrams
    take more than `memory` bytes.
    """
    module = extension.load("synthesize")
    model.supervisor = None
    with extension.report_exceptions():
        supervisor = module.synthesize(model)
    if supervisor is None:
        message = f"the supervisor is empty: `{extension.name}` finds no supervisor"
        hint = "without --synthesizer, robosc reports the reason"
        raise ModelError([Diagnostic(*place(model), Severity.ERROR, "empty-supervisor", message, hint)])
    _check(extension, model, supervisor)

    def look(encoding: Encoding) -> Synthesis:
        system = GuardedSystem(model, encoding)
        for guard in supervisor.guards:
            guard.everEnabled = (system.controlled & system.allowed[guard.event]).satisfiable()
        possible = (event for event in system.relations if (system.controlled & system.allowed[event]).satisfiable())
        supervisor.controlledStates = encoding.count(system.controlled)
        return Synthesis(supervisor, None, supervisor.controlledStates, 0, Statistics(), tuple(possible))

    return use_encoding(model, look, memory)


def _check(extension: Extension, model: sct.SupervisoryControlModel, supervisor: object) -> None:
    """Check the supervisor and assign it to the model."""
    if not isinstance(supervisor, sct.Supervisor):
        raise extension.fault(f"it returns a {type(supervisor).__name__}, not a supervisor")
    controllable = [event for plant in model.plants for event in plant.events if event.controllable]
    guards = {guard.event: guard for guard in supervisor.guards}
    if len(supervisor.guards) != len(controllable) or set(guards) != set(controllable):
        missing = next((event_name(event) for event in controllable if event not in guards), None)
        difference = f"it has none for `{missing}`" if missing else "it has other guards"
        raise extension.fault(f"a supervisor has one guard for each controllable event, and {difference}")
    supervisor.guards = [guards[event] for event in controllable]
    supervisor.settlingBound = None
    supervisor.controlledStates = supervisor.bddNodes = 0
    model.supervisor = supervisor
    fault = next(faults(model), None)
    if fault is not None:
        model.supervisor = None
        raise extension.fault(f"its supervisor does not fit this model: {fault[1]}")
