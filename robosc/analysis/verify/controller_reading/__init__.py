"""What the controller adds to plants and requirements, held against a second reading of the robot's text.

    verdict = validate_controller(models)

The engine model is what the generated C and the interpreter both execute: times, batches, groups, the order in which
events and data are tried, the bound of silent events. `loop-translation` compares the C with the interpreter, so it
can't see a fault of that model. `model_reading.controller` says what the text means, by the pages of the language
alone; `loop`, `times` and `topics` compare it with the engine model and the ROS graph.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.analysis.system import counted
from robosc.analysis.verify.controller_reading.loop import LoopComparison
from robosc.analysis.verify.controller_reading.times import Effort, TimeComparison
from robosc.analysis.verify.controller_reading.topics import compare_topics
from robosc.analysis.verify.model_reading.controller import ControllerText
from robosc.analysis.verify.model_reading.lockstep import DifferenceError
from robosc.analysis.verify.model_reading.names import NotReadError
from robosc.analysis.verify.model_reading.plants import read_plants
from robosc.analysis.verify.model_reading.text import UnlikeError, read_text
from robosc.analysis.verify.verdict import Outcome, Verdict

if TYPE_CHECKING:
    from robosc.m2t.models import Models

#: What the verdict is called.
PROPERTY = "controller-translation"
ENOUGH = Effort()
_UNLIKE = "the plants are not those of the text: see model-translation"

__all__ = ["PROPERTY", "Effort", "validate_controller"]


def validate_controller(models: Models, effort: Effort = ENOUGH) -> Verdict:
    """Whether times, batches, groups, orders and bounds of the controller are those of the text.

    The model has its supervisor; of the ROS graph the topics are compared, where there is one. Skipped without the
    text, and where the plants are others than those of the text: model-translation reports how.
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
    try:
        LoopComparison(controller, plants, executed).run()
        if models.rosgraph is not None:
            compare_topics(controller, plants, models.rosgraph)
        times.run()
    except DifferenceError as difference:
        return Verdict(PROPERTY, Outcome.REFUTED, "", difference.explanation, difference.trace, difference.onwards)
    number = sum(map(len, controller.times.values()))
    evidence = f"{counted(number, 'time')}, {counted(len(text.events), 'event')}"
    if times.is_sampled:
        return Verdict(PROPERTY, Outcome.SAMPLED, f"{evidence}, some with random data")
    return Verdict(PROPERTY, Outcome.PROVED, evidence)
