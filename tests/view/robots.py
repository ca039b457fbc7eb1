"""A small robot with time, data, a number and names that pages must not take for markup."""

from __future__ import annotations

from typing import TYPE_CHECKING

import robosc
from robosc.m2t.models import Models
from robosc.simulation import Simulation
from robosc.view import Record, describe

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.simulation import Step

#: What would be seen if any of it became markup.
EVIL = '<img src=x onerror="globalThis.hacked = 1"></script><script>globalThis.hacked = 1</script>'

GATE = f"""\
robot Gate {{
  component Barrier {{
    incoming message open with identifier: "/open", type: none
    incoming message close with identifier: "/close", type: none
    outgoing message car with identifier: "/car", type: boolean

    behaviour {{
      variable cars: integer(0..3) = 0

      initial marked state closed {{
        on request to open goto opened
      }}

      state opened {{
        on request to close goto closed
        on response from car if value do cars := min(cars + 1, 3)
        after 2.0 s goto closed
      }}
    }}
  }}

  requirement Full "no more than three {EVIL.replace('"', "'")}": open needs Barrier.cars < 3
}}
"""


def record(text: str = GATE, steps: Sequence[Step] | None = None) -> tuple[Mapping[str, object], Record, Simulation]:
    """The description and record of a robot, and another simulation of it, to know what is true."""
    robot = robosc.load(text=text)
    model, graph = robosc.to_sct(robot), robosc.to_rosgraph(robot)
    robosc.synthesize(model)
    described = describe(Models(model, graph, robot), {"<text>": text})
    return described, Record(Simulation(model, graph), steps), Simulation(model, graph)
