"""`robosc new`: its model is sound and behaves as its page states; no file is overwritten."""

import json
import runpy
import subprocess
import sys
from itertools import product
from pathlib import Path

import pytest
from click.testing import CliRunner

from robosc.tools.cli import main, new

from .conftest import Run

FLAGS = {
    "sensors": [(), ("--sensor", "clear", "--sensor", "docked_at")],
    "stop": [(), ("--stop", "-")],
    "service": [(), ("--service", "home")],
    "twist": [(), ("--twist",)],
}


@pytest.mark.parametrize(
    "flags", [sum(chosen, ()) for chosen in product(*FLAGS.values())], ids=lambda flags: " ".join(flags) or "none"
)
def test_each_combination_is_sound(run: Run, tmp_path: Path, flags: tuple[str, ...]) -> None:
    written = run("new", "my_porter", *flags)
    assert written.exit_code == 0, written.stderr
    folder = tmp_path / "my_porter"
    model = folder / "my_porter.rscd"
    assert {path.name for path in folder.iterdir()} == {
        model.name,
        "controller-config.json",
        "README.md",
        "test_my_porter.py",
    }
    for command in (["check"], ["format", "--check"]):
        answer = run(*command, model)
        assert (answer.exit_code, answer.output) == (0, "")
    story = runpy.run_path(str(folder / "test_my_porter.py"))["STORY"]
    played = CliRunner().invoke(
        main, ["simulate", str(model), "--script", "-"], input="\n".join(line for line, _ in story)
    )
    answers = [json.loads(line) for line in played.stdout.splitlines()]
    assert [answer["accepted"] for answer in answers] == [happens for _, happens in story]
    assert {answer["by"] for answer in answers if not answer["accepted"]} == {"requirement"}


@pytest.mark.parametrize("ros", ["1", "2"])
@pytest.mark.parametrize("stop", [(), ("--stop", "-")], ids=["halt", "no stop"])
def test_its_page_says_what_is_generated(run: Run, tmp_path: Path, ros: str, stop: tuple[str, ...]) -> None:
    run("new", "my_porter", "--ros", ros, "--twist", *stop)
    page = (tmp_path / "my_porter" / "README.md").read_text()
    generated = run("transform", "my_porter/my_porter.rscd", "--to", f"ros{ros}")
    assert f"transform my_porter.rscd --to ros{ros}\n" in page
    assert generated.exit_code == 0
    assert ("onShutdown" in generated.output) == ("onShutdown" in page) == (not stop)
    assert f"cp -r build/MyPorter/ros{ros}/my_porter_controller " in page
    launch = "my_porter_controller.launch" + ("" if ros == "1" else ".py")
    built = tmp_path / "build" / "MyPorter" / f"ros{ros}" / "my_porter_controller"
    assert (built / "launch" / launch).exists()
    assert f"my_porter_controller {launch}\n" in page
    assert ("robosc run my_porter.rscd\n" in page) == (ros == "2")


@pytest.mark.slow
def test_its_own_test_passes_and_can_fail(run: Run, tmp_path: Path) -> None:
    run("new", "Porter", "--service", "home", "--twist", "--sensor", "clear", "--sensor", "docked")
    command = [sys.executable, "-m", "unittest"]
    folder = tmp_path / "porter"
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    model = folder / "porter.rscd"
    model.write_text(model.read_text().replace("drive needs ClearSensor.active and ", "drive needs "))
    chosen = [*command, "test_porter.PorterTest.test_drive"]
    done = subprocess.run(chosen, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "FAILED (failures=1)" in done.stderr


@pytest.mark.slow
def test_it_is_verified(run: Run) -> None:
    run("new", "Porter", "--service", "home", "--twist", "--sensor", "clear", "--sensor", "docked")
    answer = run("verify", "porter/porter.rscd", "--json")
    assert json.loads(answer.stdout)["proved"] is True


def test_nothing_is_written_over(run: Run, tmp_path: Path) -> None:
    kept = tmp_path / "porter" / "notes.txt"
    kept.parent.mkdir()
    kept.write_text("mine")
    answer = run("new", "Porter")
    assert answer.exit_code == 2
    assert answer.stderr == "Error: porter exists already and is not overwritten; choose another folder\n"
    assert [path.name for path in kept.parent.iterdir()] == ["notes.txt"]
    (tmp_path / "file").write_text("")
    (tmp_path / "link").symlink_to("nowhere")
    assert [run("new", "Porter", "-o", name).exit_code for name in ("file", "link")] == [2, 2]
    (tmp_path / "empty").mkdir()
    assert run("new", "Porter", "-o", "empty").exit_code == 0
    assert run("new", "Porter", "-o", "deep/er").exit_code == 0


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (["../up"], "cannot name a robot"),
        (["4wd"], "cannot name a robot"),
        (["Porter", "--command", "Drive"], "cannot name a message or service"),
        (["Porter", "--sensor", "a__b"], "cannot name a message or service"),
        (["Porter", "--command", "goto"], "is a keyword"),
        (["Porter", "--command", "clear"], "`clear` is used twice"),
        (["Porter", "--sensor", "a_1", "--sensor", "a1"], "is too similar to another name"),
    ],
)
def test_names_that_will_not_do(run: Run, tmp_path: Path, call: list[str], said: str) -> None:
    answer = run("new", *call)
    assert answer.exit_code == 2
    assert said in answer.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("word", ["never", "after", "each", "all", "then", "ms", "property", "speed"])
def test_words_that_are_names_elsewhere_are_names_here(run: Run, word: str) -> None:
    assert run("new", "Porter", "--command", word, "--stop", f"{word}_not", "--twist").exit_code == 0
    assert run("check", "porter/porter.rscd").output == ""


def asked(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, answers: str, *call: str) -> str:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(new, "_on_terminal", lambda: True)
    done = CliRunner().invoke(main, ["new", "Porter", *call], input=answers, catch_exceptions=False)
    assert done.exit_code == 0, done.stderr
    return done.stderr


def test_questions_on_a_terminal(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    said = asked(monkeypatch, tmp_path, "1\nfree near\ngo\n-\nwake\ny\n")
    assert "ROS (1, 2) [2]" in said
    made = tmp_path / "porter"
    flags = ["--ros", "1", "--sensor", "free", "--sensor", "near", "--command", "go", "--stop", "-", "--service"]
    CliRunner().invoke(main, ["new", "Porter", *flags, "wake", "--twist", "-o", "same"], catch_exceptions=False)
    for path in made.iterdir():
        assert path.read_text() == (tmp_path / "same" / path.name).read_text()


def test_enter_takes_what_no_option_says(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    asked(monkeypatch, tmp_path, "\n" * 6)
    assert asked(monkeypatch, tmp_path, "", "--yes", "-o", "same") == ""
    for path in (tmp_path / "porter").iterdir():
        assert path.read_text() == (tmp_path / "same" / path.name).read_text()


def test_what_an_option_says_is_not_asked(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    flags = ["--ros", "2", "--sensor", "free", "--command", "go", "--stop", "rest", "--service", "-", "--twist"]
    assert asked(monkeypatch, tmp_path, "", *flags) == ""


def test_a_wrong_name_is_said_before_any_question(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(new, "_on_terminal", lambda: True)
    done = CliRunner().invoke(main, ["new", "4wd"], input="")
    assert done.exit_code == 2
    assert "ROS" not in done.stderr
