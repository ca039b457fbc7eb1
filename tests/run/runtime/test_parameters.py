"""Parameters of a model on the node: a new value applies from the next data on, never within a batch."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from robosc.language.configuration import Configuration
from robosc.language.configuration.parameters import layer_parameters, model_parameters
from robosc.run.runtime.core.event_loop import EventLoop
from robosc.run.runtime.core.layer import Layer
from robosc.run.runtime.core.settings import Settings, check
from tests.run.runtime.fake import FakePort, Record, World, supervised

CRUISE = Path(__file__).parent / "cruise.rscd"


def world(tmp_path: Path, **given: Any) -> World:
    return World(CRUISE, tmp_path / "events.jsonl", **given).start()


def sent(world: World, topic: str) -> Any:
    """Return the last value sent on a topic."""
    world.port.sent.clear()
    world.wait(0.3)
    found = [fields["data"] for name, fields in world.port.sent if name == topic]
    return found[-1] if found else None


def test_each_has_its_name_default_range_and_the_comment_above_it() -> None:
    """A parameter is a boolean, ranged integer, double (optionally ranged) or string.

    Its name is `speed` or `Component.speed`.
    """
    known = {found.name: found for found in model_parameters(supervised(CRUISE)).values()}
    assert {name: (found.default, found.bounds) for name, found in known.items()} == {
        "speed": (0.2, (0.05, 1.0)),
        "reach": (0.5, None),
        "least": (3, (1, 5)),
        "greeting": ("hello", None),
        "doubled": (False, None),
        "Base.factor": (-1.0, (-2.0, 2.0)),
        "Lamp.pause": (60.0, (0.02, 60.0)),
    }
    assert known["speed"].meaning == "How fast the robot drives, in metres per second."
    assert known["reach"].meaning == ""
    assert all(found.changes for found in known.values())


def test_without_a_value_the_default_counts(tmp_path: Path) -> None:
    made = world(tmp_path)
    assert sent(made, "/move") == pytest.approx(-0.2)
    assert sent(made, "/name") == "hello"


def test_what_is_set_at_the_start_counts(tmp_path: Path) -> None:
    made = world(tmp_path, speed=0.5, **{"Base.factor": 2.0}, greeting="hi")
    assert sent(made, "/move") == 1.0
    assert sent(made, "/name") == "hi"


def test_a_change_counts_from_the_next_data_on(tmp_path: Path) -> None:
    """A change applies to inputs from expressions over `value`, to rules of enums, and to provided data."""
    made = world(tmp_path)
    made.hear("range", data=0.7)
    assert sent(made, "/move") == pytest.approx(-0.2)
    made.controller.set_parameters({"reach": 1.0, "doubled": True})
    # It was clear with the last data, and remains so until new data arrives.
    assert sent(made, "/move") == 0.4
    made.hear("other", data=0.7)
    assert sent(made, "/move") is None
    made.hear("range", data=1.1)
    made.hear("load", data=3)
    assert sent(made, "/move") == 0.4
    assert sent(made, "/name") is None
    made.controller.set_parameters({"least": 4})
    assert sent(made, "/name") is None
    made.hear("load", data=3)
    assert sent(made, "/name") == "hello"


def test_a_layer_has_them_too(tmp_path: Path) -> None:
    """The data to which a layer compares its parameters decides which commands pass, from the next data on."""
    graph, port = supervised(CRUISE), FakePort()
    log = str(tmp_path / "events.jsonl")
    values = {parameter.name: parameter.default for parameter in layer_parameters(graph, Configuration(), log)}
    layer = Layer(graph, Settings(values | {"reach": 0.6}, Configuration()), port, EventLoop(lambda: port.time))
    layer.start()
    topics = {topic.topic: topic for topic in [*graph.subscriptions, *graph.publishers]}
    (move,) = topics["/move"].sendings
    seen = []
    for reach, distance in ((0.6, 0.7), (1.0, 0.7), (1.0, 1.1)):
        layer.set_parameters({"reach": reach})
        seen.append(layer.forwarded(move, Record()) is not None)  # by the data received so far
        layer.receive(topics["/range"], Record(data=distance))
        seen.append(layer.forwarded(move, Record()) is not None)
    assert seen == [True, True, True, False, False, True]


def test_a_time_that_runs_keeps_its_value(tmp_path: Path) -> None:
    """A timer that starts after a change has the new duration, as have all units of a parameter."""
    made = world(tmp_path)
    made.controller.set_parameters({"Lamp.pause": 0.5})
    made.wait(59.0)
    assert sent(made, "/lamp") is None
    made.wait(1.0)
    assert sent(made, "/lamp") is True
    made.wait(29.5)  # half a minute after the lamp went on
    assert sent(made, "/lamp") is None


def test_a_time_is_set_at_the_start(tmp_path: Path) -> None:
    made = world(tmp_path, **{"Lamp.pause": 2.0})
    made.wait(1.5)
    assert sent(made, "/lamp") is None
    made.wait(0.5)
    assert sent(made, "/lamp") is True


def test_names_that_are_none_of_the_model_are_left_alone(tmp_path: Path) -> None:
    made = world(tmp_path)
    made.controller.set_parameters({"use_sim_time": True, "speed": 0.3})
    assert sent(made, "/move") == pytest.approx(-0.3)


REFUSED = [
    ("speed", 1.5, "speed is 1.5, not between 0.05 and 1.0"),
    ("speed", "fast", "speed is 'fast', not a number"),
    ("reach", float("nan"), "reach is nan, not finite"),
    ("reach", float("inf"), "reach is inf, not finite"),
    ("least", 0, "least is 0, not between 1 and 5"),
    ("least", 2.0, "least is 2.0, not a whole number"),
    ("doubled", 1, "doubled is 1, not true or false"),
    ("greeting", 1, "greeting is 1, not a text"),
]


@pytest.mark.parametrize(("name", "value", "why"), REFUSED)
def test_a_value_that_does_not_fit_is_refused_with_the_reason(name: str, value: object, why: str) -> None:
    known = {found.name: found for found in model_parameters(supervised(CRUISE)).values()}
    with pytest.raises(ValueError, match=f"^{why}$"):
        check(known[name], value)


def test_a_whole_number_is_a_double_too() -> None:
    known = {found.name: found for found in model_parameters(supervised(CRUISE)).values()}
    found = check(known["reach"], 2)
    assert (found, type(found)) == (2.0, float)
