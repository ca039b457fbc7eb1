"""Behavior of `check` that does not depend on any rule."""

from pathlib import Path
from textwrap import dedent

import pytest

from robosc.base.diagnostics import Diagnostic, as_text
from robosc.language.checks import check
from robosc.language.reading import read
from robosc.model import robosc as rsc

BROKEN_LIBRARY = """
    library Doors {
      component Door {
        outgoing message opened with type: none
        behaviour {
          initial marked state closed { on response from opened goto open }
          state open { }
        }
      }
      component Lock {
        behaviour { initial state locked { } }
      }
    }
"""


def found(folder: Path, robot: str, **libraries: str) -> list[Diagnostic]:
    """Return the findings of a robot and of the libraries beside it, those of reading included."""
    for name, text in {"robot": robot, **libraries}.items():
        (folder / f"{name}.rscd").write_text(dedent(text).lstrip())
    reading = read(folder / "robot.rscd")
    return [*reading.findings, *check(reading.base, reading.findings)]


def places(findings: list[Diagnostic]) -> list[tuple[str, int, str]]:
    return [(Path(finding.file).name, finding.span.line, finding.rule) for finding in findings]


def test_library_is_checked_once_as_itself(tmp_path: Path) -> None:
    robot = """
        robot House {
          component Front from Doors import Door
          component Rear from Doors import Door with { opened: "/rear" }
          component Lock from Doors import Lock
        }
    """
    assert places(found(tmp_path, robot, doors=BROKEN_LIBRARY)) == [
        ("doors.rscd", 6, "marked-state"),
        ("doors.rscd", 10, "marked-state"),
    ]


def test_library_of_a_library_is_checked(tmp_path: Path) -> None:
    robot = """
        robot House {
          component Front from Porch import Front
        }
    """
    porch = """
        library Porch {
          component Front from Doors import Door
        }
    """
    assert places(found(tmp_path, robot, porch=porch, doors=BROKEN_LIBRARY)) == [
        ("doors.rscd", 6, "marked-state"),
        ("doors.rscd", 10, "marked-state"),
    ]


def test_what_a_library_repeats_is_its_own_matter(tmp_path: Path) -> None:
    robot = """
        robot House {
          component Front from Doors import Front
          component Rear from Doors import Rear
        }
    """
    doors = """
        library Doors {
          component Front {
            incoming message open with identifier: "/front", type: none
          }
          component Rear {
            incoming message open with identifier: "/rear", type: none
          }
          constant a: integer = a
        }
    """
    assert places(found(tmp_path, robot, doors=doors)) == [
        ("doors.rscd", 6, "unique-communication"),
        ("doors.rscd", 8, "cyclic-definition"),
    ]


def test_what_only_an_instance_of_a_librarys_template_shows_stands_in_the_library(tmp_path: Path) -> None:
    """Faults that only an instance of a library's template shows are reported in the library.

    The robot's text has no finding, and it may have fewer lines than the library.
    """
    robot = """
        robot House {
          component Front from Doors import Door("/front")
          component Rear from Doors import Door("/rear")
        }
    """
    doors = """
        library Doors {
          component Door(topic: string) {
            outgoing message poses with identifier: topic + "/poses", type: geometry_msgs/PoseArray
            incoming message lamp with identifier: topic + "/lamp", type: boolean
            provide lamp with true if size(kept) > 0
            behaviour {
              variable kept: array(geometry_msgs/Pose)
              variable times: integer
              initial marked state shut {
                on response from poses do kept := value.poses, times := size(value.poses)
                transition if times > 3
              }
            }
          }
        }
    """
    assert places(found(tmp_path, robot, doors=doors)) == [
        ("doors.rscd", 5, "variable-type"),
        ("doors.rscd", 11, "integer-range"),
        ("doors.rscd", 11, "integer-range"),
    ]


def waiting_library(members: str) -> str:
    return f"""
        library Parts {{
          interface moving use Move from mover_msgs
          component Base {{
            {members}
          }}
        }}
    """


