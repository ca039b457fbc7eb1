"""What a supervised system has to be: each property is a function from the system to a verdict."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from robosc.analysis.verification.properties.confluence import confluence
from robosc.analysis.verification.properties.controllability import controllability
from robosc.analysis.verification.properties.dead_events import no_dead_events
from robosc.analysis.verification.properties.input_enabledness import input_enabledness
from robosc.analysis.verification.properties.non_blocking import non_blocking
from robosc.analysis.verification.properties.non_blocking_in_the_loop import non_blocking_in_the_loop
from robosc.analysis.verification.properties.permissiveness import maximal_permissiveness
from robosc.analysis.verification.properties.requirement import requirement_holds
from robosc.analysis.verification.properties.response import bounded_response, finite_response

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.analysis.verification.system import SupervisedSystem
    from robosc.analysis.verification.verdict import Verdict
    from robosc.metamodel import sct

    Property = Callable[[SupervisedSystem], Verdict]


def properties(model: sct.SupervisoryControlModel) -> list[Property]:
    """All that a model with its supervisor is to satisfy: a property for each requirement among them."""
    return [
        non_blocking,
        controllability,
        input_enabledness,
        *(partial(requirement_holds, requirement=each) for each in model.requirements),
        no_dead_events,
        maximal_permissiveness,
        finite_response,
        bounded_response,
        confluence,
        non_blocking_in_the_loop,
    ]
