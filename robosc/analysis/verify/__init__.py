"""Verification of a supervised system, and validation of its generated artifacts.

    verdicts = verify(Models(model_with_supervisor), Configuration())

`properties` and `response` check the supervised system on decision diagrams; `loop` computes the states that the
control loop reaches. `c_validation` and `cif_validation` do translation validation (Pnueli, Siegel, Singerman:
Translation validation, TACAS 1998): independently of the generator, they read the generated text again and compare it
with the model. They read C with a compiler and CIF with a grammar of its own. `model_reading` and `controller_reading`
do the same in the other direction: they read the text of the robot again and compare the plants and the engine model
with it.
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
from robosc.analysis.verify.sent_data import data_can_comply, has_commands_with_data
from robosc.analysis.verify.verdict import Outcome, Verdict, measure
from robosc.base.diagnostics import has_errors
from robosc.m2t import cif, supervisor
from robosc.model.semantics.roles import is_from_cif
from robosc.synthesis import MEMORY, use_encoding

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.language.configuration import Configuration
    from robosc.m2t.models import Models
    from robosc.model import sct
    from robosc.synthesis.encoding import Encoding

__all__ = [
    "PARTS",
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
    """Verify a supervised model, and return a verdict for each property.

    `begin` is called with the name of each of the `PARTS` before it starts.

    The verdicts are about the model's properties (`verify_system`), the constant data of its commands
    (`data_can_comply`, if the supervisor decides with data), its plants and its controller compared with the
    robot's text (skipped if `models.robosc` is None), and the C and CIF that are generated with this configuration
    (`validate`). Raises ValueError if the model has no supervisor, and MemoryError if decision diagrams take more than
    4 GB.
    """
    verdicts = []
    for name, part in PARTS.items():
        begin(name)
        verdicts += part(models, configuration)
    return verdicts


def verify_system(model: sct.SupervisoryControlModel, *, memory: int = MEMORY) -> list[Verdict]:
    """Return the verdicts on a model under its supervisor, without changing the model.

    Every run gives the same verdicts, except for the seconds. `memory` is the limit of the decision diagrams in bytes;
    beyond it, MemoryError is raised. Raises ValueError if the model has no supervisor.
    """

    def look(encoding: Encoding) -> list[Verdict]:
        return [measure(examine) for examine in properties(GuardedSystem(model, encoding))]

    return use_encoding(model, look, memory)


def validate(models: Models, configuration: Configuration) -> list[Verdict]:
    """Return the verdicts on the C with its control loop and on the CIF that are generated from a model.

    Raises ValueError if the model has no supervisor, and MemoryError if decision diagrams take more than 4 GB.
    """
    targets: list[tuple[Sequence[str], Any, Callable[..., list[Verdict]]]] = [
        (c_validation.PROPERTIES[: 1 if is_from_cif(models.sct) else None], supervisor, validate_generated_c),
        ((cif_extension_validation.PROPERTY,), cif, lambda *generated: [measure(validate_cif, *generated)]),
    ]
    verdicts = []
    for questions, target, examine in targets:
        obstacles = [own for own in target.preconditions(models, configuration) if has_errors([own])]
        verdicts += (
            [Verdict(question, Outcome.SKIPPED, "", obstacles[0].message) for question in questions]
            if obstacles
            else examine(models.sct, target.generate(models, configuration))
        )
    return verdicts


def _verify_properties(models: Models, _configuration: Configuration) -> list[Verdict]:
    verdicts = verify_system(models.sct)
    if has_commands_with_data(models.sct):
        verdicts.append(measure(data_can_comply, models))
    return verdicts


def _validate_plants(models: Models, _configuration: Configuration) -> list[Verdict]:
    return [measure(validate_model, models.robosc, models.sct)]


def _validate_controller(models: Models, _configuration: Configuration) -> list[Verdict]:
    return [] if is_from_cif(models.sct) else [measure(validate_controller, models)]


def _validate_artifacts(models: Models, configuration: Configuration) -> list[Verdict]:
    return validate(models, configuration)


#: The parts of a verification by name, in the order of their verdicts. They are independent of each other.
PARTS: Mapping[str, Callable[[Models, Configuration], list[Verdict]]] = {
    "properties": _verify_properties,
    model_reading.PROPERTY: _validate_plants,
    controller_reading.PROPERTY: _validate_controller,
    "generated C and CIF": _validate_artifacts,
}
