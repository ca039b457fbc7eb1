"""Supervisor of a specification that was read from CIF: imports the specification and adds an automaton.

The guards of the automaton are valid for the imported text. Nothing in the text keeps variables in their ranges: an
update outside a range is an error of the program that executes the text.
"""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from robosc.base.files.suffixes import AUTOMATA
from robosc.m2t.cif.expressions import CifPrinter
from robosc.m2t.cif.names import AbsoluteNames, escape_keyword
from robosc.m2t.cif.specification import document, edge_text, fold_lines, join_by_commas
from robosc.model.semantics.naming import Names
from robosc.model.semantics.printing import conjunction
from robosc.model.semantics.roles import event_name, is_written_as
from robosc.model.semantics.walks import copy_tree

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.model import expression as ex
    from robosc.model import sct


def write_extension(model: sct.SupervisoryControlModel, supervisor: sct.Supervisor, folder: Path | None) -> str:
    """Return a specification that imports the model's own and adds an automaton with the missing conditions.

    The requirements in the text stay unchanged: all of CIF's tools except synthesis treat them as normal automata.
    `folder` is the folder of the new file. None: the folder of the model's own file, also if that is unknown.
    """
    return fold_lines(list(_lines(model, supervisor, folder)))


def _imported(model: sct.SupervisoryControlModel, folder: Path | None) -> str:
    """Return the path of a model's own specification, relative to the folder of the file that imports it."""
    assert model.source is not None
    assert model.source.file is not None
    file = model.source.file
    if is_written_as(model, *AUTOMATA):
        return f"{model.name}.cif"
    if folder is not None and Path(file.path).is_file():  # A saved model does not contain the path of its text.
        with suppress(ValueError):  # The folder is on another drive.
            return Path(os.path.relpath(Path(file.path).resolve(), folder.resolve())).as_posix()
    return file.name


def _lines(model: sct.SupervisoryControlModel, supervisor: sct.Supervisor, folder: Path | None) -> Iterator[str]:
    printer = CifPrinter(AbsoluteNames(), None)
    # First component of each name in the specification.
    taken = {plant.origin.partition(".")[0] for plant in model.plants if plant.origin}
    taken |= {event_name(event).partition(".")[0] for plant in model.plants for event in plant.events}
    taken |= {member.name for plant in model.plants if not plant.origin for member in plant.variables}
    for enumeration in model.enumerations:
        taken |= {enumeration.name, *(literal.name for literal in enumeration.literals)}
    yield from document([f"{model.name} under its supervisor: {supervisor.controlledStates} states."], sign="@@")
    yield f"import {_string(_imported(model, folder))};"
    yield ""
    lacking = _lacking(model, supervisor)
    added = any(lacking.values())
    yield from document(["Conditions by synthesis." if added else "Synthesis added nothing to the requirements."])
    yield f"supervisor automaton {Names(taken).fresh('sup')}:"
    events = {event: escape_keyword(event_name(event)) for event in lacking}
    yield f"  alphabet {join_by_commas(events.values())};" if events else "  alphabet;"
    if supervisor.initial is not None:
        yield f"  initial {printer(supervisor.initial)};"
    yield ""
    yield "  location:"
    yield "    initial; marked;"
    for event, parts in lacking.items():
        guard = conjunction(map(copy_tree, parts))
        yield edge_text(events[event], "" if guard is None else printer(guard))
    yield "end"


def _string(text: str) -> str:
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def _lacking(model: sct.SupervisoryControlModel, supervisor: sct.Supervisor) -> dict[sct.Event, list[ex.Expression]]:
    """Return the conditions that the text lacks for each event: ranges that matter, and additions of synthesis."""
    lacking: dict[sct.Event, list[ex.Expression]] = {guard.event: [] for guard in supervisor.guards}
    # Another synthesis tool does not list the requirements behind a guard: each may matter then.
    behind = {
        guard.event: set(guard.requirements) if guard.requirements or guard.requirement is None else None
        for guard in supervisor.guards
    }
    for requirement in model.requirements:
        if requirement.ranges and requirement.event in lacking:
            mattering = behind[requirement.event]
            if mattering is None or requirement in mattering:
                lacking[requirement.event].append(requirement.condition)
    for guard in supervisor.guards:
        if guard.synthesis is not None:
            lacking[guard.event].append(guard.synthesis)
    return lacking
