"""File of results: a line of JSON for each finished job, appended when the job ends."""

from __future__ import annotations

import errno
import json
import os
import stat
import sys
from typing import TYPE_CHECKING, Any, NamedTuple

from robosc.analysis.system import format_count
from robosc.base.files import reading as files
from robosc.base.files.writing import open_log
from robosc.tools.cli import CallError

if sys.platform != "win32":
    import fcntl

if TYPE_CHECKING:
    from collections.abc import Mapping
    from types import TracebackType
    from typing import Self

#: Exceptions of lines that are no results.
_FAULTS = (ArithmeticError, AttributeError, LookupError, RecursionError, TypeError, ValueError)
#: Maximum exit status of a process.
_MOST = 255
#: Begin of each line.
_BEGIN = b'{"id": "'


class Row(NamedTuple):
    """Result of a job in short: its exit status, its seconds, and its result in words."""

    status: int
    seconds: float
    summary: str


class Results:
    """Results in a file, of this sweep and of earlier ones; without a path, only those of this sweep.

    `by_job` holds the rows by the identity of their job. A half-written last line, of a sweep that was killed, is
    removed. Raises CallError if another process writes to the file, or if it has other content, and OSError.
    """

    def __init__(self, path: str | None) -> None:
        self.by_job: dict[str, Row] = {}
        self._path = path
        self._file = None if path is None else os.fdopen(open_log(path), "wb", buffering=0)
        if path is not None and self._file is not None and stat.S_ISREG(os.fstat(self._file.fileno()).st_mode):
            try:
                self._lock(path)
                self._load(path)
            except BaseException:
                self._file.close()
                raise

    def _lock(self, path: str) -> None:
        assert self._file is not None
        if sys.platform != "win32":
            try:
                fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError as error:
                if error.errno not in {errno.EWOULDBLOCK, errno.EACCES}:
                    raise
                raise CallError(f"{path}: another process writes its results there; choose another file") from error

    def _load(self, path: str) -> None:
        assert self._file is not None
        complete = 0
        with files.open_file(path, is_input=False) as file:
            for number, line in enumerate(file, 1):
                if not line.endswith(b"\n") and (line.startswith(_BEGIN) or _BEGIN.startswith(line)):
                    break
                try:
                    result = json.loads(line)
                    self.by_job[result["id"]] = _row(result)
                except _FAULTS:
                    message = "this line is no result of `robosc sweep`; choose another file for --output"
                    raise CallError(f"{path}:{number}: {message}") from None
                complete += len(line)
        self._file.truncate(complete)

    def add(self, result: dict[str, Any]) -> None:
        """Add the result of a job, and append its line to the file. Raises OSError with the name of the file."""
        self.by_job[result["id"]] = _row(result)
        if self._file is not None:
            line = json.dumps(result).encode() + b"\n"
            try:
                while line:
                    line = line[self._file.write(line) :]
            except OSError as error:
                error.filename = self._path
                raise

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, _type: type[BaseException] | None, _error: BaseException | None, _traceback: TracebackType | None
    ) -> None:
        if self._file is not None:
            self._file.close()


def _row(line: Mapping[str, Any]) -> Row:
    status, seconds = line["exit_status"], line["seconds"]
    if type(status) is not int or not 0 <= status <= _MOST or not isinstance(seconds, int | float):
        raise TypeError(f"{status} or {seconds} is no number of a result")
    return Row(status, float(seconds), _summary(line))


def _summary(line: Mapping[str, Any]) -> str:
    """Return the result of a job in words; of a failed one, its first error."""
    if line["error"]:
        return str(line["error"])
    errors = [finding for finding in line["findings"] if finding["severity"] == "error"]
    if errors:
        return f"{errors[0]['file']}:{errors[0]['line']}: {errors[0]['message']}"
    result = line["result"]
    warnings = format_count(len(line["findings"]), "warning") if line["findings"] else ""
    if result.get("fault"):
        return f"{result['fault']} after {format_count(result['events'], 'event')}"
    parts = []
    if "controlled_states" in result:
        parts = [format_count(result["controlled_states"], "state"), format_count(result["operations"], "operation")]
    elif "properties" in result:
        outcomes = [own["outcome"] for own in result["properties"]]
        refuted = [own["property"] for own in result["properties"] if own["outcome"] == "refuted"]
        counts = [f"{outcomes.count(outcome)} {outcome}" for outcome in dict.fromkeys(outcomes) if outcome != "refuted"]
        parts = [*(f"refuted: {name}" for name in refuted), *counts]
    elif "scenarios" in result:
        parts = [f"{len(result['scenarios'])} passed"]
    elif "events" in result:
        parts = [format_count(result["events"], "event")]
    return ", ".join(filter(None, [*parts, warnings])) or "no findings"
