"""The plants match the text; every change to them is refuted, with its position."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

import robosc
from robosc.analysis.verify import validate_model
from robosc.analysis.verify.model_reading import Effort
from robosc.analysis.verify.verdict import Outcome, details
from robosc.base.diagnostics import has_errors
from robosc.language.checks import check
from robosc.language.reading import read
from robosc.language.text import Documents
from robosc.m2m import robosc_to_sct
from robosc.model import expression as ex
from robosc.model import robosc as rsc
from robosc.model import sct
from robosc.model.semantics.edges import edges_of
from robosc.model.semantics.roles import event_name
from robosc.model.semantics.walks import copy_tree, parts
from tests.fuzz.mutants import LIBRARIES, sources
from tests.random_assumptions import assuming_robot
from tests.random_robots import random_robot
from tests.random_second_edition import second_edition_robot
from tests.random_served import served_robot
from tests.searching import examples

ROBOT = """\
robot Rich {
    interface task use Fibonacci from action_tutorials_interfaces
    interface dock_type use SetBool from std_srvs
    constant least: integer = 1
    condition low = Battery.charge <= least
    function far(d: double, limit: double): boolean = d > limit
    datatype object Reading { range: double }
    datatype object Done { success: boolean }
    datatype object Goal { order: integer }
    datatype enum Distance(limit: double) from double to {
        value < limit -> near
        default -> away
    }

    component Zone(ns: string, start: integer(0..2) = 2) {
        outgoing message seen with identifier: ns + "/seen", type: integer(0..2)
        behaviour {
            variable count: integer(0..2) = start
            initial marked state clear {
                on response from seen if value = 2 do count := value + 2 goto crowded
                on response from seen if value > 0 do count := value
            }
            state crowded { on response from seen if value = 0 do count := value goto clear }
        }
    }
    component Front is Zone(ns: "/front")
    component Rear is Zone("/rear", start: 1)
    component Battery {
        outgoing message level with type: integer(0..2)
        behaviour {
            variable charge: integer(0..2) = 2
            initial marked state using { on response from level do charge := value }
        }
    }
    component Lidar {
        outgoing message scan with type: double
        outgoing message gap with type: Distance(0.5)
        behaviour {
            variable ahead: Distance
            initial marked state free {
                on response from scan if !far(value, 1.5) goto blocked
                on response from gap do ahead := value
                after 500 ms without scan goto blind
            }
            state blocked { on response from scan if far(value, 1.5) goto free }
            state blind { on response from scan goto free after 2.0 s do ahead := near }
        }
    }
    component Platform {
        incoming message move with type: double
        incoming message halt with type: none
        service dock with request: boolean, response: Done links dock_type
        action drive with request: Goal, response: Done, feedback: integer(0..3) links task
        action wave with request: none, response: none, feedback: none links task
        provide move with 0.5 if Lidar.free and Battery.charge > 1
        provide move with 0.1 if Lidar.blocked
        behaviour {
            variable tries: integer(0..2)
            initial marked state still {
                on request to move goto moving
                on response from dock if value.success goto docked
                transition if tries = 2 and Lidar.blind do tries := 0
            }
            state moving { on request to halt goto still }
            state docked { transition goto still }
            on error from dock do tries := tries + 1
            on feedback from drive do tries := if value > 2 then 2 else tries
        }
    }
    requirement move needs (all Zone: Zone.clear) and (count Zone: Zone.count > 0) < 2
    requirement Slow: low and Platform.tries / 2 > 0.5 disables move
    requirement { dock, drive } needs Battery.charge < 2 or Lidar.ahead = near
    requirement halt after each move
    requirement at most 2 dock since response from scan
    requirement Turns: automaton {
        initial state mine {
            on request to drive goto yours
            on error from drive
        }
        state yours {
            on error from drive goto mine
            on response from drive if Platform.still goto mine
        }
    }
    requirement never Front.crowded and Rear.crowded and Platform.docked
    property P: reachable Platform.still from Lidar.blind
    property always Platform.tries <= 2
}
"""


@pytest.fixture(scope="module")
def robot() -> rsc.Base:
    """Return the robot, which tests must not change."""
    path = Path("rich.rscd")
    reading = read(path, documents=Documents({str(path): ROBOT}))
    found = [*reading.findings, *check(reading.base, reading.findings)]
    assert [finding.message for finding in found if finding.severity.value == "error"] == []
    assert isinstance(reading.base, rsc.Robot)
    return reading.base


@pytest.fixture
def models(robot: rsc.Base) -> tuple[rsc.Base, sct.SupervisoryControlModel]:
    """Return the robot and new plants that tests may change: `robosc.to_sct` caches its result."""
    return robot, robosc_to_sct.transform(robot)[0]


def event(model: sct.SupervisoryControlModel, name: str) -> sct.Event:
    return next(event for plant in model.plants for event in plant.events if event_name(event) == name)


def plant(model: sct.SupervisoryControlModel, name: str) -> sct.Plant:
    return next(plant for plant in model.plants if plant.name == name)


def place(model: sct.SupervisoryControlModel, name: str) -> sct.Location:
    owner, _, called = name.partition(".")
    return next(location for location in plant(model, owner).locations if location.name == called)


def variable(model: sct.SupervisoryControlModel, name: str) -> sct.DiscreteVariable:
    owner, _, called = name.partition(".")
    return next(variable for variable in plant(model, owner).variables if variable.name == called)


def edges(model: sct.SupervisoryControlModel, location: str, name: str) -> list[sct.Edge]:
    wanted = event(model, name)
    return [edge for edge in place(model, location).edges if edge.event is wanted]


def required(model: sct.SupervisoryControlModel, name: str) -> list[sct.Requirement]:
    return [requirement for requirement in model.requirements if event_name(requirement.event) == name]


def negate(element: sct.Edge | sct.Requirement | sct.StateInvariant | sct.Property) -> None:
    feature = "guard" if isinstance(element, sct.Edge) else "condition"
    setattr(element, feature, ex.Negation(operand=getattr(element, feature)))


def literals(expression: ex.Expression) -> list[ex.IntegerLiteral]:
    return [part for part in parts(expression) if isinstance(part, ex.IntegerLiteral)]


# Eight mutants that earlier versions did not detect.


def disables_is_built_as_needs(model: sct.SupervisoryControlModel) -> None:
    disabling = next(
        requirement for requirement in model.requirements if requirement.kind == sct.RequirementKind.disables
    )
    disabling.kind = sct.RequirementKind.needs


def initial_values_are_ignored(model: sct.SupervisoryControlModel) -> None:
    variable(model, "component_Front.count").initial = ex.IntegerLiteral(value=0)


def a_range_is_one_too_large(model: sct.SupervisoryControlModel) -> None:
    held = variable(model, "component_Platform.tries").type
    assert isinstance(held, ex.IntegerType)
    held.maximum = 3


def everything_is_marked(model: sct.SupervisoryControlModel) -> None:
    for plant in model.plants:
        for location in plant.locations:
            location.marked = True


def a_table_is_inverted(model: sct.SupervisoryControlModel) -> None:
    """Invert the table of `Platform.tries / 2 > 0.5`."""
    disabling = next(
        requirement for requirement in model.requirements if requirement.kind == sct.RequirementKind.disables
    )
    assert isinstance(disabling.condition, ex.Conjunction)
    disabling.condition.right = ex.Negation(operand=disabling.condition.right)


def a_response_leads_to_error(model: sct.SupervisoryControlModel) -> None:
    (edge,) = edges(model, "service_dock.wait_for_response", "service_dock.u_response")
    edge.target = place(model, "service_dock.error")


def a_cancel_stays_executing(model: sct.SupervisoryControlModel) -> None:
    (edge,) = edges(model, "action_drive.executing", "action_drive.c_cancel")
    edge.target = place(model, "action_drive.executing")


def a_data_guard_is_dropped(model: sct.SupervisoryControlModel) -> None:
    edge = next(edge for edge in edges_of(plant(model, "data_move")) if edge.event.name == "c_d2")
    edge.guard = None


# Other mutants.


def a_requirement_is_lost(model: sct.SupervisoryControlModel) -> None:
    model.requirements.remove(required(model, "service_dock.c_trigger")[0])


def a_requirement_is_on_another_event(model: sct.SupervisoryControlModel) -> None:
    required(model, "service_dock.c_trigger")[0].event = event(model, "action_wave.c_trigger")


def all_is_read_as_any(model: sct.SupervisoryControlModel) -> None:
    needed = required(model, "message_move.c_trigger")[0]
    assert isinstance(needed.condition, ex.Conjunction)
    every = needed.condition.left
    assert isinstance(every, ex.Conjunction)
    needed.condition.left = ex.Disjunction(left=copy_tree(every.left), right=copy_tree(every.right))


def an_instance_is_read_twice(model: sct.SupervisoryControlModel) -> None:
    needed = required(model, "message_move.c_trigger")[0]
    rear = variable(model, "component_Rear.count")
    for part in parts(needed.condition):
        if isinstance(part, sct.VariableReference) and part.variable is rear:
            part.variable = variable(model, "component_Front.count")


def a_constant_is_one_more(model: sct.SupervisoryControlModel) -> None:
    disabling = next(
        requirement for requirement in model.requirements if requirement.kind == sct.RequirementKind.disables
    )
    literals(disabling.condition)[0].value += 1


def a_cancel_is_always_allowed(model: sct.SupervisoryControlModel) -> None:
    for requirement in required(model, "action_drive.c_cancel"):
        requirement.condition = ex.BooleanLiteral(value=True)


def an_action_without_requirement_is_cancelled(model: sct.SupervisoryControlModel) -> None:
    for requirement in required(model, "action_wave.c_cancel"):
        model.requirements.remove(requirement)


def what_comes_can_be_prevented(model: sct.SupervisoryControlModel) -> None:
    event(model, "message_scan.u_response").controllable = True


def a_transition_comes_from_outside(model: sct.SupervisoryControlModel) -> None:
    event(model, "component_Platform.c_tau1").controllable = False


def a_component_blocks_an_answer(model: sct.SupervisoryControlModel) -> None:
    place(model, "component_Platform.moving").edges.remove(
        *edges(model, "component_Platform.moving", "service_dock.u_response")
    )


def a_request_is_possible_anywhere(model: sct.SupervisoryControlModel) -> None:
    docked = place(model, "component_Platform.docked")
    docked.edges.append(sct.Edge(event=event(model, "message_move.c_trigger"), target=docked))


def a_guard_is_negated(model: sct.SupervisoryControlModel) -> None:
    negate(edges(model, "component_Platform.still", "component_Platform.c_tau1")[0])


def a_guard_over_data_is_negated(model: sct.SupervisoryControlModel) -> None:
    for edge in edges(model, "component_Lidar.free", "message_scan.u_response"):
        negate(edge)


def a_later_transition_is_tried_first(model: sct.SupervisoryControlModel) -> None:
    first, second, *_ = edges(model, "component_Front.clear", "message_Front_seen.u_response")
    assert isinstance(second.guard, ex.Conjunction)
    later = second.guard.right
    first.guard = ex.Conjunction(left=copy_tree(first.guard), right=ex.Negation(operand=copy_tree(later)))
    second.guard = later


def a_transition_leads_elsewhere(model: sct.SupervisoryControlModel) -> None:
    (edge,) = edges(model, "component_Platform.docked", "component_Platform.c_tau2")
    edge.target = place(model, "component_Platform.moving")


def an_assignment_is_lost(model: sct.SupervisoryControlModel) -> None:
    (edge,) = edges(model, "component_Battery.using", "message_level.u_response")
    edge.updates.pop()


def an_assignment_is_one_more(model: sct.SupervisoryControlModel) -> None:
    (edge,) = edges(model, "component_Platform.moving", "service_dock.u_error")
    literals(edge.updates[0].value)[0].value = 2


def an_assignment_reads_a_variable_for_data(model: sct.SupervisoryControlModel) -> None:
    (edge,) = edges(model, "component_Battery.using", "message_level.u_response")
    edge.updates[0].value = sct.VariableReference(variable=edge.updates[0].variable)


def branches_are_swapped(model: sct.SupervisoryControlModel) -> None:
    (edge,) = edges(model, "component_Platform.still", "action_drive.u_feedback")
    choice = edge.updates[0].value
    assert isinstance(choice, ex.Conditional)
    choice.condition = ex.Negation(operand=choice.condition)


def data_has_one_value_more(model: sct.SupervisoryControlModel) -> None:
    told = event(model, "message_level.u_response").inputs[0].type
    assert isinstance(told, ex.IntegerType)
    told.maximum = 3


def an_enum_lacks_a_value(model: sct.SupervisoryControlModel) -> None:
    model.enumerations[0].literals.pop()


def a_transition_of_every_state_is_in_one_only(model: sct.SupervisoryControlModel) -> None:
    for edge in edges(model, "component_Platform.docked", "service_dock.u_error"):
        edge.updates.pop()


def an_error_needs_no_reset(model: sct.SupervisoryControlModel) -> None:
    (edge,) = edges(model, "service_dock.wait_for_response", "service_dock.u_error")
    edge.target = place(model, "service_dock.idle")


def feedback_ends_an_action(model: sct.SupervisoryControlModel) -> None:
    (edge,) = edges(model, "action_wave.executing", "action_wave.u_feedback")
    edge.target = place(model, "action_wave.ready")


def a_time_is_up_elsewhere(model: sct.SupervisoryControlModel) -> None:
    place(model, "component_Lidar.free").edges.append(
        sct.Edge(event=event(model, "component_Lidar.u_after2"), target=place(model, "component_Lidar.free"))
    )


def a_time_is_longer(model: sct.SupervisoryControlModel) -> None:
    timer = event(model, "component_Lidar.u_after2").timer
    assert timer is not None
    timer.milliseconds = 2001


def a_time_starts_with_nothing(model: sct.SupervisoryControlModel) -> None:
    timer = event(model, "component_Lidar.u_after1").timer
    assert timer is not None
    timer.without.clear()


def no_data_is_chosen_anywhere(model: sct.SupervisoryControlModel) -> None:
    edge = next(edge for edge in edges_of(plant(model, "data_move")) if edge.event.name == "c_none")
    edge.guard = None


def data_is_another(model: sct.SupervisoryControlModel) -> None:
    edge = next(edge for edge in edges_of(plant(model, "data_move")) if edge.event.name == "c_d1")
    edge.target = place(model, "data_move.d2")


def an_order_forgets_nothing(model: sct.SupervisoryControlModel) -> None:
    """Build `after each` as `after`."""
    for edge in edges(model, "requirement_1.ready", "message_halt.c_trigger"):
        edge.target = place(model, "requirement_1.ready")


def a_count_goes_one_further(model: sct.SupervisoryControlModel) -> None:
    counted = next(
        requirement for requirement in required(model, "service_dock.c_trigger") if requirement.automaton is not None
    )
    literals(counted.condition)[0].value += 1


def a_count_starts_anew_with_itself(model: sct.SupervisoryControlModel) -> None:
    (edge,) = edges(model, "requirement_2.counting", "service_dock.c_trigger")
    edge.updates[0].value = ex.IntegerLiteral(value=0)


def a_requirement_automaton_stays(model: sct.SupervisoryControlModel) -> None:
    (edge,) = edges(model, "requirement_Turns.mine", "action_drive.c_trigger")
    edge.target = place(model, "requirement_Turns.mine")


def a_requirement_automaton_forbids_less(model: sct.SupervisoryControlModel) -> None:
    model.requirements.remove(required(model, "action_drive.u_response")[0])


def never_is_built_as_always(model: sct.SupervisoryControlModel) -> None:
    negate(model.invariants[0])


def a_property_is_another(model: sct.SupervisoryControlModel) -> None:
    negate(next(claim for claim in model.properties if isinstance(claim, sct.ReachabilityProperty)))


def it_begins_elsewhere(model: sct.SupervisoryControlModel) -> None:
    place(model, "component_Lidar.free").initial = False
    place(model, "component_Lidar.blind").initial = True


def two_edges_are_possible_at_once(model: sct.SupervisoryControlModel) -> None:
    for edge in edges(model, "component_Front.clear", "message_Front_seen.u_response"):
        edge.guard = None


#: Each mutant with the beginning of its explanation.
MUTANTS: list[tuple[Callable[[sct.SupervisoryControlModel], None], str]] = [
    (disables_is_built_as_needs, "request to `Platform.move` is forbidden by the model (line 71), and"),
    (initial_values_are_ignored, "`Front.count` (line 18) begins at 2 by the text, at 0 in the model"),
    (a_range_is_one_too_large, "`Platform.tries` (line 58) has values from 0 to 2 by the text, values"),
    (everything_is_marked, "location `error` of `Platform.dock` (line 52) is marked only in the model"),
    (a_table_is_inverted, "request to `Platform.move` is forbidden by the model (line 71), and not by"),
    (a_response_leads_to_error, "after response from `Platform.dock`, `Platform.dock` is in `ready` by"),
    (a_cancel_stays_executing, "after cancel of `Platform.drive`, `Platform.drive` is in `canceling` by the"),
    (a_data_guard_is_dropped, "choice of `provide` 2 for `Platform.move` in line 56 can happen in the"),
    (a_requirement_is_lost, "request to `Platform.dock` is forbidden by the text (line 72), and not by"),
    (a_requirement_is_on_another_event, "request to `Platform.dock` is forbidden by the text (line 72),"),
    (all_is_read_as_any, "request to `Platform.move` is forbidden by the text (line 70), and not by the"),
    (an_instance_is_read_twice, "request to `Platform.move` is forbidden by the model (line 70), and"),
    (a_constant_is_one_more, "request to `Platform.move` is forbidden by the model (line 71), and not"),
    (a_cancel_is_always_allowed, "cancel of `Platform.drive` is forbidden by the text (line 72), and"),
    (an_action_without_requirement_is_cancelled, "cancel of `Platform.wave` is forbidden by the text"),
    (what_comes_can_be_prevented, "response from `Lidar.scan` (line 36) is controllable in the model,"),
    (a_transition_comes_from_outside, "transition of `Platform` in line 62 is uncontrollable in the"),
    (a_component_blocks_an_answer, "response from `Platform.dock` can happen by the text (line 52), and"),
    (a_request_is_possible_anywhere, "request to `Platform.move` can happen in the plants, and not by"),
    (a_guard_is_negated, "transition of `Platform` in line 62 can happen in the plants, and not by the"),
    (a_guard_over_data_is_negated, "after response from `Lidar.scan`, `Lidar` is in `blocked` by the"),
    (a_later_transition_is_tried_first, "after response from `Front.seen`, `Front` is in `crowded` by"),
    (a_transition_leads_elsewhere, "after transition of `Platform` in line 65, `Platform` is in `still`"),
    (an_assignment_is_lost, "after response from `Battery.level`, `Battery.charge` is 0 by the text"),
    (an_assignment_is_one_more, "after error from `Platform.dock`, `Platform.tries` is 1 by the text"),
    (an_assignment_reads_a_variable_for_data, "after response from `Battery.level`, `Battery.charge` is"),
    (branches_are_swapped, "after feedback from `Platform.drive`, `Platform.tries` stays as it was by"),
    (data_has_one_value_more, "`i_response` of response from `Battery.level` (line 29) has values from"),
    (an_enum_lacks_a_value, "`Lidar.ahead` (line 39) has values near, away by the text, values near in"),
    (a_transition_of_every_state_is_in_one_only, "after error from `Platform.dock`, `Platform.tries` is"),
    (an_error_needs_no_reset, "after error from `Platform.dock`, `Platform.dock` is in `error` by the"),
    (feedback_ends_an_action, "after feedback from `Platform.wave`, `Platform.wave` stays as it was by"),
    (a_time_is_up_elsewhere, "timeout of `Lidar` after 2 s in line 46 can happen in the plants, and not"),
    (a_time_is_longer, "timeout of `Lidar` after 2001 ms in line 46 has another time or place in the"),
    (a_time_starts_with_nothing, "timeout of `Lidar` after 500 ms in line 43 has another time or place"),
    (no_data_is_chosen_anywhere, "choice of no data for `Platform.move` can happen in the plants, and"),
    (data_is_another, "after choice of `provide` 1 for `Platform.move` in line 55, the data of"),
    (an_order_forgets_nothing, "after request to `Platform.halt`, requirement automaton 1 is in"),
    (a_count_goes_one_further, "request to `Platform.dock` is forbidden by the text (line 74), and not"),
    (a_count_starts_anew_with_itself, "after request to `Platform.dock`, the count of requirement"),
    (a_requirement_automaton_stays, "after request to `Platform.drive`, requirement automaton 3 is in"),
    (a_requirement_automaton_forbids_less, "response from `Platform.drive` is forbidden by the text"),
    (never_is_built_as_always, "the condition of an invariant (line 85) holds by the text and does not"),
    (a_property_is_another, "the reachable condition of a property (line 86) holds by the text and does"),
    (it_begins_elsewhere, "`Lidar` (line 38) begins at free by the text, at blind in the model"),
    (two_edges_are_possible_at_once, "several edges with different ends are possible in the plants for"),
]


@pytest.mark.slow
def test_a_right_model_is_proved(models: tuple[rsc.Base, sct.SupervisoryControlModel]) -> None:
    """The model has all constructs of the language's second edition that concern the supervisor."""
    found = validate_model(*models, Effort(first=1_000_000))
    assert (found.outcome, found.explanation) == (Outcome.PROVED, "")
    assert found.evidence == "530,496 states, 32 events"


