"""libFAUDES reads the same `.gen` files, and its supervisor has as many states."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import HealthCheck, assume, given, settings

from robosc.language.des import read
from tests.language.des.test_random_systems import counted, systems

if TYPE_CHECKING:
    from tests.language.des.writing import System

pytest.importorskip("faudes")
_MODELS = Path(__file__).parent / "models"


def _whole(paths: list[Path]) -> Any:
    import faudes  # noqa: PLC0415  # an optional dependency

    whole = faudes.System(str(paths[0]))
    for path in paths[1:]:
        part, whole = whole, faudes.System()
        faudes.Parallel(part, faudes.System(str(path)), whole)
    return whole


def _supervised(plants: list[Path], requirements: list[Path]) -> int:
    """Return the number of states of libFAUDES' supervisor, which has all events of the plants and requirements."""
    import faudes  # noqa: PLC0415  # an optional dependency

    plant, specification = _whole(plants), _whole(requirements)
    events = faudes.EventSet()
    for system in (plant, specification):
        events.InsertSet(system.Alphabet())
    # The projection forgets the attributes of events that only a requirement has.
    controllable = [system.ControllableEvents() for system in (plant, specification)]
    faudes.InvProject(plant, events)
    faudes.InvProject(specification, events)
    for names in controllable:
        plant.SetControllable(names)
    supervisor = faudes.System()
    faudes.SupCon(plant, specification, supervisor)
    return int(supervisor.Size())


def test_they_agree_on_the_small_factory() -> None:
    plants, requirements = (
        [_MODELS / f"{name}.gen" for name in names] for names in (("m1", "m2"), ("buffer", "repair"))
    )
    model = read(_MODELS / "small_factory.automata").model
    assert model is not None
    assert _supervised(plants, requirements) == counted(model) == 12


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(system=systems(variables=False))
def test_they_agree_on_random_systems(tmp_path: Path, system: System) -> None:
    plants, requirements = [], []
    for automaton in system.automata:
        path = tmp_path / f"{automaton.name}.gen"
        path.write_text(system.gen(automaton), encoding="utf-8")
        (requirements if automaton.requirement else plants).append(path)
    assume(requirements)
    (tmp_path / "all.automata").write_text(system.roles(".gen"), encoding="utf-8")
    model = read(tmp_path / "all.automata").model
    assert model is not None
    assert _supervised(plants, requirements) == counted(model)
