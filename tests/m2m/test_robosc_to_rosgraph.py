"""The ROS side of a robot model."""

from collections.abc import Callable
from pathlib import Path

import pytest

from robosc.base.ros_types import RosTypes
from robosc.m2m import robosc_to_rosgraph, robosc_to_sct
from robosc.model import expression as ex
from robosc.model import rosgraph, sct
from robosc.model.semantics.printing import RobotPrinter
from robosc.model.semantics.roles import Roles

SCANNER = """
robot R {
  interface laser use LaserScan from sensor_msgs
  interface twist use Twist from geometry_msgs
  datatype object Vector { x: double z: double }
  datatype object Twist { linear: Vector angular: Vector }
  datatype object Scan { ranges: array(double) count: integer }
  datatype enum Front from Scan to { value.ranges[0] < 1.0 and value.count / 2 > 1 -> near default -> open }
  datatype enum Side from Scan to { value.ranges[90] < 1.0 -> wall default -> gap }
  datatype enum Level from double to { value > 1.0 -> high default -> low }
  component Lidar {
    outgoing message front with identifier: "/scan", type: Front links laser
    outgoing message side with identifier: "scan", type: Side links laser
    outgoing message battery with type: Level
    outgoing message offset with type: double
    behaviour {
      variable f: Front variable s: Side variable battery_level: Level
      variable last: double = -0.5
      variable scaled: double
      on response from front do f := value
      on response from battery do battery_level := value
      initial marked state a {
        on response from side do s := value
        on response from offset do last := value, scaled := last goto b
      }
      state b { on response from offset do last := value / 2 goto a }
    }
  }
  component Base {
    incoming message go with identifier: "cmd_vel", type: Twist links twist
    incoming message stop with identifier: "/cmd_vel", type: Twist links twist
    incoming message blink with type: integer
  }
  requirement go needs Lidar.f = open and Lidar.a
  provide go with { linear: { x: 0.5 }, angular: { z: -Lidar.last / 100 } } if Lidar.a
  provide go with { linear: { x: 0.1 } }
  provide blink with 3
}
"""


@pytest.fixture
def graph(robot: Callable) -> rosgraph.RosGraph:
    _, trace = robosc_to_sct.transform(robot(SCANNER))
    return robosc_to_rosgraph.transform(trace)


def test_one_topic_of_one_type_is_one_subscription_with_a_slash_or_without(graph):
    shown = [
        (subscription.topic, subscription.interface.type, [part.name for part in subscription.receptions])
        for subscription in graph.subscriptions
    ]
    assert shown == [
        ("/scan", "LaserScan", ["front", "side"]),
        ("battery", "Float32", ["battery"]),
        ("offset", "Float32", ["offset"]),
    ]


def test_messages_to_one_topic_share_a_publisher(graph):
    shown = [
        (publisher.topic, publisher.interface.type, [part.name for part in publisher.sendings])
        for publisher in graph.publishers
    ]
    assert shown == [("cmd_vel", "Twist", ["go", "stop"]), ("blink", "Int16", ["blink"])]


def test_an_interface_stands_once(graph):
    assert [(interface.package, interface.type) for interface in graph.interfaces] == [
        ("sensor_msgs", "LaserScan"),
        ("std_msgs", "Float32"),
        ("geometry_msgs", "Twist"),
        ("std_msgs", "Int16"),
    ]


def test_what_the_supervisor_does_not_need_lives_in_the_node(graph):
    assert [(variable.component, variable.name) for variable in graph.variables] == [
        ("Lidar", "s"),
        ("Lidar", "battery_level"),
        ("Lidar", "last"),
        ("Lidar", "scaled"),
    ]
    assert [enumeration.name for enumeration in graph.enumerations] == ["Side", "Level"]