@pytest.mark.parametrize(("change", "said"), MUTANTS, ids=lambda value: getattr(value, "__name__", ""))
def test_a_change_is_found(
    models: tuple[rsc.Base, sct.SupervisoryControlModel],
    change: Callable[[sct.SupervisoryControlModel], None],
    said: str,
) -> None:
    change(models[1])
    found = validate_model(*models)
    assert (found.outcome, found.explanation[: len(said)]) == (Outcome.REFUTED, said)


def test_it_is_told_with_a_shortest_trace(models: tuple[rsc.Base, sct.SupervisoryControlModel]) -> None:
    a_cancel_stays_executing(models[1])
    assert details(validate_model(*models), models[1]) == (
        "model-translation: after cancel of `Platform.drive`, `Platform.drive` is in `canceling` by the text (line 53),"
        " and stays as it was in the plants"
        " where `Platform.drive.executing and Battery.charge = 2 and Lidar.ahead = away`\n"
        "  after\n"
        "    1. response from `Battery.level` (value = 0)\n"
        "    2. request to `Platform.drive`\n"
        "    3. response from `Battery.level` (value = 2)"
    )


@pytest.mark.slow
def test_where_there_is_too_much_it_looks_at_random(models: tuple[rsc.Base, sct.SupervisoryControlModel]) -> None:
    few = Effort(states=50, values=0, random=60_000)
    found = validate_model(*models, few)
    assert found.outcome is Outcome.SAMPLED
    assert re.fullmatch(r"\d+ states, 32 events, and 1,875 random steps", found.evidence)
    an_error_needs_no_reset(models[1])
    assert validate_model(*models, few).outcome is Outcome.REFUTED


