"""Random robots as text, over the whole language. All names resolve; the models have few mistakes, or none."""

from __future__ import annotations

from dataclasses import dataclass, field
from random import Random
from typing import Any

from robosc.model.semantics.naming import ROBOSC_KEYWORDS, escape_keyword

#: Names that are words of some language, look like generated names, or are equal after joining.
ODD_NAMES = (
    *("int", "class", "struct", "bool", "union", "namespace", "operator", "and_", "NULL", "main", "errno", "EOF"),
    *("plant", "event", "location", "edge", "marker", "min", "max", "controllable", "supervisor", "alg", "tau"),
    *("def", "self", "None", "True", "pass", "lambda", "hooks", "context", "inputs", "settings", "enabled", "perform"),
    *("c_tau1", "c_trigger", "u_response", "i_response", "d1", "idle", "ready", "message_m00", "component_C0", "data"),
    *("A", "b_c", "A_b", "c", "A__b", "_", "__x", "x_", "X", "T", "R", "Robot", *sorted(ROBOSC_KEYWORDS)),
)
COMPARED = ("=", "!=", "<", "<=", ">", ">=")
EVENTS = {
    "incoming": ("request",),
    "outgoing": ("response",),
    "service": ("request", "response", "error"),
    "action": ("request", "response", "error", "feedback", "cancel"),
}


@dataclass(frozen=True)
class Type:
    """A type: its text, and the properties of an object, the element of an array, the values and base of an enum."""

    text: str
    kind: str
    properties: tuple[tuple[str, Type], ...] = ()
    element: Type | None = None
    values: tuple[str, ...] = ()
    base: Type | None = None

    @property
    def is_finite(self) -> bool:
        """Whether the supervisor can represent the type."""
        return self.kind in {"boolean", "enum"} or (self.kind == "integer" and "(" in self.text)

    @property
    def is_of_ros(self) -> bool:
        return "/" in (self.base or self).text

    @property
    def needs_link(self) -> bool:
        return (self.base or self).kind == "object" and not self.is_of_ros

    @property
    def can_be_sent(self) -> bool:
        parts = [*(found_kind for _, found_kind in self.properties), *([self.element] if self.element else [])]
        return self.kind != "enum" and all(part.can_be_sent for part in parts)


BOOLEAN, DOUBLE, STRING, NONE = (Type(name, name) for name in ("boolean", "double", "string", "none"))
INTEGER = Type("integer", "integer")
RANGED = [Type(f"integer({low}..{high})", "integer") for low, high in ((0, 3), (-2, 2), (5, 5), (-9, -7))]
VECTOR = Type("Vector3", "object", tuple((name, DOUBLE) for name in "xyz"))
TWIST = Type("Twist", "object", (("linear", VECTOR), ("angular", VECTOR)))
#: Types that ROS defines, named in messages.
ROS_TYPES = [
    Type("geometry_msgs/Vector3", "object", VECTOR.properties),
    Type("geometry_msgs/Twist", "object", TWIST.properties),
    Type("sensor_msgs/LaserScan", "object", (("ranges", Type("array(double)", "array", element=DOUBLE)),)),
]
#: Interfaces: existing ones for some basic types, and `i` for all other types.
INTERFACES = (
    "interface i use Some from some_msgs",
    "interface i_boolean use Bool from std_msgs",
    "interface i_double use Float64 from std_msgs",
    "interface i_string use String from std_msgs",
    "interface i_none use Empty from std_msgs",
)


@dataclass
class Communication:
    name: str
    kind: str
    sent: Type = NONE
    data: dict[str, Type] = field(default_factory=dict)
    text: str = ""


@dataclass(frozen=True)
class Variable:
    """A variable. If the supervisor may need it, only finite data determine its value."""

    name: str
    type: Type
    may_be_needed: bool


@dataclass
class Component:
    """A component. For an imported one, `text` is the import."""

    name: str
    communications: list[Communication] = field(default_factory=list)
    variables: list[Variable] = field(default_factory=list)
    states: list[str] = field(default_factory=list)
    #: Unmarked states without incoming and outgoing transitions.
    apart: list[str] = field(default_factory=list)
    text: str = ""


