"""Robots whose supervisors decide with the data of commands: two fixed ones, and random ones."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING

import robosc
from robosc.m2t.models import Models

if TYPE_CHECKING:
    from pathlib import Path

#: Data of messages: a value computed by the node, and values that decide where a component goes.
GUARD = """\
robot Guard {
  datatype object Linear { x: double }
  datatype object Velocity { linear: Linear }
  interface Twist use Twist from geometry_msgs
  component Base {
    incoming message velocity with identifier: "/cmd_vel", type: Velocity links Twist
    incoming message level with identifier: "/level", type: integer(-1..5)
    behaviour {
      initial marked state idle { on request to level if value > 2 goto busy }
      state busy { on request to level if value = 0 goto idle on request to level if value = 5 goto fast }
      state fast { on request to level if value = 0 goto idle }
    }
  }
  component Person {
    outgoing message seen with identifier: "/seen", type: boolean
    behaviour {
      initial marked state far { on response from seen if value goto near }
      marked state near { on response from seen if !value goto far }
    }
  }
  requirement Base.velocity needs Person.far or value.linear.x <= 0.3
  requirement Base.level needs Person.far or value < 4 and value >= 3
  provide Base.velocity with { linear: { x: 0.2 } } if Person.near
  provide Base.velocity with { linear: { x: 1.0 } }
  provide Base.level with 3 if Base.idle
  provide Base.level with 0
  requirement never Base.fast and Person.near
}
"""
#: An action whose goal requirements judge by its data, a service, a set of commands and a requirement automaton.
COURIER = """\
robot Courier {
  interface Count use Count from demo_interfaces
  interface Pick use Pick from demo_interfaces
  component Base {
    action go with identifier: "/go", request: integer(-1..2), response: none, feedback: none links Count
    service pick with identifier: "/pick", request: boolean, response: none links Pick
    incoming message left with identifier: "/left", type: integer(0..2)
    incoming message right with identifier: "/right", type: integer(-2..1)
    behaviour {
      initial marked state idle {
        on request to go if value > 0 goto busy
        on request to go if value < 0
        on request to pick
      }
      state busy {
        on response from go goto idle
        on error from go goto idle
        on canceled from go goto idle
      }
    }
  }
  component Person {
    outgoing message seen with identifier: "/seen", type: boolean
    behaviour {
      initial marked state far { on response from seen if value goto near }
      marked state near { on response from seen if !value goto far }
    }
  }
  requirement Base.go needs Person.far or value < 1
  requirement value = 2 disables Base.go
  requirement Base.pick needs Person.far or value
  requirement { Base.left, Base.right } needs Person.far or value <= 0
  requirement Turns: automaton {
    initial marked state one { on request to Base.left if value > 0 goto two on request to Base.left if value = 0 }
    state two { on request to Base.left if value = 0 goto one }
  }
  provide Base.go with 1 if Person.far
  provide Base.go with -1
  provide Base.pick with true
}
"""
ROBOTS = {"Guard": GUARD, "Courier": COURIER}


def models_of(text: str, folder: Path) -> Models:
    """Return the models of a robot with its supervisor."""
    path = folder / "robot.rscd"
    path.write_text(text)
    robot = robosc.load(path)
    plants = robosc.to_sct(robot)
    robosc.synthesize(plants)
    return Models(plants, robosc.to_rosgraph(robot), robot)


def random_robot(seed: int) -> str:
    """Return the text of a small robot with random conditions on the data of two messages and an action."""
    return _Draft(Random(seed)).text()  # noqa: S311 - the same robot on every run


class _Draft:
    def __init__(self, random: Random) -> None:
        self._random = random
        self._states = ["a", "b", "c"][: random.randint(2, 3)]

    def text(self) -> str:
        states = "\n".join(self._state(name, number) for number, name in enumerate(self._states))
        requirements = "\n".join(f"  requirement {self._requirement()}" for _ in range(self._random.randint(1, 3)))
        return f"""\
robot Drawn {{
  interface Count use Count from demo_interfaces
  component Base {{
    action go with request: integer(-1..1), response: none, feedback: none links Count
    incoming message level with type: integer(0..3)
    incoming message light with type: boolean
    behaviour {{
      variable kept: integer(0..2)
{states}
    }}
  }}
  component Person {{
    outgoing message seen with type: integer(0..2)
    behaviour {{
      initial marked state far {{ on response from seen if value > 0 goto near }}
      marked state near {{ on response from seen if value = {self._random.randint(0, 2)} goto far }}
    }}
  }}
{requirements}
}}
"""

    def _state(self, name: str, number: int) -> str:
        marked = number == 0 or self._random.random() < 0.2
        prefix = f"{'initial ' * (number == 0)}{'marked ' * marked}"
        transitions = [
            f"        on request to {command} if {self._condition(command, 1)}{self._goto()}"
            for command in ("level", "light", "go")
            for _ in range(self._random.choice((0, 1, 1, 2)))
        ]
        ends = [f"        on {end} from go{self._goto()}" for end in ("response", "error", "canceled")]
        return "\n".join([f"      {prefix}state {name} {{", *transitions, *ends, "      }"])

    def _goto(self) -> str:
        kept = f" do kept := {self._random.randint(0, 2)}" if self._random.random() < 0.2 else ""
        return kept + (f" goto {self._random.choice(self._states)}" if self._random.random() < 0.7 else "")

    def _requirement(self) -> str:
        command = self._random.choice(("level", "light", "go"))
        condition = self._condition(command, 2, "Base.")
        if self._random.random() < 0.3:
            return f"{condition} disables Base.{command}"
        return f"Base.{command} needs {condition}"

    def _condition(self, command: str, depth: int, owner: str = "") -> str:
        if depth > 0 and self._random.random() < 0.5:
            left, right = (self._condition(command, depth - 1, owner) for _ in range(2))
            return f"({left} {self._random.choice(('and', 'or', '=>'))} {right})"
        if self._random.random() < 0.35:
            place = self._random.choice((f"Base.{self._random.choice(self._states)}", "Person.near", "Person.far"))
            return self._random.choice(("", "!")) + place
        if command == "light":
            return self._random.choice(("value", "!value"))
        operator = self._random.choice(("<", "=", "!=", ">="))
        other = f"{owner}kept" if owner == "" and self._random.random() < 0.2 else str(self._random.randint(0, 2))
        return f"value {operator} {other}"