CANCEL_BY_STATE = """
            action drive with request: none, response: none, feedback: none links moving
            behaviour {
              initial marked state standing { on request to drive goto driving }
              state driving {
                on response from drive goto standing
                on error from drive goto standing
                on cancel from drive goto standing
              }
            }
"""
CANCEL_BY_AUTOMATON = """
            action drive with request: none, response: none, feedback: none links moving
            requirement Turns: automaton {
              initial state waiting { on request to drive goto moving }
              state moving {
                on response from drive goto waiting
                on error from drive goto waiting
                on cancel from drive goto waiting
              }
            }
"""
CANCEL_BY_VARIABLE = """
            action drive with request: none, response: none, feedback: none links moving
            incoming message open with type: none
            requirement open needs still
            behaviour {
              variable still: boolean = true
              on response from drive do still := true
              on error from drive do still := true
              on cancel from drive do still := true
              marked initial state only { on request to drive do still := false }
            }
"""
FAILURE = """
            service go with request: none, response: none
            behaviour {
              initial marked state here { on request to go goto going }
              state going { on response from go goto here }
            }
"""
ANSWER = """
            service go with request: none, response: none
            requirement go needs here
            behaviour {
              initial marked state here { on request to go goto there }
              marked state there { }
            }
"""


@pytest.mark.parametrize(
    ("rule", "members"),
    [
        ("cancel-is-not-the-end", CANCEL_BY_STATE),
        ("cancel-is-not-the-end", CANCEL_BY_AUTOMATON),
        ("cancel-is-not-the-end", CANCEL_BY_VARIABLE),
        ("failure-unheard", FAILURE),
        ("answer-unheard", ANSWER),
    ],
)
def test_who_waits_for_whom_in_a_library_stands_at_each_import(tmp_path: Path, rule: str, members: str) -> None:
    """A library by itself draws no finding. A finding about the robot's own component is in the robot's text."""
    library = waiting_library(members)
    robot = """
        robot House {
          component Left from Parts import Base
          component Right from Parts import Base
        }
    """
    waiting = [finding for finding in found(tmp_path, robot, parts=library) if finding.rule == rule]
    assert places(waiting) == [("robot.rscd", 2, rule), ("robot.rscd", 3, rule)]
    reading = read(tmp_path / "parts.rscd")
    assert rule not in {finding.rule for finding in check(reading.base, reading.findings)}
    own = [finding for finding in found(tmp_path, library.replace("library", "robot")) if finding.rule == rule]
    assert [finding.span.line > 3 for finding in own] == [True]


@pytest.mark.parametrize(
    ("rule", "ports"),
    [
        ("topic-types", ("incoming message a with {0}, type: boolean", "outgoing message b with {0}, type: string")),
        (
            "indistinct-commands",
            ("incoming message a with {0}, type: double", "incoming message b with {0}, type: double"),
        ),
        (
            "shared-server",
            (
                "service a with {0}, request: none, response: none links empty",
                "service b with {0}, request: none, response: none links trigger",
            ),
        ),
    ],
)
def test_what_shares_a_name_stands_at_the_import_or_instance_that_makes_it(
    tmp_path: Path, rule: str, ports: tuple[str, str]
) -> None:
    interfaces = "interface empty use Empty from std_srvs\n          interface trigger use Trigger from std_srvs"
    first, second = (port.format('identifier: "/shared"') for port in ports)
    library = f"""
        library Parts {{
          {interfaces}
          component One {{ {first} }}
          component Two {{ {second} }}
        }}
    """
    robot = """
        robot House {
          component Left from Parts import One
          component Right from Parts import Two
        }
    """
    assert places(found(tmp_path, robot, parts=library)) == [("robot.rscd", 3, rule)]
    reading = read(tmp_path / "parts.rscd")
    assert check(reading.base, reading.findings) == []
    made = f"""
        robot House {{
          {interfaces}
          component One {{ {first} }}
          component Two(name: string) {{ {ports[1].format("identifier: name")} }}
          component Other is Two("/other")
          component Right is Two("/shared")
        }}
    """
    assert places(found(tmp_path, made)) == [("robot.rscd", 7, rule)]


