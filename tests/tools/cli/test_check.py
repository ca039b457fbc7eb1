"""`robosc check`: all findings of all models, in each format, with the right exit status."""

import json
from pathlib import Path

import pytest

from robosc.base.diagnostics import Edit
from robosc.language.checks.automatic_edits import CheckedModel

from .conftest import DOOR, Run


def test_nothing_wrong(run: Run, door: Path, library: Path) -> None:
    answer = run("check", door, library)
    assert (answer.exit_code, answer.output) == (0, "")


def test_findings_as_text(run: Run, broken: Path) -> None:
    answer = run("check", broken.name)
    assert answer.exit_code == 1
    first, _, second = answer.stdout.partition("broken.rscd:17:")
    assert first.startswith("broken.rscd:11:7: error: ")
    assert "[initial-state]\n          initial marked state opened {\n          ^^^^" in first
    assert "[unresolved-reference]\n      requirement open needs Leaf.x\n" in second
    assert answer.stderr == "2 errors\n"


def test_findings_as_json(run: Run, broken: Path) -> None:
    answer = run("check", broken.name, "--format", "json")
    assert answer.exit_code == 1
    found = json.loads(answer.stdout)
    assert [(finding["file"], finding["line"], finding["rule"]) for finding in found] == [
        (broken.name, 11, "initial-state"),
        (broken.name, 17, "unresolved-reference"),
    ]


def test_findings_as_sarif(run: Run, broken: Path) -> None:
    answer = run("check", broken, "--format", "sarif")
    assert answer.exit_code == 1
    assert json.loads(answer.stdout)["version"] == "2.1.0"


def test_no_findings_are_an_empty_list(run: Run, door: Path) -> None:
    answer = run("check", door, "--format", "json")
    assert (answer.exit_code, json.loads(answer.stdout)) == (0, [])


def test_one_broken_model_among_others(run: Run, broken: Path, door: Path, tmp_path: Path) -> None:
    damaged = tmp_path / "damaged.xmi"
    damaged.write_text("<robot")
    answer = run("check", damaged, door, broken, "--format", "json")
    assert answer.exit_code == 1
    assert {Path(load["file"]).name for load in json.loads(answer.stdout)} == {"damaged.xmi", "broken.rscd"}


def test_a_warning_is_no_error(run: Run, tmp_path: Path) -> None:
    file = tmp_path / "twice.rscd"
    message = 'component {} {{ outgoing message {} with identifier: "/x", type: none }}'
    file.write_text(f"robot Twice {{ {message.format('A', 'a')} {message.format('B', 'b')} }}")
    answer = run("check", file)
    assert answer.exit_code == 0
    assert "[unique-topic]" in answer.stdout
    assert answer.stderr == "1 warning\n"


def test_libraries_are_found_in_the_folders_of_the_call(run: Run, tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "parts.rscd").write_text(
        DOOR.replace("robot Door", "library Parts").partition("  req")[0] + "}"
    )
    file = tmp_path / "house.rscd"
    file.write_text("robot House { component Front from Parts import Leaf }")
    assert run("check", file).exit_code == 1
    assert run("check", file, "-I", "elsewhere").exit_code == 0
    assert run("check", file, "--library-path", tmp_path, "-I", "elsewhere").exit_code == 0


def test_saved_models_are_checked_too(run: Run, door: Path) -> None:
    assert run("transform", door, "--to", "xmi", "-o", "out").exit_code == 0
    assert run("check", *Path("out").glob("*.xmi")).exit_code == 0
    saved = Path("out/Door.robosc.xmi")
    saved.write_text(saved.read_text().replace('initial="false"', 'initial="true"'))
    answer = run("check", saved)
    assert answer.exit_code == 1
    assert "[initial-state]" in answer.stdout


def test_fix(run: Run, tmp_path: Path) -> None:
    model = tmp_path / "door.rscd"
    wrong = DOOR.replace("needs", "requires").replace("}\n\n  r", "};\n\n  r")
    model.write_bytes(wrong.replace("\n", "\r\n").encode())
    answer = run("check", model, "--fix")
    assert (answer.exit_code, answer.output) == (0, f"{model}: 2 edits\n")
    assert model.read_bytes() == DOOR.replace("\n", "\r\n").encode()


@pytest.mark.parametrize("breaks", ["\n", "\r\n", "\r"])
def test_a_fix_keeps_the_rest_of_the_file(run: Run, tmp_path: Path, breaks: str) -> None:
    """This includes the byte order mark and the line breaks, of which the first has another form."""
    model = tmp_path / "door.rscd"

    def written(text: str) -> bytes:
        return b"\xef\xbb\xbf" + text.replace("\n", breaks).replace(breaks, "\r\n", 1).encode()

    model.write_bytes(written(DOOR.replace("needs", "requires")))
    assert run("check", model, "--fix").exit_code == 0
    assert model.read_bytes() == written(DOOR)


def test_bytes_that_are_no_text_are_not_fixed_away(run: Run, tmp_path: Path) -> None:
    model = tmp_path / "door.rscd"
    content = DOOR.replace("goto opened", "gotto opened // caf\xe9", 1).encode("latin-1")
    model.write_bytes(content)
    assert run("check", model, "--fix").exit_code == 1
    assert model.read_bytes() == content


def test_a_fix_that_makes_a_model_worse_is_left_out(run: Run, tmp_path: Path) -> None:
    """`opened` resembles the misspelled name and is a state, but the condition would have the wrong type."""
    model = tmp_path / "door.rscd"
    text = DOOR.replace("robot Door {", "robot Door {\n  constant limit: double = 1.0\n").replace(
        "needs Leaf.closed", "needs Leaf.closed and lmit"
    )
    model.write_text(text)
    answer = run("check", model, "--fix")
    assert "did you mean `limit`?" in answer.stdout
    assert model.read_text() == text


def test_rounds_end_where_a_text_was_seen_before(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    seen = []

    def forth_and_back(found: CheckedModel, _: object) -> list[Edit]:
        text = found.reading.file.text
        seen.append(text.content)
        start = text.content.index(" {")
        return [Edit(text.span(start - 1, start), "n" if text.content[start - 1] == "r" else "r")]

    monkeypatch.setattr("robosc.tools.cli.check.safe_edits", forth_and_back)
    (tmp_path / "door.rscd").write_text(DOOR)
    run("check", tmp_path / "door.rscd", "--fix")
    assert seen == [DOOR, DOOR.replace("Door", "Doon", 1)]


def test_what_is_to_be_chosen_is_not_fixed(run: Run, tmp_path: Path) -> None:
    model = tmp_path / "door.rscd"
    text = DOOR.replace("marked ", "")
    model.write_text(text)
    answer = run("check", model, "--fix")
    assert answer.exit_code == 1
    assert "[marked-state]" in answer.stdout
    assert model.read_text() == text


def test_only_texts_are_fixed(run: Run, tmp_path: Path) -> None:
    (tmp_path / "model.cif").write_text("automaton a: location: initial; marked; end")
    answer = run("check", tmp_path / "model.cif", "--fix")
    assert answer.exit_code == 2
    assert "--fix edits only text" in answer.output
