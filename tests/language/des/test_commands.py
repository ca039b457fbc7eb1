"""Commands that accept files of automata, and those that reject them. No damaged file ends in a traceback."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st

from robosc.language.des import read
from robosc.language.text import Documents
from robosc.tools.cli import main

_MODELS = Path(__file__).parent / "models"
_SYSTEMS = {"small_factory.automata": 12, "transfer_line.wmod": 28, "cat_and_mouse.automata": 6}
EACH = pytest.mark.parametrize("name", _SYSTEMS)
_FILES = sorted(path for path in _MODELS.iterdir() if path.suffix != ".cif")


def call(*arguments: str) -> str:
    done = CliRunner().invoke(main, list(arguments))
    assert (done.exit_code, done.stderr) == (0, ""), done.output
    return done.stdout


@EACH
def test_check_finds_nothing(name: str) -> None:
    assert call("check", str(_MODELS / name)) == ""


@EACH
def test_synthesize_counts(name: str) -> None:
    assert json.loads(call("synthesize", str(_MODELS / name), "--json"))["controlled_states"] == _SYSTEMS[name]


@EACH
@pytest.mark.slow
def test_verify_refutes_nothing(name: str) -> None:
    rows = json.loads(call("verify", str(_MODELS / name), "--json"))["properties"]
    verdicts = {row["property"]: row["outcome"] for row in rows}
    assert set(verdicts.values()) <= {"proved", "skipped"}
    assert {verdicts[name] for name in ("non-blocking", "controllability", "cif-translation")} == {"proved"}


def test_explain_names_places_in_all_files() -> None:
    answer = call("explain", str(_MODELS / "small_factory.automata"), "--event", "start1", "--state", "buffer=s2")
    assert re.findall(r"(\w+\.gen):(\d+):1:", answer) == [
        ("m1.gen", "5"),
        ("buffer.gen", "1"),
        ("m2.gen", "11"),
        ("buffer.gen", "14"),
    ]


@EACH
def test_simulate_and_diagram_run(name: str) -> None:
    assert CliRunner().invoke(main, ["simulate", str(_MODELS / name), "--random", "5", "--seed", "1"]).exit_code == 0
    assert call("diagram", str(_MODELS / name), "--kind", "plants")


@EACH
def test_the_cif_counts_the_same(name: str, tmp_path: Path) -> None:
    done = CliRunner().invoke(
        main, ["transform", str(_MODELS / name), "--to", "cif,supervisor,xmi", "-o", str(tmp_path)]
    )
    assert done.exit_code == 0, done.output
    stem = name.partition(".")[0]
    assert f"{_SYSTEMS[name]} states" in call("synthesize", str(tmp_path / f"{stem}.cif"), "--counts")
    assert f'import "{stem}.cif";' in (tmp_path / f"{stem}.supervised.cif").read_text(encoding="utf-8")
    assert f"{_SYSTEMS[name]} states" in call("synthesize", str(next(tmp_path.glob("*.xmi"))), "--counts")


def test_commands_of_a_robot_reject_automata() -> None:
    done = CliRunner().invoke(main, ["run", str(_MODELS / "transfer_line.wmod")])
    assert done.exit_code == 2
    assert "is a file of automata, which has no ROS graph" in done.stderr


def test_a_finding_shows_its_line(tmp_path: Path) -> None:
    text = (_MODELS / "m1.gen").read_text(encoding="utf-8").replace('"busy" "done1"', '"busy" "dome1"')
    (tmp_path / "m1.gen").write_text(text, encoding="utf-8")
    done = CliRunner().invoke(main, ["check", str(tmp_path / "m1.gen")])
    assert done.exit_code == 1
    assert "m1.gen:12:8: error: the event `dome1` is not in the alphabet [unresolved-reference]" in done.stdout
    assert '"busy" "dome1"' in done.stdout


@pytest.mark.parametrize("path", _FILES, ids=lambda path: path.name)
@given(data=st.data())
def test_damaged_files_have_findings_in_them(path: Path, data: st.DataObject) -> None:
    """Reading ends, and each finding is in a file of the system."""
    content = path.read_text(encoding="utf-8")
    start = data.draw(st.integers(0, len(content)))
    end = data.draw(st.integers(start, min(len(content), start + 40)))
    inserted = data.draw(st.sampled_from(["", '"', "<", ">", "</a>", "7", "<EventList>", "#", "<?x?>", "&", "\0"]))
    damaged = content[:start] + inserted + content[end:]
    reading = read(path, Documents({str(path): damaged}))
    names = {str(file) for file in _MODELS.iterdir()}
    assert all(finding.file in names for finding in reading.findings)
    assert reading.model is not None or reading.findings
