"""The page in a real browser: counterexamples, scripts and recordings; the text, the timeline and the plots."""

from __future__ import annotations

import json
from random import Random
from typing import TYPE_CHECKING, Any
from urllib.request import urlopen

import pytest
from mcap.writer import CompressionType

from robosc.base.recordings import RecordedText
from robosc.run.simulation.simulation import whole_state
from robosc.tools.view.description import automata_of
from tests.base.recordings.test_recordings import write_mcap
from tests.chromium import opened, shown

from .robots import EVIL, GATE
from .test_page import MODEL, at, click, served, simulation_of, truth

if TYPE_CHECKING:
    from pathlib import Path

    from robosc.run.simulation import Simulation

pytestmark = pytest.mark.build

PROPERTY = "  property SP1: never Barrier.opened and Barrier.cars = 3\n"
FILLED = "message_filled.u_response"
TANK = """\
robot Tank {
  interface filling use Filling from tank_msgs

  datatype object Filling {
    x: double
    name: string
  }

  component Tank {
    outgoing message filled with identifier: "/filled", type: Filling links filling

    behaviour {
      variable level: double = 0.5
      variable label: string = "new"

      initial marked state watched {
        on response from filled do level := value.x, label := value.name
      }
    }
  }
}
"""
OPEN, CAR, UP = "message_open.c_trigger", "message_car.u_response", "component_Barrier.u_after1"


@pytest.fixture
def gate(tmp_path: Path) -> Path:
    """Return a robot with a timer, a number, and a property that does not hold."""
    path = tmp_path / "gate.rscd"
    path.write_text(GATE.replace("  requirement Full", f"{PROPERTY}  requirement Full"), encoding="utf-8")
    return path


def played(address: str, number: int, simulation: Simulation) -> list[dict[str, Any]]:
    """Play the first moments of a page with an engine; return the page's expected content at each."""
    moments: list[dict[str, Any]] = []
    with urlopen(f"{address}moments", timeout=60) as stream:  # noqa: S310
        while len(moments) < number:
            line = stream.readline().decode()
            if line.startswith("data: "):
                moments += json.loads(line.removeprefix("data: "))["moments"]
    expected = []
    for moment in moments:
        if "event" in moment and "by" not in moment:
            assert simulation.perform(moment["event"], moment.get("data", {})).accepted
        expected.append(truth(simulation))
    return expected


def test_a_counterexample_leads_to_where_the_property_does_not_hold(chromium: Any, gate: Path) -> None:
    with served(gate, "--trace", "SP1") as address, opened(chromium, address) as page:
        last = int(page.locator("body").get_attribute("data-moment"))
        expected = played(address, last + 1, simulation_of(gate))
        for moment in range(last, -1, -1):
            page.locator("#moment").fill(str(moment))
            at(page, moment)
            assert shown(page) == expected[moment]
        page.locator("#moment").fill(str(last))
        at(page, last)
        assert page.locator("#source").inner_text().startswith("Counterexample to property SP1")
        assert page.locator("#happened .refused").inner_text().endswith(": violates the property")
        assert page.locator("#happened [aria-current]").inner_text().endswith(": violates the property")
        assert page.locator("#properties li").all_inner_texts() == [f"SP1 {PROPERTY.strip()}"]
    assert expected[-1]["states"] == [["Barrier", "opened", ["opened"]]]
    assert expected[-1]["variables"] == {"Barrier.cars": "3"}


def test_a_script_with_what_it_asks_in_vain(chromium: Any, gate: Path, tmp_path: Path) -> None:
    script = tmp_path / "script"
    script.write_text(f'{OPEN}\n{OPEN}\n{CAR} {{"value": true}}\n', encoding="utf-8")
    with served(gate, "--log", script) as address, opened(chromium, address) as page:
        at(page, 3)
        expected = played(address, 4, simulation_of(gate))
        assert shown(page) == expected[-1]
        assert page.locator("#happened .refused").all_text_contents() == [
            "request to Barrier.open: the robot is not ready for it"
        ]


