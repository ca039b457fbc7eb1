"""Random robots with the constructs of the language's second edition."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING

from tests.random_robots import (
    BOOLEAN,
    COMPARED,
    DOUBLE,
    INTEGER,
    NONE,
    Communication,
    Component,
    Type,
    Variable,
    Writer,
    paths,
)

if TYPE_CHECKING:
    from collections.abc import Callable

_NAMED = (
    "constant k0: integer = 1 + 1",
    "constant k1: double = 0.5 * 2",
    "constant k2: boolean = k0 > 3",
    "function f0(a: integer, b: integer): integer = if a > b then a - b else k0",
    "function f1(a: boolean): boolean = !a or k2",
    "function f2(a: double, b: integer): double = if a > b then a / 2 else -a + k1",
    "function f3(a: boolean, b: integer): boolean = if f1(a) then f0(b, k0) > 0 else f1(b = 1)",
)
#: Functions and the types of their parameters, by the kind of the result.
_CALLS = {
    "integer": (("f0", INTEGER, INTEGER),),
    "boolean": (("f1", BOOLEAN), ("f3", BOOLEAN, INTEGER)),
    "double": (("f2", DOUBLE, INTEGER),),
}


class SecondWriter(Writer):
    """Writer of named values and conditions, templates, alternatives, times, and requirements on states and orders."""

    def __init__(self, seed: int) -> None:
        super().__init__(seed, mistakes=False)
        self.seed = seed
        self.constants = [("k0", INTEGER), ("k1", DOUBLE), ("k2", BOOLEAN)]
        self.conditions: list[str] = []
        self.templates: list[str] = []
        #: States of requirement automata, which only requirements and properties may read.
        self.turns: list[tuple[str, Type]] = []
        self.grips = False

    def robot(self, name: str) -> str:
        head, *lines, end = super().robot(name).split("\n")
        sent = [(c, m) for c in self.components for m in c.communications if m.kind != "outgoing"]
        lines += [self.automaton(number, sent) for number in self.many(2) if sent]
        finite = [*self.readable(finite=True), *self.turns, *self.turns]
        for number in self.many(2):
            condition = self.expression(BOOLEAN, finite, 2)
            lines.append(f"condition q{number} = {condition}")
            self.conditions.append(f"q{number}")
        for number in self.many(2):
            lines.append(self.one([self.invariant, self.order])(number, sent))
        if self.conditions and sent:
            target = self.reference(*self.one(sent))
            lines.append(
                f"requirement N: {target} needs {self.one(self.conditions)} or {self.expression(BOOLEAN, finite, 2)}"
            )
        return "\n".join([head, *_NAMED, *lines, *self.templates, *kept(self.seed), end])

    def imported(self, number: int) -> str:
        """Sometimes import a template of a library instead."""
        if self.one([True, True, False]):
            return super().imported(number)
        tries = self.one(["", ", 2", ", tries: k0"])
        component = Component(
            f"G{number}",
            [
                Communication("gripped", "outgoing", data={"response": BOOLEAN}),
                Communication("grip", "incoming", sent=INTEGER),
            ],
            [Variable("times", INTEGER, may_be_needed=True)],
            ["open", "closing"],
        )
        topic = self.maybe(f' with {{ grip: "/l{number}/grip" }}')
        component.text = f'component G{number} from GripperLibrary import Gripper("/g{number}"{tries}){topic}'
        self.components.append(component)
        self.conditions.append(f"G{number}.tired")
        if not self.grips:
            self.conditions.append(f"({self.one(['all', 'any'])} Gripper: Gripper.{self.one(['open', 'times > 1'])})")
            self.conditions.append(f"(count Gripper: Gripper.closing) {self.one(COMPARED)} 1")
        self.grips = True
        return component.text

    def automaton(self, number: int, sent: list[tuple[Component, Communication]]) -> str:
        """Return a requirement automaton with readable states. It forbids requests, but no responses."""
        states = "abc"[: self.one([2, 3])]
        chosen = self.random.sample(sent, min(len(sent), self.random.randint(1, 2)))
        requests = [self.reference(*found) for found in chosen]
        answers = [self.reference(c, m) for c in self.components for m in c.communications if "response" in m.data]
        answers = self.random.sample(answers, min(len(answers), self.random.randrange(2)))
        known = [*self.readable(finite=True), *self.turns]
        self.turns += [(f"T{number}.{state}", BOOLEAN) for state in states]
        made = []
        for index, state in enumerate(states):
            after = states[(index + 1) % len(states)]
            inside = [f"on request to {requests[0]} goto {after}"] if index == 0 else []
            for event in requests[1 if index == 0 else 0 :]:
                guard = self.maybe(f" if {self.expression(BOOLEAN, known, 2)}")
                inside.append(f"on {self.one(['request to ', ''])}{event}{guard}{self.maybe(f' goto {after}')}")
            for event in answers:
                condition = self.expression(BOOLEAN, known, 1)
                inside += [f"on response from {event} if {condition} goto {after}"] * (self.random.randrange(2))
                inside.append(f"on response from {event}{self.maybe(f' goto {states[0]}')}")
            kinds = f"{'initial ' * (index == 0)}{self.maybe('marked ', 3)}"
            made.append(f"{kinds}state {state} {{ {' '.join(inside)} }}")
        return f"requirement T{number}{self.maybe(chr(34) + 'in turns' + chr(34), 3)}: automaton {{ {' '.join(made)} }}"

    def declare(self, number: int) -> None:
        super().declare(number)
        if self.random.randrange(3) == 0:
            self.template(number)

    def template(self, number: int) -> None:
        """Add a component with parameters and several instances of it."""
        name = f"Made{number}"
        made = [
            Communication(f"bump{number}", "outgoing", data={"response": NONE}),
            Communication(f"lamp{number}", "incoming", sent=BOOLEAN),
            Communication(f"far{number}", "outgoing", data={"response": DOUBLE}),
        ]
        self.templates.append(
            f"component {name}(topic: string, most: integer(1..3), step: integer = 1, limit: double = -k1 * 2) {{\n"
            f'outgoing message bump{number} with identifier: topic + "/bump", type: none\n'
            f'incoming message lamp{number} with identifier: topic + "/lamp", type: boolean\n'
            f'outgoing message far{number} with identifier: topic + "/far", type: double\n'
            f"condition full = times >= most\nprovide lamp{number} with full\nbehaviour {{\n"
            "variable times: integer(0..most + 1)\n"
            f"on response from far{number} if value > limit or f2(value, most) < limit * 2 do times := 0\n"
            f"initial marked state up {{ on response from bump{number} if full do times := 0"
            f" on response from bump{number} do times := times + step goto off }}\n"
            f"state off {{ transition if times > step goto up on request to lamp{number} goto up }}\n}}\n}}"
        )
        for index in self.many(2, 1):
            component = Component(
                f"{name}I{index}", list(made), [Variable("times", INTEGER, may_be_needed=True)], ["up", "off"]
            )
            given = self.one(
                ["1", "2", "3", "k0 - 1, k0", "most: 1 + 1, limit: k1 * 3", "3, 1, 0.25 + k1", "2, limit: k1"]
            )
            component.text = f'component {component.name} is {name}("/{name.lower()}{index}", {given})'
            self.templates.append(component.text)
            self.components.append(component)
        word = self.one(["all", "any"])
        self.conditions.append(f"({word} {name}: {name}.{self.one(['off', 'times > 1', 'full'])})")
        self.conditions.append(f"(count {name}: {name}.up) {self.one(['<', '>='])} {self.one('12')}")

    def transition(self, component: Component, owner: Component, communication: Communication, event: str) -> str:
        """Return several transitions, tried in order."""
        last = super().transition(component, owner, communication, event)
        data = paths("value", communication.data.get(event, NONE))
        made = []
        for _ in self.many(2):
            guard = self.guard(data)
            plain = super().transition(component, owner, communication, event)
            head = f"on {event} {plain.split(' ')[2]} {plain.split(' ')[3]}"
            made.append(f"{head} if {guard}{plain.removeprefix(head)}")
        return " ".join([*made, *([last] if not made or self.one([True, False]) else [])])

    def guard(self, data: list[tuple[str, Type]]) -> str:
        """Return a condition over data, over the supervisor's knowledge, or over both."""
        known = self.expression(BOOLEAN, self.readable(finite=True), 2)
        told = self.expression(BOOLEAN, [read for read in data if "[" not in read[0]], 2)
        return self.one([known, f"({told})", f"({known}) {self.one(['and', 'or'])} ({told})"])

    def invariant(self, number: int, _sent: list[tuple[Component, Communication]]) -> str:
        read = [*self.readable(finite=True), *self.turns, *self.turns]
        condition = self.expression(BOOLEAN, read, 2)
        named = self.one([f"I{number}: ", f'I{number} "as it is": ', ""])
        if self.random.randrange(4) == 0:
            kind = self.one(["requirement", "property"])
            return f"{kind} {named}reachable {condition}{self.maybe(f' from {self.expression(BOOLEAN, read, 1)}')}"
        return f"{self.one(['requirement', 'property'])} {named}{self.one(['never', 'always'])} {condition}"

    def order(self, number: int, sent: list[tuple[Component, Communication]]) -> str:
        others = [
            (c, m, event)
            for c in self.components
            for m in c.communications
            for event in ("response",)
            if event in m.data
        ]
        if not sent or not others:
            return ""
        left = self.reference(*self.one(sent))
        owner, communication, event = self.one(others)
        right = f"{event} from {self.reference(owner, communication)}"
        return self.one(
            [
                f"requirement O{number}: {left} after {right}",
                f"requirement {left} after each {right}",
                f"requirement at most {self.one('12')} {left} since {right}",
            ]
        )

    def expression(self, kind: Type, reads: list[tuple[str, Type]], depth: int, *, constant: bool = True) -> str:
        if depth > 0 and self.random.randrange(6) == 0:
            condition = super().expression(BOOLEAN, reads, depth - 1)
            then, other = (
                super(SecondWriter, self).expression(kind, reads, depth - 1, constant=constant) for _ in range(2)
            )
            return f"(if {condition} then {then} else {other})"
        if depth > 0 and self.random.randrange(6) == 0:
            made = self.call(kind, reads, depth)
            if made is not None:
                return made
        return super().expression(kind, reads, depth, constant=constant)

    def call(self, kind: Type, reads: list[tuple[str, Type]], depth: int) -> str | None:
        """Return a call of a function. A call with an integer result reads a variable, so that it is no constant."""
        alike = [text for text, found in reads if found.kind == "integer"]
        calls = _CALLS.get(kind.kind, ())
        if not calls or (kind.kind == "integer" and not alike):
            return None
        name, *parameters = self.one(calls)
        given = [self.expression(parameter, reads, depth - 1) for parameter in parameters]
        if kind.kind == "integer":
            given[0] = self.one(alike)
        return f"{name}({', '.join(given)})"

    def literals(self, kind: Type) -> list[str]:
        named = [name for name, found in self.constants if found == kind]
        return [*super().literals(kind), *named]


