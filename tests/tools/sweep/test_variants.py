"""Settings of constants and parameters: their combinations, and the changed texts."""

from __future__ import annotations

import re
from itertools import product
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robosc.tools.cli.options import Paths
from robosc.tools.sweep.variants import SettingError, combinations, replaced

if TYPE_CHECKING:
    from pathlib import Path

ROBOT = """\
// constant reach: integer(0..9) = 2
robot R {
  component Lamps from Lamps import Lamps
  constant reach: integer(0..9) = /* own */ 2 // reach = 2
  constant note: string = "reach = 2"
  parameter speed: double(0.0..5.0) = 0.2
  component Arm {
    incoming message grip with type: none
    constant reach: integer(0..9) = 1 + 1
    behaviour { initial marked state used {} }
  }
}
"""
LIBRARY = "library Lamps {\n  constant bright: integer(0..9) = 3\n  component Lamps {}\n}\n"
CIF = """\
// const int n = 2;
const int n = 2, m = n + 1;
group G:
  const bool n = true;
  group def D():
    const real $input = 1.5;
  end
end
plant A: const list int n = [1, 2]; location: initial; end
"""


@pytest.fixture
def robot(tmp_path: Path) -> str:
    (tmp_path / "Lamps.rscd").write_text(LIBRARY)
    file = tmp_path / "r.rscd"
    file.write_text(ROBOT)
    return str(file)


@pytest.mark.parametrize(
    ("name", "value", "before", "after"),
    [
        ("reach", "5", "/* own */ 2 //", "/* own */ 5 //"),
        ("Arm.reach", "7", "= 1 + 1\n", "= 7\n"),
        ("speed", "1.5", "= 0.2\n", "= 1.5\n"),
        ("note", '"x, y"', '= "reach = 2"\n', '= "x, y"\n'),
    ],
)
def test_only_the_value_of_the_named_element_changes(
    robot: str, name: str, value: str, before: str, after: str
) -> None:
    assert ROBOT.count(before) == 1
    assert replaced(robot, Paths(), [{name: value}]) == [{robot: ROBOT.replace(before, after)}]


def test_a_constant_of_an_imported_library_changes_in_its_file(robot: str, tmp_path: Path) -> None:
    [changed] = replaced(robot, Paths(), [{"bright": "4", "reach": "1"}])
    assert changed == {
        str(tmp_path / "Lamps.rscd"): LIBRARY.replace("= 3", "= 4"),
        robot: ROBOT.replace("/* own */ 2", "/* own */ 1"),
    }


@pytest.mark.parametrize(
    ("name", "value", "before", "after"),
    [
        ("n", "4", "\nconst int n = 2,", "\nconst int n = 4,"),
        ("m", "9", "m = n + 1", "m = 9"),
        ("G.n", "false", "n = true", "n = false"),
        ("G.D.input", "2.5", "= 1.5", "= 2.5"),
        ("A.n", "[3]", "[1, 2]", "[3]"),
    ],
)
def test_constants_of_cif_have_absolute_names(tmp_path: Path, name: str, value: str, before: str, after: str) -> None:
    file = tmp_path / "m.cif"
    file.write_text(CIF)
    assert CIF.count(before) == 1
    assert replaced(str(file), Paths(), [{name: value}]) == [{str(file): CIF.replace(before, after)}]


def test_unknown_names_get_a_hint(robot: str) -> None:
    with pytest.raises(SettingError, match=r"r\.rscd has no constant or parameter `spede`; did you mean `speed`"):
        replaced(robot, Paths(), [{"spede": "1"}])


def test_a_name_in_two_files_is_ambiguous(robot: str, tmp_path: Path) -> None:
    (tmp_path / "Lamps.rscd").write_text(LIBRARY.replace("bright", "reach"))
    with pytest.raises(SettingError, match=r"several `reach`: .*r\.rscd:4 and .*Lamps\.rscd:2"):
        replaced(robot, Paths(), [{"reach": "1"}])


@pytest.mark.parametrize(
    "value",
    ["1..3", "(1", "2)", "1; plant P: location: initial; end", "1 // one", "1 /*", "1) + (2", "1; const int k = (2)"],
)
def test_a_value_is_one_expression(robot: str, tmp_path: Path, value: str) -> None:
    file = tmp_path / "m.cif"
    file.write_text(CIF)
    for path, name, kind in ((robot, "reach", ".rscd"), (str(file), "n", ".cif")):
        with pytest.raises(SettingError, match=re.escape(f"{name}: `{value}` is no expression of {kind} files")):
            replaced(path, Paths(), [{name: "1"}, {name: value}])


@pytest.mark.parametrize("value", ["(" * 5000 + "1" + ")" * 5000, "1 component Leg {}", "1 constant k: integer = 2"])
def test_a_value_adds_no_text_to_a_robot(robot: str, value: str) -> None:
    with pytest.raises(SettingError, match=r"is no expression of \.rscd files"):
        replaced(robot, Paths(), [{"reach": value}])


def test_all_wrong_names_and_values_are_in_one_message(robot: str) -> None:
    with pytest.raises(SettingError) as caught:
        replaced(robot, Paths(), [{"reach": "(1", "spede": "1"}, {"reach": "2)", "spede": "1"}])
    assert [line.partition(";")[0] for line in str(caught.value).splitlines()] == [
        "reach: `(1` is no expression of .rscd files",
        "reach: `2)` is no expression of .rscd files",
        f"{robot} has no constant or parameter `spede`",
    ]


def test_the_number_of_combinations_is_limited() -> None:
    with pytest.raises(SettingError, match=r"would have 1,000,000,000,000 jobs, and at most 1,000,000 are possible"):
        combinations(["a=1..1000000", "b=1..1000000"])


def test_all_wrong_settings_are_in_one_message() -> None:
    with pytest.raises(SettingError, match=r"(?s)n=: write NAME=.*\n5\.\.1: the last number.*\nm=2: m is set twice"):
        combinations(["n=", "k=5..1", "m=1", "m=2"])


NAMES = st.sampled_from(["a", "b", "C.d", "e"])
VALUES = st.sampled_from(["1", "-2", "0.5", '"x, y"', "min(1, 2)", "{ x: 1, y: 2 }", "[1, 2]", "true"])


@given(st.dictionaries(NAMES, st.lists(VALUES, min_size=1, max_size=4, unique=True), max_size=3))
def test_all_combinations_in_the_order_of_the_call(named: dict[str, list[str]]) -> None:
    settings = [f"{name}={','.join(values)}" for name, values in named.items()]
    assert [tuple(variant.values()) for variant in combinations(settings)] == list(product(*named.values()))
    assert all(list(variant) == list(named) for variant in combinations(settings))


@given(st.integers(-50, 50), st.integers(0, 50))
def test_a_range_stands_for_its_whole_numbers(low: int, more: int) -> None:
    values = [variant["n"] for variant in combinations([f"n={low}..{low + more}"])]
    assert values == [str(number) for number in range(low, low + more + 1)]


@pytest.mark.parametrize("settings", [["n"], ["n="], ["=1"], ["n=1,,"], ["n=5..1"], ["n=0..9999999"], ["n=1", "n=2"]])
def test_wrong_settings_are_named(settings: list[str]) -> None:
    with pytest.raises(SettingError, match=re.escape(settings[-1].partition("=")[2] or "write NAME=VALUE")):
        combinations(settings)
