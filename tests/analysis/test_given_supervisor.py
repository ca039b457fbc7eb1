"""Supervisors that a CIF specification already has: what they lack, and reading written supervisors again."""

import json
import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from robosc.analysis.supervise import supervise
from robosc.analysis.verify import Outcome, verify_system
from robosc.base.diagnostics.rules import page, summary
from robosc.language.cif import read
from robosc.tools.cli import main

RULE = "given-supervisor"
_PLANT = """controllable c, d; uncontrollable u;
plant P:
  disc int[0..2] n;
  location a: initial; marked; edge c do n := n + 1 goto b;
  location b: edge u goto a; edge d goto stuck;
  location stuck;
end
"""


def flaws(path: Path) -> list[str]:
    """Return the messages of the rule, after checking that `verify` agrees."""
    model = read(path).model
    assert model is not None
    found = [finding.message for finding in supervise(model).findings if finding.rule == RULE]
    [verdict] = [verdict for verdict in verify_system(model) if verdict.property == "given supervisor"]
    assert verdict.outcome is (Outcome.REFUTED if found else Outcome.PROVED)
    return [message.partition(": ")[2] for message in found]


@pytest.mark.parametrize(
    ("supervisor", "expected"),
    [
        ("supervisor c needs P.n < 2; supervisor d needs false;", []),
        ("supervisor c needs P.n < 2 and P.a; supervisor S: alphabet d; location: initial; marked; end", []),
        (
            "supervisor d needs false;",
            ["after `c`, then `u`, then `c`, then `u`, `c` can set `n` to a value out of range"],
        ),
        (
            "supervisor c needs P.n < 2;",
            ["after `c`, then `d`, `P` in `stuck` cannot get back to a marked state"],
        ),
        (
            "supervisor c needs P.n < 2; supervisor d needs false; supervisor u needs P.n < 2;",
            [
                "after `c`, then `u`, then `c`, `P` in `b` cannot get back to a marked state",
                (
                    "after `c`, then `u`, then `c`, `supervisor u needs P.n < 2` (line 8) forbids `u`, "
                    "which cannot be prevented"
                ),
            ],
        ),
        (
            "supervisor c needs P.n < 2; supervisor d needs false; requirement invariant P.n < 2;",
            ["after `c`, then `u`, then `c`, `requirement invariant P.n < 2` (line 8) is violated"],
        ),
        (
            "supervisor c needs P.n < 1; supervisor d needs false; @requirement:reachable(P.n = 0) group g: end",
            ["after `c`, no state with `P.n = 0` can be reached"],
        ),
    ],
)
def test_flaws_of_given_supervisors(tmp_path: Path, supervisor: str, expected: list[str]) -> None:
    path = tmp_path / "given.cif"
    path.write_text(f"{_PLANT}{supervisor}\n")
    assert sorted(flaws(path)) == sorted(expected)


@pytest.mark.build
def test_a_written_supervisor_is_a_specification_like_any_other(tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "plant.cif").write_text(_PLANT)
    path = tmp_path / "belt.cif"
    path.write_text('import "parts/plant.cif";\nrequirement invariant P.n < 2;\n')
    counts = []
    for file, folder in ((path, "one"), (tmp_path / "one" / "belt.supervised.cif", "two/inner")):
        output = str(tmp_path / folder)
        result = CliRunner().invoke(main, ["transform", str(file), "--to", "cif,supervisor,xmi", "-o", output])
        assert result.exit_code == 0, result.output
        counts.append(json.loads(CliRunner().invoke(main, ["synthesize", str(file), "--json"]).stdout))
    first, again = counts
    assert first["controlled_states"] == again["controlled_states"] == 3
    written = tmp_path / "one" / "belt.supervised.cif"
    assert flaws(written) == []
    verified = CliRunner().invoke(main, ["verify", str(written)])
    assert verified.exit_code == 0, verified.output
    assert flaws(tmp_path / "two" / "inner" / "belt_supervised.supervised.cif") == []
    assert 'state "sup"' in CliRunner().invoke(main, ["diagram", str(written), "--kind", "plants"]).stdout
    played = CliRunner().invoke(main, ["simulate", str(written), "--random", "5"])
    assert len(played.stdout.splitlines()) == 2  # After `c` and `u`, the supervisor permits nothing.
    saved = CliRunner().invoke(
        main, ["synthesize", str(tmp_path / "two" / "inner" / "belt_supervised.sct.xmi"), "--json"]
    )
    assert json.loads(saved.stdout)["controlled_states"] == 3


@pytest.mark.parametrize(("heading", "is_flawed"), [("Wrong", True), ("Right", False)])
def test_models_on_the_page(tmp_path: Path, heading: str, is_flawed: bool) -> None:
    text = page(RULE)
    assert text is not None
    assert summary(text).endswith(".")
    assert "\nSeverity: warning. `synthesize` and `transform` report it" in text
    [model] = re.findall(rf"^## {heading}\n\n```cif\n(.*?)^```$", text, flags=re.MULTILINE | re.DOTALL)
    (tmp_path / "belt.cif").write_text(model)
    assert bool(flaws(tmp_path / "belt.cif")) == is_flawed
