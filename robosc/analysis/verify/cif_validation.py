"""Validation of both generated CIF files: each event, in all states, symbolically."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from robosc.analysis.system import GuardedSystem, format_count
from robosc.analysis.verify.cif_extension_validation import PROPERTY, TEXT, validate_extension
from robosc.analysis.verify.cif_reading import CifError, Specification, read
from robosc.analysis.verify.correspondence import Correspondence
from robosc.analysis.verify.differences import different, event_in_words, on_one_side, refute, where
from robosc.analysis.verify.transitions import (
    AmbiguityError,
    Transition,
    of_system,
    together,
)
from robosc.analysis.verify.verdict import Outcome, Verdict
from robosc.base.diagnostics import ModelError
from robosc.model import sct
from robosc.model.semantics.edges import edges_by_event
from robosc.model.semantics.roles import is_from_cif
from robosc.synthesis import MEMORY, arithmetic
from robosc.synthesis.bdd import Diagrams, with_enough_memory
from robosc.synthesis.encoding import BitLayout, Encoding, pick, referenced_elements, smallest
from robosc.synthesis.relation import requirements_by_event

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Element

    _Bits = tuple[Element | None, tuple[Diagram, ...], tuple[Diagram, ...], Diagram]

UNSUPERVISED = f"{TEXT} without supervisor"


def validate_cif(model: sct.SupervisoryControlModel, files: Mapping[str, str]) -> Verdict:
    """Return whether the generated CIF files agree with the model's plants, requirements and supervisor.

    `<robot>.cif` must have the plants and requirements, `<robot>.supervised.cif` the supervisor. States correspond by
    `Correspondence`. Initial and marked states must be the same, and every event must have the same effect in every
    state, reachable or not. `files` maps names to texts. A model from CIF is not written again; `validate_extension`
    validates it. Raises MemoryError if the decision diagrams take more than 4 GB.
    """
    if is_from_cif(model):
        return validate_extension(model, files[f"{model.name}.supervised.cif"], files.get(f"{model.name}.cif"))
    verdicts = (
        _validate(model, files[f"{model.name}.cif"], supervised=False),
        _validate(model, files[f"{model.name}.supervised.cif"], supervised=True),
    )
    return next((verdict for verdict in verdicts if verdict.outcome is not Outcome.PROVED), verdicts[-1])


def _validate(model: sct.SupervisoryControlModel, text: str, *, supervised: bool) -> Verdict:
    what = TEXT if supervised else UNSUPERVISED
    try:
        specification = read(text)
        comparison = _Comparison(
            model, specification, Correspondence(model, specification.model), supervised=supervised
        )
        return with_enough_memory(comparison.run, MEMORY)
    except (CifError, AmbiguityError, ModelError) as fault:
        return refute(PROPERTY, f"{what} is wrong: {fault}")


@dataclass(frozen=True)
class _Difference:
    """States and inputs in which the model and its CIF disagree about an event.

    With an `element`, the bits are those of its code after the event, where both allow the event. Without one, the bit
    is whether the plants enable the event, or, if `by_requirement`, whether the requirements allow it.
    """

    event: sct.Event
    element: Element | None
    ours: tuple[Diagram, ...]
    theirs: tuple[Diagram, ...]
    where: Diagram
    by_requirement: bool = False


class _Comparison:
    """A model and its CIF over the same decision diagrams: corresponding values have the same code.

    Under a supervisor, the requirements are part of the enabling condition. Without one, they are compared separately.
    """

    def __init__(
        self,
        model: sct.SupervisoryControlModel,
        specification: Specification,
        correspondence: Correspondence,
        *,
        supervised: bool,
    ) -> None:
        """Pair the elements; raise CifError if the text has a supervisor that it should not have."""
        if not supervised and (specification.supervisor is not None or specification.invariants):
            raise CifError("it has statements of a supervisor")
        if supervised and specification.model.invariants:
            raise CifError("it has an invariant requirement, which no supervised specification has")
        if supervised and specification.model.reachabilityRequirements:
            raise CifError("it has a requirement about reachable states, which no supervised specification has")
        self._model = model
        self._correspondence = correspondence
        self._supervised = supervised
        self._text = TEXT if supervised else UNSUPERVISED
        self._requirements = requirements_by_event(model.requirements)
        self._their_invariants = list(specification.model.invariants)
        self._their_goals = list(specification.model.reachabilityRequirements)
        self._invariants = requirements_by_event([*specification.invariants, *specification.model.requirements])
        self._layout = BitLayout(model)
        self._inputs = [domain for domain in self._layout.domains.values() if isinstance(domain.element, sct.Input)]
        self._their_layout = copy(self._layout)
        self._their_layout.domains = {}
        for element, domain in self._layout.domains.items():
            counterpart = correspondence.holding(element)
            self._their_layout.domains[counterpart] = replace(domain, element=counterpart)
            if counterpart is not correspondence[element]:  # The location of such a plant is no part of its state.
                single = replace(
                    domain, element=correspondence[element], size=1, levels=(), halfway_levels=(), next_levels=()
                )
                self._their_layout.domains[correspondence[element]] = single
        self._edges = edges_by_event(specification.model.plants)
        supervisor = specification.supervisor
        self._alphabet = frozenset(specification.alphabet)
        self._loops = {} if supervisor is None else edges_by_event([supervisor])

    def run(self, capacity: int) -> Verdict:
        """Return the verdict, with room for `capacity` nodes. Raises CifError, AmbiguityError, ModelError."""
        encoding, theirs = (
            Encoding(layout, diagrams)
            for diagrams in [Diagrams(self._layout.levels, capacity)]
            for layout in (self._layout, self._their_layout)
        )
        system = GuardedSystem(self._model, encoding, guards=self._supervised)
        counterparts = ((domain.element, self._correspondence.holding(domain.element)) for domain in self._layout.state)
        initial = {
            element: self._initial(counterpart, theirs)
            for element, counterpart in counterparts
            if isinstance(counterpart, sct.DiscreteVariable)
        }
        if any(code != encoding.initial_codes[element] for element, code in initial.items()):
            return refute(PROPERTY, f"at the start {different(initial, encoding.initial_codes, self._text)}")
        fault = None
        if not self._supervised:
            fault = self._invariants_differ(system, theirs) or self._goals_differ(system, theirs)
        if fault is not None:
            return fault
        differences = list(self._differences(system, theirs))
        if not differences:
            evidence = f"{format_count(len(system.relations), 'event')} in both files, each in every state"
            return Verdict(PROPERTY, Outcome.PROVED, evidence)
        reached = [difference for difference in differences if (difference.where & system.controlled).satisfiable()]
        if not reached:
            codes = pick(differences[0].where, self._layout.domains.values())
            difference = self._describe(system, differences[0], codes)
            return refute(PROPERTY, f"{difference}, in a state that the robot never reaches")
        inputs = encoding.diagrams.cube(level for domain in self._inputs for level in domain.levels)
        path = system.path_to(reached[0].where.exists(inputs) & system.controlled)
        codes = path.states[-1] | pick(reached[0].where & encoding.state(path.states[-1]), self._inputs)
        return refute(PROPERTY, self._describe(system, reached[0], codes), system.trace(path))

    def _invariants_differ(self, system: GuardedSystem, theirs: Encoding) -> Verdict | None:
        """Return a refutation if the invariants allow other states in CIF; None if they agree."""
        encoding = system.encoding
        valid = encoding.diagrams.all_of(encoding.in_domain(domain.element) for domain in self._layout.state)
        ours, cif_states = (
            view.diagrams.any_of(~view.holds(invariant.condition) for invariant in invariants)
            for view, invariants in ((encoding, self._model.invariants), (theirs, self._their_invariants))
        )
        differ = (ours ^ cif_states) & valid
        if not differ.satisfiable():
            return None
        codes = pick(differ, self._layout.state)
        allowed = "forbids" if system.is_in(codes, cif_states) else "allows"
        elements = (
            element for invariant in self._model.invariants for element in referenced_elements(invariant.condition)
        )
        return refute(PROPERTY, f"by its invariants {self._text} {allowed} the state `{system.where(codes, elements)}`")

    def _goals_differ(self, system: GuardedSystem, theirs: Encoding) -> Verdict | None:
        """Return a refutation if CIF requires other states to be reachable; None if they agree."""
        encoding, required = system.encoding, self._model.reachabilityRequirements
        if len(required) != len(self._their_goals):
            count = format_count(len(self._their_goals), "requirement")
            return refute(PROPERTY, f"{self._text} has {count} about reachable states, the model has {len(required)}")
        valid = encoding.diagrams.all_of(encoding.in_domain(domain.element) for domain in self._layout.state)
        for ours, other in zip(required, self._their_goals, strict=True):
            if ours.bound != other.bound:
                return refute(PROPERTY, f"a requirement about reachable states has another bound in {self._text}")
            for part, counterpart in (
                (ours.condition, other.condition),
                (ours.premise, other.premise),
                (ours.pathCondition, other.pathCondition),
            ):
                differ = (encoding.holds(part) ^ theirs.holds(counterpart)) & valid
                if differ.satisfiable():
                    codes = pick(differ, self._layout.state)
                    elements = [
                        *referenced_elements(ours.condition),
                        *referenced_elements(ours.premise),
                        *referenced_elements(ours.pathCondition),
                    ]
                    shown = system.where(codes, elements)
                    return refute(PROPERTY, f"a requirement about reachable states differs in the state `{shown}`")
        return None

    @staticmethod
    def _initial(counterpart: sct.DiscreteVariable, theirs: Encoding) -> int:
        """Return the code of a variable's initial value in CIF."""
        assert counterpart.initial is not None
        value = arithmetic.value_of(theirs.vector(counterpart.initial))
        if value is None:
            raise CifError(f"the initial value of '{counterpart.name}' is not a constant")
        return value - smallest(counterpart)

    def _differences(self, system: GuardedSystem, theirs: Encoding) -> Iterator[_Difference]:
        encoding = system.encoding
        valid = encoding.diagrams.all_of(map(encoding.in_domain, self._layout.domains))
        for event, transition in of_system(system).items():
            if not self._supervised:
                ours = _allowed(self._requirements.get(event, []), encoding)
                permitted = _allowed(self._invariants.get(self._correspondence.event(event) or event, []), theirs)
                if ((ours ^ permitted) & valid).satisfiable():
                    yield _Difference(
                        event, None, (ours,), (permitted,), (ours ^ permitted) & valid, by_requirement=True
                    )
            counterpart = self._their_transition(event, theirs)
            compared: list[_Bits] = [(None, (transition.enabled,), (counterpart.enabled,), encoding.diagrams.true)]
            both = transition.enabled & counterpart.enabled
            for element in dict.fromkeys(
                [*transition.after, *(self._correspondence.original(cell) for cell in counterpart.after)]
            ):
                bits = (
                    transition.bits(element, encoding),
                    counterpart.bits(self._correspondence.holding(element), theirs),
                )
                compared.append((element, *bits, both))
            for element, our_bits, their_bits, within in compared:
                pairs = zip(our_bits, their_bits, strict=True)
                differ = encoding.diagrams.any_of((our_bit ^ their_bit) & within for our_bit, their_bit in pairs)
                # Most are equal even for invalid codes. Then the many domains need not be examined.
                if differ.satisfiable() and (differ & valid).satisfiable():
                    yield _Difference(event, element, our_bits, their_bits, differ & valid)

    def _their_transition(self, event: sct.Event, theirs: Encoding) -> Transition:
        """Return the effect of the event in CIF; at least one automaton must have the event."""
        counterpart, diagrams = self._correspondence.event(event), theirs.diagrams
        if counterpart is None:
            return Transition(diagrams.false, {})
        transition = together(self._edges.get(counterpart, {}).values(), theirs, saturates=False)
        enabled = transition.enabled if counterpart in self._edges or counterpart in self._alphabet else diagrams.false
        if counterpart in self._alphabet:
            edges = (edge for edges in self._loops.get(counterpart, {}).values() for edge in edges)
            enabled &= diagrams.any_of(theirs.holds(edge.guard) for edge in edges)
        if self._supervised:
            enabled &= _allowed(self._invariants.get(counterpart, []), theirs)
        return Transition(enabled, transition.after)

    def _describe(self, system: GuardedSystem, difference: _Difference, codes: Mapping[Element, int]) -> str:
        """Return the difference in the state and inputs with these codes, as text."""
        event, element = difference.event, difference.element
        here = system.diagrams.all_of(system.encoding.has_code(cell, code) for cell, code in codes.items())
        ours, theirs = (
            sum((bit & here).satisfiable() << place for place, bit in enumerate(bits))
            for bits in (difference.ours, difference.theirs)
        )
        step = event_in_words(event, codes)
        if element is None:
            what = on_one_side(step, self._text, translated=bool(theirs))
        else:
            what = f"after {step}, {different({element: theirs}, {element: ours}, self._text)}"
        requirements = self._requirements.get(event, []) if difference.by_requirement else []
        return (
            ("by the requirements " if difference.by_requirement else "")
            + what
            + where(system, event, codes, requirements)
        )


def _allowed(requirements: Iterable[sct.Requirement], encoding: Encoding) -> Diagram:
    """Return the states in which all requirements of an event allow it."""
    return encoding.diagrams.all_of(encoding.permits(requirement) for requirement in requirements)
