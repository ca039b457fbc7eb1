"""Files named in a call, a configuration or a saved model: no hang, no leak, no write outside the output."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from robosc.language import libraries, reading
from robosc.language.reading import read

from .conftest import DOOR, LAMPS, Run, not_longer_than

COMMANDS = {
    "model": ("check", "pipe.rscd"),
    "saved model": ("check", "pipe.xmi"),
    "configuration": ("transform", "door.rscd", "--to", "ros2", "--config", "pipe"),
    "script": ("simulate", "door.rscd", "--script", "pipe"),
    "layout": ("format", "pipe.rscd"),
    "device": ("check", "/dev/zero"),
}


@pytest.mark.parametrize("call", COMMANDS.values(), ids=list(COMMANDS))
def test_a_pipe_or_device_is_not_read(run: Run, door: Path, call: tuple[str, ...]) -> None:
    for name in ("pipe", "pipe.rscd", "pipe.xmi"):
        os.mkfifo(door.parent / name)
    with not_longer_than(60):
        done = run(*call)
    said = done.stdout + done.stderr
    assert (done.exit_code, "only regular files are read" in said) == (1 if call[1] == "pipe.xmi" else 2, True), said


@pytest.mark.slow
def test_a_standard_input_without_end_is_not_read_to_it(door: Path) -> None:
    for call in (["format", "-"], ["simulate", "door.rscd", "--script", "-"]):
        with Path("/dev/zero").open("rb") as zeros:
            done = subprocess.run(
                [sys.executable, "-m", "robosc", *call], cwd=door.parent, stdin=zeros, capture_output=True, check=False
            )
        assert (done.returncode, b"<stdin>: this has more than" in done.stderr) == (2, True)


def test_pipes_among_libraries_and_definitions(run: Run, courier: Path) -> None:
    os.mkfifo(courier.parent / "parts" / "pipe.rscd")
    package = courier.parent / "ros" / "courier_msgs" / "action"
    package.mkdir(parents=True)
    os.mkfifo(package / "Drive.action")
    os.mkfifo(package.parent / "package.xml")
    answer = run("check", courier, "-I", "parts", "--interface-path", "ros")
    assert answer.exit_code in (0, 1)
    assert "Drive.action: this is a pipe; only regular files are read" in answer.output


def test_a_folder_is_formatted_without_what_leads_out(run: Run, tmp_path: Path) -> None:
    untidy = DOOR.replace("  component", "component")
    (tmp_path / "elsewhere.rscd").write_text(untidy)
    (tmp_path / "models" / "sub").mkdir(parents=True)
    (tmp_path / "models" / "door.rscd").write_text(untidy)
    (tmp_path / "models" / "link.rscd").symlink_to(tmp_path / "elsewhere.rscd")
    (tmp_path / "models" / "up").symlink_to(tmp_path)
    os.mkfifo(tmp_path / "models" / "sub" / "pipe.rscd")
    assert run("format", "models").exit_code == 0
    assert (tmp_path / "models" / "door.rscd").read_text() == DOOR
    assert (tmp_path / "elsewhere.rscd").read_text() == untidy
    assert run("format", "models/link.rscd").exit_code == 0
    assert (tmp_path / "elsewhere.rscd").read_text() == DOOR
    assert (tmp_path / "models" / "link.rscd").is_symlink()


def saved_courier(run: Run, courier: Path) -> Path:
    """Return a saved model in its own folder, in which every element draws a finding."""
    assert run("transform", courier, "-I", "parts", "--to", "xmi", "-o", "out").exit_code == 0
    saved = Path("out/Courier.robosc.xmi")
    saved.write_text(saved.read_text().replace('marked="true"', 'marked="false"'))
    return saved


def forged(saved: Path, file: str) -> None:
    """Change the file that the model names as its source, and move each element to the first line."""
    text = re.sub(r'source="[^"]*"', 'source="1:1-1:20"', saved.read_text())
    saved.write_text(re.sub(r'file="[^"]*"', f'file="{file}"', text))


@pytest.mark.parametrize(
    "file",
    [
        "/proc/self/environ",
        "/proc/kmsg",
        "{out}/secret.rscd",
        "../secret.rscd",
        "link.rscd",
        "text",
        "below/pipe.rscd",
        "below",
        "secret.rscd",
        "circle.rscd",
    ],
)
def test_a_saved_model_shows_no_other_file(run: Run, courier: Path, file: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SECRET", "secret")
    saved = saved_courier(run, courier)
    out = saved.parent
    Path("secret.rscd").write_text("secret\n")
    (out / "text").write_text("secret\n")
    (out / "secret.rscd").write_text("secret\n") if "{out}" in file else None
    (out / "link.rscd").symlink_to(courier.parent / "secret.rscd")
    (out / "circle.rscd").symlink_to("circle.rscd")
    (out / "below").mkdir()
    os.mkfifo(out / "below" / "pipe.rscd")
    forged(saved, file.format(out=out.resolve()))
    with not_longer_than(60):
        done = run("check", saved)
    assert done.exit_code == 1
    assert "[marked-state]" in done.stdout
    assert "secret" not in done.stdout.replace("secret.rscd:", "")


@pytest.mark.parametrize("place", ["out/door.rscd", "out/sub/door.rscd", "shelf/door.rscd"])
def test_a_saved_model_shows_its_text(run: Run, courier: Path, place: str) -> None:
    saved = saved_courier(run, courier)
    Path(place).parent.mkdir(exist_ok=True)
    Path(place).write_text("robot Shown {}\n")
    forged(saved, "sub/door.rscd" if "sub" in place else "door.rscd")
    answer = run("check", saved, "-I", "parts", *(["-I", "shelf"] if place.startswith("shelf") else []))
    assert f"{place}:1:1: error:" in answer.stdout
    assert "    robot Shown {}\n    ^^^^" in answer.stdout


def test_findings_of_a_saved_model_and_a_configuration_show_their_lines(run: Run, door: Path) -> None:
    assert run("transform", door, "--to", "xmi", "-o", "out").exit_code == 0
    saved = Path("out/Door.sct.xmi")
    saved.write_text(saved.read_text().replace('controllable="true"', 'controllable="yes"'))
    answer = run("check", saved)
    assert 'controllable="yes"' in answer.stdout
    Path("controller-config.json").write_text('{"no": 1}')
    assert '{"no": 1}\n     ^^^^' in run("transform", door, "--to", "ros2").stdout


def test_two_files_of_one_name(run: Run, courier: Path) -> None:
    """A finding of synthesis about a library is in the library, even if the robot's file has the same name."""
    Path("parts/lamps.rscd").rename("parts/courier.rscd")
    answer = run("synthesize", courier.name, "-I", "parts")
    assert "parts/courier.rscd:4:5: warning:" in answer.stderr
    assert "    incoming message dark" in answer.stderr
    Path("robot").mkdir()
    courier.rename("robot/courier.rscd")
    assert run("transform", "robot/courier.rscd", "-I", "parts", "--to", "xmi", "-o", "out").exit_code == 0
    saved = Path("out/Courier.sct.xmi").read_text()
    assert 'source="parts/courier.rscd:4:5-' in saved
    assert 'source="courier.rscd:' in saved


