"""Findings of synthesis rules in the words of the robot model, from the observations of a supervisor."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

from robosc.analysis.blocking_in_words import counterexample_in_words, way_out
from robosc.analysis.causes import causes, with_causes
from robosc.analysis.given_supervisor import flaw_in_words
from robosc.analysis.observations import Forbidden
from robosc.analysis.wording import (
    condition,
    forbid,
    in_words,
    join_with_and,
    name,
    quote_requirements,
    reference,
    words,
)
from robosc.base.diagnostics import Diagnostic, Severity, in_order
from robosc.model import sct
from robosc.model.places import place
from robosc.model.reflection import tree
from robosc.model.semantics.communication import ANSWERS, ENDING_ANSWERS, event_word
from robosc.model.semantics.edges import edges_from, edges_of
from robosc.model.semantics.roles import plant_of
from robosc.synthesis.encoding import referenced_elements

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from robosc.analysis.causes import Absent
    from robosc.analysis.given_supervisor import Flaw
    from robosc.analysis.observations import (
        Example,
        ForbiddenCancel,
        Hindrance,
        NeverEnabled,
        NeverEnding,
        Observations,
        ProvideGap,
        SelfCancelling,
        SharedServer,
        SharedTopicConflict,
        SilentRestricted,
        UnreachableState,
    )
    from robosc.synthesis.encoding import Element

_DONE = {sct.PlantKind.service: "called", sct.PlantKind.action: "started"}
#: Maximum number of further commands that a message names.
_NAMED = 3
_FOLLOWED = {sct.EventKind.reset: "the end of `{}`"}


def findings_of(model: sct.SupervisoryControlModel, observations: Observations) -> list[Diagnostic]:
    """Return the findings about a model, in order, from the observations of its supervisor.

    Each finding is at an element of the model, at a requirement if only one is at fault.
    """
    words_for = _Findings(model)
    absent: dict[Absent, Diagnostic] = {}
    unused = _unused_of_libraries(model, observations)
    absent |= {observed.event: words_for.never_enabled(observed) for observed in observations.never_enabled}
    absent |= {observed.location: words_for.unreachable_state(observed) for observed in observations.unreachable_states}
    absent = {element: finding for element, finding in absent.items() if element not in unused}
    return in_order(
        [
            *with_causes(absent, causes(observations)),
            *map(words_for.silent_restricted, observations.silent_restricted),
            *map(words_for.self_cancelling, observations.self_cancelling),
            *map(words_for.forbidden_cancel, observations.forbidden_cancels),
            *map(words_for.shared_server, observations.shared_servers),
            *map(words_for.provide_gap, observations.provide_gaps),
            *map(words_for.shared_topic_conflict, observations.shared_topic_conflicts),
            *map(words_for.unrestricted_call, observations.unrestricted_calls),
            *(
                words_for.unused_assumption(plant)
                for plant in observations.unused_assumptions
                if not _of_library(plant, model)
            ),
            *map(words_for.rejected_goal, observations.rejected_goals),
            *map(words_for.never_ending, observations.never_ending),
            *map(words_for.given_supervisor, observations.flaws),
        ]
    )


def _unused_of_libraries(model: sct.SupervisoryControlModel, observations: Observations) -> set[Absent]:
    """Return states and silent transitions of library components that this robot neither uses nor names.

    A library serves other robots, too. An element is not unused if a requirement in the robot's own text or the
    supervisor makes it unreachable.
    """
    unreached = {
        observed.location
        for observed in observations.unreachable_states
        if _of_library(observed.location, model)
        and not any(_is_own_restriction(hindrance, model) for hindrance in observed.hindrances)
    }
    if unreached:
        unreached -= _named_in_own_text(model)
    silent = {
        observed.event
        for observed in observations.never_enabled
        if observed.event.kind == sct.EventKind.tau
        and _of_library(observed.event, model)
        and not _is_own_restriction(observed, model)
    }
    return {*unreached, *silent}


def _is_own_restriction(observed: Hindrance | NeverEnabled, model: sct.SupervisoryControlModel) -> bool:
    """Return whether a requirement in the robot's own text, or the supervisor, prevents something."""
    if observed.counterexample is not None or observed.forbidden is Forbidden.BY_SYNTHESIS:
        return True
    return any(not _of_library(requirement, model) for requirement in observed.requirements)


