"""Output is all or nothing, changes only files that differ, and stays inside its folder."""

import fcntl
import os
import signal
import stat
import tempfile
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from threading import Timer
from typing import Any

import pytest

from robosc.base.files import reading as files
from robosc.base.files import writing as output
from robosc.base.files.writing import OutputError, open_log, temporary_folder, write, write_file
from tests.interruptions import interrupted, interruptions


def tree(folder: Path) -> dict[str, str]:
    """Return all paths below a folder: links with their targets, folders with a slash, files with their text."""
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
    with pytest.raises(OutputError, match="is not a path inside"):
        write({tmp_path / "out": {"fine": "1", name: "2"}})
    assert tree(tmp_path) == {}


def test_no_link_leads_out(tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "link").symlink_to(tmp_path / "elsewhere")
    before = tree(tmp_path)
    with pytest.raises(OutputError, match="its path has a link"):
        write({tmp_path / "out": {"fine": "1", "link/escape": "2"}})
    assert tree(tmp_path) == before


def test_a_link_in_a_files_place_is_neither_replaced_nor_followed(tmp_path: Path) -> None:
    (tmp_path / "victim").write_text("mine")
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "file").symlink_to(tmp_path / "victim")
    before = tree(tmp_path)
    with pytest.raises(OutputError, match="file is a link: only a regular file can be replaced"):
        write({tmp_path / "out": {"file": "generated", "other": "1"}})
    assert tree(tmp_path) == before


@pytest.mark.parametrize("device", [False, True], ids=["pipe", "device"])
def test_pipes_and_devices_are_not_replaced(tmp_path: Path, device: bool) -> None:
    if device and os.geteuid() != 0:
        pytest.skip("only root makes devices")
    os.mknod(tmp_path / "file", (stat.S_IFCHR if device else stat.S_IFIFO) | 0o600, os.makedev(1, 3))
    with pytest.raises(OutputError, match=f"file is a {'device' if device else 'pipe'}: only a regular file"):
        write({tmp_path: {"first": "1", "file": "2"}})
    assert list(tmp_path.iterdir()) == [tmp_path / "file"]
    assert not (tmp_path / "file").is_file()


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


OLD = {"out": {"old": "1", "also/old": "2"}}
NEW = {"out": {"old": "3", "also/old": "4", "new/file": "5"}, "copy": {"x": "6"}}
ALL_NEW = {f"{folder}/{name}": text for folder, files in NEW.items() for name, text in files.items()}


def below(folder: Path, trees: Mapping[str, Mapping[str, str]]) -> dict[Path, Mapping[str, str]]:
    return {folder / name: files for name, files in trees.items()}


def texts(folder: Path) -> dict[str, str]:
    """Return the files below a folder, hidden ones included."""
    return {name: text for name, text in tree(folder).items() if text != "/"}


@pytest.mark.parametrize("change", ["mkdir", "unlink", "rmdir"])
@pytest.mark.parametrize("failing", range(1, 8))
@pytest.mark.parametrize("fault", [OSError(28, "No space left on device"), KeyboardInterrupt()], ids=repr)
def test_a_failure_before_the_first_move_changes_nothing(
    tmp_path: Path, change: str, failing: int, fault: BaseException, monkeypatch: pytest.MonkeyPatch
) -> None:
    write(below(tmp_path, OLD))
    before = tree(tmp_path)
    done = 0
    real = getattr(os, change)

    def failing_once(*arguments: Any, **options: Any) -> Any:
        nonlocal done
        done += 1
        if done == failing:
            raise fault
        return real(*arguments, **options)

    monkeypatch.setattr(os, change, failing_once)
    error: BaseException | None = None
    try:
        write(below(tmp_path, NEW))
    except (OutputError, KeyboardInterrupt) as raised:
        error = raised
    monkeypatch.undo()
    left = [name for name in tree(tmp_path) if ".robosc-" in name]
    assert left == [] or change in ("unlink", "rmdir")
    if tree(tmp_path)["out/old"] == "1":
        assert error is not None
        assert {name: text for name, text in tree(tmp_path).items() if name not in left} == before
    else:
        assert {name: text for name, text in texts(tmp_path).items() if name not in left} == ALL_NEW


