"""`robosc format`: written files, shown files, and unchanged files."""

from pathlib import Path

import pytest
from click.testing import CliRunner

from robosc.tools.cli import main

from .conftest import DOOR, Run

MESSY = DOOR.replace("  component", "component").replace(" {\n", "{\n")
ROOT = Path(__file__).parents[3]


@pytest.fixture
def messy(tmp_path: Path) -> Path:
    """Return a file whose layout is not the canonical one."""
    file = tmp_path / "messy.rscd"
    file.write_text(MESSY)
    return file


def test_a_file_is_written_in_place(run: Run, messy: Path) -> None:
    messy.chmod(0o640)
    answer = run("format", messy)
    assert (answer.exit_code, answer.output) == (0, "")
    assert messy.read_text() == DOOR
    assert messy.stat().st_mode & 0o777 == 0o640
    assert [path.name for path in messy.parent.iterdir()] == ["messy.rscd"]


def test_a_file_that_has_the_layout_is_not_touched(run: Run, door: Path) -> None:
    before = door.stat().st_mtime_ns
    for options in ([], ["--check"], ["--diff"], ["--check", "--diff"]):
        answer = run("format", door, *options)
        assert (answer.exit_code, answer.output) == (0, "")
    assert door.stat().st_mtime_ns == before


def test_check_lists_what_would_change(run: Run, messy: Path, door: Path) -> None:
    answer = run("format", "--check", door.name, messy.name)
    assert (answer.exit_code, answer.stdout, answer.stderr) == (1, "messy.rscd\n", "")
    assert messy.read_text() == MESSY


def test_diff_shows_what_would_change(run: Run, tmp_path: Path) -> None:
    (tmp_path / "a.rscd").write_text("robot R {\n}")
    answer = run("format", "--diff", "a.rscd")
    assert answer.exit_code == 0
    assert answer.stdout == (
        "--- a.rscd\n+++ a.rscd\n@@ -1,2 +1 @@\n-robot R {\n-}\n\\ No newline at end of file\n+robot R {}\n"
    )
    assert (tmp_path / "a.rscd").read_text() == "robot R {\n}"
    assert run("format", "--diff", "--check", "a.rscd").exit_code == 1


def test_folders_are_searched(run: Run, tmp_path: Path) -> None:
    for name in ("models/b.rscd", "models/a/c.rscd", "models/a/.git/d.rscd", "models/readme.txt"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("library L{}")
    answer = run("format", "--check", "models", "models/b.rscd")
    assert (answer.exit_code, answer.stdout) == (1, "models/b.rscd\nmodels/a/c.rscd\n")
    assert run("format", "models").exit_code == 0
    assert (tmp_path / "models/a/c.rscd").read_text() == "library L {}\n"
    assert (tmp_path / "models/a/.git/d.rscd").read_text() == "library L{}"


def test_a_file_with_syntax_errors_is_left_alone_among_others(run: Run, messy: Path, tmp_path: Path) -> None:
    (tmp_path / "faulty.rscd").write_text("robot R{ componen }")
    answer = run("format", "faulty.rscd", messy)
    assert (answer.exit_code, answer.stdout) == (1, "")
    assert answer.stderr.startswith("faulty.rscd:1:10: error: ")
    assert "robot R{ componen }" in answer.stderr
    assert (tmp_path / "faulty.rscd").read_text() == "robot R{ componen }"
    assert messy.read_text() == DOOR


def test_a_file_that_is_no_text_is_left_alone(run: Run, tmp_path: Path) -> None:
    (tmp_path / "latin.rscd").write_bytes(b"robot R{} // \xe9")
    answer = run("format", "latin.rscd")
    assert answer.exit_code == 1
    assert "latin.rscd:1:14: error: the byte 0xe9 is not UTF-8" in answer.stderr
    assert (tmp_path / "latin.rscd").read_bytes() == b"robot R{} // \xe9"


def test_names_need_not_resolve(run: Run, tmp_path: Path) -> None:
    (tmp_path / "a.rscd").write_text("robot R{component A from Nowhere import B requirement c needs d}")
    assert run("format", "a.rscd").exit_code == 0
    assert (tmp_path / "a.rscd").read_text() == (
        "robot R {\n  component A from Nowhere import B\n  requirement c needs d\n}\n"
    )


def test_line_ends_and_byte_order_marks_count(run: Run, tmp_path: Path) -> None:
    (tmp_path / "a.rscd").write_bytes(b"\xef\xbb\xbfrobot R {}\r\n")
    assert run("format", "--check", "a.rscd").exit_code == 1
    assert "+robot R {}\n" in run("format", "--diff", "a.rscd").stdout
    run("format", "a.rscd")
    assert (tmp_path / "a.rscd").read_bytes() == b"robot R {}\n"


def test_from_standard_input_to_standard_output() -> None:
    answer = CliRunner().invoke(main, ["format", "-"], input=MESSY + "// é")
    assert (answer.exit_code, answer.stdout_bytes.decode()) == (0, DOOR + "// é\n")
    answer = CliRunner().invoke(main, ["format", "-", "--check"], input=MESSY)
    assert (answer.exit_code, answer.stdout) == (1, "<stdin>\n")
    answer = CliRunner().invoke(main, ["format", "-"], input="robot")
    assert (answer.exit_code, answer.stdout) == (1, "")
    assert answer.stderr.startswith("<stdin>:1:6: error: ")


def test_links_stay_links(run: Run, messy: Path, tmp_path: Path) -> None:
    link = tmp_path / "link.rscd"
    link.symlink_to(messy)
    assert run("format", link).exit_code == 0
    assert link.is_symlink()
    assert messy.read_text() == DOOR


@pytest.mark.parametrize("arguments", [[], ["missing.rscd"], ["door.xmi"]])
def test_wrong_calls(run: Run, tmp_path: Path, arguments: list[str]) -> None:
    (tmp_path / "door.xmi").write_text("<robot/>")
    assert run("format", *arguments).exit_code == 2


def test_what_ships_has_the_layout() -> None:
    answer = CliRunner().invoke(main, ["format", "--check", str(ROOT / "examples"), str(ROOT / "robosc/stdlib")])
    assert (answer.exit_code, answer.output) == (0, "")
