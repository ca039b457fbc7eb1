"""The claims of the example pages hold in every reachable state, and in runs of the control loop."""

from collections.abc import Iterator
from itertools import product

import pytest

from robosc.engine import ControlLoop, Engine, Hooks
from robosc.engine.state import State
from robosc.model import expression as ex
from robosc.model.semantics.roles import event_name

from .conftest import MODELS, SHOWCASES, models_of

SMALL = [name for name in MODELS if name not in SHOWCASES]
EACH = pytest.mark.parametrize("name", SMALL)
STOP = "component_EmergencyStop"
STOPPABLE = pytest.mark.parametrize("name", [model for model in SMALL if model != "line_stepper"])
#: Plant and locations in which another node drives the wheels.
TURNING = {
    "maze_solver": ("component_Platform", {"turning_left", "turning_right"}),
    "object_finder": ("component_Rotator", {"turning"}),
}
HALTING = pytest.mark.parametrize(
    "name", ["line_follower", "maze_solver", "object_finder", "person_follower", "push_ball"]
)


def states(engine: Engine) -> Iterator[State]:
    """Yield every state that is reachable under the supervisor, for any inputs. The engine is in the yielded state."""
    data = {event_name(event): [*inputs(event)] for event in engine.roles.events}
    found, pending = {engine.state}, [engine.state]
    while pending:
        state = pending.pop()
        engine.state = state
        yield state
        for event, choices in data.items():
            for chosen in choices:
                engine.state = state
                if engine.perform(event, chosen) and engine.state not in found:
                    found.add(engine.state)
                    pending.append(engine.state)


def inputs(event) -> Iterator[dict]:
    values = [[(input_.name, value) for value in values_of(input_.type)] for input_ in event.inputs]
    return map(dict, product(*values))


def values_of(kind: ex.Type) -> list:
    match kind:
        case ex.EnumerationType():
            return [literal.name for literal in kind.enumeration.literals]
        case ex.IntegerType():
            return [*range(kind.minimum, kind.maximum + 1)]
    return [False, True]


@STOPPABLE
def test_nothing_moves_while_the_button_is_pressed(name: str) -> None:
    engine = Engine(models_of(name).sct)
    moving = [
        event_name(trigger) for trigger in engine.roles.triggers if event_name(trigger) != "message_halt.c_trigger"
    ]
    seen = [
        [event for event in moving if engine.enabled(event)] for state in states(engine) if state[STOP] == "stopped"
    ]
    assert moving
    assert seen
    assert not any(seen)


@EACH
def test_one_topic_has_one_command(name: str) -> None:
    engine = Engine(models_of(name).sct)
    groups = [[event_name(event) for event in topic] for topic in engine.roles.shared_topics]
    for state in states(engine):
        for group in groups:
            assert sum(map(engine.enabled, group)) <= 1, state


@HALTING
def test_somebody_always_commands_the_wheels(name: str) -> None:
    engine = Engine(models_of(name).sct)
    plant, turning = TURNING.get(name, ("", set()))
    for state in states(engine):
        if plant and state[plant] in turning and state[STOP] != "stopped":
            continue
        assert engine.enabled("message_move.c_trigger") or engine.enabled("message_halt.c_trigger"), state


@pytest.mark.parametrize("name", ["simple_navigation", "obstacle_navigation"])
def test_the_button_cancels_the_journey(name: str) -> None:
    engine = Engine(models_of(name).sct)
    under_way = [
        engine.enabled("action_navigate.c_cancel")
        for state in states(engine)
        if state[STOP] == "stopped" and state["action_navigate"] == "executing"
    ]
    assert under_way
    assert all(under_way)


class Robot(ControlLoop):
    """A control loop that records its commands by short names: `move` for `message_move.c_trigger`.

    The robot is in service from the start.
    """

    def __init__(self, name: str) -> None:
        self.sent: list[str] = []
        super().__init__(models_of(name).sct, hooks=Hooks(after=self.note))
        self.inputs = {event_name(event): [data.name for data in event.inputs] for event in self.engine.roles.events}
        self.tick()
        self.hears(pressed=False)
        self.hears(**{"continue": None})

    def note(self, event: str) -> None:
        kind, _, name = event.partition("_")
        if kind in {"message", "action"} and ".c_" in name:
            self.sent.append(name.removesuffix(".c_trigger"))

    def hears(self, **messages) -> list[str]:
        """Return the commands after one batch of messages; each message has a value or None."""
        self.begin()
        for name, value in messages.items():
            event = f"message_{name}.u_response"
            assert self.perform(event, dict(zip(self.inputs[event], [value], strict=False)))
        self.end()
        return self.said()

    def happens(self, event: str, data: dict[str, int] | None = None) -> list[str]:
        """Return the commands after an event of a service or action."""
        self.begin()
        assert self.perform(event, data or {})
        self.end()
        return self.said()

    def ticks(self) -> list[str]:
        self.tick()
        return self.said()

    def said(self) -> list[str]:
        said, self.sent[:] = list(self.sent), []
        return said


def scan(front: str, right: str, back_right: str) -> dict[str, str]:
    return {"scan_front": front, "scan_right": right, "scan_back_right": back_right}


