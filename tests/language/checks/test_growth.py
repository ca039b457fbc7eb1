"""Short texts with huge expansions are rejected before they are expanded."""

import sys
from collections.abc import Callable

import pytest

from robosc.base.ros_types import RosTypes
from robosc.language.checks import check
from robosc.language.reading import read
from robosc.language.text import Documents
from robosc.model.semantics import expansion

pytestmark = pytest.mark.slow

COMPONENT = """component A {
  outgoing message m with type: integer(0..9)
  incoming message go with type: none
  behaviour { variable k: integer(0..9) = 0 on response from m do k := value initial marked state a { } }
}"""
TOO_LARGE = "this has more than 20000 parts after names are expanded"


def doubled(head: str, first: str, step: str, use: str) -> str:
    """Return a definition and 39 more, each of which names the previous one twice."""
    lines = [head.format(0) + first, *(head.format(number) + step.format(number - 1) for number in range(1, 40))]
    return "\n".join(["robot R {", COMPONENT, *lines, use.format(39), "}"])


FUNCTION = "function f{}(x: integer): integer = "
TEXTS = {
    "functions": doubled(FUNCTION, "x + 1", "f{0}(x) + f{0}(x)", "requirement A.go needs f{}(A.k) > 3"),
    "arguments": doubled(FUNCTION, "x + x", "f{0}(x + x)", "requirement A.go needs f{}(A.k) > 3"),
    "conditions": doubled("condition c{} = ", "A.k > 3", "c{0} and c{0}", "requirement A.go needs c{}"),
}


@pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS)
def test_what_would_be_too_large_is_never_written_out(monkeypatch: pytest.MonkeyPatch, text: str) -> None:
    steps = 0
    copied = expansion.copy_tree

    def counted(*arguments: object) -> object:
        nonlocal steps
        steps += 1
        return copied(*arguments)

    monkeypatch.setattr(expansion, "copy_tree", counted)
    reading = read("r.rscd", documents=Documents({"r.rscd": text}))
    findings = [*reading.findings, *check(reading.base, reading.findings)]
    assert [finding.message for finding in findings] == [TOO_LARGE]
    # Several rules expand each of the small definitions.
    assert steps < 20 * expansion.LARGEST


def test_squares_of_squares_stay_small() -> None:
    text = doubled("constant c{}: integer = ", "3", "c{0} * c{0}", "requirement A.go needs A.k > c{}")
    reading = read("r.rscd", documents=Documents({"r.rscd": text}))
    messages = [finding.message for finding in check(reading.base, reading.findings)]
    bounds = "an integer lies between -9223372036854775808 and 9223372036854775807, and this is "
    assert f"{bounds}3433683820292512484657849089281" in messages
    assert messages.count(f"{bounds}far larger") >= 33


def test_texts_of_texts_are_not_written_out() -> None:
    use = "component B { outgoing message n with identifier: c{}, type: none }".replace("{ ", "{{ ").replace(
        " }", " }}"
    )
    text = doubled("constant c{}: string = ", '"ab"', "c{0} + c{0}", use)
    reading = read("r.rscd", documents=Documents({"r.rscd": text}))
    findings = [*reading.findings, *check(reading.base, reading.findings)]
    assert {finding.message for finding in findings} == {TOO_LARGE}


def calls(text: str) -> int:
    """Return the number of Python function calls while reading and checking a text."""
    count = 0

    def counted(_frame: object, event: str, _argument: object) -> None:
        nonlocal count
        count += event == "call"

    before = sys.getprofile()
    sys.setprofile(counted)
    try:
        reading = read("r.rscd", documents=Documents({"r.rscd": text}))
        check(reading.base, reading.findings)
    finally:
        sys.setprofile(before)
    return count


@pytest.mark.parametrize("chain", [" = ".join, lambda parts: " = ".join(["lost", *parts[1:]])])
def test_a_chain_of_reasons_costs_by_its_length(chain: Callable[[list[str]], str]) -> None:
    text = """robot R {{ component A {{ service s with request: none, response: none behaviour {{
      initial marked state idle {{ on request to s goto busy }}
      state busy {{ on response from s goto idle on error from s if {} goto idle }} }} }} }}"""
    calls(text.format("error = lost"))  # load modules once, before counting
    short, long = (calls(text.format(chain(["error"] * number))) for number in (100, 400))
    assert long < 5 * short


@pytest.mark.parametrize(
    "definitions",
    [
        "function f0(x: integer): integer = 1 {calls} constant c: integer = f29(1)",
        "parameter p: integer(0..9) = 1 constant c0: integer = p {sums} constant c: integer = c29",
        "constant c0: integer = floor(0.0 / 0.0) {sums} constant c: integer = c29",
        "constant c0: integer = c29 {sums} constant c: integer = c29",
    ],
    ids=["unread arguments", "no constant", "no value", "a circle"],
)
def test_constants_without_a_value_do_not_double(definitions: str) -> None:
    numbers = range(1, 30)
    calls = " ".join(f"function f{n}(x: integer): integer = f{n - 1}(f{n - 1}(x))" for n in numbers)
    sums = " ".join(f"constant c{n}: integer = c{n - 1} + c{n - 1}" for n in numbers)
    text = f"""robot R {{
      {definitions.replace("{calls}", calls).replace("{sums}", sums)}
      component C {{ outgoing message m with type: integer(0..9)
        behaviour {{ initial marked state s {{ on response from m if value = c }} }} }}
    }}"""
    steps = 0
    step = expansion.Expansion._step

    def counted(*arguments: object) -> object:
        nonlocal steps
        steps += 1
        return step(*arguments)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(expansion.Expansion, "_step", counted)
        reading = read("robot.rscd", (), RosTypes(), Documents({"robot.rscd": text}))
        check(reading.base, reading.findings, RosTypes())
    assert steps < 100_000


@pytest.mark.parametrize(
    "place",
    [
        "variable i: integer(0..5) = {0} initial marked state s {{}}",
        "variable i: integer(0..{0}) initial marked state s {{}}",
        "initial marked state s {{ after {0} s goto s }}",
    ],
)
def test_no_place_loses_a_value_that_is_too_large(place: str) -> None:
    """Each call triples its argument; the value of the calls is small."""
    calls = "same(" * 10 + "2" + ")" * 10
    text = f"""robot R {{
      function same(x: integer): integer = x + x - x
      component C {{ incoming message m with type: none behaviour {{ {place.format(calls)} }} }}
    }}"""
    reading = read("robot.rscd", (), RosTypes(), Documents({"robot.rscd": text}))
    found = check(reading.base, reading.findings, RosTypes())
    assert [finding.rule for finding in found] == ["cyclic-definition"]
