"""What a supervised system has to be: each property is a function from the system to a verdict."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from robosc.verification.properties.confluence import confluence
from robosc.verification.properties.controllability import controllability
from robosc.verification.properties.dead_events import no_dead_events
from robosc.verification.properties.input_enabledness import input_enabledness
from robosc.verification.properties.non_blocking import non_blocking
from robosc.verification.properties.non_blocking_in_the_loop import non_blocking_in_the_loop
from robosc.verification.properties.permissiveness import maximal_permissiveness
from robosc.verification.properties.requirement import requirement_holds
from robosc.verification.properties.response import bounded_response, finite_response

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.metamodel import sct
    from robosc.verification.system import SupervisedSystem
    from robosc.verification.verdict import Verdict

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