def test_only_needed_data_becomes_an_input(graph):
    inputs = {part.name: list(part.inputs) for subscription in graph.subscriptions for part in subscription.receptions}
    assert {name: len(input_) for name, input_ in inputs.items()} == {"front": 1, "side": 0, "battery": 0, "offset": 0}
    call = inputs["front"][0].value
    assert isinstance(call, rosgraph.ConversionCall)
    assert call.conversion.name == "Front"
    assert call.argument.type is None
    assert not call.argument.steps
    assert call.conversion.enumeration.eContainer() is graph.model


def test_a_conversion_reads_the_message_and_divides_doubles(graph):
    rule = next(conversion for conversion in graph.conversions if conversion.name == "Front").rules[0]
    near, many = rule.condition.left, rule.condition.right
    field, index = near.left.steps
    assert (field.name, index.index) == ("ranges", 0)
    assert isinstance(many.left, ex.Division)
    assert isinstance(many.left.left, ex.DoubleConversion)
    assert many.left.right.value == 2.0
    assert many.right.value == 1.0
    assert rule.literal.name == "near"


def test_a_basic_value_is_in_the_field_data(graph):
    level = next(reaction for reaction in graph.reactions if reaction.assignments[0].variable.name == "battery_level")
    argument = level.assignments[0].value.argument
    assert [step.name for step in argument.steps] == ["data"]
    assert isinstance(argument.type, ex.DoubleType)


def test_reactions_stand_where_their_transitions_do(graph):
    shown = [
        (
            reaction.event.eContainer().name,
            [at.name for at in reaction.locations],
            [a.variable.name for a in reaction.assignments],
        )
        for reaction in graph.reactions
    ]
    assert shown == [
        ("message_battery", ["a", "b"], ["battery_level"]),
        ("message_side", ["a"], ["s"]),
        ("message_offset", ["a"], ["last", "scaled"]),
        ("message_offset", ["b"], ["last"]),
    ]


def test_provided_data_is_flattened_to_fields(graph):
    go = graph.publishers[0].sendings[0]
    assert [alternative.location.name for alternative in go.alternatives] == ["d1", "d2"]
    assert [list(field.path) for field in go.alternatives[0].fields] == [["linear", "x"], ["angular", "z"]]
    assert isinstance(go.alternatives[0].fields[1].value, ex.Division)
    assert not graph.publishers[0].sendings[1].alternatives
    (blink,) = graph.publishers[1].sendings[0].alternatives
    assert [list(field.path) for field in blink.fields] == [["data"]]


def test_node_expressions_may_read_the_state(robot):
    _, trace = robosc_to_sct.transform(
        robot(
            """robot R {
              component C {
                incoming message lamp with type: boolean
                outgoing message m with type: integer(0..3)
                behaviour {
                  variable n: integer(0..3)
                  variable copy: integer
                  on response from m do n := value, copy := n + 1
                  initial marked state off { transition if n > 1 goto lit }
                  state lit { }
                }
              }
              provide lamp with C.lit
            }""".replace("state lit { }", "marked state lit { }")
        )
    )
    graph = robosc_to_rosgraph.transform(trace)
    (field,) = graph.publishers[0].sendings[0].alternatives[0].fields
    assert isinstance(field.value, sct.LocationReference)
    (assignment,) = graph.reactions[0].assignments
    assert isinstance(assignment.value.left, sct.VariableReference)


def test_an_initial_value_may_be_no_number(robot):
    _, trace = robosc_to_sct.transform(
        robot(
            """robot R {
              component C {
                incoming message m with type: double
                behaviour {
                  variable down: double = -2.0 / 0
                  variable nothing: double = 0.0 / 0
                  initial marked state s { }
                }
              }
              provide m with C.down + C.nothing
            }"""
        )
    )
    initial = [variable.initial for variable in robosc_to_rosgraph.transform(trace).variables]
    assert all(isinstance(value, ex.Division) and value.right.value == 0.0 for value in initial)
    assert (initial[0].left.operand.value, initial[1].left.value) == (1.0, 0.0)


