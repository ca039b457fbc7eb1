"""For random valid robots, their CIF has the same meaning, and the C engine behaves as the interpreter."""

from __future__ import annotations

import subprocess
from dataclasses import dataclass
from random import Random
from typing import TYPE_CHECKING, Any

from robosc.base.diagnostics import has_errors
from robosc.engine import Settings
from robosc.language import configuration as config
from robosc.language.configuration import Configuration
from robosc.m2m.sct_to_cif import transform
from robosc.m2t import cif, xmi
from robosc.m2t.cif.names import CifNames
from robosc.m2t.models import Models
from robosc.model import sct, validity
from robosc.synthesis import synthesize
from tests.fuzz.trial import Outcome, tried
from tests.m2t.cif.differences import differences
from tests.m2t.supervisor.driver import STRICT, program, run, write
from tests.m2t.supervisor.walk import Walk
from tests.random_robots import random_robot
from tests.random_second_edition import second_edition_robot
from tests.synthesis.oracle import Oracle
from tests.synthesis.test_read_back import read, supervised_states

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from robosc.synthesis import Synthesis

TARGETS = ("cif", "supervisor", "ros1", "ros2", "xmi")
#: Operations on the engines, each with one to five events.
STEPS = 200
#: Errors of synthesis that an otherwise valid robot may have.
_ALLOWED = {"empty-supervisor", "self-cancelling"}
#: Largest number of states for which the oracle enumerates them, too.
_FEW = 150


@dataclass(frozen=True)
class Robot:
    """A robot with a supervisor, and a walk through its states in Python."""

    seed: int
    models: Models
    settings: Settings
    walk: Walk


def valid_robot(seed: int) -> str:
    """Return the text of a robot; odd seeds use the second edition of the language."""
    name = f"R{seed}"
    return second_edition_robot(seed, name) if seed % 2 else random_robot(seed, name, mistakes=False)


def checked(seed: int, path: Path) -> tuple[Outcome, Robot | None]:
    """Run all steps except the C engine; return the outcome, and the robot if it has a supervisor.

    Raises AssertionError for an error in a valid robot, and for a saved model that differs after it is read back.
    """
    path.write_text(valid_robot(seed), encoding="utf-8")
    return taken_through(path, seed)


def taken_through(path: Path, seed: int) -> tuple[Outcome, Robot | None]:
    """Run the same steps on the robot in a file. `seed` selects the walk and identifies the robot in `compiled`."""
    outcome = tried(path, TARGETS)
    errors = [finding for finding in outcome.findings if has_errors([finding]) and finding.rule not in _ALLOWED]
    # CIF has no model without a plant.
    errors = [error for error in errors if not (error.rule == "cif" and error.message.endswith("without a plant"))]
    assert not errors, errors
    if outcome.models is None:
        return outcome, None
    model = outcome.models.sct
    _cif_says_the_same(outcome.models)
    if seed % 5 == 0:
        _saves_the_same(outcome.models, path.parent)
    random = Random(seed)  # noqa: S311
    settings = Settings(random.choice((0, 0, 1, 2)), random.choice((10, 10, 0, 1, 3)), random.random() < 0.8)
    walk = Walk(model, settings, seed)
    if any(plant.events for plant in model.plants):
        walk.steps(STEPS)
    else:
        walk.tick()
    return outcome, Robot(seed, outcome.models, settings, walk)


def _cif_says_the_same(models: Models) -> None:
    model, name = models.sct, models.sct.name
    files = cif.generate(models, Configuration())
    lowered = transform(model).model
    again, supervised = (named_like(files[f"{name}.{ending}"], lowered) for ending in ("cif", "supervised.cif"))
    assert (found := differences(model, again)) == [], found[:3]
    assert (found := differences(model, supervised)) == [], found[:3]
    synthesis, read_back = synthesize(model), synthesize(again)
    # CIF counts the states of requirement automata as states of plants.
    observed = any(plant.kind == sct.PlantKind.requirement for plant in model.plants)
    compared = slice(1, None) if observed else slice(None)
    assert _counts(synthesis)[compared] == _counts(read_back)[compared]
    if max(_counts(synthesis)) <= _FEW:
        oracle = Oracle(model)
        assert (len(oracle.uncontrolled), len(oracle.controlled))[compared] == _counts(synthesis)[compared]
        assert supervised_states(supervised) == synthesis.controlled_states


