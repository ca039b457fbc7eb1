"""Validity rules of models beyond classes and multiplicities, each violated once."""

from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given, settings

from robosc.model import expression as ex
from robosc.model import robosc, rosgraph, sct
from robosc.model.validity import faults
from tests.random_sct import sct_models
from tests.sct_models import edge, model, needs, plant
from tests.searching import examples


def messages(root: Any) -> list[str]:
    return [message for _, message in faults(root)]


def valid() -> sct.SupervisoryControlModel:
    return model(
        [
            plant(
                "p",
                {"one": [edge("c", "two", when="n < 3", do={"n": "n + 1"})], "two": [edge("u", do={"m": "i"})]},
                controllable=["c"],
                uncontrollable={"u": ["i"]},
                variables={"n": "-2..5 = -1", "m": "bool", "e": "E"},
                inputs={"i": "bool"},
            ),
            plant("q", {"one": [edge("p.u")]}, variables={"x": "bool"}),
        ],
        [needs("p.c", "q.one and e == red")],
        {"E": ["red", "green"]},
        guards={"p.c": ("q.one", "not p.m")},
    )


def test_a_valid_model_has_no_faults() -> None:
    assert messages(valid()) == []


@pytest.mark.slow
@settings(max_examples=examples(25), deadline=None)
@given(given=sct_models())
def test_random_valid_models_have_none(given: sct.SupervisoryControlModel) -> None:
    assert messages(given) == []


def _plants(given: Any) -> tuple[Any, Any]:
    return given.plants[0], given.plants[1]


def _rename(given: Any) -> None:
    _plants(given)[1].name = "p"


def _rename_members(given: Any) -> None:
    p, _ = _plants(given)
    p.locations[1].name, p.variables[1].name, p.events[1].name = "one", "n", "c"
    given.enumerations[0].literals[1].name = "red"


def _name_no_identifier(given: Any) -> None:
    _plants(given)[0].name = "2nd"


def _two_initial(given: Any) -> None:
    _plants(given)[0].locations[1].initial = True


def _none_initial(given: Any) -> None:
    _plants(given)[0].locations[0].initial = False


def _second_edge(given: Any) -> None:
    p, _ = _plants(given)
    p.locations[0].edges.append(sct.Edge(event=p.events[0], target=p.locations[0]))


def _unused_event(given: Any) -> None:
    _plants(given)[0].events.append(sct.Event(name="u_error", controllable=False, kind=sct.EventKind.error))


def _foreign_target(given: Any) -> None:
    p, q = _plants(given)
    p.locations[0].edges[0].target = q.locations[0]


def _foreign_update(given: Any) -> None:
    p, q = _plants(given)
    p.locations[0].edges[0].updates[0].variable = q.variables[0]
    p.locations[0].edges[0].updates[0].value = ex.BooleanLiteral(value=True)


def _updated_twice(given: Any) -> None:
    p, _ = _plants(given)
    update = sct.Update(variable=p.variables[0], value=ex.IntegerLiteral(value=1))
    p.locations[0].edges[0].updates.append(update)


def _older_action(given: Any) -> None:
    p = _plants(given)[0]
    p.kind, p.origin = sct.PlantKind.action, "Base.drive"
    p.events[0].kind = sct.EventKind.cancel
    p.locations[0].edges[0].target.name = "idle"


def _wrong_update(given: Any) -> None:
    _plants(given)[0].locations[0].edges[0].updates[0].value = ex.BooleanLiteral(value=True)


def _guard_no_boolean(given: Any) -> None:
    _plants(given)[0].locations[0].edges[0].guard = ex.IntegerLiteral(value=1)


def _condition_no_boolean(given: Any) -> None:
    given.requirements[0].condition = sct.VariableReference(variable=_plants(given)[0].variables[0])


def _part_no_boolean(given: Any) -> None:
    given.supervisor.guards[0].synthesis = sct.VariableReference(variable=_plants(given)[0].variables[0])


def _input_in_guard(given: Any) -> None:
    p, _ = _plants(given)
    p.locations[0].edges[0].guard = sct.LocationReference(location=p.locations[0])
    p.variables[1].initial = sct.InputReference(input=p.inputs[0])


def _input_of_another_event(given: Any) -> None:
    p, _ = _plants(given)
    p.locations[0].edges[0].updates.append(
        sct.Update(variable=p.variables[1], value=sct.InputReference(input=p.inputs[0]))
    )


def _carried_from_elsewhere(given: Any) -> None:
    p, q = _plants(given)
    q.inputs.append(sct.Input(name="i", type=ex.BooleanType()))
    p.events[1].inputs.append(q.inputs[0])


def _unbounded(given: Any) -> None:
    _plants(given)[0].variables[0].type.maximum = None


def _reversed(given: Any) -> None:
    _plants(given)[0].variables[0].type.maximum = -9


