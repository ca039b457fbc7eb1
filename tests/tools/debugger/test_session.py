"""Sessions with `robosc dap` and the tests' own client: stepping, stopping, inspecting, reasons, manual events."""

import json
from pathlib import Path

import pytest

from .client import ROOT, Client, Program

YARD = """\
// A gate with a lamp 🤖, and a cart that drives through.
robot Yard {
  component Gate {
    outgoing message seen with identifier: "/seen", type: integer(0..3)
    incoming message open with identifier: "/open", type: none

    behaviour {
      variable carts: integer(0..3) = 0

      initial marked state shut {
        on request to open goto ajar
        on response from seen do carts := value
      }

      state ajar {
        on response from seen if value = 3 do carts := value goto shut
        on response from seen do carts := value
        after 2.5 s goto shut
      }
    }
  }

  component Cart {
    incoming message go with identifier: "/go", type: none
    incoming message stop with identifier: "/stop", type: none

    behaviour {
      initial marked state standing { on request to go goto driving }
      /* 🤖 */ state driving { on request to stop goto standing }
    }
  }

  requirement SR1: go needs Gate.ajar
  requirement open needs Cart.standing and Gate.carts < 2
  property SP1: never Cart.driving
}
"""
LINES = {text.strip(): number for number, text in enumerate(YARD.splitlines(), 1)}
SCRIPT = """\
# The cart goes through the gate.
message_open.c_trigger
message_go.c_trigger
message_seen.u_response {"value": 1}
message_seen.u_response {"value": 3}
message_go.c_trigger
message_stop.c_trigger
message_open.c_trigger
"""
GO = "message_go.c_trigger"


@pytest.fixture
def yard(tmp_path: Path) -> Path:
    path = tmp_path / "yard.rscd"
    path.write_text(YARD)
    (tmp_path / "yard.script").write_text(SCRIPT)
    return path


def line(text: str) -> int:
    return next(number for shown, number in LINES.items() if shown.startswith(text))


def test_a_script_step_by_step(program: Program, yard: Path) -> None:
    session = program
    assert session.launch(yard, script="yard.script")["reason"] == "entry"
    first, *components, following = session.frames()
    assert (first["name"], first["line"]) == ("start", 2)
    assert [frame["name"] for frame in components] == ["Gate: shut", "Cart: standing"]
    assert components[0]["source"]["path"] == str(yard)
    assert following["name"] == "next: line 2 of yard.script"
    stopped = session.go("next")
    assert (stopped["reason"], stopped["description"]) == ("step", "request to `Gate.open`")
    first, gate, cart, following = session.frames()
    assert (first["line"], gate["line"], following["line"]) == (line("on request to open"), line("state ajar"), 3)
    session.go("next")
    session.go("stepIn")
    assert session.scope("Components")["Gate"]["value"] == "ajar"
    session.go("stepOut")
    assert session.frames()[0]["line"] == line("on response from seen if")
    # Columns are UTF-16 units: the robot emoji before it takes two.
    cart = session.frames()[2]
    before = YARD.splitlines()[cart["line"] - 1].partition("state driving")[0]
    assert cart["column"] == len(before) + 2
    # An event that cannot happen is an exception, and the script continues.
    stopped = session.go("next")
    assert stopped["reason"] == "exception"
    told = session.do("exceptionInfo", threadId=1)["description"]
    assert told == "request to `Cart.go` cannot happen: the robot is not ready for it"
    assert session.go()["description"] == (
        "request to `Gate.open` cannot happen: forbidden by requirement open needs Cart.standing and Gate.carts < 2"
    )
    session.do("continue", threadId=1)
    assert session.event("exited") == {"exitCode": 0}
    session.event("terminated")
    session.do("disconnect")
    assert session.end() == (0, "")


