"""`abs`, `min` and `max` for the supervisor: calls in the sct model, expanded into cases in C and CIF."""

from __future__ import annotations

import math

import pytest

import robosc
from robosc.engine.interpreter import Engine
from robosc.model import expression as ex
from robosc.model.reflection import tree
from robosc.model.semantics import expansion
from robosc.model.semantics.evaluation import evaluate, literal
from robosc.model.semantics.operators import UnreadableError
from robosc.model.semantics.walks import copy_tree

MODEL = """\
robot Round {
  component Counter {
    outgoing message tick with identifier: "/tick", type: integer(-20..20)
    incoming message ring with identifier: "/ring", type: integer

    behaviour {
      variable count: integer(-30..30) = max(3, 7)
      variable near: integer(0..9) = 0

      initial marked state counting {
        on response from tick do count := max(min(value, near + 3), -5), near := abs(value - count)
      }
    }
  }

  requirement ring needs abs(Counter.count - 1) < max(Counter.near, floor(2.5))
}
"""


def test_supervisor_and_engine_agree() -> None:
    """`abs`, `min` and `max` of integers and doubles agree in the supervisor and the engine."""
    robot = robosc.load(text=MODEL)
    assert robosc.check(robot) == []
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    assert {part.function for _, part in tree(model) if isinstance(part, ex.FunctionCall)} == {"abs", "min", "max"}
    engine = Engine(model)
    assert engine.state["Counter.count"] == 7
    for value in range(-20, 21):
        count, near = engine.state["Counter.count"], engine.state["Counter.near"]
        assert engine.perform("message_tick.u_response", {"i_response": value})
        assert engine.state["Counter.count"] == max(min(value, near + 3), -5)
        assert engine.state["Counter.near"] == min(abs(value - count), 9)
        count, near = engine.state["Counter.count"], engine.state["Counter.near"]
        assert engine.enabled("message_ring.c_trigger") == (abs(count - 1) < max(near, 2))
    models = robosc.Models(model, None, robot)
    for target in ("supervisor", "cif"):
        assert str(robosc.generate(target, models))


def test_each_stays_one_element() -> None:
    """Arguments are not copied, however deep the calls are nested."""

    def size(depth: int) -> int:
        nested = "Counter.near"
        for _ in range(depth):
            nested = f"min({nested}, Counter.count)"
        return len(list(tree(robosc.to_sct(robosc.load(text=MODEL.replace("Counter.near,", f"{nested},"))))))

    assert size(12) - size(0) == 12 * 2


def test_they_are_not_written_out_without_end() -> None:
    nested = "Counter.near"
    for _ in range(12):
        nested = f"abs({nested} - 1)"
    findings = robosc.check(robosc.load(text=MODEL.replace("Counter.near,", f"{nested},")))
    assert [finding.rule for finding in findings] == ["variable-type"]
    assert "cases" in findings[0].message


HALVES = [
    (0.5, 1),
    (-0.5, -1),
    (2.5, 3),
    (-2.5, -3),
    (0.49999999999999994, 0),
    (2.0**52 + 1, 2**31 - 1),
    (-1e300, -(2**31)),
]


@pytest.mark.parametrize(("value", "rounded"), HALVES)
def test_halves_go_away_from_zero(value: float, rounded: int) -> None:
    """`floor`, `ceil` and `round` turn a double into an integer.

    Halves round away from zero; integers of the node saturate at 32 bits.
    """
    assert call("round", value) == rounded


def test_nan_cannot_be_rounded() -> None:
    """`floor`, `ceil` and `round` of NaN cannot be read."""
    for function in ("floor", "ceil", "round"):
        with pytest.raises(UnreadableError):
            call(function, math.nan)
        assert call(function, math.inf) == 2**31 - 1


def test_where_ieee_754_has_nan() -> None:
    """`sqrt`, `sin`, `cos` and `atan2`."""
    for function, value in [("sqrt", -1.0), ("sin", math.inf), ("cos", -math.inf)]:
        found = call(function, value)
        assert isinstance(found, float)
        assert math.isnan(found)
    assert call("atan2", 0.0, -1.0) == math.pi


def test_the_length_of_a_vector() -> None:
    """`hypot` does not overflow between, and is infinite beside an infinite side."""
    assert call("hypot", 3, -4.0) == 5.0
    assert call("hypot", 1e200, 0.0) == 1e200
    assert call("hypot", math.inf, math.nan) == math.inf


def call(function: str, *values: float) -> object:
    return evaluate(ex.FunctionCall(function=function, arguments=[literal(value) for value in values]), lambda _: 0)


def test_nested_calls_copy_an_argument_only_where_it_occurs_twice() -> None:
    """The work is in proportion to the result, which doubles with each function."""
    calls = [f"function f{n}(a: integer): integer = f{n + 1}(f{n + 1}(a))\n" for n in range(11)]
    text = f"robot R {{ {''.join(calls)} function f11(a: integer): integer = a + 1 constant c: integer = f0(1) }}"
    copies = []

    def counted(element: ex.Expression) -> ex.Expression:
        copies.append(element)
        return copy_tree(element)

    robot = robosc.load(text=text)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(expansion, "copy_tree", counted)
        assert expansion.constant_value(robot.definitions[-1].value) == 2049
    assert len(copies) < 10


def test_a_text_is_no_number() -> None:
    robot = robosc.load(text='robot R { constant c: double = 2.0 * "x" parameter p: integer(0..9) = 3 - "x" }')
    assert {finding.rule for finding in robosc.check(robot)} == {"type"}