def test_a_librarys_component_mentions_itself_only(tmp_path: Path) -> None:
    robot = """
        robot House {
          component Lock from Doors import Lock
        }
    """
    doors = """
        library Doors {
          component Door {
            outgoing message opened with type: none
            behaviour { variable wide: boolean initial marked state shut { } }
          }
          component Lock {
            behaviour {
              variable locked: boolean
              initial marked state idle {
                transition if Door.shut and
                  Lock.locked do locked := Door.wide
                on response from Door.opened
              }
            }
          }
        }
    """
    findings = found(tmp_path, robot, doors=doors)
    assert places(findings) == [("doors.rscd", line, "unresolved-reference") for line in (10, 11, 12)]
    assert {finding.hint for finding in findings} == {"a component of a library reads only its own members"}


def test_repairs_escape_keywords(tmp_path: Path) -> None:
    robot = """
        robot House {
          component state {
            behaviour {
              variable ^value: integer(0..9)
              initial marked state error { transition if ^value goto error }
            }
          }
          component Lamp {
            incoming message shine with type: none
            behaviour { initial marked state dark { transition if ^error goto dark } }
          }
          requirement shine needs ^state
        }
    """
    hints = [finding.hint or "" for finding in found(tmp_path, robot)]
    assert hints == [
        "write `^state.^error`",
        "compare it, such as `^value > 0`",
        "write `^state.^value` or `^state.^error`",
    ]


def test_nothing_is_concluded_from_an_unresolved_target(tmp_path: Path) -> None:
    robot = """
        robot House {
          component Door {
            outgoing message opened with type: none
            behaviour {
              initial state closed { on response from opened goto opne }
              marked state open { }
            }
          }
          component Lock {
            behaviour { initial state locked { } }
          }
        }
    """
    assert places(found(tmp_path, robot)) == [
        ("robot.rscd", 5, "unresolved-reference"),
        ("robot.rscd", 10, "marked-state"),
    ]


def test_unresolved_names_hide_only_what_they_may_stand_for(tmp_path: Path) -> None:
    robot = """
        robot House {
          interface bell use Ring from bells
          component Door {
            outgoing message opened with type: Gap
            action close with request: none, response: none, feedback: wrong
            action open with request: none, response: none, feedback: none links wrong
            behaviour {
              initial state closed { on response from wrong goto opened }
              state opened { transition if wrong do wrong := wrong }
            }
          }
          component Bell {
            behaviour { state still { on response from wrong goto wrong } }
          }
          datatype enum Gap from double to { value > wrong -> wide }
          requirement { } needs wrong
        }
    """
    findings = [finding for finding in found(tmp_path, robot) if finding.rule != "unresolved-reference"]
    assert places(findings) == [
        ("robot.rscd", 5, "interface-link"),
        ("robot.rscd", 8, "marked-state"),
        ("robot.rscd", 9, "marked-state"),
        ("robot.rscd", 13, "initial-state"),
        ("robot.rscd", 15, "enum-default"),
        ("robot.rscd", 16, "requirement-target"),
    ]


def test_unresolved_names_draw_nothing_further(tmp_path: Path) -> None:
    robot = """
        robot House {
          component Door {
            outgoing message width with type: Widht
            incoming message open with type: none
            behaviour {
              variable last: double = nothing
              initial marked state closed {
                on response from width do last := value
                on response from widht do last := value
                transition if lats > 1.0 and wide goto closed
              }
            }
          }
          component Rear from Nowhere import Door
          requirement open needs Rear.closed and 1.0 = Door.lats
          provide opne with 3 if Rear
        }
    """
    assert {finding.rule for finding in found(tmp_path, robot)} == {"unresolved-reference", "type"}
    # `Rear` is a component even though its import is not resolved.
    types = [finding for finding in found(tmp_path, robot) if finding.rule == "type"]
    assert places(types) == [("robot.rscd", 16, "type")]