def test_a_recording_moment_by_moment(chromium: Any, tmp_path: Path) -> None:
    simulation, random = simulation_of(MODEL), Random(8)
    texts, expected = [], [truth(simulation, 0)]
    for number in range(40):
        happened = simulation.random_step(random)
        assert happened is not None
        components = {
            str(plant.origin): {
                "state": whole_state(simulation.engine)[plant.name],
                "variables": {variable.name: simulation.engine.value(variable) for variable in plant.variables},
            }
            for plant in automata_of(simulation.engine.model)
        }
        components["LineDetector"]["variables"]["offset"] = number / 8  # type: ignore[index]
        report = {
            "robot": "LineFollower",
            "time": number / 4,
            "components": components,
            "transitions": [happened.event],
        }
        texts.append(RecordedText("/line_follower_controller/state", json.dumps(report)))
        expected.append(truth(simulation, number / 8))
    recording = write_mcap("cdr", CompressionType.ZSTD)(tmp_path / "run", texts)
    with served(MODEL, "--log", recording) as address, opened(chromium, address) as page:
        last = int(page.locator("body").get_attribute("data-moment"))
        for back in range(40):
            page.locator("#moment").fill(str(last - back))
            at(page, last - back)
            assert shown(page) == expected[40 - back]
        page.get_by_role("button", name="Go on from here").click()
        page.wait_for_selector(f'#moment[max="{last - 39}"]')
        assert shown(page) == expected[1]


def test_numbers_and_times_are_told_and_the_time_line_is_dragged(chromium: Any, gate: Path) -> None:
    with served(gate) as address, opened(chromium, address) as page:
        left = page.locator(f'#numbers > li[data-key="{UP}"] strong')
        assert left.text_content() == "not running"
        click(page, OPEN)
        at(page, 1)
        assert left.text_content() == "2 s left"
        for number in range(2, 5):
            click(page, CAR, "true")
            at(page, number)
        page.get_by_role("button", name="Wait 1 s").click()
        at(page, 5)
        assert left.text_content() == "1 s left"
        assert page.locator('#numbers > li[data-key="Barrier.cars"] strong').text_content() == "3"
        lanes = page.locator("#lanes").bounding_box()
        names = 150
        step = (lanes["width"] - names) / 6
        page.mouse.move(lanes["x"] + names + 4.5 * step, lanes["y"] + 8)
        page.mouse.down()
        at(page, 4)
        for moment in (3, 0, 2):
            page.mouse.move(lanes["x"] + names + (moment + 0.5) * step, lanes["y"] + 8)
            at(page, moment)
            assert page.locator('#numbers > li[data-key="Barrier.cars"] strong').text_content() == str(
                max(0, moment - 1)
            )
        page.mouse.up()
        page.mouse.move(lanes["x"] + names + 5.5 * step, lanes["y"] + 8)
        page.locator("#follow").click()
        at(page, 5)


