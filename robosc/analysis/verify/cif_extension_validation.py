"""Validation of the CIF that is written for a model from CIF: each event, in all states, symbolically.

The generated CIF imports the text that the model was read from. It is interpreted as in CIF's explorer, simulator and
code generators: supervisors and requirements restrict as plants do, and an update out of a range is an error, not a
restriction.
"""

from __future__ import annotations

from copy import copy
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from robosc.analysis.system import GuardedSystem, format_count
from robosc.analysis.verify.differences import event_in_words, on_one_side, refute, where
from robosc.analysis.verify.transitions import in_range
from robosc.analysis.verify.verdict import Outcome, Verdict
from robosc.language.cif import read_supervised
from robosc.model import sct
from robosc.model.semantics.domains import domain
from robosc.model.semantics.edges import edges_by_event
from robosc.synthesis import MEMORY
from robosc.synthesis.bdd import Diagrams, with_enough_memory
from robosc.synthesis.encoding import BitLayout, Encoding
from robosc.synthesis.relation import EventRelation, requirements_by_event

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.model import expression as ex
    from robosc.synthesis.bdd import Diagram

PROPERTY = "cif-translation"
TEXT = "the generated CIF"


def validate_extension(model: sct.SupervisoryControlModel, text: str, own_text: str | None = None) -> Verdict:
    """Return whether `<model>.supervised.cif` allows the same as the supervisor of a model from CIF, without errors.

    `own_text` is the specification that it imports, if the model was not read from CIF.
    Every event must be enabled in the same reachable states, lead to the same ones, and leave no range. Raises
    MemoryError if the decision diagrams take more than 4 GB.
    """
    reading = read_supervised(model, text, own_text)
    if reading is None:
        return Verdict(PROPERTY, Outcome.SKIPPED, "", "the CIF that the model was read from cannot be read any more")
    if reading.model is None:
        finding = reading.findings[0]
        return refute(PROPERTY, f"{TEXT} is wrong: line {finding.span.line}: {finding.message}")
    try:
        comparison = _Comparison(model, reading.model)
    except _DifferenceError as fault:
        return refute(PROPERTY, f"{TEXT} is wrong: {fault}")
    return with_enough_memory(comparison.run, MEMORY)


class _DifferenceError(ValueError):
    """A specification has other plants, events or values than the model."""


