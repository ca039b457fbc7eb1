"""Models without findings can be transformed, and no text makes reading or checking fail.

The models are the repository's own and random ones. `tests/fuzz` adds faults to them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from robosc.base.diagnostics import Diagnostic, as_text, has_errors
from robosc.language.checks import check
from robosc.language.reading import read
from robosc.m2m import robosc_to_rosgraph, robosc_to_sct
from robosc.model import robosc
from robosc.model.validity import faults
from tests.fuzz.mutants import LIBRARIES, sources
from tests.random_robots import random_robot
from tests.searching import examples

if TYPE_CHECKING:
    from pathlib import Path

SOURCES = sources()
MODELS = examples(50)


def examined(path: Path) -> tuple[robosc.Base | None, list[Diagnostic]]:
    """Read and check a file; render its findings."""
    reading = read(path, [LIBRARIES])
    found = [*reading.findings, *check(reading.base, reading.findings)]
    assert as_text.render(found, reading.texts) or not found
    return reading.base, found


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("models") / "model.rscd"


def limited(count: int) -> settings:
    return settings(max_examples=count, deadline=None, suppress_health_check=list(HealthCheck))


def transformed(robot: robosc.Robot) -> None:
    model, trace = robosc_to_sct.transform(robot)
    assert [fault for _, fault in faults(model)] == []
    graph = robosc_to_rosgraph.transform(trace)
    assert [fault for _, fault in faults(graph)] == []


@pytest.mark.slow
def test_a_random_robot_is_transformed(path: Path) -> None:
    clean = 0
    for seed in range(MODELS):
        path.write_text(random_robot(seed), encoding="utf-8")
        base, found = examined(path)
        assert not {"syntax", "unresolved-reference", "type"} & {finding.rule for finding in found}, f"seed {seed}"
        if isinstance(base, robosc.Robot) and not has_errors(found):
            clean += 1
            transformed(base)
    assert clean > 0.9 * seed


@pytest.mark.slow
@pytest.mark.parametrize("text", ["".join(source) for source in SOURCES], ids=range(len(SOURCES)))
def test_every_model_of_the_repository_that_has_no_error_is_transformed(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8")
    base, found = examined(path)
    if isinstance(base, robosc.Robot) and not has_errors(found):
        transformed(base)


@limited(MODELS)
@given(data=st.one_of(st.binary(max_size=200), st.text(max_size=200).map(lambda text: text.encode(errors="replace"))))
def test_no_text_breaks_reading_and_checking(path: Path, data: bytes) -> None:
    path.write_bytes(data)
    examined(path)


@limited(MODELS)
@given(
    soup=st.lists(st.sampled_from(sorted({character for text in SOURCES for character in text})), max_size=80).map(
        " ".join
    )
)
def test_no_words_break_reading_and_checking(path: Path, soup: str) -> None:
    path.write_text(f"robot R {{ {soup}", encoding="utf-8")
    examined(path)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("operator", "operand", "count"),
    [("or", "C.b", 3000), ("=>", "C.b", 1000), ("=", "C.b", 1000), ("-", "C.n", 1000)],
)
def test_a_long_expression_is_transformed(path: Path, operator: str, operand: str, count: int) -> None:
    expression = f" {operator} ".join([operand] * count)
    condition = expression if operand == "C.b" else f"3 > {expression}"
    path.write_text(
        f"""robot R {{
          component C {{
            incoming message go with type: none
            behaviour {{
              variable b: boolean
              variable n: integer(0..1)
              initial marked state s {{ transition if b and n = 0 }}
            }}
          }}
          requirement go needs {condition}
        }}"""
    )
    base, found = examined(path)
    assert found == []
    assert isinstance(base, robosc.Robot)
    model, trace = robosc_to_sct.transform(base)
    assert len(model.requirements) == 1
    assert robosc_to_rosgraph.transform(trace).publishers


@pytest.mark.slow
@pytest.mark.parametrize(
    ("condition", "message"),
    [
        (" or ".join(["C.b"] * 20_000), "this expression has more than 5000 operators"),
        (f"{'(' * 10_000}C.b{')' * 10_000}", "this is nested more than 50 levels deep"),
        ("!" * 10_000 + "C.b", "this is nested more than 50 levels deep"),
    ],
    ids=["operators", "brackets", "negations"],
)
def test_an_expression_beyond_reason_is_a_finding(path: Path, condition: str, message: str) -> None:
    behaviour = "behaviour { variable b: boolean initial marked state s { } }"
    path.write_text(
        f"""robot R {{
          component C {{ incoming message go with type: none {behaviour} }}
          requirement go needs {condition}
        }}"""
    )
    _, found = examined(path)
    assert [(finding.rule, finding.span.line, finding.message) for finding in found] == [("syntax", 3, message)]
