"""`verify` proves or refutes a `property` and never enforces it."""

from pathlib import Path

import pytest

from robosc.analysis.supervise import supervise
from robosc.analysis.verify import Verdict, verify_system
from robosc.analysis.verify.verdict import Outcome
from robosc.language.checks import check
from robosc.language.formatting import format_text
from robosc.language.reading import read
from robosc.language.text import Text
from robosc.m2m import robosc_to_sct
from robosc.model import sct

ROBOT = """robot R {{
    component Battery {{
        outgoing message low with type: none
        outgoing message dead with type: none
        behaviour {{
            initial marked state full {{ on response from low goto flat }}
            marked state flat {{ on response from dead goto empty }}
            marked state empty {{ }}
        }}
    }}
    component Base {{
        incoming message home with type: none
        incoming message out with type: none
        behaviour {{
            initial marked state docked {{ on request to out goto away }}
            marked state away {{ on request to home goto docked }}
        }}
    }}
    {}
}}"""
HOME = 'property SP1 "can always get home": reachable Base.docked from Battery.flat'


def supervised(folder: Path, *definitions: str) -> sct.SupervisoryControlModel:
    path = folder / "robot.rscd"
    path.write_text(ROBOT.format(" ".join(definitions)), encoding="utf-8")
    reading = read(path)
    assert [*reading.findings, *check(reading.base, reading.findings)] == []
    made = robosc_to_sct.transform(reading.base)[0]
    supervise(made)
    return made


def verdict(made: sct.SupervisoryControlModel) -> Verdict:
    (claimed,) = made.properties
    return next(verdict for verdict in verify_system(made) if verdict.property == f"{claimed.text} (line 19)")


@pytest.mark.parametrize(
    ("claimed", "evidence"),
    [
        (HOME, "from 2 states to `Base.docked`"),
        ("property reachable Base.away", "from 6 states to `Base.away`"),
        ("property SP2: never Base.docked and Base.away", "6 states, requires `!(Base.docked and Base.away)`"),
        ('property "one of the two": always Base.docked or Base.away', "6 states, requires `Base.docked or Base.away`"),
    ],
)
def test_it_is_proved(tmp_path: Path, claimed: str, evidence: str) -> None:
    found = verdict(supervised(tmp_path, claimed))
    assert (found.outcome, found.evidence) == (Outcome.PROVED, evidence)


@pytest.mark.parametrize(
    ("claimed", "explanation", "trace"),
    [
        (
            "property SP1: never Battery.flat and Base.away",
            "it is violated where `Battery.flat and Base.away`",
            {"message_low.u_response", "message_out.c_trigger"},
        ),
        (
            "property reachable Battery.full from Battery.flat",
            "from `Battery.flat` no state with `Battery.full` can be reached",
            {"message_low.u_response"},
        ),
    ],
)
def test_it_is_refuted_with_a_shortest_trace(tmp_path: Path, claimed: str, explanation: str, trace: set[str]) -> None:
    found = verdict(supervised(tmp_path, claimed))
    assert (found.outcome, found.explanation) == (Outcome.REFUTED, explanation)
    assert {step.event for step in found.trace} == trace
    assert len(found.trace) == len(trace)


def test_from_every_reachable_supervised_state(tmp_path: Path) -> None:
    """Only states under the supervisor count: without the requirement the property is proved."""
    made = supervised(tmp_path, HOME)
    assert verdict(made).outcome is Outcome.PROVED
    made = supervised(tmp_path, HOME, "requirement home needs Battery.full")
    found = verdict(made)
    assert (found.outcome, found.explanation) == (
        Outcome.REFUTED,
        "from `Battery.flat and Base.away` no state with `Base.docked` can be reached",
    )


def test_it_is_not_enforced(tmp_path: Path) -> None:
    alone = supervised(tmp_path).supervisor
    made = supervised(tmp_path, "property never Base.away").supervisor
    assert made.controlledStates == alone.controlledStates == 6


def test_it_reads_requirement_automata(tmp_path: Path) -> None:
    turns = "requirement T: automaton { initial state a { on out goto b } state b { on home goto a } }"
    made = supervised(tmp_path, "property reachable T.a from T.b", turns)
    assert verdict(made).outcome is Outcome.PROVED


@pytest.mark.parametrize(
    ("definition", "finding"),
    [
        ("property Base: never Base.away", "property `Base` has the name of a component (line 11)"),
        ("property reachable 1", "the condition of a property must be boolean, found integer"),
        ("property reachable Base.away from 1", "the condition after `from` must be boolean, found integer"),
    ],
)
def test_what_is_wrong_is_found(tmp_path: Path, definition: str, finding: str) -> None:
    path = tmp_path / "robot.rscd"
    path.write_text(ROBOT.format(definition), encoding="utf-8")
    reading = read(path)
    (found,) = [*reading.findings, *check(reading.base, reading.findings)]
    assert found.message.startswith(finding)


def test_the_words_are_names_elsewhere(tmp_path: Path) -> None:
    component = "component property { incoming message reachable with type: none }"
    made = supervised(tmp_path, component, "requirement property.reachable needs Base.docked")
    assert [requirement.text for requirement in made.requirements] == ["requirement reachable needs Base.docked"]


def test_format_keeps_what_is_laid_out() -> None:
    laid_out = f"robot R {{\n  {HOME}\n  property never Base.docked and Base.away\n}}\n"
    assert format_text(Text("robot.rscd", laid_out)) == (laid_out, [])