def _named_in_own_text(model: sct.SupervisoryControlModel) -> set[sct.Location]:
    """Return the locations that requirements, properties and guards in the robot's own text read."""
    texts = [*model.plants, *model.requirements, *model.invariants, *model.reachabilityRequirements, *model.properties]
    return {
        node.location
        for text in texts
        for _, node in tree(text)
        if isinstance(node, sct.LocationReference) and not _of_library(node, model)
    }


def _of_library(element: Any, model: sct.SupervisoryControlModel) -> bool:
    """Return whether an element comes from another text than the robot's."""
    while element.source is None or element.source.file is None:
        if element is model or element.eContainer() is None:
            return False
        element = element.eContainer()
    own = model.source.file if model.source else None
    return own is not None and element.source.file != own


class _Findings:
    def __init__(self, model: sct.SupervisoryControlModel) -> None:
        self._model = model

    def never_enabled(self, observed: NeverEnabled) -> Diagnostic:
        event, plant = observed.event, plant_of(observed.event)
        silent = event.kind == sct.EventKind.tau
        subject = f"this transition of `{name(plant)}`" if silent else _subject(event)
        done = "taken" if silent else _DONE.get(plant.kind, "sent")
        if observed.forbidden is Forbidden.BY_REQUIREMENTS:
            why, hint = (
                f"in every state where it could be, {forbid(observed.requirements, 'it')}",
                "loosen its requirements",
            )
            if observed.trace is not None:
                way = f"after {in_words(observed.trace, self._model)}" if observed.trace else "at the start"
                why += f", for example {way}"
        elif observed.counterexample is not None and not observed.kept_away:
            why, hint = counterexample_in_words(observed.counterexample, self._model), way_out(observed.counterexample)
            invariants = any(isinstance(own, sct.StateInvariant) for own in observed.counterexample.violated)
            if invariants and plant.kind == sct.PlantKind.action:
                hint = hint.partition(":")[0]
                hint += " (what the action `needs` cancels it; `never` and `always` do not let it start)"
        elif observed.kept_away:
            why = f"the supervised robot reaches no state in which it could be {done}"
            hint = "allow a way to such a state"
            if observed.counterexample is not None:
                why += f": {counterexample_in_words(observed.counterexample, self._model)}"
            elif observed.needed is not None:
                *before, _ = observed.trace or ()
                after = f" after {in_words(before, self._model)}" if before else ""
                why += f": the shortest way to one needs {words(observed.needed)}{after}, where "
                why += forbid(observed.requirements, "it")
        elif silent:
            why, hint = _guard(event), "correct its guard or the transitions to its state"
        else:
            why = _not_requested(observed)
            hint = f"write `on {event_word(event)} to {reference(plant)}` in a state that can be reached"
        required = () if observed.kept_away else observed.requirements
        at_fault = required or (observed.counterexample and observed.counterexample.violated) or ()
        return _finding(
            _blamed(at_fault, event),
            "never-enabled",
            f"{subject} can never be {done}: {why}",
            f"{hint}, or remove it"
            + ("" if silent else f"; `robosc explain --why-never {_named(event)}` explains why"),
        )

    def silent_restricted(self, observed: SilentRestricted) -> Diagnostic:
        if observed.event.kind == sct.EventKind.cancel:
            return self._cancel_held_back(observed)
        plant = name(plant_of(observed.event))
        what = _FOLLOWED.get(observed.event.kind, "this transition of `{}`").format(plant)
        return _finding(
            observed.event,
            "silent-restricted",
            f"the supervisor must prevent {what}, so the model may lose track of the robot: otherwise, "
            f"{counterexample_in_words(observed.counterexample, self._model)}",
            way_out(observed.counterexample),
        )

    def _cancel_held_back(self, observed: SilentRestricted) -> Diagnostic:
        action, trace = name(plant_of(observed.event)), observed.counterexample
        violated = [requirement for requirement in trace.violated if isinstance(requirement, sct.Requirement)]
        hint = way_out(trace)
        if ends := [requirement for requirement in violated if requirement.automaton is not None]:
            hint = (
                f"a start can be refused, a cancel cannot: take the end of `{action}` out "
                f"of {quote_requirements(ends)}, or restrict the start of `{action}`"
            )
        return _finding(
            observed.event,
            "cancel-held-back",
            f"the supervisor would have to prevent the cancel of `{action}`, which it cannot: otherwise, "
            f"{counterexample_in_words(trace, self._model)}",
            hint,
            Severity.ERROR,
        )

    @staticmethod
    def self_cancelling(observed: SelfCancelling) -> Diagnostic:
        states = [f"`{name(plant)}.{state.name}`" for plant, state in _entered(observed.event)]
        led = f"allow {join_with_and(states)}, where its request leads" if states else "loosen its requirements"
        return _finding(
            _blamed(observed.requirements, observed.event),
            "self-cancelling",
            f"`{name(plant_of(observed.event))}` is cancelled as soon as it has started: right after its start "
            f"{forbid(observed.requirements, 'it')}",
            f"the requirements of an action must also hold while it runs: {led}",
            Severity.ERROR,
        )

    def forbidden_cancel(self, observed: ForbiddenCancel) -> Diagnostic:
        action, requirement = name(plant_of(observed.event)), quote_requirements([observed.requirement])
        return _finding(
            observed.requirement,
            "cancel-held-back",
            f"{requirement} prevents the cancel of `{action}` when it is due, and the controller could not stop it: "
            f"after {in_words(observed.trace, self._model)}",
            f"a start can be refused, a cancel cannot: take `cancel from {action.rpartition('.')[2]}` out of the"
            f" requirement, or restrict the start of `{action}`",
            Severity.ERROR,
        )

    def shared_server(self, observed: SharedServer) -> Diagnostic:
        first, second = name(observed.first), name(observed.second)
        return _finding(
            observed.second,
            "shared-server",
            f"`{first}` and `{second}` use one server, and both can be under way at the same time: after "
            f"{in_words(observed.trace, self._model)}{_likewise(second, observed.others)}",
            f"let the requirements keep `{second}` from starting while `{first}` is running",
        )

    def given_supervisor(self, flaw: Flaw) -> Diagnostic:
        return _finding(
            flaw.requirement or self._model,
            "given-supervisor",
            f"the supervisor of the specification does not suffice: {flaw_in_words(flaw, self._model)}",
            "correct this supervisor, or take the one that synthesis completes: `robosc transform`",
        )

    def provide_gap(self, observed: ProvideGap) -> Diagnostic:
        plant = plant_of(observed.event)
        provided = "feedback to " * (observed.event.kind == sct.EventKind.replyFeedback) + reference(plant)
        done = _DONE.get(plant.kind, "sent")
        edges = edges_of(observed.data)
        elements = [element for edge in edges for element in referenced_elements(edge.guard)]
        return _finding(
            observed.data,
            "provide-gap",
            f"{_subject(observed.event)} can be {done} without data, where no condition of its `provide` statements"
            " holds" + _where(observed.example, [*elements, *self._asking(observed.event)]),
            f"add `provide {provided} with ...` without a condition, or a requirement that excludes this",
        )

    def shared_topic_conflict(self, observed: SharedTopicConflict) -> Diagnostic:
        first, second = observed.first, observed.second
        requirements = [*self._requirements(first), *self._requirements(second)]
        others = [plant_of(event) for event in observed.others]
        return _finding(
            requirements[-1] if requirements else second,
            "shared-topic-conflict",
            f"`{name(plant_of(first))}` and `{name(plant_of(second))}` go to one topic, and both can be sent at the "
            f"same time, so that they take turns"
            + _where(observed.example, [*self._asking(first), *self._asking(second)])
            + _likewise(name(plant_of(second)), others),
            "let the requirements on the two exclude each other",
        )

    @staticmethod
    def unrestricted_call(event: sct.Event) -> Diagnostic:
        plant = plant_of(event)
        action = reference(plant)
        return _finding(
            event,
            "unrestricted-call",
            f"`{name(plant)}` is {_DONE[plant.kind]} again and again, as soon as it has ended: no requirement "
            "restricts it, and no component waits for its request",
            f"add `requirement {action} needs ...`, or `on request to {action}` in the states that allow it",
        )

    @staticmethod
    def rejected_goal(event: sct.Event) -> Diagnostic:
        plant = plant_of(event)
        return _finding(
            event,
            "goal-rejected",
            f"the controller rejects every goal of `{name(plant)}`: the supervised robot reaches no state in which each"
            f" component that names `request from {reference(plant)}` permits it"
            if _is_named(event)
            else f"the controller rejects every goal of `{name(plant)}`: no transition names its request",
            f"write `on request from {reference(plant)}` in a state that can be reached",
        )

    def never_ending(self, observed: NeverEnding) -> Diagnostic:
        plant = observed.plant
        ends = [event for event in plant.events if event.kind in ENDING_ANSWERS]
        is_action = plant.kind == sct.PlantKind.actionServer
        what, word = ("goal", "end") if is_action else ("request", "be answered")
        named = join_with_and([f"`{event_word(event)} to {reference(plant)}`" for event in ends])
        possible = f"{named} can{'not' if len(ends) == 1 else ' no longer'} happen"
        why = f"no transition names `response to {reference(plant)}`{' or another end' * is_action}"
        if ends:
            why = f"after {in_words(observed.trace, self._model)}, {possible}"
        written = [f"`on {end} to {reference(plant)}`" for end in ("response", *("error",) * is_action)]
        return _finding(
            plant,
            "goal-never-ends",
            f"a {what} of `{name(plant)}` may never {word}: {why}",
            f"write {' or '.join(written)} in the states in which it is then open",
        )

    def unused_assumption(self, plant: sct.Plant) -> Diagnostic:
        alike = [
            other
            for other in self._model.plants
            if other.kind == sct.PlantKind.assumption and plant.source is not None and other.source == plant.source
        ]
        others = max(len(alike) - 1, 0)
        instances = "instance" if others == 1 else f"{others} instances"
        return _finding(
            plant,
            "assumption-unused",
            f"`{plant.text}` excludes nothing: wherever its events can come in the supervised robot, its condition"
            f" holds{f'; the same holds for the other {instances}' if others else ''}",
            "remove it, or correct its condition",
        )

    def unreachable_state(self, observed: UnreachableState) -> Diagnostic:
        state, plant = observed.location, observed.location.eContainer()
        why = "; ".join(dict.fromkeys(map(self._hindrance, observed.hindrances))) or "no transition leads to it"
        first = "allow a transition that leads to it" if observed.hindrances else f"write `goto {state.name}` somewhere"
        return _finding(
            state,
            "unreachable-state",
            f"`{name(plant)}` is never in `{state.name}`: {why}",
            f"{first}, or remove the state",
        )

    def _hindrance(self, observed: Hindrance) -> str:
        """Return why a transition never leads to a state."""
        here: sct.Location = observed.edge.eContainer()
        event, own = observed.edge.event, here.eContainer()
        if observed.forbidden is None:
            return f"a transition leads there from `{here.name}`, but it is never in `{here.name}` either"
        if observed.forbidden is Forbidden.BY_REQUIREMENTS:
            return f"in `{here.name}` {forbid(observed.requirements, f'the {words(event)}')}"
        if observed.counterexample is not None:
            held_back = f"in `{here.name}` the supervisor prevents the {words(event)}"
            return f"{held_back}, since {counterexample_in_words(observed.counterexample, self._model)}"
        if own in observed.plants:
            return f"in `{here.name}` the guard of the {words(event)} never holds"
        others = [f"`{name(plant)}`" for plant in observed.plants]
        who = (
            f"{join_with_and(others)} never {'takes' if len(others) == 1 else 'take'} part"
            if others
            else "not all take part"
        )
        return f"in `{here.name}` the {words(event)} never happens: {who} in it then"

    @cached_property
    def _required(self) -> dict[sct.Event, list[sct.Requirement]]:
        required: dict[sct.Event, list[sct.Requirement]] = {}
        for requirement in self._model.requirements:
            if requirement.event is not None:
                required.setdefault(requirement.event, []).append(requirement)
        return required

    def _requirements(self, event: sct.Event) -> list[sct.Requirement]:
        return self._required.get(event, [])

    @cached_property
    def _participants(self) -> dict[sct.Event, dict[sct.Plant, None]]:
        participants: dict[sct.Event, dict[sct.Plant, None]] = {}
        for plant in self._model.plants:
            for edge in edges_of(plant):
                participants.setdefault(edge.event, {})[plant] = None
        return participants

    def _asking(self, event: sct.Event) -> Iterable[Element]:
        """Yield the elements that decide about an event: plants that take part, and data of its requirements."""
        yield from self._participants.get(event, ())
        for requirement in self._requirements(event):
            yield from referenced_elements(requirement.condition)