def test_back_and_forth(session: Client, yard: Path) -> None:
    session.prepare(yard, script="yard.script")
    session.do("setExceptionBreakpoints", filters=[])
    session.begin()
    assert session.go()["description"] == "the script is at its end"
    end = session.scope("Components")
    assert [variable["value"] for variable in end.values()] == ["shut", "standing"]
    told = [session.go("stepBack")["reason"] for _ in range(6)]
    assert told == ["step"] * 6
    assert session.frames()[0]["name"] == "request to `Gate.open`"
    assert session.go("stepBack")["description"] == "one step back"
    assert session.go("stepBack")["description"] == "this is the start of the robot"
    assert session.go()["description"] == "the script is at its end"
    session.do("setFunctionBreakpoints", breakpoints=[{"name": "go"}])
    assert session.go("reverseContinue")["description"] == "request to `Cart.go`"
    assert session.frames()[-1]["name"] == "next: line 4 of yard.script"
    assert session.go("reverseContinue")["description"] == "this is the start of the robot"


def test_breakpoints_by_line(session: Client, yard: Path) -> None:
    session.prepare(yard, script="yard.script")
    lines = [line("on response from seen if"), line("requirement open"), 1, line("component Cart") + 6]
    set_in_model = session.do(
        "setBreakpoints", source={"path": str(yard)}, breakpoints=[{"line": number} for number in lines]
    )["breakpoints"]
    assert [(point["verified"], point["line"]) for point in set_in_model] == [
        (True, lines[0]),
        (True, lines[1]),
        (False, 1),
        (True, lines[3]),
    ]
    assert "`Cart` enters `driving`" in set_in_model[3]["message"]
    script = yard.with_name("yard.script")
    set_in_script = session.do("setBreakpoints", source={"path": str(script)}, breakpoints=[{"line": 1}, {"line": 5}])[
        "breakpoints"
    ]
    assert [point["verified"] for point in set_in_script] == [False, True]
    session.begin()
    driving, before, shut = stops = [session.go() for _ in range(3)]
    assert [stop["reason"] for stop in stops] == ["breakpoint"] * 3
    # When the cart drives, opening is forbidden too: both breakpoints are hit at once.
    assert driving["hitBreakpointIds"] == [set_in_model[1]["id"], set_in_model[3]["id"]]
    assert before["hitBreakpointIds"] == [set_in_script[1]["id"]]
    assert shut["hitBreakpointIds"] == [set_in_model[0]["id"]]


def test_function_and_data_breakpoints(session: Client, yard: Path) -> None:
    session.prepare(yard, script="yard.script")
    names = ["forbidden open", "SR1", "allowed open", "Gate", "nothing", "forbidden nothing"]
    told = session.do("setFunctionBreakpoints", breakpoints=[{"name": name} for name in names])["breakpoints"]
    assert [point["verified"] for point in told] == [True, True, True, True, False, False]
    assert told[4]["message"].startswith("there is no event `nothing`")
    numbers = [point["id"] for point in told]
    session.begin()
    # The gate opens: neither requirement forbids more than before.
    assert session.go()["hitBreakpointIds"] == [numbers[3]]
    # The cart drives: the requirement forbids opening, for which the gate is not ready anyway.
    session.do("setFunctionBreakpoints", breakpoints=[{"name": "SR1"}])
    information = session.do("dataBreakpointInfo", name="carts", variablesReference=0)
    assert information["dataId"] is None
    information = session.do("dataBreakpointInfo", name="Gate.carts")
    (point,) = session.do("setDataBreakpoints", breakpoints=[{"dataId": information["dataId"]}])["breakpoints"]
    assert point["verified"]
    stopped = session.go()
    assert (stopped["reason"], stopped["description"]) == ("data breakpoint", "Gate.carts is 1")
    assert stopped["hitBreakpointIds"] == [point["id"]]
    # The gate shuts: SR1 begins to forbid `go`, which takes precedence over the value.
    stopped = session.go()
    assert stopped["reason"] == "function breakpoint"
    assert stopped["description"].startswith("`requirement SR1: go needs Gate.ajar` begins to forbid")
    (point,) = session.do("setDataBreakpoints", breakpoints=[{"dataId": "x"}])["breakpoints"]
    assert not point["verified"]


def test_a_command_becomes_forbidden(session: Client, yard: Path) -> None:
    session.prepare(yard, script="yard.script")
    options = [{"filterId": "forbidden", "condition": "nothing"}, {"filterId": "x"}]
    told = session.do("setExceptionBreakpoints", filters=["refused"], filterOptions=options)["breakpoints"]
    assert [point["verified"] for point in told] == [True, False, False]
    session.do("setExceptionBreakpoints", filters=[], filterOptions=[{"filterId": "forbidden", "condition": "open"}])
    session.begin()
    stopped = session.go()
    assert (stopped["reason"], stopped["description"]) == (
        "exception",
        "the request to `Gate.open` becomes forbidden",
    )
    assert session.frames()[0]["name"] == "response from `Gate.seen`"


