"""Arrays and functions in texts: the extent of a condition on elements, the meaning of names, the layout."""

from __future__ import annotations

import pytest

import robosc
from robosc.language.formatting import format_text
from robosc.language.text import Text
from robosc.model import robosc as rsc
from robosc.model.reflection import tree
from robosc.model.semantics.printing import RoboscPrinter

MODEL = """\
robot Scan {{
  datatype object Scan {{
    ranges: array(double)
    first: integer
  }}
  interface Scan use Scan from scan_msgs

  component Lidar {{
    outgoing message scan with type: Scan links Scan

    behaviour {{
      variable near: boolean
      variable r: integer
      variable in: boolean
      variable size: integer

      initial marked state here {{
        on response from scan
          do near := {expression}
      }}
    }}
  }}
}}
"""


def assigned(expression: str) -> tuple[rsc.Robot, rsc.Assignment]:
    robot = robosc.load(text=MODEL.format(expression=expression))
    assert [finding for finding in robosc.check(robot) if finding.severity.name == "ERROR"] == []
    assignment = next(part for _, part in tree(robot) if isinstance(part, rsc.Assignment))
    return robot, assignment


@pytest.mark.parametrize(
    ("text", "printed"),
    [
        # Bodies extend as far right as possible.
        ("any e in value.ranges: e < 1.0 and near", "(any e in value.ranges: e < 1.0 and Lidar.near)"),
        ("(any e in value.ranges: e < 1.0) and near", "(any e in value.ranges: e < 1.0) and Lidar.near"),
        (
            "near or all e in value.ranges: any f in value.ranges: e = f or near",
            "Lidar.near or (all e in value.ranges: (any f in value.ranges: e = f or Lidar.near))",
        ),
        ("(count e in value.ranges[1..2]: e > 0) > 1", "(count e in value.ranges[1..2]: e > 0) > 1"),
        ("value.ranges[value.first + 1] < 1.0", "value.ranges[value.first + 1] < 1.0"),
        ("size(value.ranges[r..size]) = 2", "size(value.ranges[Lidar.r..Lidar.size]) = 2"),
        # In other places these words are names.
        ("in and size > 1", "Lidar.in and Lidar.size > 1"),
    ],
)
def test_texts(text: str, printed: str) -> None:
    _, assignment = assigned(text)
    assert RoboscPrinter()(assignment.value) == printed
    formatted, _ = format_text(Text("scan.rscd", MODEL.format(expression=text)))
    assert formatted is not None
    assert f"do near := {text} }}" in " ".join(formatted.split())
    assert format_text(Text("scan.rscd", formatted))[0] == formatted


def test_a_bound_name_comes_first() -> None:
    """A bound name (`all r in …`) precedes all other meanings of a bare name, except in the array itself."""
    _, assignment = assigned("any r in value.ranges[r..r]: r < 1.0")
    quantifier = assignment.value
    assert isinstance(quantifier, rsc.ArrayQuantifier)
    items = [part.item for _, part in tree(quantifier) if isinstance(part, rsc.Access) and part.item is not None]
    assert [type(item) for item in items] == [rsc.Variable, rsc.Variable, rsc.ArrayElement]


def test_the_inner_one_of_two_equal_names() -> None:
    _, assignment = assigned("any e in value.ranges: (any e in value.ranges: e > 1.0) and e < 2.0")
    outer = assignment.value
    assert isinstance(outer, rsc.ArrayQuantifier)
    inner, own = [part for _, part in tree(outer) if isinstance(part, rsc.Access) and part.item is not None]
    assert own.item is outer.element
    assert inner.item is not outer.element


def test_a_bound_name_ends_with_its_condition() -> None:
    robot = robosc.load(text=MODEL.format(expression="(any e in value.ranges: e < 1.0) and near"))
    assert robosc.check(robot)  # the finding is about the package of its interface
    with pytest.raises(robosc.ModelError) as error:
        robosc.load(text=MODEL.format(expression="(any e in value.ranges: e < 1.0) and e > 0.0"))
    assert [finding.rule for finding in error.value.diagnostics] == ["unresolved-reference"]


def test_a_condition_in_a_function_is_written_out_where_it_is_called() -> None:
    """A `function` is inlined at its calls; names of elements in it are its own."""
    text = MODEL.format(expression="any e in value.ranges: close(e)").replace(
        "  component Lidar {",
        "  constant most: double = 2.0\n  function close(e: double): boolean = if e > most then false else e >= 0.0\n\n"
        "  component Lidar {",
    )
    robot = robosc.load(text=text)
    graph = (robosc.to_sct(robot), robosc.to_rosgraph(robot))[1]
    (reaction,) = graph.reactions
    texts = [part for _, part in tree(reaction) if type(part).__name__ == "ArrayQuantifier"]
    assert len(texts) == 1
