"""Names for values and conditions, and components with several instances, statement by statement."""

from __future__ import annotations

import pytest

import robosc
from robosc.model import sct
from tests.language.second_edition import errors, requirements, running, supervised

_ROBOT = """robot Cart {{
  {names}
  component Base {{
    incoming message move with type: double
    outgoing message hit with identifier: "/hit", type: integer(0..9)
    {inside}
    behaviour {{
      variable left: integer(0..9) = 3
      initial marked state idle {{ on response from hit do left := value }}
    }}
  }}
  requirement move needs {needs}
}}"""


def _robot(names: str = "", inside: str = "", needs: str = "Base.left > 0") -> str:
    return _ROBOT.format(names=names, inside=inside, needs=needs)


def _holds(text: str, *values: int) -> list[bool]:
    """Return for each of these values whether `move` is possible after `hit`."""
    engine = running(text)
    found = []
    for value in values:
        engine.perform("message_hit.u_response", {"i_response": value})
        found.append(engine.enabled("message_move.c_trigger"))
    return found


@pytest.mark.parametrize(
    ("declared", "condition"),
    [
        ("constant yes: boolean = 1 < 2 and !false", "yes and Base.left > 5"),
        ("constant most: integer = 2 * 3 - 1", "Base.left > most"),
        ("constant most: integer = mod(-2, 7)", "Base.left > most"),
        ("constant half: double = 10.0 / 2", "Base.left > half"),
        ("constant a: integer = b constant b: integer = 5", "Base.left > a"),
    ],
)
def test_a_constant_is_usable_wherever_a_literal_is(declared: str, condition: str) -> None:
    """A constant (boolean, integer, double, string or enum) is usable wherever a literal is.

    Its value is a constant expression.
    """
    assert _holds(_robot(declared, needs=condition), 5, 6) == [False, True]


def test_a_constant_lies_in_its_range() -> None:
    """A constant outside its range is `integer-range`."""
    assert {rule for rule, _ in errors(_robot("constant most: integer(0..4) = 5"))} == {"integer-range"}


def test_constants_in_bounds_initial_values_and_identifiers() -> None:
    """Constants in range bounds, initial values, arguments, and parts of identifiers (`ns + "/scan"`)."""
    text = _robot('constant most: integer = 4 constant ns: string = "/left"')
    text = text.replace('identifier: "/hit"', 'identifier: ns + "/hit"').replace(
        "(0..9) = 3", "(0..most * 2) = most - 1"
    )
    model = supervised(text)
    plants = {plant.name: plant for plant in model.plants}
    (left,) = plants["component_Base"].variables
    assert (left.type.minimum, left.type.maximum, left.initial.value) == (0, 8, 3)
    assert plants["message_hit"].topic == "/left/hit"


def test_strings_are_joined_in_constant_expressions_only() -> None:
    """`+` joins strings in constant expressions only."""
    text = _robot('constant ns: string = "/a" + "/b"').replace(
        "left: integer(0..9) = 3", "left: integer(0..9) = 3 variable t: string"
    )
    assert errors(text) == []
    assert errors(text.replace("do left := value", 'do left := value, t := t + "x"')) == [("type", 9)]


@pytest.mark.parametrize(
    "names",
    [
        "constant a: integer = b constant b: integer = a",
        "condition a = b condition b = !a",
        "function f(n: integer): integer = f(n - 1)",
    ],
)
def test_a_cycle_is_cyclic_definition(names: str) -> None:
    """A cycle is `cyclic-definition`; a function is not recursive."""
    assert "cyclic-definition" in {rule for rule, _ in errors(_robot(names))}


def test_a_condition_is_inlined_and_texts_for_people_keep_its_name() -> None:
    """A condition is inlined; texts for readers keep its name."""
    text = _robot("condition some = Base.left > 2 condition few = some and Base.left < 6", needs="few")
    assert _holds(text, 2, 3, 5, 6) == [False, True, True, False]
    assert requirements(text) == ["requirement move needs few"]


