"""`cif-translation` of a model from CIF: the written CIF, executed as CIF's tools do, against the model."""

import re
from pathlib import Path

import pytest

from robosc.analysis.supervise import supervise
from robosc.analysis.verify import Outcome, validate_cif
from robosc.language.cif import read
from robosc.language.configuration import Configuration
from robosc.m2t import cif
from robosc.m2t.models import Models
from robosc.model import sct
from tests.language.cif.random_specifications import Specification
from tests.language.cif.test_language import COUNTS
from tests.language.cif.test_random_specifications import supervised

_TEXT = """plant P:
  controllable up, down, go;
  uncontrollable u;
  disc int[0..3] n;
  location a: initial; marked;
    edge up do n := n + 1;
    edge down do n := n - 1;
    edge go goto b;
  location b:
    edge u goto a;
    edge up when n < 2 do n := n + 2;
end
requirement automaton R:
  disc int[0..2] m;
  location: initial; marked;
    edge P.up do m := m + 1;
    edge P.down do m := 0;
end
requirement P.n != 2 or P.a;
"""


def written(path: Path) -> tuple[sct.SupervisoryControlModel, dict[str, str]]:
    """Return the model of a specification with its supervisor, and the files generated from it."""
    model = read(path).model
    assert model is not None
    supervise(model)
    return model, cif.generate(Models(model), Configuration())


@pytest.fixture
def specification(tmp_path: Path) -> Path:
    path = tmp_path / "lift.cif"
    path.write_text(_TEXT)
    return path


def test_the_written_cif_does_what_the_model_does(specification: Path) -> None:
    verdict = validate_cif(*written(specification))
    assert (verdict.outcome, verdict.evidence) == (Outcome.PROVED, "4 events in 13 states")


def changed(specification: Path, pattern: str, replacement: str) -> tuple[str, list[str]]:
    """Return the explanation and the trace that refute a changed text."""
    model, files = written(specification)
    [(name, text)] = files.items()
    assert len(re.findall(pattern, text)) == 1, text
    verdict = validate_cif(model, {name: re.sub(pattern, replacement, text)})
    assert verdict.outcome is Outcome.REFUTED
    return verdict.explanation, [step.event for step in verdict.trace]


def test_without_a_guard_a_variable_leaves_its_range(specification: Path) -> None:
    explanation, way = changed(specification, "edge P.down when [^;]*;", "edge P.down;")
    assert (
        explanation
        == "`P.down` sets `n` to a value out of its range in the generated CIF where `P.a and P.n = 0 and R.m = 0`"
    )
    assert way == []


def test_the_range_of_a_variable_of_a_requirement_counts_too(specification: Path) -> None:
    explanation, way = changed(specification, r" and R\.m \+ 1 <= 2", "")
    assert explanation.startswith("`P.up` sets `m` to a value out of its range in the generated CIF where ")
    assert way.count("P.up") == 2


@pytest.mark.parametrize(
    ("pattern", "replacement", "said"),
    [
        (
            "edge P.go( when [^;]*)?;",
            "edge P.go when false;",
            "`P.go` can happen in the model and not in the generated",
        ),
        ("initial; marked;", "initial false; marked;", "the generated CIF starts in other states"),
        ("initial; marked;", "initial;", "the supervisor does not start, or is not marked"),
        ("edge P.go( when [^;]*)?;", "edge P.gone;", "there is no `gone` in `P`"),
        (r"(?s)supervisor automaton.*", "plant q: location: initial; marked; edge P.go; end", "`P.down` sets `n`"),
        ("location:", "location other; location:", "is wrong: "),
    ],
)
def test_any_other_change_is_found(specification: Path, pattern: str, replacement: str, said: str) -> None:
    assert said in changed(specification, pattern, replacement)[0]


def test_a_text_that_is_gone_is_not_examined(specification: Path) -> None:
    model, files = written(specification)
    specification.unlink()
    assert validate_cif(model, files).outcome is Outcome.SKIPPED


@pytest.mark.parametrize("name", COUNTS)
def test_each_construct_is_written_so_that_it_does_what_the_model_does(name: str, tmp_path: Path) -> None:
    path = tmp_path / "main.cif"
    path.write_text(COUNTS[name][0])
    verdict = validate_cif(*written(path))
    assert verdict.outcome is Outcome.PROVED, verdict.explanation


@pytest.mark.slow
def test_so_are_random_specifications(tmp_path: Path) -> None:
    examined = 0
    for seed in range(80):
        if supervised(seed) is not None:
            for name, text in Specification(seed).files.items():
                (tmp_path / name).write_text(text)
            verdict = validate_cif(*written(tmp_path / "random.cif"))
            assert verdict.outcome is Outcome.PROVED, f"seed {seed}: {verdict.explanation}"
            examined += 1
    assert examined >= 20
