"""Every command on a page runs or has a reason not to, every model passes its checks, and other texts parse.

`tests.docs.pages.MARKS` lists the marks in the comment before a block.
"""

from __future__ import annotations

import json
import re
import shlex
import tomllib
import xml.etree.ElementTree as ET
from contextlib import nullcontext
from fnmatch import fnmatch
from typing import TYPE_CHECKING

import click
import pytest
from ruamel.yaml import YAML

import robosc
from robosc.language.reading import read
from robosc.language.text import Documents
from robosc.tools.cli import main
from tests.docs.pages import MARKS, PAGES, ROOT, Block, blocks, without_blocks
from tests.docs.running import Desk, commands, matches
from tests.searching import less_effort

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

#: Pages whose blocks other tests cover completely.
HELD = {
    "docs/rules/*.md": "tests/language/checks/test_rule_pages.py",
    "docs/rules/xmi.md": "tests/model/validity/test_validity.py",
    "docs/patterns*.md": "tests/test_patterns.py",
    "docs/explain.md": "tests/tools/cli/test_explain_page.py",
    "docs/cif-simulator.md": "tests/language/cif/test_simulator_page.py",
}
BLOCKS = {page: blocks(page) for page in PAGES}


def is_held(page: Path) -> bool:
    return any(fnmatch(page.relative_to(ROOT).as_posix(), pattern) for pattern in HELD)


def free(*kinds: str) -> list[Block]:
    """Return the blocks of these kinds that no other test covers and no mark excludes."""
    return [
        block
        for page, found in BLOCKS.items()
        if not is_held(page)
        for block in found
        if block.kind in kinds and not {"not run", "tested by"} & block.marks.keys()
    ]


def named(found: list[Block]) -> pytest.MarkDecorator:
    return pytest.mark.parametrize("block", found, ids=[block.name for block in found])


def test_blocks_have_a_kind_that_is_looked_at() -> None:
    known = {"sh", "console", "robosc", "mermaid", "diff", "", *READERS, *UNREAD}
    assert [block.name for found in BLOCKS.values() for block in found if block.kind not in known] == []


def test_marks_are_known_and_point_somewhere() -> None:
    wrong = []
    for block in (block for found in BLOCKS.values() for block in found):
        for mark, value in block.marks.items():
            if mark not in MARKS or not value:
                wrong.append(f"{block.name}: {mark}")
            if mark == "tested by" and block.page.name not in (ROOT / value).read_text(encoding="utf-8"):
                wrong.append(f"{block.name}: {value} does not speak of {block.page.name}")
            if mark == "in" and value.startswith("examples") and not (ROOT / value).is_dir():
                wrong.append(f"{block.name}: there is no {value}")
    assert wrong == []
    assert all((ROOT / test).is_file() for test in HELD.values())


def test_no_command_hides_in_a_block_without_a_kind() -> None:
    begins = re.compile(r"^(\$ |robosc |ros2 |roslaunch |(robot|library) \w+ \{)", re.MULTILINE)
    assert [
        block.name for found in BLOCKS.values() for block in found if not block.kind and begins.search(block.text)
    ] == []


RUN = sorted({block.page for block in free("sh", "console")})


@pytest.mark.slow
@pytest.mark.parametrize("page", RUN, ids=[page.relative_to(ROOT).as_posix() for page in RUN])
def test_the_commands_of_a_page_do_what_it_says(page: Path, tmp_path: Path) -> None:
    desk = Desk(tmp_path)
    runnable = free("sh", "console")
    for block in BLOCKS[page]:
        if "file" in block.marks:
            desk.write(block)
        if block not in runnable:
            continue
        found = commands(block)
        assert found, f"{block.name} holds no command"
        for number, (command, shown) in enumerate(found):
            # Only pages that show a number of operations need the full effort.
            with nullcontext() if " operations" in (shown or "") else less_effort():
                status, told = desk.run(command, desk.place(block))
            wanted = int(block.marks.get("status", 0)) if number == len(found) - 1 else 0
            assert status == wanted, f"{block.name}: {command}\n{told}"
            if shown is not None:
                assert matches(told, shown), f"{block.name}: {command}\n{told}"


def called(text: str) -> Iterator[list[str]]:
    """Yield the calls of robosc in commands, each as a list of words."""
    for command in re.findall(r"(?:^|[\s|/;])(?<!-[lm] )robosc ([a-z][^|<>;&#\n`]*)", text, flags=re.MULTILINE):
        try:
            yield shlex.split(command.replace("...", ""))
        except ValueError:
            continue


