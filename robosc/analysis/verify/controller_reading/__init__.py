"""Validation of the controller's additions to plants and requirements by a second reading of the robot's text.

    verdict = validate_controller(models)

The generated C and the interpreter both execute the engine model: timers, batches, groups, the order of events and
data, and the bound of silent events. `loop-translation` compares the C with the interpreter, so it cannot detect a
fault of that model. `model_reading.controller` derives the meaning of the text from the pages of the language alone.
`loop`, `times`, `violations` and `topics` compare it with the engine model and the ROS graph. `data` compares the
conditions of the engine model on the inputs of commands with the supervised model.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.analysis.system import format_count
from robosc.analysis.verify.controller_reading.data import DataComparison
from robosc.analysis.verify.controller_reading.loop import LoopComparison
from robosc.analysis.verify.controller_reading.times import Effort, TimeComparison
from robosc.analysis.verify.controller_reading.topics import compare_topics
from robosc.analysis.verify.controller_reading.violations import ViolationComparison
from robosc.analysis.verify.model_reading.controller import ControllerText
from robosc.analysis.verify.model_reading.lockstep import DifferenceError
from robosc.analysis.verify.model_reading.names import NotReadError
from robosc.analysis.verify.model_reading.plants import read_plants
from robosc.analysis.verify.model_reading.text import UnlikeError, read_text
from robosc.analysis.verify.verdict import Outcome, Verdict

if TYPE_CHECKING:
    from robosc.m2t.models import Models

#: Name of the property in verdicts.
PROPERTY = "controller-translation"
ENOUGH = Effort()
_UNLIKE = "the plants are not those of the text: see model-translation"

__all__ = ["PROPERTY", "Effort", "validate_controller"]


def validate_controller(models: Models, effort: Effort = ENOUGH) -> Verdict:
    """Return whether timers, batches, groups, orders, bounds and violations of assumptions agree with the text.

    The model has its supervisor. The topics of the ROS graph are compared if there is one. The property is skipped
    without the text, and if the plants differ from the text: model-translation reports the difference.
    """
    if models.robosc is None:
        return Verdict(PROPERTY, Outcome.SKIPPED, "", "the model was not read from its text")
    try:
        plants = read_plants(models.sct)
        text = read_text(models.robosc, plants)
    except NotReadError as unknown:
        return Verdict(PROPERTY, Outcome.SKIPPED, "", str(unknown))
    except UnlikeError:
        return Verdict(PROPERTY, Outcome.SKIPPED, "", _UNLIKE)
    if text.events.keys() != plants.events.keys() or text.domains.keys() != plants.domains.keys():
        return Verdict(PROPERTY, Outcome.SKIPPED, "", _UNLIKE)
    controller, executed = ControllerText(text), models.engine
    times = TimeComparison(controller, plants, executed, effort)
    data = DataComparison(executed, effort.values)
    violations = ViolationComparison(controller, plants, executed, effort.values)
    try:
        LoopComparison(controller, plants, executed).run()
        if models.rosgraph is not None:
            compare_topics(controller, plants, models.rosgraph)
        times.run()
        violations.run()
        data.run()
    except DifferenceError as difference:
        return Verdict(PROPERTY, Outcome.REFUTED, "", difference.explanation, difference.trace, difference.onwards)
    number = sum(map(len, controller.times.values()))
    evidence = f"{format_count(number, 'time')}, {format_count(len(text.events), 'event')}"
    if violations.is_sampled:
        return Verdict(PROPERTY, Outcome.SAMPLED, f"{evidence}, without some violations of assumptions")
    if data.is_sampled:
        return Verdict(PROPERTY, Outcome.SAMPLED, f"{evidence}, without some conditions on the data of commands")
    if times.is_sampled:
        return Verdict(PROPERTY, Outcome.SAMPLED, f"{evidence}, some with random data")
    return Verdict(PROPERTY, Outcome.PROVED, evidence)