def kept(seed: int) -> list[str]:
    """For half of the seeds, return a component that stores and sends arrays and objects, with parameters and times."""
    random = Random(seed)  # noqa: S311 - nothing here is secret
    if random.random() < 0.5:
        return []

    def one(*choices: str) -> str:
        return random.choice(choices)

    index = one("0", "k0", "size(value.poses) - 1", "mod(k0, 2)")
    number = one(
        "value.position[0]", "max(value.position)", "min(value.position[0..k0])", "double(keptNext) + keptReach"
    )
    whole = one("floor", "ceil", "round")
    numbers = one("value.position", "value.position[k0..3]", "value.position[0..size(value.name)]")
    body = one(
        "r < keptReach", "abs(r) > sqrt(2.0)", "any s in value.effort: s < r", "sin(r) < cos(r) or atan2(r, 1.0) > 0.0"
    )
    names = one("any n in value.name: size(n) > 2", 'count n in value.name: n = "a"', "size(value.name)")
    counted = names if not names.startswith("any") else f"(if {names} then 1 else 0)"
    limit = one("k1", "0.25, 1", "0.5, where: k0", "keptReach")
    needed = one("Kept.keptSome", "Kept.ahead = keptClear", "abs(Kept.keptNext - 1) < max(k0, 1)")
    change = one(", send: change", "")
    chosen = f"if {needed} then {{ poses: Kept.route[0..1] }} else {one('Kept.path', '{}')}"
    sums = f"if Kept.level < keptReach then [] else {one('[Kept.level]', 'Kept.joints.position')}"
    provided = [
        f"provide keptGo with {{ pose: Kept.route[{one('0', 'Kept.keptNext', 'size(Kept.route) - 1')}].pose }}",
        f"provide keptAgain with {one('{ poses: Kept.route }', chosen, 'Kept.path')}",
        f"provide keptSums with {{ data: {one('[1.0, Kept.level]', sums, 'Kept.joints.position')} }}",
    ]
    return [
        "// How far it looks.",
        f"parameter keptReach: double(0.1..5.0) = {one('0.5', 'k1')}",
        f"parameter keptPause: integer(1..60) = {one('1', 'k0')}",
        "function keptGain(d: double): double = if d < keptReach then 0.1 else min(keptReach, d / 2)",
        *nested(one),
        "datatype enum KeptAhead(limit: double, where: integer = 0) from sensor_msgs/LaserScan to {",
        "value.ranges[where] < limit -> keptNear",
        f"{one('all', 'any')} r in value.ranges[0..where]: r < limit -> keptNear default -> keptClear }}",
        "component Kept {",
        'outgoing message keptRoute with identifier: "/kept/route", type: nav_msgs/Path',
        'outgoing message keptJoints with identifier: "/kept/joints", type: sensor_msgs/JointState',
        f'outgoing message keptScan with identifier: "/kept/scan", type: KeptAhead({limit})',
        f'incoming message keptGo with identifier: "/kept/go", type: geometry_msgs/PoseStamped{change}',
        'incoming message keptAgain with identifier: "/kept/again", type: nav_msgs/Path',
        'incoming message keptSums with identifier: "/kept/sums", type: std_msgs/Float64MultiArray, send: change',
        "behaviour {",
        "variable route: array(geometry_msgs/PoseStamped) variable path: nav_msgs/Path",
        "variable joints: sensor_msgs/JointState variable level: double variable rounded: integer",
        "variable keptNext: integer(0..k0 + 1) variable ahead: KeptAhead = KeptAhead.keptNear",
        "on response from keptScan do ahead := value",
        f"on response from keptJoints if {one('all', 'any')} r in {numbers}: {body}",
        f"do level := {one(number, f'keptGain({number})')}, rounded := {whole}(level * {one('1.5', '-0.5')}),",
        f"keptNext := {counted}",
        f"on response from keptJoints if keptNext > 0 do joints := value{one('', ', keptNext := keptNext - 1')}",
        "initial marked state keptNone {",
        f"on response from keptRoute if size(value.poses) > k0 or value.poses[{index}].pose.position.x > keptReach",
        f"do route := value.poses{one('', '[0..k0]', '[1..size(value.poses) - 1]')}, path := value goto keptSome }}",
        "state keptSome {",
        f"after {one('keptPause s', 'k0 min', 'k1 s without keptJoints, keptScan')} goto keptNone }}",
        "}",
        "}",
        f"requirement keptGo needs {needed}",
        one("requirement at most k0 keptAgain since keptRoute", "requirement keptAgain after each keptJoints", ""),
        *random.sample(provided, random.randint(1, 3)),
    ]


