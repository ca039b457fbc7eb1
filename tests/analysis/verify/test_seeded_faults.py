"""`verify` refutes robots that a faulty RoboSC produces: each test seeds one fault into its passes.

docs/verify.md lists the faults that `verify` cannot detect, with reasons.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import robosc
from robosc.analysis.verify import (
    LoopEffort,
    validate_c,
    validate_controller,
    validate_loop,
    validate_model,
    verify_system,
)
from robosc.analysis.verify.controller_reading import Effort
from robosc.analysis.verify.verdict import Outcome, details
from robosc.base.diagnostics import ModelError, has_errors
from robosc.language.checks import check
from robosc.language.configuration import Configuration
from robosc.language.reading import read
from robosc.m2t import supervisor
from robosc.m2t.models import Models
from robosc.model import robosc as robosc_model
from tests.analysis.verify.seeding import seed
from tests.fuzz.mutants import LIBRARIES
from tests.m2t.supervisor import corners
from tests.random_robots import random_robot
from tests.random_second_edition import second_edition_robot
from tests.searching import examples

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.analysis.verify import Verdict

ROOT = Path(__file__).parents[3]
#: Models of this repository. `Pairs` adds features that none of them has, such as a topic with two spellings.
SHIPPED = {
    "Courier": ROOT / "docs" / "patterns" / "courier.rscd",
    "LostSensor": ROOT / "docs" / "patterns" / "lost_sensor.rscd",
    "PersonFollower": ROOT / "examples" / "person_follower" / "person_follower.rscd",
}
#: Two messages of one topic, once with a slash; two to one topic; timers of components that expire at once.
PAIRS = """\
robot Pairs {
  parameter pause: integer(1..9) = 3
  component First {
    outgoing message near with identifier: "/scan", type: integer(0..3)
    outgoing message far with identifier: "scan", type: integer(0..3)
    incoming message left with identifier: "/turn", type: boolean
    incoming message right with identifier: "turn", type: boolean
    service help with identifier: "/help", request: none, response: none
    behaviour {
      variable seen: integer(0..3)
      after 700 ms without Second.heard do seen := 0
      initial marked state here {
        on response from near if value > 1 goto here
        on response from near do seen := value
        on response from far if value = 3 goto there
        after 1 s without far goto there
        after pause s goto there
      }
      marked state there {
        on response from near goto here
        after 2 s do seen := 1
        after 1 s without far goto there
      }
    }
  }
  component Second {
    outgoing message heard with identifier: "/heard", type: none
    behaviour {
      initial marked state here { after 1 s goto there }
      marked state there { on response from heard goto here transition if First.seen = 2 goto here }
    }
  }
  requirement left needs First.seen > 1
  requirement right needs First.seen < 2
  requirement help needs First.there
  provide left with true if First.here
  provide left with false if First.seen > 2
  provide right with false
}
"""

_LOWER, _PLANTS, _ROLES = "m2m.sct_to_engine.lower_timers", "m2m.robosc_to_sct", "model.semantics.roles"
_AUTOMATA, _NODE, _ENGINE = "m2m.requirement_automata", "m2m.robosc_to_rosgraph", "m2m.sct_to_engine"
_EVENTS, _CONE = "m2m.sct_to_engine.collect_events", "model.semantics.cone_of_influence"
#: A fault: module, original text, replacement, the robot that shows it, and the report.
Fault = tuple[str, str, str, str, str]

TIMES: dict[str, Fault] = {
    "the time of the initial state is not started": (
        *(_LOWER, "timed.location is None or timed.location.initial", "timed.location is None", "Courier"),
        "the time `after 1 min` of `Route` (line 21) runs from the start by the text, and does not run from the start",
    ),
    "a message does not restart a `without`": (
        *(_LOWER, "if entering or event in timed.without", "if entering", "Courier"),
        "with response from `Way.gap`, the time `after 500 ms without Way.gap` of `Way` (line 47) starts anew by the",
    ),
    "the time of a left state goes on": (
        *(_LOWER, "left = entering and location in timers", "left = False", "Courier"),
        "with request to `Base.go`, the time `after 1 min` of `Base` (line 65) stops by the text, and goes on in the",
    ),
    "every time is 1 ms early": (
        *(_LOWER, "milliseconds=length", "milliseconds=length - 1", "Courier"),
        "the time `after 1 min` of `Route` (line 21) lasts 60,000 ms by the text, and 59,999 ms in the controller",
    ),
    "`goto` to the same state does not restart": (
        *(_PLANTS, "if named or edge.target is not location:", "if edge.target is not location:", "Courier"),
        "with request to `Base.go`, the time `after patience s without Desk.call` of `Base` (line 59) starts anew",
    ),
    "an entry that stays is none": (
        *(_LOWER, "or any(edge in timed.entries for timed, _ in here)", "", "Courier"),
        "with request to `Base.go`, the time `after patience s without Desk.call` of `Base` (line 59) starts anew",
    ),
    "what stays is an entry": (
        *(_LOWER, "entering = edge.target is not location or", "entering = True or", "Courier"),
        "with request to `Base.stay`, the time `after patience s without Desk.call` of `Base` (line 59) goes on by the",
    ),
    "a message restarts all times": (
        *(_LOWER, "if event in timed.without)\n        if starts", ")\n        if starts", "Courier"),
        "with response from `Desk.call`, the time `after 1 min` of `Base`",
    ),
    "a message of another component restarts nothing": (
        *(_LOWER, "listening.setdefault(message, {})[plant_of(event.event)] = None", "pass", "Courier"),
        "with response from `Desk.call`, the time `after patience s without Desk.call` of `Base` (line 59) starts anew",
    ),
    "a silence in every state does not start anew": (
        *(_LOWER, "if event.event in everywhere:", "if False:", "LostSensor"),
        "with response from `Lidar.scan`, the time `after 500 ms without Lidar.scan` of `Lidar` (line 7) starts anew",
    ),
    "a silence in every state does not run from the start": (
        *(_LOWER, "timed.location is None or", "timed.location is not None and", "LostSensor"),
        "the time `after 500 ms without Lidar.scan` of `Lidar` (line 7) runs from the start by the text, and does",
    ),
    "what the robot sets is half as long": (
        *(_PLANTS, "set_milliseconds(number, unit) for", "set_milliseconds(number / 2, unit) for", "Courier"),
        "the time `after patience s without Desk.call` of `Base` (line 59) lasts 2,000 ms by the text, and 1,000 ms in",
    ),
    "the last of times that are up together comes first": (
        *(_LOWER, "model.timers.append(timer)", "model.timers.insert(0, timer)", "Pairs"),
        "the time `after 700 ms without Second.heard` of `First` (line 11) comes before the time `after 1 s` of",
    ),
}
#: Facts that the generated C, the interpreter and the decision diagrams all take from one place.
LOOP: dict[str, Fault] = {
    "the settling bound is one more": (
        *(_ROLES, "min(proved, 0xFFFFFFFF)", "min(proved + 1, 0xFFFFFFFF)", "Pairs"),
        "a livelock is reported after 3 silent events in a row in the controller, and not after 2",
    ),
    "a topic with a slash is another": (
        *(_ROLES, 'plant.topic.removeprefix("/")', "plant.topic", "Pairs"),
        "response from `First.near`, response from `First.far` come as one by the text, and not in the controller",
    ),
    "messages of a topic are no batch": (
        *(_ROLES, "if len(events) > 1 and plant_of", "if len(events) > 2 and plant_of", "PersonFollower"),
        "response from `PersonDetector.who`, response from `PersonDetector.place` are no batch in the controller",
    ),
    "each message is a source": (
        *(_ROLES, "named = plant.kind == sct.PlantKind.message and plant.topic", "named = False", "Pairs"),
        "response from `First.near`, response from `First.far` come as one by the text, and not in the controller",
    ),
    "times of a component are no source": (
        *(_ROLES, "_by_source([*self.incoming, *self.timeouts])", "_by_source(self.incoming)", "Pairs"),
        "timeout of `First` after 700 ms without Second.heard in line 11, timeout of `First` after 1 s without",
    ),
    "messages to one topic do not exclude each other": (
        *(_ROLES, "_by_source(messages) if len(events) > 1", "_by_source(messages) if False", "Pairs"),
        "request to `First.left`, request to `First.right` exclude each other in a round by the text, and not in th",
    ),
    "a service starts again in a tick": (
        *(_ROLES, "(sct.PlantKind.service, sct.PlantKind.action)", "()", "Pairs"),
        "request to `First.help` happens once in a tick by the text, and not in the controller",
    ),
    "the last data is wanted most": (
        *(
            _ROLES,
            "tuple(tuple(events) for events in chosen",
            "tuple(tuple(events[::-1]) for events in chosen",
            "Pairs",
        ),
        "data for `First.left` is chosen in another order in the controller: choice of no data for `First.left`,",
    ),
    "data has no message": (
        *(_ENGINE, "events[trigger].choice = choices.get(plant)", "pass", "Pairs"),
        "request to `First.left` sends other data in the controller",
    ),
    "what is chosen is chosen again": (
        *(_ENGINE, "return None if condition.constant == 0 else build_expression(condition)", "return None", "Pairs"),
        "choice of `provide` 1 for `First.left` in line 36 is not taken for chosen in the controller where it is `d1`",
    ),
    "triggers are tried backwards": (
        *(_EVENTS, "(engine.Role.trigger, roles.triggers)", "(engine.Role.trigger, roles.triggers[::-1])", "Pairs"),
        "request to `First.left` comes before request to `First.help` in the text, and after it in the controller",
    ),
    "silent events are tried backwards": (
        *(_EVENTS, "(engine.Role.silent, roles.silent)", "(engine.Role.silent, roles.silent[::-1])", "Pairs"),
        "reset of `First.help` comes before transition of `Second` in line 30 in the text, and after it in",
    ),
    "a reset waits for its turn": (
        *(_EVENTS, "(engine.Role.silent, roles.silent)", "(engine.Role.cancel, roles.silent)", "Pairs"),
        "reset of `First.help` is silent by the text, and cancel in the controller",
    ),
    "the node has two subscriptions for a topic": (
        *(_NODE, 'key = topic.removeprefix("/"), interface', "key = topic, interface", "Pairs"),
        "topic `scan` is one in the text, and has two ends in the node",
    ),
    "the node calls another server": (
        *(
            _NODE,
            "user.identifier = port.instance.topic(port.communication)",
            "user.identifier = port.communication.name",
            "Pairs",
        ),
        "`First.help` is `/help` in ROS by the text, and `help` in the node",
    ),
}
#: Faults that only the courier shows among this repository's models.
MODEL: dict[str, Fault] = {
    "a requirement is on the first of its set": (
        *(_CONE, "list(dict.fromkeys(port for port in named if port is not None))", "list(named)[:1]", "Courier"),
        "request to `Base.horn` is forbidden by the text (line 80), and not by the model",
    ),
    "an order is on the first of its set": (
        *(
            _AUTOMATA,
            "list(dict.fromkeys(map(self._event, named.events)))",
            "[self._event(named.events[0])]",
            "Courier",
        ),
        "request to `Base.horn` is forbidden by the text (line 78), and not by the model",
    ),
    "a property `never` is `always`": (
        *(
            _PLANTS,
            "sct.InvariantProperty(condition=ex.Negation(operand=condition) if never else condition)",
            "sct.InvariantProperty(condition=condition)",
            "Courier",
        ),
        "the condition of a property (line 104) holds by the text and does not in the model where",
    ),
    "a property `always` is `never`": (
        *(
            _PLANTS,
            "sct.InvariantProperty(condition=ex.Negation(operand=condition) if never else condition)",
            "sct.InvariantProperty(condition=ex.Negation(operand=condition))",
            "Courier",
        ),
        "the condition of a property (line 105) holds by the text and does not in the model where",
    ),
    "what is counted starts no count": (
        *(
            _AUTOMATA,
            "if event is anchor else one_more",
            "if event is anchor and event not in restricted else one_more",
            "Courier",
        ),
        "after request to `Base.go`, the count of requirement automaton 2 stays as it was by the text (line 83), and",
    ),
    "alternatives do not deny those before them": (
        *(_AUTOMATA, "before += map(copy_tree, own)", "pass", "Courier"),
        "several edges with different ends are possible in the plants for response from `Desk.call`",
    ),
    "every requirement state is marked": (
        *(_AUTOMATA, "marked=unmarked or state.marked", "marked=True", "Courier"),
        "location `answering` of requirement automaton 3 (line 86) is marked only in the model",
    ),
}


def text_of(name: str) -> str:
    return PAIRS if name == "Pairs" else SHIPPED[name].read_text()


def made(name: str, folder: Path) -> Models:
    """Return the models of a robot, produced with the currently seeded faults."""
    path = folder / "robot.rscd"
    path.write_text(text_of(name))
    robot = robosc.load(path)
    plants = robosc.to_sct(robot)
    robosc.synthesize(plants)
    return Models(plants, robosc.to_rosgraph(robot), robot)


def verdicts(models: Models) -> dict[str, Verdict]:
    return {
        "model": validate_model(models.robosc, models.sct),
        "controller": validate_controller(models),
    }


@pytest.mark.parametrize("name", [*SHIPPED, "Pairs"])
def test_without_a_fault_all_is_proved(name: str, tmp_path: Path) -> None:
    found = verdicts(made(name, tmp_path))
    assert {verdict.outcome for verdict in found.values()} == {Outcome.PROVED}, found


@pytest.mark.parametrize("fault", [*TIMES, *LOOP])
def test_a_fault_between_plants_and_controller_is_refuted(
    fault: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    *place, name, said = (TIMES | LOOP)[fault]
    seed(monkeypatch, *place)
    found = validate_controller(made(name, tmp_path))
    assert (found.outcome, found.explanation[: len(said)]) == (Outcome.REFUTED, said)


@pytest.mark.parametrize("fault", MODEL)
def test_a_fault_between_text_and_plants_is_refuted(
    fault: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    *place, name, said = MODEL[fault]
    seed(monkeypatch, *place)
    models = made(name, tmp_path)
    found = validate_model(models.robosc, models.sct)
    assert (found.outcome, found.explanation[: len(said)]) == (Outcome.REFUTED, said)


def test_the_way_to_a_difference_is_shown(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    seed(monkeypatch, *TIMES["a message does not restart a `without`"][:3])
    models = made("Courier", tmp_path)
    assert details(validate_controller(models), models.sct) == (
        "controller-translation: with response from `Way.gap`, the time `after 500 ms without Way.gap` of `Way` "
        "(line 47) starts anew by the text, and goes on in the controller where `Way.free`\n"
        "  after\n"
        "    1. response from `Way.gap` (value = wide)\n"
        "  then\n"
        "    1. response from `Way.gap` (value = wide)"
    )


def test_where_no_bound_is_saved_it_is_counted(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    seed(monkeypatch, _ROLES, "2 * len(self.silent) + 16", "2 * len(self.silent) + 17")
    models = made("Pairs", tmp_path)
    assert models.sct.supervisor is not None
    models.sct.supervisor.settlingBound = None
    assert validate_controller(models).explanation == (
        "a livelock is reported after 21 silent events in a row in the controller, and not after 20"
    )


def test_a_bound_that_synthesis_and_verify_count_too_low_is_refuted(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    seed(monkeypatch, "synthesis.run_to_completion", "            return length\n", "            return length - 1\n")
    models = made("Pairs", tmp_path)
    (found,) = [verdict for verdict in verify_system(models.sct) if verdict.property == "bounded response"]
    assert found.outcome is Outcome.REFUTED
    assert len(found.onwards) == 1 + models.sct.supervisor.settlingBound


def test_of_too_many_values_it_tries_some(tmp_path: Path) -> None:
    found = validate_controller(made("Courier", tmp_path), Effort(values=1, random=50))
    assert (found.outcome, found.evidence) == (Outcome.SAMPLED, "4 times, 14 events, some with random data")


@pytest.mark.build
def test_assignments_that_read_each_other_are_made_at_once(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    seed(monkeypatch, "m2m.sct_to_engine.merge_effects", "    return list(late)\n", "    return []\n")
    models = made("Courier", tmp_path)
    found = validate_c(models.sct, supervisor.generate(models, Configuration()))
    assert found.outcome is Outcome.REFUTED
    assert found.explanation.startswith("after `message_arrived.u_response(i_response = 2)`, the generated C has ")


@pytest.mark.build
def test_data_that_moves_while_its_trigger_stays_possible_is_sent(tmp_path: Path) -> None:
    models = made("Courier", tmp_path)
    files = supervisor.generate(models, Configuration())
    name = "courier_supervisor.c"
    changed = re.sub(r"moved = self->state.*$", "moved = false;", files[name], flags=re.MULTILINE)
    assert changed != files[name]
    found = validate_loop(models.sct, {**files, name: changed}, LoopEffort(12_000, 2_000))
    assert found.outcome is Outcome.REFUTED
    assert found.explanation.startswith("in the control loop of the generated C, at the end of a batch: ")


@pytest.mark.build
def test_a_livelock_that_is_reported_one_event_late_is_refuted(monkeypatch: pytest.MonkeyPatch) -> None:
    """A model whose silent events rest within the bound cannot show this fault: no livelock is reported."""
    files = supervisor.generate(Models(corners.silent()), Configuration())
    seed(
        monkeypatch,
        "engine.control_loop",
        "if left == 0:\n                        if not",
        "if left < 0:\n                        if not",
    )
    found = validate_loop(corners.silent(), files, LoopEffort(2_000, 500))
    assert found.outcome is Outcome.REFUTED
    assert "a livelock" in found.explanation


@pytest.mark.slow
@pytest.mark.parametrize("random_text", [random_robot, second_edition_robot])
def test_the_controller_of_a_random_robot_is_that_of_its_text(
    random_text: Callable[[int], str], tmp_path: Path
) -> None:
    found = [controller_of(random_text(number), tmp_path) for number in range(examples(10))]
    assert found.count(None) < 0.8 * len(found)
    assert {verdict.outcome for verdict in found if verdict} <= {Outcome.PROVED, Outcome.SAMPLED}, found


def controller_of(text: str, folder: Path) -> Verdict | None:
    """Return the verdict on a robot; None for one with errors or an empty supervisor."""
    path = folder / "robot.rscd"
    path.write_text(text)
    reading = read(path, [LIBRARIES])
    if has_errors([*reading.findings, *check(reading.base, reading.findings)]):
        return None
    assert isinstance(reading.base, robosc_model.Robot)
    plants = robosc.to_sct(reading.base)
    try:
        robosc.synthesize(plants)
    except ModelError:
        return None
    return validate_controller(Models(plants, robosc.to_rosgraph(reading.base), reading.base))
