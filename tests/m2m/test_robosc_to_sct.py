"""The plants and requirements of a robot model."""

from robosc.model import expression as ex
from robosc.model.semantics.edges import edges_from
from robosc.model.semantics.printing import SctPrinter

MESSAGES = """
robot R {
  component Sensor {
    outgoing message near with identifier: "/near", type: none
    outgoing message far with type: none
    behaviour {
      initial marked state clear { on response from near goto blocked }
      state blocked { on response from far goto clear transition goto clear }
    }
  }
  component Motor { incoming message go with identifier: "/go", type: none }
  requirement go needs Sensor.clear
  requirement Sensor.blocked disables go
}
"""

ACTION = """
robot R {
  interface i use Move from nav
  datatype object Progress { percent: integer(0..100) }
  component Arm {
    action grab with request: none, response: none, feedback: Progress links i
    outgoing message halt with type: none
    behaviour {
      variable percent: integer(0..50)
      initial marked state free { on request to grab goto busy }
      state busy {
        on feedback from grab do percent := value.percent
        on response from grab goto free
        on cancel from grab goto free
      }
    }
  }
  REQUIREMENTS
}
"""


def plant(model, name):
    return next(automaton for automaton in model.plants if automaton.name == name)


def edges(model, name):
    return {
        (location.name, edge.event.name, edge.target.name)
        for location in plant(model, name).locations
        for edge in edges_from(location)
    }


def show(expression):
    return SctPrinter()(expression)


def test_plants_stand_in_the_order_of_the_text(to_sct):
    model, _ = to_sct(MESSAGES)
    assert [automaton.name for automaton in model.plants] == [
        "message_near",
        "message_far",
        "component_Sensor",
        "message_go",
    ]
    assert [automaton.topic for automaton in model.plants] == ["/near", "far", None, "/go"]


def test_only_what_the_controller_sends_is_controllable(to_sct):
    model, _ = to_sct(MESSAGES)
    events = {
        f"{automaton.name}.{event.name}": event.controllable for automaton in model.plants for event in automaton.events
    }
    assert events == {
        "message_near.u_response": False,
        "message_far.u_response": False,
        "component_Sensor.c_tau1": True,
        "message_go.c_trigger": True,
    }


def test_a_component_never_blocks_what_it_hears_of_elsewhere(to_sct):
    model, _ = to_sct(MESSAGES)
    near, far = (plant(model, name).events[0] for name in ("message_near", "message_far"))
    loops = {
        (location.name, edge.event)
        for location in plant(model, "component_Sensor").locations
        for edge in edges_from(location)
        if edge.target is location
    }
    assert loops == {("clear", far), ("blocked", near)}


def test_requests_get_no_self_loop(to_sct):
    model, _ = to_sct(ACTION.replace("REQUIREMENTS", ""))
    assert edges(model, "component_Arm") == {
        ("free", "c_trigger", "busy"),
        ("free", "u_feedback", "free"),
        ("free", "u_response", "free"),
        ("free", "c_cancel", "free"),
        ("busy", "u_feedback", "busy"),
        ("busy", "u_response", "free"),
        ("busy", "c_cancel", "free"),
    }


def test_an_action_ends_when_its_server_says_so(to_sct):
    model, _ = to_sct(ACTION.replace("REQUIREMENTS", ""))
    assert edges(model, "action_grab") == {
        ("idle", "c_trigger", "executing"),
        ("executing", "u_feedback", "executing"),
        ("executing", "u_response", "ready"),
        ("executing", "u_error", "error"),
        ("executing", "c_cancel", "canceling"),
        ("canceling", "u_feedback", "canceling"),
        ("canceling", "u_response", "ready"),
        ("canceling", "u_error", "error"),
        ("canceling", "u_canceled", "idle"),
        ("ready", "c_reset", "idle"),
        ("error", "c_reset", "idle"),
    }
    assert [location.name for location in plant(model, "action_grab").locations if location.marked] == ["idle"]