@pytest.mark.parametrize("page", PAGES, ids=[page.relative_to(ROOT).as_posix() for page in PAGES])
def test_calls_of_robosc_are_right(page: Path) -> None:
    """Each call on a page, run or not, in a block or in a sentence, uses an existing command and existing options."""
    text = page.read_text(encoding="utf-8")
    shells = "\n".join(block.text.replace("\\\n", " ") for block in BLOCKS[page] if block.kind in ("sh", "console"))
    inline = "\n".join(re.findall(r"`(robosc [a-z][^`\n]*)`", without_blocks(text)))
    wrong = []
    for words in [*called(shells), *called(inline)]:
        command = main.get_command(click.Context(main), words[0])
        if command is None:
            wrong.append(words)
            continue
        options = command.get_params(click.Context(command))
        if isinstance(command, click.Group):
            continue
        there = {spelling for option in options for spelling in (*option.opts, *option.secondary_opts)} | {"--help"}
        # ROS interprets the words after this one.
        own = words[: words.index("--ros-args")] if "--ros-args" in words else words
        wrong += [words for word in own[1:] if re.match(r"--?[a-zA-Z]", word) and word.partition("=")[0] not in there]
    assert wrong == []


#: Constructs that may contain a fragment of a model, from the outermost to the innermost.
FRAMES = {
    "model": "{}",
    "robot": "robot R {{ {} }}",
    "component": "robot R {{ component C {{ {} }} }}",
    "behaviour": "robot R {{ component C {{ behaviour {{ {} }} }} }}",
    "state": "robot R {{ component C {{ behaviour {{ initial state s {{ {} }} }} }} }}",
}


def syntax_faults(text: str) -> list[str]:
    return [
        finding.message
        for finding in read("page.rscd", documents=Documents({"page.rscd": text})).findings
        if finding.rule == "syntax"
    ]


MODELS = free("robosc")


@named(MODELS)
def test_models_are_right(block: Block, tmp_path: Path) -> None:
    """A whole model has no error. A fragment has no syntax error in at least one permitted frame."""
    if not re.match(r"(\s|//.*\n)*robot ", block.text) or block.text.count("\nlibrary "):
        frames = [block.marks["fragment"]] if "fragment" in block.marks else list(FRAMES)
        faults = {frame: syntax_faults(FRAMES[frame].format(block.text + "\n")) for frame in frames}
        if frames == list(FRAMES) and block.text.count("\nlibrary "):
            faults["model"] = [
                fault
                for part in re.split(r"^(?=library )", block.text, flags=re.MULTILINE)
                for fault in syntax_faults(part)
            ]
        assert [] in faults.values(), faults
        return
    path = tmp_path / "model.rscd"
    path.write_text(block.text, encoding="utf-8")
    robot = robosc.load(path)
    assert [str(finding.message) for finding in robosc.check(robot) if finding.severity == "error"] == []
    robosc.synthesize(robosc.to_sct(robot))


def read_json(text: str) -> None:
    """Read one JSON value, or one for each line."""
    try:
        json.loads(text)
    except json.JSONDecodeError:
        for line in text.splitlines():
            json.loads(line)


#: Parsers for the languages whose syntax the test checks.
READERS: dict[str, Callable[[str], object]] = {
    "json": read_json,
    "yaml": YAML(typ="safe").load,
    "toml": tomllib.loads,
    "xml": ET.fromstring,
    "python": lambda text: compile(text, "page", "exec"),
}
#: Languages without a parser here.
UNREAD = {"lua", "elisp", "c", "cif", "cmake", "dockerfile", "{toctree}", "{eval-rst}", "{literalinclude}", "{include}"}
TEXTS = free(*READERS)


@named(TEXTS)
def test_other_texts_can_be_read(block: Block) -> None:
    READERS[block.kind](block.text)


def test_a_page_that_is_wrong_is_found(tmp_path: Path) -> None:
    """The checks above fail for a wrong page."""
    page = tmp_path / "page.md"
    page.write_text(
        "<!-- in: x; status: 3 -->\n```console\n$ robosc rule type\nother\n```\n\n```robosc\nstate s { on }\n```\n"
    )
    console, model = blocks(page)
    assert console.marks == {"in": "x", "status": "3"}
    assert commands(console) == [("robosc rule type", "other\n")]
    desk = Desk(tmp_path)
    status, told = desk.run("robosc rule type", desk.root)
    assert status == 0
    assert not matches(told, "other\n")
    assert matches(told, "# type\n...\n")
    assert desk.run("robosc rule type | grep -q '# nothing'", desk.root)[0] == 1
    assert all(syntax_faults(frame.format(model.text)) for frame in FRAMES.values())
