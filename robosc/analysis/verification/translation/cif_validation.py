"""Compares both files of CIF, read back, with the model: each event, in all states, symbolically."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from robosc.analysis.verification.cif_reading import CifError, DepthError, Specification, read
from robosc.analysis.verification.system import SupervisedSystem, counted
from robosc.analysis.verification.translation.differences import different, happening, on_one_side, refuted, where
from robosc.analysis.verification.translation.transitions import (
    AmbiguityError,
    Transition,
    of_system,
    participants,
    together,
)
from robosc.analysis.verification.translation.twins import Twins
from robosc.analysis.verification.verdict import Outcome, Verdict
from robosc.diagnostics import ModelError
from robosc.metamodel import sct
from robosc.semantics.recursion import deep_recursion
from robosc.synthesis import MEMORY, arithmetic
from robosc.synthesis.bdd import Diagrams, with_enough_memory
from robosc.synthesis.decoding import pick
from robosc.synthesis.encoding import Encoding, Layout, smallest

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Element

    _Bits = tuple[Element | None, tuple[Diagram, ...], tuple[Diagram, ...], Diagram]

PROPERTY = "cif-translation"
TEXT = "the generated CIF"
UNSUPERVISED = f"{TEXT} without supervisor"


@deep_recursion()
def validate_cif(model: sct.SupervisoryControlModel, files: Mapping[str, str]) -> Verdict:
    """Whether `<robot>.cif` means the model's plants and requirements, and `<robot>.supervised.cif` its supervisor.

    States correspond by `Twins`; then initial and marked states must be the same, and every event must do the same in
    every state, reachable or not. `files` are the texts by their names. Raises MemoryError where the decision diagrams
    take more than 4 GB.
    """
    verdicts = (
        _validate(model, files[f"{model.name}.cif"], supervised=False),
        _validate(model, files[f"{model.name}.supervised.cif"], supervised=True),
    )
    return next((each for each in verdicts if each.outcome is not Outcome.PROVED), verdicts[-1])


def _validate(model: sct.SupervisoryControlModel, text: str, *, supervised: bool) -> Verdict:
    what = TEXT if supervised else UNSUPERVISED
    try:
        specification = read(text)
        comparison = _Comparison(model, specification, Twins(model, specification.model), supervised=supervised)
        return with_enough_memory(comparison.run, MEMORY)
    except DepthError as fault:
        return Verdict(PROPERTY, Outcome.SKIPPED, "", f"{what} can't be read: {fault}")
    except (CifError, AmbiguityError, ModelError) as fault:
        return refuted(PROPERTY, f"{what} is wrong: {fault}")


@dataclass(frozen=True)
class _Difference:
    """In which states, with which inputs, the model and its CIF have other bits.

    They are of an element after the event where it can happen in both, or, without an element, of whether it can: by
    the plants, or where it is `asked`, by the requirements.
    """

    event: sct.Event
    element: Element | None
    ours: tuple[Diagram, ...]
    theirs: tuple[Diagram, ...]
    where: Diagram
    asked: bool = False


class _Comparison:
    """A model and its CIF over the same decision diagrams: a value has the code that its twin has.

    Under a supervisor what is asked is part of what can happen; without it, it is a question of its own.
    """

    def __init__(
        self, model: sct.SupervisoryControlModel, specification: Specification, twins: Twins, *, supervised: bool
    ) -> None:
        """Raises CifError where there is a supervisor and none is due."""
        if not supervised and (specification.supervisor is not None or specification.invariants):
            raise CifError("it says what a supervisor does")
        self._model = model
        self._twins = twins
        self._supervised = supervised
        self._text = TEXT if supervised else UNSUPERVISED
        self._asked = _by_event(model.requirements)
        self._invariants = _by_event([*specification.invariants, *specification.model.requirements])
        self._layout = Layout(model)
        self._inputs = [each for each in self._layout.domains.values() if isinstance(each.element, sct.Input)]
        self._their_layout = copy(self._layout)
        self._their_layout.domains = {}
        for each, domain in self._layout.domains.items():
            twin = twins.holding(each)
            self._their_layout.domains[twin] = replace(domain, element=twin)
            if twin is not twins[each]:  # the location of such a plant is no part of its state
                single = replace(domain, element=twins[each], size=1, levels=(), halfway_levels=(), next_levels=())
                self._their_layout.domains[twins[each]] = single
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
        system = SupervisedSystem(self._model, encoding, guards=self._supervised)
        held = ((each.element, self._twins.holding(each.element)) for each in self._layout.state)
        initial = {each: self._initial(twin, theirs) for each, twin in held if isinstance(twin, sct.DiscreteVariable)}
        if any(code != encoding.initial_codes[each] for each, code in initial.items()):
            return refuted(PROPERTY, f"at the start {different(initial, encoding.initial_codes, self._text)}")
        found = list(self._differences(system, theirs))
        if not found:
            evidence = f"{counted(len(system.relations), 'event')} in both files, each in every state"
            return Verdict(PROPERTY, Outcome.PROVED, evidence)
        reached = [each for each in found if (each.where & system.reachable).satisfiable()]
        if not reached:
            codes = pick(found[0].where, self._layout.domains.values())
            return refuted(PROPERTY, f"{self._said(system, found[0], codes)}, though nothing leads there")
        inputs = encoding.diagrams.cube(level for each in self._inputs for level in each.levels)
        path = system.path_to(reached[0].where.exists(inputs) & system.reachable)
        codes = path.states[-1] | pick(reached[0].where & encoding.state(path.states[-1]), self._inputs)
        return refuted(PROPERTY, self._said(system, reached[0], codes), system.trace(path))

    @staticmethod
    def _initial(twin: sct.DiscreteVariable, theirs: Encoding) -> int:
        """The code of a variable's initial value in CIF."""
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
            if not self._supervised:
                ours = _allowed(self._asked.get(event, []), encoding)
                asked = _allowed(self._invariants.get(self._twins.event(event), []), theirs)
                if ((ours ^ asked) & valid).satisfiable():
                    yield _Difference(event, None, (ours,), (asked,), (ours ^ asked) & valid, asked=True)
            twin = self._their_transition(event, theirs)
            compared: list[_Bits] = [(None, (transition.enabled,), (twin.enabled,), encoding.diagrams.true)]
            both = transition.enabled & twin.enabled
            for element in dict.fromkeys([*transition.after, *(self._twins.original(each) for each in twin.after)]):
                bits = transition.bits(element, encoding), twin.bits(self._twins.holding(element), theirs)
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
        if self._supervised:
            enabled &= _allowed(self._invariants.get(twin, []), theirs)
        return Transition(enabled, transition.after)

    def _said(self, system: SupervisedSystem, difference: _Difference, codes: Mapping[Element, int]) -> str:
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
            what = on_one_side(step, self._text, translated=bool(theirs))
        else:
            what = f"after {step}, {different({element: theirs}, {element: ours}, self._text)}"
        asked = self._asked.get(event, []) if difference.asked else []
        return ("by the requirements " if difference.asked else "") + what + where(system, event, codes, asked)


def _by_event(requirements: Iterable[sct.Requirement]) -> dict[sct.Event | None, list[sct.Requirement]]:
    found: dict[sct.Event | None, list[sct.Requirement]] = {}
    for each in requirements:
        found.setdefault(each.event, []).append(each)
    return found


def _allowed(requirements: Iterable[sct.Requirement], encoding: Encoding) -> Diagram:
    """Where all requirements of an event let it happen."""
    allowed = encoding.diagrams.true
    for each in requirements:
        holds = encoding.holds(each.condition)
        allowed &= ~holds if each.kind == sct.RequirementKind.disables else holds
    return allowed