def test_what_is_seen(session: Client, yard: Path) -> None:
    session.launch(yard)
    session.console("open")
    gate = session.scope("Components")["Gate"]
    assert gate["evaluateName"] == "Gate"
    assert {name: variable["value"] for name, variable in session.children(gate).items()} == {"carts": "0"}
    own = session.scope("Cart", frame=3)
    assert own["state"]["value"] == "standing"
    assert {name: variable["value"] for name, variable in session.scope("Times").items()} == {
        "timeout of `Gate` after 2500 ms in line 18": "in 2.5 s"
    }
    assert list(session.scope("Can happen")) == [
        "message_seen.u_response",
        "component_Gate.u_after1",
        "message_go.c_trigger",
    ]
    blocked = session.scope("Cannot happen")
    assert blocked["message_stop.c_trigger"]["value"] == "the robot is not ready for it"
    # The output of `explain`: the failing part of the requirement, and the remedy.
    session.console("go")
    session.console("wait 2.5")
    session.console("stop")
    reason = session.scope("Cannot happen")[GO]
    assert reason["value"] == "forbidden by requirement SR1: go needs Gate.ajar"
    why = session.children(reason)
    (requirement,) = [reason for name, reason in why.items() if name.endswith(f":{line('requirement SR1')}:3")]
    assert [reason["value"] for reason in session.children(requirement).values()] == [
        "`Gate.ajar` does not hold: `Gate` is in `shut`"
    ]
    assert why["would help"]["value"] == "`Gate` goes from `shut` to `ajar` by request to `Gate.open`"
    assert why["shortest way"]["value"] == "request to `Gate.open`"
    # References from before the robot's last step are invalid.
    session.go("stepBack")
    assert "the robot has continued" in session.refused("variables", variablesReference=reason["variablesReference"])


def test_synthesis_as_the_reason(session: Client, tmp_path: Path) -> None:
    """The porter of docs/explain.md, at the open door."""
    page = (ROOT / "docs" / "explain.md").read_text()
    (text,) = [part for part in page.split("```robosc\n") if part.startswith("// A porter")]
    (tmp_path / "porter.rscd").write_text(text.partition("```")[0])
    session.launch("porter.rscd")
    session.console("open")
    reason = session.scope("Cannot happen")["message_enter.c_trigger"]
    assert reason["value"].startswith("forbidden by synthesis, which requires component_Door.held; otherwise, after")
    why = session.children(reason)
    assert "`Base` cannot get back to a marked state" in why["otherwise"]["value"]
    assert why["would help"]["value"] == "`Door` goes from `ajar` to `held` by request to `Door.hold`"
    assert "The request to `Base.enter` cannot happen here: no requirement forbids it" in session.console("why enter")


def test_the_debug_console(session: Client, yard: Path) -> None:
    session.launch(yard)
    assert session.console("open") == "request to `Gate.open`\n    component_Gate = ajar"
    assert session.event("stopped")["description"] == "request to `Gate.open`"
    assert session.console("Gate.seen 2") == "response from `Gate.seen`\n    Gate.carts = 2"
    assert session.console('message_seen.u_response {"value": 1}') == "response from `Gate.seen`\n    Gate.carts = 1"
    assert [session.console(name) for name in ("Gate", "Gate.carts", "Gate.ajar", "Gate.shut")] == [
        "ajar",
        "1",
        "true",
        "false",
    ]
    assert session.do("evaluate", expression="Cart", context="hover")["result"] == "standing"
    assert "is not a component" in session.refused("evaluate", expression="open", context="hover")
    refusals = {
        "open": "request to `Gate.open` cannot happen: the robot is not ready for it",
        "seen {": "the data cannot be read: not JSON",
        'seen "many"': 'value is "many", expected an integer',
        "opne": "there is no event `opne`; did you mean `open`?",
        "wait long": "`wait` needs a number of seconds",
        "why": "there is no event ``",
    }
    for text, message in refusals.items():
        assert session.refused("evaluate", expression=text, context="repl").startswith(message)
    assert session.console("wait 2.4") == "2.4 s on the clock"
    assert session.console("wait 0.2") == (
        "timeout of `Gate` after 2500 ms in line 18\n    component_Gate = shut\n2.6 s on the clock"
    )
    assert session.console("help").startswith("EVENT [JSON]")
    targets = session.do("completions", text="mes", column=4)["targets"]
    assert {"label": "message_open.c_trigger", "start": 0, "length": 3} in targets
    assert [completion["label"] for completion in session.do("completions", text="why comp", column=9)["targets"]] == [
        "component_Gate.u_after1"
    ]


