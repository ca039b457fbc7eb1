"""The second reading of served communications agrees with the plants; a change of any of their edges is refuted."""

from collections.abc import Callable
from pathlib import Path

import pytest

import robosc
from robosc.analysis.verify import validate_model
from robosc.analysis.verify.controller_reading import validate_controller
from robosc.analysis.verify.verdict import Outcome, Verdict
from robosc.language.checks import check
from robosc.language.reading import read
from robosc.language.text import Documents
from robosc.m2m import robosc_to_rosgraph, robosc_to_sct
from robosc.m2t.models import Models
from robosc.model import robosc as rsc
from robosc.model import rosgraph, sct
from robosc.model.semantics.edges import edges_of
from robosc.model.semantics.roles import event_name

ROBOT = """\
robot Served {
    interface switch use SetBool from std_srvs
    interface task use Fibonacci from example_interfaces
    datatype object Switch { data: boolean }
    datatype object Answer { success: boolean }
    datatype object Order { order: integer(0..3) }
    datatype object Report { sequence: array(integer) }

    component Desk {
        outgoing service start with request: Switch, response: Answer links switch
        outgoing service mute with request: none, response: none
        behaviour {
            variable asked: boolean = false
            initial marked state idle {
                on request from start if value.data do asked := value.data goto busy
            }
            state busy { on response to start do asked := false goto idle }
        }
    }
    component Camera {
        outgoing action inspect with request: Order, response: Report, feedback: Report links task
        outgoing action watch with request: none, response: none, feedback: none links task
        outgoing action closed with request: none, response: none, feedback: none links task
        behaviour {
            variable left: integer(0..3) = 0
            initial marked state idle {
                on request from inspect if value.order > 0 do left := value.order goto looking
                on request from watch goto watching
            }
            state looking {
                on feedback to inspect do left := left - 1
                on response to inspect if left = 0 goto idle
                on error to inspect if left > 2 goto idle
                on canceled to inspect goto idle
            }
            state watching { on response to watch goto idle }
        }
    }
    component Lid {
        behaviour {
            initial marked state shut { transition if !Camera.inspect.running goto open }
            state open {
                on request from inspect
                transition if Desk.start.running goto shut
            }
        }
    }
    provide start with { success: true } if Camera.idle
    provide start with { success: false }
    provide inspect with { sequence: [Camera.left] } if Camera.left > 0
    provide feedback to inspect with { sequence: [Camera.left] }
    requirement start needs Lid.open and value.success
    requirement inspect needs !Desk.busy
    requirement feedback to inspect after each request from inspect
    requirement at most 2 error to inspect since canceled to inspect
    property never Desk.busy and Camera.watching and Lid.shut
}
"""


@pytest.fixture(scope="module")
def robot() -> rsc.Base:
    """Return the robot, which tests must not change."""
    path = Path("served.rscd")
    reading = read(path, documents=Documents({str(path): ROBOT}))
    found = [*reading.findings, *check(reading.base, reading.findings)]
    assert [finding.message for finding in found if finding.severity.value == "error"] == []
    assert isinstance(reading.base, rsc.Robot)
    return reading.base


def event(model: sct.SupervisoryControlModel, name: str) -> sct.Event:
    return next(event for plant in model.plants for event in plant.events if event_name(event) == name)


def plant(model: sct.SupervisoryControlModel, name: str) -> sct.Plant:
    return next(plant for plant in model.plants if plant.name == name)


def edge(model: sct.SupervisoryControlModel, place: str, name: str) -> sct.Edge:
    owner, _, location = place.partition(".")
    wanted = next(known for known in plant(model, owner).locations if known.name == location)
    return next(edge for edge in wanted.edges if event_name(edge.event) == name)


def test_the_text_and_the_plants_agree(robot: rsc.Base) -> None:
    verdict = validate_model(robot, robosc_to_sct.transform(robot)[0])
    assert verdict.outcome is Outcome.PROVED, verdict.explanation
    assert "states" in verdict.evidence


def test_only_events_that_are_named_exist(robot: rsc.Base) -> None:
    model = robosc_to_sct.transform(robot)[0]
    served = {known.name: [event.name for event in known.events] for known in model.plants if "watch" in known.name}
    assert served == {"action_watch": ["u_request", "c_response"]}


