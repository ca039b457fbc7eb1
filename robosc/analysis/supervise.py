"""Synthesize the supervisor of a model; report why it is empty or suspicious."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.analysis.blocking import BlockReason, reason_of_emptiness
from robosc.analysis.blocking_in_words import counterexample_in_words, describe_blocking
from robosc.analysis.findings import findings_of
from robosc.analysis.observations import Observations, Observer, Weight
from robosc.analysis.system import SynthesizedSystem
from robosc.analysis.wording import forbid, in_words, name, reference
from robosc.base.diagnostics import Diagnostic, ModelError, Severity, has_errors
from robosc.model import sct
from robosc.model.places import place
from robosc.model.semantics.edges import edges_from
from robosc.model.semantics.naming import escape_keyword
from robosc.model.semantics.roles import plant_of
from robosc.synthesis import MEMORY, Phase, Solution, Statistics, Synthesis, Tuning, solve

if TYPE_CHECKING:
    from robosc.base.diagnostics import Span


@dataclass(frozen=True)
class Diagnosis(Synthesis):
    """Result of synthesis, with `observations` of the supervisor, or with the `reason` why it is empty.

    `weights` are the numbers of states in which each requirement matters. They are given on request, and only if their
    computation is cheap.
    """

    observations: Observations | None = None
    reason: BlockReason | None = None
    weights: tuple[Weight, ...] = ()


@dataclass(frozen=True)
class Supervision:
    """Result of synthesis, and the findings of its rules."""

    synthesis: Diagnosis
    findings: list[Diagnostic]


class EmptySupervisorError(ModelError):
    """No behavior of the robot satisfies its requirements; `synthesis.reason` holds the cause."""

    def __init__(self, model: sct.SupervisoryControlModel, synthesis: Diagnosis) -> None:
        self.synthesis = synthesis
        assert synthesis.reason is not None
        reason = synthesis.reason
        trace = f"; a shortest trace: {in_words(reason.trace, model)}" if reason.trace else ""
        file, span = _place(model, reason)
        message = f"the supervisor is empty: {describe_blocking(reason)}{trace}"
        if reason.requirements and not (reason.event and reason.event.controllable):
            message += f"; from there on {forbid(reason.requirements, 'something')}"
        way = _condition(model, reason) or "loosen a requirement, or give every component a way back to a marked state"
        hint = f"{way}; `robosc explain --why-empty` explains why"
        super().__init__([Diagnostic(file, span, Severity.ERROR, "empty-supervisor", message, hint)])


def _place(model: sct.SupervisoryControlModel, reason: BlockReason) -> tuple[str, Span]:
    """Return the place of the event at fault, or of the first requirement at fault if the event is a library's."""
    own, _ = place(model)
    elements = [element for element in (reason.event, *reason.violated, *reason.requirements) if element is not None]
    places = [place(element) for element in elements] or [place(model)]
    return next((candidate for candidate in places if candidate[0] == own), places[0])


def _condition(model: sct.SupervisoryControlModel, reason: BlockReason) -> str | None:
    """Return the condition that an automaton lacks if it follows a message that its component ignores."""
    violated = [requirement for requirement in reason.violated if isinstance(requirement, sct.Requirement)]
    shared = Counter(name(plant).rpartition(".")[2] for plant in model.plants if plant.kind == sct.PlantKind.message)
    for requirement in violated:
        event = requirement.event
        component, _, message = name(plant_of(event)).rpartition(".")
        for plant in model.plants if plant_of(event).kind == sct.PlantKind.message else ():
            moved = [state for state in plant.locations if any(_does(edge, event) for edge in edges_from(state))]
            here = reason.state.get(plant.name)
            if plant.kind == sct.PlantKind.behaviour and name(plant) == component and moved:
                owner = reference(plant)
                states = " or ".join(f"{owner}.{escape_keyword(state.name)}" for state in moved)
                if here not in {state.name for state in moved}:
                    own_name = f"{owner}.{escape_keyword(message)}"
                    heard = f"on response from {own_name if shared[message] > 1 else escape_keyword(message)}"
                    way = (
                        f"`{component}` ignores it in `{here}`: in the automaton of the requirement, write "
                        f"`if {states}` after `{heard}`, and add `{heard} if !({states})` to each state"
                    )
                    template = f", with the name of the template for `{owner}`"
                    return way + template if _is_of_template(requirement, model) else way
    return None


def _is_of_template(requirement: sct.Requirement, model: sct.SupervisoryControlModel) -> bool:
    """Return whether the automaton of a requirement has one text for instances that each have their own events."""
    automaton, event = requirement.automaton, requirement.event
    copies = [plant for plant in model.plants if plant.kind == sct.PlantKind.requirement and plant is not automaton]
    return automaton is not None and any(
        plant.source == automaton.source
        and all(edge.event is not event for state in plant.locations for edge in state.edges)
        for plant in copies
        if plant.source is not None
    )


def _does(edge: sct.Edge, event: sct.Event) -> bool:
    """Return whether an edge of an event changes something."""
    return edge.event is event and (edge.target not in (None, edge.eContainer()) or bool(edge.updates))


def diagnose(
    model: sct.SupervisoryControlModel,
    *,
    memory: int = MEMORY,
    statistics: Statistics | None = None,
    weigh: bool = False,
    tuning: Tuning | None = None,
) -> Diagnosis:
    """Synthesize the supervisor of a model and observe it, without changing the model.

    `weigh` requests the weights. For `memory`, `statistics`, `tuning` and errors see
    `robosc.synthesis.synthesize`.
    """

    def look(solution: Solution) -> Diagnosis:
        attributes = vars(solution.synthesis)
        with solution.synthesis.statistics.during(Phase.OBSERVE if solution.synthesis.supervisor else Phase.GUARDS):
            system = SynthesizedSystem(model, solution.encoding, solution.relations, solution.states)
            if solution.uncontrolled is not None:
                system.uncontrolled = solution.uncontrolled
            if solution.synthesis.supervisor is None:
                return Diagnosis(**attributes, reason=reason_of_emptiness(system))
            observer = Observer(system, solution.permissions)
            weights = tuple(observer.weights()) if weigh else ()
            return Diagnosis(**attributes, observations=observer.observations(), weights=weights)

    return solve(model, look, memory=memory, statistics=statistics, tuning=tuning)


def supervise(
    model: sct.SupervisoryControlModel,
    *,
    memory: int = MEMORY,
    statistics: Statistics | None = None,
    weigh: bool = False,
    tuning: Tuning | None = None,
) -> Supervision:
    """Synthesize the supervisor of a model and assign it to the model.

    The model gets the supervisor only if all guards are complete and no finding is an error. Guards explain why
    synthesis added a condition, if the explanation is cheap. For `memory`, `statistics` and
    `tuning` see `robosc.synthesis.synthesize`; for `weigh` see `diagnose`. Raises EmptySupervisorError if there is no
    supervisor, and ModelError and MemoryError as `synthesize` does.
    """
    synthesis = diagnose(model, memory=memory, statistics=statistics, weigh=weigh, tuning=tuning)
    if synthesis.observations is None:
        raise EmptySupervisorError(model, synthesis)
    findings = findings_of(model, synthesis.observations)
    assert synthesis.supervisor is not None
    for guard in synthesis.supervisor.guards:
        counterexample = synthesis.observations.counterexamples.get(guard.event)
        if counterexample is not None:
            guard.explanation = counterexample_in_words(counterexample, model)
    if not has_errors(findings) and not synthesis.unwritten:
        model.supervisor = synthesis.supervisor
    return Supervision(synthesis, findings)
