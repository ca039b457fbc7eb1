"""Translation validation: whether what is generated means what the supervised model says.

It does not ask how a text was made, but reads it anew, the C with a compiler, the CIF with a grammar of its own, and
compares it with the model (Pnueli, Siegel, Singerman: Translation validation, TACAS 1998).
"""

from __future__ import annotations

from dataclasses import replace
from time import perf_counter
from typing import TYPE_CHECKING

from robosc.analysis.verification.translation.c_validation import PROPERTY as C
from robosc.analysis.verification.translation.c_validation import Effort, validate_c
from robosc.analysis.verification.translation.cif_validation import PROPERTY as CIF
from robosc.analysis.verification.translation.cif_validation import validate_cif
from robosc.analysis.verification.verdict import Outcome, Verdict
from robosc.m2t import cif, supervisor

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.configuration import Configuration
    from robosc.m2t.models import Models

__all__ = ["Effort", "validate", "validate_c", "validate_cif"]


def validate(models: Models, configuration: Configuration) -> list[Verdict]:
    """The verdicts on the C and on the CIF that are generated from a model with its supervisor.

    Raises ValueError where the model has no supervisor, MemoryError where decision diagrams take more than 4 GB.
    """
    model = models.sct

    def generated_c() -> Verdict:
        return validate_c(model, supervisor.generate(models, configuration))

    def generated_cif() -> Verdict:
        return validate_cif(model, cif.generate(models, configuration))

    return [
        _timed(C, [each.message for each in supervisor.preconditions(models, configuration)], generated_c),
        _timed(CIF, [each.message for each in cif.preconditions(models, configuration)], generated_cif),
    ]


def _timed(name: str, obstacles: list[str], examine: Callable[[], Verdict]) -> Verdict:
    """The verdict with its seconds; skipped where something keeps the translation from being made."""
    if obstacles:
        return Verdict(name, Outcome.SKIPPED, "", obstacles[0])
    began = perf_counter()
    return replace(examine(), seconds=perf_counter() - began)
