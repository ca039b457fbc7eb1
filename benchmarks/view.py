"""Time the page of `robosc view`: drawing a robot of many components, showing events; or take its picture.

    python benchmarks/view.py [--components 100] [--flood SECONDS]
    python benchmarks/view.py --picture docs/pictures/view.png
    python benchmarks/view.py --picture docs/pictures/view-robot.png --ros2 --dark
    python benchmarks/view.py --recording docs/pictures/view.gif

It needs Debian's `chromium`, `playwright` and the built page. Times are medians of five, in milliseconds: from the
request for the page until it is drawn, the processor time of the page in that, which does not depend on other load of
the machine, and from a call that performs 1,000 random events until the last of them is shown.

With `--flood` the page receives a node's reports, 1,000 events a second in 100 reports, for the given seconds. The
results are the frames that the browser draws a second, the memory of its scripts after each tenth of that time, and
the processor time of page and server.

`--picture` draws the page of the line follower: simulated, or with `--ros2` beside `robosc run`, which drives the robot
of the simulator over ROS 2 until it halts for the obstacle. `--recording` plays its scenario in the simulator, and
films thirty seconds of its event log in the page, around the obstacle.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import statistics
import subprocess
import sys
import tempfile
from contextlib import contextmanager
from io import BytesIO
from multiprocessing import Process
from pathlib import Path
from random import Random
from socket import socket
from time import perf_counter
from typing import TYPE_CHECKING, Any

from PIL import Image
from playwright.sync_api import Error as PlaywrightError
from playwright.sync_api import sync_playwright

import robosc
from robosc.m2t.models import Models
from robosc.run.simulation import Simulation
from robosc.tools import view
from robosc.tools.view import http_server
from robosc.tools.view.server import application

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).parent.parent
MODEL = ROOT / "examples" / "line_follower" / "line_follower.rscd"
DOOR = """\
  component Door{number} {{
    outgoing message opened{number} with identifier: "/opened{number}", type: none
    outgoing message closed{number} with identifier: "/closed{number}", type: none

    behaviour {{
      initial marked state closed {{
        on response from opened{number} goto opened
      }}

      state opened {{
        on response from closed{number} goto closed
      }}
    }}
  }}
"""


#: Frames a second of the recording.
_FRAMES = 3
#: Events a second, and reports a second.
_RATE, _REPORTS = 1000, 100


@contextmanager
def served(model: Path, *options: str) -> Iterator[str]:
    """Serve the page of a model; yield its address."""
    command = [sys.executable, "-m", "robosc", "view", str(model), *options]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=ROOT) as server:
        assert server.stdout is not None
        yield server.stdout.readline().strip()
        server.terminate()


def measured(browser: Any, address: str) -> tuple[float, float, float]:
    """Return the milliseconds until a page is drawn, their processor time, and those until 1,000 events are shown."""
    page = browser.new_page(viewport={"width": 1500, "height": 950})
    began = perf_counter()
    page.goto(address)
    page.wait_for_selector("body[data-drawn][data-moment]")
    drawn = perf_counter()
    computed = metrics(page)["ProcessTime"]
    began_again = perf_counter()
    page.evaluate(
        """fetch("do", {method: "POST", headers: {"Content-Type": "application/json"},
             body: JSON.stringify({action: "random", number: 1000})})"""
    )
    page.wait_for_selector('body[data-moment="1000"]')
    shown = perf_counter()
    page.get_by_role("button", name="Start again").click()
    page.wait_for_selector('body[data-moment="0"]')
    page.close()
    return 1000 * (drawn - began), 1000 * computed, 1000 * (shown - began_again)


def metrics(page: Any) -> dict[str, float]:
    """Return the browser's metrics of a page: the memory of its scripts, the processor time of its process."""
    tools = page.context.new_cdp_session(page)
    tools.send("Performance.enable")
    tools.send("HeapProfiler.collectGarbage")
    return {metric["name"]: metric["value"] for metric in tools.send("Performance.getMetrics")["metrics"]}


