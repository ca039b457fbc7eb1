"""CIF's real tools accept and agree with random specifications and generated CIF."""

from __future__ import annotations

import shutil
from itertools import count
from math import prod
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from click.testing import CliRunner

import robosc
from robosc.analysis.supervise import supervise
from robosc.language.cif import read
from robosc.language.configuration import Configuration
from robosc.m2t import cif
from robosc.model import expression as ex
from robosc.model.semantics.roles import input_values
from robosc.synthesis import count as count_states
from robosc.synthesis import synthesize
from robosc.tools.cli import main
from tests.fuzz.valid import checked
from tests.language.cif.comparing import reading_of
from tests.language.cif.escet import CONTROLLER_CHECK, TRANSFORMER, Tools, home, without_inputs
from tests.language.cif.random_specifications import Specification
from tests.language.cif.test_language import COUNTS

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from robosc.model import sct

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(home() is None, reason="ESCET_HOME names no folder with CIF's tools: benchmarks/escet.md"),
]
_ROOT = Path(__file__).parents[3]
#: The fleet has more states than these tools take in a test.
_SHIPPED = sorted(
    path
    for path in [*(_ROOT / "examples").glob("*/*.rscd"), *(_ROOT / "docs" / "patterns").glob("*.rscd")]
    if path.parent.name != "fleet"
)


@pytest.fixture(scope="module")
def tools(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Tools]:
    folder = home()
    assert folder is not None
    with Tools(folder, tmp_path_factory.mktemp("crashes")) as running:
        yield running


def _written(folder: Path, specification: Specification) -> Path:
    for name, text in specification.files.items():
        (folder / name).write_text(text)
    return folder / "random.cif"


@pytest.mark.parametrize("start", range(0, 100, 25))
def test_synthesis_counts_as_many_states(tools: Tools, tmp_path: Path, start: int) -> None:
    compared = 0
    for seed in range(start, start + 25):
        specification = Specification(seed, narrow=True)
        path = _written(tmp_path, specification)
        text = "\n".join(specification.files.values())
        theirs = tools.synthesize(path)
        if "Definition/use cycle" in theirs.call.output:
            continue  # A location uses itself in its own predicates: docs/coming-from-cif.md.
        reading = reading_of(specification)
        if reading.model is None:
            # RoboSC alone rejects plant invariants that an event can violate in several ways.
            rules = {finding.rule for finding in reading.findings}
            assert theirs.call.status != 0 or rules == {"cif-construct"}, text
        # CIF's answer depends on its bits if an event leaves a plant invariant and a range at once. An invariant over
        # an input of many values is weaker in CIF: docs/coming-from-cif.md.
        elif not specification.differs_in_cif():
            assert theirs.states == specification.controlled_states(), text + theirs.call.output
            compared += 1
    assert compared > 10


@pytest.mark.parametrize("name", ["data", "failures", "transitions"])
def test_robots_with_inputs_have_as_many_states(tools: Tools, tmp_path: Path, name: str) -> None:
    """In CIF, an input is part of the state, and an input of an enumeration can have each literal."""
    robot = robosc.load(_ROOT / "tests" / "every_view" / f"{name}.rscd")
    model = robosc.to_sct(robot)
    states = robosc.synthesize(model).controlledStates
    for path, text in robosc.generate("cif", robosc.Models(model)).items():
        (tmp_path / path).write_text(text)
    assert tools.synthesize(tmp_path / f"{model.name}.cif").states == states * input_values(model)


def test_what_is_written_of_specifications_is_valid(tools: Tools, tmp_path: Path) -> None:
    valid = 0
    for seed in range(60):
        path = _written(tmp_path, Specification(seed, narrow=True))
        result = CliRunner().invoke(main, ["transform", str(path), "--to", "cif", "-o", str(tmp_path)])
        if result.exit_code == 0:
            call = tools.is_valid(tmp_path / "random.supervised.cif")
            if "Definition/use cycle" in call.output:
                continue
            assert call.status == 0, call.output
            valid += 1
    assert valid > 10


