"""Compares the supervised CIF, read back, with the supervised model: each event, in all states, symbolically."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from robosc.diagnostics import ModelError
from robosc.metamodel import sct
from robosc.synthesis import MEMORY, arithmetic
from robosc.synthesis.bdd import Diagrams, with_enough_memory
from robosc.synthesis.decoding import pick
from robosc.synthesis.encoding import Encoding, Layout, smallest
from robosc.verification.cif_reading import CifError, Specification, read
from robosc.verification.system import SupervisedSystem, counted
from robosc.verification.translation.differences import different, happening, on_one_side, refuted, where
from robosc.verification.translation.transitions import (
    AmbiguityError,
    Transition,
    of_system,
    participants,
    together,
)
from robosc.verification.translation.twins import Twins
from robosc.verification.verdict import Outcome, Verdict

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Element

    _Bits = tuple[Element | None, tuple[Diagram, ...], tuple[Diagram, ...], Diagram]

PROPERTY = "cif-translation"
TEXT = "the generated CIF"


def validate_cif(model: sct.SupervisoryControlModel, text: str) -> Verdict:
    """Whether the text of `<robot>.supervised.cif` means what the model says with its supervisor.

    States correspond by `Twins`; then initial and marked states must be the same, and every event must do the same in
    every state, reachable or not. Raises MemoryError where the decision diagrams take more than 4 GB.
    """
    try:
        specification = read(text)
        comparison = _Comparison(model, specification, Twins(model, specification.model))
        return with_enough_memory(comparison.run, MEMORY)
    except (CifError, AmbiguityError, ModelError) as fault:
        return refuted(PROPERTY, f"{TEXT} is wrong: {fault}")


@dataclass(frozen=True)
class _Difference:
    """In which states, with which inputs, the model and its CIF have other bits.

    They are of an element after the event where it can happen in both, or, without an element, of whether it can.
    """

    event: sct.Event
    element: Element | None
    ours: tuple[Diagram, ...]
    theirs: tuple[Diagram, ...]
    where: Diagram


class _Comparison:
    """A model and its CIF over the same decision diagrams: a value has the code that its twin has."""

    def __init__(self, model: sct.SupervisoryControlModel, specification: Specification, twins: Twins) -> None:
        self._model = model
        self._twins = twins
        self._invariants: dict[sct.Event, list[sct.Requirement]] = {}
        for each in (*specification.invariants, *specification.model.requirements):
            self._invariants.setdefault(each.event, []).append(each)
        self._layout = Layout(model)
        self._inputs = [each for each in self._layout.domains.values() if isinstance(each.element, sct.Input)]
        self._their_layout = copy(self._layout)
        domains = self._layout.domains.items()
        self._their_layout.domains = {twins[each]: replace(domain, element=twins[each]) for each, domain in domains}
        self._edges = participants(specification.model.plants)
        supervisor = specification.supervisor
        self._alphabet = frozenset(specification.alphabet)
        self._loops = {} if supervisor is None else participants([supervisor])

    def run(self, capacity: int) -> Verdict:
        """The verdict, with so many nodes for the decision diagrams. Raises CifError, AmbiguityError, ModelError."""
        encoding, theirs = (
            Encoding(layout, diagrams)
            for diagrams in [Diagrams(self._layout.levels, capacity)]
            for layout in (self._layout, self._their_layout)
        )
        system = SupervisedSystem(self._model, encoding)
        initial: dict[Element, int] = {
            each: self._initial(each, theirs) for plant in self._model.plants for each in plant.variables
        }
        if any(code != encoding.initial_codes[each] for each, code in initial.items()):
            return refuted(PROPERTY, f"at the start {different(initial, encoding.initial_codes, TEXT)}")
        found = list(self._differences(system, theirs))
        if not found:
            return Verdict(PROPERTY, Outcome.PROVED, f"{counted(len(system.relations), 'event')}, each in every state")
        reached = [each for each in found if (each.where & system.reachable).satisfiable()]
        if not reached:
            codes = pick(found[0].where, self._layout.domains.values())
            return refuted(PROPERTY, f"{self._said(system, found[0], codes)}, though nothing leads there")
        inputs = encoding.diagrams.cube(level for each in self._inputs for level in each.levels)
        path = system.path_to(reached[0].where.exists(inputs) & system.reachable)
        codes = path.states[-1] | pick(reached[0].where & encoding.state(path.states[-1]), self._inputs)
        return refuted(PROPERTY, self._said(system, reached[0], codes), system.trace(path))

    def _initial(self, variable: sct.DiscreteVariable, theirs: Encoding) -> int:
        """The code of a variable's initial value in CIF."""
        twin = self._twins[variable]
        value = arithmetic.value_of(theirs.vector(twin.initial))
        if value is None:
            raise CifError(f"the initial value of '{twin.name}' is no constant")
        return value - smallest(twin)

    def _differences(self, system: SupervisedSystem, theirs: Encoding) -> Iterator[_Difference]:
        encoding = system.encoding
        valid = encoding.diagrams.true
        for each in self._layout.domains:
            valid &= encoding.in_domain(each)
        for event, transition in of_system(system).items():
            twin = self._their_transition(event, theirs)
            compared: list[_Bits] = [(None, (transition.enabled,), (twin.enabled,), encoding.diagrams.true)]
            both = transition.enabled & twin.enabled
            for element in dict.fromkeys([*transition.after, *(self._twins.original(each) for each in twin.after)]):
                bits = transition.bits(element, encoding), twin.bits(self._twins[element], theirs)
                compared.append((element, *bits, both))
            for element, our_bits, their_bits, within in compared:
                differ = encoding.diagrams.false
                for one, other in zip(our_bits, their_bits, strict=True):
                    differ |= (one ^ other) & within
                # Most are the same even for codes without a value: then the many domains need not be looked at.
                if differ.satisfiable() and (differ & valid).satisfiable():
                    yield _Difference(event, element, our_bits, their_bits, differ & valid)

    def _their_transition(self, event: sct.Event, theirs: Encoding) -> Transition:
        """What the event does in CIF: only automata that have it take part, and one of them at least."""
        twin, diagrams = self._twins.event(event), theirs.diagrams
        if twin is None:
            return Transition(diagrams.false, {})
        transition = together(self._edges.get(twin, []), theirs, saturates=False)
        enabled = transition.enabled if twin in self._edges or twin in self._alphabet else diagrams.false
        if twin in self._alphabet:
            allowed = diagrams.false
            for edge in (edge for edges in self._loops.get(twin, []) for edge in edges):
                allowed |= theirs.holds(edge.guard)
            enabled &= allowed
        for each in self._invariants.get(twin, []):
            holds = theirs.holds(each.condition)
            enabled &= ~holds if each.kind == sct.RequirementKind.disables else holds
        return Transition(enabled, transition.after)

    @staticmethod
    def _said(system: SupervisedSystem, difference: _Difference, codes: Mapping[Element, int]) -> str:
        """The difference where state and inputs have these codes."""
        event, element = difference.event, difference.element
        here = system.diagrams.true
        for each, code in codes.items():
            here &= system.encoding.has_code(each, code)
        ours, theirs = (
            sum((bit & here).satisfiable() << place for place, bit in enumerate(bits))
            for bits in (difference.ours, difference.theirs)
        )
        step = happening(event, codes)
        if element is None:
            what = on_one_side(step, TEXT, translated=bool(theirs))
        else:
            what = f"after {step}, {different({element: theirs}, {element: ours}, TEXT)}"
        return what + where(system, event, codes)
