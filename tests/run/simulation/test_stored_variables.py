"""Stored data, computed from the events of scripts, equals the data that the node computes from the messages."""

from __future__ import annotations

import json
from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import robosc
from robosc.model.semantics.messages import receptions
from robosc.model.semantics.roles import event_name
from robosc.run.runtime.core.event_log import format_value
from robosc.run.runtime.core.node_data import NodeData
from robosc.run.simulation import Simulation
from robosc.run.simulation.data import data_beside
from robosc.run.simulation.stored_variables import StoredVariables
from tests.searching import examples

TANK = """\
robot Keeper {
  interface reading use Reading from tank_msgs

  parameter highest: double(1.0..9.0) = 5.0

  datatype object Reading {
    level: double
    count: integer
    name: string
    seen: boolean
  }

  datatype enum Kind from double to {
    value > 0.0 -> warm
    default -> cold
  }

  component Tank {
    outgoing message reading with identifier: "/reading", type: Reading links reading
    outgoing message outside with identifier: "/outside", type: Kind
    outgoing message again with identifier: "/again", type: none

    behaviour {
      variable level: double = 0.5
      variable before: double = 0.0
      variable total: integer(0..100) = 7
      variable name: string = "none"
      variable seen: boolean = false
      variable kind: Kind = cold

      on response from outside do kind := value

      initial marked state low {
        on response from reading
          if value.level > highest
          do before := level, level := value.level, name := "high"
          goto high
        on response from reading
          do before := level, level := value.level + total, total := total + value.count, seen := value.seen
        on response from again do level := level / 2
      }

      state high {
        on response from reading if !value.seen do name := value.name goto low
        on response from again do level := 1.0 / before goto low
      }
    }
  }
}
"""
ROBOT = robosc.load(text=TANK)
MODEL, GRAPH = robosc.to_sct(ROBOT), robosc.to_rosgraph(ROBOT)
robosc.synthesize(MODEL)
READING, OUTSIDE, AGAIN = (f"message_{name}.u_response" for name in ("reading", "outside", "again"))
RECEPTIONS = {event_name(reception.event): reception for reception in receptions(GRAPH)}
NUMBERS = st.floats(-10, 10) | st.sampled_from([0.0, 1e300, -1e300])
STEPS = st.lists(
    st.one_of(
        st.fixed_dictionaries(
            {"level": NUMBERS, "count": st.integers(-50, 150), "name": st.text(max_size=3), "seen": st.booleans()}
        ).map(lambda value: (READING, value)),
        NUMBERS.map(lambda value: (OUTSIDE, value)),
        st.just((AGAIN, None)),
    ),
    max_size=30,
)


def message(value: Any) -> Any:
    """Return the ROS message for data of the event log."""
    return SimpleNamespace(**value) if isinstance(value, dict) else SimpleNamespace(data=value)


@pytest.mark.slow
@settings(max_examples=examples(75))
@given(STEPS)
def test_it_is_what_the_node_makes_of_the_messages(steps: list[tuple[str, Any]]) -> None:
    simulation = Simulation(MODEL, GRAPH)
    kept, node = StoredVariables(simulation.engine, GRAPH), NodeData(GRAPH, simulation.engine)
    values = kept.initial
    for event, value in steps:
        reception = RECEPTIONS[event]
        received = node.receive(reception.event, reception.inputs, message(value))
        before, data = simulation.engine.state, {} if value is None else {"value": value}
        assert simulation.perform(event, json.loads(json.dumps(data))).accepted
        node.variables |= received.variables
        after = kept.after(values, event, data, before)
        expected = {
            f"Tank.{variable.name}": format_value(now)
            for variable, now in node.variables.items()
            if variable.component == "Tank"
        }
        for name, now in expected.items():
            is_finite = not isinstance(now, float) or abs(now) < float("inf")
            assert after[name] == (now if is_finite else None)
        values = after
        # A value that is not finite becomes unknown in the simulation only.
        if None in values.values():
            break


def test_nobody_knows_what_was_not_given() -> None:
    simulation = Simulation(MODEL, GRAPH)
    kept = StoredVariables(simulation.engine, GRAPH)
    before = simulation.engine.state
    # The data determines only which transition was taken, not the value.
    values = kept.after(kept.initial, READING, {"where": {"value.level > highest": True}}, before)
    assert {name for name, value in values.items() if value is None} >= {"Tank.level"}
    known = kept.after(values, READING, {"value": {"level": 1.0, "count": 1, "seen": True}}, before)
    assert (known["Tank.level"], known["Tank.seen"]) == (None, True)


@pytest.mark.parametrize("value", [[1], {"a": 1}, float("nan"), float("inf")])
def test_what_a_report_tells_that_no_page_can_show(value: Any) -> None:
    kept = StoredVariables(Simulation(MODEL, GRAPH).engine, GRAPH)
    told = kept.update(kept.initial, {"Tank.level": value, "Tank.other": 1, "Tank.name": "seen"})
    assert "Tank.other" not in told
    assert told["Tank.name"] == "seen"
    json.dumps(told, allow_nan=False)


def test_data_beside_what_inputs_tell() -> None:
    events = {event_name(event): event for plant in MODEL.plants for event in plant.events}
    # Scripts give conditions on this data by their texts; the data itself would decide them.
    assert data_beside(GRAPH, events[READING]) == {}
