"""What is taken back and played again is the same, on all examples; what was taken is known by its transition."""

from pathlib import Path

import pytest

import robosc
from robosc.debugger.replay import Replay
from robosc.metamodel import sct
from robosc.simulation import Simulation

EXAMPLES = sorted((Path(__file__).parent.parent.parent / "examples").glob("*/*.rscd"))


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_there_and_back_again(path: Path) -> None:
    robot = robosc.load(path)
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    replay = Replay(Simulation(model, robosc.to_rosgraph(robot)), seed=7)
    first = replay.engine.state, replay.timers.saved
    moments = [moment for _ in range(60) if (moment := replay.forward()) is not None]
    last = replay.engine.state, replay.timers.saved
    for moment in moments:
        assert moment.happened
        # A component that changed its state did so by the one transition that is told.
        for plant in model.plants:
            before, after = (state.get(plant.name) for state in (moment.before, moment.after))
            taken = [edge for edge in moment.edges if edge in _edges(plant)]
            assert len(taken) <= 1
            if plant.kind == sct.PlantKind.behaviour and before != after:
                assert [edge.target.name for edge in taken] == [after]
    while replay.back() is not None:
        pass
    assert (replay.engine.state, replay.timers.saved) == first
    again = [replay.forward() for _ in moments]
    assert again == moments
    assert (replay.engine.state, replay.timers.saved) == last


def _edges(plant: sct.Plant) -> list[sct.Edge]:
    return [*plant.edges, *(edge for location in plant.locations for edge in location.edges)]