def test_where_there_are_too_many_states_each_event_may_be_tried_in_all(
    models: tuple[rsc.Base, sct.SupervisoryControlModel],
) -> None:
    """An event reads only a small part of a state."""
    found = validate_model(*models, Effort(states=50))
    assert found.outcome is Outcome.PROVED
    assert re.fullmatch(r"\d+ states, 32 events; in other states event by event", found.evidence)
    an_error_needs_no_reset(models[1])
    assert validate_model(*models, Effort(states=50)).outcome is Outcome.REFUTED


@pytest.mark.slow
def test_of_too_many_values_it_tries_some(models: tuple[rsc.Base, sct.SupervisoryControlModel]) -> None:
    found = validate_model(*models, Effort(states=10_000, inputs=2, values=0, random=3000))
    assert (found.outcome, found.explanation) == (Outcome.SAMPLED, "")
    an_assignment_is_lost(models[1])
    assert validate_model(*models, Effort(states=10_000, inputs=2, values=0, random=3000)).outcome is Outcome.REFUTED


@pytest.mark.parametrize("values", [5_000, 20_000])
def test_one_value_of_many_is_found(tmp_path: Path, values: int) -> None:
    """The values are few enough to try all in each state, or so many that each is tried once."""
    path = tmp_path / "robot.rscd"
    path.write_text(f"""robot R {{
        component Scale {{
            outgoing message weight with type: integer(0..{values})
            behaviour {{
                initial marked state light {{ on response from weight if value = 3333 goto heavy }}
                state heavy {{ on response from weight goto light }}
            }}
        }}
    }}""")
    robot = robosc.load(path)
    model = robosc_to_sct.transform(robot)[0]
    effort = Effort(inputs=10_000, random=1_000)
    assert validate_model(robot, model, effort).outcome is Outcome.PROVED
    for edge in edges(model, "component_Scale.light", "message_weight.u_response"):
        for literal in literals(edge.guard):
            literal.value += literal.value == 3333
    assert validate_model(robot, model, effort).outcome is Outcome.REFUTED


