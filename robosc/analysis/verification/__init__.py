"""Proves or refutes that a supervised system keeps its promises, and that its outputs are what it is.

verdicts = verify(Models(model_with_supervisor), Configuration())
"""

from __future__ import annotations

from dataclasses import replace
from time import perf_counter
from typing import TYPE_CHECKING

from robosc.analysis.verification.properties import properties
from robosc.analysis.verification.system import SupervisedSystem
from robosc.analysis.verification.translation import validate
from robosc.analysis.verification.verdict import Outcome, Verdict
from robosc.semantics.recursion import deep_recursion
from robosc.synthesis.bdd import Diagrams, with_enough_memory
from robosc.synthesis.encoding import Encoding, Layout

if TYPE_CHECKING:
    from robosc.configuration import Configuration
    from robosc.m2t.models import Models
    from robosc.metamodel import sct

__all__ = ["Outcome", "Verdict", "verify", "verify_system"]


@deep_recursion()
def verify(models: Models, configuration: Configuration) -> list[Verdict]:
    """The verdicts on a model with its supervisor, and on the C and the CIF that the configuration makes of it.

    Raises ValueError where the model has no supervisor, MemoryError where decision diagrams take more than 4 GB.
    """
    return [*verify_system(models.sct), *validate(models, configuration)]


@deep_recursion()
def verify_system(model: sct.SupervisoryControlModel, *, memory: int = 4 << 30) -> list[Verdict]:
    """The verdicts on a model under its supervisor, whatever it was made from, the model left as it is.

    All but the seconds is the same on every run. `memory` bounds the bytes for decision diagrams: MemoryError is raised
    beyond. Raises ValueError where the model has no supervisor.
    """
    layout = Layout(model)
    return with_enough_memory(lambda capacity: _verified(model, layout, capacity), memory)


def _verified(model: sct.SupervisoryControlModel, layout: Layout, capacity: int) -> list[Verdict]:
    system = SupervisedSystem(model, Encoding(layout, Diagrams(layout.levels, capacity)))
    verdicts = []
    for examine in properties(model):
        began = perf_counter()
        verdict = examine(system)
        verdicts.append(replace(verdict, seconds=perf_counter() - began))
    return verdicts