def _likewise(second: str, others: Sequence[sct.Plant]) -> str:
    """Return the end of a message that names further commands with the same conflict."""
    if not others:
        return ""
    shown = [f"`{name(plant)}`" for plant in others[:_NAMED]]
    more = len(others) - len(shown)
    return f"; the same holds for `{second}` and {join_with_and([*shown, f'{more} more'] if more else shown)}"


def _finding(element: Any, rule: str, message: str, hint: str, severity: Severity = Severity.WARNING) -> Diagnostic:
    file, span = place(element)
    return Diagnostic(file, span, severity, rule, message, hint)


def _blamed(requirements: Sequence[sct.StatedRequirement], event: sct.Event) -> Any:
    return requirements[0] if len(requirements) == 1 else event


def _guard(event: sct.Event) -> str:
    """Return why a transition without requirements is never taken."""
    plant = plant_of(event)
    locations = [location for location in plant.locations if any(edge.event is event for edge in edges_from(location))]
    guarded = any(
        edge.guard is not None for location in locations for edge in edges_from(location) if edge.event is event
    )
    if len(locations) == len(plant.locations):
        return "its guard never holds"
    state = f"`{name(plant)}.{locations[0].name}`"
    return f"its guard never holds in {state}" if guarded else f"{state} is never reached"


