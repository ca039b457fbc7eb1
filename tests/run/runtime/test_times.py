"""Timers in a node without middleware: each test checks one statement about `after` on the language's page."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from robosc.language.configuration import Configuration
from robosc.language.configuration.parameters import layer_parameters
from robosc.run.runtime.core.event_loop import EventLoop
from robosc.run.runtime.core.layer import Layer
from robosc.run.runtime.core.settings import Settings
from tests.run.runtime.fake import FakePort, Record, World, supervised

GUARD = Path(__file__).parent / "guard.rscd"


@pytest.fixture
def guard(tmp_path: Path) -> World:
    return World(GUARD, tmp_path / "events.jsonl", Configuration(on_shutdown=[])).start()


def events(world: World) -> list[dict[str, Any]]:
    world.controller._log.flush()
    return [json.loads(line) for line in world.log.read_text().splitlines()]


def timeouts(world: World) -> list[tuple[float, str]]:
    return [
        (round(line["time"] - 100, 3), line["event"].rpartition("_")[2])
        for line in events(world)
        if "u_after" in line["event"]
    ]


def scan_for(world: World, seconds: float) -> None:
    for _ in range(round(seconds * 10)):
        world.wait(0.1)
        world.hear("scan")


def test_one_timer_is_armed_for_the_earliest(guard: World) -> None:
    """One ROS timer is armed for the earliest expiry.

    Each timeout happens at its time, never early, and is logged as the node's own.
    """
    scan_for(guard, 3.9)
    found = timeouts(guard)
    assert [name for _, name in found] == ["after2", "after3"]
    assert [at for at, _ in found] == pytest.approx([1.001, 3.002], abs=0.0011)
    assert all(at >= due for (at, _), due in zip(found, (1.0, 3.0), strict=True))
    assert {line["direction"] for line in events(guard) if "u_after" in line["event"]} == {"internal"}
    planned = [timer for _, _, timer in guard.event_loop._timers if timer._action is not None]
    assert len(planned) == 3  # the tick, the graph check, and the timeouts


def test_a_silence_and_its_end(guard: World) -> None:
    """`after 500 ms without scan goto blind` fires once per silence; variables of the node change with it."""
    scan_for(guard, 0.4)
    guard.wait(5.0)
    assert timeouts(guard) == [(pytest.approx(0.9, abs=0.0011), "after1")]
    guard.hear("scan")
    guard.wait(0.4)
    guard.hear("scan")
    guard.wait(5.0)
    assert timeouts(guard)[1:] == [(pytest.approx(6.3, abs=0.0011), "after1")]
    told = [json.loads(text) for topic, text in guard.port.told if topic == "state"]
    assert told[-1]["components"]["Base"] == {"state": "blind", "variables": {"silences": 2}}


def test_it_reacts_at_once(tmp_path: Path) -> None:
    """A timeout is handled like incoming data: event, settle, react."""
    guard = World(GUARD, tmp_path / "events.jsonl", Configuration(on_shutdown=[]), period_ms=900).start()
    scan_for(guard, 1.0)
    assert [topic for topic, _ in guard.port.sent] == ["/halt"]
    guard.wait(0.002)
    assert [topic for topic, _ in guard.port.sent] == ["/halt", "/move"]


def test_a_clock_that_goes_back(guard: World) -> None:
    """A clock that goes backward restarts all timers."""
    scan_for(guard, 0.9)
    guard.port.time = 50.0
    guard.event_loop.run_pending()
    guard.hear("scan")
    scan_for(guard, 0.9)
    assert timeouts(guard) == []
    scan_for(guard, 0.2)
    assert [name for _, name in timeouts(guard)] == ["after2"]


def test_a_clock_that_leaps_ahead(guard: World) -> None:
    """Timers that expire together fire in the order of their expiry."""
    guard.hear("scan")
    guard.port.time += 3600
    guard.event_loop.run_pending()
    assert [name for _, name in timeouts(guard)] == ["after1"]
    assert guard.controller._control.state["component_Base"] == "blind"


def test_a_clock_that_starts_late(tmp_path: Path) -> None:
    """With `use_sim_time`, the first message on `/clock` is the node's start."""
    world = World(GUARD, tmp_path / "events.jsonl", Configuration(on_shutdown=[]))
    world.port.time = 0.0
    world.event_loop = EventLoop(lambda: world.port.time, starts_late=True)
    world.controller._event_loop = world.controller._times._event_loop = world.event_loop
    world.start()
    world.port.time = 1000.0
    world.event_loop.run_pending()
    world.hear("scan")
    assert world.controller._control.timers.running == {
        "component_Base.u_after1": 501,
        "component_Base.u_after2": 1001,
    }


