"""Random robots with services and actions that the controller serves."""

from __future__ import annotations

from random import Random

_SERVICE = ("request from", "response to")
_ACTION = ("request from", "cancel from", "feedback to", "response to", "error to", "canceled to")
_HEAD = """\
interface switch use SetBool from std_srvs
interface task use NavigateToPose from nav2_msgs
datatype object Switch { data: boolean }
datatype object Answer { success: boolean message: string }
datatype object Progress { number_of_recoveries: integer(0..3) }
component Button {
  outgoing message pressed with identifier: "/pressed", type: integer(0..3)
  incoming message beep with identifier: "/beep", type: none
  behaviour {
    variable level: integer(0..3) = 0
    initial marked state low { on response from pressed if value > 1 do level := value goto high }
    marked state high { on response from pressed do level := value goto low }
  }
}"""


class _Writer:
    def __init__(self, seed: int) -> None:
        self.random = Random(seed)  # noqa: S311  # reproducible
        #: Events that some transition names, of each communication.
        self.named: dict[str, set[str]] = {}

    def one(self, choices: list[str]) -> str:
        return self.random.choice(choices)

    def condition(self) -> str:
        """Return a condition on states that every component may read."""
        conditions = ["Button.high", "Button.level > 1", "C0.s0", "C1.s1", "C0.start0.running", "!C1.visit1.running"]
        joined = " or ".join(self.random.sample(conditions, self.random.randint(1, 2)))
        return f"({joined})"

    def robot(self) -> str:
        components = [self.component(number) for number in range(2)]
        statements = [statement for name in self.named for statement in self.statements(name)]
        if self.random.random() < 0.3:
            statements.append(f"requirement never {self.condition()} and Button.level = 3")
        statements.append(f"requirement beep needs {self.condition()}")
        return "\n".join(["robot Served {", _HEAD, *components, *statements, "}"])

    def statements(self, name: str) -> list[str]:
        """Return data for the answers of a service or an action, and requirements on them."""
        sent = sorted(event for event in self.named[name] if event.endswith(" to"))
        known, is_service = self.random.random() < 0.6, "start" in name
        statements = []
        if "response to" in sent and is_service and known:
            statements.append(f"provide {name} with {{ success: {self.one(['true', 'false'])} }} if {self.condition()}")
            statements.append(f"provide {name} with {{ success: true }}")
        if "feedback to" in sent and known:
            statements.append(f"provide feedback to {name} with {{ number_of_recoveries: Button.level }}")
        if "response to" in sent and self.random.random() < 0.5:
            value = " and value.success" if is_service and self.random.random() < 0.3 else ""
            statements.append(f"requirement {name} needs {self.condition()}{value}")
        if sent and self.random.random() < 0.3:
            event = f"{self.one(sent)} {name}"
            form = self.one(["{} after each request from {}", "at most 2 {} since request from {}"])
            statements.append("requirement " + form.format(event, name))
        return statements

    def component(self, number: int) -> str:
        """Return a component with a service and an action."""
        own = [(f"start{number}", _SERVICE), (f"visit{number}", _ACTION)]
        for name, _ in own:
            self.named[f"C{number}.{name}"] = set()
        states = []
        for index in range(self.random.randint(2, 3)):
            transitions = [
                transition
                for name, events in own
                for event in self.random.sample(events, self.random.randint(1, len(events)))
                for transition in self.transitions(f"C{number}.{name}", event)
            ]
            states += [f"{'initial ' * (index == 0)}marked state s{index} {{", *transitions, "}"]
        service, action = (name for name, _ in own)
        return "\n".join(
            [
                f"component C{number} {{",
                f"outgoing service {service} with request: Switch, response: Answer links switch",
                f"outgoing action {action} with request: none, response: none, feedback: Progress links task",
                "behaviour {",
                "variable asked: boolean = false",
                *states,
                "}",
                "}",
            ]
        )

    def transitions(self, name: str, event: str) -> list[str]:
        """Return one or two transitions on an event; the first of two has a condition."""
        self.named[name].add(event)
        is_request = event == "request from" and "start" in name
        conditions = ["asked", "!asked", self.condition(), *["value.data", "!value.data and Button.low"] * is_request]
        alternatives = [f" if {self.one(conditions)}"] * self.random.randint(0, 1)
        alternatives += [""] if not alternatives or self.random.random() < 0.3 else []
        change = " do asked := value.data" if is_request else self.one(["", "", " do asked := !asked"])
        return [
            f"on {event} {name.partition('.')[2]}{condition}{change}{self.one(['', ' goto s0', ' goto s1'])}"
            for condition in alternatives
        ]


def served_robot(seed: int) -> str:
    """Return the text of a random robot whose controller serves two services and two actions."""
    return _Writer(seed).robot()
