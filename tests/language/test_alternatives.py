"""Several transitions on one event, and the data that the supervisor receives: language, second edition."""

from __future__ import annotations

import pytest

from tests.language.second_edition import errors, running, supervised

_DOCK = """robot Cart {
  datatype object Scan { range: double ok: boolean level: integer(0..3) count: integer ranges: array(double) }
  interface Scanner use Scan from scan_msgs
  component Lidar {
    outgoing message scan with type: Scan links Scanner
    behaviour {
      variable left: integer(0..5)
      variable near: boolean
      initial marked state free { FREE }
      marked state blocked { BLOCKED }
    }
  }
  component Base {
    incoming message move with type: none
    incoming message halt with type: none
    behaviour { initial marked state idle { IDLE } marked state moving { on request to halt goto idle } }
  }
  requirement move needs Lidar.free or Lidar.near or Lidar.left > 2
}"""
_SCAN = "message_scan.u_response"


def _cart(free: str = "", blocked: str = "", idle: str = "on request to move goto moving") -> str:
    return _DOCK.replace("FREE", free).replace("BLOCKED", blocked).replace("IDLE", idle)


def test_the_first_whose_condition_holds_is_taken() -> None:
    """Several transitions of one state on one event are tried in text order.

    The first with a true condition is taken.
    """
    text = _cart(
        "on response from scan if value.level > 2 goto blocked"
        " on response from scan if value.level > 1 do left := 4"
        " on response from scan do left := value.level"
    )
    engine = running(text)
    for level, left in ((1, 1), (2, 4), (0, 0)):
        engine.perform(_SCAN, {"i_response_level": level})
        assert (engine.state["component_Lidar"], engine.state["Lidar.left"]) == ("free", left)
    engine.perform(_SCAN, {"i_response_level": 3})
    assert (engine.state["component_Lidar"], engine.state["Lidar.left"]) == ("blocked", 0)


def test_where_none_holds_a_response_leaves_the_component_as_it_is() -> None:
    """If no condition is true, a response, error, feedback or cancel leaves the component unchanged."""
    engine = running(_cart("on response from scan if value.ok goto blocked"))
    before = engine.state
    assert engine.perform(_SCAN, {"i_response_ok": False})
    assert engine.state == before
    assert engine.perform(_SCAN, {"i_response_ok": True})
    assert engine.state["component_Lidar"] == "blocked"


def test_where_none_holds_a_request_is_not_possible() -> None:
    """If no condition is true, a request is not possible."""
    scan = "on response from scan do left := value.level"
    engine = running(
        _cart(scan, idle="on request to move if Lidar.left = 2 on request to move if Lidar.left = 3 goto moving")
    )
    for level, possible, location in ((1, False, "idle"), (2, True, "idle"), (3, True, "moving")):
        engine.perform(_SCAN, {"i_response_level": level})
        assert engine.enabled("message_move.c_trigger") is possible
        engine.perform("message_move.c_trigger")
        assert engine.state["component_Base"] == location


@pytest.mark.parametrize(
    ("free", "line"),
    [
        ("on response from scan goto blocked\n on response from scan if value.ok do left := 1", 10),
        ("on response from scan if value.ok do left := 1 }\n on response from scan if value.ok state other {", 10),
    ],
    ids=["after one without condition", "beside one at automaton level"],
)
def test_one_that_is_never_taken(free: str, line: int) -> None:
    """A transition that can never be taken is `nondeterminism`.

    So is a transition in a state beside one at automaton level.
    """
    text = (
        _cart(free)
        .replace("state other {", "initial marked state other {")
        .replace("initial marked state free", "state free")
    )
    text = text if "other" in text else _cart(free)
    assert ("nondeterminism", line) in errors(text)


def test_conditions_read_the_values_before_the_event() -> None:
    """Conditions read the values before the event."""
    swap = (
        "on response from scan if left = 1 do left := 2, near := true goto free"
        " on response from scan do left := 1, near := left = 1"
    )
    engine = running(_cart(swap, blocked="transition if near"))
    seen = []
    for _ in range(4):
        engine.perform(_SCAN)
        seen.append((engine.state["Lidar.left"], engine.state["Lidar.near"]))
    assert seen == [(1, False), (2, True), (1, False), (2, True)]


@pytest.mark.parametrize(
    "asked", ["false != (if Base.idle then near else false)", "!(if left > 1 then near else true)"]
)
def test_conditions_of_choices_beside_data(asked: str) -> None:
    """Exactly one transition is taken for all data: each guard accounts for the earlier ones."""
    free = f"on response from scan if ({asked}) or !value.ok do left := 1 on response from scan do near := true"
    engine = running(_cart(free, blocked="transition if left = 5"))
    for ok, state in ((True, (0, True)), (False, (1, True))):
        engine.perform(_SCAN, {"i_response_ok": ok})
        assert (engine.state["Lidar.left"], engine.state["Lidar.near"]) == state


