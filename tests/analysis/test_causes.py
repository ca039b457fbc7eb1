"""Causes come before their consequences, and hints name the text to write and the command to run."""

import json

import pytest

import robosc
from robosc.analysis.explain import Renderer, data_of, emptiness, explore, find_event, possibility
from robosc.analysis.supervise import EmptySupervisorError, supervise
from robosc.base.diagnostics import Diagnostic, as_json, as_sarif, in_order

#: A drill goes down between two feeds. Its cover can be opened at any time, so it never may go down.
TURNS = """robot Drill {
  component Feed {
    incoming message left with type: none
    incoming message right with type: none
    behaviour {
      initial marked state away { on request to right goto there }
      marked state there { on request to left goto away }
    }
  }
  component Spindle {
    incoming message lower with type: none
    incoming message lift with type: none
    behaviour {
      initial marked state up { on request to lower goto down }
      state down { on request to lift goto up }
    }
  }
  component Cover {
    outgoing message opened with type: boolean
    behaviour {
      initial marked state shut { on response from opened if value goto open }
      marked state open { on response from opened if !value goto shut }
    }
  }
  requirement Turn "in turns": automaton {
    initial state left { on request to left goto left on request to lower goto right }
    state right { on request to right goto left }
  }
  requirement Safe: never Spindle.down and Cover.open
}
"""
#: A machine that publishes when it is done, and an automaton that permits this once.
BUFFER = """robot Factory {
  component Mill {
    incoming message start with type: none
    outgoing message done with type: none
    behaviour {
      initial marked state idle { on request to start goto busy }
      state busy { on response from done goto idle }
    }
  }
  component Lathe {
    incoming message take with type: none
    behaviour { initial marked state ready { on request to take } }
  }
  requirement Buffer: automaton {
    initial marked state empty { on response from done goto full }
    state full { on request to take goto empty }
  }
}
"""
#: The mains return only while the crane is parked, and the crane needs mains to park.
GUARDED = """robot Crane {
  component Boom {
    incoming message park with type: none
    outgoing message swung with type: none
    behaviour {
      initial marked state parked { on response from swung goto out }
      state out { on request to park goto parked }
    }
  }
  component Mains {
    outgoing message lost with type: none
    outgoing message back with type: none
    behaviour {
      initial marked state on_line { on response from lost goto off_line }
      state off_line { on response from back if Boom.parked goto on_line }
    }
  }
  requirement park needs Mains.on_line
}
"""


def findings(text: str) -> list[Diagnostic]:
    return supervise(robosc.to_sct(robosc.load(text=text))).findings


def test_the_cause_comes_first() -> None:
    found = findings(TURNS)
    assert in_order(reversed(found)) == found
    cause, *others = found
    assert cause.message.startswith("`Spindle.lower` can never be sent: ")
    assert cause.span.line == 29
    assert [finding.message.partition(":")[0] for finding in others] == [
        "therefore, `Spindle` is never in `down`",
        "therefore, `Feed.right` can never be sent",
        "therefore, `Spindle.lift` can never be sent",
        "therefore, `Feed.left` can never be sent",
        "therefore, `Feed` is never in `there`",
    ]
    assert all(finding.message.startswith("therefore, ") for finding in others)
    assert {finding.hint for finding in others} == {"correct the cause in line 29 first"}


def test_consequences_stand_after_their_own_cause() -> None:
    """The finding about `stray` is independent. It stands after the consequences of the one before it."""
    independent = "component Extra { behaviour { initial marked state home { } state stray { } } } }"
    found = findings(TURNS.rstrip().removesuffix("}") + independent)
    assert [finding.follows for finding in found] == [0, 1, 1, 1, 2, 2, 0]
    assert "`Extra` is never in `stray`" in found[-1].message


def test_programs_get_the_place_of_the_cause() -> None:
    found = findings(TURNS)
    cause, *others = json.loads(as_json.render(found))
    assert (cause["follows"], cause["related"]) == (0, [])
    place = {key: cause[key] for key in ("file", "line", "column", "end_line", "end_column")}
    assert all(finding["follows"] > 0 for finding in others)
    assert all(finding["related"] == [{**place, "message": "the cause of this finding"}] for finding in others)
    first, *later = json.loads(as_sarif.render(found, "1"))["runs"][0]["results"]
    for result in later:
        (related,) = result["relatedLocations"]
        assert related["physicalLocation"] == first["locations"][0]["physicalLocation"]