def nested(choose: Callable[..., str]) -> list[str]:
    """Return a component that stores nested objects of its own data types, as a whole and in parts."""
    place = choose("0", "nestAt", "size(value.list) - 1", "mod(nestAt, 2)")
    read = choose(
        "outer.list[nestAt].deep.known",
        "any i in list: i.deep.known or (any t in i.tags: t > nestAt)",
        "all t in inner.tags: t = k0 or inner.deep.known",
        "size(outer.inner.deep.name) > size(outer.list)",
    )
    given = choose("outer", "{ inner: Nest.inner, list: Nest.list }", "{ list: Nest.outer.list[0..Nest.nestAt] }")
    whole = "Nest.outer" if given == "outer" else given
    parts = choose(
        "Nest.inner.deep",
        "if Nest.nestSaw then Nest.outer.list[Nest.nestAt].deep else { known: true }",
        "{ name: Nest.deep.name, known: Nest.nestSaw }",
    )
    return [
        "datatype object NestDeep { known: boolean name: string }",
        "datatype object NestInner { x: double tags: array(integer) deep: NestDeep }",
        "datatype object NestOuter { inner: NestInner list: array(NestInner) }",
        "component Nest {",
        'outgoing message nestTold with identifier: "/nest/told", type: NestOuter links i',
        'outgoing message nestIndex with identifier: "/nest/index", type: integer(0..2)',
        'service nestAsked with identifier: "/nest/asked", request: NestDeep, response: NestInner links i',
        f'incoming message nestOut with identifier: "/nest/out", type: NestOuter{choose("", ", send: change")} links i',
        "behaviour {",
        "variable outer: NestOuter variable inner: NestInner variable deep: NestDeep variable list: array(NestInner)",
        "variable nestAt: integer(0..2) variable nestSaw: boolean variable nestSum: double",
        f"on response from nestTold do outer := value, inner := value.list[{place}], list := outer.list",
        "on response from nestIndex do nestAt := value",
        "initial marked state nestIdle { on request to nestAsked goto nestBusy }",
        "state nestBusy {",
        f"on response from nestAsked if value.deep.known do inner := value, deep := value.deep, nestSaw := {read}",
        "goto nestIdle",
        "on response from nestAsked do deep := inner.deep, nestSum := max(inner.x, value.x) goto nestIdle",
        "on error from nestAsked goto nestIdle }",
        "} }",
        f"provide nestOut with {whole}",
        f"provide nestAsked with {parts}",
    ]


def second_edition_robot(seed: int, name: str = "R") -> str:
    """Return the text of a robot without errors, equal for equal seeds."""
    return SecondWriter(seed).robot(name)
