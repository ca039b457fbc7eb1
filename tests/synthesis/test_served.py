"""Served services and actions: symbolic synthesis and its findings against the definition, on random robots."""

from random import Random

import pytest

import robosc
from robosc.analysis.supervise import supervise
from robosc.model import sct
from robosc.synthesis import synthesize
from tests.synthesis.oracle import Oracle, reaching
from tests.synthesis.test_against_oracle import check

HEAD = """robot Served {
  interface inspection use Fibonacci from example_interfaces
  datatype object Area { order: integer(0..3) }
  component Desk {
    outgoing service start with request: none, response: none
    outgoing action inspect with request: Area, response: none, feedback: none links inspection
    outgoing message fault with type: none
    incoming message move with type: none
  }
"""
STATES = ("Left.a", "Left.b", "Right.a", "Right.b", "Desk.inspect.running", "Desk.start.running", "Left.n > 1")


def component(name: str, random: Random) -> str:
    """Return a component with two states, both of which may react to each event."""

    def to(state: str) -> str:
        return random.choice(["", " goto a", " goto b", f" goto {state}"])

    lines = [f"component {name} {{ behaviour {{ variable n: integer(0..3) = 0"]
    answers = random.sample(
        ["response to Desk.start", "response to Desk.inspect", "error to Desk.inspect", "feedback to Desk.inspect"], 3
    )
    answers += random.sample(["cancel from Desk.inspect", "canceled to Desk.inspect"], random.randrange(2))
    for state, other in (("a", "b"), ("b", "a")):
        lines.append(f"{'initial ' * (state == 'a')}marked state {state} {{")
        guard = random.choice([" if value.order > 1", " if value.order < 2", " if value.order = n", ""])
        if random.randrange(3):
            lines.append(f"on request from Desk.inspect{guard} do n := value.order{to(other)}")
        lines += [f"on {answer}{to(other)}" for answer in answers if random.randrange(3)]
        lines.append(f"on response from Desk.fault{to(other)}")
        if random.randrange(2):
            lines.append(f"on request to Desk.move goto {other}")
        if random.randrange(2):
            lines.append(f"on request from Desk.start{to(other)}")
        lines.append("}")
    return "\n".join([*lines, "}}"])


def robot(seed: int) -> str:
    random = Random(seed)  # noqa: S311 - a test is no secret
    lines = [component(name, random) for name in ("Left", "Right")]
    text = "\n".join(lines)
    targets = ["Desk.move", *(f"Desk.{name}" for name in ("start", "inspect") if f"response to Desk.{name}" in text)]
    for _ in range(2):
        condition = " or ".join(random.sample(STATES, 2))
        lines.append(f"requirement {random.choice(targets)} needs {condition}")
    lines.append(f"requirement never {' and '.join(random.sample(STATES, 3))}")
    return "\n".join([HEAD, *lines, "}"])


def model_of(seed: int) -> sct.SupervisoryControlModel:
    base = robosc.load(text=robot(seed))
    assert [finding for finding in robosc.check(base) if finding.severity.name == "ERROR"] == []
    return robosc.to_sct(base)


@pytest.mark.parametrize("seed", range(16))
def test_synthesis_and_findings(seed: int) -> None:
    model = model_of(seed)
    check(model, synthesize(model))
    oracle = Oracle(model)
    if not oracle.controlled:
        return
    found = {finding.rule for finding in supervise(model).findings}
    assert ("goal-never-ends" in found) == any(endless(oracle, plant) for plant in served(model))
    [request] = [event for plant in served(model) for event in plant.events if event.name == "u_request"][1:]
    assert ("goal-rejected" in found) == (not any(oracle.enabled(request, state) for state in oracle.controlled))


def served(model: sct.SupervisoryControlModel) -> list[sct.Plant]:
    return [plant for plant in model.plants if plant.kind in (sct.PlantKind.serviceServer, sct.PlantKind.actionServer)]


def endless(oracle: Oracle, plant: sct.Plant) -> bool:
    """Return whether a controlled state reaches none in which a served communication is idle."""
    following = {
        state: [
            (event, after)
            for event in oracle.events
            if not event.controllable or oracle.allows(event, state)
            for after in oracle.successors(event, state)
        ]
        for state in oracle.controlled
    }
    place = oracle.places[plant]
    return oracle.controlled != reaching(oracle.controlled, following, lambda state: state[place].name == "idle")


def test_random_robots_differ() -> None:
    empty = [not Oracle(model_of(seed)).controlled for seed in range(16)]
    assert 2 <= sum(empty) <= 12
