"""Requirements of thousands of operators are analyzed on a small stack, whichever way they are nested."""

from typing import Any

import pytest

from robosc.analysis.explain import explain, explore, possibility
from robosc.analysis.supervise import diagnose
from robosc.analysis.verify import Outcome, verify_system
from robosc.m2m.sct_to_cif import transform
from robosc.model import expression as ex
from robosc.model import sct
from tests.sct_models import edge, model, needs, plant
from tests.small_stack import on_small_stack

OPERATORS = 3000


def counter(kind: type[ex.BinaryExpression], *, left: bool) -> sct.SupervisoryControlModel:
    """Return a counter whose step is restricted by a chain of operators, nested to the left or to the right."""
    made = model(
        [
            plant(
                "C",
                {"on": [edge("c_up", do={"n": "n + 1"}), edge("c_back", do={"n": "0"})]},
                controllable=["c_up", "c_back"],
                variables={"n": "0..7 = 0"},
            )
        ],
        [needs("c_up", "n < 6")],
    )
    [variable] = made.plants[0].variables
    whole: ex.Expression = made.requirements[0].condition
    for number in range(OPERATORS // 2):
        reference = sct.VariableReference(variable=variable)
        bound = ex.LessThan(left=reference, right=ex.IntegerLiteral(value=7 if kind is ex.Conjunction else number % 5))
        whole = kind(left=whole, right=bound) if left else kind(left=bound, right=whole)
    made.requirements[0].condition = whole
    return made


@pytest.mark.slow
@pytest.mark.parametrize("left", [True, False], ids=["left", "right"])
@pytest.mark.parametrize("kind", [ex.Conjunction, ex.Disjunction])
def test_long_requirements_take_no_stack(kind: type[ex.BinaryExpression], left: bool) -> None:
    made = counter(kind, left=left)
    up = made.plants[0].events[0]

    def look() -> tuple[int, list[Any], bool, set[Outcome]]:
        made.supervisor = diagnose(made).supervisor
        explanation = explore(made, lambda system: explain(system, up, {made.plants[0].variables[0]: 6}))
        possible = explore(made, lambda system: possibility(system, up)).possible
        outcomes = {verdict.outcome for verdict in verify_system(made)}
        transform(made)
        details = [note.details for note in explanation.requirements]
        return made.supervisor.controlledStates, details, possible, outcomes

    states, details, possible, outcomes = on_small_stack(look)
    assert (states, possible, outcomes) == (7, True, {Outcome.PROVED})
    assert details[0][0].endswith(" does not hold: `C.n` is 6")
