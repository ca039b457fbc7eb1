"""The page in a real browser shows the state of the engine, step by step."""

from __future__ import annotations

import json
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, Any
from urllib.error import HTTPError
from urllib.request import urlopen

import pytest

import robosc
from robosc.analysis.wording import words
from robosc.model.semantics.roles import Roles, event_name
from robosc.run.simulation import Simulation
from robosc.run.simulation.session import trace_line
from robosc.run.simulation.simulation import whole_state
from robosc.tools.view import export
from robosc.tools.view.description import automata_of, commands_of
from tests.analysis.test_causes import TURNS
from tests.chromium import opened, shown

from .robots import EVIL, record

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.run.simulation.simulation import RequestResult

pytestmark = pytest.mark.build

ROOT = Path(__file__).parents[3]
MODEL = ROOT / "examples" / "line_follower" / "line_follower.rscd"
AXE = ROOT / "web" / "node_modules" / "axe-core" / "axe.min.js"


@contextmanager
def served(*arguments: str | Path) -> Iterator[str]:
    """Yield the address at which `robosc view` serves its page."""
    command = [sys.executable, "-m", "robosc", "view", *map(str, arguments)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        try:
            assert server.stdout is not None
            address = server.stdout.readline().strip()
            assert address.startswith("http://127.0.0.")
            yield address
        finally:
            server.terminate()
    assert server.returncode in (0, -15, 130)


def at(page: Any, moment: int) -> None:
    """Wait until the page shows a moment."""
    page.wait_for_selector(f'body[data-moment="{moment}"]')


def truth(simulation: Simulation, offset: float | None = None) -> dict[str, Any]:
    """Return the expected content of the page for the present state of a run and the line follower's number."""
    engine, model = simulation.engine, simulation.engine.model
    state = whole_state(engine)
    automata = automata_of(model)
    commands = []
    for event in commands_of(model):
        by = engine.blocked_by(event_name(event))
        reason = "" if by is None else simulation.reason(event_name(event), by).removeprefix("forbidden ")
        kind = "allowed" if by is None else "unready" if by == "plant" else "forbidden"
        commands.append([event_name(event), kind, reason])
    return {
        "states": [[plant.origin or plant.name, state[plant.name], [state[plant.name]]] for plant in automata],
        "variables": {
            (key := f"{plant.origin or plant.name}.{variable.name}"): str(state[key])
            .replace("True", "true")
            .replace("False", "false")
            for plant in automata
            for variable in plant.variables
        }
        | ({} if offset is None else {"LineDetector.offset": f"{offset:g}"}),
        "commands": commands,
    }


def simulation_of(path: Path) -> Simulation:
    robot = robosc.load(path)
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    return Simulation(model, robosc.to_rosgraph(robot))


def click(page: Any, event: str, data: Any = None) -> None:
    """Perform an event with data, as a user does."""
    if isinstance(data, float):
        page.locator(f'.performer:has(button[data-event="{event}"]) input').fill(str(data))
    elif data is not None:
        data = str(data).lower() if isinstance(data, bool) else data
        page.locator(f'.performer:has(button[data-event="{event}"]) select').select_option(label=data)
    page.click(f'button[data-event="{event}"]')


CORRECTION = "message_correction.u_response"


def with_offset(random: Random, event: str, data: dict[str, Any], offset: float) -> tuple[dict[str, Any], float]:
    """Return the data of the line follower's event, random for a correction, and the offset after it."""
    if event != CORRECTION:
        return data, offset
    offset = random.randrange(-80, 80) / 8
    return {"value": offset}, offset


def driven(random: Random, length: int) -> list[tuple[RequestResult, float]]:
    """Return random events of a line follower, each with the offset after it."""
    simulation, offset, happened = simulation_of(MODEL), 0.0, []
    for _ in range(length):
        event, data = simulation.random_event(random) or ("", {})
        data, offset = with_offset(random, event, data, offset)
        happened.append((simulation.perform(event, data), offset))
    return happened


def test_a_simulation_by_hand(chromium: Any) -> None:
    simulation, random, offsets = simulation_of(MODEL), Random(4), [0.0]
    said = {event_name(event): words(event).replace("`", "") for event in Roles(simulation.engine.model).events}
    with served(MODEL) as address, opened(chromium, address) as page:
        assert shown(page) == truth(simulation, 0)
        for number in range(1, 26):
            event, data = simulation.random_event(random) or ("", {})
            data, offset = with_offset(random, event, data, offsets[-1])
            offsets.append(offset)
            simulation.perform(event, data)
            click(page, event, data.get("value"))
            at(page, number)
            assert shown(page) == truth(simulation, offset)
            last = page.locator("#happened [aria-current]").text_content()
            assert last.startswith(said[event])
        assert len(set(offsets)) > 2
        for number in range(24, 19, -1):
            page.get_by_role("button", name="Undo").click()
            at(page, number)
            simulation.undo()
            assert shown(page) == truth(simulation, offsets[number])


def test_a_log_moment_by_moment_and_on_from_there(chromium: Any, tmp_path: Path) -> None:
    random = Random(5)
    happened = driven(random, 150)
    log = tmp_path / "log.jsonl"
    log.write_text("".join(trace_line(entry) + "\n" for entry, _ in happened))

    def after(number: int) -> tuple[Simulation, float]:
        past = simulation_of(MODEL)
        for entry, _ in happened[:number]:
            past.perform(entry.event, entry.data)
        return past, happened[number - 1][1] if number else 0

    with served(MODEL, "--log", log) as address, opened(chromium, address) as page:
        at(page, 150)
        assert shown(page) == truth(*after(150))
        for moment in (149, 64, 63, 0, 1, 127, 128, 77):
            page.locator("#moment").fill(str(moment))
            at(page, moment)
            assert shown(page) == truth(*after(moment))
        page.get_by_role("button", name="Go on from here").click()
        page.wait_for_selector('#moment[max="77"]')
        past, offset = after(77)
        event, data = past.random_event(random) or ("", {})
        data, offset = with_offset(random, event, data, offset)
        past.perform(event, data)
        click(page, event, data.get("value"))
        at(page, 78)
        assert shown(page) == truth(past, offset)


def test_why_a_command_is_forbidden(chromium: Any) -> None:
    with served(MODEL) as address, opened(chromium, address) as page:
        command = page.locator('#commands > li[data-event="message_move.c_trigger"]')
        command.get_by_role("button", name="What would help?").click()
        command.get_by_text("The shortest way there:").wait_for()
        assert "LineDetector.correction" in command.text_content()
        # The requirement's text is one click away.
        command.get_by_role("button", name="requirement").click()
        assert page.locator(".line.here").text_content().startswith("  requirement move needs")


def test_two_viewers_see_what_one_does_and_one_that_comes_late_too(chromium: Any) -> None:
    with served(MODEL) as address, opened(chromium, address) as first, opened(chromium, address) as second:
        first.get_by_role("button", name="20 random").click()
        for page in (first, second):
            at(page, 20)
        second.get_by_role("button", name="Undo").click()
        with opened(chromium, address) as late:
            for page in (first, second, late):
                at(page, 19)
            assert shown(first) == shown(second) == shown(late)


def test_an_exported_page_opens_without_a_server(chromium: Any, tmp_path: Path) -> None:
    happened, simulation = driven(Random(6), 30), simulation_of(MODEL)
    for entry, _ in happened:
        simulation.perform(entry.event, entry.data)
    (tmp_path / "log.jsonl").write_text("".join(trace_line(entry) + "\n" for entry, _ in happened))
    command = [
        sys.executable,
        "-m",
        "robosc",
        "view",
        MODEL,
        "--log",
        tmp_path / "log.jsonl",
        "--export",
        tmp_path / "out",
    ]
    subprocess.run(command, check=True, capture_output=True)
    address = (tmp_path / "out" / "index.html").as_uri()
    with opened(chromium, address) as page:
        at(page, 30)
        assert shown(page) == truth(simulation, happened[-1][1])
        page.locator("#moment").fill("0")
        at(page, 0)
        assert shown(page) == truth(simulation_of(MODEL), 0)


#: Keys with which the page looks other things up.
KEYS = ("kind", "direction", "event", "key", "owner")


def hostile(value: Any) -> Any:
    """Replace every text of a description by markup."""
    match value:
        case dict():
            return {name: hostile(part) if name not in KEYS else part for name, part in value.items()}
        case list():
            return [hostile(part) for part in value]
        case str():
            return f"{value}{EVIL}"
    return value


def test_names_are_text_whatever_they_say(chromium: Any, tmp_path: Path) -> None:
    description, shown_record, _ = record()
    shown_record.do({"action": "random", "number": 20})
    events = description["events"]
    told = hostile(json.loads(json.dumps(description))) | {"commands": description["commands"]}
    assert set(told["events"]) == set(events)  # type: ignore[call-overload]
    moments = [moment | {"words": EVIL, "reason": EVIL, "data": {"value": EVIL}} for moment in shown_record.moments]
    for name, text in export(told, moments).items():
        (tmp_path / name).write_text(text)
    with opened(chromium, (tmp_path / "index.html").as_uri()) as page:
        at(page, 20)
        assert page.evaluate("globalThis.hacked === undefined && document.querySelectorAll('img').length === 0")
        assert page.locator("h1").text_content() == f"Gate{EVIL}"
        assert EVIL in page.locator("#requirements").text_content()
        assert EVIL in page.locator("#happened").text_content()


def test_consequences_stand_below_their_cause(chromium: Any, tmp_path: Path) -> None:
    path = tmp_path / "drill.rscd"
    path.write_text(TURNS, encoding="utf-8")
    with served(path) as address, opened(chromium, address) as page:
        cause, *others = page.locator("#findings li").all()
        assert cause.text_content().startswith("Spindle.lower can never be sent: ")
        assert "robosc explain --why-never Spindle.lower" in cause.text_content()
        assert len(others) == 5
        assert [item.get_attribute("class") for item in [cause, *others]] == ["", *["follows"] * 5]


def test_one_of_several_robots_is_chosen(chromium: Any) -> None:
    other = ROOT / "examples" / "simple_navigation" / "simple_navigation.rscd"
    with served(MODEL, other) as address, opened(chromium, address) as page:
        assert page.locator("#robot-name").text_content() == "LineFollower"
        click(page, "message_pressed.u_response", False)
        at(page, 1)
        page.locator("#robots-choice").select_option("SimpleNavigation")
        page.wait_for_url("**/?robot=1")
        page.wait_for_selector('body[data-drawn][data-moment="0"]')
        expected = truth(simulation_of(other))
        expected["variables"] |= {"Navigation.frame": "map"} | {f"Navigation.{axis}": "0" for axis in "xyz"}
        assert shown(page) == expected
        page.locator("#robots-choice").select_option("LineFollower")
        page.wait_for_url("**/?robot=0")
        at(page, 1)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_it_is_accessible(chromium: Any, scheme: str) -> None:
    if not AXE.exists():
        pytest.skip("axe-core is not there: `npm ci --prefix web` brings it")
    with served(MODEL) as address, opened(chromium, address, color_scheme=scheme, bypass_csp=True) as page:
        page.get_by_role("button", name="20 random").click()
        at(page, 20)
        page.add_script_tag(path=str(AXE))
        told = page.evaluate("axe.run()")
        assert [
            (violation["id"], [node["html"] for node in violation["nodes"]]) for violation in told["violations"]
        ] == []
        # The accessible names contain the states and mark the present one.
        assert page.locator("#cards").get_by_role("button", name="searching").count() == 1
        assert page.get_by_role("button", name="the present state").count() == 3


def tab_to(page: Any, selector: str) -> None:
    """Move the focus to an element with the Tab key."""
    for _ in range(200):
        page.keyboard.press("Tab")
        if page.evaluate("(selector) => document.activeElement.matches(selector)", selector):
            return
    pytest.fail(f"no Tab leads to {selector}")


def test_by_keyboard_alone(chromium: Any) -> None:
    """Visit each part of the page in turn, without a mouse and without programmatic focus."""
    with served(MODEL) as address, opened(chromium, address) as page:
        tab_to(page, "#search")
        page.keyboard.type("blocked")
        assert page.locator(".card:visible .name").all_text_contents() == ["Lidar"]
        for _ in "blocked":
            page.keyboard.press("Backspace")
        tab_to(page, "#fold")
        page.keyboard.press("Enter")
        assert page.locator(".card[open]").count() == 0
        tab_to(page, ".card:first-child summary")
        page.keyboard.press("Enter")
        assert page.locator(".card[open] .name").all_text_contents() == ["LineDetector"]
        tab_to(page, '.card svg [role="button"][aria-label^="searching"]')
        page.keyboard.press("Enter")
        assert "state searching" in page.locator(".line.here").first.text_content()
        page.keyboard.press("Shift+Tab")
        tab_to(page, 'svg > .transition[aria-label^="on response from no_line"]')
        page.keyboard.press("Enter")
        assert "on response from no_line goto searching" in page.locator(".line.here").text_content()
        tab_to(page, '#commands > li[data-event="message_move.c_trigger"] .links button:last-child')
        page.keyboard.press("Enter")
        page.locator('#commands > li[data-event="message_move.c_trigger"]').get_by_text("shortest way").wait_for()
        tab_to(page, 'button[data-event="message_correction.u_response"]')
        page.keyboard.press("Tab")
        page.keyboard.press("Control+A")
        page.keyboard.type("1.5")
        page.keyboard.press("Shift+Tab")
        page.keyboard.press("Enter")
        at(page, 1)
        assert shown(page)["variables"]["LineDetector.offset"] == "1.5"
        tab_to(page, "#moment")
        page.keyboard.press("ArrowLeft")
        at(page, 0)
        page.keyboard.press("ArrowRight")
        at(page, 1)
        tab_to(page, "#happened")
        tab_to(page, "#happened button")
        page.keyboard.press("Enter")
        at(page, 0)


def test_another_address_needs_the_token(chromium: Any) -> None:
    with served(MODEL, "--address", "127.0.0.2") as address:
        plain, token = address.split("?token=")
        assert len(token) > 20
        with opened(chromium, address) as page:
            assert shown(page) == truth(simulation_of(MODEL), 0)
            assert token not in page.url
        for asked in (
            plain,
            f"{plain}description",
            f"{plain}moments",
            f"{plain}page.js",
            f"{plain}?token={token[:-1]}",
        ):
            with pytest.raises(HTTPError, match="403"):
                urlopen(asked, timeout=60)  # noqa: S310


def test_it_draws_30_times_a_second_at_most_and_what_is_chosen_in_the_next_frame(chromium: Any) -> None:
    count = """(happening) => new Promise((done) => {
      const [frames, began] = [120, performance.now()];
      let [drawings, number] = [0, 0];
      new MutationObserver((changes) => (drawings += changes.length)).observe(
        document.body, { attributeFilter: ["data-moment"] });
      const place = happening === "input" ? document.getElementById("moment") : window;
      requestAnimationFrame(function frame() {
        if (number++ === frames) return done([frames, drawings, performance.now() - began]);
        place.dispatchEvent(new Event(happening));
        requestAnimationFrame(frame);
      });
    })"""
    with served(MODEL) as address, opened(chromium, address) as page:
        _, drawings, milliseconds = page.evaluate(count, "resize")
        assert 2 < drawings <= milliseconds / 32 + 2
        frames, drawings, _ = page.evaluate(count, "input")
        assert drawings >= frames - 1


def test_finding_folding_and_zooming(chromium: Any) -> None:
    with served(MODEL) as address, opened(chromium, address) as page:
        page.get_by_label("Find", exact=True).fill("blocked")
        assert page.locator(".card:visible .name").all_text_contents() == ["Lidar"]
        page.get_by_label("Find", exact=True).fill("")
        page.get_by_role("button", name="Fold all").click()
        assert page.locator(".card[open]").count() == 0
        page.get_by_role("button", name="Unfold all").click()
        before = page.locator(".card svg").first.bounding_box()["width"]
        page.get_by_role("button", name="Zoom in").click()
        assert page.locator(".card svg").first.bounding_box()["width"] > before * 1.2


def test_hidden_pages_leave_connections_to_others(chromium: Any) -> None:
    """A browser opens six connections to one server, and a visible page holds one."""
    hide = """(hidden) => {
      Object.defineProperty(document, "hidden", { value: hidden, configurable: true });
      document.dispatchEvent(new Event("visibilitychange"));
    }"""
    with served(MODEL) as address, opened(chromium, address) as first:
        page = first
        for _ in range(7):
            page.evaluate(hide, True)
            page = first.context.new_page()
            page.goto(address)
            # The page is drawn and holds its connection: only then can it release it.
            page.wait_for_selector("body[data-drawn][data-moment]")
        assert shown(page) == truth(simulation_of(MODEL), 0)
        page.evaluate(hide, True)
        first.evaluate(hide, False)
        assert shown(first) == truth(simulation_of(MODEL), 0)