def flooding(model: Path, port: int, seconds: float) -> None:
    """Serve the page of a robot whose doors open and close, until the process is killed."""
    loaded = robosc.load(model)
    supervised, graph = robosc.to_sct(loaded), robosc.to_rosgraph(loaded)
    robosc.synthesize(supervised)
    live = view.Live(Simulation(supervised, graph), graph, "/doors_controller")
    description = view.describe(Models(supervised, graph, loaded), {})
    served = application([(description, live)], [f"127.0.0.1:{port}"])
    states = ["closed"] * len(description["automata"])

    async def flood() -> None:
        loop, random = asyncio.get_running_loop(), Random(0)
        began = loop.time()
        for number in range(round(seconds * _REPORTS)):
            await asyncio.sleep(began + number / _REPORTS - loop.time())
            events = []
            for door in random.choices(range(len(states)), k=_RATE // _REPORTS):
                states[door] = "opened" if states[door] == "closed" else "closed"
                events.append(f"message_{states[door]}{door}.u_response")
            components = {f"Door{door}": {"state": state, "variables": {}} for door, state in enumerate(states)}
            report = {"robot": "Doors", "time": number / _REPORTS, "components": components, "transitions": events}
            live.receive_report(json.dumps(report))
            await live.tell()

    def ready() -> None:
        asyncio.get_running_loop().flood = asyncio.ensure_future(flood())  # type: ignore[attr-defined]  # keeps it

    live.heard(1)
    http_server.serve(served, http_server.listen("127.0.0.1", port), ready)


def flooded(browser: Any, model: Path, seconds: float) -> None:
    """Print the costs of a flood."""
    with socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    server = Process(target=flooding, args=(model, port, seconds + 5))
    server.start()
    page = browser.new_page(viewport={"width": 1500, "height": 950})
    while True:
        try:
            page.goto(f"http://127.0.0.1:{port}/")
            break
        except PlaywrightError:
            page.wait_for_timeout(100)
    page.wait_for_selector("body[data-drawn][data-moment]")
    count = "window.frames_drawn = 0; (function one() { window.frames_drawn++; requestAnimationFrame(one); })()"
    page.evaluate(count)
    heaps, rates, used_before = [], [], metrics(page)["ProcessTime"]
    for _ in range(10):
        before, began = page.evaluate("window.frames_drawn"), perf_counter()
        page.wait_for_timeout(100 * seconds)
        rates.append((page.evaluate("window.frames_drawn") - before) / (perf_counter() - began))
        heaps.append(metrics(page)["JSHeapUsedSize"] / 1e6)
    computed = metrics(page)["ProcessTime"] - used_before
    moment = int(page.locator("body").get_attribute("data-moment"))
    used = sum(map(int, Path(f"/proc/{server.pid}/stat").read_text().split()[13:15])) / os.sysconf("SC_CLK_TCK")
    server.terminate()
    print(f"shown: event {moment}; frames a second: {min(rates):.0f} at least, {statistics.median(rates):.0f} mostly")
    print(
        f"MB of scripts: {', '.join(f'{heap:.0f}' for heap in heaps)}; processor time: the page {computed:.0f} s,"
        f" the server {used:.0f} s"
    )


def record(browser: Any, log: Path, film: Path) -> None:
    """Film thirty seconds of the line follower's scenario, from five seconds before it halts for the obstacle."""
    simulator = [sys.executable, str(ROOT / "examples" / "simulator"), "--scenario", "line_follower", "--log", str(log)]
    subprocess.run(simulator, check=True)
    entries = [json.loads(line) for line in log.read_text(encoding="utf-8").splitlines()]
    times = [entry["time"] - entries[0]["time"] for entry in entries]
    moving = next(at for at, entry in enumerate(entries) if entry["event"] == "message_move.c_trigger")
    halt = next(at for at in range(moving, len(entries)) if entries[at]["event"] == "message_halt.c_trigger")
    pictures = []
    with served(MODEL, "--log", str(log)) as address:
        page = browser.new_page(viewport={"width": 1180, "height": 640})
        page.goto(address)
        page.wait_for_selector(f'body[data-drawn][data-moment="{len(entries)}"]')
        for number in range(30 * _FRAMES):
            now = times[halt] - 5 + number / _FRAMES
            moment = sum(time <= now for time in times)
            choose = "(slider, moment) => { slider.value = moment; slider.dispatchEvent(new Event('input')); }"
            page.locator("#moment").evaluate(choose, moment)
            page.wait_for_selector(f'body[data-moment="{moment}"]')
            pictures.append(Image.open(BytesIO(page.screenshot())).convert("RGB"))
    colours = pictures[0].quantize(96, dither=Image.Dither.NONE)
    first, *others = [picture.quantize(palette=colours, dither=Image.Dither.NONE) for picture in pictures]
    first.save(film, save_all=True, append_images=others, duration=1000 // _FRAMES, loop=0, optimize=True)


def beside_a_robot(page: Any, folder: Path, picture: Path) -> None:
    """Draw the page beside a node that drives, when it has halted for the obstacle."""
    sys.path.insert(0, str(ROOT))
    from benchmarks.watched import page_served  # noqa: PLC0415  # only here a ROS is needed
    from tests.ros.running import Runner, find_rclpy  # noqa: PLC0415
    from tests.ros.workspaces import middleware  # noqa: PLC0415

    found = find_rclpy()
    assert found.ros is not None, found.missing
    runner = Runner(found.ros, folder / "none")
    with middleware(runner, folder, simulated=True) as processes, page_served(processes, runner, folder) as address:
        page.goto(address)
        page.wait_for_selector("body[data-drawn]")
        processes.start("node", runner.node("line_follower_controller", "use_sim_time:=true"))
        options = ["--scenario", "line_follower", "--ros", "2", "--speed", "5"]
        processes.start("world", [found.ros.python, ROOT / "examples" / "simulator", *options])
        command = '#commands > li[data-event="message_move.c_trigger"]'
        page.wait_for_selector(f"{command}.allowed", timeout=120_000)
        page.wait_for_selector(f'{command}.forbidden:has-text("Lidar.free")', timeout=120_000)
        page.wait_for_selector('.current .title:text-is("blocked")', timeout=120_000)
        page.screenshot(path=picture)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--components", type=int, default=100)
    parser.add_argument("--picture", type=Path)
    parser.add_argument("--ros2", action="store_true")
    parser.add_argument("--dark", action="store_true")
    parser.add_argument("--recording", type=Path)
    parser.add_argument("--flood", type=float, metavar="SECONDS")
    options = parser.parse_args()
    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as folder:
        browser = playwright.chromium.launch(executable_path="/usr/bin/chromium", args=["--no-sandbox"])
        if options.picture is not None:
            size = {"width": 1280, "height": 780}
            page = browser.new_page(viewport=size, color_scheme="dark" if options.dark else "light")
            if not options.ros2:
                with served(MODEL) as address:
                    page.goto(address)
                    page.wait_for_selector("body[data-drawn][data-moment]")
                    page.get_by_role("button", name="20 random").click()
                    page.wait_for_selector('body[data-moment="20"]')
                    page.get_by_role("button", name="What would help?").first.click()
                    page.get_by_text("The shortest way there:").wait_for()
                    page.screenshot(path=options.picture)
            else:
                beside_a_robot(page, Path(folder) / "run", options.picture)
            return
        if options.recording is not None:
            record(browser, Path(folder) / "events.jsonl", options.recording)
            return
        model = Path(folder) / "doors.rscd"
        doors = "\n".join(DOOR.format(number=number) for number in range(options.components))
        model.write_text(f"robot Doors {{\n{doors}}}\n", encoding="utf-8")
        if options.flood is not None:
            flooded(browser, model, options.flood)
            return
        with served(model) as address:
            times = [measured(browser, address) for _ in range(5)]
        drawn, computed, shown = (statistics.median(column) for column in zip(*times, strict=True))
        print(
            f"{options.components} components: drawn in {drawn:.0f} ms, with {computed:.0f} ms of processor time;"
            f" 1,000 events shown in {shown:.0f} ms"
        )


if __name__ == "__main__":
    main()