def test_a_service_is_listing_5_2(to_sct):
    model, _ = to_sct("robot R { component C { service s with request: none, response: none } }")
    assert edges(model, "service_s") == {
        ("idle", "c_trigger", "wait_for_response"),
        ("wait_for_response", "u_response", "ready"),
        ("wait_for_response", "u_error", "error"),
        ("ready", "c_reset", "idle"),
        ("error", "c_reset", "idle"),
    }


def test_each_requirement_restricts_the_trigger(to_sct):
    model, _ = to_sct(MESSAGES)
    assert [
        (requirement.event.name, requirement.kind.name, show(requirement.condition))
        for requirement in model.requirements
    ] == [
        ("c_trigger", "needs", "component_Sensor.clear"),
        ("c_trigger", "disables", "component_Sensor.blocked"),
    ]
    assert [requirement.text for requirement in model.requirements] == [
        "requirement go needs Sensor.clear",
        "requirement Sensor.blocked disables go",
    ]


def test_an_action_is_cancelled_exactly_when_a_requirement_no_longer_holds(to_sct):
    requirements = "requirement grab needs Arm.free requirement Arm.percent > 10 disables grab"
    model, _ = to_sct(ACTION.replace("REQUIREMENTS", requirements))
    cancel = next(requirement for requirement in model.requirements if requirement.event.name == "c_cancel")
    assert cancel.kind.name == "needs"
    assert show(cancel.condition) == "!component_Arm.free or component_Arm.percent > 10"


def test_an_action_without_requirement_is_never_cancelled(to_sct):
    model, _ = to_sct(ACTION.replace("REQUIREMENTS", ""))
    assert [show(requirement.condition) for requirement in model.requirements] == ["false"]


def test_only_needed_data_is_in_a_plant(to_sct):
    model, _ = to_sct(ACTION.replace("REQUIREMENTS", ""))
    assert not plant(model, "component_Arm").variables
    assert not plant(model, "action_grab").inputs
    model, _ = to_sct(ACTION.replace("REQUIREMENTS", "requirement grab needs Arm.percent = 0"))
    assert [variable.name for variable in plant(model, "component_Arm").variables] == ["percent"]
    assert [input_.name for input_ in plant(model, "action_grab").inputs] == ["i_feedback_percent"]
    feedback = next(event for event in plant(model, "action_grab").events if event.name == "u_feedback")
    assert list(feedback.inputs) == list(plant(model, "action_grab").inputs)


def test_data_elimination_is_transitive(to_sct):
    model, _ = to_sct(
        """robot R {
          component C {
            outgoing message m with type: integer(0..9)
            incoming message n with type: none
            behaviour {
              variable a: integer(0..9) variable b: integer(0..9) = 2 variable unused: double
              initial marked state s { on response from m do a := value, b := a }
            }
          }
          requirement n needs C.b > 3
        }"""
    )
    component = plant(model, "component_C")
    assert [variable.name for variable in component.variables] == ["a", "b"]
    assert [show(variable.initial) for variable in component.variables] == ["0", "2"]
    (edge,) = component.locations[0].edges
    assert [(update.variable.name, show(update.value)) for update in edge.updates] == [
        ("a", "message_m.i_response"),
        ("b", "component_C.a"),
    ]


def test_a_variable_without_initial_value_starts_at_the_default_of_its_type(to_sct):
    model, _ = to_sct(
        """robot R {
          datatype enum E from double to { value > 1.0 -> high default -> low }
          component C {
            incoming message n with type: none
            behaviour {
              variable b: boolean variable i: integer(3..9) variable j: integer(-9..-3) variable e: E
              initial marked state s { }
            }
          }
          requirement n needs C.b or C.i = 4 or C.j = 4 or C.e = high
        }"""
    )
    shown = {variable.name: show(variable.initial) for variable in plant(model, "component_C").variables}
    assert shown == {"b": "false", "i": "3", "j": "-3", "e": "low"}


