"""CIF's real tools, where `ESCET_HOME` names a folder with them: docs/coming-from-cif.md says what that holds."""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path
from typing import NamedTuple

#: Their classes.
CONTROLLER_CHECK = "org.eclipse.escet.cif.controllercheck.ControllerCheckerApp"
EXPLORER = "org.eclipse.escet.cif.explorer.app.ExplorerApplication"
SYNTHESIS = "org.eclipse.escet.cif.datasynth.CifDataSynthesisApp"
TRANSFORMER = "org.eclipse.escet.cif.cif2cif.app.CifToCifApp"
_COUNT = re.compile(r"Controlled system: exactly ([\d,.\u00a0]+) states?\.")
_CALLED = re.compile(r"called: (\d+) (\d+) (\d+)\n")


def home() -> Path | None:
    """The folder with CIF's tools."""
    folder = os.environ.get("ESCET_HOME")
    return Path(folder) if folder else None


def class_path(folder: Path) -> str:
    """Where Java finds the classes: in `classes`, and in the jars of the folder, of `lib` and of `plugins`."""
    jars = [str(jar) for inner in (".", "lib", "plugins") for jar in sorted((folder / inner).glob("*.jar"))]
    return os.pathsep.join([str(folder / "classes"), *jars])


class Call(NamedTuple):
    """What a call of a tool said, its exit status, and how long it took in a Java that was running.

    `processor` are the seconds of the processor that the tool's thread took, without what Java does beside it.
    """

    status: int
    output: str
    seconds: float
    processor: float


class Counted(NamedTuple):
    """What synthesis found: None where it refused, or has no number."""

    states: int | None
    call: Call


class Tools:
    """CIF's tools in one running Java. Ends with the context."""

    def __init__(self, folder: Path) -> None:
        command = ["java", "-Xmx3g", "-cp", class_path(folder), str(Path(__file__).with_name("Calls.java"))]
        self._java = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )

    def __enter__(self) -> Tools:
        return self

    def __exit__(self, *_: object) -> None:
        self._java.communicate()

    def call(self, tool: str, *arguments: str) -> Call:
        """Calls a tool."""
        assert self._java.stdin is not None
        assert self._java.stdout is not None
        # Of a display that it can't open, a tool waits for ever the second time.
        self._java.stdin.write("\t".join([tool, *arguments, "--gui=off"]) + "\n")
        self._java.stdin.flush()
        lines: list[str] = []
        for line in self._java.stdout:
            called = _CALLED.fullmatch(line)
            if called is not None:
                return Call(int(called[1]), "".join(lines), int(called[2]) / 1000, int(called[3]) / 1000)
            lines.append(line)
        raise AssertionError(f"Java ended: {''.join(lines)[-2000:]}")

    def is_valid(self, path: Path) -> Call:
        """Whether a specification has no fault in its syntax and its types: the exit status is 0 then."""
        return self.call(TRANSFORMER, str(path), "-t", "elim-comp-def-inst", "-o", str(path.with_suffix(".flat.cif")))

    def synthesize(self, path: Path) -> Counted:
        """How many states the supervisor leaves, 0 where there is none."""
        output = path.with_suffix(".out.cif")
        options = ["--bdd-output=nodes", "--forward-reach=yes", "--stats=ctrl-sys-states", "-o", str(output)]
        call = self.call(SYNTHESIS, str(path), *options)
        if "Empty supervisor" in call.output:
            return Counted(0, call)
        found = _COUNT.search(call.output)
        return Counted(None if found is None else int(re.sub(r"\D", "", found[1])), call)
