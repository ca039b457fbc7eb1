"""Validation of the generated C: its events by diagrams, its control loop by the one in Python."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.analysis.verify import c_exploration, loop_exploration
from robosc.analysis.verify.c_exploration import Effort, explore_events
from robosc.analysis.verify.c_program import COMPILERS, CompileError, CProgram, c_compiler
from robosc.analysis.verify.differences import refute
from robosc.analysis.verify.loop_exploration import LoopEffort, explore_loop
from robosc.analysis.verify.verdict import Outcome, Verdict, measure
from robosc.base.files.writing import temporary_folder
from robosc.model.semantics.roles import is_from_cif

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from robosc.model import sct

    #: Functions that examine a program, by the name of the property.
    Examinations = Mapping[str, Callable[[CProgram], Verdict]]

#: Names of the properties, in the order of their verdicts.
PROPERTIES = (c_exploration.PROPERTY, loop_exploration.PROPERTY)


def validate_generated_c(model: sct.SupervisoryControlModel, files: Mapping[str, str]) -> list[Verdict]:
    """Return the verdicts on the C in these files: on its events, and on its control loop if any.

    `files` maps relative paths to texts. Raises MemoryError if decision diagrams take more than 4 GB.
    """
    loop: Examinations = {} if is_from_cif(model) else {loop_exploration.PROPERTY: explore_loop}
    return _examined(model, files, {c_exploration.PROPERTY: explore_events, **loop})


def validate_c(model: sct.SupervisoryControlModel, files: Mapping[str, str], effort: Effort | None = None) -> Verdict:
    """Return whether the events of the compiled C agree with the model under its supervisor.

    Raises MemoryError if the decision diagrams take more than 4 GB.
    """
    return _examined(model, files, {c_exploration.PROPERTY: lambda program: explore_events(program, effort)})[0]


def validate_loop(
    model: sct.SupervisoryControlModel, files: Mapping[str, str], effort: LoopEffort | None = None
) -> Verdict:
    """Return whether the control loop of the compiled C agrees with the one in Python."""
    return _examined(model, files, {loop_exploration.PROPERTY: lambda program: explore_loop(program, effort)})[0]


def _examined(
    model: sct.SupervisoryControlModel, files: Mapping[str, str], examinations: Examinations
) -> list[Verdict]:
    """Return the verdicts on one compiled program."""

    def skipped(reason: str) -> list[Verdict]:
        return [Verdict(question, Outcome.SKIPPED, "", reason) for question in examinations]

    compiler = c_compiler()
    if compiler is None:
        return skipped(f"no C compiler found ({', '.join(COMPILERS)})")
    try:
        with temporary_folder() as folder:
            try:
                program = CProgram(model, folder, compiler, files)
                return [measure(examine, program) for examine in examinations.values()]
            except CompileError as error:
                return [refute(question, str(error)) for question in examinations]
    except OSError as error:  # The C is not the cause.
        return skipped(f"the program cannot run in the folder for temporary files: {error}")