def test_names_of_files_are_the_same_everywhere(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Below the model's folder a file is named by its relative path, elsewhere by its bare name."""
    texts = []
    for home in ("here", "there/deeper"):
        folder = tmp_path / home
        (folder / "sub").mkdir(parents=True)
        (folder / "robot.rscd").write_text(
            "robot R { component A from Lamps import Lamps component B from Other import Lamps"
            " component Stop from EmergencyStopLibrary import EmergencyStop"
            " provide light with true provide dark with false"
            " provide glow with true provide gloom with false }"
        )
        (folder / "sub" / "lamps.rscd").write_text(LAMPS)
        shelf = tmp_path / "shelves" / home.replace("/", "_")
        shelf.mkdir(parents=True)
        other = LAMPS.replace("library Lamps", "library Other").replace("light", "glow").replace("dark", "gloom")
        (shelf / "lamps.rscd").write_text(other)
        found = read(folder / "robot.rscd", [folder / "sub", shelf])
        assert [finding for finding in found.findings if finding.severity == "error"] == []
        assert found.base is not None
        names = [definition.type.library.file for definition in found.base.definitions if hasattr(definition, "type")]
        assert names[:2] == ["sub/lamps.rscd", "lamps.rscd"]
        assert "/" not in names[2]
        monkeypatch.chdir(folder)
        answer = run("transform", "robot.rscd", "-I", "sub", "-I", shelf, "--to", "xmi,supervisor", "-o", "out")
        assert answer.exit_code == 0, answer.output
        texts.append({path.name: path.read_bytes() for path in Path("out").rglob("*") if path.is_file()})
    assert texts[0] == texts[1]


def test_a_shipped_library_has_its_bare_name_wherever_it_is_installed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shipped = tmp_path / "environment" / "stdlib"
    shipped.mkdir(parents=True)
    (shipped / "lamps.rscd").write_text(LAMPS)
    (tmp_path / "robot.rscd").write_text("robot R { component A from Lamps import Lamps }")
    for module in (libraries, reading):
        monkeypatch.setattr(module, "locate", lambda _: shipped)
    base = read(tmp_path / "robot.rscd").base
    assert base is not None
    assert base.definitions[0].type.library.file == "lamps.rscd"


def test_a_diagram_spares_its_model_and_devices(run: Run, door: Path) -> None:
    for call in (["diagram", door, "-o", door], ["verify", door, "--junit", door]):
        answer = run(*call)
        assert (answer.exit_code, "an input file is not overwritten" in answer.stderr) == (2, True), answer.output
    assert door.read_text() == DOOR
    null = Path(os.devnull).stat()
    assert run("diagram", door, "-o", os.devnull).exit_code == 0
    assert os.path.samestat(null, Path(os.devnull).stat())
    Path("picture.mmd").symlink_to("real.mmd")
    assert run("diagram", door, "-o", "picture.mmd").exit_code == 0
    assert Path("picture.mmd").is_symlink()
    assert Path("real.mmd").read_text().startswith("stateDiagram")


def test_a_saved_model_is_not_written_over_by_what_comes_from_it(run: Run, door: Path) -> None:
    assert run("transform", door, "--to", "xmi", "-o", "out").exit_code == 0
    saved = Path("out/Door.sct.xmi")
    before = saved.read_bytes()
    assert run("transform", saved, "--to", "xmi", "-o", "out").exit_code == 0  # no file changes
    saved.write_bytes(before.replace(b"  <", b" <"))
    answer = run("transform", saved, "--to", "xmi", "-o", "out")
    assert (answer.exit_code, "an input file is not overwritten" in answer.stderr) == (2, True)


def test_a_session_is_not_saved_over_its_model(door: Path) -> None:
    commands = "save door.rscd\nsave \0\nload \0\nload /dev/zero\nsave trace\nload trace\nsave trace\n"
    done = subprocess.run(
        [sys.executable, "-m", "robosc", "simulate", "door.rscd"],
        cwd=door.parent,
        input=commands,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0
    assert "an input file is not overwritten" in done.stdout
    assert "only regular files are read" in done.stdout
    assert done.stdout.count("embedded null byte") == 2
    assert done.stdout.count("0 events in trace") == 2
    assert door.read_text() == DOOR


KEY = "output.ros2ControllerNodeLocation"


@pytest.mark.parametrize("location", ["{outside}", "../outside", "link", "~/outside"])
def test_a_folder_outside_of_the_models_is_confirmed(
    run: Run, tmp_path: Path, location: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    outside = tmp_path / "outside"
    model = tmp_path / "robot" / "door.rscd"
    (model.parent / "settings").mkdir(parents=True)
    model.write_text(DOOR)
    (model.parent / "link").symlink_to(outside)
    settings = {"output": {"ros2ControllerNodeLocation": location.format(outside=outside)}}
    (model.parent / "settings" / "controller-config.json").write_text(json.dumps(settings))
    call = ("transform", model, "--to", "ros2", "-o", "out")
    answer = run(*call)
    assert answer.exit_code == 1
    assert f'controller-config.json:1:13: error: "{KEY}" names ' in answer.stdout
    assert f"--confirm {KEY}" in answer.stdout
    assert not Path("out").exists()
    assert not outside.exists()
    assert run(*call, "--confirm", "output.ros1ControllerNodeLocation").exit_code == 1
    assert run("transform", model, "--to", "ros1", "-o", "out").exit_code == 0  # this call writes no file there
    answer = run(*call, "--confirm", KEY)
    assert answer.exit_code == 0, answer.output
    count = sum(path.is_file() for path in outside.rglob("*"))
    assert f"outside: {count} files, {count} written\n" in answer.stderr or f"link: {count} files" in answer.stderr


def test_a_folder_of_nobody(run: Run, door: Path) -> None:
    Path("controller-config.json").write_text('{"output": {"ros2ControllerNodeLocation": "~nobody_at_all/x"}}')
    answer = run("transform", door, "--to", "ros2")
    assert answer.exit_code == 1
    assert "names no folder: " in answer.stdout
