"""Statements about the language's second edition that no other test covers, each in a small robot."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

import robosc
from robosc.base.diagnostics import ModelError, Severity
from robosc.engine import Engine
from robosc.model import rosgraph, sct
from robosc.model.reflection import tree
from tests.language.second_edition import errors, running, supervised

if TYPE_CHECKING:
    from pathlib import Path

    from robosc.base.diagnostics import Diagnostic

# Names

USES = """robot R {
  datatype enum Kind from integer(0..9) to { value > 5 -> big default -> small }
  constant yes: boolean = true
  constant third: integer = 2
  constant half: double = 0.5
  constant name: string = "a" + "b"
  constant kind: Kind = big
  component C(ns: string, most: integer(0..9) = 4, wanted: Kind = small) {
    outgoing message told with identifier: ns + "/told", type: Kind
    outgoing message scan with identifier: ns + "/scan", type: sensor_msgs/LaserScan
    incoming message say with identifier: ns + "/say", type: string
    incoming message turn with identifier: ns + "/turn", type: double
    incoming message go with identifier: ns + "/go", type: none
    requirement go needs seen = wanted and level < most
    requirement at most third go since told
    provide say with name
    provide turn with far * half
    behaviour {
      variable seen: Kind = kind
      variable level: integer(0..third + 7) = third
      variable far: double = half
      initial marked state here {
        after half s do level := third
        on response from told do seen := value
        on response from scan do far := value.ranges[third]
      }
    }
  }
  component Left is C("/" + name, wanted: kind)
}"""


def test_a_constant_of_each_type_in_each_place() -> None:
    """A constant of each type is usable wherever a literal is.

    These places are range bounds, indexes, durations, initial values, arguments, `at most N` and parts of identifiers.
    M2M folds constants.
    """
    model = supervised(USES)
    engine = Engine(model)
    assert (engine.state["Left.seen"], engine.state["Left.level"]) == ("big", 2)
    (level,) = [variable for plant in model.plants for variable in plant.variables if variable.name == "level"]
    assert (level.type.minimum, level.type.maximum) == (0, 9)
    assert [timer.milliseconds for timer in tree_of(model, sct.Timer)] == [500]
    assert [plant.topic for plant in model.plants if plant.name == "message_go"] == ["/ab/go"]
    for _ in range(2):
        assert engine.perform("message_go.c_trigger")
    assert not engine.enabled("message_go.c_trigger")
    graph = robosc.to_rosgraph(robosc.load(text=USES))
    (index,) = tree_of(graph, rosgraph.IndexStep)
    assert index.position.value == 2


def tree_of(root: object, kind: type) -> list[object]:
    return [part for _, part in tree(root) if isinstance(part, kind)]


LIBRARY = """library {0} {{
  {1}
  constant most: integer = 5
  constant least: integer = 2
  function below(n: integer): boolean = n < least
  component Tank {{
    outgoing message level with identifier: "/level", type: integer(0..9)
    incoming message fill with identifier: "/fill", type: boolean
    constant most: integer = 7
    condition low = level < most
    requirement fill needs low
    provide fill with low
    behaviour {{
      variable level: integer(0..9)
      initial marked state here {{ on response from level do level := value }}
    }}
  }}
}}"""


def found(folder: Path, **texts: str) -> list[Diagnostic]:
    """Return the errors of the file `robot.rscd` with other files in its folder."""
    for name, text in texts.items():
        (folder / f"{name}.rscd").write_text(text, encoding="utf-8")
    try:
        findings = robosc.check(robosc.load(folder / "robot.rscd"))
    except ModelError as error:
        findings = list(error.diagnostics)
    return [finding for finding in findings if finding.severity is Severity.ERROR]


@pytest.mark.parametrize(
    ("condition", "levels"),
    [
        ("Tank.level > most", range(6, 10)),  # the constant of the library
        ("below(Tank.level)", range(2)),
        ("Tank.low", range(7)),
        ("Tank.level < Tank.most", range(7)),  # the constant of the component
    ],
)
def test_names_of_a_directly_imported_library(tmp_path: Path, condition: str, levels: range) -> None:
    """A bare name is one of the robot or library, then one of a directly imported library.

    Names in a component are resolved in the component first.
    """
    robot = f"""robot R {{
      component Tank from Tanks import Tank
      component Base {{ incoming message go with type: none }}
      requirement go needs {condition}
    }}"""
    assert found(tmp_path, Tanks=LIBRARY.format("Tanks", ""), robot=robot) == []
    model = robosc.to_sct(robosc.load(tmp_path / "robot.rscd"))
    robosc.synthesize(model)
    engine = Engine(model)
    held = []
    for level in range(10):
        engine.perform("message_level.u_response", {"i_response": level})
        held += [level] if engine.enabled("message_go.c_trigger") else []
        assert engine.enabled("message_fill.c_trigger") == (level < 7)
    assert held == list(levels)


@pytest.mark.parametrize(
    "declared", ["condition c = Tank.level > 1", "function f(n: integer): boolean = Tank.level > n"]
)
def test_a_library_speaks_of_its_components_in_them(tmp_path: Path, declared: str) -> None:
    """A condition beside its components would be ambiguous: a robot may have several of a component, or none."""
    text = LIBRARY.format("Tanks", declared)
    robot = "robot R { component Tank from Tanks import Tank component Other from Tanks import Tank }"
    (finding,) = found(tmp_path, Tanks=text, robot=robot)
    assert (finding.rule, finding.span.line) == ("unresolved-reference", 2)
    assert finding.message == "there is no component or variable `Tank`"
    assert finding.hint is not None
    assert finding.hint.endswith("write this in the component")


def test_the_robots_own_name_comes_before_the_librarys_and_no_other_librarys_is_there(tmp_path: Path) -> None:
    """A bare name is one of the robot or library, then one of a directly imported library."""
    robot = """robot R {
      component Tank from Tanks import Tank
      component Base { incoming message go with type: none }
      CONSTANT
      requirement go needs Tank.level > most and Tank.level > deep
    }"""
    tanks = LIBRARY.format("Tanks", "component Pump from Pumps import Pump")
    pumps = "library Pumps { constant deep: integer = 1 component Pump { outgoing message ran with type: none } }"
    (finding,) = found(tmp_path, Tanks=tanks, Pumps=pumps, robot=robot.replace("CONSTANT", ""))
    assert finding.rule == "unresolved-reference"
    assert "deep" in finding.message
    own = robot.replace("CONSTANT", "constant most: integer = 0 constant deep: integer = 0")
    assert found(tmp_path, Tanks=tanks, Pumps=pumps, robot=own) == []
    model = robosc.to_sct(robosc.load(tmp_path / "robot.rscd"))
    robosc.synthesize(model)
    engine = Engine(model)
    engine.perform("message_level.u_response", {"i_response": 1})
    assert engine.enabled("message_go.c_trigger")


@pytest.mark.parametrize(
    ("definitions", "rule"),
    [
        ("parameter a: integer(0..1) = 1 constant a: integer = 1", "unique-component"),
        ("function C(n: integer): integer = n", "unique-component"),
        ("condition a = true function a(n: integer): integer = n", "unique-component"),
        ("requirement C: never C.other", "unique-component"),
        ("property a: never C.other constant a: integer = 1", "unique-component"),
        ("component D { parameter here: integer(0..1) = 1 behaviour { initial marked state here { } } }", "unique-var"),
        ("component D { condition a = true function a(n: integer): integer = n }", "unique-variable"),
    ],
)
def test_names_are_unique_with_their_neighbours(definitions: str, rule: str) -> None:
    """A new name must be unique among its neighbors.

    The rule is `unique-variable` in a component and `unique-component` in a robot.
    """
    component = "component C { behaviour { initial marked state here { } state other { } } }"
    text = f"robot R {{ {component} {definitions} }}"
    assert [found for found, _ in errors(text) if found.startswith(rule)], errors(text)


# Expressions


DATA = """robot R {
  datatype object Scan { ranges: array(double) name: string ok: boolean pick: integer }
  interface link use Scan from my_msgs
  parameter reach: double(0.1..2.0) = 0.5
  component C {
    outgoing message scan with type: Scan links link
    incoming message go with type: none
    behaviour {
      variable hits: integer(0..9)
      variable flag: boolean
      variable text: string
      variable far: double
      variable kept: array(double)
      initial marked state here { on response from scan do ASSIGNED }
    }
  }
  requirement go needs NEEDS
}"""


def data(assigned: str, needs: str = "C.flag or C.hits > 8") -> str:
    return DATA.replace("ASSIGNED", assigned).replace("NEEDS", needs)


@pytest.mark.parametrize(
    "node_side",
    [
        "far := double(value.pick) / 2",
        "far := sqrt(value.ranges[value.pick + 1])",
        "far := min(value.ranges[0..value.pick])",
        "far := atan2(sin(value.ranges[0]), cos(1.0))",
        "kept := value.ranges, far := max(kept)",
        "far := kept[size(kept) - 1]",
        "text := value.name",
        "far := double(size(value.name))",
    ],
)
def test_doubles_strings_and_arrays_are_of_the_node(node_side: str) -> None:
    """Expressions on doubles, strings and arrays belong to the node. There, an index may be any integer expression."""
    model = supervised(data(node_side))
    assert [given.name for plant in model.plants for given in plant.inputs] == []
    reactions = robosc.to_rosgraph(robosc.load(text=data(node_side))).reactions
    assert [len(reaction.assignments) for reaction in reactions] == [node_side.count(":=")]


@pytest.mark.parametrize(
    ("assigned", "inputs"),
    [
        ("hits := size(value.name)", ["size(value.name)"]),
        ("hits := size(value.ranges)", ["size(value.ranges)"]),
        ("flag := value.ranges[0] < reach", ["value.ranges[0] < reach"]),
        ("flag := any r in value.ranges[0..20]: r < reach", ["(any r in value.ranges[0..20]: r < reach)"]),
        ("hits := count r in value.ranges: r < reach", ["(count r in value.ranges: r < reach)"]),
        ('flag := value.ok and value.name = "dock"', ['value.ok and value.name = "dock"']),
        ("hits := if value.ok then round(value.ranges[0]) else hits", [None, "round(value.ranges[0])"]),
    ],
)
def test_what_simply_works(assigned: str, inputs: list[str | None]) -> None:
    """Each largest sub-expression with `value` that is a boolean, enum or integer is one more input.

    Its operands are `value`, literals, enum values, constants and parameters.
    """
    model = supervised(data(assigned))
    assert [given.text for plant in model.plants for given in plant.inputs] == inputs


QUANTIFIED = """robot R {
  component Tank(ns: string) {
    outgoing message level with identifier: ns + "/level", type: integer(0..3)
    behaviour {
      variable level: integer(0..3)
      initial marked state used { on response from level do level := value }
    }
  }
  component Left is Tank("/left")
  component Right is Tank("/right")
  condition some = any Tank: Tank.level > 1
  component Base {
    incoming message go with type: none
    incoming message say with type: boolean
    behaviour { initial marked state idle { transition if all Tank: Tank.level > 1 goto done } marked state done { } }
  }
  requirement go needs some
  requirement SR1: always (count Tank: Tank.level > 1) < 3 or Base.done
  provide say with true if (count Tank: Tank.level > 1) = 1
}"""


def test_quantifiers_stand_in_guards_requirements_conditions_and_provide_conditions() -> None:
    """Quantifiers are usable in guards, requirements, conditions and provide conditions."""
    engine = running(QUANTIFIED)
    (tau,) = [event for event in engine.events if "tau" in event]
    names = ("message_go.c_trigger", tau, "data_say.c_d1")
    seen = [tuple(engine.enabled(name) for name in names)]
    for tank in ("Left", "Right"):
        engine.perform(f"message_{tank}_level.u_response", {"i_response": 2})
        seen.append(tuple(engine.enabled(name) for name in names))
    assert seen == [(False, False, False), (True, False, True), (True, True, False)]


GRIPPERS = """library Grippers {
  component Finger {
    outgoing message bent with type: boolean
    behaviour {
      initial marked state straight { on response from bent if value goto crooked }
      marked state crooked { on response from bent if !value goto straight }
    }
  }
  component Thumb is Joint("/thumb")
  component Joint(ns: string) {
    outgoing message locked with identifier: ns + "/locked", type: none
    behaviour { initial marked state free { on response from locked goto fixed } marked state fixed { } }
  }
  condition at_ease = all Joint: Joint.free
}"""


def test_quantifiers_range_over_components_of_libraries(tmp_path: Path) -> None:
    """Quantifiers range over the instances of a library component, also one of a directly imported library."""
    robot = """robot R {
      component One from Grippers import Finger with { bent: "/one" }
      component Two from Grippers import Finger with { bent: "/two" }
      component Base { incoming message go with type: none }
      requirement go needs (count Finger: Finger.crooked) = 1
    }"""
    assert found(tmp_path, Grippers=GRIPPERS, robot=robot) == []
    model = robosc.to_sct(robosc.load(tmp_path / "robot.rscd"))
    robosc.synthesize(model)
    engine = Engine(model)
    seen = [engine.enabled("message_go.c_trigger")]
    for finger in ("One", "Two"):
        engine.perform(f"message_{finger}_bent.u_response", {"i_response": True})
        seen.append(engine.enabled("message_go.c_trigger"))
    assert seen == [False, True, False]


@pytest.mark.parametrize("condition", ["at_ease", "all Joint: Joint.free"])
def test_a_condition_of_a_library_ranges_over_instances_of_its_template(tmp_path: Path, condition: str) -> None:
    """A quantifier may name a component of a directly imported library.

    In a library, it ranges over the library's instances.
    """
    robot = f"""robot R {{
      component Thumb from Grippers import Thumb
      component Index from Grippers import Joint("/index")
      component Base {{ incoming message go with type: none }}
      requirement go needs {condition}
    }}"""
    assert found(tmp_path, Grippers=GRIPPERS, robot=robot) == []
    for joint in ("Thumb", "Index"):
        model = robosc.to_sct(robosc.load(tmp_path / "robot.rscd"))
        robosc.synthesize(model)
        engine = Engine(model)
        assert engine.enabled("message_go.c_trigger")
        engine.perform(f"message_{joint}_locked.u_response")
        assert not engine.enabled("message_go.c_trigger")


# Transitions

ACTION = """robot R {
  interface go use Go from my_msgs
  datatype object Feedback { near: boolean }
  datatype object Answer { good: boolean }
  component C {
    action go with request: none, response: Answer, feedback: Feedback links go
    service ask with request: none, response: none
    outgoing message stop with type: none
    behaviour {
      variable held: boolean
      initial marked state here {
        on feedback from go if value.near goto there
        on error from go if held goto there
        on error from ask if held goto there
        on cancel from go if held goto there
        on response from go if value.good goto there
        on response from stop do held := !held
      }
      marked state there { on response from stop do held := false goto here }
    }
  }
  requirement go needs !C.held
  requirement ask needs C.here
}"""


@pytest.mark.parametrize(
    ("events", "data"),
    [
        (["action_go.c_trigger", "action_go.u_feedback"], {"i_feedback_near": False}),
        (["action_go.c_trigger", "action_go.u_error"], {}),
        (["action_go.c_trigger", "action_go.u_response"], {"i_response_good": False}),
        (["service_ask.c_trigger", "service_ask.u_error"], {}),
    ],
)
def test_where_none_holds_an_error_or_feedback_leaves_the_component_as_it_is(
    events: list[str], data: dict[str, bool]
) -> None:
    """If no condition is true, an error or feedback leaves the component unchanged."""
    engine = running(ACTION)
    assert engine.perform(events[0])
    assert engine.perform(events[1], data)
    assert engine.state["component_C"] == "here"


@pytest.mark.parametrize(("condition", "state"), [("held", "there"), ("!held", "here")])
def test_where_none_holds_a_cancel_leaves_the_component_as_it_is(condition: str, state: str) -> None:
    """If no condition is true, a cancel leaves the component unchanged."""
    engine = running(ACTION.replace("cancel from go if held", f"cancel from go if {condition}"))
    assert engine.perform("action_go.c_trigger")
    assert engine.perform("message_stop.u_response")
    assert engine.perform("action_go.c_cancel")
    assert engine.state["component_C"] == state


TIMED = """robot R {{
  constant hold: integer = 3
  parameter pause: double(0.1..5.0) = 0.5
  parameter free: double = 0.5
  component Eye {{ outgoing message scan with type: none service see with request: none, response: none }}
  component C {{
    incoming message go with type: none
    outgoing message seen with type: none
    behaviour {{
      variable n: integer(0..3)
      {}
      initial marked state here {{ {} }}
      marked state there {{ }}
    }}
  }}
}}"""


@pytest.mark.parametrize(
    ("level", "state", "found"),
    [
        ("", "after hold s do n := 1 goto there", None),
        ("", "after pause s goto there", None),
        ("", "after pause ms without scan, seen goto there", "duration"),
        ("after 1 min without scan do n := 2", "", None),
        ("after 1 min without Eye.scan, C.seen goto there", "", None),
        ("", "after 3 s if n = 1 goto there", "syntax"),
        ("after 3 s goto there", "", "duration"),
        ("", "after free s goto there", "duration"),
        ("", "after n s goto there", "type"),
        ("", "after true s goto there", "type"),
        ("", "after 3 s without go goto there", "result-type"),
        ("", "after 3 s without see goto there", "result-type"),
        ("", "after 3 s do n := value goto there", "type"),
    ],
)
def test_where_a_time_may_stand(level: str, state: str, found: str | None) -> None:
    """The permitted parts of `after`.

    `do` is permitted, `if` is not. The duration is a constant or parameter of type integer or double. `without` names
    outgoing messages of any component; at automaton level it is required.
    """
    assert [rule for rule, _ in errors(TIMED.format(level, state))] == ([found] if found else [])


# Data


@pytest.mark.parametrize(
    ("declared", "stored", "found"),
    [
        ("array(double)", "value.ranges", []),
        ("Scan", "value", []),
        ("string", "value.name", []),
        ('string = "a"', "value.name", []),
        ("double = 0.5", "value.ranges[0]", []),
        ("array(double) = 1.0", "value.ranges", ["variable-type"]),
        ("array(double) = [1.0]", "value.ranges", ["syntax"]),
        ("Scan = 1.0", "value", ["variable-type"]),
    ],
)
def test_variables_of_the_node(declared: str, stored: str, found: list[str]) -> None:
    """Variables may be objects, arrays, strings and doubles, and hold the data of an event.

    Arrays and objects have no initial value.
    """
    text = data(f"flag := true, a := {stored}").replace("variable text", f"variable a: {declared} variable text")
    assert [rule for rule, _ in errors(text)] == found


def test_variables_of_a_ros_type() -> None:
    """Variables may be of a data type or a ROS type."""
    text = data("flag := value.range_min > 0.5, a := value").replace(
        "type: Scan links link", "type: sensor_msgs/LaserScan"
    )
    assert errors(text.replace("variable text", "variable a: sensor_msgs/LaserScan variable text")) == []


PROVIDING = """library Base {
  component Lamp {
    incoming message lit with identifier: "/lit", type: boolean
    outgoing message told with identifier: "/told", type: none
    requirement lit needs up
    provide lit with true if up
    behaviour {
      initial marked state up { on response from told goto down }
      marked state down { on response from told goto up }
    }
  }
}"""


@pytest.mark.parametrize(
    ("robot", "statements"),
    [
        ("", [[True], [False]]),
        ("provide lit with false if Lamp.down", [[False], [True]]),
        ("provide lit with false if Lamp.down provide lit with true if Lamp.up", [[False, True], [True, False]]),
    ],
)
def test_statements_of_the_robot_replace_those_of_a_library(
    tmp_path: Path, robot: str, statements: list[list[bool]]
) -> None:
    """Statements for a communication outside a component replace those inside it.

    The robot's replace those of a library.

    `provide` and `requirement` may be in components, also in libraries.
    """
    assert found(tmp_path, Base=PROVIDING, robot=f"robot R {{ component Lamp from Base import Lamp {robot} }}") == []
    model = robosc.to_sct(robosc.load(tmp_path / "robot.rscd"))
    robosc.synthesize(model)
    engine = Engine(model)
    names = [event for event in engine.events if event.startswith("data_lit.c_d")]
    seen = []
    for up in (True, False):
        assert engine.enabled("message_lit.c_trigger") == up
        seen.append([engine.enabled(name) for name in names])
        engine.perform("message_told.u_response")
    assert seen == statements


@pytest.mark.parametrize(
    ("declared", "found"),
    [
        ('incoming message m with identifier: "/m", type: Scan, send: change links link', []),
        ('incoming message m with type: boolean, send: change, identifier: "/m"', ["syntax"]),
        ("incoming message m with send: change, type: boolean", ["syntax"]),
        ("outgoing message m with type: boolean, send: change", ["requirement-event"]),
        ("service m with request: none, response: none, send: change", ["syntax"]),
        ("incoming message m with type: boolean, send: always", ["syntax"]),
    ],
)
def test_where_send_change_may_stand(declared: str, found: list[str]) -> None:
    """`send` is the last part, before `links`; only incoming messages have it."""
    text = data("flag := true").replace("incoming message go", f"{declared} incoming message go")
    assert [rule for rule, _ in errors(text)][:1] == found


# Components made several times


def test_arguments_are_read_where_they_stand() -> None:
    """Names in arguments are resolved outside the component that receives them."""
    text = """robot R {
      constant here: string = "/robot"
      constant most: integer = 4
      component Bumper(ns: string, most: integer(0..9)) {
        outgoing message hit with identifier: ns + "/hit", type: none
        incoming message lamp with identifier: ns + "/lamp", type: none
        constant least: integer = 1
        requirement lamp needs left > least
        behaviour {
          variable left: integer(0..most) = most
          initial marked state here { on response from hit do left := left - least }
        }
      }
      component Left is Bumper(here + "/left", most: most + 1)
    }"""
    model = supervised(text)
    assert [plant.topic for plant in model.plants if plant.topic] == ["/robot/left/hit", "/robot/left/lamp"]
    assert [variable.type.maximum for plant in model.plants for variable in plant.variables] == [5]
    assert errors(text.replace("most + 1", "least")) == [("unresolved-reference", 14)]


@pytest.mark.parametrize(("topic", "lines"), [('ns + "/told"', []), ('"/told"', [3])])
def test_instances_on_one_topic(topic: str, lines: list[int]) -> None:
    """Two `outgoing` messages on one topic draw `unique-topic`."""
    text = f"""robot R {{
      component Bumper(ns: string) {{
        outgoing message told with identifier: {topic}, type: none
        incoming message lit with identifier: ns + "/lit", type: none
        requirement lit needs true
      }}
      component Left is Bumper("/left")
      component Right is Bumper("/right")
    }}"""
    drawn = robosc.check(robosc.load(text=text))
    assert [(finding.rule, finding.span.line) for finding in drawn] == [("unique-topic", line) for line in lines]


# Requirements

ARM = """robot R {{
  interface go use Go from my_msgs
  component Arm {{
    incoming message grip with type: none
    outgoing message home with type: none
    service dock with request: none, response: none
    action move with request: none, response: none, feedback: none links go
  }}
  {}
}}"""


@pytest.mark.parametrize(
    ("requirement", "event"),
    [
        ("grip after home", "message_home.u_response"),
        ("grip after response from home", "message_home.u_response"),
        ("grip after dock", "service_dock.c_trigger"),
        ("grip after request to Arm.dock", "service_dock.c_trigger"),
        ("grip after error from dock", "service_dock.u_error"),
        ("grip after feedback from move", "action_move.u_feedback"),
    ],
)
def test_events_are_named_as_in_transitions(requirement: str, event: str) -> None:
    """Events have the same names as in transitions.

    A bare communication means its request, a bare outgoing message its response.
    """
    engine = running(ARM.format(f"requirement {requirement}"))
    assert not engine.enabled("message_grip.c_trigger")
    before = {"service_dock.u_error": "service_dock.c_trigger", "action_move.u_feedback": "action_move.c_trigger"}
    if event in before:
        engine.perform(before[event])
        assert not engine.enabled("message_grip.c_trigger")
    engine.perform(event)
    assert engine.enabled("message_grip.c_trigger")


@pytest.mark.parametrize(
    "inside",
    [
        "initial state a { on grip do x := 1 }",
        "initial state a { after 3 s goto a }",
        "initial state a { transition goto a }",
        "initial state a { } after 3 s without home goto a",
    ],
)
def test_what_an_automaton_has_not(inside: str) -> None:
    """Variables, `do`, silent transitions, `after` and automaton-level transitions are not permitted (`syntax`)."""
    assert [rule for rule, _ in errors(ARM.format(f"requirement T: automaton {{ {inside} }}"))][:1] == ["syntax"]


@pytest.mark.parametrize("kind", ["requirement", "property"])
@pytest.mark.parametrize(("head", "name"), [("", None), ("A1: ", "A1"), ('A1 "why": ', "A1"), ('"why": ', None)])
def test_a_name_a_name_and_a_text_or_a_text(kind: str, head: str, name: str | None) -> None:
    """Any requirement or property may have a name, a name and a text, or a text before a colon."""
    text = ARM.format(f"{kind} {head}never Arm.lifted")
    text = text.replace("action move", "behaviour { initial marked state down { } state lifted { } } action move")
    model = supervised(text)
    (stated,) = model.invariants if kind == "requirement" else model.properties
    assert (stated.name, stated.text) == (name, f"{kind} {head}never Arm.lifted")