def test_provided_data_becomes_a_data_plant(to_sct):
    model, _ = to_sct(
        MESSAGES.replace('"/go", type: none', '"/go", type: integer').replace(
            "requirement go needs", "provide go with 1 if Sensor.clear provide go with 2 requirement go needs"
        )
    )
    assert model.plants[-1].name == "data_go"
    assert edges(model, "data_go") == {
        (here, event, there)
        for here in ("none", "d1", "d2")
        for event, there in (("c_d1", "d1"), ("c_d2", "d2"), ("c_none", "none"))
    }
    guards = {edge.event.name: edge.guard for edge in edges_from(plant(model, "data_go").locations[0])}
    assert {name: show(guard) if guard else None for name, guard in guards.items()} == {
        "c_d1": "component_Sensor.clear",
        "c_d2": None,
        "c_none": "false",
    }
    assert all(location.marked for location in plant(model, "data_go").locations)


def test_two_instances_of_one_component_are_independent(to_sct):
    library = """library L {
      component Stop {
        outgoing message stop with identifier: "/stop", type: none
        behaviour { initial marked state running { on response from stop goto off } marked state off { } }
      }
    }"""
    model, _ = to_sct(
        """robot R {
          component Front from L import Stop
          component Rear from L import Stop with { stop: "/rear/stop" }
          component M { incoming message go with type: none }
          requirement go needs Front.running and Rear.running
        }""",
        L=library,
    )
    assert [(automaton.name, automaton.topic) for automaton in model.plants] == [
        ("message_Front_stop", "/stop"),
        ("component_Front", None),
        ("message_Rear_stop", "/rear/stop"),
        ("component_Rear", None),
        ("message_go", "go"),
    ]
    assert show(model.requirements[0].condition) == "component_Front.running and component_Rear.running"


def test_a_generated_name_gives_way_to_the_authors(to_sct):
    model, _ = to_sct(
        """robot R { component C { behaviour {
          initial marked state c_tau1 { transition goto other }
          state other { transition goto c_tau1 }
        } } }"""
    )
    assert [event.name for event in plant(model, "component_C").events] == ["c_tau1_", "c_tau2"]


def test_a_comparison_of_doubles_becomes_one_of_integers(to_sct):
    model, _ = to_sct(
        """robot R {
          component C {
            incoming message n with type: none
            behaviour { variable level: integer(0..9) = 1 initial marked state s { } }
          }
          requirement n needs C.level / 2 > 1
          requirement n needs C.level * 0.5 != 2.0
        }"""
    )
    assert [show(requirement.condition) for requirement in model.requirements] == [
        "component_C.level >= 3",
        "component_C.level <= 3 or component_C.level >= 5",
    ]


def test_every_element_says_where_it_comes_from(to_sct):
    model, trace = to_sct(MESSAGES)
    assert str(model.requirements[0].source) == "robot.rscd:12:3-12:36"
    assert trace.origins[plant(model, "component_Sensor")].name == "Sensor"
    assert plant(model, "component_Sensor").origin == "Sensor"
    assert plant(model, "message_near").origin == "Sensor.near"
    assert all(isinstance(origin, ex.Located) for origin in trace.origins.values())


def test_of_two_assignments_to_one_variable_the_last_counts(to_sct):
    model, _ = to_sct(
        """robot R {
          component C {
            outgoing message m with type: none
            behaviour {
              variable a: integer(0..3)
              initial marked state s { on response from m do a := 1, a := 2 transition if a = 1 }
            }
          }
        }"""
    )
    (update,) = plant(model, "component_C").locations[0].edges[0].updates
    assert show(update.value) == "2"


def test_a_comparison_of_strings_is_a_constant_or_a_choice(to_sct):
    model, _ = to_sct(
        """robot R {
          component C {
            incoming message m with type: none
            behaviour { variable x: boolean variable y: boolean initial marked state s { } }
          }
          requirement m needs C.s and "a" = "a"
          requirement "a" != "a" disables m
          requirement m needs (if false then "b" else "a") = "a"
          requirement m needs (if C.x then "a" else "b") = "a"
          requirement m needs (if C.x then "a" else "b") != (if C.y then "a" else "b")
        }"""
    )
    assert [show(requirement.condition) for requirement in model.requirements] == [
        "component_C.s and true",
        "false",
        "!false",
        "component_C.x",
        "(!component_C.x and component_C.y) or (component_C.x and !component_C.y)",
    ]
