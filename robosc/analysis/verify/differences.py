"""Differences between a model and a translation, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.analysis.paths import TraceStep
from robosc.analysis.verify.verdict import Outcome, Verdict
from robosc.analysis.wording import condition, describe_event
from robosc.model.semantics.roles import event_name
from robosc.synthesis.decoding import value
from robosc.synthesis.encoding import domain_size, referenced_elements, smallest

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from robosc.analysis.system import GuardedSystem
    from robosc.model import sct
    from robosc.synthesis.decoding import Value
    from robosc.synthesis.encoding import Element


def event_in_words(event: sct.Event, inputs: Mapping[Element, int]) -> str:
    """Return the event with those of its inputs whose codes are given."""
    values = {parameter.name: value(parameter, inputs[parameter]) for parameter in event.inputs if parameter in inputs}
    meaning = describe_event(event).removeprefix(event_name(event))
    return f"`{TraceStep(event_name(event), values)}`{meaning}"


def on_one_side(step: str, translation: str, *, translated: bool) -> str:
    """Return a clause which states that an event can happen only in the translation, or only in the model."""
    sides = (translation, "the model") if translated else ("the model", translation)
    return f"{step} can happen in {sides[0]} and not in {sides[1]}"


def different(theirs: Mapping[Element, int], ours: Mapping[Element, int], translation: str) -> str:
    """Return the first element whose code differs in the translation, with both values, as text."""
    element = next(cell for cell in theirs if theirs[cell] != ours[cell])
    values = [condition([(element, _value(element, codes[element]))]) for codes in (theirs, ours)]
    return f"{translation} has `{values[0]}` and the model `{values[1]}`"


def where(
    system: GuardedSystem, event: sct.Event, state: Mapping[Element, int], requirements: Iterable[sct.Requirement] = ()
) -> str:
    """Return the part of a state that an event and its requirements depend on, as text."""
    touched = set(system.relations[event].touched)
    if event in system.guards:
        touched.update(
            referenced_elements(system.guards[event].requirement), referenced_elements(system.guards[event].synthesis)
        )
    for requirement in requirements:
        touched.update(referenced_elements(requirement.condition))
    elements = [element for plant in system.model.plants for element in (plant, *plant.variables) if element in touched]
    condition = system.where(state, elements)
    return f" where `{condition}`" if condition else ""


def refute(question: str, explanation: str, way: tuple[TraceStep, ...] = ()) -> Verdict:
    """Return the verdict on a translation that differs from the model."""
    return Verdict(question, Outcome.REFUTED, "", explanation, way)


def _value(element: Element, code: int) -> Value:
    """Return the value of a code, or a number if it is outside of the domain."""
    if code < domain_size(element):
        return value(element, code)
    return smallest(element) + code - (2**64 if code >= 2**63 else 0)
