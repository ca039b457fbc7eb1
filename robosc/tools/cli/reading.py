"""Reading of the MODEL argument of commands."""

from __future__ import annotations

from pathlib import Path, PurePath
from typing import TYPE_CHECKING

import robosc
from robosc.base.files.suffixes import AUTOMATA
from robosc.base.ros_types import RosTypes
from robosc.language.checks import check
from robosc.language.libraries import search_folders
from robosc.language.reading import read as read_text
from robosc.m2t.models import Models
from robosc.model import engine, rosgraph, sct
from robosc.model import robosc as rsc
from robosc.tools.cli import CallError, say
from robosc.tools.cli.options import chosen_synthesizer

if TYPE_CHECKING:
    from robosc.language.configuration import Configuration
    from robosc.language.text import Documents
    from robosc.synthesis import Synthesis, Tuning
    from robosc.tools.cli.options import Paths
    from robosc.tools.cli.report import Report

    Root = rsc.Base | sct.SupervisoryControlModel | rosgraph.RosGraph


def read(path: str, paths: Paths, report: Report, documents: Documents | None = None) -> Root | None:
    """Return the model in a file of any kind. All findings of reading and of the rules go to the report.

    `documents` are texts that replace `.rscd` files.

    None if the file is too damaged to contain a model. Raises ModelError for an XMI file with faults.
    """
    interfaces = RosTypes(paths.interfaces)

    def locate(name: str) -> str | None:
        # The author of a saved model chose the names of its source texts. They are searched only in a few folders.
        folders = [Path(path).parent, *search_folders(paths.libraries)]
        file_text = next((text for folder in folders if (text := _text_below(folder, name))), None)
        if file_text is not None:
            report.may_quote(file_text)
        return file_text

    if path.endswith(".xmi"):
        from robosc.model import validity

        texts: dict[str, str] = {}
        try:
            root: Root | engine.EngineModel | None = validity.load(path, texts, locate)
        finally:
            report.add((), texts)
        if isinstance(root, engine.EngineModel):
            root = root.model  # the engine model is derived from it
        findings = []
    elif path.endswith(".cif"):
        from robosc.language.cif import read as read_cif

        specification = read_cif(path)
        root, findings = specification.model, specification.findings
        report.add(findings, specification.texts)
    elif path.endswith(AUTOMATA):
        from robosc.language.des import read as read_automata

        specification = read_automata(path)
        root, findings = specification.model, specification.findings
        report.add(findings, specification.texts)
    else:
        reading = read_text(path, paths.libraries, interfaces, documents)
        root, findings = reading.base, reading.findings
        report.add(findings, reading.texts)
    if isinstance(root, rsc.Base):
        report.add(check(root, findings, interfaces))
    return root


def _text_below(folder: Path, name: str) -> str | None:
    """Return the path of a `.rscd` file with that relative name in a folder or below. None if there is none."""
    relative = PurePath(name)
    if relative.is_absolute() or ".." in relative.parts:
        return None
    path = folder / relative
    try:
        real = path.resolve(strict=True)
        is_text = real.suffix == ".rscd" and real.is_file() and real.is_relative_to(folder.resolve())
    except (OSError, ValueError, RuntimeError):  # a null character, or circular links
        return None
    return str(path) if is_text else None


def read_configuration(model: str, chosen: str | None, report: Report) -> Configuration:
    """Return the configuration in the chosen file, else in the one near the model. Findings may quote the file.

    Raises ModelError and OSError as `robosc.language.configuration` does.
    """
    from robosc.language import configuration as config  # loads pydantic

    file = Path(chosen) if chosen else config.find(Path(model).parent)
    if file is None:
        return config.Configuration()
    if not chosen and file.parent != Path(model).parent:
        say(f"the configuration is {file}; choose another one with --config", err=True)
    report.may_quote(str(file))
    return config.read(file)


def read_models(
    path: str, paths: Paths, report: Report, *, cif: bool = False, documents: Documents | None = None
) -> Models:
    """Return the models of the robot in a file: the sct model in it, or created from it, and all others.

    `documents` are texts that replace `.rscd` files.

    Ends the report if there are errors. Raises CallError for a library, and for CIF if the call does not support it.
    """
    if path.endswith((".cif", *AUTOMATA)) and not cif:
        what = "CIF" if path.endswith(".cif") else "a file of automata"
        raise CallError(
            f"{path} is {what}, which has no ROS graph and no control loop: `check`, `synthesize`, `explain`, `verify`,"
            " `simulate`, `diagram` and `transform --to cif,supervisor,xmi` take it"
        )
    root = read(path, paths, report, documents)
    if isinstance(root, rsc.Library):
        raise CallError(f"{path} has a library: only a robot that imports it has a supervisor")
    report.stop_on_errors()
    if isinstance(root, rsc.Robot):
        types = RosTypes(paths.interfaces)
        return Models(robosc.to_sct(root), robosc.to_rosgraph(root, paths.interfaces), root, types)
    if isinstance(root, rosgraph.RosGraph):
        return Models(root.model, root, ros_types=RosTypes(paths.interfaces))
    assert isinstance(root, sct.SupervisoryControlModel)
    return Models(root)


def supervise_models(
    models: Models, report: Report, *, memory: int | None = None, tuning: Tuning | None = None
) -> None:
    """Synthesize the supervisor of the sct model, unless it has one. Warnings about it go to the report.

    The default of `tuning` is that of the call.

    With another synthesizer in the call, its supervisor also replaces an existing one. `memory` limits the memory of
    the process in bytes; the default is that of synthesis. Ends the report if there are errors. Raises
    EmptySupervisorError if there is no supervisor.
    """
    from robosc.analysis.supervise import supervise
    from robosc.synthesis import MEMORY
    from robosc.tools.cli.progress import show_progress
    from robosc.tools.cli.tuning import chosen_tuning

    if supervise_otherwise(models.sct, memory=memory) is None and models.sct.supervisor is None:
        with show_progress(models.sct) as statistics:
            supervision = supervise(
                models.sct, memory=memory or MEMORY, statistics=statistics, tuning=tuning or chosen_tuning(models.sct)
            )
        report.add(supervision.findings)
        report.stop_on_errors()


def supervise_otherwise(model: sct.SupervisoryControlModel, *, memory: int | None = None) -> Synthesis | None:
    """Set the supervisor of the model by the synthesizer in the call.

    Returns None, and leaves the model unchanged, if the call names none. `memory` and errors are those of
    `robosc.analysis.other_synthesizers.supervise_by`.
    """
    chosen = chosen_synthesizer()
    if chosen is None:
        return None
    from robosc.analysis.other_synthesizers import supervise_by
    from robosc.synthesis import MEMORY
    from robosc.tools.cli.progress import progress

    with progress(f"synthesizing by {chosen.name}"):
        return supervise_by(chosen, model, memory=memory or MEMORY)
