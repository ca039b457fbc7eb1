"""The line that a node prints when it has started."""

from __future__ import annotations

import robosc
from robosc.run.runtime.node import _started

TEXT = """\
robot Lamp {
  component Light {
    service bright with identifier: "/uv/set", request: std_srvs/SetBool, response: none
    service dark with identifier: "/uv/set", request: std_srvs/SetBool, response: none
    outgoing service ring with identifier: "/ring", request: none, response: none
  }
}
"""


def test_a_name_stands_there_once() -> None:
    graph = robosc.to_rosgraph(robosc.load(text=TEXT))
    assert "calls /uv/set; serves /ring." in _started("lamp_controller", graph, shows=False)
