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


def random_mixture(seed: int) -> str:
    """Return the text of such a robot with some other constructs: a fleet, a service, assumptions, orders and more."""
    return _Mixture(Random(seed)).text()  # noqa: S311 - the same robot on every run


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
            f"        on request to {command} if {self._condition(command, 1)}{self._goto(assigns=command == 'go')}"
            for command in ("level", "light", "go")
            for _ in range(self._random.choice((0, 1, 1, 2)))
        ]
        ends = [f"        on {end} from go{self._goto()}" for end in ("response", "error", "canceled")]
        return "\n".join([f"      {prefix}state {name} {{", *transitions, *ends, "      }"])

    def _goto(self, *, assigns: bool = True) -> str:
        """Return what a transition does; the request of a message assigns nothing."""
        kept = f" do kept := {self._random.randint(0, 2)}" if self._random.random() < 0.2 and assigns else ""
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


class _Mixture(_Draft):
    def text(self) -> str:
        cells = self._random.random() < 0.5
        parts = [self._cells() if cells else self._dock()]
        other = f"Cell[{self._random.randint(1, 2)}].enter" if cells else "dock"
        drawn = (self._automaton, self._assumption, self._order, self._reachable)
        parts += [draw(other) for draw in self._random.sample(drawn, self._random.randint(1, 3))]
        return super().text().rstrip().removesuffix("}") + "".join(f"  {part}\n" for part in parts) + "}\n"

    def _cells(self) -> str:
        number, condition = self._random.randint(0, 1), self._known()
        requirement = self._random.choice(
            (
                f"Station.enter needs value < 1 or {condition}",
                f"{condition} and value = 2 disables Station.enter",
                "Station.enter needs (count Station: Station.inside) < 1",
                "at most 1 Station.enter since response from seen",
            )
        )
        return f"""\
component Station(ns: string) {{
    incoming message enter with identifier: ns + "/enter", type: integer(0..2)
    outgoing message done with identifier: ns + "/done", type: none
    behaviour {{
      initial marked state outside {{ on request to enter if value > {number} goto inside }}
      state inside {{ on response from done goto outside on request to enter if value = 0 }}
    }}
  }}
  component Cell[1..2] is Station("/cell" + text(number))
  requirement each Station: {requirement}"""

    def _dock(self) -> str:
        reason, condition = self._random.choice(("timeout", "failed", "unreadable")), self._known()
        return f"""\
component Dock {{
    service dock with request: none, response: none
    behaviour {{
      initial marked state free {{ on request to dock goto busy }}
      state busy {{
        on response from dock goto free
        on error from dock if error {self._random.choice(("=", "!="))} {reason} goto broken
        on error from dock goto free
      }}
      state broken {{ on request to dock goto busy }}
    }}
  }}
  requirement dock needs {condition}"""

    def _automaton(self, other: str) -> str:
        conditions = [self._condition("level", 1, "Base.") for _ in range(2)]
        return f"""\
requirement Turns: automaton {{
    initial marked state mine {{ on request to Base.level if {conditions[0]} goto yours on request to {other} }}
    {self._random.choice(("", "marked "))}state yours {{ on request to Base.level if {conditions[1]} goto mine }}
  }}"""

    def _assumption(self, _other: str) -> str:
        return f"assume {self._random.choice(('seen', 'response from go'))} needs {self._known()} or {self._known()}"

    def _order(self, other: str) -> str:
        before, after = self._random.sample(("Base.light", "Base.level", other), 2)
        return "requirement " + self._random.choice(
            (f"{after} after {before}", f"{after} after each {before}", f"at most 2 {after} since response from seen")
        )

    def _reachable(self, _other: str) -> str:
        premise = self._random.choice(("", f" from {self._known()}"))
        return f"requirement reachable {self._known()}{premise}"

    def _known(self) -> str:
        place = self._random.choice((f"Base.{self._random.choice(self._states)}", "Person.near", "Base.kept > 0"))
        return f"{self._random.choice(('', '!'))}({place})"
