"""Validation of plants and requirements by a second reading of the robot's text.

    verdict = validate_model(robot, model)

`text` interprets the linked robot by the pages of the language alone, and `plants` interprets the SCT model. Both are
independent of the transformation between the two, except for the names of plants, events and inputs. `lockstep`
explores both together.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.analysis.verify.model_reading.lockstep import DifferenceError, Effort, Lockstep
from robosc.analysis.verify.model_reading.names import NotReadError
from robosc.analysis.verify.model_reading.plants import read_plants
from robosc.analysis.verify.model_reading.text import UnlikeError, read_text
from robosc.analysis.verify.verdict import Outcome, Verdict

if TYPE_CHECKING:
    from robosc.model import robosc, sct

#: Name of the property in verdicts.
PROPERTY = "model-translation"
ENOUGH = Effort()

__all__ = ["PROPERTY", "Effort", "validate_model"]


def validate_model(robot: robosc.Base | None, model: sct.SupervisoryControlModel, effort: Effort = ENOUGH) -> Verdict:
    """Return whether plants and requirements agree with the text in every state that the requirements allow."""
    if robot is None:
        return Verdict(PROPERTY, Outcome.SKIPPED, "", "the model was not read from its text")
    try:
        plants = read_plants(model)
        walked = Lockstep(read_text(robot, plants), plants, effort).run()
    except NotReadError as unknown:
        return Verdict(PROPERTY, Outcome.SKIPPED, "", str(unknown))
    except UnlikeError as unlike:
        source = unlike.source.source if unlike.source is not None else None
        line = f" (line {source.span.line})" if source is not None else ""
        return Verdict(PROPERTY, Outcome.REFUTED, "", f"{unlike}{line}")
    except DifferenceError as difference:
        return Verdict(PROPERTY, Outcome.REFUTED, "", difference.explanation, difference.trace)
    evidence = f"{walked.states:,} states, {walked.events:,} events"
    if walked.is_whole:
        return Verdict(PROPERTY, Outcome.PROVED, evidence)
    if not walked.steps:
        return Verdict(PROPERTY, Outcome.PROVED, f"{evidence}; in other states event by event")
    return Verdict(PROPERTY, Outcome.SAMPLED, f"{evidence}, and {walked.steps:,} random steps")
