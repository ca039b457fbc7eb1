"""The models of the pattern pages have no findings, behave as documented, and appear on their pages unchanged."""

import json
import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from robosc.tools.cli import main
from tests.searching import less_effort

DOCS = Path(__file__).parent.parent / "docs"
PAGES = (DOCS / "patterns.md", DOCS / "patterns-tasks.md")
PATTERNS = DOCS / "patterns"
NAMES = sorted(path.stem for path in PATTERNS.glob("*.rscd"))
EACH = pytest.mark.parametrize("name", NAMES)
PASSED, REFUSED = ' {"value": {"success": true}}', ' {"value": {"success": false}}'


def play(name: str, *lines: str) -> list[list[str]]:
    """Return the commands of the controller after each line of a script and the tick after it, without repetitions."""
    script = "\n".join(f"{line}\ntick" for line in lines)
    done = CliRunner().invoke(main, ["simulate", str(PATTERNS / f"{name}.rscd"), "--loop", "--script", "-"], script)
    assert done.exit_code == 0, done.stderr
    answers = [json.loads(line) for line in done.stdout.splitlines()]
    assert [answer["by"] for answer in answers] == [None] * 2 * len(lines)
    pairs = zip(answers[::2], answers[1::2], strict=True)
    happened = [" ".join(line["happened"] + tick["happened"]) for line, tick in pairs]
    sent = [re.findall(r"(?:message|service|action)_(\w+)\.c_(trigger|cancel)", text) for text in happened]
    return [[*dict.fromkeys(name if way == "trigger" else f"cancel {name}" for name, way in names)] for names in sent]


def heard(name: str, value: object = None) -> str:
    return f"message_{name}.u_response" + ("" if value is None else " " + json.dumps({"value": value}))


def answered(name: str, result: str = "") -> str:
    return f"service_{name}.u_response{result}"


@EACH
@pytest.mark.parametrize("command", ["check", "synthesize", pytest.param("verify", marks=pytest.mark.slow)])
def test_nothing_is_said_of_it(name: str, command: str) -> None:
    with less_effort():
        done = CliRunner().invoke(main, [command, str(PATTERNS / f"{name}.rscd")])
    assert (done.exit_code, done.stderr) == (0, ""), done.output


def test_the_pages_show_each_model() -> None:
    text = "".join(page.read_text(encoding="utf-8") for page in PAGES)
    shown = re.findall(r"^```robosc\n(.*?)^```$", text, flags=re.MULTILINE | re.DOTALL)
    assert sorted(shown) == sorted((PATTERNS / f"{name}.rscd").read_text(encoding="utf-8") for name in NAMES)
    assert len(NAMES) == 15


def test_the_spindle_turns_behind_the_closed_guard() -> None:
    lines = ("tick", heard("closed", True), heard("closed", True), heard("closed", False))
    assert play("interlock", *lines) == [["brake"], ["spin"], ["spin"], ["brake"]]


def test_one_arm_is_in_the_zone() -> None:
    sent = play("mutual_exclusion", "tick", "service_Left_enter.u_error", answered("Left_leave"), "tick")
    assert sent[0] == ["Left_enter"], "an arm that enters does not leave before it is in"
    assert sent[1] == ["Left_leave"], "after an error it may be in the zone"
    assert "Right_enter" in sent[2] + sent[3]


def test_the_part_is_held_by_one_hand_at_least() -> None:
    steps = ("grip", "take", "release", "put")
    assert play("hand_over", "tick", *map(answered, steps)) == [["grip"], ["take"], ["release"], ["put"], ["grip"]]
    assert play("hand_over", "tick", "service_grip.u_error")[1] == ["grip"]


def test_the_lift_rises_when_the_goal_of_the_base_has_ended() -> None:
    coming, going = heard("present", True), heard("present", False)
    sent = play("stop_then_act", "tick", coming, "tick", "action_patrol.u_canceled", answered("raise"), going)
    assert sent == [["patrol"], ["cancel patrol"], [], ["raise"], [], ["lower"]]
    assert play("stop_then_act", "tick", coming, "action_patrol.u_error")[2] == ["raise"]


def test_a_new_point_replaces_the_old_goal() -> None:
    point = heard("point", {"pose": {"position": {"x": 1.0}}})
    lines = (point, point, "tick", point, "action_go.u_canceled", "tick", "action_go.u_response")
    assert play("replace_goal", *lines) == [["go"], ["cancel go"], [], [], ["go"], [], []]