def test_unresolved_types_and_interfaces_draw_nothing_further(tmp_path: Path) -> None:
    robot = """
        robot House {
          datatype object Width { width: Widht }
          datatype enum Size from Widht to { default -> wide }
          component Door {
            outgoing message width with type: Width links nothing
            outgoing message size with type: Size
            service open with request: Widht, response: none
            action shut with request: none, response: none, feedback: none links nothing
            behaviour {
              variable last: Widht
              initial marked state closed {
                on response from width do last := value.width
                transition if last = wide and last > 3
              }
            }
          }
          requirement { opne } needs Door.closed
          provide opne with { }
        }
    """
    assert {finding.rule for finding in found(tmp_path, robot)} == {"unresolved-reference"}


@pytest.mark.parametrize(
    "imported",
    [
        'Stop from Nowhere import Stop with { stop: "/a", go: "/b" }',
        'Stop from Safety import Stopp with { stop: "/a", go: "/b" }',
        'Stop from Safety import Stop with { stopp: "/a", goo: "/b" }',
    ],
)
def test_unresolved_topics_are_not_one_and_the_same(tmp_path: Path, imported: str) -> None:
    safety = """
        library Safety {
          component Stop {
            outgoing message stop with type: none
            outgoing message go with type: none
          }
        }
    """
    findings = found(tmp_path, f"robot House {{\n  component {imported}\n}}\n", safety=safety)
    assert {finding.rule for finding in findings} == {"unresolved-reference"}


@pytest.mark.parametrize(
    "damaged",
    [
        "component Door { behaviour { state closed { on response } initial marked state open { } } }",
        "datatype enum Width from double to { value > 1.0 - > wide default -> narrow }",
        "datatype enum Width from double to { value > 1.0 -> wide default - narrow }",
        "component Door { behaviour { initial marked state closed { goto } } }",
        "component Door { behaviour { initiall marked state closed { } } }",
    ],
)
def test_damaged_text_draws_no_rule(tmp_path: Path, damaged: str) -> None:
    assert {finding.rule for finding in found(tmp_path, f"robot House {{\n  {damaged}\n}}\n")} == {"syntax"}


@pytest.mark.parametrize("number", ["1.", "1 2", "1 .5", "99999999999999999999"])
def test_a_number_that_can_not_be_read_has_no_type(tmp_path: Path, number: str) -> None:
    robot = f"""
        robot House {{
          component Door {{
            outgoing message opened with type: none
            behaviour {{
              variable width: double = {number}
              initial marked state closed {{
                on response from opened do width := {number} goto closed
                transition if width > 1.0 and width = {number} goto closed
              }}
            }}
          }}
        }}
    """
    findings = [finding for finding in found(tmp_path, robot) if finding.rule != "variable-type"]
    assert places(findings) == [("robot.rscd", line, "syntax") for line in (5, 7, 8)]


def test_ten_faults_are_ten_findings(tmp_path: Path) -> None:
    robot = """
        robot House {
          datatype enum Width from double to { value > 1 -> wide }
          datatype enum Width from double to { value -> wide default -> narrow }
          component Door {
            outgoing message width with type: Width
            outgoing message width with type: none
            behaviour {
              variable last: Width = 1
              variable last: Width
              state closed { }
              state closed { transition if last goto closed }
            }
          }
          component Door { }
        }
    """
    assert places(found(tmp_path, robot)) == [
        ("robot.rscd", 2, "enum-default"),
        ("robot.rscd", 3, "unique-datatype"),
        ("robot.rscd", 3, "type"),
        ("robot.rscd", 6, "unique-communication"),
        ("robot.rscd", 7, "initial-state"),
        ("robot.rscd", 8, "type"),
        ("robot.rscd", 9, "unique-variable"),
        ("robot.rscd", 11, "unique-state"),
        ("robot.rscd", 11, "type"),
        ("robot.rscd", 14, "unique-component"),
    ]


