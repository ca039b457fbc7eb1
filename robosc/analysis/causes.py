"""Causes of impossible events and unreachable states among other such events and states."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, TypeAlias

from robosc.analysis.observations import Forbidden
from robosc.base.diagnostics import Related
from robosc.model import sct
from robosc.model.semantics.edges import edges_of
from robosc.model.semantics.roles import event_name
from robosc.synthesis.encoding import referenced_elements

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from robosc.analysis.observations import NeverEnabled, Observations, UnreachableState
    from robosc.base.diagnostics import Diagnostic

    #: Event that never happens, or state that is never reached.
    Absent: TypeAlias = sct.Event | sct.Location


def causes(observations: Observations) -> dict[Absent, set[Absent]]:
    """Return the direct causes of each absent event or state; a root cause has none."""
    never = {observed.event for observed in observations.never_enabled}
    unreached = {observed.location for observed in observations.unreachable_states}
    direct: dict[Absent, set[Absent]] = {}
    for event in observations.never_enabled:
        direct[event.event] = set(_of_event(event, never, unreached)) - {event.event}
    for state in observations.unreachable_states:
        direct[state.location] = set(_of_state(state, never, unreached))
    return direct


def _of_event(observed: NeverEnabled, never: set[sct.Event], unreached: set[sct.Location]) -> Iterator[Absent]:
    event = observed.event
    if observed.needed in never:
        yield observed.needed
    elif observed.kept_away and observed.counterexample is not None:
        held_back = observed.counterexample.trace[-1].event
        yield from (other for other in never if event_name(other) == held_back)
    elif observed.forbidden is Forbidden.BY_REQUIREMENTS:
        for requirement in observed.requirements:
            for plant in referenced_elements(requirement.condition):
                # An automaton or order waits for an event that never happens.
                if isinstance(plant, sct.Plant) and plant.kind == sct.PlantKind.requirement:
                    yield from {edge.event for edge in edges_of(plant)} & never
    elif observed.counterexample is None:
        for plant in observed.plants:
            leaving = {edge.eContainer() for edge in edges_of(plant) if edge.event is event}
            if leaving <= unreached:
                yield from leaving


def _of_state(observed: UnreachableState, never: set[sct.Event], unreached: set[sct.Location]) -> Iterable[Absent]:
    reasons = set()
    for hindrance in observed.hindrances:
        source = hindrance.edge.eContainer()
        if hindrance.forbidden is None and source in unreached:
            reasons.add(source)
        elif hindrance.edge.event in never:
            reasons.add(hindrance.edge.event)
        else:
            return set()  # This transition has another cause.
    return reasons


def with_causes(findings: Mapping[Absent, Diagnostic], follows: Mapping[Absent, set[Absent]]) -> list[Diagnostic]:
    """Return the findings about absent elements; a consequence refers to the line of its root cause."""
    depths: dict[Absent, int] = {absent: 0 for absent in findings if not follows[absent]}
    nearest: dict[Absent, Absent] = {}
    pending = list(depths)
    for absent in pending:
        for other in findings:
            if other not in depths and absent in follows[other]:
                depths[other], nearest[other] = depths[absent] + 1, nearest.get(absent, absent)
                pending.append(other)
    return [
        _following(finding, findings[nearest[absent]], depths[absent]) if absent in nearest else finding
        for absent, finding in findings.items()
    ]


def _following(finding: Diagnostic, cause: Diagnostic, depth: int) -> Diagnostic:
    where = f"line {cause.span.line}" if cause.file == finding.file else f"{cause.file}:{cause.span.line}"
    message = f"therefore, {finding.message}"
    related = (Related(cause.file, cause.span, "the cause of this finding"), *finding.related)
    hint = f"correct the cause in {where} first"
    return replace(finding, message=message, hint=hint, related=related, follows=depth)
