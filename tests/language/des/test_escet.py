"""CIF's real tools read the CIF of automata, and write `.wmod` files that have the states of their CIF."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, given, settings

from robosc.language.cif import read as read_cif
from robosc.language.des import cif_of, read
from tests.language.cif.escet import TO_SUPREMICA, Tools, home
from tests.language.des.test_random_systems import counted, systems

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.language.des.writing import System

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(home() is None, reason="ESCET_HOME names no folder with CIF's tools: benchmarks/escet.md"),
]
_ROOT = Path(__file__).parents[3]
_MODELS = sorted((_ROOT / "docs" / "supervisory-control").glob("*.cif"))


@pytest.fixture(scope="module")
def tools(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Tools]:
    folder = home()
    assert folder is not None
    with Tools(folder, tmp_path_factory.mktemp("crashes")) as running:
        yield running


def _to_supremica(tools: Tools, path: Path) -> Path | None:
    """Return the file that CIF's tool writes; None if it refuses the specification."""
    output = path.with_suffix(".again.wmod")
    output.unlink(missing_ok=True)
    call = tools.call(TO_SUPREMICA, str(path), "-o", str(output))
    if "ClassNotFoundException" in call.output:
        pytest.skip("the folder has no cif2supremica")
    return output if call.status == 0 else None


@settings(max_examples=40, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(system=systems(variables=True))
def test_their_tools_agree_on_a_module(tools: Tools, tmp_path: Path, system: System) -> None:
    path = tmp_path / "all.wmod"
    path.write_text(system.wmod(), encoding="utf-8")
    model = read(path).model
    assert model is not None
    text = cif_of(model)
    assert text is not None
    path.with_suffix(".cif").write_text(text, encoding="utf-8")
    theirs = tools.synthesize(path.with_suffix(".cif"))
    assert theirs.states == system.controlled_states(), text + theirs.call.output
    written = _to_supremica(tools, path.with_suffix(".cif"))
    if written is not None:
        again = read(written)
        assert again.model is not None, again.findings
        assert counted(again.model) == theirs.states, text


@pytest.mark.parametrize("model", _MODELS, ids=lambda path: path.stem)
def test_published_models_survive_a_round_trip(tools: Tools, tmp_path: Path, model: Path) -> None:
    path = tmp_path / model.name
    path.write_text(model.read_text(encoding="utf-8"), encoding="utf-8")
    written = _to_supremica(tools, path)
    assert written is not None
    ours, theirs = read(written), read_cif(path)
    assert ours.model is not None, ours.findings
    assert theirs.model is not None
    assert counted(ours.model) == counted(theirs.model) == tools.synthesize(path).states
