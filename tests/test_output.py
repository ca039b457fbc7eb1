"""Writing is all or nothing, changes only what differs, and stays inside of its folder."""

import os
from pathlib import Path

import pytest

from robosc.output import OutputError, write


def tree(folder: Path) -> dict[str, str]:
    """Everything below a folder: links by where they lead, folders by a slash, files by their text."""
    found = {}
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder).as_posix()
        if path.is_symlink():
            found[name] = f"-> {path.readlink()}"
        else:
            found[name] = "/" if path.is_dir() else path.read_text()
    return found


def test_new_folders_and_files(tmp_path: Path) -> None:
    changed = write({tmp_path / "deep" / "out": {"a.txt": "é\n", "b/c.txt": "c"}, tmp_path / "copy": {"c.txt": "c"}})
    assert tree(tmp_path) == {
        "copy": "/",
        "copy/c.txt": "c",
        "deep": "/",
        "deep/out": "/",
        "deep/out/a.txt": "é\n",
        "deep/out/b": "/",
        "deep/out/b/c.txt": "c",
    }
    assert changed == [tmp_path / "deep/out/a.txt", tmp_path / "deep/out/b/c.txt", tmp_path / "copy/c.txt"]
    assert (tmp_path / "copy").stat().st_mode == (tmp_path / "deep").stat().st_mode


def test_only_what_differs_is_touched(tmp_path: Path) -> None:
    write({tmp_path: {"same": "1", "other": "2"}})
    (tmp_path / "mine").write_text("not generated")
    for name in ("same", "other"):
        os.utime(tmp_path / name, (1, 1))
    assert write({tmp_path: {"same": "1", "other": "3"}}) == [tmp_path / "other"]
    assert (tmp_path / "same").stat().st_mtime == 1
    assert (tmp_path / "other").stat().st_mtime > 1
    assert tree(tmp_path) == {"same": "1", "other": "3", "mine": "not generated"}


def test_nothing_to_change_makes_no_folder(tmp_path: Path) -> None:
    assert write({tmp_path / "out": {}}) == []
    assert tree(tmp_path) == {}


@pytest.mark.parametrize("name", ["../escape", "a/../../escape", "/escape", "", ".", "..", "a\\..\\..\\escape"])
def test_no_path_leads_out(tmp_path: Path, name: str) -> None:
    with pytest.raises(OutputError, match="no path inside"):
        write({tmp_path / "out": {"fine": "1", name: "2"}})
    assert tree(tmp_path) == {}


def test_no_link_leads_out(tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "link").symlink_to(tmp_path / "elsewhere")
    before = tree(tmp_path)
    with pytest.raises(OutputError, match="link on the way"):
        write({tmp_path / "out": {"fine": "1", "link/escape": "2"}})
    assert tree(tmp_path) == before


def test_a_link_in_a_files_place_is_replaced_not_followed(tmp_path: Path) -> None:
    (tmp_path / "victim").write_text("mine")
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "file").symlink_to(tmp_path / "victim")
    write({tmp_path / "out": {"file": "generated"}})
    assert tree(tmp_path) == {"victim": "mine", "out": "/", "out/file": "generated"}


def test_a_linked_output_folder_is_fine(tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    (tmp_path / "out").symlink_to("real")
    write({tmp_path / "out": {"a/b": "1"}})
    assert (tmp_path / "real" / "a" / "b").read_text() == "1"


def test_links_in_a_circle(tmp_path: Path) -> None:
    (tmp_path / "one").symlink_to(tmp_path / "two")
    (tmp_path / "two").symlink_to(tmp_path / "one")
    before = tree(tmp_path)
    with pytest.raises(OutputError):
        write({tmp_path / "one": {"a": "1"}})
    assert tree(tmp_path) == before


@pytest.mark.parametrize(
    ("existing", "wanted"),
    [
        pytest.param({"in_the_way": "a file"}, "in_the_way/file", id="a file where a folder is needed"),
        pytest.param({"folder/mine": "1"}, "folder", id="a folder where a file is needed"),
    ],
)
def test_what_is_in_the_way_stays(tmp_path: Path, existing: dict[str, str], wanted: str) -> None:
    write({tmp_path: existing})
    before = tree(tmp_path)
    with pytest.raises(OutputError):
        write({tmp_path: {"first": "1", wanted: "2", "new/last": "3"}})
    assert tree(tmp_path) == before


@pytest.mark.parametrize("failing", range(6))
@pytest.mark.parametrize("fault", [OSError(28, "No space left on device"), KeyboardInterrupt()], ids=repr)
def test_a_failure_at_any_move_undoes_all(
    tmp_path: Path, failing: int, fault: BaseException, monkeypatch: pytest.MonkeyPatch
) -> None:
    write({tmp_path / "out": {"old": "1", "also/old": "2"}})
    os.utime(tmp_path / "out" / "old", (1, 1))
    before = tree(tmp_path)
    moves = 0
    replace = Path.replace

    def replace_until(self: Path, target: Path) -> Path:
        nonlocal moves
        moves += 1
        if moves == failing + 1:
            raise fault
        return replace(self, target)

    monkeypatch.setattr(Path, "replace", replace_until)
    with pytest.raises((OutputError, KeyboardInterrupt)) as raised:
        write({tmp_path / "out": {"old": "3", "also/old": "4", "new/file": "5"}, tmp_path / "copy": {"x": "6"}})
    assert raised.type is KeyboardInterrupt or "No space left on device" in str(raised.value)
    assert tree(tmp_path) == before
    assert (tmp_path / "out" / "old").stat().st_mtime == 1


def test_two_texts_for_one_file(tmp_path: Path) -> None:
    with pytest.raises(OutputError, match="twice"):
        write({tmp_path / "out": {"copy/a": "1"}, tmp_path / "out" / "copy": {"a": "2"}})
    assert tree(tmp_path) == {}
    write({tmp_path / "out": {"copy/a": "1"}, tmp_path / "out" / "copy": {"a": "1"}})
    assert (tmp_path / "out" / "copy" / "a").read_text() == "1"