def _initial_outside(given: Any) -> None:
    _plants(given)[0].variables[0].initial.operand.value = 3


def _initial_computed(given: Any) -> None:
    _plants(given)[0].variables[1].initial = ex.Negation(operand=ex.BooleanLiteral(value=True))


def _initial_wrong(given: Any) -> None:
    _plants(given)[0].variables[1].initial = ex.IntegerLiteral(value=1)


def _double(given: Any) -> None:
    _plants(given)[0].variables[1].type = ex.DoubleType()
    _plants(given)[0].variables[1].initial = ex.DoubleLiteral(value=1.0)


def _mixed(given: Any) -> None:
    p, _ = _plants(given)
    p.locations[0].edges[0].guard = ex.Equation(
        left=sct.VariableReference(variable=p.variables[0]), right=ex.BooleanLiteral(value=True)
    )


def _compared_booleans(given: Any) -> None:
    _plants(given)[0].locations[0].edges[0].guard = ex.LessThan(
        left=ex.BooleanLiteral(value=True), right=ex.BooleanLiteral(value=True)
    )


def _joined_numbers(given: Any) -> None:
    _plants(given)[0].locations[0].edges[0].guard = ex.Conjunction(
        left=ex.IntegerLiteral(value=1), right=ex.BooleanLiteral(value=True)
    )


def _uneven_choice(given: Any) -> None:
    _plants(given)[0].locations[0].edges[0].guard = ex.Conditional(
        condition=ex.IntegerLiteral(value=1), then=ex.BooleanLiteral(value=True), otherwise=ex.IntegerLiteral(value=1)
    )


def _negative_literal(given: Any) -> None:
    _plants(given)[0].variables[0].initial = ex.IntegerLiteral(value=-1)


def _access(given: Any) -> None:
    _plants(given)[0].locations[0].edges[0].guard = robosc.Access(value=True)


def _function_of_arrays(given: Any) -> None:
    call = ex.FunctionCall(function="max", arguments=[ex.IntegerLiteral(value=1)])
    _plants(given)[0].locations[0].edges[0].updates[0].value = call


def _unknown_function(given: Any) -> None:
    call = ex.FunctionCall(function="median", arguments=[ex.IntegerLiteral(value=1)])
    _plants(given)[0].locations[0].edges[0].updates[0].value = call


def _no_argument(given: Any) -> None:
    _plants(given)[0].locations[0].edges[0].updates[0].value = ex.FunctionCall(function="min")


def _restricted_response(given: Any) -> None:
    given.requirements[0].event = _plants(given)[0].events[1]


def _no_guard(given: Any) -> None:
    given.supervisor.guards.clear()


def _foreign_requirement(given: Any) -> None:
    given.supervisor.guards[0].requirements.append(
        sct.Requirement(event=_plants(given)[0].events[1], condition=ex.BooleanLiteral(value=True))
    )


def _two_guards(given: Any) -> None:
    given.supervisor.guards.append(sct.EventGuard(event=_plants(given)[0].events[0], everEnabled=True))


def _another_models_event(given: Any) -> None:
    _plants(given)[1].locations[0].edges[0].event = valid().plants[0].events[0]


def _another_models_literal(given: Any) -> None:
    other = valid().enumerations[0]
    given.requirements[0].condition.right.right.literal = other.literals[0]


