"""`synthesize` reports the number of states in which each requirement matters, and those that never matter."""

from pathlib import Path

from robosc.analysis.supervise import supervise
from robosc.language.reading import read
from robosc.m2m import robosc_to_sct

ROBOT = """robot R {
    component Left {
        incoming message enter with type: none
        outgoing message left with type: none
        behaviour {
            initial marked state away { on request to enter goto in_zone }
            state in_zone { on response from left goto away }
        }
    }
    component Right {
        incoming message come with type: none
        outgoing message gone with type: none
        behaviour {
            initial marked state away { on request to come goto in_zone }
            state in_zone { on response from gone goto away }
        }
    }
    component Horn { incoming message toot with type: none }
    requirement SR1: never Left.in_zone and Right.in_zone
    requirement toot needs Left.in_zone or Right.in_zone
    requirement SR2: toot needs Left.away or Right.away
    requirement Turns: automaton {
        initial state mine { on request to enter goto yours }
        state yours { on request to come goto mine }
    }
    requirement toot after each enter
}"""


def test_each_requirement_has_the_number_of_states_in_which_it_matters(tmp_path: Path) -> None:
    path = tmp_path / "robot.rscd"
    path.write_text(ROBOT, encoding="utf-8")
    made = robosc_to_sct.transform(read(path).base)[0]
    synthesis = supervise(made, weigh=True).synthesis
    told = {weight.requirements[0].text: weight.states for weight in synthesis.weights}
    assert synthesis.controlled_states == 8
    assert told == {
        "requirement toot needs Left.in_zone or Right.in_zone": 4,
        "requirement SR2: toot needs Left.away or Right.away": 0,
        "requirement Turns: automaton": 4,
        "requirement toot after each enter": 4,
        "requirement SR1: never Left.in_zone and Right.in_zone": 3,
    }


def test_nobody_counts_where_nobody_asks(tmp_path: Path) -> None:
    path = tmp_path / "robot.rscd"
    path.write_text(ROBOT, encoding="utf-8")
    assert supervise(robosc_to_sct.transform(read(path).base)[0]).synthesis.weights == ()
