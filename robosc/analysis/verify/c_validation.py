"""Compares the generated C with the model: its events with their diagrams, its control loop with the one in Python."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.analysis.verify import c_exploration, loop_exploration
from robosc.analysis.verify.c_exploration import Effort, explore_events
from robosc.analysis.verify.c_program import COMPILERS, CompileError, CProgram, c_compiler
from robosc.analysis.verify.differences import refuted
from robosc.analysis.verify.loop_exploration import LoopEffort, explore_loop
from robosc.analysis.verify.verdict import Outcome, Verdict, timed
from robosc.files.writing import temporary_folder
from robosc.semantics.roles import is_from_cif

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from robosc.metamodel import sct

    #: What examines a program, by the name of the property.
    Examinations = Mapping[str, Callable[[CProgram], Verdict]]

#: The properties, in the order of their verdicts.
PROPERTIES = (c_exploration.PROPERTY, loop_exploration.PROPERTY)


def validate_generated_c(model: sct.SupervisoryControlModel, files: Mapping[str, str]) -> list[Verdict]:
    """The verdicts on the C in these files (relative path to text): on its events, and on its control loop if any.

    Raises MemoryError where decision diagrams take more than 4 GB.
    """
    loop: Examinations = {} if is_from_cif(model) else {loop_exploration.PROPERTY: explore_loop}
    return _examined(model, files, {c_exploration.PROPERTY: explore_events, **loop})


def validate_c(model: sct.SupervisoryControlModel, files: Mapping[str, str], effort: Effort | None = None) -> Verdict:
    """Whether the events of the C in these files, compiled, do what the model says with its supervisor.

    Raises MemoryError where the decision diagrams take more than 4 GB.
    """
    return _examined(model, files, {c_exploration.PROPERTY: lambda program: explore_events(program, effort)})[0]


def validate_loop(
    model: sct.SupervisoryControlModel, files: Mapping[str, str], effort: LoopEffort | None = None
) -> Verdict:
    """Whether the control loop of the C in these files, compiled, does what the one in Python does."""
    return _examined(model, files, {loop_exploration.PROPERTY: lambda program: explore_loop(program, effort)})[0]


def _examined(
    model: sct.SupervisoryControlModel, files: Mapping[str, str], examinations: Examinations
) -> list[Verdict]:
    """The verdicts on one compiled program."""

    def skipped(reason: str) -> list[Verdict]:
        return [Verdict(question, Outcome.SKIPPED, "", reason) for question in examinations]

    compiler = c_compiler()
    if compiler is None:
        return skipped(f"there is no C compiler ({', '.join(COMPILERS)}) to try it with")
    try:
        with temporary_folder() as folder:
            try:
                program = CProgram(model, folder, compiler, files)
                return [timed(examine, program) for examine in examinations.values()]
            except CompileError as error:
                return [refuted(question, str(error)) for question in examinations]
    except OSError as error:  # that says nothing about the C
        return skipped(f"it can't be tried in the folder for temporary files: {error}")