@pytest.mark.parametrize(
    ("text", "transformation", "states"),
    [
        (
            """controllable c;
            plant p: disc bool x, y; location: initial; marked; edge c do if x: y := true else x := true end; end""",
            "elim-if-updates",
            3,
        ),
    ],
)
def test_the_transformation_that_a_finding_names_takes_the_construct_out(
    tools: Tools, tmp_path: Path, text: str, transformation: str, states: int
) -> None:
    path, without = tmp_path / "with.cif", tmp_path / "without.cif"
    path.write_text(text)
    hints = [finding.hint or "" for finding in read(path).findings]
    assert hints
    assert all(f"cif2cif -t {transformation}`" in hint for hint in hints)
    called = tools.call(TRANSFORMER, str(path), "-t", transformation, "-o", str(without))
    assert called.status == 0, called.output
    model = read(without).model
    assert model is not None
    assert synthesize(model).controlled_states == tools.synthesize(without).states == states


@pytest.mark.parametrize("name", [name for name in COUNTS if "channel" in name])
def test_channels_are_the_events_of_linearize_product(tools: Tools, tmp_path: Path, name: str) -> None:
    path, without = tmp_path / "with.cif", tmp_path / "without.cif"
    path.write_text(COUNTS[name][0])
    called = tools.call(TRANSFORMER, str(path), "-t", "linearize-product", "-o", str(without))
    assert called.status == 0, called.output
    model = read(without).model
    assert model is not None
    assert synthesize(model).controlled_states == tools.synthesize(path).states == COUNTS[name][1]


def test_the_transformation_that_gives_edges_an_event(tools: Tools, tmp_path: Path) -> None:
    """The user must declare whether the new event is controllable."""
    path, without = tmp_path / "with.cif", tmp_path / "without.cif"
    path.write_text("plant p: location a: initial; marked; edge tau goto b; location b: marked; end")
    assert "cif2cif -t elim-tau-event`" in (read(path).findings[0].hint or "")
    called = tools.call(TRANSFORMER, str(path), "-t", "elim-tau-event", "-o", str(without))
    assert called.status == 0, called.output
    without.write_text(without.read_text().replace("event tau_", "uncontrollable tau_"))
    model = read(without).model
    assert model is not None
    assert synthesize(model).controlled_states == tools.synthesize(without).states == 2


def _values(parameter: sct.Input) -> int:
    """Return the number of values of an input."""
    declared = parameter.type
    if isinstance(declared, ex.IntegerType):
        return declared.maximum - declared.minimum + 1
    return len(declared.enumeration.literals) if isinstance(declared, ex.EnumerationType) else 2


@pytest.mark.parametrize("start", range(0, 40, 10))
def test_random_robots_have_as_many_states(tools: Tools, tmp_path: Path, start: int) -> None:
    """In CIF, the values of inputs are part of a state and can change at any time."""
    compared = 0
    for seed in range(start, start + 10):
        _, robot = checked(seed, tmp_path / "robot.rscd")
        if robot is not None:
            model = robot.models.sct
            name = model.name
            for file, text in cif.generate(robot.models, Configuration()).items():
                (tmp_path / file).write_text(text)
            told = prod(
                _values(carried) for plant in model.plants for event in plant.events for carried in event.inputs
            )
            found = tools.synthesize(tmp_path / f"{name}.cif")
            assert found.states == model.supervisor.controlledStates * told, f"seed {seed}: {found.call.output}"
            valid = tools.is_valid(tmp_path / f"{name}.supervised.cif")
            assert valid.status == 0, f"seed {seed}: {valid.output}"
            compared += 1
    assert compared > 2


