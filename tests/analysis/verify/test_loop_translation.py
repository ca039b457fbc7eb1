"""The generated control loop behaves like the Python one; every change to it is refuted."""

import re
from functools import cache
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings

import robosc
from robosc.analysis.verify import LoopEffort, c_program, validate, validate_loop
from robosc.analysis.verify.verdict import Outcome, Verdict
from robosc.language.configuration import Configuration
from robosc.m2m import sct_to_engine
from robosc.m2t import supervisor
from robosc.m2t.models import Models
from robosc.model import sct
from tests.engine.robots import robots
from tests.examples.conftest import models_of
from tests.m2t.supervisor import corners
from tests.m2t.supervisor.test_supervisor import dock
from tests.searching import examples, long_but

pytestmark = pytest.mark.build

#: A robot with a topic of two messages, a topic with two senders, a canceled action, fair turns, and timers.
PATROL = Path(__file__).parent / "patrol.rscd"
EXPLORED = LoopEffort(explored=12_000, walked=2_000)


#: Two timers that expire at once.
TIES = """\
robot Ties {
  component First {
    behaviour {
      initial marked state here { after 1.0 s goto there }
      marked state there { }
    }
  }
  component Second {
    behaviour {
      initial marked state here { after 1.0 s goto there }
      marked state there { }
    }
  }
}
"""


def made_of(path: Path) -> sct.SupervisoryControlModel:
    made = robosc.to_sct(robosc.load(path))
    robosc.synthesize(made)
    return made


@cache
def patrol() -> sct.SupervisoryControlModel:
    return made_of(PATROL)


def c_of(made: sct.SupervisoryControlModel) -> dict[str, str]:
    return _c_of(made, sct_to_engine.POLLED)


@cache
def _c_of(made: sct.SupervisoryControlModel, _polled: int) -> dict[str, str]:
    return supervisor.generate(Models(made), Configuration())


def changed(made: sct.SupervisoryControlModel, pattern: str, replacement: str) -> Verdict:
    """Return the verdict after a change to one place of the engine or to several similar ones."""
    files = c_of(made)
    name = next(name for name in files if name.endswith("_supervisor.c"))
    text, count = re.subn(pattern, replacement, files[name], flags=re.MULTILINE)
    assert count, pattern
    return validate_loop(made, {**files, name: text}, EXPLORED)


