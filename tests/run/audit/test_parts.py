"""Audits of services, actions, data, assumptions and the order of messages: expectations by hand."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from robosc.language.configuration import Configuration
from robosc.model import rosgraph
from robosc.run.audit import judge
from tests.run.audit.recordings import SECOND, START, Entry, store, write_bag, write_mcap, write_sqlite
from tests.run.audit.test_audit import audited, graph_of

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from robosc.run.audit import Audit

#: A robot that drives to poses while its door is closed, and beams its lamp while it drives.
PORTER = """robot Porter {
  interface drive use NavigateToPose from nav2_msgs
  interface switch use SetBool from std_srvs
  component Door {
    outgoing message opened with identifier: "/opened", type: none
    outgoing message closed with identifier: "/closed", type: none
    behaviour {
      initial marked state closed { on response from opened goto open }
      state open { on response from closed goto closed }
    }
  }
  component Base {
    action drive with identifier: "/drive", request: none, response: none, feedback: none links drive
    behaviour {
      initial marked state standing { on request to drive goto driving }
      state driving {
        on cancel from drive goto stopping
        on response from drive goto standing
        on error from drive goto standing
      }
      state stopping {
        on response from drive goto standing
        on error from drive goto standing
        on canceled from drive goto standing
      }
    }
  }
  datatype object Answer { success: boolean }
  component Lamp {
    service beam with identifier: "/beam", request: none, response: Answer links switch
    behaviour {
      variable works: boolean = true
      initial marked state lamp {
        on response from beam do works := value.success
        on error from beam do works := false
      }
    }
  }
  requirement drive needs Door.closed
  requirement beam needs Base.driving
}
"""
#: Types that services and actions are recorded with.
ROS_2 = {
    "nav2_msgs/msg/NavigateToPose_Feedback": "float32 distance_remaining\n",
    "nav2_msgs/msg/NavigateToPose_FeedbackMessage": (
        "unique_identifier_msgs/UUID goal_id\nnav2_msgs/NavigateToPose_Feedback feedback\n"
    ),
    "std_srvs/msg/SetBool_Request": "bool data\n",
    "std_srvs/msg/SetBool_Response": "bool success\nstring message\n",
    "std_srvs/msg/SetBool_Event": (
        "service_msgs/ServiceEventInfo info\nstd_srvs/SetBool_Request[<=1] request\n"
        "std_srvs/SetBool_Response[<=1] response\n"
    ),
}
ROS_1 = {
    "nav2_msgs/msg/NavigateToPoseGoal": "float32 x\n",
    "nav2_msgs/msg/NavigateToPoseFeedback": "float32 distance_remaining\n",
    "nav2_msgs/msg/NavigateToPoseResult": "float32 x\n",
    "nav2_msgs/msg/NavigateToPoseActionGoal": (
        "std_msgs/Header header\nactionlib_msgs/GoalID goal_id\nnav2_msgs/NavigateToPoseGoal goal\n"
    ),
    "nav2_msgs/msg/NavigateToPoseActionFeedback": (
        "std_msgs/Header header\nactionlib_msgs/GoalStatus status\nnav2_msgs/NavigateToPoseFeedback feedback\n"
    ),
    "nav2_msgs/msg/NavigateToPoseActionResult": (
        "std_msgs/Header header\nactionlib_msgs/GoalStatus status\nnav2_msgs/NavigateToPoseResult result\n"
    ),
}
ACCEPTED, EXECUTING, CANCELING, SUCCEEDED, CANCELED, ABORTED = range(1, 7)


def found(audit: Audit) -> list[tuple[str, str, str, list[float]]]:
    """Return the findings: kind, name, reason, and times in seconds."""
    return [
        (
            str(finding.kind),
            finding.name,
            finding.reason,
            [round(time / 1e9 - START, 6) for time in finding.times],
        )
        for finding in audit.findings
    ]


def door(time: float, word: str) -> Entry:
    return Entry(time, f"/{word}", "std_msgs/msg/Empty")


def call(time: float, number: int, *, answer: bool | None = None, kind: int | None = None) -> Entry:
    event = kind if kind is not None else (1 if answer is None else 2)
    fields: dict[str, Any] = {"info": {"event_type": event, "sequence_number": number}}
    fields |= {"request": [{"data": True}]} if answer is None else {"response": [{"success": answer}]}
    return Entry(time, "/beam/_service_event", "std_srvs/msg/SetBool_Event", fields)


def status(time: float, *goals: tuple[int, int], accepted: float = -START) -> Entry:
    nanoseconds = round((START + accepted) * 1000) * 1_000_000
    stamp = {"sec": nanoseconds // SECOND, "nanosec": nanoseconds % SECOND}
    entries = [
        {"goal_info": {"goal_id": {"uuid": [goal] * 16}, "stamp": stamp}, "status": state} for goal, state in goals
    ]
    return Entry(time, "/drive/_action/status", "action_msgs/msg/GoalStatusArray", {"status_list": entries})


def feedback(time: float, goal: int) -> Entry:
    kind = "nav2_msgs/msg/NavigateToPose_FeedbackMessage"
    return Entry(time, "/drive/_action/feedback", kind, {"goal_id": {"uuid": [goal] * 16}})


def audit_of(entries: Sequence[Entry], tmp_path: Path, **options: Any) -> Audit:
    return audited(graph_of(PORTER), write_mcap(tmp_path / "run", entries, store(2, ROS_2)), **options)


def test_a_permitted_run_of_services_and_actions_has_no_findings(tmp_path: Path) -> None:
    entries = [
        status(0.0),
        status(1.0, (7, ACCEPTED)),
        status(1.1, (7, EXECUTING)),
        feedback(1.2, 7),
        call(1.3, 1),
        call(1.31, 1, kind=0),  # client and server report the same call
        call(1.4, 1, answer=True),
        call(1.41, 1, answer=True, kind=3),
        door(1.5, "opened"),
        status(1.6, (7, CANCELING)),
        status(1.7, (7, CANCELED)),
        door(1.8, "closed"),
        status(2.0, (7, CANCELED), (8, ACCEPTED)),
        status(3.0, (7, CANCELED), (8, ABORTED)),
    ]
    audit = audit_of(entries, tmp_path)
    assert found(audit) == []
    assert audit.commands == 3
    assert set(audit.unseen) == {"/drive/_action/send_goal", "/drive/_action/get_result"}


def test_forbidden_calls_and_goals_are_found(tmp_path: Path) -> None:
    entries = [
        status(0.0),
        call(0.5, 1),  # while standing
        call(0.6, 1, answer=True),
        call(0.7, 9, answer=True),  # nobody called
        door(0.8, "opened"),
        status(1.0, (7, ACCEPTED)),  # while the door is open
        feedback(1.1, 7),
        status(1.2, (7, EXECUTING), (8, ACCEPTED)),  # beside another one
        status(1.3, (7, SUCCEEDED), (8, EXECUTING)),
        feedback(1.4, 8),
        call(1.42, 2),  # while it drives to the second one
        call(1.44, 2, answer=True),
        status(1.5, (7, SUCCEEDED), (8, SUCCEEDED)),
        feedback(1.6, 8),  # it has ended
    ]
    audit = audit_of(entries, tmp_path)
    assert found(audit) == [
        ("forbidden", "Lamp.beam", "requirement", [0.5]),
        ("unexpected", "Lamp.beam", "state", [0.7]),
        ("forbidden", "Base.drive", "requirement", [1.0, 1.2]),
        ("unexpected", "Base.drive", "state", [1.6]),
    ]
    assert audit.findings[1].because == ["Lamp.beam.idle"]


def test_a_goal_that_the_supervisor_would_cancel_is_found(tmp_path: Path) -> None:
    """A cancel is due when the door opens. The server has five seconds, the default time-out of actions."""
    start = [status(0.0), status(1.0, (7, EXECUTING)), door(2.0, "opened")]
    canceled = [*start, status(6.5, (7, CANCELING)), status(8.0, (7, CANCELED))]
    assert found(audit_of(canceled, tmp_path)) == []
    ended = [*start, status(6.5, (7, SUCCEEDED)), status(9.0, (7, SUCCEEDED))]
    assert found(audit_of(ended, tmp_path)) == []
    (finding,) = audit_of([*start, status(7.5, (7, SUCCEEDED))], tmp_path).findings
    assert (finding.event, finding.reason, finding.because) == (
        "action_drive.c_cancel",
        "cancel",
        ["requirement drive needs Door.closed"],
    )
    assert [time / 1e9 - START for time in finding.times] == [2.0]


def test_a_goal_from_before_the_recording_is_known(tmp_path: Path) -> None:
    entries = [status(0.0, (6, SUCCEEDED), (7, EXECUTING)), call(0.1, 1), call(0.2, 1, answer=True)]
    assert found(audit_of(entries, tmp_path)) == []


def test_feedback_before_the_first_status_begins_no_goal(tmp_path: Path) -> None:
    entries = [door(0.0, "opened"), feedback(0.1, 7), status(0.2, (7, EXECUTING)), status(3.0, (7, SUCCEEDED))]
    audit = audit_of(entries, tmp_path)
    assert (found(audit), audit.commands) == ([], 0)
    entries[2] = status(0.2, (7, EXECUTING), accepted=0.05)
    assert found(audit_of(entries, tmp_path)) == [("forbidden", "Base.drive", "requirement", [0.2])]


def test_the_first_status_may_have_a_goal_that_began_in_the_recording(tmp_path: Path) -> None:
    """A server publishes no status before its first goal."""
    entries = [door(0.0, "opened"), status(1.0, (7, ACCEPTED), accepted=0.99)]
    assert found(audit_of(entries, tmp_path)) == [("forbidden", "Base.drive", "requirement", [1.0])]
    entries[1] = status(1.0, (7, ACCEPTED), accepted=-0.01)
    assert found(audit_of(entries, tmp_path)) == []


def test_a_call_without_an_answer_fails_after_its_time(tmp_path: Path) -> None:
    """The default time-out of a service is five seconds."""
    start = [status(0.0, (7, EXECUTING)), call(0.1, 1)]
    assert found(audit_of([*start, call(6.0, 2), call(6.5, 1, answer=True), call(6.6, 2, answer=True)], tmp_path)) == []
    (second,) = found(audit_of([*start, call(4.0, 2)], tmp_path))
    assert second == ("forbidden", "Lamp.beam", "state", [4.0])


def test_an_action_of_ros_1_is_audited(tmp_path: Path) -> None:
    kind = "nav2_msgs/msg/NavigateToPoseAction"

    def goal(time: float, name: str) -> Entry:
        return Entry(time, "/drive/goal", f"{kind}Goal", {"goal_id": {"id": name}})

    def result(time: float, name: str, state: int) -> Entry:
        return Entry(time, "/drive/result", f"{kind}Result", {"status": {"goal_id": {"id": name}, "status": state}})

    entries = [
        goal(1.0, "a"),
        Entry(1.1, "/drive/feedback", f"{kind}Feedback", {"status": {"goal_id": {"id": "a"}}}),
        result(1.2, "a", 3),
        door(1.3, "opened"),
        goal(1.4, "b"),
        Entry(1.5, "/drive/cancel", "actionlib_msgs/msg/GoalID", {"id": "b"}),
        result(1.6, "b", 2),
        door(1.7, "closed"),
        goal(1.8, "c"),
        result(1.9, "c", 5),
    ]
    audit = audited(graph_of(PORTER), write_bag(tmp_path / "run", entries, store(1, ROS_1)))
    assert found(audit) == [("forbidden", "Base.drive", "requirement", [1.4])]
    assert audit.unseen == {"/beam": "bags of ROS 1 have no calls of services"}


#: A cart whose speed has a limit and a requirement, and an assumption on its arm.
CART = """robot Cart {
  component Person {
    outgoing message seen with identifier: "/seen", type: boolean
    behaviour {
      initial marked state far { on response from seen if value goto near }
      marked state near { on response from seen if !value goto far }
    }
  }
  component Base {
    incoming message velocity with identifier: "/velocity", type: geometry_msgs/Twist
    incoming message gear with identifier: "/gear", type: integer(0..3)
    outgoing message level with identifier: "/level", type: integer(0..9)
    behaviour {
      variable height: integer(0..9) = 0
      initial marked state base {
        on request to velocity
        on response from level do height := value
      }
    }
  }
  component Arm {
    incoming message down with identifier: "/down", type: none
    outgoing message done with identifier: "/done", type: none
    outgoing message points with identifier: "/points", type: geometry_msgs/Polygon
    behaviour {
      variable first: double
      on response from points do first := value.points[1].x
      initial marked state up { on request to down goto pressing }
      state pressing { on response from done goto up }
    }
  }
  limit velocity with { linear: { x: max(-1.0, min(value.linear.x, 1.0)) } }
  requirement velocity needs Person.far or value.linear.x <= 0.3
  requirement gear needs value < 2
  requirement down needs Base.height < 9
  assume A1: response from done needs Arm.pressing
}
"""


def seen(time: float, *, near: bool) -> Entry:
    return Entry(time, "/seen", "std_msgs/msg/Bool", {"data": near})


def velocity(time: float, speed: float) -> Entry:
    return Entry(time, "/velocity", "geometry_msgs/msg/Twist", {"linear": {"x": speed}})


def number(time: float, topic: str, value: int) -> Entry:
    return Entry(time, topic, "std_msgs/msg/Int16", {"data": value})


def test_data_limits_ranges_and_assumptions_are_audited(tmp_path: Path) -> None:
    corner = [{"x": 1.0}, {"x": 2.0}]
    entries = [
        velocity(0.0, 0.9),
        velocity(0.1, 1.5),  # beyond the limit
        velocity(0.2, 1.25),
        seen(0.3, near=True),
        velocity(0.4, 0.25),
        velocity(0.5, 0.5),  # too fast near a person
        velocity(0.6, float("nan")),
        seen(0.7, near=False),
        velocity(0.8, 0.5),
        number(0.9, "/gear", 1),
        number(1.0, "/gear", 2),  # forbidden
        number(1.1, "/gear", 7),  # no gear
        number(1.2, "/level", 4),
        number(1.3, "/level", 12),  # out of range
        number(1.35, "/level", 4),
        Entry(1.4, "/points", "geometry_msgs/msg/Polygon", {"points": corner}),
        Entry(1.5, "/points", "geometry_msgs/msg/Polygon", {"points": corner[:1]}),  # lacks what is read
        Entry(1.6, "/done", "std_msgs/msg/Empty"),  # against A1
        Entry(1.7, "/down", "std_msgs/msg/Empty"),
        Entry(1.8, "/down", "std_msgs/msg/Empty"),  # while pressing
        Entry(1.9, "/done", "std_msgs/msg/Empty"),
    ]
    audit = audited(graph_of(CART), write_sqlite(tmp_path / "run", entries))
    assert found(audit) == [
        ("forbidden", "Base.velocity", "limit", [0.1, 0.2]),
        ("forbidden", "Base.velocity", "requirement", [0.5]),
        ("forbidden", "Base.velocity", "data", [0.6]),
        ("forbidden", "Base.gear", "requirement", [1.0]),
        ("forbidden", "Base.gear", "data", [1.1]),
        ("unexpected", "Base.level", "range", [1.3]),
        ("unexpected", "Arm.points", "data", [1.5]),
        ("assumption", "Arm.done", "assumption", [1.6]),
        ("forbidden", "Arm.down", "state", [1.8]),
    ]
    by_name = {finding.reason: finding for finding in audit.findings}
    assert by_name["limit"].because == ["linear.x is 1.5, limited to 1.0"]
    assert by_name["range"].because == ["data is 12, expected 0 to 9"]
    assert by_name["assumption"].because == ["assume A1: response from done needs Arm.pressing"]
    assert by_name["state"].because == ["Arm.pressing"]


def test_a_tolerance_accepts_what_was_permitted_shortly_before_or_after(tmp_path: Path) -> None:
    fast = 0.5
    entries = [
        seen(0.0, near=True),
        velocity(1.0, fast),  # permitted 4 ms later
        seen(1.004, near=False),
        velocity(1.5, fast),
        seen(2.0, near=True),
        velocity(2.003, fast),  # permitted 3 ms before
        velocity(2.02, fast),
    ]
    path = write_mcap(tmp_path / "run", entries)
    strict = audited(graph_of(CART), path)
    assert [finding[3] for finding in found(strict)] == [[1.0], [2.003, 2.02]]
    assert strict.findings[0].since == 1_000_000_000
    assert strict.findings[1].since == 3_000_000
    tolerant = audited(graph_of(CART), path, tolerance=5_000_000)
    assert [finding[3] for finding in found(tolerant)] == [[2.02]]
    assert (strict.tolerated, tolerant.tolerated) == (0, 2)


def test_each_command_has_the_whole_tolerance(tmp_path: Path) -> None:
    fast = 0.5
    entries = [seen(0.0, near=True), velocity(1.0, fast), velocity(1.004, fast), seen(1.006, near=False)]
    audit = audited(graph_of(CART), write_mcap(tmp_path / "run", entries), tolerance=5_000_000)
    assert [finding[3] for finding in found(audit)] == [[1.0]]
    assert audit.tolerated == 1


def test_a_topic_may_be_heard_and_commanded(tmp_path: Path) -> None:
    robot = """robot Echo {
  component Door {
    outgoing message moved with identifier: "/door", type: none
    behaviour {
      initial marked state closed { on response from moved goto open }
      marked state open { }
    }
  }
  component Base {
    incoming message door with identifier: "/door", type: none
    incoming message drive with identifier: "/drive", type: none
  }
  requirement drive needs Door.closed
}
"""
    entries = [door(0.0, "drive"), door(1.0, "door"), door(2.0, "drive")]
    audit = audited(graph_of(robot), write_mcap(tmp_path / "run", entries))
    assert found(audit) == [("forbidden", "Base.drive", "requirement", [2.0])]
    assert (audit.commands, audit.events) == (3, 1)


def test_a_tolerance_does_not_hide_a_second_command(tmp_path: Path) -> None:
    """The controller knows its own commands: the state before the first does not permit the second."""
    down = [
        Entry(0.0, "/done", "std_msgs/msg/Empty"),
        *(Entry(time, "/down", "std_msgs/msg/Empty") for time in (1.0, 1.002)),
    ]
    audit = audited(graph_of(CART), write_mcap(tmp_path / "run", down), tolerance=5_000_000)
    assert ("forbidden", "Arm.down", "state", [1.002]) in found(audit)


def test_a_forbidden_command_happens_all_the_same(tmp_path: Path) -> None:
    """The robot drives after the goal: its lamp may beam."""
    entries = [
        door(0.1, "opened"),
        status(0.15),
        status(0.2, (7, EXECUTING)),
        call(0.3, 1),
        call(0.4, 1, answer=True),
    ]
    assert found(audit_of(entries, tmp_path)) == [("forbidden", "Base.drive", "requirement", [0.2])]


def test_an_event_against_an_assumption_happens_all_the_same(tmp_path: Path) -> None:
    """Somebody opens the door of a standing robot by hand: it is open, and the robot must not drive."""
    text = PORTER.replace("robot Porter", "robot Assuming").removesuffix("}\n")
    graph = graph_of(f"{text}  assume A1: response from Door.opened needs Base.driving\n}}\n")
    entries = [status(0.0), door(0.1, "opened"), status(0.2, (7, ACCEPTED))]
    audit = audited(graph, write_mcap(tmp_path / "run", entries, store(2, ROS_2)))
    assert found(audit) == [
        ("assumption", "Door.opened", "assumption", [0.1]),
        ("forbidden", "Base.drive", "requirement", [0.2]),
    ]


def test_the_start_may_be_another_state(tmp_path: Path) -> None:
    graph = graph_of(PORTER)
    place = next(plant for plant in graph.model.plants if plant.origin == "Door")
    entries = [status(0.0), status(0.1, (7, ACCEPTED))]
    (finding,) = audit_of(entries, tmp_path, state={place: "open"}).findings
    assert finding.unheard == ["Base"]
    assert audit_of(entries, tmp_path).findings == []
    (unheard,) = audit_of([status(0.0), call(0.1, 1)], tmp_path).findings
    assert unheard.unheard == ["Base"]


def test_topics_of_another_type_or_name_are_reported(tmp_path: Path) -> None:
    graph = graph_of(CART)
    entries = [
        number(0.0, "/seen", 1),
        Entry(0.1, "/base/velocity", "geometry_msgs/msg/Twist", {"linear": {"x": 5.0}}),
    ]
    path = write_mcap(tmp_path / "run", entries)
    unseen = audited(graph, path).unseen
    assert unseen["/seen"] == "it has the type std_msgs/msg/Int16, the model expects std_msgs/msg/Bool"
    assert "no message" in unseen["/velocity"]
    audit = audited(graph, path, remappings={"/velocity": "/base/velocity"})
    assert found(audit) == [("forbidden", "Base.velocity", "limit", [0.1])]


@pytest.mark.parametrize("speed", [0.2, 0.15])
def test_commands_that_share_a_topic_are_told_by_their_data(speed: float, tmp_path: Path) -> None:
    graph = graph_of(
        """robot Two {
  component Guard {
    outgoing message stop with identifier: "/stop", type: none
    behaviour { initial marked state free { on response from stop goto blocked } marked state blocked { } }
  }
  component Base {
    incoming message move with identifier: "/speed", type: double
    incoming message halt with identifier: "/speed", type: double
  }
  requirement move needs Guard.free
  provide move with 0.2
}
"""
    )
    assert isinstance(graph, rosgraph.RosGraph)
    entries = [
        Entry(0.0, "/speed", "std_msgs/msg/Float32", {"data": speed}),
        Entry(0.1, "/stop", "std_msgs/msg/Empty"),
        Entry(0.2, "/speed", "std_msgs/msg/Float32", {"data": 0.0}),
        Entry(0.3, "/speed", "std_msgs/msg/Float32", {"data": speed}),
    ]
    audit = audited(graph, write_mcap(tmp_path / "run", entries))
    forbidden = ("forbidden", "Base.move", "requirement", [0.3])
    if speed == 0.2:
        assert found(audit) == [forbidden]
    else:  # a message that the model does not have
        assert found(audit) == [
            ("unexpected", "Base.move", "state", [0.0, 0.3]),
            forbidden,
        ]


def test_safe_messages_of_the_configuration_are_no_findings(tmp_path: Path) -> None:
    """A layer sends a message of `onBlocked` itself. With other data, the message is a command like any other."""
    entries = [
        seen(0.0, near=True),
        velocity(0.1, 0.9),
        velocity(0.2, 0.0),
    ]
    path = write_mcap(tmp_path / "run", entries)
    graph = graph_of(CART.replace("Person.far or value.linear.x <= 0.3", "Person.far").replace("Cart", "Wagon"))
    assert found(audited(graph, path)) == [("forbidden", "Base.velocity", "requirement", [0.1, 0.2])]
    audit = audited(graph, path, Configuration(on_blocked=["velocity"]))
    assert found(audit) == [("forbidden", "Base.velocity", "requirement", [0.1])]
    assert audit.safe == 1


def test_a_jump_in_time_does_not_hold_up_the_audit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(judge, "_MOST_EXPIRIES", 500)
    text = """robot Clock {
  component Tick {
    incoming message tick with identifier: "/tick", type: none
    behaviour { initial marked state on { after 1 ms goto on } }
  }
}
"""
    entries = [Entry(time, "/tick", "std_msgs/msg/Empty") for time in (0.0, 86_400.0)]
    audit = audited(graph_of(text), write_mcap(tmp_path / "run", entries))
    assert (audit.commands, audit.findings) == (2, [])
    assert audit.notes == ["timers expire more than 500 times between two messages: some are left out"]
