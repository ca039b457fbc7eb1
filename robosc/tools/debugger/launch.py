"""The launch request: the model, and the script or counterexample to play with it."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from robosc.run.simulation.sources import counterexample_of, script_steps

if TYPE_CHECKING:
    from robosc.base.diagnostics import Diagnostic
    from robosc.m2t.models import Models
    from robosc.run.simulation import ScriptStep, Simulation

#: Default number of random events after which a run stops by itself.
_MOST_AT_RANDOM = 10_000
#: Keys of a `launch` configuration with types and descriptions; editors add keys of their own.
_KEYS: Mapping[str, tuple[Any, str]] = {
    "program": (str, "the path of a model"),
    "script": (str, "the path of a script or event log"),
    "counterexample": (str | bool, "a property of `robosc verify`, or true"),
    "seed": (int, "a whole number"),
    "most": (int, "a whole number"),
    "libraries": (list, "a list of folders"),
    "interfaces": (list, "a list of folders"),
    "parameters": (dict, "an object from name to value"),
    "stopOnEntry": (bool, "true or false"),
}


class RequestError(Exception):
    """A request that cannot be answered: the message explains why, and how to correct it."""


@dataclass(frozen=True)
class LaunchTarget:
    """The model to launch, its folders for libraries and ROS definitions, and the values of its parameters."""

    program: str
    libraries: tuple[str, ...] = ()
    interfaces: tuple[str, ...] = ()
    parameters: Mapping[str, Any] = field(default_factory=dict)


#: Loads a model with its supervisor, its findings such as warnings, and the texts of its files. Raises PlayError.
Loader = Callable[[LaunchTarget], tuple["Models", "Sequence[Diagnostic]", Mapping[str, str]]]


@dataclass(frozen=True)
class Launch:
    """The arguments of a launch; `most` is the number of random events after which the run stops."""

    target: LaunchTarget
    script: str | None
    counterexample: str | bool | None
    seed: int
    most: int
    stop_on_entry: bool

    @classmethod
    def of(cls, arguments: Mapping[str, Any]) -> Launch:
        """Return the launch of a request's arguments. Raises RequestError."""
        for name, (kind, expected) in _KEYS.items():
            value = arguments.get(name)
            if value is not None and (not isinstance(value, kind) or (isinstance(value, bool) and kind is int)):
                raise RequestError(f"launch: `{name}` is {json.dumps(value)}, expected {expected}")
            paths = value if isinstance(value, list) else [value]
            if any("\0" in path for path in paths if isinstance(path, str)):
                raise RequestError(f"launch: `{name}` has a null character: no path has one")
        if not arguments.get("program"):
            raise RequestError("launch: `program` names the model")
        script, counterexample = arguments.get("script") or None, arguments.get("counterexample") or None
        if script and counterexample:
            raise RequestError("launch: `script` and `counterexample` exclude each other")
        libraries, interfaces = (tuple(map(str, arguments.get(name) or ())) for name in ("libraries", "interfaces"))
        return cls(
            LaunchTarget(arguments["program"], libraries, interfaces, arguments.get("parameters") or {}),
            script,
            counterexample,
            arguments.get("seed") or 0,
            max(arguments.get("most") or _MOST_AT_RANDOM, 1),
            arguments.get("stopOnEntry") is not False,
        )

    def steps(self, simulation: Simulation) -> tuple[list[ScriptStep] | None, str]:
        """Return the steps to play (None to play random events), and a message about them.

        Raises PlayError, and OSError if the script cannot be read.
        """
        if self.script is not None:
            return script_steps(simulation, self.script), ""
        if self.counterexample is not None:
            name = self.counterexample if isinstance(self.counterexample, str) else None
            refutation = counterexample_of(simulation, name)
            return refutation.steps, f"{refutation.property}: {refutation.explanation}\n"
        return None, ""