def test_arguments_are_the_values_of_what_is_given(tmp_path: Path) -> None:
    """The supervisor receives data that are compared with arguments."""
    text = """robot R {
        constant pi: double = 3.5
        datatype enum Level from integer to { value > 2 -> high default -> low }
        component Zone(a: double, b: integer, c: string, d: Level, e: boolean = 1 > 2, f: double = -pi * 2) {
            outgoing message scan with type: sensor_msgs/JointState
            outgoing message level with type: Level
            behaviour {
                variable near: boolean
                initial marked state s {
                    on response from scan if any r in value.position[0..b]: r < a or e and r < f do near := true
                    on response from scan if value.name[b] = c do near := false
                    on response from level if value = d goto t
                }
                state t { transition goto s }
            }
        }
        component One is Zone(pi * 2, 1 + 1, "a" + "b", Level.high)
        component Two is Zone(-0.5, 0, d: low, c: "", e: !(1 > 2))
        requirement never One.t and Two.t
    }"""
    assert agrees(tmp_path / "robot.rscd", text)


def test_a_model_without_its_text_is_skipped(models: tuple[rsc.Base, sct.SupervisoryControlModel]) -> None:
    found = validate_model(None, models[1])
    assert (found.outcome, found.explanation) == (Outcome.SKIPPED, "the model was not read from its text")