BROKEN: list[tuple[Callable[[Any], None], list[str]]] = [
    (_rename, ["the name 'p' is used twice"]),
    (
        _rename_members,
        ["the name 'red' is used twice", *(f"the name '{name}' is used twice" for name in ("c", "n", "one"))],
    ),
    (_name_no_identifier, ["'name' must be an identifier, found '2nd'"]),
    (_two_initial, ["plant 'p' has 2 initial locations, expected exactly one"]),
    (_none_initial, ["plant 'p' has no initial locations, expected exactly one"]),
    (_second_edge, ["location 'one' has two edges for 'c', one without guard"]),
    (_unused_event, ["no plant has an edge for the event 'u_error'"]),
    (_foreign_target, ["the target 'one' is a location of another plant"]),
    (_foreign_update, ["the variable 'x' belongs to another plant"]),
    (_updated_twice, ["the variable 'n' is updated twice"]),
    (_wrong_update, ["this is of boolean, expected integer"]),
    (_guard_no_boolean, ["this is of integer, expected boolean"]),
    (_condition_no_boolean, ["this is of integer, expected boolean"]),
    (_part_no_boolean, ["this is of integer, expected boolean"]),
    (
        _input_in_guard,
        [
            "an input can be read only in guards, updates of edges, and requirements",
            "an initial value must be a literal",
        ],
    ),
    (_input_of_another_event, ["'c' does not carry the input 'i'"]),
    (_carried_from_elsewhere, ["the input 'i' belongs to another plant"]),
    (_unbounded, ["an integer in an sct model must have both bounds"]),
    (_reversed, ["the range -2..-9 is reversed", "-1 is outside -2..-9"]),
    (_initial_outside, ["-3 is outside -2..5"]),
    (_initial_computed, ["an initial value must be a literal"]),
    (_initial_wrong, ["this is of integer, expected boolean"]),
    (
        _double,
        [
            "this is of boolean, expected double",
            "this is of double, expected boolean",
            "DoubleType is not allowed in an sct model",
            "DoubleLiteral is not allowed in an sct model",
            "an initial value must be a literal",
        ],
    ),
    (_mixed, ["the operands are of integer and boolean, not of one type"]),
    (_compared_booleans, ["expected numbers, found boolean"]),
    (_joined_numbers, ["this is of integer, expected boolean"]),
    (
        _uneven_choice,
        ["this is of integer, expected boolean", "the operands are of boolean and integer, not of one type"],
    ),
    (_negative_literal, ["a literal has no sign; the sign is a UnaryMinus around it"]),
    (_access, ["Access is allowed only in a robosc model"]),
    (
        _older_action,
        [
            (
                "the action 'Base.drive' ends where it is canceled, as in older models; generate this model"
                " again from its text: `robosc transform MODEL.rscd --to xmi`"
            )
        ],
    ),
    (_function_of_arrays, ["this call of 'max' is not allowed in an sct model"]),
    (_unknown_function, ["there is no function 'median'"]),
    (_no_argument, ["'min' has a wrong number of arguments"]),
    (_restricted_response, ["the event 'u' is uncontrollable: no requirement can restrict it"]),
    (_no_guard, ["the event 'p.c' has no guard"]),
    (_foreign_requirement, ["a requirement of this guard does not restrict 'c'"]),
    (_two_guards, ["the event 'c' has more than one guard", "the event 'c' has more than one guard"]),
    (_another_models_event, ["the event 'c' belongs to another model"]),
    (
        _another_models_literal,
        [
            "the operands are of enumeration E and enumeration E, not of one type",
            "the literal 'red' belongs to another model",
        ],
    ),
]


@pytest.mark.parametrize(("break_it", "wanted"), BROKEN, ids=[breaking.__name__ for breaking, _ in BROKEN])
def test_sct(break_it: Callable[[Any], None], wanted: list[str]) -> None:
    given = valid()
    break_it(given)
    assert sorted(messages(given)) == sorted(wanted)


def graph() -> rosgraph.RosGraph:
    """Return a graph with one of every feature that can be inconsistent."""
    of = valid()
    p, _ = of.plants
    of.plants.append(
        sct.Plant(
            name="data", kind=sct.PlantKind.data, locations=[sct.Location(name="none", initial=True, marked=True)]
        )
    )
    [enumeration] = of.enumerations
    text = rosgraph.Interface(package="std_msgs", type="String", kind=rosgraph.InterfaceKind.message)
    wire = rosgraph.WireAccess(steps=[rosgraph.FieldStep(name="data")], type=ex.BooleanType())
    element = rosgraph.WireAccess(
        steps=[rosgraph.FieldStep(name="words"), rosgraph.IndexStep(index=0)], type=ex.StringType()
    )
    variable = rosgraph.NodeVariable(
        name="v", component="C", type=ex.StringType(), initial=ex.StringLiteral(value="anything")
    )
    return rosgraph.RosGraph(
        name="robot",
        model=of,
        interfaces=[text],
        variables=[variable],
        conversions=[
            rosgraph.Conversion(
                name="E",
                enumeration=enumeration,
                default=enumeration.literals[0],
                rules=[
                    rosgraph.ConversionRule(condition=ex.BooleanLiteral(value=True), literal=enumeration.literals[1])
                ],
            )
        ],
        subscriptions=[
            rosgraph.Subscription(
                topic="t",
                interface=text,
                receptions=[
                    rosgraph.Reception(
                        name="u", event=p.events[1], inputs=[rosgraph.InputAssignment(input=p.inputs[0], value=wire)]
                    )
                ],
            )
        ],
        publishers=[
            rosgraph.Publisher(
                topic="/t",
                interface=text,
                sendings=[
                    rosgraph.Sending(
                        name="c",
                        event=p.events[0],
                        alternatives=[
                            rosgraph.ProvidedData(
                                location=of.plants[2].locations[0],
                                fields=[
                                    rosgraph.FieldAssignment(
                                        path=["data"],
                                        type=ex.StringType(),
                                        value=rosgraph.NodeVariableReference(variable=variable),
                                    )
                                ],
                            )
                        ],
                    )
                ],
            )
        ],
        reactions=[
            rosgraph.Reaction(
                event=p.events[1],
                locations=[p.locations[0]],
                assignments=[rosgraph.NodeAssignment(variable=variable, value=element)],
            )
        ],
    )