@pytest.mark.parametrize("failing", range(1, 5))
def test_after_a_move_that_fails_each_file_is_whole(
    tmp_path: Path, failing: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    write(below(tmp_path, OLD))
    done = 0
    replace = os.replace

    def failing_from_then_on(*arguments: Any) -> None:
        nonlocal done
        done += 1
        if done >= failing:
            raise OSError(5, "Input/output error")
        replace(*arguments)

    monkeypatch.setattr(os, "replace", failing_from_then_on)
    with pytest.raises(OutputError, match="Input/output error"):
        write(below(tmp_path, NEW))
    monkeypatch.undo()
    assert texts(tmp_path)["out/old"] in ("1", "3")
    write(below(tmp_path, NEW))
    assert texts(tmp_path) == ALL_NEW


@pytest.mark.slow
@pytest.mark.parametrize("again", [False, True], ids=["once", "again and again"])
@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT])
def test_a_signal_at_any_change_leaves_all_or_nothing(tmp_path: Path, sent: signal.Signals, again: bool) -> None:
    def run(number: int) -> int:
        write(below(tmp_path / str(number), OLD))
        return interrupted(lambda: write(below(tmp_path / str(number), NEW)), number, sent, again=again)

    seen = []
    for number, status in interruptions(run):
        assert status == (130 if sent == signal.SIGINT else -sent)
        found = tree(tmp_path / str(number))
        if found["out/old"] == "1":
            assert found == {"out": "/", "out/old": "1", "out/also": "/", "out/also/old": "2"}
        else:
            assert texts(tmp_path / str(number)) == ALL_NEW
        seen.append(found["out/old"])
    assert seen == sorted(seen)
    assert seen.count("1") > 3


@pytest.mark.slow
def test_what_kill_leaves_the_next_run_finishes(tmp_path: Path) -> None:
    def run(number: int) -> int:
        write(below(tmp_path / str(number), OLD))
        return interrupted(lambda: write(below(tmp_path / str(number), NEW)), number, signal.SIGKILL)

    halfway = 0
    for number, status in interruptions(run):
        assert status == -signal.SIGKILL
        home = tmp_path / str(number)
        assert texts(home)["out/old"] in ("1", "3")
        assert texts(home)["out/also/old"] in ("2", "4")
        halfway += texts(home)["out/old"] != {"2": "1", "4": "3"}[texts(home)["out/also/old"]]
        write(below(home, NEW))
        assert texts(home) == ALL_NEW
    assert halfway > 0


def test_nobody_elses_folder_is_removed(tmp_path: Path) -> None:
    for name in (".robosc-abcdefgh/precious", ".robosc-cache/0", ".robosc/0"):
        (tmp_path / name).parent.mkdir()
        (tmp_path / name).write_text("mine")
    before = tree(tmp_path)
    write({tmp_path: {"a": "1"}})
    assert tree(tmp_path) == {**before, "a": "1"}


def test_a_folder_is_waited_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write({tmp_path: {"a": "1"}})
    holder = os.open(tmp_path, os.O_RDONLY)
    fcntl.flock(holder, fcntl.LOCK_EX)
    monkeypatch.setattr(output, "PATIENCE_SECONDS", 0.1)
    with pytest.raises(OutputError, match=f"another run of robosc still writes to {tmp_path}"):
        write({tmp_path: {"a": "2"}, tmp_path.parent: {"b": "2"}})
    assert texts(tmp_path) == {"a": "1"}
    monkeypatch.setattr(output, "PATIENCE_SECONDS", 60)
    Timer(0.2, os.close, (holder,)).start()
    write({tmp_path: {"a": "2"}})
    assert texts(tmp_path) == {"a": "2"}