class _Comparison:
    """A model and its CIF over the same decision diagrams."""

    def __init__(self, model: sct.SupervisoryControlModel, specification: sct.SupervisoryControlModel) -> None:
        """Pair the elements; raise _DifferenceError if more than the supervisors differ."""
        self._model = model
        self._theirs: dict[Any, Any] = {}
        names = {plant.name for plant in model.plants}
        supervisors = [plant for plant in specification.plants if plant.name not in names]
        others = [plant for plant in specification.plants if plant.name in names]
        self._pair("enumerations", model.enumerations, specification.enumerations)
        self._pair("plants", model.plants, others)
        for plant in model.plants:
            for kind in ("locations", "variables", "inputs", "events"):
                self._pair(kind, getattr(plant, kind), getattr(self._theirs[plant], kind))
        if any(len(plant.locations) != 1 or plant.variables for plant in supervisors):
            raise _DifferenceError("the supervisor has a state")
        only = [location for plant in supervisors for location in plant.locations]
        if not all(location.initial and location.marked for location in only):
            raise _DifferenceError("the supervisor does not start, or is not marked")
        self._layout = BitLayout(model)
        self._their_layout = copy(self._layout)
        self._their_layout.model = specification
        self._their_layout.domains = {
            self._theirs[element]: replace(own, element=self._theirs[element])
            for element, own in self._layout.domains.items()
        }
        self._their_layout.state = [self._their_layout.domains[self._theirs[own.element]] for own in self._layout.state]
        some = next(iter(self._layout.domains.values()))
        for plant in supervisors:
            self._their_layout.domains[plant] = replace(
                some, element=plant, size=1, levels=(), halfway_levels=(), next_levels=()
            )
        self._edges = edges_by_event(specification.plants)
        requirements = [requirement for requirement in specification.requirements if not requirement.ranges]
        self._requirements = requirements_by_event(requirements)

    def _pair(self, what: str, ours: Sequence[ex.NamedElement], theirs: Sequence[ex.NamedElement]) -> None:
        if [_kind(element) for element in ours] != [_kind(element) for element in theirs]:
            raise _DifferenceError(f"its {what} differ from those of the imported text")
        self._theirs.update(zip(ours, theirs, strict=True))

    def run(self, capacity: int) -> Verdict:
        """Return the verdict, with room for `capacity` nodes in the decision diagrams."""
        diagrams = Diagrams(self._layout.levels, capacity)
        encoding, theirs = (Encoding(layout, diagrams) for layout in (self._layout, self._their_layout))
        system = GuardedSystem(self._model, encoding)
        if (system.initial ^ theirs.initial).satisfiable():
            return refute(PROPERTY, f"{TEXT} starts in other states")
        relations = {event: self._relation(event, theirs) for event in system.relations}
        differences = {event: self._differ(system, event, relation) for event, relation in relations.items()}
        anywhere = diagrams.any_of(differences.values())
        if not anywhere.satisfiable():
            return Verdict(PROPERTY, Outcome.PROVED, f"{format_count(len(relations), 'event')} in {system.size}")
        path = system.path_to(anywhere)
        codes = path.states[-1]
        event = next(event for event, states in differences.items() if system.is_in(codes, states))
        difference = self._describe(system, theirs, event, relations[event], encoding.state(codes))
        return refute(PROPERTY, f"{difference}{where(system, event, codes)}", system.trace(path))

    def _relation(self, event: sct.Event, theirs: Encoding) -> EventRelation:
        counterpart = self._theirs[event]
        edges = list(self._edges.get(counterpart, {}).values())
        return EventRelation(counterpart, edges, self._requirements.get(counterpart, []), theirs)

    @staticmethod
    def _differ(system: GuardedSystem, event: sct.Event, relation: EventRelation) -> Diagram:
        """Return the reachable states in which the effects of an event differ."""
        allowed, permitted = system.allowed[event], relation.enabled & relation.requirement
        differ = (allowed ^ permitted) & system.controlled
        if differ.satisfiable():
            return differ
        both = allowed & system.controlled
        moved = (system.relations[event].with_inputs() ^ relation.with_inputs()) & both
        return both if moved.satisfiable() else differ

    def _describe(
        self, system: GuardedSystem, theirs: Encoding, event: sct.Event, relation: EventRelation, here: Diagram
    ) -> str:
        """Return how an event differs between the generated CIF and the model in a state, as text."""
        step = event_in_words(event, {})
        happens = (relation.enabled & relation.requirement & here).satisfiable()
        for edge in (edge for edges in self._edges.get(self._theirs[event], {}).values() for edge in edges):
            taken = here & theirs.source(edge) & theirs.holds(edge.guard)
            for update in edge.updates if happens else ():
                if (taken & ~in_range(update, theirs)).satisfiable():
                    return f"{step} sets `{update.variable.name}` to a value out of its range in {TEXT}"
        if happens and (system.allowed[event] & here).satisfiable():
            return f"{step} leads elsewhere in {TEXT}"
        return on_one_side(step, TEXT, translated=happens)


def _kind(element: Any) -> tuple[Any, ...]:
    """Return the properties that corresponding elements share."""
    match element:
        case sct.DiscreteVariable() | sct.Input():
            own = domain(element.type)
            return element.name, own.low, own.size
        case sct.Event():
            return element.name, element.controllable
        case sct.Location():
            return element.name, element.initial, element.marked
        case sct.Plant():
            return element.name, element.kind
    return (element.name,)
