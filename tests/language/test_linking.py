"""The meaning of a name in each place (the language reference, files and names)."""

from pathlib import Path
from typing import Any

import pytest

from robosc.language.reading import Reading
from robosc.model import robosc as rsc
from tests.language.texts import reading, underlined

STOP = """
    library Safety {
      interface flag use Flag from safety_msgs
      datatype object Info { text: string }
      datatype enum Level from double to { value > 1.0 -> high default -> low }
      component Stop {
        outgoing message stop with type: Level
        outgoing message go with type: none
        behaviour {
          variable level: Level
          initial marked state running { on response from stop do level := value goto stopped }
          state stopped { on response from go goto running }
        }
      }
    }
"""


def elements(found: Reading, kind: type[Any]) -> list[Any]:
    assert found.base is not None
    return [element for element in found.base.eAllContents() if isinstance(element, kind)]


def test_a_bare_name_is_a_component_before_all_else(tmp_path: Path) -> None:
    found = reading(
        tmp_path,
        """
        robot R {
          component a { }
          component C { behaviour { variable a: boolean initial state s { transition if a } } }
        }
        """,
    )
    (access,) = elements(found, rsc.Access)
    assert isinstance(access.item, rsc.Component)


@pytest.mark.parametrize(
    ("variable", "state", "expected"),
    [("a", "a", rsc.Variable), ("x", "a", rsc.State), ("x", "s", rsc.EnumValue)],
)
def test_then_an_own_variable_an_own_state_an_enum_value(
    tmp_path: Path, variable: str, state: str, expected: type[Any]
) -> None:
    found = reading(
        tmp_path,
        f"""
        robot R {{
          datatype enum E from boolean to {{ default -> a }}
          component Other {{ behaviour {{ variable a: boolean initial state b {{ }} }} }}
          component C {{ behaviour {{
            variable {variable}: boolean
            initial state {state} {{ transition if a }}
          }} }}
        }}
        """,
    )
    assert found.findings == []
    (access,) = elements(found, rsc.Access)
    assert isinstance(access.item, expected)
    owner = None if expected is rsc.EnumValue else "C"
    assert (access.component and access.component.name) == owner


def test_another_component_needs_its_name(tmp_path: Path) -> None:
    found = reading(
        tmp_path,
        """
        robot R {
          component A { incoming message m with type: none behaviour { initial state s { } } }
          component B { behaviour { variable v: boolean initial state t { transition if s } } }
          requirement m needs A.s and B.v and not_there and t and A.v
        }
        """,
    )
    assert underlined(found) == [("unresolved-reference", name) for name in ("s", "not_there", "t", "v")]
    assert [finding.hint for finding in found.findings] == ["write `A.s`", None, "write `B.t`", "there is `s`"]


def test_every_unresolved_name_is_a_finding_with_what_may_be_meant(tmp_path: Path) -> None:
    found = reading(
        tmp_path,
        """
        robot R {
          interface twist use Twist from geometry_msgs
          datatype object Vector { length: double }
          datatype enum E from Vectr to { value > 1.0 -> far default -> near }
          datatype enum F from Vector to { value.lenght > 1.0 -> long default -> short }
          component Motor {
            incoming message move with type: Vectro links twits
            incoming message turn with type: Vector links twist
            behaviour {
              initial marked state idle { on request to mvoe goto idel }
              state busy { on request to Moter.move }
            }
          }
          requirement Motor.movee needs Motor.idel or Motro.idle
          requirement {move, trun} needs Motor.idle
          provide turn with { lenght: 1.0 }
        }
        """,
    )
    assert underlined(found) == [
        ("unresolved-reference", name)
        for name in (
            *("Vectr", "lenght", "Vectro", "twits", "mvoe", "idel", "Moter"),
            *("movee", "idel", "Motro", "trun", "lenght"),
        )
    ]
    assert {finding.hint for finding in found.findings} == {
        f"did you mean `{name}`?" for name in ("Vector", "twist", "move", "idle", "Motor", "turn", "length")
    }


def test_the_few_names_that_there_are_are_listed(tmp_path: Path) -> None:
    found = reading(
        tmp_path,
        """
        robot R {
          component Motor {
            incoming message move with type: none
            behaviour { initial marked state idle { on request to move goto off } state ^state { } }
          }
          requirement Motor.x needs Motor.y
          component Rear from L import Q
        }
        """,
        l="library L { component Wheel { } }",
    )
    assert [finding.hint for finding in found.findings] == [
        "there is `idle` or `^state`",
        "there is `move`",
        "there is `idle` or `^state`",
        "there is `Wheel`",
    ]