@pytest.mark.parametrize(
    "name", ["service_start", "service_mute", "action_inspect", "action_watch", "component_Camera", "component_Lid"]
)
def test_an_edge_that_is_missing_or_leads_elsewhere_is_refuted(robot: rsc.Base, name: str) -> None:
    count = len(edges_of(plant(robosc_to_sct.transform(robot)[0], name)))
    assert count
    for number in range(count):
        lost, moved = (robosc_to_sct.transform(robot)[0] for _ in range(2))
        removed = edges_of(plant(lost, name))[number]
        removed.eContainer().edges.remove(removed)
        turned = edges_of(plant(moved, name))[number]
        turned.target = next(place for place in plant(moved, name).locations if place is not turned.target)
        for model in (lost, moved):
            verdict = validate_model(robot, model)
            assert verdict.outcome is Outcome.REFUTED, f"{event_name(turned.event)} ({number}): {verdict}"


def a_goal_is_accepted_whatever_it_is(model: sct.SupervisoryControlModel) -> None:
    edge(model, "component_Camera.idle", "action_inspect.u_request").guard = None


def a_goal_is_accepted_that_nothing_names(model: sct.SupervisoryControlModel) -> None:
    edge(model, "action_closed.idle", "action_closed.u_request").guard = None


def a_component_does_not_reject_a_goal(model: sct.SupervisoryControlModel) -> None:
    shut = next(place for place in plant(model, "component_Lid").locations if place.name == "shut")
    shut.edges.append(sct.Edge(event=event(model, "action_inspect.u_request"), target=shut))


def a_component_blocks_a_request(model: sct.SupervisoryControlModel) -> None:
    idle = next(place for place in plant(model, "component_Desk").locations if place.name == "idle")
    ignored = [one for one in idle.edges if event_name(one.event) == "service_start.u_request" and not one.updates]
    idle.edges.remove(*ignored)


def an_answer_is_uncontrollable(model: sct.SupervisoryControlModel) -> None:
    event(model, "action_inspect.c_error").controllable = False


def a_cancel_has_the_kind_of_a_request(model: sct.SupervisoryControlModel) -> None:
    event(model, "action_inspect.u_cancel").kind = sct.EventKind.request


def an_open_request_is_not_marked(model: sct.SupervisoryControlModel) -> None:
    next(place for place in plant(model, "service_start").locations if place.name == "open").marked = False


def a_requirement_restricts_the_request(model: sct.SupervisoryControlModel) -> None:
    restricted = next(one for one in model.requirements if event_name(one.event) == "action_inspect.c_response")
    restricted.event = event(model, "action_inspect.c_error")


def feedback_has_the_data_of_the_result(model: sct.SupervisoryControlModel) -> None:
    feedback, result = plant(model, "data_inspect_feedback"), plant(model, "data_inspect")
    feedback.origin, result.origin = result.origin, feedback.origin


MUTANTS = [
    a_goal_is_accepted_whatever_it_is,
    a_goal_is_accepted_that_nothing_names,
    a_component_does_not_reject_a_goal,
    a_component_blocks_a_request,
    an_answer_is_uncontrollable,
    a_cancel_has_the_kind_of_a_request,
    an_open_request_is_not_marked,
    a_requirement_restricts_the_request,
    feedback_has_the_data_of_the_result,
]


@pytest.mark.parametrize("change", MUTANTS, ids=lambda change: change.__name__)
def test_a_wrong_plant_is_refuted(robot: rsc.Base, change: Callable[[sct.SupervisoryControlModel], None]) -> None:
    model = robosc_to_sct.transform(robot)[0]
    change(model)
    assert validate_model(robot, model).outcome is Outcome.REFUTED


def test_the_node_serves_what_the_text_has(robot: rsc.Base) -> None:
    plants, trace = robosc_to_sct.transform(robot)
    robosc.synthesize(plants)

    def verdict(change: Callable[[rosgraph.RosGraph], object]) -> Verdict:
        graph = robosc_to_rosgraph.transform(trace)
        change(graph)
        return validate_controller(Models(plants, graph, robot))

    assert verdict(lambda _: None).outcome is Outcome.PROVED
    renamed = verdict(lambda graph: setattr(graph.serviceServers[0], "identifier", "/begin"))
    assert renamed.explanation == "`Desk.start` is `start` in ROS by the text, and `/begin` in the node"
    lost = verdict(lambda graph: graph.actionServers.pop())
    assert lost.explanation == "the text and the node do not serve the same: `Camera.closed`"
