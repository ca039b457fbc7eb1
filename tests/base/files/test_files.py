"""Only regular files of a bounded size are read, whatever their names refer to."""

import os
import socket
from pathlib import Path

import pytest

from robosc.base.files import reading as files


def test_a_regular_file_is_read_through_links(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(b"a\r\n\0\xff")
    (tmp_path / "link").symlink_to("file")
    assert files.read(tmp_path / "file") == files.read(str(tmp_path / "link")) == b"a\r\n\0\xff"


@pytest.mark.parametrize("name", ["pipe", "socket", "/dev/zero", "/dev/tty", "folder", "missing", "circle", "nul\0"])
def test_nothing_else_is_read(tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "folder").mkdir()
    (tmp_path / "circle").symlink_to("circle")
    server = socket.socket(socket.AF_UNIX)
    monkeypatch.chdir(tmp_path)  # socket names are limited in length
    server.bind("socket")
    with pytest.raises(OSError) as raised:  # noqa: PT011  # of whatever kind
        files.read(tmp_path / name)
    server.close()
    assert str(raised.value.filename) == str(tmp_path / name)
    assert raised.value.strerror


def test_what_becomes_a_pipe_meanwhile_is_not_waited_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").touch()
    opened = os.open

    def swapped(path: str, flags: int) -> int:
        Path(path).unlink()
        os.mkfifo(path)
        return opened(path, flags)

    monkeypatch.setattr(os, "open", swapped)
    with pytest.raises(OSError, match="this is a pipe; only regular files are read"):
        files.read(tmp_path / "file")


def test_a_file_is_read_up_to_a_size(tmp_path: Path) -> None:
    with (tmp_path / "large").open("wb") as large:
        large.truncate(files.MOST_BYTES)
    assert len(files.read(tmp_path / "large")) == files.MOST_BYTES
    with (tmp_path / "large").open("ab") as large:
        large.write(b"x")
    with pytest.raises(OSError, match="more than 128 MB, the most that is read"):
        files.read(tmp_path / "large")


@pytest.mark.skipif(not Path("/proc/kmsg").exists() or os.geteuid() != 0, reason="root's /proc only")
def test_a_regular_file_that_waits_for_more_is_not_waited_for() -> None:
    with pytest.raises(OSError, match="kmsg"):
        files.read("/proc/kmsg")


def test_inputs_are_noted(tmp_path: Path) -> None:
    for name in ("input", "other"):
        (tmp_path / name).touch()
    with files.record_inputs():
        files.read(tmp_path / "input")
        files.read(tmp_path / "other", is_input=False)
        (tmp_path / "again").hardlink_to(tmp_path / "input")
        assert files.input_name((tmp_path / "again").stat()) == str(tmp_path / "input")
        assert files.input_name((tmp_path / "other").stat()) is None
    assert files.input_name((tmp_path / "input").stat()) is None


def test_only_files_below_folders_are_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("own", "installed", "other"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "file").write_text(name)
    for name in ("own", "installed"):
        (tmp_path / name / "out").symlink_to(tmp_path / "other" / "file")
    (tmp_path / "own" / "around").symlink_to(tmp_path / "own" / "file")
    monkeypatch.chdir(tmp_path)
    with files.read_only_below([Path("own")], [Path("installed")]):
        for name in ("own/file", "own/around", "other/../own/file", "installed/file", "installed/out"):
            assert files.read(name)
        for name in ("other/file", "own/out", "own/../other/file", "installed/../other/file", "/etc/passwd"):
            with pytest.raises(PermissionError, match="outside of the folders that may be read"):
                files.read(name)
    assert files.read("other/file") == b"other"


def test_a_file_that_becomes_a_link_meanwhile_is_not_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "file").touch()
    (tmp_path / "other").write_text("other")
    opened = os.open

    def swapped(path: str, flags: int) -> int:
        Path(path).unlink()
        Path(path).symlink_to(tmp_path / "other")
        return opened(path, flags)

    monkeypatch.setattr(os, "open", swapped)
    with files.read_only_below([tmp_path / "own"], []), pytest.raises(PermissionError):
        files.read(tmp_path / "own" / "file")