class Writer:
    """Writer of one robot, with occasional mistakes on request."""

    def __init__(self, seed: int, *, mistakes: bool) -> None:
        self.random = Random(seed)  # noqa: S311 - nothing here is secret
        self.enums: list[Type] = []
        self.objects: list[Type] = []
        self.components: list[Component] = []
        self.mistakes = mistakes and self.random.randrange(10) == 0
        self.odd_names = self.random.sample(ODD_NAMES, len(ODD_NAMES) * self.random.randrange(3) // 2)

    def one(self, choices: Any) -> Any:
        return self.random.choice(list(choices))

    def many(self, most: int, least: int = 0) -> range:
        return range(self.random.randint(least, most))

    def maybe(self, text: str, chance: int = 2) -> str:
        return text if self.random.randrange(chance) == 0 else ""

    def name(self, plain: str) -> str:
        """Return a name that is unique in the robot."""
        return escape_keyword(self.odd_names.pop()) if self.odd_names and self.random.randrange(3) == 0 else plain

    def robot(self, name: str) -> str:
        imports = [self.imported(number) for number in self.many(2)]
        types = [self.data_type(number) for number in self.many(5)]
        for number in self.many(3, 1):
            self.declare(number)
        parts = [self.component(component) for component in self.components if not component.text]
        self.random.shuffle(parts)
        sent = [(c, m) for c in self.components for m in c.communications if m.kind != "outgoing"]
        parts += [self.requirement(sent) for _ in self.many(4) if sent]
        parts += [self.provide(*self.one(sent)) for _ in self.many(3) if sent]
        return "\n".join([f"robot {name} {{", *INTERFACES, *types, *imports, *parts, "}"])

    def imported(self, number: int) -> str:
        """Import a component of the standard library, often with changed topics."""
        component = Component(self.name(f"L{number}"))
        if self.one([True, True, False]):
            source = "from EmergencyStopLibrary import EmergencyStop"
            component.states = ["in_service", "stopped"]
            made = [Communication(name, "outgoing", data={"response": NONE}) for name in ("stop", "continue")]
        else:
            source = "from TurtlebotLibrary import TurtlebotPlatform"
            made = [Communication(name, "incoming", sent=TWIST) for name in ("move", "halt")]
            if VECTOR not in self.objects:
                self.objects.append(VECTOR)
        topics = ", ".join(f'{communication.name}: "/l{number}/{communication.name}"' for communication in made)
        component.communications = made
        component.text = f"component {component.name} {source}{self.maybe(f' with {{ {topics} }}')}"
        self.components.append(component)
        return component.text

    def reference(self, component: Component, communication: Communication) -> str:
        """Return a reference to a communication; names of several instances need the name of the component."""
        names = [communication.name for c in self.components for communication in c.communications]
        if names.count(communication.name) == 1 and self.one([True, True, False]):
            return communication.name
        return f"{component.name}.{communication.name}"

    # Types

    def simple(self) -> Type:
        return self.one([BOOLEAN, DOUBLE, STRING, INTEGER, *RANGED])

    def data_type(self, number: int) -> str:
        if self.one("eo") == "o":
            properties = []
            for index in self.many(3, 1):
                kind = self.one([self.simple(), *self.enums, *self.objects])
                for _ in self.many(2):
                    kind = self.one([kind, Type(f"array({kind.text})", "array", element=kind)])
                properties.append((self.name(f"p{index}"), kind))
            self.objects.append(Type(self.name(f"O{number}"), "object", tuple(properties)))
            text = " ".join(f"{name}: {kind.text}" for name, kind in properties)
            return f"datatype object {self.objects[-1].text} {{ {text} }}"
        base = self.one([self.simple(), *self.objects, *self.objects, self.one(ROS_TYPES)])
        values = tuple(self.name(f"v{number}{index}") for index in self.many(3, 1))
        reads = paths("value", base)
        rules = [f"{self.expression(BOOLEAN, reads, 2)} -> {value}" for value in values[1:]]
        rules.insert(self.random.randint(0, len(rules)), f"default -> {values[0]}")
        self.enums.append(Type(self.name(f"E{number}"), "enum", values=values, base=base))
        return f"datatype enum {self.enums[-1].text} from {base.text} to {{ {' '.join(rules)} }}"

    # Components

    def carried(self, kind: str) -> Type:
        choices = [NONE, self.simple(), *self.enums, *self.enums, *self.objects, *self.objects]
        if kind == "outgoing":
            return self.one([*choices, self.one(ROS_TYPES)])
        return self.one([choice for choice in choices if not choice.is_of_ros])

    def declare(self, number: int) -> None:
        component = Component(self.name(f"C{number}"))
        for index in self.many(3):
            kind = self.one(EVENTS)
            made = Communication(self.name(f"m{number}{index}"), kind)
            topic = self.maybe('identifier: "/shared", ', 4)
            if "_" in made.name:  # Some names are invalid in topics.
                topic = f'identifier: "/t{number}/m{index}", '
            name = f"{made.name} with {topic}"
            if kind == "outgoing":
                made.data = {"response": self.carried(kind)}
                made.text = f"outgoing message {name}type: {made.data['response'].text}"
            else:
                choices = [NONE, self.simple(), *self.objects, *(ROS_TYPES[:2] if kind == "incoming" else [])]
                made.sent = self.one([choice for choice in choices if choice.can_be_sent])
                made.data = {event: self.carried(kind) for event in ("response", "feedback") if event in EVENTS[kind]}
                rest = "".join(f", {event}: {found_kind.text}" for event, found_kind in made.data.items())
                word = "type" if kind == "incoming" else "request"
                head = "incoming message" if kind == "incoming" else kind
                made.text = f"{head} {name}{word}: {made.sent.text}{rest}"
            types = [made.sent, *made.data.values()]
            basic = kind in {"incoming", "outgoing"} or (kind == "service" and set(types) == {NONE})
            if not basic or any(kind.needs_link for kind in types):
                made.text += " links i"
                if kind in {"incoming", "outgoing"}:
                    made.text = made.text.replace("/shared", "/shared/i")
            elif kind in {"incoming", "outgoing"}:
                carried = {"incoming": made.sent, "outgoing": made.data.get("response", NONE)}[kind]
                wire = carried.base or carried
                if wire.kind != "object":
                    made.text += self.maybe(f" links {'i' if wire.kind == 'integer' else f'i_{wire.kind}'}", 5)
                # A topic has one type.
                link = made.text.partition(" links ")[2]
                made.text = made.text.replace("/shared", f"/shared/{link or wire.text.partition('(')[0]}")
            component.communications.append(made)
        if self.random.randrange(6) == 0:
            self.components.append(component)
            return  # The component has no behavior.
        for index in self.many(4):
            kind = self.one([self.simple(), *RANGED, BOOLEAN, *self.enums])
            may_be_needed = kind.is_finite and self.one([True, True, False])
            component.variables.append(Variable(self.name(f"x{number}{index}"), kind, may_be_needed))
        component.states = [self.name(f"s{number}{index}") for index in self.many(3, 1)]
        component.apart = [self.name(f"t{number}")] * (self.random.randrange(3) == 0)
        self.components.append(component)

    def component(self, component: Component) -> str:
        lines = [communication.text for communication in component.communications]
        if not component.states:
            return "\n".join([f"component {component.name} {{", *lines, "}"])
        body = [
            f"variable {variable.name}: {variable.type.text}{self.initial(variable.type)}"
            for variable in component.variables
        ]
        free = [(c, m, event) for c in self.components for m in c.communications for event in EVENTS[m.kind]]
        common = [candidate for candidate in free if self.random.randrange(6) == 0]
        body += [self.transition(component, *candidate) for candidate in common]
        body += [self.silent(component, self.goto(component)) for _ in self.many(1)]
        body += [self.timed(component, everywhere=True)] * (self.random.randrange(6) == 0)
        marked = [state for state in component.states if self.one([True, False])] or component.states[-1:]
        for index, state in enumerate(component.states):
            own = [candidate for candidate in free if candidate not in common and self.random.randrange(4) == 0]
            inside = [self.transition(component, *candidate) for candidate in own]
            inside += [self.silent(component, self.goto(component)) for _ in self.many(2)]
            inside += [self.timed(component) for _ in self.many(2) if self.random.randrange(3) == 0]
            if state not in marked:
                inside.append(self.silent(component, f" goto {self.one(marked)}"))
            kinds = ["initial "] * (index == 0) + ["marked "] * (state in marked)
            self.random.shuffle(kinds)
            body.append(f"{''.join(kinds)}state {state} {{ {' '.join(inside)} }}")
        body += [f"state {state} {{ }}" for state in component.apart]
        self.random.shuffle(body)
        return "\n".join([f"component {component.name} {{", *lines, "behaviour {", *body, "}", "}"])

    def initial(self, kind: Type) -> str:
        if kind in RANGED:
            low, high = kind.text[8:-1].split("..")
            return self.maybe(f" = {self.one([low, high])}")
        return self.maybe(f" = {self.expression(kind, [], 2)}")

    def transition(self, component: Component, owner: Component, communication: Communication, event: str) -> str:
        reads = paths("value", communication.data.get(event, NONE))
        assigned = self.assigned(component, reads) if (communication.kind, event) != ("incoming", "request") else ""
        word = self.one(["to", "from"])
        return f"on {event} {word} {self.reference(owner, communication)}{assigned}{self.goto(component)}"

    def silent(self, component: Component, goto: str) -> str:
        guard = self.maybe(f" if {self.expression(BOOLEAN, self.readable(finite=True), 3)}")
        return f"transition{guard}{self.assigned(component, [])}{goto}"

    def timed(self, component: Component, *, everywhere: bool = False) -> str:
        """Return a timed transition. Outside of states it needs a silent message, and is empty if there is none."""
        messages = [(owner, found) for owner in self.components for found in owner.communications]
        heard = [self.reference(owner, found) for owner, found in messages if found.kind == "outgoing"]
        if everywhere and not heard:
            return ""
        named = self.random.sample(heard, min(len(heard), self.random.randrange(everywhere, 3)))
        without = f" without {', '.join(named)}" if named else ""
        time = self.one(["1 ms", "0.5 s", "2 min", "(1 + 2) * 3 s", "24 * 24 * 60 min"])
        return f"after {time}{without}{self.assigned(component, [])}{self.goto(component)}"

    def goto(self, component: Component) -> str:
        return self.maybe(f" goto {self.one(component.states)}")

    def assigned(self, component: Component, data: list[tuple[str, Type]]) -> str:
        done = []
        for variable in component.variables:
            if self.one([True, False]):
                finite = variable.may_be_needed and not self.mistakes
                fitting = [(text, kind) for text, kind in data if not finite or (kind.is_finite and "[" not in text)]
                value = self.expression(variable.type, [*fitting, *self.readable(finite=finite)], 3)
                done.append(f"{variable.name} := {value}")
        return f" do {', '.join(done)}" if done else ""

    # Requirements and data

    def requirement(self, sent: list[tuple[Component, Communication]]) -> str:
        condition = self.expression(BOOLEAN, self.readable(finite=True), 3)
        named = [self.reference(*self.one(sent)) for _ in self.many(2, 1)]
        target = f"{{ {', '.join(named)} }}" if len(named) > 1 else named[0]
        anchor = self.reference(*self.one(sent))
        text = self.maybe(' "why"')
        heading = self.maybe(f"R{self.random.randrange(10**6)}{text}: ", 4)
        often = [f"{target} needs {condition}", f"{condition} disables {target}"]
        seldom = [
            f"never {condition}",
            f"always {condition}",
            f"reachable {condition}{self.maybe(f' from {condition}')}",
            f"{target} after {self.maybe('each ')}{anchor}",
            f"at most {self.random.randint(1, 4)} {target} since {anchor}",
            f"automaton {{ initial state a {{ on {anchor} if {condition} goto b }} state b {{ on {anchor} goto a }} }}",
        ]
        said = self.one([*often * 3, *seldom])
        claimed = f"property reachable {condition}{self.maybe(f' from {condition}')}"
        return f"requirement {heading}{said} {self.maybe(claimed, 6)}"

    def provide(self, component: Component, communication: Communication) -> str:
        if communication.sent == NONE:
            return ""
        data = self.provided(communication.sent)
        condition = self.maybe(f" if {self.expression(BOOLEAN, self.readable(finite=True), 3)}")
        return f"provide {self.reference(component, communication)} with {data}{condition}"

    def provided(self, kind: Type) -> str:
        if kind.kind == "object":
            given = [
                declared for declared in kind.properties if declared[1].kind != "array" and self.one([True, False])
            ]
            return "{ " + ", ".join(f"{name}: {self.provided(inner)}" for name, inner in given) + " }"
        return self.expression(kind, self.readable(finite=False), 2, constant=kind not in RANGED)

    # Expressions

    def readable(self, *, finite: bool) -> list[tuple[str, Type]]:
        """Return everything that a full name can refer to, with its type."""
        states = [(f"{c.name}.{state}", BOOLEAN) for c in self.components for state in (*c.states, *c.apart)]
        variables = [
            (f"{c.name}.{variable.name}", variable.type)
            for c in self.components
            for variable in c.variables
            if not finite or self.mistakes or variable.may_be_needed
        ]
        return states + variables

    def expression(self, kind: Type, reads: list[tuple[str, Type]], depth: int, *, constant: bool = True) -> str:
        """Return an expression of a type; without `constant` it reads something, if possible."""
        alike = [
            text
            for text, found_kind in reads
            if found_kind.kind == kind.kind and (kind.kind != "enum" or found_kind == kind)
        ]
        leaf = self.one([*alike, *alike, *(self.literals(kind) if constant or not alike else [])])
        if depth == 0 or self.one([True, False, False]):
            return leaf
        operand = [self.expression(kind, reads, depth - 1) for _ in range(2)]
        match kind.kind:
            case "boolean":
                return self.boolean(reads, depth, *operand)
            case "integer" if leaf in alike:
                return self.one([f"{leaf} {self.one('+-*')} {operand[0]}", f"-({leaf})"])
            case "double":
                other = self.expression(INTEGER, reads, depth - 1)
                mixed = [f"{operand[0]} {self.one('+-*/')} {other}", f"({other}) / {operand[1]}", f"-{leaf}"]
                return self.one([f"({operand[0]} {self.one('+-*')} {operand[1]})", *mixed])
        return leaf

    def boolean(self, reads: list[tuple[str, Type]], depth: int, left: str, right: str) -> str:
        comparable = [found_kind for _, found_kind in reads if found_kind.kind not in {"object", "array", "none"}]
        kind = self.one([*comparable, INTEGER, DOUBLE, BOOLEAN, *self.enums])
        first, second = (self.expression(kind, reads, depth - 1) for _ in range(2))
        symbol = self.one(COMPARED if kind.kind in {"integer", "double"} else COMPARED[:2])
        logical = [f"{left} {self.one(['and', 'or', '=>'])} ({right})", f"!({left})"]
        return self.one([*logical, f"(({first}) {symbol} {second})"])

    def literals(self, kind: Type) -> list[str]:
        known = {"boolean": ["true", "false"], "double": ["0.5", "-2.0"], "string": ['"a"', "'b'"], "enum": kind.values}
        if kind in RANGED:
            return list(kind.text[8:-1].split(".."))
        return list(known.get(kind.kind, ["0", "2", "-1"]))


def paths(start: str, kind: Type) -> list[tuple[str, Type]]:
    """Return all readable parts of data with their types."""
    if kind.element is not None:
        return paths(f"{start}[{len(start) % 4}]", kind.element)
    return [(start, kind), *(read for name, inner in kind.properties for read in paths(f"{start}.{name}", inner))]


def random_robot(seed: int, name: str = "R", *, mistakes: bool = True) -> str:
    """Return the text of a robot, equal for equal seeds, and without errors unless mistakes are requested."""
    return Writer(seed, mistakes=mistakes).robot(name)
