"""Undone and replayed events give the same states, on all examples. The moments name the transitions taken."""

from pathlib import Path

import pytest

import robosc
from robosc.model import sct
from robosc.run.simulation import Simulation
from robosc.run.simulation.replay import Replay
from robosc.run.simulation.script import WAIT, ScriptStep
from robosc.tools.debugger.launch import Launch
from tests.searching import slow_but

from ..runtime.fake import World

EXAMPLES = sorted(
    path for path in (Path(__file__).parents[2].parent / "examples").glob("*/*.rscd") if path.parent.name != "fleet"
)


@pytest.mark.parametrize("path", slow_but((path.stem for path in EXAMPLES[:4]), EXAMPLES), ids=lambda path: path.stem)
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
        # Only the named transition can have changed the state of a component.
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


def test_the_log_of_a_node_is_played_without_a_stop(tmp_path: Path) -> None:
    """The model accepts all events of the node and takes over its clock."""
    path = next(path for path in EXAMPLES if path.stem == "line_follower")
    log = tmp_path / "events.jsonl"
    world = World(path, log).start()
    world.hear("emergency_stop", data=False)
    world.hear("continue")
    world.hear("scan", ranges=[5.0] * 360)
    world.hear("correction", data=3.0)
    world.wait(0.35)
    world.hear("emergency_stop", data=True)
    world.wait(0.2)
    world.hear("scan", ranges=[0.3] * 360)
    world.hear("emergency_stop", data=False)
    world.hear("continue")
    world.wait(0.2)
    world.controller.close()
    simulation = Simulation(world.graph.model, world.graph)
    steps, _ = Launch.of({"program": str(path), "script": str(log)}).steps(simulation)
    replay = Replay(simulation, steps)
    moments = [moment for _ in steps or () if (moment := replay.forward()) is not None]
    assert replay.is_over
    assert len(moments) == len(log.read_text().splitlines()) > 10
    assert {moment.event for moment in moments} >= {"message_move.c_trigger", "message_halt.c_trigger"}
    assert [moment for moment in moments if not moment.happened] == []
    assert replay.timers.now == 700


def test_a_typed_wait_does_not_prolong_a_wait_of_the_script(tmp_path: Path) -> None:
    file = tmp_path / "r.rscd"
    file.write_text(
        """robot R { component C {
          outgoing message a with type: none
          behaviour {
            initial marked state idle { after 3 s goto x }
            marked state x { after 4 s goto y }
            marked state y { on response from a goto idle }
          }
        } }"""
    )
    model = robosc.to_sct(robosc.load(file))
    robosc.synthesize(model)
    steps = [ScriptStep(1, WAIT, {"seconds": 6.0}), ScriptStep(2, "message_a.u_response", {})]
    replay = Replay(Simulation(model), steps)
    assert replay.forward() is not None
    assert replay.timers.now == 3000
    replay.let_go_by(1.0)
    assert replay.timers.now == 4000
    wait, response = replay.forward(), replay.forward()
    assert (wait and wait.event, replay.timers.now) == (WAIT, 6000)
    assert response is not None
    assert response.after["component_C"] == "x"
    while replay.timers.now > 3000:
        replay.back()
    replay.let_go_by(10.0)
    assert replay.next_line == 2


def _edges(plant: sct.Plant) -> list[sct.Edge]:
    return [*plant.edges, *(edge for location in plant.locations for edge in location.edges)]