def named_like(text: str, model: sct.SupervisoryControlModel) -> sct.SupervisoryControlModel:
    """Read a model from CIF text, and restore the names of the lowered model that CIF does not permit."""
    again, names = read(text), CifNames(model)

    def alike(ours: Iterable[Any], theirs: Iterable[Any]) -> list[tuple[Any, Any]]:
        found = {element.name: element for element in theirs}
        called = ((mine, names.declared_name(mine).removeprefix("$")) for mine in ours if mine.name)
        return [(mine, found[name]) for mine, name in called if name in found]

    pairs = alike(model.enumerations, again.enumerations) + alike(model.plants, again.plants)
    for mine, theirs in list(pairs):
        for member in ("literals", "events", "inputs", "variables", "locations"):
            pairs += alike(getattr(mine, member, ()), getattr(theirs, member, ()))
    for mine, theirs in pairs:
        theirs.name = mine.name
    return again


def _counts(synthesis: Synthesis) -> tuple[int, int]:
    return synthesis.uncontrolled_states, synthesis.controlled_states


def _saves_the_same(models: Models, folder: Path) -> None:
    """Check that saved models, read back, are saved as the same bytes and give the same CIF."""
    written = xmi.generate(models, Configuration())
    for name, text in written.items():
        (folder / name).write_text(text, encoding="utf-8")
    name = models.sct.name
    graph = validity.load(str(folder / f"{name}.rosgraph.xmi"))
    again = Models(graph.model, graph, validity.load(str(folder / f"{name}.robosc.xmi")))
    assert xmi.generate(again, Configuration()) == written
    assert cif.generate(again, Configuration()) == cif.generate(models, Configuration())
    for file in written:
        (folder / file).unlink()


def compiled(robots: Sequence[Robot], folder: Path, flags: Sequence[str]) -> Path:
    """Compile one program with the engines of all robots; its argument selects the engine."""
    sources = []
    for robot in robots:
        loop = robot.settings
        chosen = config.ControlLoop(
            events_per_tick=loop.events_per_tick,
            reactions_per_tick=loop.reactions_per_tick,
            react_immediately=loop.react_immediately,
        )
        sources.append(write(robot.models.sct, folder, chosen).name)
        text = program(robot.models.sct)
        (folder / f"main{robot.seed}.c").write_text(f"#define main main{robot.seed}\n{text}")
    declared = "".join(f"int main{robot.seed}(int, char **);\n" for robot in robots)
    cases = "".join(f"    case {robot.seed}: return main{robot.seed}(1, words);\n" for robot in robots)
    (folder / "all.c").write_text(
        f"#include <stdlib.h>\n{declared}int main(int count, char **words)\n{{\n"
        f"    switch (count > 1 ? atoi(words[1]) : -1) {{\n{cases}    default: return 1;\n    }}\n}}\n"
    )
    mains = ["all.c", *(f"main{robot.seed}.c" for robot in robots)]
    objects = [source.replace(".c", ".o") for source in sources]
    for arguments in ([*STRICT, "-c", *sources], ["-std=gnu99", *mains, *objects, "-o", "all"]):
        done = subprocess.run(["gcc", *flags, *arguments], cwd=folder, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
    return folder / "all"


def compared(robot: Robot, built: Path) -> None:
    """Raise AssertionError if the C engine and the interpreter behave differently."""
    said = run(built, robot.walk.script, str(robot.seed))
    for number, (theirs, ours) in enumerate(zip(said, robot.walk.said, strict=True)):
        assert theirs == ours, f"step {number}: C {theirs}, Python {ours}"