def test_a_model_without_text_is_checked_too() -> None:
    automaton = rsc.Automaton(definitions=[rsc.State(name="on", initial=True)])
    behaviour = rsc.ComponentBehaviour(automaton=automaton)
    lamp = rsc.Component(name="Lamp", type=rsc.LocalComponent(definitions=[behaviour]))
    (finding,) = check(rsc.Robot(name="House", file="house.rscd", definitions=[lamp]))
    assert finding.rule == "marked-state"
    assert as_text.render([finding], {}).startswith("house.rscd:1:1: error: no marked state")


def test_an_empty_model_draws_nothing() -> None:
    assert check(rsc.Robot()) == []
    bare = [rsc.Component(), rsc.ObjectDataType(), rsc.Interface(), rsc.ProvideStatement(), rsc.NeedsRequirement()]
    assert check(rsc.Library(definitions=bare)) == []


def test_libraries_that_import_each_other_are_all_checked() -> None:
    first, second = rsc.Library(name="One"), rsc.Library(name="Other")
    for base, imported in ((first, second), (second, first)):
        component = rsc.Component(name="Both")
        base.definitions.append(component)
        component.type = rsc.ImportedComponent(library=imported)
    first.definitions[0].type.definition = second.definitions[0]
    second.definitions[0].type.definition = first.definitions[0]
    second.definitions.append(rsc.EnumDataType(name="Empty"))
    assert [finding.rule for finding in check(first)] == ["enum-default"]


def test_a_second_component_of_a_name_has_no_other_finding(tmp_path: Path) -> None:
    """The second component uses the ROS types that it names, although its own name is not unique."""
    path = tmp_path / "twice.rscd"
    path.write_text("""robot R {
  component Lidar { outgoing message scan with type: sensor_msgs/LaserScan }
  component Lidar {
    service dock with request: none, response: std_srvs/Trigger
    behaviour {
      initial marked state away { on request to dock goto docking }
      state docking {
        on response from dock if value.success goto docked
        on response from dock goto away
        on error from dock goto away
      }
      marked state docked { }
    }
  }
}
""")
    reading = read(path)
    assert [found.rule for found in check(reading.base, reading.findings)] == ["unique-component"]


def test_a_missing_import_is_one_finding_with_the_import(tmp_path: Path) -> None:
    robot = """robot R {
  component Base { incoming message go with type: none incoming message halt with type: none }
  requirement go needs Stop.in_service
  requirement halt needs !Stop.in_service
  requirement Stop.in_service disables halt
}
"""
    path = tmp_path / "robot.rscd"
    path.write_text(robot)
    (finding,) = read(path).findings
    assert finding.message == "there is no component or variable `Stop`"
    assert [other.span.line for other in finding.related] == [4, 5]
    imported = "component Stop from EmergencyStopLibrary import EmergencyStop"
    assert finding.hint == f"import it: `{imported}`"
    path.write_text(robot.replace("robot R {", f"robot R {{\n  {imported}"))
    assert read(path).findings == []


def test_a_short_name_is_no_missing_import(tmp_path: Path) -> None:
    path = tmp_path / "robot.rscd"
    path.write_text("""robot R {
  component Base { incoming message go with type: none }
  requirement go needs To.be
}
""")
    assert [finding.hint for finding in read(path).findings] == ["there is `Base`"]


def test_a_name_that_is_close_is_no_missing_import(tmp_path: Path) -> None:
    path = tmp_path / "robot.rscd"
    path.write_text("""robot R {
  component Stopper { behaviour { initial marked state on_call { } } }
  component Base { incoming message go with type: none incoming message halt with type: none }
  requirement go needs Stoper.on_call
  requirement halt needs Stoper.on_call
}
""")
    assert [finding.hint for finding in read(path).findings] == ["did you mean `Stopper`?"] * 2