CRANE = ROOT / "tests" / "run" / "simulation" / "crane.rscd"


def test_a_script_in_the_words_of_scenarios(session: Client, tmp_path: Path) -> None:
    steps = [
        "request to go",
        "refuse cancel of go",
        "response from stop with true",
        "cancel to go",
        "refuse cancel of go",
        'canceled from go with {"code": 3}',
    ]
    (tmp_path / "crane.script").write_text("\n".join(steps))
    session.launch(CRANE, script="crane.script")
    told = [session.go("next")["description"] for _ in steps]
    assert told == [
        "request to `Base.go`",
        "refusal to cancel `Base.go` cannot happen: its goal is not being canceled",
        "response from `Button.stop`",
        "cancel of `Base.go`",
        "refusal to cancel `Base.go`",
        "canceled from `Base.go`",
    ]
    session.go("stepBack")
    assert session.frames()[0]["name"] == "refusal to cancel `Base.go`"
    assert session.scope("Components")["Base"]["value"] == "stopping"


def test_the_debug_console_takes_steps_of_scenarios(session: Client) -> None:
    session.launch(CRANE)
    session.console("request to go")
    refusals = {
        "refuse cancel of go": "refusal to cancel `Base.go` cannot happen: its goal is not being canceled",
        "error from go because failed": 'the reason is "failed", expected one of aborted, canceled, lost',
        "error from og": "there is no event `og.error`",
        "error from": "there is no event `error`",
        "error from go with {": "not JSON",
    }
    for text, message in refusals.items():
        assert session.refused("evaluate", expression=text, context="repl").startswith(message)
    assert "component_Base = unknown" in session.console("error from go because lost")
    session.go("stepBack")
    assert "Base.why = rejected" in session.console('go.error {"reason": "rejected"}')


def test_a_step_into_a_chosen_event(session: Client, yard: Path) -> None:
    session.launch(yard)
    targets = {target["label"]: target["id"] for target in session.do("stepInTargets", frameId=1)["targets"]}
    assert list(targets) == ["message_seen.u_response", "message_open.c_trigger"]
    stopped = session.go("stepIn", targetId=targets["message_open.c_trigger"])
    assert stopped["description"] == "request to `Gate.open`"
    assert "cannot happen here" in session.refused("stepIn", targetId=targets["message_open.c_trigger"])
    assert session.refused("stepIn", targetId=99) == "there is no such target"


def test_an_event_log_with_its_times(session: Client, yard: Path) -> None:
    """The clock follows the log, which also determines the running timers."""
    log = [
        {"time": 1000.5, "direction": "out", "event": "message_open.c_trigger"},
        {"time": 1002.0, "direction": "in", "event": "message_seen.u_response", "data": {"value": 1}},
        {"time": 1003.0, "direction": "internal", "event": "component_Gate.u_after1"},
    ]
    yard.with_name("events.jsonl").write_text("".join(f"{json.dumps(entry)}\n" for entry in log))
    session.launch(yard, script="events.jsonl")
    session.go("next")
    session.go("next")
    assert [variable["value"] for variable in session.scope("Times").values()] == ["in 1 s"]
    session.go("next")
    assert session.scope("Components")["Gate"]["value"] == "shut"
    session.go("stepBack")
    assert [variable["value"] for variable in session.scope("Times").values()] == ["in 1 s"]