def test_of_two_runs_into_one_folder_one_comes_after_the_other(tmp_path: Path) -> None:
    def run(text: str) -> int:
        child = os.fork()
        if child:
            return child
        with suppress(BaseException):
            for number in range(10):
                write({tmp_path / "out": {f"{file}": f"{text}{number}" for file in range(20)}})
            os._exit(0)
        os._exit(1)

    assert [os.waitpid(child, 0)[1] for child in (run("a"), run("b"))] == [0, 0]
    left = texts(tmp_path / "out")
    assert len(left) == 20
    assert set(left.values()) in ({"a9"}, {"b9"})


def test_inputs_are_not_written_over(tmp_path: Path) -> None:
    (tmp_path / "model.rscd").write_text("robot R {}")
    (tmp_path / "same.rscd").hardlink_to(tmp_path / "model.rscd")
    (tmp_path / "link.rscd").symlink_to(tmp_path / "model.rscd")
    before = tree(tmp_path)
    with files.record_inputs():
        files.read(tmp_path / "model.rscd")
        for name in ("model.rscd", "same.rscd"):
            with pytest.raises(OutputError, match=f"{name} was read by this call"):
                write({tmp_path: {"other": "1", name: "2"}})
        with pytest.raises(OutputError, match=r"link\.rscd was read by this call, as .*model\.rscd"):
            write_file(tmp_path / "link.rscd", "2")
        write({tmp_path: {"model.rscd": "robot R {}"}})
        with pytest.raises(OSError, match="cannot be the log"):
            open_log(tmp_path / "link.rscd")
    assert tree(tmp_path) == before
    write_file(tmp_path / "link.rscd", "2")
    assert tree(tmp_path) == {**before, "model.rscd": "2"}


def test_a_named_file_may_be_a_device_or_a_pipe(tmp_path: Path) -> None:
    null = Path(os.devnull).stat()
    write_file(os.devnull, "text")
    assert os.path.samestat(null, Path(os.devnull).stat())
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(OutputError, match="pipe: No such device"):  # no process reads the pipe
        write_file(tmp_path / "pipe", "text")
    reader = os.open(tmp_path / "pipe", os.O_RDONLY | os.O_NONBLOCK)
    write_file(tmp_path / "pipe", "text")
    assert os.read(reader, 100) == b"text"
    os.close(reader)
    with pytest.raises(OutputError, match="is a folder"):
        write_file(tmp_path, "text")
    with pytest.raises(OutputError, match="null"):
        write_file("\0", "text")


def test_a_log_is_a_file_or_a_device_or_a_pipe_that_is_read(tmp_path: Path) -> None:
    for _ in "ab":
        with os.fdopen(open_log(tmp_path / "log"), "a") as log:
            log.write("line\n")
    assert (tmp_path / "log").read_text() == "line\nline\n"
    os.close(open_log(os.devnull))
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(OSError, match="No such device"):
        open_log(tmp_path / "pipe")


def test_two_texts_for_one_file(tmp_path: Path) -> None:
    with pytest.raises(OutputError, match="twice"):
        write({tmp_path / "out": {"copy/a": "1"}, tmp_path / "out" / "copy": {"a": "2"}})
    assert tree(tmp_path) == {}
    write({tmp_path / "out": {"copy/a": "1"}, tmp_path / "out" / "copy": {"a": "1"}})
    assert (tmp_path / "out" / "copy" / "a").read_text() == "1"


@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_temporary_folder_is_gone_after_a_signal_at_any_change(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, sent: signal.Signals
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))

    def work() -> None:
        with temporary_folder() as folder:
            (folder / "below").mkdir()
            (folder / "below" / "file").touch()

    def run(number: int) -> int:
        return interrupted(work, number, sent)

    statuses = []
    for _, status in interruptions(run):
        statuses.append(status)
        assert list(tmp_path.iterdir()) == []
    assert len(statuses) == 5  # create two folders, create a file, remove two folders
    assert set(statuses) == {130 if sent == signal.SIGINT else -sent}
    assert list(tmp_path.iterdir()) == []
