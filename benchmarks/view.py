"""How long the page of `robosc view` takes to draw a robot of many components, and to show events; its picture.

    python benchmarks/view.py [--components 100] [--picture docs/pictures/view.png]

It needs Debian's `chromium`, `playwright` and the built page. Times are medians of five, in milliseconds: from asking
for the page until all is drawn, and from a call that lets 1,000 random events happen until the last of them is shown.
"""

from __future__ import annotations

import argparse
import statistics
import subprocess
import sys
import tempfile
from contextlib import contextmanager
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

from playwright.sync_api import sync_playwright

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


@contextmanager
def served(model: Path) -> Iterator[str]:
    """The address of the page of a model."""
    command = [sys.executable, "-m", "robosc", "view", str(model)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=ROOT) as server:
        assert server.stdout is not None
        yield server.stdout.readline().strip()
        server.terminate()


def measured(browser: Any, address: str) -> tuple[float, float]:
    """Milliseconds until a page is drawn, and until it shows 1,000 events."""
    page = browser.new_page(viewport={"width": 1500, "height": 950})
    began = perf_counter()
    page.goto(address)
    page.wait_for_selector("body[data-drawn][data-moment]")
    drawn = perf_counter()
    page.evaluate(
        """fetch("do", {method: "POST", headers: {"Content-Type": "application/json"},
             body: JSON.stringify({action: "random", number: 1000})})"""
    )
    page.wait_for_selector('body[data-moment="1000"]')
    shown = perf_counter()
    page.get_by_role("button", name="Start again").click()
    page.wait_for_selector('body[data-moment="0"]')
    page.close()
    return 1000 * (drawn - began), 1000 * (shown - drawn)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--components", type=int, default=100)
    parser.add_argument("--picture", type=Path)
    options = parser.parse_args()
    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as folder:
        browser = playwright.chromium.launch(executable_path="/usr/bin/chromium", args=["--no-sandbox"])
        if options.picture is not None:
            with served(MODEL) as address:
                page = browser.new_page(viewport={"width": 1400, "height": 860})
                page.goto(address)
                page.wait_for_selector("body[data-drawn][data-moment]")
                page.get_by_role("button", name="20 random").click()
                page.wait_for_selector('body[data-moment="20"]')
                page.get_by_role("button", name="What would help?").first.click()
                page.get_by_text("The shortest way there:").wait_for()
                page.screenshot(path=options.picture)
            return
        model = Path(folder) / "doors.rscd"
        doors = "\n".join(DOOR.format(number=number) for number in range(options.components))
        model.write_text(f"robot Doors {{\n{doors}}}\n", encoding="utf-8")
        with served(model) as address:
            times = [measured(browser, address) for _ in range(5)]
        drawn, shown = (statistics.median(one) for one in zip(*times, strict=True))
        print(f"{options.components} components: drawn in {drawn:.0f} ms, 1,000 events shown in {shown:.0f} ms")


if __name__ == "__main__":
    main()
