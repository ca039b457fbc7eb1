"""Hints that state an edit mend the finding, in all models that violate a rule."""

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from robosc.base.diagnostics import Diagnostic, Edit
from robosc.base.ros_types import RosTypes
from robosc.language.checks import check
from robosc.language.reading import Reading, read
from robosc.language.text import Documents
from tests.language.test_recovery import FAULTS, FOREIGN, MODEL, changed

HERE = Path(__file__).parent
PACKAGE = HERE.parents[2] / "robosc"
LINE = re.compile(r" \(line \d+\)| in line \d+")
INTERFACES = RosTypes([HERE / "interfaces"])
MODELS = sorted((HERE / "rejected").glob("*/*.rscd"))
#: Texts that violate rules in ways no robot in `rejected` does: names, and syntax of other languages.
TEXTS = {
    "none": MODEL,
    **{f"fault-{number}": changed(MODEL, old, new) for number, (old, new, *_) in enumerate(FAULTS)},
    **{f"foreign-{number}": text for number, (text, _) in enumerate(FOREIGN)},
    "names": """robot R {
  datatype object Point { x: double }
  datatype object Path { points: array(Point) length: double }
  datatype enum E from double to { value > 1.0 -> clear default -> far }
  component A {
    incoming message m with type: none outgoing message path with type: Path
    behaviour { variable d: double marked initial state s { on response from path do d := value.points.x } state u { } }
  }
  component B { outgoing message n with type: E behaviour { initial marked state t { transition if u } state u { } } }
  component C { behaviour { initial marked state w { transition if u } } }
  requirement m needs A.q and A.clear and B.sss
}
""",
    "named": """robot R {
  datatype object O { x: double }
  datatype enum E from integer to { value = 1 -> one C.k > 1.0 -> two default -> other }
  constant c: O = 1
  parameter p: boolean(0.0..1.0) = true
  function f(x: double = 1.0): double = x
  function g(x: double): double = C.k
  component C {
    incoming message m with type: none
    outgoing message a with type: E
    outgoing message o with type: O
    incoming message n with type: integer
    incoming message l with type: std_msgs/Float64MultiArray
    behaviour {
      variable k: double = 1.0 variable e: E = one variable w: string = "a" variable b: boolean = all C: true
      initial marked state i { after true s goto i transition if k + e > 1.0 or w + w = "a" or b }
    }
  }
  component D { outgoing message a with type: E }
  requirement at most 0 m since m
  requirement at most 5000 m since m
  requirement T: automaton { state u { on m goto u on m goto u } state v { } }
  requirement U: automaton { initial state u { } initial state v { } }
  provide n with 1.0
  provide l with { data: 1.0 }
}
""",
    "changes": """robot R {
  component C {
    incoming message m with type: boolean, send: change
    outgoing message o with type: double, send: change
    behaviour { initial marked state i { on request to m goto i when true unless true } var x: boolean }
  }
}
""",
    "each": """robot R {
  component C { incoming message m with type: none }
  requirement P each C: m needs true
}
""",
    "calls": """robot R {
  component C { service s with request: none, response: none }
  component D { incoming message m with type: none }
  requirement m needs !C.s.running.x
  requirement m needs !C.s.runing
  requirement m needs !C.s
}
""",
    "spellings": """robot R {
  constant not: boolean = true
  component C { service s with request: std_srvs/msg/SetBool, response: std_srvs/SetBool }
  requirement s needs not x
}
""",
    "escapes": 'robot R { component C { incoming message m with identifier: "a\\d", type: none } }',
    "quotes": "robot R { component C { incoming message m with identifier: \u201c/m\u201d, type: none } }",
    "numbers": "robot R { constant a: double = .5 constant b: double = 1e-3 constant c: double = 2. }",
    "arrow": """robot R {
  component C {
    outgoing message m with type: boolean
    behaviour { initial state i { on response from m if value -> j } marked state j {} }
  }
}
""",
}
#: The beginnings of hints that state an edit, and such hints that no text here draws. None of the latter has an edit.
SAYING = ("write `", "add ", "leave ", "rename ", "did you mean")
UNSEEN = ("write `if` and `!` before the condition", "write `none`: no data type fits", "write `{}`")
#: Beginnings of hints without an edit, by the reason: they do not state an edit.
TOLD = {
    "only the author knows the missing part": (
        "compare double with double",
        "compare it with `value` when data arrives",
        "declare a `constant` for the whole string",
        "declare `datatype object",
        "declare `interface",
        "name the topic with a parameter",
        "rename the fleet, or the other element",
        'use a separate topic, such as `with { arm_done: "/arm" + text(number)',
        "give it another `identifier`, or use one of them for both",
        "write `Side[1]` or `Front` in",
        "write `on ",
        "write the name of the communication alone",
        "write the condition with `Front` itself",
        "write `text(i)` with an integer",
        "write `requirement each T: …` for each instance",
        "write one instance in the brackets",
        "declare `variable",
        "declare an object",
        "declare it from the object that has the array",
        "end it with",
        "for the data of a service or action, declare",
        "is a name missing before",
        "leave it out: this event carries no data",
        "leave one of these uses out",
        "store the relevant part in a variable",
        "name a type of kind",
        "narrow its range",
        "store it in a variable",
        "store the condition in a variable",
        "the `{` in line",
        "the units are",
        "convert it to an enum",
        "use only features of both",
        "write `Ahead(limit",
        "write `Bumper(topic",
        "write `gain(distance",
        "write a message from a component",
        "write a number, a space and a unit",
        "write a number that is in the range",
        "set another variable where the data arrives",
        "write a whole number: RoboSC never rounds",
        "write an integer from 1 on",
        "write an object value",
        "write `->` and the value",
        "write a larger one",
        "write a smaller one",
        "write another expression",
        "write the name of an array there",
        "write its content directly",
        "leave the folder out, or name another type",
        "write a requirement",
        "write an array, such as",
    ),
    "a construct must be rewritten": (
        "assign it `on canceled from",
        "use one type for both",
        "go to a state",
        "let `",
        "choose another name, such as `why`",
        "provide other data",
        "provide arrays as a whole",
        "provide objects as a whole",
        "read `error` at `on error from",
        "store it in a variable by `on error from",
        "write `on error from",
        "write `identifier` before all other clauses",
        "write `links` after all other clauses",
        "write `send: change` after the type",
        "a file has one robot or one library",
        "a name has only the letters",
        "an `after` has no condition",
        "compare an enum's values by `=` only",
        "compare integers, or give the integers smaller ranges",
        "compute it from `value`",
        "declare it from the type that `Endless` is from",
        "the rules of an enum read only",
        "add a parameter for this value",
        "declare the source and the target of the data",
        "give the integers smaller ranges",
        "move its states, variables and transitions",
        "write it as a requirement",
        "write such a definition in",
        "a requirement automaton has only states",
        "write the condition of a transition before",
        "write the properties of an object in braces",
        "write the text before the colon",
        "use literals, constants, operators",
        "write `=` and one expression instead of braces",
        "write `all`, `any` or `count`",
        "write `component name(parameter",
        "write `goto idle`",
        "write the condition with `C` itself",
        "write `if condition then value else value`",
        "write `mod(a, b)`",
        "write `parameter name: type = value` in the robot",
        "write `requirement at most",
        "write `after 3.0 s goto state`",
        "write `requirement never condition`",
        "write it in the intended state",
        "write `requirement b after a`",
        "write `requirement name: automaton",
        "write a transition for each case",
    ),
    "the repair is in another text": (
        "assign it in",
        "change the arguments",
        "source the setup of",
        "import only one of these",
        "in library `TankLibrary`",
        "correct it: until then",
        "restrict the reaction of the controller",
        "write an existing field",
    ),
}