def test_a_script_that_waits(session: Client, yard: Path) -> None:
    yard.with_name("wait.script").write_text("message_open.c_trigger\nwait 4\nmessage_open.c_trigger\n")
    session.launch(yard, script="wait.script")
    told = [session.go("next")["description"] for _ in range(4)]
    assert told == [
        "request to `Gate.open`",
        "timeout of `Gate` after 2500 ms in line 18",
        "4 s on the clock",
        "request to `Gate.open`",
    ]
    for _ in range(3):
        session.go("stepBack")
    assert [session.go("next")["description"] for _ in range(3)] == told[1:]
    assert [variable["value"] for variable in session.scope("Times").values()] == ["in 2.5 s"]


def test_a_counterexample_of_verify(session: Client, yard: Path) -> None:
    session.launch(yard, counterexample=True)
    assert "SP1" in session.said()
    assert session.go()["description"] == "the script is at its end"
    assert session.scope("Components")["Cart"]["value"] == "driving"
    assert [session.go("stepBack")["reason"] for _ in range(2)] == ["step", "step"]
    assert session.scope("Components")["Gate"]["value"] == "shut"


def test_a_run_at_random_is_the_same_for_the_same_seed(session: Client, yard: Path) -> None:
    told = []
    for seed in (1, 1, 2):
        before = len(session.said())
        session.prepare(yard, seed=seed, most=50, stopOnEntry=False)
        session.do("configurationDone")
        assert session.event("stopped")["description"] == "50 events have happened; continue for more"
        told.append(session.said()[before:])
    assert told[0] == told[1] != told[2]


def test_a_run_that_nothing_stops_is_paused(session: Client, yard: Path) -> None:
    session.launch(yard, most=1_000_000_000)
    session.do("continue", threadId=1)
    assert session.refused("stackTrace", threadId=1) == "the robot runs: pause it first"
    assert session.do("threads")["threads"] == [{"id": 1, "name": "Yard"}]
    assert session.do("setFunctionBreakpoints", breakpoints=[]) == {"breakpoints": []}
    session.do("pause", threadId=1)
    assert session.event("stopped")["reason"] == "pause"
    session.do("continue", threadId=1)
    session.do("disconnect")
    while session.read() is not None:
        pass


def test_nothing_can_happen(session: Client, tmp_path: Path) -> None:
    (tmp_path / "once.rscd").write_text(
        "robot Once { component A { incoming message go with type: none behaviour {"
        " initial state a { on request to go goto b } marked state b { } } } requirement go needs A.a }"
    )
    session.launch("once.rscd")
    stopped = session.go()
    assert (stopped["reason"], stopped["description"]) == ("exception", "no event can happen any more")
    assert session.go("next")["description"] == "no event can happen any more"


def test_a_model_from_cif(session: Client, tmp_path: Path) -> None:
    (tmp_path / "lamp.cif").write_text(
        "plant lamp:\n  controllable on, off;\n  location dark:\n    initial; marked;\n    edge on goto lit;\n"
        "  location lit:\n    edge off goto dark;\nend\n"
    )
    session.prepare("lamp.cif")
    told = session.do("setFunctionBreakpoints", breakpoints=[{"name": "lamp.off"}])["breakpoints"]
    assert told[0]["verified"]
    session.begin()
    assert session.go()["reason"] == "function breakpoint"
    assert session.scope("Components")["lamp"]["value"] == "dark"


def test_parameters_and_libraries(session: Client, tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "lamps.rscd").write_text(
        "library Lamps { component Lamp { incoming message lamp with type: none behaviour {"
        " initial marked state dark { on request to lamp goto lit } state lit { after pause s goto dark } } }"
        " parameter pause: integer(1..9) = 2 }"
    )
    (tmp_path / "room.rscd").write_text(
        "robot Room { component Lamp from Lamps import Lamp requirement lamp needs Lamp.dark }"
    )
    room = str(tmp_path / "room.rscd")
    program = {"program": room, "libraries": [str(tmp_path / "parts")]}
    session.do("initialize")
    assert "Lamps" in session.refused("launch", program=room)
    assert "the model has no parameter" in session.refused("launch", **program, parameters={"speed": 3})
    session.do("launch", **program, parameters={"pause": 5})
    session.event("initialized")
    session.begin()
    session.console("lamp")
    assert [variable["value"] for variable in session.scope("Times").values()] == ["in 5 s"]