def test_conditions_in_guards_and_provide_conditions() -> None:
    """Conditions are usable in guards, requirements, provide conditions and conditions."""
    text = _robot(inside="condition calm = left > 2 provide move with 0.5 if calm").replace(
        "initial marked state idle {", "initial marked state idle { transition if calm and left < 5 do left := 9 "
    )
    engine = running(text)
    (tau,) = [event for event in engine.events if "tau" in event]
    assert engine.enabled(tau)
    assert engine.enabled("data_move.c_d1")
    engine.perform("message_hit.u_response", {"i_response": 1})
    assert not engine.enabled(tau)
    assert not engine.enabled("data_move.c_d1")


def test_a_function_is_inlined_and_legal_where_its_body_is() -> None:
    """A function is an expression of its parameters, constants and node parameters.

    It is legal where its inlined body is.
    """
    names = "constant step: integer = 2 function twice(n: integer): integer = step * n"
    assert _holds(_robot(names, needs="twice(Base.left) > 6"), 3, 4) == [False, True]
    doubled = "function far(d: double): boolean = d > 0.5"
    assert errors(_robot(doubled, needs="far(Base.left / 2)")) == []


@pytest.mark.parametrize("call", ["far()", "far(1.0, 2.0)", "far(true)"])
def test_a_wrong_call_is_argument(call: str) -> None:
    """A wrong call is `argument`."""
    assert "argument" in {rule for rule, _ in errors(_robot("function far(d: double): boolean = d > 0.5", needs=call))}


def test_what_a_bare_name_is() -> None:
    """The meanings of a bare name, in order.

    A parameter, a component, a name of the own component, a name of the robot, an enum value.
    """
    names = "constant left: integer = 8 constant most: integer = 1"
    inside = "constant most: integer = 4 condition here = left > most function over(left: integer): boolean = left > 7"
    assert _holds(_robot(names, inside, needs="Base.here"), 4, 5) == [False, True]
    assert _holds(_robot(names, inside + " condition named = over(left)", needs="Base.named"), 7, 8) == [False, True]
    assert _holds(_robot(names, inside, needs="Base.left > most"), 1, 2) == [False, True]


def test_a_component_has_constants_and_conditions_too() -> None:
    """`X.y` names a member of a component (its constants and conditions, too) or of an enum."""
    text = _robot(inside="constant most: integer = 4", needs="Base.left > Base.most")
    assert _holds(text, 4, 5) == [False, True]
    enums = "datatype enum Size from integer(0..9) to { value > 5 -> big default -> small }"
    text = _robot(enums, needs="Base.size = Size.big").replace("type: integer(0..9)", "type: Size")
    text = text.replace("left: integer(0..9) = 3", "size: Size").replace("left := value", "size := value")
    engine = running(text)
    assert not engine.enabled("message_move.c_trigger")
    engine.perform("message_hit.u_response", {"i_response": "big"})
    assert engine.enabled("message_move.c_trigger")


def test_enums_may_share_values_and_a_bare_value_is_of_one_enum_only() -> None:
    """Enums may share values, but a bare value must belong to one enum only. Several rules may give the same value."""
    enums = """datatype enum Size from integer(0..9) to { value > 7 -> big value < 2 -> big default -> small }
      datatype enum Age from integer(0..9) to { value > 5 -> old default -> small }"""
    text = _robot(enums, needs="Base.size = Size.small").replace("type: integer(0..9)", "type: Size")
    text = text.replace("left: integer(0..9) = 3", "size: Size").replace("left := value", "size := value")
    assert errors(text) == []
    assert {rule for rule, _ in errors(text.replace("Size.small", "small"))} == {"unique-enum-value"}