def findings(path: Path, text: str | None = None) -> tuple[Reading, list[Diagnostic]]:
    documents = None if text is None else Documents({str(path): text})
    reading = read(path, [HERE / "libraries"], INTERFACES, documents)
    return reading, [*reading.findings, *check(reading.base, reading.findings, INTERFACES)]


@cache
def before(path: Path, text: str | None = None) -> tuple[Reading, list[Diagnostic]]:
    """Return the findings of a text before it is edited."""
    return findings(path, text)


def edited(text: str, edits: tuple[Edit, ...]) -> str:
    lines = text.split("\n")
    for edit in sorted(edits, reverse=True):
        span = edit.span
        before, behind = lines[span.line - 1][: span.column - 1], lines[span.end_line - 1][span.end_column - 1 :]
        lines[span.line - 1 : span.end_line] = (before + edit.text + behind).split("\n")
    return "\n".join(lines)


def like(finding: Diagnostic, others: list[Diagnostic]) -> int:
    """Return the number of findings with the same rule and message, wherever they are."""
    key = (finding.rule, LINE.sub("", finding.message))
    return sum((other.rule, LINE.sub("", other.message)) == key for other in others)


def ways(finding: Diagnostic) -> list[tuple[Edit, ...]]:
    return [*([finding.edits] if finding.edits else ()), *(way.edits for way in finding.alternatives)]


