"""`error` is the reason of an error, and bare names are values of `Failure` if the text expects one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robosc.model import robosc as rsc
from robosc.model.semantics.failures import FAILURES, REASONS, is_failure
from tests.language.second_edition import running, supervised
from tests.language.texts import reading, underlined
from tests.searching import examples

if TYPE_CHECKING:
    from pathlib import Path

ROBOT = """robot Carrier {{
  interface moving use Move from carrier_msgs
  datatype object Result {{ code: integer(0..9) codes: array(integer) speed: double }}
  {definitions}
  component Base {{
    action drive with request: none, response: Result, feedback: none links moving
    service dock with request: none, response: none
    behaviour {{
      variable why: Failure
      variable number: integer(0..9)
      {variables}
      initial marked state ready {{ on request to drive goto driving on request to dock goto docking }}
      state driving {{ on request to drive on response from drive goto ready {driving} }}
      state docking {{ on request to dock on response from dock goto ready {docking} }}
      marked state other {{}}
    }}
  }}
}}"""


def robot(driving: str = "", docking: str = "", definitions: str = "", variables: str = "") -> str:
    return ROBOT.format(driving=driving, docking=docking, definitions=definitions, variables=variables)


def failed(text: str, inputs: dict[str, Any] | None = None, event: str = "action_drive") -> Any:
    """Return the engine after a call or goal has failed."""
    engine = running(text)
    engine.perform(f"{event}.c_trigger")
    engine.perform(f"{event}.u_error", inputs or {})
    return engine


def test_the_enum_has_the_reasons_of_the_page(tmp_path: Path) -> None:
    base = reading(tmp_path, robot("on error from drive do why := error")).base
    assert base is not None
    (read,) = (element for element in base.eAllContents() if isinstance(element, rsc.ErrorReason))
    assert is_failure(read.enumeration)
    assert {rule.value.name for rule in read.enumeration.rules} == FAILURES
    (default,) = (rule for rule in read.enumeration.rules if isinstance(rule, rsc.EnumDefaultRule))
    assert default.value.name == "unavailable"


@pytest.mark.parametrize("reason", sorted(REASONS[rsc.Action]))
def test_a_condition_on_the_reason(reason: str) -> None:
    text = robot(f"on error from drive if error = {reason} goto other on error from drive goto ready")
    for other in REASONS[rsc.Action]:
        engine = failed(text, {"i_error_reason": other})
        assert engine.state["component_Base"] == ("other" if other == reason else "ready")


@pytest.mark.parametrize(("event", "kind"), [("action_drive", rsc.Action), ("service_dock", rsc.Service)])
def test_an_input_has_the_reasons_of_its_kind(event: str, kind: Any) -> None:
    driving, docking = (f"on error from {name} if error = unreadable goto ready" for name in ("drive", "dock"))
    text = robot(driving, docking)
    for reason in FAILURES:
        if reason in REASONS[kind]:
            failed(text, {"i_error_reason": reason}, event)
        else:
            with pytest.raises(ValueError, match="is none of the values"):
                failed(text, {"i_error_reason": reason}, event)


def test_there_is_an_input_only_where_the_supervisor_needs_it() -> None:
    kept = robot("on error from drive do why := error goto ready", "on error from dock goto ready")
    needed = robot("on error from drive if error = lost goto other", "on error from dock goto ready")
    for text, names in ((kept, []), (needed, ["i_error_reason"])):
        model = supervised(text)
        assert [given.name for plant in model.plants for given in plant.inputs] == names


@pytest.mark.parametrize(
    ("condition", "reasons"),
    [
        ("lost = error", {"lost"}),
        ("error != Failure.lost", {*REASONS[rsc.Action]} - {"lost"}),
        ("error = worst", {"aborted"}),
        ("bad(error)", {"lost", "timeout"}),
        ("error = (if error = lost then lost else timeout)", {"lost", "timeout"}),
        ("!(error = lost) and error != timeout", {*REASONS[rsc.Action]} - {"lost", "timeout"}),
    ],
)
def test_bare_values(condition: str, reasons: set[str]) -> None:
    definitions = """datatype enum Kind from integer to { value = 1 -> lost default -> rejected }
      constant worst: Failure = aborted
      function bad(reason: Failure): boolean = reason = lost or timeout = (if true then reason else lost)"""
    text = robot(f"on error from drive if {condition} goto other on error from drive goto ready", "", definitions)
    taken = {
        reason
        for reason in REASONS[rsc.Action]
        if failed(text, {"i_error_reason": reason}).state["component_Base"] == "other"
    }
    assert taken == reasons


def test_of_two_bare_names_the_left_one_is_looked_up_as_ever(tmp_path: Path) -> None:
    text = robot("on error from drive if lost = why goto other")
    assert [rule for rule, _ in underlined(reading(tmp_path, text))] == ["unresolved-reference"]
    mixed = robot("on error from drive if why = lost goto other", definitions="constant lost: integer = 3")
    assert reading(tmp_path, mixed).findings == []


def test_elsewhere_a_bare_name_is_what_it_was(tmp_path: Path) -> None:
    """It is a value of another enum, a state or a constant."""
    definitions = "datatype enum Kind from integer to { value = 1 -> lost default -> aborted }"
    text = robot(
        "on error from drive if kind = lost and error = lost goto other",
        definitions=definitions,
        variables="variable kind: Kind = lost",
    )
    base = reading(tmp_path, text).base
    assert base is not None
    enums = [
        element.item.eContainer().eContainer().name
        for element in base.eAllContents()
        if isinstance(element, rsc.Access) and isinstance(element.item, rsc.EnumValue)
    ]
    assert sorted(enums) == ["Failure", "Kind", "Kind"]


def test_a_type_of_the_user_hides_the_name() -> None:
    definitions = "datatype enum Failure from boolean to { value -> broken default -> fine }"
    text = robot("on error from drive if error = lost goto other", "", definitions).replace(
        "variable why: Failure", "variable why: Failure = broken"
    )
    assert failed(text, {"i_error_reason": "lost"}).state["component_Base"] == "other"


def test_the_result_of_an_error() -> None:
    text = robot("on error from drive if value.code = 3 do number := value.code goto other")
    assert failed(text, {"i_error_code": 3}).state["component_Base"] == "other"
    assert failed(text, {"i_error_code": 4}).state["component_Base"] == "driving"


def test_a_condition_on_elements_is_one_input_and_so_is_its_negation() -> None:
    driving = """on error from drive if value.codes[0] = 5 and error = lost goto other
      on error from drive if !(value.codes[0] = 5) goto ready"""
    model = supervised(robot(driving))
    (plant,) = (plant for plant in model.plants if plant.inputs)
    texts = [carried.text for carried in plant.inputs]
    assert texts == ["value.codes[0] = 5", "error", "!(value.codes[0] = 5)"]
    nothing = dict.fromkeys(("i_error_c1", "i_error_c2"), False)
    assert failed(robot(driving), nothing).state["component_Base"] == "driving"


def test_a_condition_on_elements_and_states_is_one_input() -> None:
    driving = """on error from drive if value.codes[0] = 5 or number = 3 goto other
      on error from drive if !(value.codes[0] = 5 or number = 3) and number < 4 goto ready
      on error from drive do number := 3"""
    model = supervised(robot(driving))
    (plant,) = (plant for plant in model.plants if plant.inputs)
    texts = [carried.text for carried in plant.inputs]
    whole = "value.codes[0] = 5 or Base.number = 3"
    assert texts == [whole, f"!({whole})"]


def test_an_assignment_that_can_not_be_read_is_left_out() -> None:
    driving = "on error from drive do number := value.codes[1] goto other"
    text = robot(driving, "on error from dock goto ready").replace(
        "marked state other {}", "marked state other { transition if number = 4 goto ready }"
    )
    model = supervised(text)
    (plant,) = (plant for plant in model.plants if plant.inputs)
    assert [carried.text for carried in plant.inputs] == ["value.codes[1]", "value.codes[1] = value.codes[1]"]
    there = failed(text, {"i_error_c1": 4, "i_error_c2": True})
    missing = failed(text, {"i_error_c1": 4, "i_error_c2": False})
    assert (there.state["Base.number"], missing.state["Base.number"]) == (4, 0)


_REASON = st.sampled_from(sorted(FAILURES))


@settings(max_examples=examples(30), deadline=None)
@given(st.lists(st.tuples(_REASON, st.sampled_from(["=", "!="])), min_size=1, max_size=4), _REASON)
def test_the_first_transition_whose_reason_fits_is_taken(tests: list[tuple[str, str]], reason: str) -> None:
    """Compare with the meaning of a list of conditions, which the test computes itself."""
    possible = REASONS[rsc.Action]
    tests = [(wanted, symbol) for wanted, symbol in tests if wanted in possible]
    if reason not in possible or not tests:
        return
    transitions = " ".join(
        f"on error from drive if error {symbol} {wanted} do number := {number}"
        for number, (wanted, symbol) in enumerate(tests, start=1)
    )
    text = robot(transitions).replace(
        "marked state other {}", "marked state other { transition if number = 1 goto ready }"
    )
    fits = [number for number, (wanted, symbol) in enumerate(tests, 1) if (reason == wanted) is (symbol == "=")]
    engine = failed(text, {"i_error_reason": reason})
    assert engine.state["Base.number"] == next(iter(fits), 0)


FORBIDDEN = """robot Forbidden {
  component Lamp {
    service light with request: none, response: none
    behaviour {
      initial marked state dark { on request to light goto lighting }
      state lighting { on response from light goto dark on error from light goto dark }
    }
  }
  %s
  requirement Never: automaton { initial marked state all { on error from light if error != timeout } }
}"""


@pytest.mark.parametrize("others", [0, 3])
def test_an_error_that_is_forbidden_for_a_reason_must_not_come(others: int) -> None:
    """The error is uncontrollable, so the supervisor prevents the call."""
    more = "".join(
        f"""component C{number} {{ outgoing message m{number} with type: none
        behaviour {{ initial marked state a {{ on response from m{number} goto b }}
          marked state b {{ on response from m{number} goto a }} }} }}"""
        for number in range(others)
    )
    engine = running(FORBIDDEN % more)
    assert not engine.enabled("service_light.c_trigger")


@pytest.mark.parametrize(
    ("driving", "texts"),
    [
        ("on error from drive if kept[0] = 1 goto other", ["Base.kept[0] = 1"]),
        ("on canceled from drive if !(kept[0] = 1) and error_seen goto other", ["!(Base.kept[0] = 1)"]),
        (
            "on error from drive if error = lost do number := kept[0] goto other transition if number = 9 goto other",
            ["error", "Base.kept[0]", "Base.kept[0] = Base.kept[0]"],
        ),
    ],
)
def test_elements_that_the_node_has_kept_are_inputs(driving: str, texts: list[str]) -> None:
    text = robot(driving, variables="variable kept: array(integer) variable error_seen: boolean")
    (plant,) = (plant for plant in supervised(text).plants if plant.inputs)
    assert [carried.text for carried in plant.inputs] == texts


def test_a_reason_is_bare_beside_a_variable_of_a_library(tmp_path: Path) -> None:
    """The robot's own text names neither the enum nor an error."""
    (tmp_path / "base.rscd").write_text("""library BaseLibrary {
  component Drive {
    service go with request: none, response: none
    behaviour {
      variable why: Failure
      initial marked state here { on request to go goto there }
      state there { on response from go goto here on error from go do why := error goto here }
    }
  }
}""")
    found = reading(
        tmp_path,
        """robot R {
  component Base from BaseLibrary import Drive
  component Hatch { incoming message open with type: none }
  requirement open needs Base.why != timeout
}""",
    )
    assert found.findings == []


def test_a_library_of_the_user_can_have_the_name_of_the_predefined_one(tmp_path: Path) -> None:
    """Its own `Failure` hides the predefined one, and the reasons of errors keep their meaning."""
    (tmp_path / "predefined.rscd").write_text("""library Predefined {
  datatype enum Failure from string to { value = "big" -> big default -> small }
  component Gauge { outgoing message size with type: Failure }
}""")
    base = "component Gauge from Predefined import Gauge component Base { service go with request: none, response: none"
    text = (
        f"robot R {{ {base} behaviour {{ variable size: Failure = small initial marked state here {{"
        " on request to go goto there } state there { on response from go goto here"
        " on error from go if error = timeout do size := big goto here on error from go goto here } } } }"
    )
    assert reading(tmp_path, text).findings == []