def test_docking_is_tried_three_times_with_pauses() -> None:
    refused = answered("dock", REFUSED)
    lines = ("tick", refused, "wait 1.9", "wait 0.1", "service_dock.u_error", "wait 2", refused, "wait 60")
    assert play("retry", *lines) == [["dock"], [], [], ["dock"], [], ["dock"], [], []]
    assert play("retry", *lines, heard("again"), answered("dock", PASSED), "wait 60")[8:] == [["dock"], [], []]


def test_a_silent_lidar_halts_the_robot() -> None:
    lines = ("tick", heard("scan"), "wait 0.4", heard("scan"), "wait 0.4", "wait 0.1", heard("scan"))
    assert play("lost_sensor", *lines) == [["halt"], *[["move"]] * 4, ["halt"], ["move"]]


def test_the_switch_says_who_drives() -> None:
    lines = ("tick", heard("Planner_wish"), heard("automatic", True), heard("Stick_wish"), heard("automatic", False))
    assert play("modes", *lines, "wait 0.5") == [["halt"], ["halt"], ["drive"], ["drive"], ["drive"], ["halt"]]


def test_two_hands_close_the_press_within_half_a_second() -> None:
    left, right = heard("left", True), heard("right", True)
    assert play("two_hands", left, "wait 0.4", right, heard("left", False), left)[2:] == [["close"], ["open"], ["open"]]
    off = (heard("left", False), heard("right", False))
    assert play("two_hands", left, "wait 0.5", right, *off, right, left)[2:] == [*[["open"]] * 4, ["close"]]


def test_a_contact_that_bounces_is_not_closed() -> None:
    shut, open_ = heard("closed", True), heard("closed", False)
    lines = ("tick", shut, "wait 0.04", open_, shut, "wait 0.04", "wait 0.01", open_, "wait 0.01", shut, "wait 1")
    assert play("debounce", *lines) == [*[["rest"]] * 6, *[["run"]] * 5]


def test_after_three_portions_the_hopper_is_filled() -> None:
    lines = (*[heard("order")] * 4, *[answered("dispense")] * 3, heard("filled"))
    assert play("limit", *lines) == [["dispense"], [], [], [], ["dispense"], ["dispense"], [], ["dispense"]]


def test_a_route_is_driven_to_its_end() -> None:
    poses = [{"pose": {"position": {"x": float(x)}}} for x in range(2)]
    route, arrived = heard("route", {"poses": poses}), heard("arrived")
    assert play("route", "tick", route, arrived, arrived, route) == [[], ["go"], ["go"], [], ["go"]]


def test_the_button_comes_before_the_joystick_and_that_before_the_planner() -> None:
    released, pressed, again = heard("pressed", False), heard("pressed", True), heard("continue")
    wishes = (released, again, heard("Planner_wish"), heard("Stick_wish"))
    sent = play("priority", *wishes, pressed, released, again)
    assert sent == [["halt"], ["halt"], ["follow"], ["obey"], ["halt"], ["halt"], ["obey"]]
    lines = (*wishes, "wait 0.4", released, heard("Planner_wish"), "wait 0.1")
    assert play("priority", *lines)[4:] == [["obey"], ["obey"], ["obey"], ["follow"]]
    assert play("priority", *wishes, "wait 0.4", heard("Stick_wish"), "wait 0.1")[-1] == ["halt"]


def test_nothing_moves_before_the_test_has_passed() -> None:
    begin = ("tick", heard("scan"))
    lines = (*begin, answered("test", PASSED), answered("enable"))
    assert play("start_up", *lines) == [["test"], [], ["enable"], ["move"]]
    assert play("start_up", *begin, answered("test", REFUSED), "wait 60", heard("start"))[2:] == [[], [], ["test"]]
    assert play("start_up", "tick", answered("test", PASSED), heard("scan"))[1:] == [[], ["enable"]]
    assert play("start_up", "tick", "wait 10", heard("start"), answered("test"))[1:] == [[], [], ["test"]]


def test_the_courier_sounds_its_horn_three_times() -> None:
    wide, narrow = heard("gap", 1.5), heard("gap", 0.3)
    lines = (heard("open"), wide, narrow, "wait 2", "wait 2", "wait 2", "wait 2", wide)
    warned = [["horn", "stay"]] * 3
    assert play("courier", *lines) == [["stay"], ["go"], ["stay"], *warned, ["stay"], []]


def test_the_courier_stops_for_a_call_on_its_way_to_desk_1() -> None:
    wide = heard("gap", 1.5)
    lines = (heard("open"), wide, heard("call"), heard("arrived", 2), wide, heard("call"), wide)
    assert play("courier", *lines) == [["stay"], *[["go"]] * 4, ["stay", "go"], ["go"]]