def _not_requested(observed: NeverEnabled) -> str:
    waiting = [f"`{name(plant)}`" for plant in observed.plants]
    if observed.event.kind in ANSWERS:
        if not waiting:
            return "the components that name it never permit it at the same time"
        return f"{join_with_and(waiting)} cannot reach a state that permits it"
    if not waiting:
        return "the components that wait for its request never do so at the same time"
    return f"{join_with_and(waiting)} cannot reach a state that waits for its request"


def _subject(event: sct.Event) -> str:
    """Return a command as the subject of a sentence: its communication, or the answer to a client."""
    return f"the {words(event)}" if event.kind in ANSWERS else f"`{name(plant_of(event))}`"


def _named(event: sct.Event) -> str:
    """Return the name of a command for `robosc explain`."""
    plant = name(plant_of(event))
    return f"{plant}.{event_word(event)}" if event.kind in ANSWERS else plant


def _is_named(event: sct.Event) -> bool:
    """Return whether a component names an event."""
    model = plant_of(event).eContainer()
    components = (plant for plant in model.plants if plant.kind == sct.PlantKind.behaviour)
    return any(edge.event is event for plant in components for edge in edges_of(plant))


def _entered(event: sct.Event) -> Iterable[tuple[sct.Plant, sct.Location]]:
    """Return the states of components that an event enters from other states."""
    plants: Sequence[sct.Plant] = plant_of(event).eContainer().plants
    targets = [
        edge.target
        for plant in plants
        for location in plant.locations
        for edge in edges_from(location)
        if plant.kind == sct.PlantKind.behaviour and edge.event is event and edge.target is not location
    ]
    return [(target.eContainer(), target) for target in dict.fromkeys(targets)]


def _where(example: Example, relevant: Iterable[Element]) -> str:
    """Return the example as text, restricted to relevant elements with several values."""
    chosen = set(relevant)
    conditions = [
        (domain, value)
        for domain, value in example.state.items()
        if domain in chosen and not (isinstance(domain, sct.Plant) and len(domain.locations) == 1)
    ]
    shown = f", for example where `{condition(conditions)}`" if conditions else ""
    return shown if example.quiescent else f"{shown}, at least until silent transitions have run"