@pytest.mark.parametrize(
    ("called", "hint"), [("exp", "there is `abs`, `atan2`, "), ("median", "did you mean `min`?"), ("halt", "did you")]
)
def test_the_functions_that_there_are_are_listed(tmp_path: Path, called: str, hint: str) -> None:
    """A call of an unknown function draws a finding that lists the functions and shows how to declare one."""
    found = reading(
        tmp_path,
        f"""
        robot R {{
          function half(d: double): double = d / 2
          component Motor {{ incoming message move with type: double }}
          provide move with {called}(1.0)
        }}
        """,
    )
    assert underlined(found) == [("unresolved-reference", called)]
    assert str(found.findings[0].hint).startswith(hint)


def test_the_value_of_an_enum_belongs_to_no_component(tmp_path: Path) -> None:
    found = reading(
        tmp_path,
        """
        robot R {
          datatype enum Ahead from boolean to { value -> clear default -> blocked }
          component Lidar {
            incoming message move with type: none
            outgoing message scan with type: Ahead
          }
          requirement move needs Lidar.clear
        }
        """,
    )
    assert underlined(found) == [("unresolved-reference", "clear")]
    assert found.findings[0].hint == "`clear` is a value of `Ahead`: write it without a component"
    # A component of the same name would take it.
    assert not found.findings[0].edits
    assert len(found.findings[0].alternatives) == 1


def test_properties_are_looked_up_in_the_type_before_them(tmp_path: Path) -> None:
    found = reading(
        tmp_path,
        """
        robot R {
          datatype object Point { x: double }
          datatype object Path { points: array(Point) length: double }
          datatype enum E from double to { default -> e }
          component C {
            outgoing message path with type: Path
            outgoing message level with type: E
            incoming message send with type: none
            behaviour {
              variable d: double
              on response from path do d := value.points[0].x, d := value.points.x, d := value.length.x
              on response from level do d := value.x
              on request to send do d := value.whatever
              initial state s { transition if d.x > 1.0 and s.y }
            }
          }
        }
        """,
    )
    assert underlined(found) == [("unresolved-reference", name) for name in ("x", "x", "x", "x", "y")]
    assert [finding.message.rpartition(" is ")[2] for finding in found.findings] == [
        *("an array", "of type double", "an enum", "of type double", "of type boolean"),
    ]
    assert found.findings[0].hint == "write an index before it: `[0].x`"
    segments = [element.property and element.property.name for element in elements(found, rsc.PropertySegment)]
    assert segments == ["points", "x", "points", None, "length", None, None, None, None, None]


def test_an_enum_sees_values_literals_and_enum_values(tmp_path: Path) -> None:
    found = reading(
        tmp_path,
        """
        robot R {
          component C { behaviour { variable v: boolean initial state s { } } }
          datatype enum E from double to { value > 1.0 and C.v -> a value < 0.0 or s -> b default -> c }
        }
        """,
    )
    assert underlined(found) == [("unresolved-reference", "C"), ("unresolved-reference", "s")]
    assert {finding.hint for finding in found.findings} == {
        "the rules of an enum read only `value`, literals, constants, functions, its parameters and enum values"
    }


def test_a_communication_may_be_that_of_any_component(tmp_path: Path) -> None:
    found = reading(
        tmp_path,
        """
        robot R {
          component Stop from Safety import Stop
          component C {
            incoming message m with type: none
            behaviour { initial state s { on response from stop on response from Stop.go on request to m } }
          }
          requirement m needs Stop.running and Stop.level = low
        }
        """,
        safety=STOP,
    )
    assert found.findings == []
    named = {
        element.communicationType.name: element.component.name
        for element in elements(found, rsc.CommunicationReference)
    }
    assert named == {"stop": "Stop", "go": "Stop", "m": "C"}
    read = {element.item.name: element.component and element.component.name for element in elements(found, rsc.Access)}
    assert read == {"running": "Stop", "level": "Stop", "low": None}


def test_two_instances_share_names_that_need_qualification(tmp_path: Path) -> None:
    found = reading(
        tmp_path,
        """
        robot R {
          component Front from Safety import Stop
          component Rear from Safety import Stop with { stop: "/rear/stop", gone: "/x" }
          component C { behaviour { initial state s { on response from stop on response from Rear.stop } } }
        }
        """,
        safety=STOP,
    )
    assert underlined(found) == [("unresolved-reference", "gone"), ("unresolved-reference", "stop")]
    assert found.findings[1].message == "`stop` is ambiguous: it may be `Front.stop` or `Rear.stop`"
    first, second = elements(found, rsc.CommunicationReference)
    assert (first.component, first.communicationType) == (None, None)
    assert (second.component.name, second.communicationType.name) == ("Rear", "stop")
    assert [
        element.communicationType and element.communicationType.name for element in elements(found, rsc.TopicRemapping)
    ] == [
        "stop",
        None,
    ]


def test_of_many_that_may_be_meant_a_few_are_listed(tmp_path: Path) -> None:
    """Only a few candidates are listed.

    If each of many names listed all candidates, the findings would grow with the square of the text.
    """
    made = "\n".join(f"component C{number} from Safety import Stop" for number in range(300))
    found = reading(tmp_path, f"robot R {{ {made} requirement stop needs C0.running }}", safety=STOP)
    (finding,) = found.findings
    assert finding.message.endswith(
        "it may be `C0.stop`, `C1.stop`, `C2.stop`, `C3.stop`, `C4.stop`, `C5.stop` or that of 294 more"
    )
    assert len(finding.alternatives) == 6