def test_what_it_does_not_know_is_named(models: tuple[rsc.Base, sct.SupervisoryControlModel]) -> None:
    models[0].definitions.append(rsc.Requirement())
    found = validate_model(*models)
    models[0].definitions.pop()
    assert (found.outcome, found.explanation) == (Outcome.SKIPPED, "`Requirement` is not read a second time")


def agrees(path: Path, text: str) -> bool | None:
    """Return whether nothing is refuted; None for a model with errors."""
    path.write_text(text, encoding="utf-8")
    reading = read(path, [LIBRARIES])
    found = [*reading.findings, *check(reading.base, reading.findings)]
    if not isinstance(reading.base, rsc.Robot) or has_errors(found):
        return None
    said = validate_model(
        reading.base, robosc.to_sct(reading.base), Effort(states=20_000, tries=3_000_000, values=20_000, random=10_000)
    )
    assert said.outcome in {Outcome.PROVED, Outcome.SAMPLED}, said
    return True


@pytest.mark.slow
def test_every_model_of_the_repository_says_what_its_plants_do(tmp_path: Path) -> None:
    found = [agrees(tmp_path / "model.rscd", "".join(text)) for text in sources()]
    assert found.count(True) > 100


@pytest.mark.slow
@pytest.mark.parametrize("made", [random_robot, second_edition_robot, assuming_robot, served_robot])
def test_a_random_robot_says_what_its_plants_do(made: Callable[[int], str], tmp_path: Path) -> None:
    count = examples(10)
    assert [agrees(tmp_path / "model.rscd", made(seed)) for seed in range(count)].count(True) > 0.8 * count
