"""MISRA C:2012 as cppcheck's add-on checks it: docs/engine.md lists exactly its findings."""

import re
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path

import pytest

from robosc.model import sct
from tests.m2t.supervisor import corners
from tests.m2t.supervisor.driver import write
from tests.m2t.supervisor.test_supervisor import dock, supervised

pytestmark = pytest.mark.build

ROOT = Path(__file__).parents[3]
EXAMPLES = [path for path in sorted((ROOT / "examples").glob("*/*.rscd")) if path.stem == path.parent.name]

#: A layer, actions, and the largest example; `benchmarks/matrix.py` checks the others.
CHOSEN = ("supervised_line_follower", "simple_navigation", "warehouse_robot")


def guard() -> sct.SupervisoryControlModel:
    return supervised(ROOT / "tests" / "run" / "runtime" / "guard.rscd")


#: Features that no example has: wide ranges, enumerations, unbounded names, timers.
OTHERS = (dock, guard, corners.shared, corners.swap, corners.data, corners.incoming, corners.cancels)


def found(sources: Sequence[Path]) -> set[str]:
    """Return the rules that the add-on reports as violated."""
    if shutil.which("cppcheck") is None:
        pytest.skip("cppcheck is not installed")
    folder = sources[0].parent
    done = subprocess.run(
        ["cppcheck", "--addon=misra", "--std=c99", "--quiet", *(source.name for source in sources)],
        cwd=folder, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    assert "Traceback" not in done.stderr
    return set(re.findall(r"\[misra-c2012-(\d+\.\d+)\]", done.stderr))


def documented() -> dict[str, str]:
    """Return the rules of the page, and whether each is required."""
    return dict(re.findall(r"^\| (\d+\.\d+) \| (\w+) \| \S", (ROOT / "docs" / "engine.md").read_text(), re.MULTILINE))


def in_examples(folder: Path, names: Sequence[str]) -> set[str]:
    """Return the rules that examples violate; only one of the required rules may be among them."""
    folder.mkdir()
    paths = [path for path in EXAMPLES if path.stem in names]
    assert len(paths) == len(names)
    broken = found([write(supervised(path), folder) for path in paths])
    page = documented()
    assert {rule for rule in broken if page[rule] == "required"} == {"5.7"}
    return broken


def test_it_is_what_the_page_lists(tmp_path: Path) -> None:
    examples = in_examples(tmp_path / "examples", CHOSEN)
    folders = [tmp_path / name for name in ("others", "large")]
    for folder in folders:
        folder.mkdir()
    others = [
        *found([write(make(), folders[0]) for make in OTHERS]),
        *found([write(make(), folders[1], small=0) for make in OTHERS]),
    ]
    assert examples | set(others) == set(documented())


@pytest.mark.matrix
def test_no_other_example_breaks_more(tmp_path: Path) -> None:
    others = {path.stem for path in EXAMPLES} - set(CHOSEN)
    assert len(others) == 8
    assert in_examples(tmp_path / "examples", sorted(others)) <= set(documented())


def test_the_add_on_sees_what_is_wrong(tmp_path: Path) -> None:
    source = tmp_path / "wrong.c"
    source.write_text("int wrong(int x);\nint wrong(int x)\n{\n    goto end;\nend:\n    return wrong(x);\n}\n")
    assert {"15.1", "17.2"} & found([source]) - set(documented())