def test_components_of_one_name_make_no_name_ambiguous(tmp_path: Path) -> None:
    made = "component C from Safety import Stop\n" * 2
    assert not reading(tmp_path, f"robot R {{ {made} requirement stop needs C.running }}", safety=STOP).findings


def test_definitions_of_an_imported_library_are_usable_by_name(tmp_path: Path) -> None:
    found = reading(
        tmp_path,
        """
        robot R {
          datatype object Info { number: integer }
          component Stop from Safety import Stop
          component C {
            outgoing message m with type: Info links flag
            behaviour { variable l: Level = high initial state s { on response from m do l := value.number } }
          }
        }
        """,
        safety=STOP,
    )
    assert found.findings == []
    assert found.base is not None
    own, level = (element.type for element in elements(found, rsc.ComplexDataTypeReference))
    assert own.eContainer() is found.base
    assert level.eContainer().name == "Safety"


def test_without_an_import_they_are_not(tmp_path: Path) -> None:
    found = reading(tmp_path, "robot R { component C { outgoing message m with type: Level } }", safety=STOP)
    assert underlined(found) == [("unresolved-reference", "Level")]


def test_a_name_that_two_imported_libraries_share_is_ambiguous(tmp_path: Path) -> None:
    other = STOP.replace("Safety", "Danger").replace("message ", "message danger_").replace("from ", "from danger_")
    other = other.replace("from danger_safety_msgs", "from safety_msgs").replace("from danger_double", "from double")
    robot = """
        robot R {
          component A from Safety import Stop
          component B from Danger import Stop
          component C { outgoing message m with type: Info links flag }
          datatype enum E from boolean to { value = (high = high) -> x default -> y }
        }
    """
    found = reading(
        tmp_path, robot, safety=STOP, danger=other.replace("message go", "message went").replace("from go", "from went")
    )
    assert (
        underlined(found)
        == [("unresolved-reference", name) for name in ("Info", "flag")] + [("unique-enum-value", "high")] * 2
    )
    assert all("the libraries `Safety` and `Danger`" in finding.message for finding in found.findings[:2])


def test_names_in_a_library_mean_what_is_in_the_library(tmp_path: Path) -> None:
    robot = """
        robot R {
          datatype enum Level from double to { default -> high }
          component Stop from Safety import Stop
          component C { outgoing message unrelated with type: none }
        }
    """
    found = reading(tmp_path, robot, safety=STOP)
    assert found.findings == []
    assert found.base is not None
    library = found.base.definitions[1].type.library
    level = next(element for element in library.eAllContents() if isinstance(element, rsc.ComplexDataTypeReference))
    assert level.type.eContainer() is library
    access = next(element for element in library.eAllContents() if isinstance(element, rsc.Access) and element.item)
    assert access.component is found.base.definitions[1].type.definition


def test_a_library_component_speaks_of_itself_only(tmp_path: Path) -> None:
    library = """
        library L {
          component A { outgoing message a with type: none behaviour { variable v: boolean initial state s { } } }
          component B { behaviour {
            initial state t { on response from a transition if A.v transition if B.t goto s }
          } }
        }
    """
    found = reading(tmp_path, library)
    assert underlined(found) == [("unresolved-reference", name) for name in ("a", "A", "s")]


def test_what_hangs_on_an_unresolved_name_is_no_finding(tmp_path: Path) -> None:
    robot = """
        robot R {
          component Stop from Safety import Stopp
          component Other from Nowhere import Thing
          component C {
            incoming message m with type: Unknown links nothing
            behaviour { variable v: Level initial state s { on response from stop do v := value.x goto gone } }
          }
          requirement halt needs Stop.running and Other.idle
          provide m with { x: 1.0, y: { z: 2 } }
        }
    """
    found = reading(tmp_path, robot, safety=STOP)
    assert underlined(found) == [("unresolved-reference", name) for name in ("Stopp", "Nowhere", "gone")]


def test_an_unknown_library_adds_nothing_to_what_is_known(tmp_path: Path) -> None:
    robot = """
        robot R {
          datatype object O { a: integer }
          component Other from Nowhere import Thing with { ready: "/ready" }
          component Stop from Safety import Stop with { gone: "/gone" }
          component C {
            incoming message m with type: O
            behaviour { initial state s { on response from Other.ready transition if value.b = 1 } }
          }
          requirement C.lost needs C.nothing or Stop.walking or Other.idle or unheard
          provide m with { c: 1 }
        }
    """
    found = reading(tmp_path, robot, safety=STOP)
    assert underlined(found) == [
        ("unresolved-reference", name) for name in ("Nowhere", "gone", "lost", "nothing", "walking", "c")
    ]