@pytest.mark.slow
@pytest.mark.parametrize("path", MODELS, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_an_edit_mends_its_finding(path: Path) -> None:
    reading, found = before(path)
    for finding in found:
        if finding.file == str(path):
            for edits in ways(finding):
                text = edited(reading.file.text.content, edits)
                _, after = findings(path, text)
                assert like(finding, after) < like(finding, found), text
                assert "syntax" not in {other.rule for other in after}, text


@pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS)
def test_an_edit_mends_what_is_no_syntax_or_no_name(text: str) -> None:
    """An edit of a name or a word of another language mends its finding.

    Text after a mended word may have a fault of its own, which the finding hid. Findings of the model without a fault
    are mended in that model only.
    """
    path = HERE / "nowhere.rscd"
    _, found = before(path, text)
    _, anyway = before(path, MODEL)
    for finding in found:
        for edits in ways(finding) if text == MODEL or not like(finding, anyway) else ():
            _, after = findings(path, edited(text, edits))
            assert like(finding, after) < like(finding, found), edited(text, edits)


@cache
def drawn() -> dict[str, bool]:
    """Return each hint that these texts draw, and whether edits follow it everywhere.

    Titles of alternatives are included.
    """
    texts = [*((path, None) for path in MODELS), *((HERE / "nowhere.rscd", text) for text in TEXTS.values())]
    found: dict[str, bool] = {}
    for path, text in texts:
        for finding in before(path, text)[1]:
            if finding.hint is not None and finding.file == str(path):
                found[finding.hint] = found.get(finding.hint, True) and bool(ways(finding))
                found |= {way.title: True for way in finding.alternatives if way.title != finding.hint}
    return found


@pytest.mark.slow
def test_every_hint_that_says_what_to_write_is_an_edit() -> None:
    told = [start for starts in TOLD.values() for start in starts]
    without = [hint for hint, is_edit in drawn().items() if not is_edit]
    assert [hint for hint in without if not hint.startswith(tuple(told))] == []
    assert [start for start in told if not any(hint.startswith(start) for hint in without)] == []


def test_no_hint_is_forgotten() -> None:
    """Each hint in the sources that states an edit is drawn by one of the texts."""
    modules = [*(PACKAGE / "language" / "checks").rglob("*.py"), *(PACKAGE / "language").glob("*.py")]
    known = [*drawn(), *(start for starts in TOLD.values() for start in starts)]
    written = [text for path in modules for text in literals(path) if text.startswith(SAYING)]
    assert len(written) > len(TOLD)
    assert [text for text in written if not any(text in hint for hint in known) and not text.startswith(UNSEEN)] == []


def literals(path: Path) -> Iterator[str]:
    """Return the strings of a module without trailing blanks; of formatted strings, the beginning."""
    tree = ast.parse(path.read_text())
    inside = {id(part) for node in ast.walk(tree) if isinstance(node, ast.JoinedStr) for part in node.values[1:]}
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in inside:
            yield node.value.rstrip()