def test_the_maze_solver_turns_once_and_looks_first() -> None:
    robot = Robot("maze_solver")
    assert robot.ticks() == ["halt"]
    along, corner = (
        scan("way_ahead", "wall_right", "wall_back_right"),
        scan("way_ahead", "no_wall_right", "wall_back_right"),
    )
    assert robot.hears(**along) == ["move"]
    assert robot.hears(**corner) == ["halt"]
    assert "rotate_right" in robot.ticks()
    # While the robot turns, and until the next scan after that, the old view does not count.
    assert robot.hears(**corner) == []
    assert robot.ticks() == []
    assert robot.hears(rotate_done=None) == ["halt"]
    assert robot.ticks() == ["halt"]
    assert robot.hears(**along) == ["move"]


def test_the_maze_solver_comes_free_of_a_turn_that_is_never_reported() -> None:
    robot = Robot("maze_solver")
    assert "rotate_left" in robot.hears(**scan("wall_ahead", "wall_right", "wall_back_right"))
    assert robot.hears(pressed=True) == ["halt"]
    assert robot.hears(**{"continue": None}) == [], "it is still pressed"
    assert robot.hears(pressed=False) == []
    assert robot.hears(**{"continue": None}) == []
    assert robot.ticks() == ["halt"]
    assert robot.hears(**scan("way_ahead", "wall_right", "wall_back_right")) == ["move"]


def test_the_maze_solver_rounds_a_corner_once() -> None:
    robot = Robot("maze_solver")
    around = scan("way_ahead", "no_wall_right", "wall_back_right")
    assert "rotate_right" in robot.hears(**around) + robot.ticks()
    robot.hears(rotate_done=None)
    # The wall behind the right side is now another one.
    assert robot.hears(**around) == ["move"]
    assert robot.ticks() == ["move"]
    # The robot turns again after it has seen the wall beyond the corner and that wall ends.
    assert robot.hears(**scan("way_ahead", "wall_right", "wall_back_right")) == []
    assert robot.hears(**around) == ["halt"]
    assert "rotate_right" in robot.ticks()


def test_the_object_finder_leaves_a_dead_end_and_stops_at_the_sign() -> None:
    robot = Robot("object_finder")
    dead_end = {"scan_front": "front_blocked", "scan_left": "left_blocked", "scan_right": "right_blocked"}
    for _ in range(2):
        assert "rotate_left" in robot.hears(**dead_end) + robot.ticks()
        robot.hears(rotate_done=None)
    assert robot.hears(**dead_end | {"scan_front": "front_clear"}) == ["move"]
    robot.hears(object_count=1)
    assert robot.hears(objects="stop_sign") == ["halt"]
    assert robot.ticks() == ["halt"]


def test_a_new_point_ends_the_way_to_the_old_one() -> None:
    robot = Robot("simple_navigation")
    assert robot.hears(clicked_point=None) == []
    robot.hears(initial_pose=None)
    assert robot.hears(clicked_point=None) == ["navigate"]
    assert robot.hears(clicked_point=None)[0] == "navigate.c_cancel"
    assert robot.ticks() == [], "the goal has not ended"
    assert robot.happens("action_navigate.u_canceled") == ["navigate"]


def test_releasing_the_button_sets_nobody_off() -> None:
    robot = Robot("simple_navigation")
    robot.hears(initial_pose=None)
    robot.hears(clicked_point=None)
    assert robot.hears(pressed=True) == ["navigate.c_cancel"]
    robot.hears(clicked_point=None)
    assert robot.hears(pressed=False) + robot.ticks() == []
    assert robot.hears(**{"continue": None}) + robot.ticks() == []


def test_too_many_recoveries_end_the_journey_but_not_the_next() -> None:
    robot = Robot("obstacle_navigation")
    robot.hears(initial_pose=None)
    robot.hears(clicked_point=None)
    for number in range(1, 7):
        recoveries = {"i_feedback_number_of_recoveries": number}
        cancels = ["navigate.c_cancel"] if number == 6 else []
        assert robot.happens("action_navigate.u_feedback", recoveries) == cancels
    assert robot.happens("action_navigate.u_canceled") + robot.ticks() == []
    assert robot.hears(clicked_point=None) + robot.ticks() == ["navigate"]


def test_the_ball_pusher_is_told_when_its_velocities_change() -> None:
    robot = Robot("push_ball")
    assert robot.ticks() == ["halt"]
    assert robot.hears(no_ball=None) == [], "the lidar says nothing yet"
    assert robot.hears(scan="obstructed") == ["move"]
    assert robot.hears(ball_correction=None) == ["halt"]
    assert robot.hears(scan="free") == ["move"]
    assert robot.hears(ball_front_check=None) == ["move"]
    assert robot.hears(goal_correction=None) == ["move"]
    assert robot.hears(scan="obstructed") == ["halt"]


def test_the_person_follower_turns_but_does_not_drive_to_who_is_near() -> None:
    robot = Robot("person_follower")
    assert robot.ticks() == ["halt"]
    assert robot.hears(scan="near") == []
    assert robot.hears(who="person", place=None) == ["move"]
    assert robot.state["data_move"] == "d2"
    assert robot.hears(scan="far") == ["move"]
    assert robot.state["data_move"] == "d1"
    assert robot.hears(who="nobody", place=None) == ["halt"]
