"""The arguments of `@requirement:reachable`, from the text to the states that remain under the supervisor."""

from pathlib import Path

import pytest
from click.testing import CliRunner
from hypothesis import event, given, settings
from hypothesis import strategies as st

from robosc.language.cif import read
from robosc.language.text import Documents
from robosc.synthesis import synthesize
from robosc.tools.cli import main
from tests.searching import examples
from tests.synthesis.oracle import Oracle

#: Two ways from `a` to `d`: directly, and by `b` and `c`. Only `c` leads on from `b`.
_WAYS = """plant p:
  controllable e, f, g, h;
  location a: initial; marked; edge e goto b; edge g goto d;
  location b: marked; edge f goto c;
  location c: marked; edge h goto d;
  location d: marked; edge h goto a;
end
"""


def _remaining(arguments: str, plant: str = _WAYS) -> set[str]:
    """Return the locations that remain under the supervisor, after comparing them with an explicit search."""
    path = Path("ways.cif").resolve()
    reading = read(path, Documents({str(path): f"@requirement:reachable({arguments})\n{plant}"}))
    assert reading.findings == []
    assert reading.model is not None
    oracle = Oracle(reading.model)
    assert synthesize(reading.model).controlled_states == len(oracle.controlled)
    return {state[0].name for state in oracle.controlled}


@pytest.mark.parametrize(
    ("arguments", "remaining"),
    [
        ("d", "abcd"),
        ("d, bound: 3", "abcd"),
        ("d, bound: 2", "abcd"),
        # From `b`, `d` is two events away.
        ("d, bound: 1", "ad"),
        ("d, bound: 1, from: a", "abcd"),
        ("d, from: not b, bound: 1", "abcd"),
        ("d, bound: 0", ""),
        ("b or d, bound: 1", "abcd"),
        # The path from `b` is through `c`. From `c` itself, the requirement demands nothing.
        ("d, avoid: c", "ad"),
        ("d, avoid: c, from: a", "abcd"),
        ("d, avoid: c or b", "abcd"),
        ("d, stay: not c", "ad"),
        ("d, stay: a or d", "abcd"),
        ("d, stay: not c, avoid: b", "abcd"),
        # No path that avoids `d` ends in `d`.
        ("d, avoid: d", ""),
        ("avoid: c, bound: 2 - 1, d, from: true,", "ad"),
    ],
)
def test_the_supervisor_keeps_paths_within_the_arguments(arguments: str, remaining: str) -> None:
    assert _remaining(arguments) == set(remaining)


_LOCATIONS = "abcdef"
_SETS = st.sets(st.sampled_from(_LOCATIONS), min_size=1).map(lambda names: " or ".join(sorted(names)))


@st.composite
def _graphs(draw: st.DrawFn) -> str:
    """Draw an automaton in which each edge has an event of its own. Each location has a controllable way back."""
    lines = ["plant p:"]
    for number, name in enumerate(_LOCATIONS):
        targets = draw(st.lists(st.sampled_from(_LOCATIONS), min_size=1, max_size=3, unique=True))
        kinds = ["", *(draw(st.sampled_from(["", "", "un"])) for _ in targets[1:])]
        lines.insert(1, " ".join(f"{kind}controllable e{number}{to};" for kind, to in zip(kinds, targets, strict=True)))
        edges = " ".join(f"edge e{number}{to} goto {to};" for to in targets)
        lines.append(f"location {name}: {'initial; ' if number == 0 else ''}marked; {edges}")
    return "\n".join([*lines, "end"])


@given(
    _graphs(), _SETS, st.dictionaries(st.sampled_from(["from", "avoid", "stay"]), _SETS), st.none() | st.integers(0, 4)
)
@settings(max_examples=examples(100), deadline=None)
def test_random_graphs_against_an_explicit_search(
    graph: str, goal: str, named: dict[str, str], bound: int | None
) -> None:
    bounds = {} if bound is None else {"bound": bound}
    arguments = ", ".join([goal, *(f"{name}: {value}" for name, value in {**named, **bounds}.items())])
    remaining = _remaining(arguments, graph)
    event("empty" if not remaining else "all" if remaining == _remaining("true", graph) else "some")


def test_explain_names_the_whole_path(tmp_path: Path) -> None:
    path = tmp_path / "ways.cif"
    path.write_text(f"@requirement:reachable(d, avoid: c, bound: 1)\n{_WAYS}")
    result = CliRunner().invoke(main, ["explain", str(path), "--event", "p.e", "--state", "p=a"])
    assert "no state with `p.d` in at most 1 event through states with `!p.c` only can be reached" in result.output


def test_a_saved_model_keeps_the_path(tmp_path: Path) -> None:
    path = tmp_path / "ways.cif"
    path.write_text(f"@requirement:reachable(d, avoid: c, bound: 1)\n{_WAYS}")
    assert CliRunner().invoke(main, ["transform", str(path), "--to", "xmi", "-o", str(tmp_path)]).exit_code == 0
    counted = CliRunner().invoke(main, ["synthesize", str(tmp_path / "ways.sct.xmi"), "--counts"])
    assert counted.output == "ways: 2 states\n"
