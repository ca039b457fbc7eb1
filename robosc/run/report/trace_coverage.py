"""Plays the traces of generated tests on the interpreter, and records their coverage."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from robosc.engine.transitions import Transitions
from robosc.model import engine, sct
from robosc.model.semantics.edges import edges_of
from robosc.model.semantics.roles import event_name
from robosc.run.simulation import Simulation
from robosc.run.simulation.script import read_script

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robosc.engine import Engine
    from robosc.m2t.models import Models

#: Roles of events that the controller decides by itself.
_DECIDED = (engine.Role.cancel, engine.Role.trigger, engine.Role.silent)


@dataclass
class TraceCoverage:
    """Coverage of traces, over all states that they reach, including the first and the last."""

    #: Number of states in which the guard of each event was true, and false.
    enabled: Counter[str] = field(default_factory=Counter)
    disabled: Counter[str] = field(default_factory=Counter)
    #: First place at which each requirement allowed an event that the plants could do, and at which it forbade it.
    allowed: dict[sct.Requirement, tuple[str, int]] = field(default_factory=dict)
    forbidden: dict[sct.Requirement, tuple[str, int]] = field(default_factory=dict)
    taken: set[sct.Edge] = field(default_factory=set)
    states: int = 0
    events: int = 0

    def coverage(self, model: sct.SupervisoryControlModel, executed: engine.EngineModel) -> dict[str, Any]:
        """Return the coverage of the robot."""
        behaviours = [plant for plant in model.plants if plant.kind == sct.PlantKind.behaviour]
        written = [edge for plant in behaviours for edge in edges_of(plant) if edge.source is not None]
        decided = [event for event in executed.events if event.role in _DECIDED]
        guards = [
            {"event": event.name, "true": self.enabled[event.name], "false": self.disabled[event.name]}
            for event in decided
        ]
        return {
            "events": self.events,
            "states": self.states,
            "transitions": {"all": len(written), "taken": sum(edge in self.taken for edge in written)},
            "guards": guards,
            "guards_true_and_false": sum(bool(guard["true"]) and bool(guard["false"]) for guard in guards),
        }


def play(models: Models, traces: Mapping[str, str]) -> TraceCoverage:
    """Play event traces (path to text), each from the initial state."""
    shown = TraceCoverage()
    for path, text in traces.items():
        _play(models, path, text, shown)
    return shown


def _play(models: Models, path: str, text: str, shown: TraceCoverage) -> None:
    simulation = Simulation(models.sct, models.rosgraph, models.ros_types)
    inside: Engine = simulation.engine
    transitions = Transitions(inside)
    guards = {event.name: event.guard for event in inside.executed.events}
    possible = {
        name: None if guard.plants is None else inside.condition(guard.plants) for name, guard in guards.items()
    }
    names = [event.name for event in inside.executed.events if event.role in _DECIDED]
    required = [requirement for requirement in models.sct.requirements if event_name(requirement.event) in possible]

    def look(line: int) -> None:
        shown.states += 1
        for name in names:
            (shown.enabled if inside.enabled(name) else shown.disabled)[name] += 1
        for requirement in required:
            name = event_name(requirement.event)
            holds = possible[name]
            if holds is None or holds():
                verdict = shown.forbidden if requirement in inside.failing_requirements(name) else shown.allowed
                verdict.setdefault(requirement, (path, line))

    look(0)
    steps, _ = read_script(path, text, simulation.engine.events)
    for step in steps:
        before = inside.saved
        if simulation.perform(step.event, step.data).accepted:
            after = inside.saved
            inside.restore((before[0], after[1]))
            shown.taken.update(transitions.taken_transitions(step.event))
            inside.restore(after)
            shown.events += 1
            look(step.line)