#: Faults in the loop of a small robot; the first seven are regressions that `verify` once missed.
SMALL = {
    "a turn without asking the guard": (r"event\]\] && guard\(&self->state, event\);$", "event]];"),
    "another event is reported": (r"after\(self->hooks\.context, event\)", "after(self->hooks.context, (PREFIX_event)0)"),
    "silent events do not take turns": (r"self->silent = \(uint8_t\)next;", "self->silent = 0U;"),
    "reactions are not counted": (r"self->reactions\[source\] = \(uint16_t\)\(most - left\);", ""),
    "what has run stays at its place": (r"self->queue\[place \+ 1U\] = \(uint8_t\)event;", ""),
    "it reacts before the first tick": (r"self->started && self->settings", "self->settings"),
    "it reacts though it shall not": (r"self->started && self->settings\.react_immediately", "self->started"),
    "what is withheld happens": (r"return given \|\|", "return true ||"),
    "one topic counts for all": (r"source_of\(self->last\)", "0U"),
    "the first event of a batch counts": (r"self->last = \(uint8_t\)event;", r"self->last = self->last ? self->last : (uint8_t)event;"),
    "nothing is owed": (r"self->owing = left == 0U;", "self->owing = false;"),
    "what is owed comes without a change": (r"^    if \(same\(&self->before, &self->state\)\) \{$", "    if (false) {"),
    "what is owed is owed for ever": (r"^    self->owing = false;\n    go_round", "    go_round"),
    "a service starts again": (r"self->taken\[group\[event\]\] = .*$", ""),
    "a topic is sent to once a tick": (r"number <= 1U; \+\+number\) \{\n        self->taken\[number\] = false;", "number < 1U; ++number) {"),
    "a tick has no end": (r"--left; /\* It", "/* It"),
    "a tick has no limit": (r"\(self->settings\.events_per_tick > 0U\) \? self->settings\.events_per_tick : QUEUED", "QUEUED"),
    "reactions are never forgotten": (r"        self->reactions\[source\] = 0U;\n", ""),
    "triggers come before cancels": (r"place = CANCELS;", "place = 0U;"),
    "a batch starts unsettled": (r"(_begin\(.*\n\{\n(?:    at\(.*\n)?)    settle\(self\);\n", r"\1"),
    "a batch ends unsettled": (r"(const unsigned source = source_of\(self->last\);\n)    settle\(self\);\n", r"\1"),
    "nothing settles after an event of a round": (r"(--left; .*\n) *settle\(self\);\n", r"\1"),
    "settling cancels nothing": (r"(settle\(self\);\n)    serve_cancels\(self\);", r"\1"),
    "the batch is compared with nothing": (r"!guard\(&self->before, event\)", "true"),
    "data is not chosen": (r"^        provide\(self\);\n", ""),
    "data is chosen again and again": (r"if \(!arrived\(&self->state, \(PREFIX_event\)event\)\)", "if (true)"),
    "the last choice of data holds": (r"(\(void\)run\(self, .*\n *\}\n) *break;", r"\1"),
    "what others send is no reason": (r"moved = self->state.*$", "moved = false;"),
    "withheld silent events are forgotten": (r"if \(withheld\) \{\n *return;[^\n]*\n *\}\n", ""),
    "one more silent event": (r"if \(left == 0U\) \{", "if (left > BOUND) {"),
    "a livelock is told again": (r"if \(!self->livelocked && ", "if ("),
}  # fmt: skip
#: Faults that need provided data to show, and faults that need endless silent events.
OF_DOCK = {name for name in SMALL if "data" in name or "others" in name or "owed for ever" in name}
OF_ENDLESS = {"one more silent event", "a livelock is told again"}
LARGE = {
    "a turn without asking whether it is due": (r"bool ran = due == NULL \|\| has\(due, event\);", "bool ran = true;"),
    "another event is reported": SMALL["another event is reported"],
    "reactions are never forgotten": (r"self->reactions\[self->reacted_to\[self->reacted\]\] = 0U;", ""),
    "one is not asked again": (r"(for \(unsigned place = first_reader\[event\]); place", r"\1 + 1U; place"),
    "what has run stays at its place": (r"^        bring\(self, \(unsigned\)event, self->end\);.*\n        \+\+self->end;\n", ""),
    "gaps are closed by half": (r"^            bring\(self, event, end\);\n", ""),
    "what is due stays due": (r"empty\(&self->due, QUEUED\);", ""),
    "a round does not ask again": (r"(            settle\(self\);\n)            ask\(self, NULL\);\n", r"\1"),
    "silent events do not take turns": (r"self->silent = \(uint8_t\)\(event \+ 1U\);", ""),
    "a service starts again": (r"add\(&self->taken, group\[event\]\);", ""),
    "a batch is not looked at from its start": (r"^    ask\(self, NULL\);\n    if \(self->owing\)", "    if (self->owing)"),
}  # fmt: skip
TIMES = {
    "another length": (r"^    3000U", "    3001U"),
    "what is left runs on": (r"leave\(self, 1U\);", ""),
    "what is started does not run": (r"begin_time\(self, 1U\);", ""),
    "the clock goes back unseen": (r"if \(back\) \{", "if (false) {"),
    "the later one first": (r"ahead < HALF\);", "ahead > HALF);"),
    "the last in the text first": (r"other < timer", "other > timer"),
    "nothing is late": (r" \+ self->settings\.resolution_ms", ""),
    "a clock that wraps": (r"left = \(left < HALF\) \? left : 0U;", "left = self->up[self->running[0]] > now ? left : 0U;"),
    "a time that is up starts no batch": (r"^        \w+_begin\(self, now\);\n", ""),
    "a time that is up ends no batch": (r"^        \w+_end\(self, now\);\n", ""),
    "not sorted anew": (r"time_up\(self, self->running\[place\]\);\n        sort_in\(self, place\);", "time_up(self, self->running[place]);"),
}  # fmt: skip


#: Faults for a run of all tests: the first seven, and one for each part of the loop.
TRIED = {
    *list(SMALL)[:7],
    *("nothing is owed", "a service starts again", "a tick has no limit", "a batch ends unsettled", "data is not chosen"),
    *("withheld silent events are forgotten", "a livelock is told again", "one is not asked again", "what is due stays due"),
    *("another length", "the clock goes back unseen", "the last in the text first", "a time that is up ends no batch"),
}  # fmt: skip


