"""`if C then A else B` between objects and arrays in provided data, as text."""

from __future__ import annotations

from textwrap import dedent
from typing import Any

import pytest

import robosc
from robosc.language.formatting import format_text
from robosc.language.text import Text
from robosc.model import robosc as rsc
from robosc.model.reflection import tree
from robosc.model.semantics.printing import RoboscPrinter
from robosc.model.validity import load

MODEL = """\
robot Cart {{
  datatype object Vector {{
    x: double
    y: double
  }}
  datatype object Velocity {{
    linear: Vector
    gains: array(double)
  }}

  interface velocity use Velocity from cart_msgs

  component Person {{
    behaviour {{
      initial marked state near {{ transition goto away }}
      state away {{ transition goto near }}
    }}
  }}

  component Base {{
    incoming message move with type: Velocity links velocity
    outgoing message moved with type: Velocity links velocity

    behaviour {{
      variable first: Velocity
      variable gains: array(double)

      initial marked state on {{
        on response from moved do first := value, gains := value.gains
      }}
    }}
  }}

  provide move with {data}
}}
"""
CHOICES = [
    "if Person.near then { linear: { x: 0.1 } } else { gains: [1.0] }",
    "if Person.near then {} else Base.first",
    "{ linear: if Person.near then { x: 0.1 } else if Person.away then Base.first.linear else { y: 0.2 } }",
    "{ gains: if Person.near then [] else if Person.away then [1.0, 2.0] else Base.gains }",
    "if Person.near then { linear: if Person.away then { x: 0.1 } else { y: 0.1 } } else Base.first",
    "(if Person.near then (if Person.away then { linear: { y: 0.1 } } else {}) else Base.first)",
]


def provided(data: str) -> Any:
    """Return the data of the statement in a model that has no errors."""
    robot = robosc.load(text=MODEL.format(data=data))
    assert [finding for finding in robosc.check(robot) if finding.severity.name == "ERROR"] == []
    return next(part.data for _, part in tree(robot) if isinstance(part, rsc.ProvideStatement))


@pytest.mark.parametrize("data", CHOICES)
def test_a_branch_may_be_any_value_of_the_type(data: str) -> None:
    values = [part for _, part in tree(provided(data)) if isinstance(part, rsc.ObjectPropertyValue)]
    assert all(value.property is not None for value in values)
    assert len(values) == data.count(":")


@pytest.mark.parametrize("data", CHOICES)
def test_the_printed_text_has_the_same_meaning(data: str) -> None:
    printed = RoboscPrinter()(provided(data))
    assert RoboscPrinter()(provided(printed)) == printed


@pytest.mark.parametrize("data", CHOICES)
def test_a_saved_robot_is_the_same(data: str, tmp_path: Any) -> None:
    robot = robosc.load(text=MODEL.format(data=data))
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    for name, text in robosc.generate("xmi", robosc.Models(model, robosc.to_rosgraph(robot), robot)).items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    saved = load(tmp_path / "Cart.robosc.xmi")
    copy = next(part.data for _, part in tree(saved) if isinstance(part, rsc.ProvideStatement))
    assert RoboscPrinter()(copy) == RoboscPrinter()(provided(data))


def test_long_choices_break_before_their_branches() -> None:
    vector = "{ x: 111111111.111111111, y: 222222222.222222222 }"
    data = f"{{ linear: if Person.near then {vector} else if Person.away then {vector} else Base.first.linear }}"
    text, findings = format_text(Text("cart.rscd", MODEL.format(data=data)))
    assert findings == []
    assert text is not None
    assert text.partition("  provide")[2] == dedent(
        f"""\
         move with {{
            linear: if Person.near
                then {vector}
                else if Person.away
                    then {vector}
                    else Base.first.linear
          }}
        }}
        """
    )
    assert format_text(Text("cart.rscd", text))[0] == text