@pytest.mark.parametrize("path", _SHIPPED, ids=lambda path: str(path.stem))
def test_what_is_written_of_robots(tools: Tools, tmp_path: Path, path: Path) -> None:
    result = CliRunner().invoke(main, ["transform", str(path), "--to", "cif", "-o", str(tmp_path)])
    assert result.exit_code == 0, result.output
    [supervised] = tmp_path.glob("*.supervised.cif")
    [plants] = set(tmp_path.glob("*.cif")) - {supervised}
    checked = tools.is_valid(supervised)
    assert checked.status == 0, checked.output
    # Synthesis does not support supervisors: as plants, they must leave the number of states unchanged.
    as_plants = tmp_path / "as_plants.cif"
    tools.call(TRANSFORMER, str(supervised), "-t", "relabel-supervisors-as-plants", "-o", str(as_plants))
    counted = tools.synthesize(as_plants)
    assert counted.states is not None, counted.call.output
    assert counted.states == tools.synthesize(plants).states
    # The run time of the confluence check is proportional to the product of all domains.
    checked_path = str(tmp_path / "checked.cif")
    properties = tools.call(CONTROLLER_CHECK, str(supervised), "--confluence-check=no", "-o", checked_path)
    assert "CONCLUSION" in properties.output, properties.output


#: The folder below ESCET_HOME with specifications of CIF's own tests, if it exists.
_OWN = "tests/datasynth"
#: The explorer is slow beyond this number of states.
_MOST = 20_000
#: Number of random specifications that have a supervisor in both tools.
_RANDOM = 100


def _agree(tools: Tools, path: Path) -> bool:
    """Check that a specification has the same states and edges under the written supervisor and under CIF's own.

    Both supervised specifications can be read back: they have as many states as before, and their supervisors suffice.
    Returns False if one of the tools finds no supervisor.
    """
    result = CliRunner().invoke(main, ["transform", str(path), "--to", "cif", "-o", str(path.parent / "written")])
    theirs = tools.supervised(path)
    if result.exit_code != 0 or theirs.call.status != 0:
        return False
    written = path.parent / "written" / f"{path.stem}.supervised.cif"
    ours = tools.explore(written)
    assert ours.size is not None, f"{path.name}: {ours.call.output}"
    assert ours.size == theirs.size, path.name
    for supervised in (written, path.with_suffix(".own.cif")):
        again = read(supervised)
        assert again.model is not None, (supervised.name, again.findings)
        supervision = supervise(again.model)
        assert supervision.synthesis.controlled_states == ours.size[0], supervised.name
        assert not [finding for finding in supervision.findings if finding.rule == "given-supervisor"], supervised.name
    return True


def _write_explorable(folder: Path, files: Mapping[str, str]) -> None:
    """Write a specification without inputs, which the explorer does not support."""
    folder.mkdir()
    for name, text in files.items():
        (folder / name).write_text(without_inputs(text))


@pytest.mark.parametrize("construct", COUNTS)
def test_each_construct_runs_to_the_states_of_cifs_own_supervisor(tools: Tools, tmp_path: Path, construct: str) -> None:
    """An update outside its range ends the explorer in an error."""
    text, _ = COUNTS[construct]
    _write_explorable(tmp_path / "construct", {"construct.cif": text})
    if not _agree(tools, tmp_path / "construct" / "construct.cif"):
        assert tools.supervised(tmp_path / "construct" / "construct.cif").call.status != 0


def test_random_specifications_run_to_the_states_of_cifs_own_supervisor(tools: Tools, tmp_path: Path) -> None:
    explored = 0
    for seed in count():
        specification = Specification(seed, narrow=True)
        if not specification.differs_in_cif():
            _write_explorable(tmp_path / f"{seed}", specification.files)
            explored += _agree(tools, tmp_path / f"{seed}" / "random.cif")
        if explored == _RANDOM:
            return