def refuted(made: sct.SupervisoryControlModel, mutant: tuple[str, str]) -> None:
    pattern, replacement = (part.replace("PREFIX", made.name.lower()) for part in mutant)
    verdict = changed(made, pattern, replacement)
    assert verdict.outcome is Outcome.REFUTED, verdict
    assert verdict.explanation.startswith(("in the control loop of the generated C, at ", "the control loop of"))


@pytest.mark.parametrize("mutant", long_but(TRIED, SMALL))
def test_a_changed_control_loop_is_refuted(mutant: str) -> None:
    robot = corners.silent if mutant in OF_ENDLESS else dock if mutant in OF_DOCK else patrol
    refuted(robot(), SMALL[mutant])


@pytest.mark.parametrize("mutant", long_but(TRIED, LARGE))
def test_a_changed_control_loop_of_a_large_robot_is_refuted(mutant: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sct_to_engine, "POLLED", 0)
    refuted(patrol(), LARGE[mutant])


@pytest.mark.parametrize("mutant", long_but(TRIED, TIMES))
def test_changed_times_are_refuted(mutant: str, tmp_path: Path) -> None:
    if mutant == "the last in the text first":
        (tmp_path / "ties.rscd").write_text(TIES)
        refuted(made_of(tmp_path / "ties.rscd"), TIMES[mutant])
    else:
        refuted(patrol(), TIMES[mutant])


def test_a_loop_that_never_ends_is_refuted(monkeypatch: pytest.MonkeyPatch) -> None:
    """The test compiles the follower with less patience, since nothing else takes long here."""
    compile_ = c_program.CProgram._compile
    monkeypatch.setattr(
        c_program.CProgram, "_compile", lambda self, *arguments: compile_(self, "-DPATIENCE=1", *arguments)
    )
    verdict = changed(
        patrol(), r"^        for \(unsigned asked = 0U; asked < SILENT && !ran; \+\+asked\)", "        for (;;)"
    )
    assert verdict.explanation.startswith("the control loop of the generated C does not come to an end, at ")


def test_a_loop_that_crashes_is_refuted() -> None:
    verdict = changed(patrol(), r"^(void patrol_tick\(.*\n\{\n)", r"\1    (void)*(volatile char *)0;\n")
    assert verdict.explanation == (
        "the control loop of the generated C ends with status -11, at one of these: a tick, the start of a batch"
    )


def test_the_way_to_a_difference_is_told() -> None:
    verdict = changed(patrol(), *SMALL["a turn without asking the guard"])
    assert verdict.trace
    assert {step.event for step in verdict.trace} <= {
        f"{plant.name}.{event.name}" for plant in patrol().plants for event in plant.events
    }


def test_a_loop_is_proved_in_all_its_states() -> None:
    made = models_of("line_stepper").sct
    verdict = validate_loop(made, c_of(made))
    assert (verdict.outcome, verdict.explanation) == (Outcome.PROVED, "")
    assert re.fullmatch(r"\d+ states, [\d,]+ operations", verdict.evidence)


@pytest.mark.parametrize("small", [sct_to_engine.POLLED, 0])
@pytest.mark.parametrize("make", [*corners.ALL, dock, patrol])
def test_the_loops_are_the_same(make, small: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sct_to_engine, "POLLED", small)
    made = make()
    assert validate_loop(made, c_of(made), LoopEffort(1_000, 300)).outcome is not Outcome.REFUTED


def test_what_is_not_looked_at_is_said() -> None:
    made = patrol()
    verdict = validate_loop(made, c_of(made), LoopEffort(500, 200))
    assert verdict.outcome is Outcome.SAMPLED
    assert re.fullmatch(r"\d+ states, 500 operations, then 2\d\d at random", verdict.evidence)


@pytest.mark.slow
@settings(max_examples=examples(6), deadline=None, suppress_health_check=list(HealthCheck))
@given(robots())
def test_random_robots_have_the_same_loop(made: sct.SupervisoryControlModel) -> None:
    verdict = validate_loop(made, c_of(made), LoopEffort(2_000, 300))
    assert (verdict.outcome is Outcome.REFUTED, verdict.explanation) == (False, "")


def test_it_has_a_row_of_its_own() -> None:
    made = models_of("supervised_line_follower")
    assert [verdict.property for verdict in validate(Models(made.sct), Configuration())] == [
        "c-translation",
        "loop-translation",
        "cif-translation",
    ]
