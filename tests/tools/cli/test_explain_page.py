"""The stories of docs/explain.md are true: each model, repaired as the page shows, has the shown output."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.tools.cli.conftest import Run

PAGE = Path(__file__).parents[3] / "docs" / "explain.md"
STORIES = ["Nothing is allowed", "Less is allowed than was meant", "One thing is never allowed"]


def repaired(model: str, diff: str) -> str:
    """Return the model with one hunk of a diff applied."""
    old, new = (
        "".join(line[1:] for line in diff.splitlines(keepends=True) if line[0] in signs) for signs in ("- ", "+ ")
    )
    assert model.count(old) == 1
    return model.replace(old, new)


@pytest.mark.parametrize("story", STORIES)
def test_story(story: str, run: Run, golden: Callable, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    page = PAGE.read_text(encoding="utf-8")
    section = page.partition(f"\n## {story}\n")[2].partition("\n## ")[0]
    name = re.search(r"`(\w+\.rscd)`", section)[1]

    def told(block: re.Match[str]) -> str:
        kind, text = block.groups()
        if kind == "console":
            command = text.partition("\n")[0]
            answer = run(*command.split()[2:])
            return f"```console\n{command}\n{answer.stdout}{answer.stderr}```"
        model = Path(name)
        model.write_text(repaired(model.read_text(), text) if kind == "diff" else text)
        return block[0]

    golden(PAGE, page.replace(section, re.sub(r"^```(\w*)\n(.*?)^```$", told, section, flags=re.MULTILINE | re.DOTALL)))


def test_the_page_tells_three_stories() -> None:
    sections = re.findall(r"^## (.*)$", PAGE.read_text(encoding="utf-8"), flags=re.MULTILINE)
    assert sections == ["Events and states", *STORIES]