def test_times_begin_with_the_clock_before_anything_happens(tmp_path: Path) -> None:
    world = World(GUARD, tmp_path / "events.jsonl", Configuration(on_shutdown=[]))
    world.port.time = 0.0
    world.event_loop = EventLoop(lambda: world.port.time, starts_late=True)
    world.controller._event_loop = world.controller._times._event_loop = world.event_loop
    world.start()
    for world.port.time in (0.002, 0.09):
        world.event_loop.run_pending()
    with world.controller._times:
        assert world.controller._control.timers.running == {
            "component_Base.u_after1": 501 - 88,
            "component_Base.u_after2": 1001 - 88,
        }


def test_a_tick_comes_after_the_timers_that_have_expired(guard: World) -> None:
    """An expired timer is handled before a due tick, and an earlier message before the timer."""
    guard.hear("scan")
    guard.port.time += 0.51
    guard.controller.tick()
    assert [name for _, name in timeouts(guard)] == ["after1"]
    guard.hear("scan")
    guard.port.arrived.append(lambda: guard.hear("scan"))
    guard.port.time += 0.51
    guard.controller.tick()
    assert [name for _, name in timeouts(guard)] == ["after1"]


def test_what_arrived_before_a_time_was_up_is_handled_before_it(guard: World) -> None:
    """A message that arrives before a timer expires is handled first."""
    guard.port.arrived.append(lambda: guard.hear("scan"))
    guard.port.time += 0.6
    guard.event_loop.run_pending()
    assert timeouts(guard) == []
    guard.wait(0.6)
    assert [name for _, name in timeouts(guard)] == ["after2", "after1"]


def a_layer(log: Path) -> tuple[Layer, FakePort, EventLoop]:
    """Return the layer of the guard, its clock and its event loop."""
    graph, port = supervised(GUARD), FakePort()
    event_loop = EventLoop(lambda: port.time)
    values = {parameter.name: parameter.default for parameter in layer_parameters(graph, Configuration(), str(log))}
    return Layer(graph, Settings(values, Configuration()), port, event_loop), port, event_loop


def test_what_the_robot_told_a_layer_before_a_time_was_up_is_handled_before_it(tmp_path: Path) -> None:
    layer, port, event_loop = a_layer(tmp_path / "events.jsonl")
    layer.start()
    scan = next(topic for topic in supervised(GUARD).subscriptions if topic.topic == "/scan")
    port.arrived.append(lambda: layer.receive(scan, Record()))
    port.time += 0.6
    event_loop.run_pending()
    assert layer._control.state["component_Base"] == "waiting"
    port.time += 0.6
    event_loop.run_pending()
    assert layer._control.state["component_Base"] == "blind"


def test_the_layer_has_timers_too(tmp_path: Path) -> None:
    """The layer has timers, too."""
    graph = supervised(GUARD)
    layer, port, event_loop = a_layer(tmp_path / "events.jsonl")
    layer.start()
    sendings = {sending.name: sending for publisher in graph.publishers for sending in publisher.sendings}
    assert layer.forwarded(sendings["halt"], Record()) is not None
    assert layer.forwarded(sendings["move"], Record()) is None
    scan = next(topic for topic in graph.subscriptions if topic.topic == "/scan")
    for _ in range(11):
        port.time += 0.1
        event_loop.run_pending()
        layer.receive(scan, Record())
    assert layer.forwarded(sendings["move"], Record()) is not None
    port.time += 0.6
    event_loop.run_pending()
    assert layer.forwarded(sendings["move"], Record()) is None
