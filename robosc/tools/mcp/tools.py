"""The tools: each calls the functions of a command."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, Any

from robosc.analysis.explain import data_of, emptiness, explore
from robosc.analysis.supervise import supervise
from robosc.analysis.verify import Outcome, verify
from robosc.analysis.verify.verdict import as_json
from robosc.base.diagnostics.rules import page, rules
from robosc.base.files.suffixes import MODELS
from robosc.base.files.writing import write_file
from robosc.language.text import Documents
from robosc.run.simulation import Simulation
from robosc.run.simulation.session import trace_line
from robosc.synthesis.memory import limit_memory
from robosc.tools.cli import EMPTY_SUPERVISOR, ERRORS_FOUND, CallError
from robosc.tools.cli.check import mended
from robosc.tools.cli.explain import position, question
from robosc.tools.cli.new import create
from robosc.tools.cli.options import Paths
from robosc.tools.cli.parameters import set_parameters
from robosc.tools.cli.reading import read, read_configuration, read_models, supervise_models
from robosc.tools.cli.report import attempt
from robosc.tools.cli.simulate import loop_settings, play
from robosc.tools.cli.synthesize import as_object, count_states
from robosc.tools.cli.test import Call, Run, as_objects, play_all
from robosc.tools.mcp.catalog import TOOLS
from robosc.tools.mcp.folders import Folders
from robosc.tools.mcp.pages import OVERVIEW, all_pages
from robosc.tools.mcp.search import excerpt, search
from robosc.tools.starter import Choices
from robosc.tools.starter.guard import GuardChoices

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.m2t.models import Models
    from robosc.tools.cli.report import Report

    Arguments = Mapping[str, Any]

#: Paths of texts without a file. Their folder does not exist, so that it has no configuration.
_MODEL = "<text>/model.rscd"
_SCENARIOS = "<text>/test.scenarios"
_SCRIPT = "<text>/script"


@dataclass(frozen=True)
class _Source:
    """The model of a call: its path, its search folders, and its text in place of the file."""

    path: str
    paths: Paths
    documents: Documents

    def models(self, report: Report, memory: int, *, cif: bool = True) -> Models:
        """Return the models of the robot. Ends the report if there are errors. `memory` is in bytes."""
        with limit_memory(memory, "reading the model"):
            return read_models(self.path, self.paths, report, cif=cif, documents=self.documents)


class Calls:
    """Executes calls of tools for one client."""

    def __init__(
        self, folders: Sequence[str], libraries: Sequence[str], interfaces: Sequence[str], memory: int
    ) -> None:
        """Take the fields of `robosc.tools.mcp.server.Settings`."""
        self._folders = Folders(folders)
        self._libraries = [str(Path(folder).resolve()) for folder in libraries]
        self._interfaces = [str(Path(folder).resolve()) for folder in interfaces]
        self._memory = memory
        # Relative paths in calls and findings start here.
        os.chdir(self._folders.roots[0])

    def answer(self, name: str, arguments: Arguments) -> dict[str, Any]:
        """Return the answer of a tool to arguments that fit its schema."""
        result: dict[str, Any] = {}
        tool: Callable[[Arguments, Report], tuple[int, dict[str, Any]]] = getattr(self, f"_{name}")

        def work(report: Report) -> int:
            with self._folders.guarded(self._libraries, self._interfaces):
                status, answer = tool(arguments, report)
            result.update(answer)
            return status

        status, error, findings = attempt(work)
        if "exit_status" not in TOOLS[name].output["required"] and not status:
            return result
        return {"exit_status": status, "error": error, "findings": findings, "result": result}

    # Arguments

    def _source(self, arguments: Arguments) -> _Source:
        path, text = arguments.get("path"), arguments.get("text")
        if path is None and text is None:
            raise CallError("name a file with `path`, or give the model itself with `text`")
        if path is not None and text is None:
            self._folders.file(path, MODELS)
        else:
            self._folders.inside(path or _MODEL, (".rscd",))
        beside = [] if path else [str(self._folders.roots[0])]
        libraries = [*beside, *self._named_folders(arguments, "library_paths"), *self._libraries]
        interfaces = [*self._named_folders(arguments, "interface_paths"), *self._interfaces]
        texts = {_SCENARIOS: arguments.get("scenarios_text", "")} | ({} if text is None else {path or _MODEL: text})
        return _Source(path or _MODEL, Paths(libraries, interfaces), Documents(texts))

    def _named_folders(self, arguments: Arguments, name: str) -> list[str]:
        folders = [self._folders.inside(folder) for folder in arguments.get(name, ())]
        missing = next((folder for folder in folders if not Path(folder).is_dir()), None)
        if missing is not None:
            raise CallError(f"`{name}`: there is no folder {missing}")
        return folders

    def _config(self, arguments: Arguments) -> str | None:
        chosen: str | None = arguments.get("config")
        return chosen if chosen is None else self._folders.file(chosen, (".json",))

    # Tools: each returns the exit status without errors, and its result

    def _check(self, arguments: Arguments, report: Report) -> tuple[int, dict[str, Any]]:
        source = self._source(arguments)
        with limit_memory(self._memory, "the check"):
            read(source.path, source.paths, report, source.documents)
        return 0, {}

    def _fix(self, arguments: Arguments, report: Report) -> tuple[int, dict[str, Any]]:
        source = self._source(arguments)
        if not source.path.endswith(".rscd"):
            raise CallError(f"{source.path} is not a .rscd file: `fix` edits only text")
        is_written = "text" not in arguments
        with limit_memory(self._memory, "the repair"):
            text, count = mended(source.path, source.documents.read(Path(source.path), is_input=False), source.paths)
        if is_written and count:
            write_file(source.path, text)
        documents = source.documents if is_written else Documents({source.path: text})
        with limit_memory(self._memory, "the check"):
            read(source.path, source.paths, report, documents)
        return 0, {"edits": count, "text": text}

    def _synthesize(self, arguments: Arguments, report: Report) -> tuple[int, dict[str, Any]]:
        model = self._source(arguments).models(report, self._memory).sct
        if arguments.get("counts"):
            counted, answer = count_states(model, self._memory)
            return (0 if counted.controlled_states else EMPTY_SUPERVISOR), answer
        supervision = supervise(model, memory=self._memory, weigh=True)
        report.add(supervision.findings)
        return 0, as_object(model, supervision.synthesis)

    def _explain(self, arguments: Arguments, report: Report) -> tuple[int, dict[str, Any]]:
        event, never, empty = (arguments.get(name) for name in ("event", "why_never", "why_empty"))
        if [event is not None, never is not None, bool(empty)].count(True) != 1:
            raise CallError("give one of `event`, `why_never` and `why_empty`")
        state = arguments.get("state")
        if state is not None and event is None:
            raise CallError("`state` needs `event`")
        model = self._source(arguments).models(report, self._memory).sct
        answer = explore(model, emptiness if empty else question(model, event, state, never), self._memory)
        if answer is None and not empty:
            supervise(model, memory=self._memory)  # raises with the cause
        return 0, data_of(answer, position)

    def _verify(self, arguments: Arguments, report: Report) -> tuple[int, dict[str, Any]]:
        source = self._source(arguments)
        models = source.models(report, self._memory)
        settings = read_configuration(source.path, self._config(arguments), report)
        supervise_models(models, report, memory=self._memory)
        verdicts = verify(models, settings)
        report.add(finding for verdict in verdicts for finding in verdict.findings)
        is_refuted = any(verdict.outcome is Outcome.REFUTED for verdict in verdicts)
        return (ERRORS_FOUND if is_refuted else 0), json.loads(as_json(models.sct.name, verdicts))

    def _simulate(self, arguments: Arguments, report: Report) -> tuple[int, dict[str, Any]]:
        script, number, is_loop = (arguments.get(name) for name in ("script", "random", "loop"))
        if (script is None) == (number is None):
            raise CallError("give one of `script` and `random`")
        if is_loop and script is None:
            raise CallError("`loop` needs a `script`")
        source = self._source(arguments)
        models = source.models(report, self._memory, cif=not is_loop)
        values = arguments.get("parameters", {}).items()
        texts = [f"{name}={value if isinstance(value, str) else json.dumps(value)}" for name, value in values]
        set_parameters(models.rosgraph, texts)
        chosen = self._config(arguments)
        settings = loop_settings(read_configuration(source.path, chosen, report)) if is_loop else None
        supervise_models(models, report, memory=self._memory)
        if script is not None:
            return 0, {"lines": list(play(models, _SCRIPT, script.encode(), settings, report))}
        simulation = Simulation(models.sct, models.rosgraph, models.ros_types)
        random = Random(arguments.get("seed", 0))  # noqa: S311
        while len(simulation.trace) < (number or 0) and simulation.random_step(random) is not None:
            pass
        return 0, {"lines": [json.loads(trace_line(event)) for event in simulation.trace]}

    def _test(self, arguments: Arguments, report: Report) -> tuple[int, dict[str, Any]]:
        source = self._source(arguments)
        if not source.path.endswith(".rscd"):
            raise CallError(f"{source.path} is not a text file: scenarios need a robot in a .rscd file")
        scenarios = [self._folders.file(name, (".scenarios",)) for name in arguments.get("scenarios", ())]
        scenarios += [_SCENARIOS] if "scenarios_text" in arguments else []
        if not scenarios:
            raise CallError("name files with `scenarios`, or give the scenarios themselves with `scenarios_text`")
        chosen = self._config(arguments)
        runs: list[Run] = []
        call = Call(source.path, scenarios, chosen=chosen, paths=source.paths, documents=source.documents)
        play_all(call, report, runs)
        return 0, {"scenarios": as_objects(runs)}

    def _rule(self, arguments: Arguments, _report: Report) -> tuple[int, dict[str, Any]]:
        name = arguments.get("name")
        if name is None:
            return 0, {"page": None, "rules": list(rules())}
        text = page(name)
        if text is None:
            close = get_close_matches(name, rules(), n=1)
            hint = f"did you mean `{close[0]}`?" if close else "`rule` without a name lists all rules"
            raise CallError(f"there is no rule `{name}`; {hint}")
        return 0, {"page": text, "rules": [name]}

    def _new(self, arguments: Arguments, _report: Report) -> tuple[int, dict[str, Any]]:
        choices = _choices(arguments)
        fault = choices.fault()
        if fault is not None:
            raise CallError(fault)
        folder = self._folders.inside(arguments.get("folder", choices.stem))
        return 0, {"folder": folder, "files": create(choices, Path(folder))}

    def _search_docs(self, arguments: Arguments, _report: Report) -> tuple[int, dict[str, Any]]:
        if not any(page.name == OVERVIEW for page in all_pages()):
            raise CallError("the documentation is missing from this installation of robosc: install its wheel again")
        query = arguments["query"]
        return 0, {
            "results": [
                {
                    "uri": section.page.uri,
                    "page": section.page.title,
                    "heading": section.heading,
                    "excerpt": excerpt(section, query),
                }
                for section in search(query, arguments.get("most", 5))
            ]
        }


#: Arguments of `new` for a controller, and for a guard.
_OF_CONTROLLERS = ("ros", "sensors", "command", "stop", "service", "twist")
_OF_GUARDS = ("topics", "services", "actions", "button", "pose")


def _choices(arguments: Arguments) -> Choices | GuardChoices:
    """Return the choices for a new model. Raises CallError for an argument of the other kind of model."""
    own, others = (_OF_GUARDS, _OF_CONTROLLERS) if arguments.get("guard") else (_OF_CONTROLLERS, _OF_GUARDS)
    wrong = next((name for name in others if arguments.get(name)), None)
    if wrong is not None:
        meaning = "has no meaning for a guard" if own is _OF_GUARDS else "needs `guard`"
        raise CallError(f"`{wrong}` {meaning}")
    chosen: dict[str, Any] = {
        name: tuple(arguments[name]) if isinstance(arguments[name], list) else arguments[name]
        for name in own
        if arguments.get(name)
    }
    if own is _OF_GUARDS:
        return GuardChoices(arguments["name"], **chosen)
    chosen |= {name: None for name in ("stop", "service") if chosen.get(name) == "-"}
    return Choices(arguments["name"], **chosen)