@pytest.mark.parametrize(
    ("names", "inside", "rule"),
    [
        ("constant a: integer = 1 condition a = true", "", "unique-component"),
        ("constant Base: integer = 1", "", "unique-component"),
        ("", "constant left: integer = 1", "unique-variable"),
    ],
)
def test_new_names_are_unique_with_their_neighbours(names: str, inside: str, rule: str) -> None:
    """A new name must be unique among its neighbors.

    The rule is `unique-variable` in a component and `unique-component` in a robot.
    """
    assert rule in {found for found, _ in errors(_robot(names, inside))}


@pytest.mark.parametrize(
    "expression", ["if Base.left > 5 then true else false", "(if Base.left > 5 then 1 else 2) = 1"]
)
def test_if_then_else(expression: str) -> None:
    """`if C then A else B` binds loosest, has branches of one type, and is usable everywhere."""
    assert _holds(_robot(needs=expression), 5, 6) == [False, True]
    assert errors(_robot(needs="if Base.left > 5 then 1 else false")) != []


_BUMPERS = """robot Cart {
  component Bumper(ns: string, tries: integer(1..5) = 3) {
    outgoing message hit with identifier: ns + "/hit", type: none
    incoming message lamp with identifier: ns + "/lamp", type: boolean
    requirement SR4: lamp needs left > 1
    provide lamp with left > 2
    behaviour {
      variable left: integer(0..tries) = tries
      initial marked state clear { on response from hit do left := left - 1 }
    }
  }
  component Front is Bumper(ns: "/front")
  component Rear is Bumper("/rear", tries: 2)
  component Base { incoming message move with type: none }
  requirement move needs NEEDS
}"""


def _bumpers(needs: str = "true") -> str:
    return _BUMPERS.replace("NEEDS", needs)


def test_a_template_is_no_part_of_the_robot_until_made() -> None:
    """A component with parameters is a template.

    It is not part of the robot until `is` or `import` makes an instance of it.
    """
    model = supervised(_bumpers())
    names = [plant.name for plant in model.plants]
    assert [name for name in names if name.startswith("component")] == ["component_Front", "component_Rear"]
    assert {plant.topic for plant in model.plants if plant.topic} == {
        "/front/hit",
        "/front/lamp",
        "/rear/hit",
        "/rear/lamp",
        "move",
    }
    lefts = [variable for plant in model.plants for variable in plant.variables]
    assert [(left.type.maximum, left.initial.value) for left in lefts] == [(3, 3), (2, 2)]


@pytest.mark.parametrize(
    "made",
    ["Bumper()", 'Bumper("/a", 2, 3)', 'Bumper("/a", often: 2)', "Bumper(2)", 'Base("/a")'],
    ids=["too few", "too many", "name", "type", "no template"],
)
def test_wrong_arguments_are_argument(made: str) -> None:
    """A wrong count, name or type of arguments is `argument`. So is `is` with a component that is not a template."""
    text = _bumpers().replace('Bumper(ns: "/front")', made)
    assert {rule for rule, _ in errors(text)} == {"argument"}


def test_names_of_communications_and_requirements_of_instances() -> None:
    """Instances share names of communications, which then need `Component.`. Names of requirements: `Left.SR4`."""
    assert "unresolved-reference" in {
        rule for rule, _ in errors(_bumpers().replace("move needs true", "lamp needs true"))
    }
    texts = [text for text in requirements(_bumpers()) if text and "lamp" in text]
    assert [text.split(":")[0] for text in texts] == ["requirement Front.SR4", "requirement Rear.SR4"]


@pytest.mark.parametrize(
    ("needs", "after"),
    [
        ("all Bumper: Bumper.left > 1", [True, False, False]),
        ("any Bumper: Bumper.left > 1", [True, True, False]),
        ("(count Bumper: Bumper.left > 1) >= 2", [True, False, False]),
        ("(count Bumper: Bumper.left > 1) + 1 = 2", [False, True, False]),
    ],
)
def test_quantifiers_range_over_the_instances(needs: str, after: list[bool]) -> None:
    """`all Bumper: …`, `any Bumper: …` and `count Bumper: …` range over the instances of a template."""
    engine = running(_bumpers(needs))
    found = [engine.enabled("message_move.c_trigger")]
    for component in ("Rear", "Front", "Front"):
        engine.perform(f"message_{component}_hit.u_response")
        found.append(engine.enabled("message_move.c_trigger"))
    assert [found[0], found[1], found[3]] == after