@pytest.mark.parametrize("start", range(0, 200, 50))
def test_channels_have_as_many_states(tools: Tools, tmp_path: Path, start: int) -> None:
    """CIF's explorer reaches the same states and edges under both supervisors."""
    compared = explored = 0
    for seed in range(start, start + 50):
        specification = Specification(seed, narrow=True)
        if not specification.channels or specification.differs_in_cif():
            continue
        path, text = _written(tmp_path, specification), "\n".join(specification.files.values())
        theirs = tools.synthesize(path)
        if theirs.states is None or reading_of(specification).model is None:
            continue
        assert theirs.states == specification.controlled_states(), text
        compared += 1
        explored += "input" not in text and _agree(tools, path)
    assert compared > 5
    assert explored


#: Specifications of ESCET's own tests and examples, except expected outputs.
_SPECIFICATIONS = [
    path.relative_to(folder)
    for folder in [home() or Path("nowhere")]
    for path in [*sorted(folder.glob("tests/**/*.cif")), *sorted(folder.glob("examples/**/*.cif"))]
    if path.relative_to(folder).parts[0] == "examples" or path.name.count(".") == 1
]


@pytest.fixture(scope="module")
def copied(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with copies of the specifications: the tools write beside them."""
    folder = tmp_path_factory.mktemp("escet")
    for name in ("tests", "examples"):
        if (home() or Path("nowhere")).joinpath(name).is_dir():
            shutil.copytree((home() or Path()) / name, folder / name)
    return folder


@pytest.mark.skipif(not _SPECIFICATIONS, reason="ESCET_HOME has neither tests nor examples: benchmarks/escet.md")
@pytest.mark.parametrize("start", range(8))
def test_cifs_own_specifications_have_as_many_states(tools: Tools, copied: Path, start: int) -> None:
    """RoboSC reads each specification that CIF's synthesis accepts, except those without an initial location."""
    compared = 0
    for path in _SPECIFICATIONS[start::8]:
        theirs = tools.synthesize(copied / path)
        if theirs.states is None:
            continue
        reading = read(copied / path)
        if reading.model is None:
            assert {finding.rule for finding in reading.findings} == {"initial-state"}, path
            continue
        # CIF's tool computes the number as a floating-point number.
        assert float(count_states(reading.model).controlled_states) == pytest.approx(theirs.states, rel=1e-14), path
        compared += 1
    assert compared > 10


@pytest.mark.skipif(
    not (home() or Path()).joinpath(_OWN).is_dir(), reason=f"ESCET_HOME has no folder {_OWN}: benchmarks/escet.md"
)
def test_cifs_own_tests_run_to_the_states_of_its_supervisor(tools: Tools, tmp_path: Path) -> None:
    folder = home()
    assert folder is not None
    shutil.copytree(folder / _OWN, tmp_path / "own")
    explored = 0
    for path in sorted((tmp_path / "own").glob("*.cif")):
        # Files with two suffixes are the expected output of tests.
        if path.name.count(".") == 1 and "input string" not in (text := path.read_text()):
            path.write_text(without_inputs(text))
            explored += _agree(tools, path)
    assert explored > 200


@pytest.mark.parametrize("path", _SHIPPED, ids=lambda path: str(path.stem))
def test_written_robots_run_to_the_states_of_cifs_own_supervisor(tools: Tools, tmp_path: Path, path: Path) -> None:
    result = CliRunner().invoke(main, ["transform", str(path), "--to", "cif", "-o", str(tmp_path)])
    if result.exit_code != 0:
        pytest.skip("a library, or no model by itself")
    [supervised] = tmp_path.glob("*.supervised.cif")
    [plants] = set(tmp_path.glob("*.cif")) - {supervised}
    states = tools.synthesize(plants).states
    if states is None or states > _MOST:
        pytest.skip(f"{states} states take the explorer long")
    for file in (supervised, plants):
        file.write_text(without_inputs(file.read_text()))
    ours, theirs = tools.explore(supervised), tools.supervised(plants)
    assert ours.size is not None, ours.call.output
    assert ours.size == theirs.size, theirs.call.output
