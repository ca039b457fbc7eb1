"""`mod(a, b)` from the text to the generated files; a variable may have the function's name."""

import re

import pytest

import robosc
from robosc.engine.interpreter import Engine
from robosc.language.formatting import format_text
from robosc.language.text import Text
from robosc.model import expression as ex
from robosc.model.semantics.evaluation import evaluate
from robosc.model.semantics.printing import RoboscPrinter

MODEL = """\
robot Round {
  component Counter {
    outgoing message tick with identifier: "/tick", type: integer(-20..20)
    incoming message ring with identifier: "/ring", type: integer

    behaviour {
      variable count: integer(-30..30) = -7
      variable mod: integer(0..3) = 0

      initial marked state counting {
        on response from tick do count := value + mod, mod := mod(value - 3, 2 + 2)
      }
    }
  }

  requirement ring needs mod(Counter.count - 1, 5) = 2

  provide ring with mod(Counter.count, 9)
}
"""


@pytest.fixture(scope="module")
def models() -> robosc.Models:
    robot = robosc.load(text=MODEL)
    assert robosc.check(robot) == []
    made = robosc.Models(robosc.to_sct(robot), robosc.to_rosgraph(robot), robot)
    robosc.synthesize(made.sct)
    return made


REMAINDERS = [(7, 5, 2), (-7, 5, 3), (-10, 5, 0), (0, 1, 0), (-(2**63), 7, 6)]


@pytest.mark.parametrize(("value", "divisor", "rest"), REMAINDERS)
def test_the_remainder_is_never_negative(value: int, divisor: int, rest: int) -> None:
    literal: ex.Expression = ex.IntegerLiteral(value=abs(value))
    given = ex.UnaryMinus(operand=literal) if value < 0 else literal
    call = ex.FunctionCall(function="mod", arguments=[given, ex.IntegerLiteral(value=divisor)])
    assert evaluate(call, lambda reference: reference) == rest


def test_supervisor_and_engine_agree(models: robosc.Models) -> None:
    engine = Engine(models.sct)
    start = engine.state
    for value in range(-20, 21):
        engine.state = start
        assert engine.perform("message_tick.u_response", {"i_response": value})
        assert engine.state["Counter.count"] == value
        assert engine.state["Counter.mod"] == (value - 3) % 4
        assert engine.enabled("message_ring.c_trigger") == ((value - 1) % 5 == 2)


def test_each_target_says_it(models: robosc.Models) -> None:
    texts = {target: str(robosc.generate(target, models)) for target in ("supervisor", "ros2")}
    assert "- 1) % 5 + 5) % 5 == 2" in texts["supervisor"]
    assert re.search(r"mod\(Integer\(.*\), Integer\(9\)\)", texts["ros2"])


def test_what_is_never_negative_is_divided_once() -> None:
    model = robosc.to_sct(robosc.load(text=MODEL.replace("-20..20", "3..20")))
    robosc.synthesize(model)
    text = str(robosc.generate("supervisor", robosc.Models(model)))
    assert "(inputs->message_tick_i_response - 3) % 4)" in text or "(inputs->message_tick_i_response - 3) % 4;" in text
    assert "% 4 + 4" not in text


def test_format_and_print_keep_it(models: robosc.Models) -> None:
    assert format_text(Text("round.rscd", MODEL))[0] == MODEL
    assert models.robosc is not None
    assert RoboscPrinter()(models.robosc.definitions[1].condition) == "mod(Counter.count - 1, 5) = 2"


@pytest.mark.parametrize("between", [" ", "\n", "// a\n", "/* ( */ // )\n /***/"])
def test_blanks_and_comments_before_the_arguments(between: str) -> None:
    text = MODEL.replace("mod(value", f"mod{between}(value")
    robot = robosc.load(text=text)
    assert robosc.check(robot) == []
    assert format_text(Text("round.rscd", text))[0] is not None