def test_guards_that_read_what_the_event_changes() -> None:
    """Conditions read the values before the event, also those of another component that the event moves."""
    text = """robot Pair {
      component A {
        outgoing message tick with type: none
        behaviour {
          variable n: integer(0..3)
          initial marked state one { on response from tick do n := n + 1 goto two }
          marked state two { on response from tick if n < 3 goto one on response from tick do n := 0 goto one }
        }
      }
      component B {
        behaviour {
          variable m: integer(0..3)
          initial marked state even {
            on response from A.tick if A.one and A.n = 0 do m := A.n + 1 goto odd
            on response from A.tick if A.two do m := A.n
          }
          marked state odd { on response from A.tick if A.two goto even }
        }
      }
      component C { incoming message go with type: none }
      requirement go needs B.odd or B.m > 1
    }"""
    engine = running(text)
    seen = []
    for _ in range(5):
        engine.perform("message_tick.u_response")
        seen.append(tuple(engine.state[name] for name in ("component_A", "A.n", "component_B", "B.m")))
    assert seen == [
        ("two", 1, "odd", 1),
        ("one", 1, "even", 1),
        ("two", 2, "even", 1),
        ("one", 2, "even", 2),
        ("two", 3, "even", 2),
    ]


def _inputs(text: str) -> list[tuple[str, str | None, str]]:
    model = supervised(text)
    return [(given.name, given.text, type(given.type).__name__) for plant in model.plants for given in plant.inputs]


def test_finite_data_is_an_input_for_each_piece() -> None:
    """Finite data (boolean, enum, integer with a range) is an input, one for each piece of data."""
    text = _cart("on response from scan if value.ok and value.level = 2 goto blocked")
    assert _inputs(text) == [("i_response_ok", None, "BooleanType"), ("i_response_level", None, "IntegerType")]


def test_the_largest_part_over_data_is_an_input() -> None:
    """The input is each largest sub-expression with `value` over `value`, literals, enum values and constants."""
    text = _cart(
        "on response from scan if left > 1 and (value.range < 0.5 or value.ranges[0] < reach) goto blocked",
        "on response from scan if value.range < 0.5 do left := 2",
    ).replace("robot Cart {", "robot Cart { constant reach: double = 0.2")
    assert _inputs(text) == [
        ("i_response_c1", "value.range < 0.5 or value.ranges[0] < 0.2", "BooleanType"),
        ("i_response_c2", "value.range < 0.5", "BooleanType"),
    ]


def test_equal_ones_after_inlining_are_one() -> None:
    """Inputs that are equal after inlining are one input."""
    text = _cart(
        "on response from scan if close(value.range) goto blocked on response from scan do near := value.range < 0.5",
        "on response from scan if !(value.range < 0.5) goto free",
    ).replace("robot Cart {", "robot Cart { function close(d: double): boolean = d < 0.5")
    assert _inputs(text) == [("i_response_c1", "value.range < 0.5", "BooleanType")]


def test_an_integer_takes_the_range_of_the_variable() -> None:
    """An integer input takes the range of the variable to which it is assigned."""
    text = _cart(
        "on response from scan do left := value.count + 1",
        "on response from scan do left := if near then value.count else 0",
    )
    model = supervised(text)
    (first, second) = [given for plant in model.plants for given in plant.inputs]
    assert [(given.text, given.type.minimum, given.type.maximum) for given in (first, second)] == [
        ("value.count + 1", 0, 5),
        ("value.count", 0, 5),
    ]


def test_an_integer_without_variable_needs_a_range() -> None:
    """An integer input without such a variable needs a range (`integer-range`)."""
    text = _cart("on response from scan do left := value.count").replace("left: integer(0..5)", "left: integer")
    assert ("integer-range", 2) in errors(text)


def test_inputs_are_taken_as_independent() -> None:
    """Inputs of one event are independent: a reachable state may need values that never occur together."""
    text = _cart(
        "on response from scan if value.range < 0.2 do near := true"
        " on response from scan if value.range < 0.5 goto blocked",
        "on response from scan if value.range >= 0.5 goto free",
    )
    model = supervised(text)
    assert model.supervisor is not None
    assert model.supervisor.controlledStates == 2 * 2 * 2


def test_doubles_mixed_with_variables_are_computed_by_the_node() -> None:
    """The node compares doubles, strings and arrays with variables of the supervisor."""
    assert errors(_cart("on response from scan if value.range < left goto blocked")) == []
    assert errors(_cart("on response from scan if value.ranges[left] < 0.5 goto blocked")) == []