def test_what_the_node_keeps_is_typed_shown_and_drawn(chromium: Any, tmp_path: Path) -> None:
    """A number is drawn as steps, a text as a lane, and an unknown value as a gap."""
    path = tmp_path / "tank.rscd"
    path.write_text(TANK, encoding="utf-8")
    with served(path) as address, opened(chromium, address) as page:
        told = page.locator('#numbers > li[data-key="Tank.level"]')
        label = page.locator('#numbers > li[data-key="Tank.label"] strong')
        assert (told.locator("strong").text_content(), label.text_content()) == ("0.5", "new")
        fields = page.locator(f'.performer:has(button[data-event="{FILLED}"])')
        for number, (level, text) in enumerate([(2.5, "half"), (-1.25, EVIL)], 1):
            fields.get_by_label("value.x").fill(str(level))
            fields.get_by_label("value.name").fill(text)
            click(page, FILLED)
            at(page, number)
            assert (told.locator("strong").text_content(), label.text_content()) == (str(level), text)
        assert told.locator(".range").text_content() == "(-1.25 to 2.5)"
        heights = """() => {
          const canvas = document.querySelector('[data-key="Tank.level"] canvas');
          const sample = document.createElement("canvas").getContext("2d");
          sample.fillStyle = getComputedStyle(document.documentElement).getPropertyValue("--accent");
          const wanted = [1, 3, 5].map((at) => parseInt(sample.fillStyle.slice(at, at + 2), 16));
          const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
          const draws = (at, height) => {
            const pixel = data.slice(4 * (height * canvas.width + at));
            return pixel[3] > 100 && wanted.every((part, one) => Math.abs(pixel[one] - part) < 40);
          };
          return [0.2, 0.5, 0.75].map((part) => {
            const at = Math.round(part * canvas.width);
            return [...Array(canvas.height).keys()].find((height) => draws(at, height)) ?? null;
          });
        }"""
        first, highest, lowest = page.evaluate(heights)
        assert highest < first < lowest
        # A random event has data of any kind.
        page.get_by_role("button", name="Random", exact=True).click()
        at(page, 3)
        assert label.text_content() in "abc"
        assert -10 <= float(told.locator("strong").text_content()) <= 10
        assert page.evaluate("globalThis.hacked === undefined && document.querySelectorAll('img').length === 0")


def test_the_text_leads_to_what_stands_there(chromium: Any, gate: Path) -> None:
    lines = gate.read_text().splitlines()

    def number(text: str) -> int:
        return next(at for at, line in enumerate(lines) if text in line)

    with served(gate) as address, opened(chromium, address) as page:
        page.get_by_role("button", name="Fold all").click()
        page.locator("#lines .line").nth(number("state opened")).click()
        assert page.locator(".state.found .title").text_content() == "opened"
        assert page.locator(".card[open] .name").all_text_contents() == ["Barrier"]
        # Continue with the keyboard: the transition below, then the requirement.
        page.locator("#lines").focus()
        page.keyboard.press("ArrowDown")
        page.keyboard.press("Enter")
        assert "on request to close" in page.locator(".transition.found").text_content()
        assert page.locator(".state.found").count() == 0
        for _ in range(number("requirement Full") - number("on request to close")):
            page.keyboard.press("ArrowDown")
        page.keyboard.press("Enter")
        assert page.locator("#commands > li.found").get_attribute("data-event") == OPEN


def test_lanes_of_commands_have_the_colours_of_their_verdicts(chromium: Any, gate: Path) -> None:
    with served(gate) as address, opened(chromium, address) as page:
        click(page, OPEN)
        at(page, 1)
        colour = """(name) => {
          const shown = document.createElement("canvas").getContext("2d");
          shown.fillStyle = getComputedStyle(document.documentElement).getPropertyValue(name);
          return shown.fillStyle;
        }"""
        colours = {page.evaluate(colour, f"--{kind}-lane"): kind for kind in ("allowed", "forbidden", "unready")}
        pixels = """(number) => {
          const lanes = document.querySelector("#lanes");
          const { data } = lanes.getContext("2d").getImageData(0.8 * lanes.width, 0, 1, lanes.height);
          return Array.from({ length: number }, (_, lane) => {
            const at = 4 * Math.round(((lane + 1) * 16 + 8) * devicePixelRatio);
            return "#" + [...data.slice(at, at + 3)].map((part) => part.toString(16).padStart(2, "0")).join("");
          });
        }"""
        # A lane for the component, then one for each command, in the order of the page's list.
        listed = page.locator("#commands > li")
        drawn = [colours[pixel] for pixel in page.evaluate(pixels, listed.count())]
        assert drawn == [listed.nth(lane).get_attribute("class") for lane in range(listed.count())]
        assert len(set(drawn)) > 1