GRAPHS: list[tuple[str, Any, str]] = [
    ("interfaces[0].kind", rosgraph.InterfaceKind.service, "'String' is a service, expected a message"),
    ("interfaces[0].package", "a/b", "'a/b' is not a name of a ROS package"),
    ("interfaces[0].type", "a b", "'type' must be an identifier, found 'a b'"),
    ("variables[0].initial", ex.IntegerLiteral(value=1), "this is of integer, expected string"),
    ("conversions[0].rules[0].condition", ex.StringLiteral(value=""), "this is of string, expected boolean"),
    ("conversions[0].default", ex.EnumerationLiteral(name="blue"), "'blue' is not a literal of E"),
    (
        "subscriptions[0].receptions[0].inputs[0].value.type",
        ex.DoubleType(),
        "this is of double, expected boolean",
    ),
    (
        "subscriptions[0].receptions[0].inputs[0].input",
        sct.Input(name="j", type=ex.BooleanType()),
        "'u' does not carry the input 'j'",
    ),
    (
        "subscriptions[0].receptions[0].inputs[0].value.steps[0].name",
        "x;",
        "'name' must be an identifier, found 'x;'",
    ),
    ("reactions[0].guard", ex.IntegerLiteral(value=1), "this is of integer, expected boolean"),
    ("reactions[0].assignments[0].value.steps[1].index", -1, "an index counts from 0"),
    (
        "publishers[0].sendings[0].alternatives[0].fields[0].type",
        ex.BooleanType(),
        "this is of string, expected boolean",
    ),
    ("reactions[0].assignments[0].value", ex.BooleanLiteral(value=True), "this is of boolean, expected string"),
]


@pytest.mark.parametrize(("place", "value", "message"), GRAPHS, ids=[place for place, _, _ in GRAPHS])
def test_rosgraph(place: str, value: Any, message: str) -> None:
    given = graph()
    assert messages(given) == []
    holder, _, feature = place.rpartition(".")
    setattr(eval(f"given.{holder}", {}, {"given": given}), feature, value)  # noqa: S307 - a path from above
    assert message in messages(given)


def test_rosgraph_references() -> None:
    given = graph()
    p, q, _ = given.model.plants
    given.reactions[0].locations.append(q.locations[0])
    given.publishers[0].sendings[0].alternatives[0].location = p.locations[0]
    given.subscriptions[0].receptions[0].event = valid().plants[0].events[1]
    given.reactions[0].assignments.clear()
    given.publishers[0].sendings[0].alternatives[0].fields[0].path.append("a.b")
    assert sorted(messages(given)) == [
        "'one' is not a location of a data plant",
        "'path' must be an identifier, found 'a.b'",
        "'u' does not carry the input 'i'",
        "the event 'u' belongs to another model",
        "the locations belong to several plants",
    ]


@pytest.mark.parametrize(
    ("element", "message"),
    [
        (robosc.Access(value=False), "an access reads either an item or the value of the event"),
        (
            robosc.Access(value=True, item=robosc.State(name="s")),
            "an access reads either an item or the value of the event",
        ),
        (robosc.IndexSegment(index=-1), "an index counts from 0"),
        (robosc.Interface(name="i", type="T", package="a b"), "'a b' is not a name of a ROS package"),
        (robosc.State(name="s t"), "'name' must be an identifier, found 's t'"),
        (ex.DoubleLiteral(value=-1.0), "a literal has no sign; the sign is a UnaryMinus around it"),
    ],
)
def test_robosc(element: Any, message: str) -> None:
    assert messages(element) == [message]


def test_functions_of_a_robosc_model() -> None:
    condition = ex.FunctionCall(function="median", arguments=[ex.IntegerLiteral(value=1)])
    requirement = robosc.NeedsRequirement(condition=condition)
    assert messages(robosc.Robot(name="R", definitions=[requirement])) == ["there is no function 'median'"]


def test_fleets_of_a_robosc_model() -> None:
    fleet = robosc.Component(name="C", first=ex.IntegerLiteral(value=1), type=robosc.LocalComponent())
    robot = robosc.Robot(name="R", definitions=[fleet])
    assert messages(robot) == ["the fleet 'C' lacks its first or last instance or its number"]
    fleet.last = ex.IntegerLiteral(value=2)
    fleet.number = robosc.FormalParameter(name="number", type=robosc.IntegerDataType())
    assert messages(robot) == ["the fleet 'C' has a text or parameters of its own"]
    condition = robosc.Access(item=fleet)
    robot.definitions.append(
        robosc.StateInvariant(kind=robosc.InvariantKind.never, condition=condition, template=fleet)
    )
    assert messages(robot)[1:] == [
        "'C' is not a template",
        "an index follows the name of a fleet, and only that",
    ]
