"""Proves or refutes that a supervised system keeps its promises, and that its outputs are what it is.

    verdicts = verify(Models(model_with_supervisor), Configuration())

`properties` and `response` are about the supervised system, on decision diagrams; the states that the control loop
comes to are found in `loop`. `c_validation` and `cif_validation` are translation validation: they do not ask how a text
was made, but read it anew, the C with a compiler, the CIF with a grammar of its own, and compare it with the model
(Pnueli, Siegel, Singerman: Translation validation, TACAS 1998). `model_reading` does so the other way: it reads the
text of the robot anew, and holds the plants and the engine model that were made of it against that.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.analysis.system import GuardedSystem
from robosc.analysis.verify import c_validation, cif_extension_validation, controller_reading, model_reading
from robosc.analysis.verify.c_exploration import Effort
from robosc.analysis.verify.c_validation import validate_c, validate_generated_c, validate_loop
from robosc.analysis.verify.cif_validation import validate_cif
from robosc.analysis.verify.controller_reading import validate_controller
from robosc.analysis.verify.loop_exploration import LoopEffort
from robosc.analysis.verify.model_reading import validate_model
from robosc.analysis.verify.properties import properties
from robosc.analysis.verify.verdict import Outcome, Verdict, timed
from robosc.m2t import cif, supervisor
from robosc.semantics.roles import is_from_cif
from robosc.synthesis import MEMORY, encoded

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from robosc.configuration import Configuration
    from robosc.m2t.models import Models
    from robosc.metamodel import sct
    from robosc.synthesis.encoding import Encoding

__all__ = [
    "Effort",
    "LoopEffort",
    "Outcome",
    "Verdict",
    "validate",
    "validate_c",
    "validate_cif",
    "validate_controller",
    "validate_loop",
    "validate_model",
    "verify",
    "verify_system",
]


def verify(
    models: Models, configuration: Configuration, begin: Callable[[str], None] = lambda _: None
) -> list[Verdict]:
    """Examine a supervised model, and give a verdict for each property.

    `begin` is called with the name of each step before it.

    Examined are the model's properties (`verify_system`), its plants and its controller against the robot's text
    (skipped where `models.robosc` is None), and the C and CIF that are generated with this configuration (`validate`).
    Raises ValueError without a supervisor, MemoryError where decision diagrams take more than 4 GB.
    """
    begin(model_reading.PROPERTY)
    read = timed(validate_model, models.robosc, models.sct)
    begin(controller_reading.PROPERTY)
    controllers = [] if is_from_cif(models.sct) else [timed(validate_controller, models)]
    begin("properties")
    system = verify_system(models.sct)
    begin("generated C and CIF")
    return [*system, read, *controllers, *validate(models, configuration)]


def verify_system(model: sct.SupervisoryControlModel, *, memory: int = MEMORY) -> list[Verdict]:
    """The verdicts on a model under its supervisor, whatever it was made from, the model left as it is.

    All but the seconds is the same on every run. `memory` bounds the bytes for decision diagrams: MemoryError is raised
    beyond. Raises ValueError where the model has no supervisor.
    """

    def look(encoding: Encoding) -> list[Verdict]:
        return [timed(examine) for examine in properties(GuardedSystem(model, encoding))]

    return encoded(model, look, memory)


def validate(models: Models, configuration: Configuration) -> list[Verdict]:
    """The verdicts on the C, its control loop too, and on the CIF that are generated from a model with its supervisor.

    Raises ValueError where the model has no supervisor, MemoryError where decision diagrams take more than 4 GB.
    """
    targets: list[tuple[Sequence[str], Any, Callable[..., list[Verdict]]]] = [
        (c_validation.PROPERTIES[: 1 if is_from_cif(models.sct) else None], supervisor, validate_generated_c),
        ((cif_extension_validation.PROPERTY,), cif, lambda *generated: [timed(validate_cif, *generated)]),
    ]
    verdicts = []
    for questions, target, examine in targets:
        obstacles = target.preconditions(models, configuration)
        verdicts += (
            [Verdict(question, Outcome.SKIPPED, "", obstacles[0].message) for question in questions]
            if obstacles
            else examine(models.sct, target.generate(models, configuration))
        )
    return verdicts
