"""The edit of `did you mean` replaces one name and nothing else, in models and in CIF."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path

import pytest

from robosc.base.diagnostics import Diagnostic, Edit
from robosc.base.ros_types import RosTypes
from robosc.language import cif
from robosc.language.checks import check
from robosc.language.cif.parsing import identifier
from robosc.language.reading import read
from robosc.language.text import Documents, Text
from robosc.language.tokens import Kind, Tokens
from robosc.m2t.cif.names import KEYWORDS
from tests.language.cif.test_language import COUNTS

EXAMPLES = Path(__file__).parents[2] / "examples"
ROBOTS = [EXAMPLES / name / f"{name}.rscd" for name in ("line_follower", "person_follower")]
INTERFACES = RosTypes()
#: Misspellings of a name: longer at an end or inside, shorter, or with two letters swapped.
MISTYPED: dict[str, Callable[[str], str]] = {
    "longer": lambda name: f"{name}x",
    "longer before": lambda name: f"x{name}",
    "doubled": lambda name: name[:2] + name[1] + name[2:],
    "shorter": lambda name: name[:-1],
    "turned": lambda name: name[:-2] + name[-1] + name[-2],
    "with a part more": lambda name: f"{name}_2",
}


def words(content: str) -> list[str]:
    return [token.text for token in Tokens(content) if token.kind is not Kind.END]


def replaced(before: Sequence[str], after: Sequence[str]) -> list[tuple[str, str]]:
    """Return the tokens that an edit replaced, each with its replacement."""
    assert len(before) == len(after), (before, after)
    return [(old, new) for old, new in zip(before, after, strict=True) if old != new]


def suggestions(findings: Iterable[Diagnostic], file: str) -> Iterator[Diagnostic]:
    for finding in findings:
        if finding.file == file and offered(finding) and (finding.hint or "").startswith("did you mean"):
            yield finding


def offered(finding: Diagnostic) -> Sequence[Edit]:
    """Return the edits of a finding: a word of the language is replaced, a name is only offered."""
    return finding.edits or next((way.edits for way in finding.alternatives), ())


@pytest.mark.slow
@pytest.mark.parametrize("mistyped", MISTYPED)
@pytest.mark.parametrize("robot", ROBOTS, ids=lambda path: path.stem)
def test_a_name_in_a_model_is_replaced_whole(robot: Path, mistyped: str) -> None:
    """The test misspells every 17th word of the text, keywords included."""
    content = robot.read_text(encoding="utf-8")
    tokens = [token for token in Tokens(content) if token.kind is Kind.WORD and len(token.text) > 3]
    for token in tokens[len(mistyped) :: 17]:
        wrong = MISTYPED[mistyped](token.text)
        broken = content[: token.start] + wrong + content[token.end :]
        reading = read(robot, (), INTERFACES, Documents({str(robot): broken}))
        found = [*reading.findings, *check(reading.base, reading.findings, INTERFACES)]
        for finding in suggestions(found, str(robot)):
            after = Text(str(robot), broken).after(offered(finding))
            changed = replaced(words(broken), words(after))
            assert {new for _, new in changed} <= {finding.hint.split("`")[1]} or len(offered(finding)) > 1
            assert len(changed) == len(offered(finding)), (finding, changed)


@pytest.mark.parametrize("mistyped", MISTYPED)
def test_a_name_in_cif_is_replaced_whole(mistyped: str) -> None:
    seen = 0
    for content, _ in list(COUNTS.values())[len(mistyped) % 5 :: 5]:
        tokens = [token for token in Tokens(content) if token.kind is Kind.WORD and len(token.text) > 3]
        for token in tokens[len(mistyped) % 3 :: 5]:
            wrong = MISTYPED[mistyped](token.text)
            broken = content[: token.start] + wrong + content[token.end :]
            for finding in suggestions(cif.read("a.cif", Documents({"a.cif": broken})).findings, "a.cif"):
                after = Text("a.cif", broken).after(offered(finding))
                ((_, new),) = replaced(words(broken), words(after))
                assert new.strip("$") in finding.hint
                seen += 1
    assert seen > 0


PARTS = """group g:
  group inner: controllable closing, state; end
  group loop: controllable entered; end
end
plant p: location first: initial; marked; edge {0} goto {1}; end
"""


@pytest.mark.parametrize(
    ("event", "target", "suggested"),
    [
        ("g.inner.closin", "first", "g.inner.closing"),
        ("g.iner.closing", "first", "g.inner.closing"),
        ("gg.inner.closing", "first", None),
        ("^g.iner.closing", "first", "^g.inner.closing"),
        ("g.inner.stat", "first", "g.inner.state"),
        ("g.inner.state", "firs", "first"),
        ("g.inner.state", "firstly", "first"),
    ],
)
def test_a_dotted_name_keeps_its_other_parts(event: str, target: str, suggested: str | None) -> None:
    content = PARTS.replace("{0}", event).replace("{1}", target)
    found = cif.read("a.cif", Documents({"a.cif": content})).findings
    hints = [finding.hint for finding in found if finding.rule == "unresolved-reference"]
    assert hints == [None if suggested is None else f"did you mean `{suggested}`?"]
    if suggested is not None:
        mended = Text("a.cif", content).after(offered(found[0]))
        assert cif.read("a.cif", Documents({"a.cif": mended})).findings == []
        word, wrong = ("goto", target) if target != "first" else ("edge", event)
        assert mended == content.replace(f"{word} {wrong}", f"{word} {suggested}")


def test_the_first_part_of_a_dotted_name_is_replaced_alone() -> None:
    content = PARTS.replace("group g:", "group outer:").replace("{0}", "outr.loop.entered").replace("{1}", "first")
    (finding,) = cif.read("a.cif", Documents({"a.cif": content})).findings
    assert finding.hint == "did you mean `outer.loop.entered`?"
    assert Text("a.cif", content).after(offered(finding)) == content.replace("outr.loop", "outer.loop")


def test_a_suggested_keyword_of_cif_has_its_dollar_sign() -> None:
    content = "controllable c;\nplant p: location $initial: initial; marked; edge c goto initia; end\n"
    (finding,) = cif.read("a.cif", Documents({"a.cif": content})).findings
    assert finding.hint == "did you mean `$initial`?"
    mended = Text("a.cif", content).after(offered(finding))
    assert cif.read("a.cif", Documents({"a.cif": mended})).findings == []


def test_the_grammar_knows_the_keywords_that_are_written() -> None:
    assert {word for word in KEYWORDS if identifier(word) == word} == set()
    assert identifier("closing") == "closing"
