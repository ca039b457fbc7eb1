"""Automata of other tools for supervisory control as sct models: Supremica, IDES and libFAUDES.

    reading = read("factory.wmod")

A file becomes a `System`, one module for each format. `cif_text` writes the system as CIF, and `robosc.language.cif`
reads that text, so that a file means the same as its CIF. All places are then moved to the file itself.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from os.path import normpath
from pathlib import Path
from typing import TYPE_CHECKING

from robosc.base.diagnostics import ModelError, has_errors, in_order
from robosc.language.cif import CifReading
from robosc.language.cif import read as read_cif
from robosc.language.des import faudes, ides, wmod
from robosc.language.des.automata import FaultError, System
from robosc.language.des.cif_text import lines
from robosc.language.des.files import Source, open_source
from robosc.language.text import Documents
from robosc.model.reflection import tree

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from robosc.model import sct
    from robosc.model.places import Place

#: Readers of files with one automaton.
_AUTOMATON = {".xmd": ides.read, ".gen": faudes.read}
_ROLES = {"plant": False, "requirement": True}


def read(path: Path | str, documents: Documents | None = None) -> CifReading:
    """Read a file and all that it names as an sct model. Raises OSError if the file itself cannot be read.

    Precondition: its suffix is one of `robosc.base.files.suffixes.AUTOMATA`.
    """
    path = Path(path)
    system, texts = _system(path, documents or Documents())
    if has_errors(system.findings):
        return CifReading(None, in_order(system.findings), texts)
    text_lines = list(lines(system))
    places = [place for _, place in text_lines]
    own = path.with_suffix(".cif")
    reading = read_cif(own, Documents({str(own): _joined(text_lines)}))
    findings = list(system.findings)
    for finding in reading.findings:
        place = places[finding.span.line - 1]
        assert place.file is not None
        findings.append(replace(finding, file=place.file.path, span=place.span, edits=(), alternatives=()))
    model = reading.model
    if model is not None:
        for _, element in tree(model):
            if getattr(element, "source", None) is not None:
                element.source = places[element.source.span.line - 1]
        model.source = system.place
        # Guards keep the variables in their ranges.
        for requirement in [requirement for requirement in model.requirements if requirement.ranges]:
            model.requirements.remove(requirement)
    return CifReading(model, in_order(findings), texts)


def cif_of(model: sct.SupervisoryControlModel) -> str | None:
    """Return the CIF text of a model that was read from automata; None if its file is no longer readable."""
    assert model.source is not None
    assert model.source.file is not None
    try:
        system, _ = _system(Path(model.source.file.path), Documents())
    except OSError:
        return None
    return None if has_errors(system.findings) else _joined(lines(system))


def _joined(text_lines: Iterable[tuple[str, Place]]) -> str:
    return "".join(f"{text}\n" for text, _ in text_lines)


def _system(path: Path, documents: Documents) -> tuple[System, dict[str, str]]:
    """Return the system in a file and its files, and the texts by path."""
    source, findings = open_source(path, path.name, documents)
    system = System(path.stem, source.whole)
    system.findings += findings
    texts = {str(path): source.text.content}
    if not findings:
        if path.suffix == ".automata":
            _read_list(source, system, texts, documents)
        elif path.suffix == ".wmod":
            _read_into(system, partial(wmod.read, source, system))
        else:
            _read_into(system, partial(_AUTOMATON[path.suffix], source, system, requirement=False))
    system.check()
    system.name_states()
    return system, texts


def _read_into(system: System, read_file: Callable[[], None]) -> None:
    with system.reporting():
        try:
            read_file()
        except ModelError as fault:
            system.findings += fault.diagnostics


def _read_list(source: Source, system: System, texts: dict[str, str], documents: Documents) -> None:
    """Read the files of a list: in each line `plant` or `requirement`, and the path of a file beside the list."""
    position = 0
    for line in source.text.content.split("\n"):
        start, position = position, position + len(line) + 1
        role, _, name = line.partition("#")[0].strip().partition(" ")
        if not role:
            continue
        with system.reporting():
            place = source.text.source(start, start + len(line))
            file = Path(normpath(source.path.parent / name.strip()))
            if role not in _ROLES or not name.strip():
                message = f"found `{role}`, expected `plant` or `requirement` and a file"
                raise FaultError(place, "syntax", message, "write `plant machine.gen`")
            if file.suffix not in _AUTOMATON:
                message = f"`{name.strip()}` is not a file with one automaton"
                raise FaultError(place, "automata-construct", message, f"name files of {' or '.join(_AUTOMATON)}")
            try:
                part, findings = open_source(file, name.strip(), documents)
            except (OSError, ValueError) as error:  # A path may contain a null character.
                message = f"the file `{file}` cannot be read: {getattr(error, 'strerror', None) or error}"
                raise FaultError(place, "unresolved-reference", message) from None
            if str(file) in texts:
                raise FaultError(place, "automata-declaration", f"the list names `{file}` twice", "name it once")
            texts[str(file)] = part.text.content
            system.findings += findings
            if not findings:
                requirement = _ROLES[role]
                _read_into(system, partial(_AUTOMATON[file.suffix], part, system, requirement=requirement))
