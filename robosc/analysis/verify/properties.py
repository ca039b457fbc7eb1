"""Properties of a supervised system. A property is a function from the system or its control loop to a verdict.

`response` has the properties about sequences of internal events and the states that they lead to.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import PurePath
from typing import TYPE_CHECKING, Any, TypeVar

from robosc.analysis.given_supervisor import flaw_in_words, flaws, states_of_given_supervisor
from robosc.analysis.paths import TraceStep
from robosc.analysis.system import format_count
from robosc.analysis.verify.loop import LoopModel, require_loop_states
from robosc.analysis.verify.response import bounded_response, confluence, finite_response
from robosc.analysis.verify.verdict import Outcome, Verdict, trace_step
from robosc.analysis.wording import goal_in_words, in_words, join_with_and, name, words
from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.places import place
from robosc.model.semantics.communication import ANSWERS, REQUESTS
from robosc.model.semantics.printing import RobotPrinter
from robosc.model.semantics.roles import event_name, is_from_cif, is_goal, plant_of
from robosc.model.semantics.walks import copy_tree
from robosc.synthesis.decoding import value
from robosc.synthesis.encoding import pick, referenced_elements
from robosc.synthesis.fixpoint import Search, completed, coreachable, reaching, supervise_forwards
from robosc.synthesis.relation import Goal, required_moves, steps

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.analysis.paths import Path
    from robosc.analysis.system import Codes, GuardedSystem
    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.relation import EventRelation

    T = TypeVar("T")

#: Kinds of events that must be possible. An action without a changing restriction is never canceled, and data may
#: always be available. No user wrote cancels and data events, and some of them are dead on purpose.
_LIVE = (sct.EventKind.trigger, sct.EventKind.reset, sct.EventKind.tau, *ANSWERS)
_INPUTS = (
    sct.EventKind.response,
    sct.EventKind.error,
    sct.EventKind.feedback,
    sct.EventKind.cancel,
    sct.EventKind.canceled,
    *REQUESTS,
)
_NEVER_QUIESCENT = "the control loop never again rests in a state in which all components are marked"


def properties(system: GuardedSystem) -> list[Callable[[], Verdict]]:
    """Return all properties of a supervised system, including one for each requirement.

    A model from CIF has no control loop, and its plants may refuse events.
    """
    stepwise = is_from_cif(system.model)
    written = [requirement for requirement in system.model.requirements if not requirement.ranges]
    return [
        partial(non_blocking, system),
        partial(controllability, system),
        *([partial(given_supervisor, system)] if system.model.supervised else []),
        *([] if stepwise else [partial(input_enabledness, system)]),
        *(partial(_examine_statement, requirement_holds, system, statement) for statement in written),
        *([partial(ranges, system)] if len(written) < len(system.model.requirements) else []),
        *(partial(_examine_statement, invariant_holds, system, statement) for statement in system.model.invariants),
        *(partial(_examine_statement, goal_reachable, system, own) for own in system.model.reachabilityRequirements),
        *(partial(_examine_statement, claim_holds, system, statement) for statement in system.model.properties),
        *([] if stepwise else [partial(no_dead_events, system)]),
        *([] if stepwise or not _cancelable(system) else [partial(cancel_when_due, system)]),
        partial(maximal_permissiveness, system),
        *([] if stepwise else _in_the_loop(system)),
    ]


def _in_the_loop(system: GuardedSystem) -> list[Callable[[], Verdict]]:
    loop = LoopModel(system)
    return [
        partial(finite_response, system),
        partial(bounded_response, system),
        partial(confluence, loop),
        partial(non_blocking_in_the_loop, loop),
    ]


def non_blocking(system: GuardedSystem) -> Verdict:
    """Check that every reachable state can reach one in which every plant is marked."""
    states = system.controlled
    marked = states & system.encoding.all_marked
    blocked = states & ~coreachable(system.diagrams, steps(system.moves), marked, states)
    if not blocked.satisfiable():
        marks = format_count(system.encoding.count(marked), "of them marked").removesuffix("s")
        return Verdict("non-blocking", Outcome.PROVED, f"{system.size}, {marks}")
    path = system.path_to(blocked)
    explanation = _stuck(system.never_marked(path.states[-1]), path.states[-1])
    return Verdict("non-blocking", Outcome.REFUTED, system.size, explanation, system.trace(path))


def controllability(system: GuardedSystem) -> Verdict:
    """Check that no requirement and no guard forbids an uncontrollable event in a reachable state."""
    uncontrollable = [relation for relation in system.relations.values() if not relation.event.controllable]
    forbidden = {
        relation: system.controlled & relation.enabled & ~(relation.requirement & system.guard(relation.event))
        for relation in uncontrollable
    }

    def explanation(relation: EventRelation, _path: Path) -> str:
        parts = ["a requirement"] if relation.requirements else []
        who = " or ".join([*parts, "its guard"] if relation.event in system.guards else parts)
        return f"{words(relation.event)} cannot be prevented, but {who} forbids it here"

    evidence = f"{system.size}, {format_count(len(uncontrollable), 'uncontrollable event')}"
    return _nowhere("controllability", system, evidence, forbidden, explanation)


def given_supervisor(system: GuardedSystem) -> Verdict:
    """Check that the supervisor in the text needs no addition: it is controllable, non-blocking and safe by itself."""
    question, reached = "given supervisor", states_of_given_supervisor(system)
    evidence = format_count(system.encoding.count(reached), "state")
    for flaw in flaws(system, reached):
        return Verdict(question, Outcome.REFUTED, evidence, flaw_in_words(flaw, system.model), flaw.trace)
    return Verdict(question, Outcome.PROVED, evidence)


def input_enabledness(system: GuardedSystem) -> Verdict:
    """Check that every component accepts the answers, errors, feedback and cancels that a communication allows.

    Components synchronize with communications. A component without an edge for such an event would block the robot in
    the model, although nothing blocks it in reality. Assumptions are excluded: the node checks them. The term is that
    of I/O automata (Lynch, Tuttle: An introduction to input/output automata, CWI Quarterly 1989).
    """
    inputs = [
        relation
        for relation in system.relations.values()
        if relation.event.kind in _INPUTS
        and plant_of(relation.event) in relation.enabled_by
        and not is_goal(relation.event)  # the controller rejects a goal for which a component is not ready
    ]
    blocking = {
        (relation.event, plant): system.controlled & relation.enabled_by[plant_of(relation.event)] & ~enabled
        for relation in inputs
        for plant, enabled in relation.enabled_by.items()
        if plant.kind != sct.PlantKind.assumption
    }

    def explanation(blocked: tuple[sct.Event, sct.Plant], path: Path) -> str:
        event, plant = blocked
        location = plant.locations[path.states[-1][plant]].name
        return f"{words(event)} can come, but `{name(plant)}` has no transition for it in `{location}`"

    evidence = f"{system.size}, {format_count(len(inputs), 'event')}"
    return _nowhere("input-enabledness", system, evidence, blocking, explanation)


def _examine_statement(
    examine: Callable[[GuardedSystem, Any], Verdict], system: GuardedSystem, statement: Any
) -> Verdict:
    """Return the verdict on a statement of the robot model, with its identifier."""
    return replace(examine(system, statement), requirement=requirement_identifier(statement))


def requirement_identifier(requirement: sct.StatedRequirement) -> str:
    """Return the name of a requirement, or its file and line. One in the text may become several in the model."""
    if requirement.name or requirement.source is None:
        return requirement.name or ""
    file, span = place(requirement)
    return f"{PurePath(file).name}:{span.line}"


def requirement_name(requirement: sct.StatedRequirement) -> str:
    """Return the text of the requirement in the robot model, with its line."""
    name = requirement.text or "requirement"
    if isinstance(requirement, sct.Requirement) and not requirement.text:
        name = f"requirement on {event_name(requirement.event)}"
    return f"{name} (line {requirement.source.span.line})" if requirement.source else name


def requirement_holds(system: GuardedSystem, requirement: sct.Requirement) -> Verdict:
    """Check that the supervisor allows the event in no reachable state in which the requirement forbids it.

    The evidence shows the proved condition of the model, which was derived from the author's text.
    """
    relation = system.relations[requirement.event]
    condition = copy_tree(requirement.condition)
    is_needed = requirement.kind == sct.RequirementKind.needs
    condition_text = RobotPrinter()(condition if is_needed else ex.Negation(operand=condition))
    happens = system.controlled & system.allowed[requirement.event]
    states = format_count(system.encoding.count(happens), "state")
    forbidden = ~relation.condition_of(requirement)

    def last(_: EventRelation, path: Path) -> TraceStep:
        return _last_step(system, requirement.event, system.guard(requirement.event) & forbidden, path)

    def explanation(_: EventRelation, path: Path) -> str:
        where = system.where(path.states[-1], referenced_elements(requirement.condition))
        step = in_words([last(relation, path)], system.model)
        return f"{step} can happen" + (f" where `{where}`" if where else "")

    evidence = f"happens in {states}, requires `{condition_text}`"
    broken = {relation: system.controlled & relation.allowed_by(system.guard(requirement.event) & forbidden)}
    return _nowhere(requirement_name(requirement), system, evidence, broken, explanation, last=last)


def _last_step(system: GuardedSystem, event: sct.Event, condition: Diagram, path: Path) -> TraceStep:
    """Return an event as the end of a trace after a path: a command with inputs for which the condition holds."""
    relation = system.relations[event]
    if not relation.has_data:
        return trace_step(event)
    domains = [system.encoding.layout.domains[carried] for carried in event.inputs]
    codes = pick(relation.happens & condition & system.last(path), domains)
    return TraceStep(event_name(event), {carried.name: value(carried, codes[carried]) for carried in event.inputs})


def ranges(system: GuardedSystem) -> Verdict:
    """Check that no event in a reachable state can move a variable out of its range."""
    requirements = [requirement for requirement in system.model.requirements if requirement.ranges]
    leaving = {
        requirement: system.controlled & system.happens(requirement.event) & ~system.encoding.permits(requirement)
        for requirement in requirements
    }

    def explanation(requirement: sct.Requirement, path: Path) -> str:
        at = system.where(path.states[-1], referenced_elements(requirement.condition))
        variables = join_with_and([f"`{own.name}`" for own in requirement.ranges])
        return f"{words(requirement.event)} sets {variables} to values out of range" + (f" where `{at}`" if at else "")

    evidence = f"{system.size}, {format_count(len(requirements), 'edge')} that could leave their ranges"
    return _nowhere(
        "ranges", system, evidence, leaving, explanation, last=lambda requirement, _: trace_step(requirement.event)
    )


def invariant_holds(system: GuardedSystem, invariant: sct.StateInvariant | sct.InvariantProperty) -> Verdict:
    """Check that the condition of an invariant holds in every reachable state."""

    def explanation(_: object, path: Path) -> str:
        return f"it is violated where `{system.where(path.states[-1], referenced_elements(invariant.condition))}`"

    evidence = f"{system.size}, requires `{RobotPrinter()(invariant.condition)}`"
    broken = {invariant: system.controlled & ~system.encoding.holds(invariant.condition)}
    return _nowhere(requirement_name(invariant), system, evidence, broken, explanation)


def claim_holds(system: GuardedSystem, claimed: sct.Property) -> Verdict:
    """Check a property that the model claims; synthesis does not enforce it."""
    if isinstance(claimed, sct.InvariantProperty):
        return invariant_holds(system, claimed)
    assert isinstance(claimed, sct.ReachabilityProperty)
    return goal_reachable(system, claimed)


def goal_reachable(system: GuardedSystem, claimed: sct.ReachabilityProperty | sct.ReachabilityRequirement) -> Verdict:
    """Check that every reachable state with the premise can reach a state with the condition."""
    states, holds = system.controlled, system.encoding.holds
    condition_text = RobotPrinter()(claimed.condition)
    if isinstance(claimed, sct.ReachabilityRequirement):
        goal, target = system.goals[claimed], goal_in_words(claimed)
    else:
        goal, target = Goal(holds(claimed.premise), holds(claimed.condition)), f"state with `{condition_text}`"
    start = states & goal.premise
    stuck = {claimed: start & ~reaching(system.diagrams, steps(system.moves), goal, states)}

    def explanation(_: object, path: Path) -> str:
        elements = [*referenced_elements(claimed.premise), *referenced_elements(claimed.condition)]
        return f"from `{system.where(path.states[-1], elements)}` no {target} can be reached"

    origin = format_count(system.encoding.count(start), "state")
    return _nowhere(requirement_name(claimed), system, f"from {origin} to `{condition_text}`", stuck, explanation)


def no_dead_events(system: GuardedSystem) -> Verdict:
    """Check that each trigger, answer, silent transition and reset can happen in some reachable state.

    An answer of the controller that no transition names has no edge, and is not meant to happen.
    """
    events = [
        event
        for event, relation in system.relations.items()
        if event.kind in _LIVE and (event.kind not in ANSWERS or plant_of(event) in relation.enabled_by)
    ]
    dead = [event for event in events if not (system.controlled & system.allowed[event]).satisfiable()]
    evidence = f"{system.size}, {format_count(len(events), 'event')}"
    if not dead:
        return Verdict("no dead events", Outcome.PROVED, evidence)
    explanation = f"{join_with_and([words(event) for event in dead])} can never happen"
    return Verdict("no dead events", Outcome.REFUTED, evidence, explanation)


def _cancelable(system: GuardedSystem) -> dict[sct.Event, sct.Event]:
    """Return the cancels of actions whose start has a requirement, each with the event of the start.

    An order, a count or an automaton refuses a start, but never cancels.
    """
    start_by_cancel = {}
    for event in system.relations:
        if event.kind == sct.EventKind.cancel:
            starts = (start for start in plant_of(event).events if start.kind == sct.EventKind.trigger)
            for start in starts:
                if any(requirement.automaton is None for requirement in system.relations[start].requirements):
                    start_by_cancel[event] = start
    return start_by_cancel


def _goal_satisfies(system: GuardedSystem, start: EventRelation) -> Diagram:
    """Return the states in which the data of a running goal satisfy the requirements on its start.

    The start stores its inputs in variables of the action's plant.
    """
    satisfied = system.diagrams.true
    for requirement in start.requirements:
        if requirement.automaton is None:
            satisfied &= start.condition_of(requirement)
    for update in (update for edge in start.own_edges for update in edge.updates):
        if isinstance(update.value, sct.InputReference):
            satisfied &= system.encoding.equal(update.variable, update.value.input)
    return satisfied.exists(start.inputs) if start.has_data else satisfied


def cancel_when_due(system: GuardedSystem) -> Verdict:
    """Check that the cancel of a running action can happen if a requirement on its start no longer holds."""
    cancels = _cancelable(system)
    held_back = {
        cancel: system.controlled
        & system.relations[cancel].enabled_by[plant_of(cancel)]
        & ~_goal_satisfies(system, system.relations[start])
        & ~system.allowed[cancel]
        for cancel, start in cancels.items()
    }

    def explanation(cancel: sct.Event, _path: Path) -> str:
        return f"a requirement on the start of `{name(plant_of(cancel))}` does not hold, and its cancel cannot happen"

    evidence = f"{system.size}, {format_count(len(cancels), 'action')} that requirements cancel"
    return _nowhere("cancel when due", system, evidence, held_back, explanation)


def maximal_permissiveness(system: GuardedSystem) -> Verdict:
    """Check that every guard forbids a controllable event only where any supervisor must."""
    relations = list(system.relations.values())
    goals = list(system.goals.values())
    search = Search(system.encoding, relations, required_moves(relations), system.violating, goals)
    required = completed(supervise_forwards(search)).controlled
    controllable = [relation for relation in system.relations.values() if relation.event.controllable]
    denied = {relation: ~system.guard(relation.event) for relation in controllable}
    needless = {
        relation: system.controlled & _permitted(relation, required, condition)
        for relation, condition in denied.items()
    }

    def last(relation: EventRelation, path: Path) -> TraceStep:
        leading = relation.permitted & denied[relation]
        if relation.has_data and relation.changed:
            leading &= relation.leading_to(required)
        return _last_step(system, relation.event, leading, path)

    def explanation(relation: EventRelation, path: Path) -> str:
        return f"{in_words([last(relation, path)], system.model)} is forbidden here without a reason"

    evidence = f"{system.size}, {format_count(len(controllable), 'controllable event')}"
    return _nowhere("maximal permissiveness", system, evidence, needless, explanation, last=last)


@require_loop_states("non-blocking in the control loop")
def non_blocking_in_the_loop(loop: LoopModel) -> Verdict:
    """Check that the control loop can always reach a state that is marked and quiescent.

    If some events have precedence, a nonblocking system may stay in these events forever, or always take the same
    branch. The controller property "non-blocking under control" of Eclipse ESCET for CIF is about all controllable
    events: its generated code executes these until none is possible. This control loop does so with internal events;
    requests and cancels alternate with events from the robot.
    """
    system, question = loop.system, "non-blocking in the control loop"
    blocked = loop.states & ~loop.coreachable(loop.quiescent & system.encoding.all_marked)
    evidence = format_count(system.encoding.count(loop.states), "state")
    if not blocked.satisfiable():
        return Verdict(question, Outcome.PROVED, evidence)
    path = loop.path_to(blocked)
    onwards = loop.after(path.states[-1])
    plants = [plant for plant in system.model.plants if not (onwards & system.encoding.marked(plant)).satisfiable()]
    explanation = _stuck(plants, path.states[-1]) if plants else _NEVER_QUIESCENT
    return Verdict(question, Outcome.REFUTED, evidence, explanation, system.trace(path))


def _nowhere(  # noqa: PLR0913 - all parts of a verdict
    question: str,
    system: GuardedSystem,
    evidence: str,
    violations: Mapping[T, Diagram],
    explanation: Callable[[T, Path], str],
    *,
    last: Callable[[T, Path], TraceStep] | None = None,
) -> Verdict:
    """Return the verdict that there are no violations, or the first violation in the nearest state.

    The trace ends in that state, or with the step `last` of the violation.
    """
    anywhere = system.diagrams.any_of(violations.values())
    if not anywhere.satisfiable():
        return Verdict(question, Outcome.PROVED, evidence)
    path = system.path_to(anywhere)
    violated = next(requirement for requirement, states in violations.items() if system.is_in(path.states[-1], states))
    trace = (*system.trace(path), *([last(violated, path)] if last else []))
    return Verdict(question, Outcome.REFUTED, evidence, explanation(violated, path), trace)


def _permitted(relation: EventRelation, controlled: Diagram, condition: Diagram) -> Diagram:
    """Return the states in which the maximally permissive supervisor allows the event under a condition.

    The condition is on the state and on the inputs of a command: the supervisor decides on each combination of them.
    """
    if not relation.has_data:
        enabled = controlled & relation.enabled & relation.requirement & condition
        return enabled if relation.step is None else enabled & relation.step.preimage(controlled)
    step = relation.step_where(relation.permitted & condition)
    allowed = relation.allowed_by(relation.permitted & condition) if step is None else step.preimage(controlled)
    return controlled & allowed


def _stuck(plants: Sequence[sct.Plant], codes: Codes) -> str:
    """Return a clause about plants that are never marked again, or never all at once if there are none."""
    if not plants:
        return "the marked states of all components cannot be reached together any more"
    places = (
        f"`{name(plant)}`" + (f" in `{plant.locations[codes[plant]].name}`" if len(plant.locations) > 1 else "")
        for plant in plants
    )
    return f"{', '.join(places)} cannot get back to a marked state"
