"""Wide integers: acceleration reaches the same result as single steps, in few steps."""

from unittest.mock import patch

import pytest
from hypothesis import given

from robosc.base.diagnostics import ModelError
from robosc.model.places import Place
from robosc.synthesis import acceleration, encoding, synthesize
from tests.random_sct import sct_models
from tests.sct_models import edge, model, needs, plant
from tests.synthesis.test_against_oracle import RANDOM_MODELS, check

pytestmark = pytest.mark.slow

INTEGER = "-2147483648..2147483647 = 0"
LARGEST = 2**31 - 1


@given(sct_models())
@RANDOM_MODELS
def test_random_models_accelerated(random_model):
    with patch.object(encoding, "_WIDE", 2), patch.object(acceleration, "_PATIENCE", 1):
        check(random_model, synthesize(random_model))


def test_they_are_taken(monkeypatch):
    taken = []
    closed = acceleration.Acceleration._closed
    monkeypatch.setattr(acceleration.Acceleration, "_closed", lambda *given: taken.append(closed(*given)) or taken[-1])
    synthesize(counter())
    assert taken
    assert None not in taken


def counter(integer=INTEGER):
    """Return a plant that counts without end; `go` may happen until the count is three."""
    return model(
        [
            plant(
                "P",
                {"on": [edge("count", do={"n": "n + 1"}), edge("go")]},
                controllable=["go"],
                uncontrollable=["count"],
                variables={"n": integer},
            )
        ],
        [needs("go", "n < 3")],
    )


def turning(number, integer=INTEGER):
    """Return counters that stop after every count and then continue."""
    return [
        plant(
            f"P{i}",
            {
                "on": [edge(f"count{i}", do={"n": "n + 1"}, to="off")],
                "off": [edge(f"again{i}", to="on"), edge(f"go{i}")],
            },
            controllable=[f"go{i}", f"again{i}"],
            uncontrollable=[f"count{i}"],
            variables={"n": integer},
        )
        for i in range(number)
    ]


def test_a_counter():
    synthesis = synthesize(counter())
    assert synthesis.controlled_states == LARGEST + 1
    assert synthesis.statistics.operations < 1000


def test_counters_that_stop_after_every_count():
    synthesis = synthesize(model(turning(4), [needs("go0", "P0.n < P1.n + 3")]))
    assert synthesis.controlled_states == (2 * LARGEST + 1) ** 4


def test_counters_that_go_together():
    pair = plant(
        "P",
        {
            "on": [edge("count", do={"n": "n + 1", "m": "m - 1"}, to="off")],
            "off": [edge("again", to="on"), edge("clear", do={"n": "0", "m": "0"}, to="on")],
        },
        controllable=["again", "clear"],
        uncontrollable=["count"],
        variables={"n": INTEGER, "m": INTEGER},
    )
    assert synthesize(model([pair])).controlled_states == 2 * LARGEST + 1 + 2


def test_a_counter_of_answers():
    """The counter and the plant that waits for it are different plants."""
    service = plant(
        "S",
        {
            "idle": [edge("call", to="busy")],
            "busy": [edge("response", to="idle"), edge("error", to="failed")],
            "failed": [edge("reset", to="idle")],
        },
        controllable=["call", "reset"],
        uncontrollable=["response", "error"],
        marked=["idle"],
    )
    component = plant(
        "P",
        {
            "free": [edge("call", to="waiting"), edge("response"), edge("error")],
            "waiting": [edge("response", do={"good": "good + 1"}, to="free"), edge("error", to="free")],
        },
        variables={"good": INTEGER},
    )
    assert synthesize(model([service, component])).controlled_states == 3 * (LARGEST + 1)


def test_what_must_not_happen_after_a_million_counts():
    """The supervisor permits counting until spilling becomes possible: its guard has the number."""
    tank = plant(
        "T",
        {
            "open": [edge("fill", do={"n": "n + 1"}, to="closed")],
            "closed": [
                edge("more", to="open"),
                edge("spill", to="spilled", when="n > 1000000"),
                edge("empty", do={"n": "0"}),
            ],
            "spilled": [],
        },
        controllable=["fill", "more", "empty"],
        uncontrollable=["spill"],
        variables={"n": INTEGER},
    )
    synthesis = synthesize(model([tank]))
    assert synthesis.controlled_states == 1_000_001 + 1_000_000 + 1


def test_where_nothing_helps_the_widest_integer_is_named(monkeypatch):
    monkeypatch.setattr(acceleration, "_HOPELESS", 64)
    monkeypatch.setattr(acceleration, "_LARGE", 1)
    endless = counter()
    endless.plants[0].variables[0].source = Place.parse("robot.rscd:7:9-7:20")
    with pytest.raises(ModelError, match="the range of n, 4294967296 values, is too wide") as caught:
        synthesize(endless)
    [finding] = caught.value.diagnostics
    assert (finding.file, finding.span.line, finding.span.column, finding.rule) == ("robot.rscd", 7, 9, "integer-range")