def test_services_and_actions_have_their_events(robot):
    _, trace = robosc_to_sct.transform(
        robot(
            """robot R {
              interface b use SetBool from std_srvs
              interface n use Move from nav
              datatype object Ask { data: boolean }
              datatype object Answer { success: boolean }
              component C {
                service s with identifier: "/s", request: Ask, response: Answer links b
                service e with request: none, response: none
                action a with request: none, response: none, feedback: none links n
                behaviour { variable ok: boolean initial marked state x { on response from s do ok := value.success } }
              }
              provide s with { data: C.x }
            }"""
        )
    )
    graph = robosc_to_rosgraph.transform(trace)
    assert [(client.identifier, client.interface.type) for client in graph.serviceClients] == [
        ("/s", "SetBool"),
        ("e", "Empty"),
    ]
    service, (action,) = graph.serviceClients[0], graph.actionClients
    assert [service.request.event.name, service.response.event.name, service.error.event.name, service.reset.name] == [
        "c_trigger",
        "u_response",
        "u_error",
        "c_reset",
    ]
    assert [action.feedback.event.name, action.cancel.name] == ["u_feedback", "c_cancel"]
    (reaction,) = graph.reactions
    assert [step.name for step in reaction.assignments[0].value.steps] == ["success"]


def test_linked_basic_data_goes_to_the_only_field(robot: Callable, tmp_path: Path) -> None:
    for name, text in {
        "msg/Level.msg": "int32 level\n",
        "msg/Two.msg": "int32 level\nint32 data\n",
        "srv/Lift.srv": "float64 height\n---\nbool done\n",
        "action/Raise.action": "float64 goal\n---\nbool reached\n---\nfloat64 height\n",
    }.items():
        path = tmp_path / "hoist_msgs" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    model = robot("""
        robot R {
          interface level use Level from hoist_msgs
          interface two use Two from hoist_msgs
          interface lift use Lift from hoist_msgs
          interface raise use Raise from hoist_msgs
          component Hoist {
            incoming message go with type: integer links level
            incoming message both with type: integer links two
            outgoing message seen with type: integer links level
            service lift with request: double, response: boolean links lift
            action raise with request: double, response: boolean, feedback: double links raise
            behaviour {
              variable height: double variable done: boolean variable level: integer
              on response from seen do level := value
              on response from lift do done := value
              on response from raise do done := value
              on feedback from raise do height := value
              initial marked state idle { }
            }
          }
          provide go with 1
          provide both with 2
          provide lift with 3.0
          provide raise with 4.0
        }
    """)
    _, trace = robosc_to_sct.transform(model)
    graph = robosc_to_rosgraph.transform(trace, RosTypes([tmp_path]))
    sent = [*(sending for topic in graph.publishers for sending in topic.sendings)]
    sent += [client.request for client in (*graph.serviceClients, *graph.actionClients)]
    assert [list(event.alternatives[0].fields[0].path) for event in sent] == [["level"], ["data"], ["height"], ["goal"]]
    read = [[step.name for step in reaction.assignments[0].value.steps] for reaction in graph.reactions]
    assert read == [["level"], ["done"], ["reached"], ["height"]]
    # Without the definitions, `data` is a guess.
    unknown = robosc_to_rosgraph.transform(trace, RosTypes())
    assert {step.name for reaction in unknown.reactions for step in reaction.assignments[0].value.steps} == {"data"}


def test_kept_objects_are_where_they_came_from(robot: Callable) -> None:
    """Variables that store objects have the ROS type of the stored data.

    `do route := value.poses`: this holds for objects and for arrays of them, in one step or several.
    """
    model = robot("""
        robot R {
          component Mission {
            outgoing message route with type: nav_msgs/Path
            behaviour {
              variable route: array(geometry_msgs/PoseStamped)
              variable whole: nav_msgs/Path
              variable third: geometry_msgs/PoseStamped
              variable place: geometry_msgs/Point
              on response from route
                do route := value.poses, whole := value, third := route[2], place := third.pose.position
              initial marked state idle { }
            }
          }
        }
    """)
    _, trace = robosc_to_sct.transform(model)
    graph = robosc_to_rosgraph.transform(trace)
    assert {variable.name: (variable.reception.event.name, list(variable.path)) for variable in graph.variables} == {
        "route": ("u_response", ["poses"]),
        "whole": ("u_response", []),
        "third": ("u_response", ["poses", "0"]),
        "place": ("u_response", ["poses", "0", "pose", "position"]),
    }


