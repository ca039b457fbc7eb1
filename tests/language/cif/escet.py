"""CIF's real tools, if `ESCET_HOME` names a folder with them: benchmarks/escet.md describes it."""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path
from typing import NamedTuple

#: The Java classes of the tools.
CONTROLLER_CHECK = "org.eclipse.escet.cif.controllercheck.ControllerCheckerApp"
EXPLORER = "org.eclipse.escet.cif.explorer.app.ExplorerApplication"
SYNTHESIS = "org.eclipse.escet.cif.datasynth.CifDataSynthesisApp"
TO_SUPREMICA = "org.eclipse.escet.cif.cif2supremica.CifToSupremicaApp"
TRANSFORMER = "org.eclipse.escet.cif.cif2cif.app.CifToCifApp"
_EXPLORED = re.compile(r"Number of states in state space: ([\d,.\u00a0]+)\.\n.*: ([\d,.\u00a0]+)\.", re.DOTALL)
_INPUT = re.compile(r"^(\s*)input ([^;]+?) (\$?\w+(?:, *\$?\w+)*);", re.MULTILINE)
_ENUMERATION = re.compile(r"^\s*enum (\w+) =([^;]*);", re.MULTILINE)
_RANGE = re.compile(r"int\[(\d+)\.\.(\d+)\]")
_COUNT = re.compile(r"Controlled system: exactly ([\d,.\u00a0]+) states?\.")
_CALLED = re.compile(r"called: (\d+) (\d+) (\d+)\n")


def home() -> Path | None:
    """Return the folder with CIF's tools."""
    folder = os.environ.get("ESCET_HOME")
    return Path(folder) if folder else None


def class_path(folder: Path) -> str:
    """Return Java's class path: `classes`, and the jars of the folder, of `lib` and of `plugins`."""
    jars = [str(jar) for inner in (".", "lib", "plugins") for jar in sorted((folder / inner).glob("*.jar"))]
    return os.pathsep.join([str(folder / "classes"), *jars])


class Call(NamedTuple):
    """Exit status, output and duration of one tool call in a running Java.

    `processor` is the CPU time of the tool's thread in seconds, without Java's own threads.
    """

    status: int
    output: str
    seconds: float
    processor: float


class Counted(NamedTuple):
    """The number of controlled states, or None if synthesis refused or reports no number."""

    states: int | None
    call: Call


class Explored(NamedTuple):
    """The states and edges that the explorer reaches, or None if it ends in an error."""

    size: tuple[int, int] | None
    call: Call


def without_inputs(text: str) -> str:
    """Replace each input by an automaton, since the explorer does not support inputs.

    As in CIF's synthesis, an input has any initial value and can change to any other value at any time. Raises KeyError
    for an input whose type is neither an integer range nor an enumeration at the specification's top level.
    """
    literals = {name: [part.strip() for part in parts.split(",")] for name, parts in _ENUMERATION.findall(text)}
    automata: list[str] = []

    def moved(found: re.Match[str]) -> str:
        indent, kind, names = found.groups()
        numbers = _RANGE.fullmatch(kind)
        literals["bool"] = ["true", "false"]
        values = [*map(str, range(int(numbers[1]), int(numbers[2]) + 1))] if numbers else literals[kind]
        equations = []
        for name in names.split(","):
            own = f"input_{len(automata)}"
            edges = " ".join(f"edge change when held != {value} do held := {value};" for value in values)
            automata.append(
                f"plant {own}: uncontrollable change; disc {kind} held in any; location: initial; marked; {edges} end\n"
            )
            equations.append(f"alg {kind} {name.strip()} = ^{own}.held;")
        return indent + " ".join(equations)

    return _INPUT.sub(moved, text) + "\n" + "".join(automata)


class Tools:
    """CIF's tools in one running Java. The process ends with the context."""

    def __init__(self, folder: Path, crashes: Path | None = None) -> None:
        """`crashes` is the folder for crash reports. Default: the working directory."""
        command = ["java", "-Xmx3g", "-cp", class_path(folder), str(Path(__file__).with_name("Calls.java"))]
        self._java = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=crashes
        )

    def __enter__(self) -> Tools:
        return self

    def __exit__(self, *_: object) -> None:
        self._java.communicate()

    def call(self, tool: str, *arguments: str) -> Call:
        """Call a tool."""
        assert self._java.stdin is not None
        assert self._java.stdout is not None
        # A tool that cannot open a display blocks forever on the second attempt.
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
        """Check the syntax and types of a specification: the exit status is 0 if they are valid."""
        return self.call(TRANSFORMER, str(path), "-t", "elim-comp-def-inst", "-o", str(path.with_suffix(".flat.cif")))

    def synthesize(self, path: Path) -> Counted:
        """Return the number of states under the supervisor; 0 if there is none."""
        output = path.with_suffix(".out.cif")
        options = ["--bdd-output=nodes", "--forward-reach=yes", "--stats=ctrl-sys-states", "-o", str(output)]
        call = self.call(SYNTHESIS, str(path), *options)
        if "Empty supervisor" in call.output:
            return Counted(0, call)
        found = _COUNT.search(call.output)
        return Counted(None if found is None else int(re.sub(r"\D", "", found[1])), call)

    def explore(self, path: Path) -> Explored:
        """Count the states and edges that CIF's simulator reaches: an overflow is an error."""
        call = self.call(EXPLORER, str(path), "--enable-cif=no")
        found = _EXPLORED.search(call.output)
        if call.status != 0 or found is None:
            return Explored(None, call)
        states, edges = (int(re.sub(r"\D", "", number)) for number in found.groups())
        return Explored((states, edges), call)

    def supervised(self, path: Path) -> Explored:
        """Count the states and edges of a specification under the supervisor of CIF's own synthesis."""
        output = path.with_suffix(".own.cif")
        call = self.call(SYNTHESIS, str(path), "--forward-reach=yes", "-o", str(output))
        return Explored(None, call) if call.status != 0 else self.explore(output)