@pytest.mark.parametrize(
    "mention",
    [
        "requirement move needs Bumper.left > 1",
        "requirement move needs Front.left > 0 and Bumper",
        "requirement never Bumper.clear",
        "requirement Bumper.lamp needs Front.left > 1",
        "provide Bumper.lamp with true",
        "requirement move after response from Bumper.hit",
    ],
)
def test_others_name_what_is_made_of_a_template(mention: str) -> None:
    """A template is not part of the robot: others name its instances.

    Only the template itself also uses its own name.
    """
    (finding,) = errors(_bumpers().replace("requirement move", f"{mention} requirement move"))
    assert finding[0] == "unresolved-reference"
    inside = _bumpers().replace("do left := left - 1", "if Bumper.left > 0 do left := Bumper.left - 1")
    assert errors(inside) == []


def test_statements_outside_a_component_replace_those_in_it() -> None:
    """Statements for a communication outside a component replace those inside it.

    The robot's replace those of a library.
    """
    inside = supervised(_bumpers())
    assert [len(plant.locations) for plant in inside.plants if plant.kind == sct.PlantKind.data] == [2, 2]
    text = _bumpers().replace("requirement move", "provide Front.lamp with true if Front.left = 1 requirement move")
    (front, _) = [plant for plant in supervised(text).plants if plant.kind == sct.PlantKind.data]
    assert len(front.edges) == 2
    assert front.edges[0].guard is not None


def test_arguments_of_an_enum() -> None:
    """Arguments of an enum are constants or parameters. The type of a variable is the enum without arguments."""
    text = """robot Cart {
      constant close: double = 0.3
      datatype enum Ahead(limit: double) from double to { value < limit -> near default -> clear }
      component Lidar {
        outgoing message front with identifier: "/front", type: Ahead(close)
        outgoing message rear with identifier: "/rear", type: Ahead(0.5 + 0.2)
        behaviour {
          variable ahead: Ahead = clear
          initial marked state on { on response from front do ahead := value on response from rear do ahead := value }
        }
      }
      component Base { incoming message move with type: none }
      requirement move needs Lidar.ahead = clear
    }"""
    assert errors(text) == []
    graph = robosc.to_rosgraph(robosc.load(text=text))
    bounds = [conversion.rules[0].condition.right.value for conversion in graph.conversions]
    assert bounds == [0.3, 0.7]
    assert len(graph.model.enumerations) == 1


def test_parameters_are_arguments_of_an_enum() -> None:
    """Arguments of an enum may be parameters, also those of the instance in which the enum is a type of data."""
    text = """robot Cart {
      parameter reach: double(0.1..2.0) = 0.5
      datatype enum Ahead(limit: double) from double to { value < limit -> near default -> clear }
      component Lidar(ns: string) {
        parameter limit: double(0.1..1.0) = 0.4
        outgoing message scan with identifier: ns + "/scan", type: Ahead(limit)
        outgoing message wide with identifier: ns + "/wide", type: Ahead(reach)
        behaviour {
          variable ahead: Ahead = clear
          initial marked state on { on response from scan do ahead := value on response from wide do ahead := value }
        }
      }
      component Left is Lidar("/left")
      component Right is Lidar("/right")
      component Base { incoming message move with type: none }
      requirement move needs Left.ahead = clear and Right.ahead = clear
    }"""
    assert errors(text) == []
    graph = robosc.to_rosgraph(robosc.load(text=text))
    limits = [conversion.rules[0].condition.right.variable for conversion in graph.conversions]
    assert [(limit.component, limit.name) for limit in limits] == [
        ("Left", "limit"),
        (None, "reach"),
        ("Right", "limit"),
    ]