CHOICES = SCANNER.replace(
    "provide go with { linear: { x: 0.1 } }",
    """provide stop with
    if Lidar.f = near then { linear: if Lidar.a then { x: 0.1 } else { x: 0.2 } }
    else if Lidar.b then { linear: { x: 0.3 } } else { linear: { x: 0.4 } }""",
)


def test_each_value_of_a_choice_has_the_conditions_on_its_way(robot: Callable) -> None:
    """The condition of a value after `else` is that the one after `if` does not hold."""
    _, trace = robosc_to_sct.transform(robot(CHOICES))
    graph = robosc_to_rosgraph.transform(trace)
    (stop,) = (part for publisher in graph.publishers for part in publisher.sendings if part.name == "stop")
    (alternative,) = stop.alternatives
    shown = [(field.value.value, RobotPrinter()(field.condition)) for field in alternative.fields]
    assert shown == [
        (0.1, "Lidar.f = near and Lidar.a"),
        (0.2, "Lidar.f = near and !Lidar.a"),
        (0.3, "!(Lidar.f = near) and Lidar.b"),
        (0.4, "!(Lidar.f = near) and !Lidar.b"),
    ]


SERVED = """
robot Served {
  interface ordering use AddTwoInts from example_interfaces
  interface inspection use Fibonacci from example_interfaces
  datatype object Order { a: integer(0..9) b: integer }
  datatype object Answer { sum: integer }
  datatype object Report { sequence: array(integer) }
  component Desk {
    outgoing service start with identifier: "/start", request: Order, response: Answer links ordering
    outgoing service ask with request: none, response: none
    outgoing action inspect with identifier: "/inspect", request: none, response: Report, feedback: Report
      links inspection
    behaviour {
      variable last: integer
      initial marked state idle {
        on request from start if value.a > 3 do last := value.b
        on response to start
        on request from inspect goto busy
      }
      marked state busy {
        on feedback to inspect
        on error to inspect goto idle
        on canceled to inspect goto idle
      }
    }
    provide start with { sum: last + 1 }
    provide inspect with { sequence: [last] } if busy
    provide feedback to inspect with { sequence: [7] }
  }
}
"""


def test_servers(robot: Callable) -> None:
    model, trace = robosc_to_sct.transform(robot(SERVED))
    graph = robosc_to_rosgraph.transform(trace)
    start, ask = graph.serviceServers
    assert (start.identifier, start.interface.type, start.request.event.name) == ("/start", "AddTwoInts", "u_request")
    assert [assignment.input.name for assignment in start.request.inputs] == ["i_request_a"]
    assert start.response is not None
    assert [alternative.location.name for alternative in start.response.alternatives] == ["d1"]
    assert (ask.identifier, ask.interface.package, ask.response) == ("ask", "std_srvs", None)
    (inspect,) = graph.actionServers
    assert (inspect.response, inspect.cancel.name) == (None, "u_cancel")
    sendings = {word: getattr(inspect, word) for word in ("feedback", "error", "canceled")}
    plants = {word: sending.alternatives[0].location.eContainer().name for word, sending in sendings.items()}
    assert plants == {"feedback": "data_inspect_feedback", "error": "data_inspect", "canceled": "data_inspect"}
    chosen = {event.name: plant.name for event, plant in Roles(model).data_plants.items()}
    assert chosen == {
        "c_response": "data_start",
        "c_feedback": "data_inspect_feedback",
        "c_error": "data_inspect",
        "c_canceled": "data_inspect",
    }