def test_the_hint_says_what_to_write_and_to_run() -> None:
    cause, *_ = findings(TURNS)
    assert cause.hint == (
        "loosen the requirement: add a `needs` requirement for each command, or a command that undoes the event, "
        "or remove it; `robosc explain --why-never Spindle.lower` explains why"
    )


def test_the_decisive_requirement_comes_first() -> None:
    model = robosc.to_sct(robosc.load(text=TURNS))
    found = explore(model, lambda system: possibility(system, find_event(model, "Feed.right")))
    assert [loosening.requirements[0].name for loosening in found.loosenings] == ["Safe", "Turn"]
    shown = Renderer(model, lambda _: "").answer(found)
    assert shown.count('requirement Turn "in turns": automaton (') == 1


def test_a_message_that_its_component_ignores() -> None:
    with pytest.raises(EmptySupervisorError) as refused:
        findings(BUFFER)
    (finding,) = refused.value.diagnostics
    assert finding.hint == (
        "`Mill` ignores it in `idle`: in the automaton of the requirement, write `if Mill.busy` after "
        "`on response from done`, and add `on response from done if !(Mill.busy)` to each state; `robosc explain "
        "--why-empty` explains why"
    )
    ignored = "on response from done if !(Mill.busy)"
    mended = BUFFER.replace("from done goto full", f"from done if Mill.busy goto full {ignored}").replace(
        "state full {", f"state full {{ {ignored}"
    )
    assert "never-enabled" not in {found.rule for found in findings(mended)}


STATION = """robot Stations {
  component Station(ns: string) {
    outgoing message done with identifier: ns + "/done", type: none
    incoming message enter with identifier: ns + "/enter", type: none
    behaviour {
      initial marked state outside { on request to enter goto inside }
      state inside { on response from done goto outside }
    }
  }
  component Cell[1..2] is Station("/cell" + text(number))
  requirement EACH automaton {
    initial marked state free { on request to NAME.enter goto taken }
    state taken { on response from NAME.done goto free }
  }
}"""


@pytest.mark.parametrize(("each", "written"), [("", "Cell[1]"), ("Turns: each Station:", "Station")])
def test_a_message_that_an_instance_ignores(each: str, written: str) -> None:
    """The texts of the hint are texts of the model, which name an instance as `Cell[1]`."""
    model = STATION.replace("EACH", each).replace("NAME", written)
    with pytest.raises(EmptySupervisorError) as refused:
        findings(model)
    (finding,) = refused.value.diagnostics
    assert finding.hint is not None
    [condition, heard, ignored] = [
        next(part for part in finding.hint.split("`") if part.startswith(start))
        for start in ("if ", "on response from Cell[1].done", "on response from Cell[1].done if ")
    ]
    assert finding.hint.endswith(
        "with the name of the template for `Cell[1]`; `robosc explain --why-empty` explains why"
    ) == bool(each)
    condition, heard, ignored = (part.replace("Cell[1]", written) for part in (condition, heard, ignored))
    mended = model.replace(heard, f"{heard} {condition}").replace(
        " }\n    state taken {", f" {ignored} }}\n    state taken {{ {ignored}"
    )
    assert "never-enabled" not in {found.rule for found in findings(mended)}


def test_a_guard_of_a_component_is_named() -> None:
    model = robosc.to_sct(robosc.load(text=GUARDED))
    found = explore(model, emptiness)
    assert [note.details for note in found.stuck if "Mains" in note.text] == [
        ("its transition on response from `Mains.back` requires `Boom.parked`",)
    ]


def test_explanations_name_each_requirement_once() -> None:
    text = """robot Press {
      component Ram {
        outgoing message hit with type: none
        incoming message rise with type: none
        incoming message lift with type: none
        behaviour {
          initial marked state up { on response from hit goto down }
          state down { on response from hit on request to rise goto up on request to lift goto up }
        }
      }
      requirement Lock: automaton { initial state locked { on request to rise if Ram.up on request to lift if Ram.up } }
    }"""
    model = robosc.to_sct(robosc.load(text=text))
    answer = explore(model, emptiness)
    (note,) = answer.blamed
    assert note.details == ("forbids the request to `Ram.rise`", "forbids the request to `Ram.lift`")
    (loosening,) = data_of(answer, lambda _: {})["loosenings"]
    assert loosening["texts"] == ["requirement Lock: automaton"]
