"""Automatic edits never damage a text: they keep comments and leave a model no worse than before."""

from collections import Counter
from collections.abc import Sequence
from functools import lru_cache, partial
from pathlib import Path
from typing import NamedTuple

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robosc.base.diagnostics import Diagnostic, Edit, Severity
from robosc.language.checks import check
from robosc.language.checks.automatic_edits import Safety, objection, safe_edits, safety_of
from robosc.language.reading import Reading, read
from robosc.language.text import Documents, Text
from robosc.language.tokens import Kind, Tokens
from tests.language.checks.test_mending import HERE, INTERFACES, MODELS, TEXTS, ways

PATH = HERE / "nowhere.rscd"
#: All models that violate a rule, and texts with syntax errors and unknown names.
PATHS = {f"{path.parent.name}/{path.stem}": path for path in MODELS} | dict.fromkeys(TEXTS, PATH)
BROKEN = {name: TEXTS.get(name) or path.read_text(encoding="utf-8") for name, path in PATHS.items()}


class Checked(NamedTuple):
    reading: Reading
    findings: Sequence[Diagnostic]


@lru_cache(64)
def checked(content: str, path: Path = PATH) -> Checked:
    reading = read(path, [HERE / "libraries"], INTERFACES, Documents({str(path): content}))
    return Checked(reading, [*reading.findings, *check(reading.base, reading.findings, INTERFACES)])


def fixed(content: str, path: Path = PATH) -> str:
    """Return the text after all rounds of edits of findings that have one edit."""
    for _ in range(20):
        found = checked(content, path)
        edits = safe_edits(found, partial(checked, path=path))
        if not edits:
            return content
        content = found.reading.file.text.after(edits)
    raise AssertionError(f"edits go on for ever: {content}")


def comments(content: str) -> list[str]:
    return [content[start:end] for start, end in Tokens(content).comments]


def strings(content: str) -> Counter[str]:
    return Counter(token.text for token in Tokens(content) if token.kind in {Kind.STRING, Kind.OPEN_STRING})


def of_rules(findings: Sequence[Diagnostic]) -> Counter[str]:
    return Counter(finding.rule for finding in findings)


def baited(content: str, every: int = 1) -> str:
    """Insert a comment before every n-th token. It repeats the tokens around it and contains a string."""
    tokens = [token for token in Tokens(content) if token.kind is not Kind.OPEN_COMMENT]
    pieces, behind = [], 0
    for index, token in enumerate(tokens):
        # The sign of a bound and its number are one word.
        signed = tokens[index - 1].text == "-" or token.text == "-"
        if index and index % every == 0 and not signed:
            bait = " ".join(other.text for other in tokens[index - 2 : index + 6] if "*/" not in other.text)
            pieces += [content[behind : token.start], f' /* {bait} "no" }} */ ']
            behind = token.start
    return "".join([*pieces, content[behind:]])


def test_comments_do_not_change_what_is_found() -> None:
    """This ensures that later tests try the same edits as for the texts without comments."""
    for name in list(BROKEN)[::8]:
        # The numbers of `numbers` are several words: a comment between them changes what they are.
        if "fault" not in name and "foreign" not in name and name != "numbers":
            before, after = (checked(content, PATHS[name]).findings for content in (BROKEN[name], baited(BROKEN[name])))
            assert [found.rule for found in before] == [found.rule for found in after], name


@pytest.mark.slow
@pytest.mark.parametrize("name", BROKEN)
def test_no_way_to_mend_a_finding_changes_a_comment(name: str) -> None:
    content = baited(BROKEN[name])
    before = checked(content, PATHS[name])
    kept = comments(content)
    for finding in before.findings:
        for edits in ways(finding) if finding.file == str(PATHS[name]) else ():
            assert comments(before.reading.file.text.after(edits)) == kept, (finding.message, edits)


@pytest.mark.slow
@pytest.mark.parametrize("name", BROKEN)
def test_edits_that_do_no_harm_leave_no_more_syntax_errors(name: str) -> None:
    content = BROKEN[name]
    before = checked(content, PATHS[name])
    for finding in before.findings:
        for edits in ways(finding) if finding.file == str(PATHS[name]) else ():
            safety = safety_of(finding, edits, before, partial(checked, path=PATHS[name]))
            after = checked(before.reading.file.text.after(edits), PATHS[name])
            counts, left = of_rules(before.findings), of_rules(after.findings)
            worse = left["syntax"] > counts["syntax"] or (finding in after.findings and left >= counts)
            assert safety is Safety.HARMFUL if worse else True, (finding.message, edits)
            if safety is Safety.SAFE and finding.rule != "syntax":
                assert left <= counts


@pytest.mark.slow
@pytest.mark.parametrize("name", BROKEN)
def test_automatic_edits_make_nothing_worse(name: str) -> None:
    assert_no_worse(baited(BROKEN[name], 3), PATHS[name])


def assert_no_worse(content: str, path: Path) -> None:
    """Check that unambiguous edits add no finding, except findings that a syntax error hid."""
    after = fixed(content, path)
    assert comments(after) == comments(content)
    before, found = (of_rules(checked(text, path).findings) for text in (content, after))
    assert found["syntax"] <= before["syntax"]
    if not before["syntax"]:
        assert found <= before, after
        assert found != before or after == content


@pytest.mark.parametrize(
    ("old", "new", "safety"),
    [
        ("oops", "shut", Safety.SAFE),
        ("goto oops", "do x := 1", Safety.DOUBTFUL),
        ("oops", "oops", Safety.HARMFUL),
        ("oops", "shut }", Safety.HARMFUL),
        ("oops /* keep */", "shut", Safety.HARMFUL),
        ("oops", "shut /* new */", Safety.HARMFUL),
    ],
)
def test_effect_of_an_edit(old: str, new: str, safety: Safety) -> None:
    content = """robot R {
  component C {
    incoming message go with type: none
    behaviour { initial marked state shut { on request to go goto oops /* keep */ } }
  }
}"""
    before = checked(content)
    (finding,) = before.findings
    start = content.index(old)
    edit = Edit(before.reading.file.text.span(start, start + len(old)), new)
    assert safety_of(finding, [edit], before, checked) is safety


FRAGMENTS = ("/* no, send: change } */", '/* "state idle" */', "// goto idle { }\n", "/* { */", "/* marked initial */")


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(name=st.sampled_from(sorted(BROKEN)), data=st.data())
def test_comments_anywhere(name: str, data: st.DataObject) -> None:
    tokens = list(Tokens(BROKEN[name]))
    places = data.draw(st.lists(st.integers(0, len(tokens) - 1), max_size=12, unique=True), label="places")
    content = BROKEN[name]
    for place in sorted(places, reverse=True):
        start = tokens[place].start
        content = content[:start] + data.draw(st.sampled_from(FRAGMENTS)) + content[start:]
    assert_no_worse(content, PATHS[name])


@pytest.mark.slow
@settings(max_examples=40, deadline=None)
@given(name=st.sampled_from(sorted(BROKEN)), data=st.data())
def test_words_that_are_missing_anywhere(name: str, data: st.DataObject) -> None:
    """Damaged texts are mended or remain as they are."""
    tokens = list(Tokens(BROKEN[name]))
    content = BROKEN[name]
    for place in sorted(data.draw(st.sets(st.integers(1, len(tokens) - 1), max_size=3), label="places"), reverse=True):
        token = tokens[place]
        new = data.draw(st.sampled_from(["", "}", "{", ",", "state", "^", '"', "goto x"]), label="word")
        content = content[: token.start] + new + content[token.end :]
    assert_no_worse(content, PATHS[name])


ROBOT = """robot Cart {
  component Drive {
    incoming message go with type: none
    outgoing message scan with type: boolean
    behaviour {
      initial marked state idle { on response from scan goto moving }
      state moving { on request to go goto idle }
    }
  }
}
"""


def test_only_the_clause_is_left_out() -> None:
    content = ROBOT.replace("scan with", "scan /* , send: change is for commands */ with").replace(
        "boolean", "boolean /* of the laser */ , /* no */ send: change // at once"
    )
    after = content.replace("*/ , /*", "*/ /*").replace(" send: change //", " //")
    found = checked(content)
    (offered,) = [way for finding in found.findings for way in finding.alternatives if "send: change" in way.title]
    assert found.reading.file.text.after(offered.edits) == after


@pytest.mark.parametrize("comment", ["/* state moving of old */", "// state moving\n"])
def test_the_name_is_renamed_and_no_comment(comment: str) -> None:
    content = ROBOT.replace("state moving", f"state {comment} idle")
    before = checked(content)
    (finding,) = [found for found in before.findings if found.rule == "unique-state"]
    (way,) = finding.alternatives
    text = before.reading.file.text
    assert text.after(way.edits) == content.replace(f"{comment} idle", f"{comment} idle_2")


def test_a_point_in_a_comment_is_none() -> None:
    content = """robot R {
  datatype object P { x: double }
  datatype object Q { points: array(P) }
  component C {
    outgoing message m with type: Q
    behaviour {
      variable d: double
      marked initial state s { on response from m do d := value.points /* a.b */ . /* c.d */ x }
    }
  }
}
"""
    found = checked(content)
    (offered,) = found.findings[0].alternatives
    assert found.reading.file.text.after(offered.edits) == content.replace(". /* c.d */ x", "[0]. /* c.d */ x")


@pytest.mark.parametrize(
    ("name", "close"),
    [("unlocked", "locked"), ("not_locked", "locked"), ("door_2_open", "door_1_open"), ("locekd", "locked")],
)
def test_a_name_is_offered_and_never_replaced(name: str, close: str) -> None:
    """The closest name can mean the opposite."""
    content = f"""robot Gate {{
      component Gate {{
        incoming message go with type: none
        behaviour {{ initial marked state locked {{}} marked state door_1_open {{}} }}
      }}
      requirement go needs Gate.{name}
    }}"""
    (finding,) = [finding for finding in checked(content).findings if "unreachable" not in finding.rule]
    assert finding.hint == f"did you mean `{close}`?"
    assert finding.edits == ()
    assert [way.title for way in finding.alternatives] == [f"write `{close}`"]
    assert fixed(content) == content


TIME = "write `after 3.0 s goto state` in a state, or `after 500 ms without message goto state` for a silent topic"
CONDITION = "write the condition after the event, as in `on … if … do … goto …`"
OFFERED = """robot Cart {
  parameter gain: double(0.5..9.5) = 1.0
  component Base {
    incoming message go with type: none
    outgoing message scan with type: boolean
    service check with request: std_srvs/SetBool, response: std_srvs/SetBool
    behaviour {
      variable near: boolean
      variable load: integer(0..3)
      initial marked state idle {
        on response from scan do near := value goto moving
        on request to check
        on response from check
        on error from check do load := 1
      }
      state moving {
        on request to go
        on response from scan if near = value goto idle
        after 5.0 s without scan goto idle
      }
    }
  }
  requirement go needs Base.near or Base.load = 2
  requirement always Base.idle or Base.moving
}
"""


@pytest.mark.parametrize(
    ("old", "new", "offers"),
    [
        ("without scan", "with scan", ["without"]),
        ("go needs", "go neednt", ["needs"]),
        ("0.5..9.5", "0.5...9.5", ["a range has two points, such as `0..5`"]),
        ("Base.near or", "Base.check or", ["check.running"]),
        ("on request to go", "on error from go", ["write `on request to go`", "leave the transition out"]),
        ("Base.load = 2", "Base.load / 2 = 1", ["write `1.0`: `/` is a division of doubles"]),
        ("near = value", "near == value == true", ["="]),
        ("near = value", "near & value == true", ["and"]),
        ("requirement always", "always", ["requirement always", "property always"]),
        ("near = value", "near == value\n == true", ["="]),
        ("Base.near or Base.load = 2", "Base.near; (Base.load = 2)", ["leave it out: RoboSC has no semicolons"]),
        ("scan do near := value goto moving", "scan timeout 3 s goto moving", [TIME]),
        ("on request to check", "when near goto moving", ["if", "transition if"]),
        ("on response from scan do", "if near on response from scan do", [CONDITION]),
        ("requirement go", "requirement { go => check }", [","]),
    ],
)
def test_an_edit_that_may_mean_something_else_is_only_offered(old: str, new: str, offers: list[str]) -> None:
    assert [finding for finding in checked(OFFERED).findings if finding.severity is Severity.ERROR] == []
    content = OFFERED.replace(old, new)
    assert content != OFFERED
    assert fixed(content) == content
    titles = [way.title for finding in checked(content).findings for way in finding.alternatives]
    assert [offer for offer in offers if offer not in titles and f"write `{offer}`" not in titles] == []


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("near = value", "near == value"),
        ("Base.near or", "Base.near ||"),
        ("or Base.load = 2", "or Base.load = 2;"),
        ("or Base.load = 2", "or True"),
        ("always Base.idle or Base.moving", "always Base.idle implies Base.moving"),
        ("integer(0..3)", "integer[0..3]"),
        ("5.0 s", "5.0 seconds"),
        ("5.0 s", "5.0 minutes"),
        ("go with type", 'go with topic: "/go", type'),
        ("requirement go needs", "requirement go, check needs"),
        ("variable near", "variable\N{NO-BREAK SPACE}near"),
        ("on error from check", "on cancelled from drive"),
    ],
)
def test_a_word_or_symbol_with_one_meaning_is_mended(old: str, new: str) -> None:
    drive = "    action drive with request: none, response: none, feedback: none\n    behaviour"
    base = OFFERED.replace("    behaviour", drive) if "drive" in new else OFFERED
    usual = {"||": "or", "True": "true", "implies": "=>", "[": "(", "]": ")", "seconds": "s", "minutes": "min"}
    usual |= {"topic": "identifier", "go, check": "{ go, check }", "cancelled": "canceled", "==": "=", ";": ""}
    mended = new.replace("\N{NO-BREAK SPACE}", " ")
    for word, other in usual.items():
        mended = mended.replace(word, other)
    assert fixed(base.replace(old, new)) == base.replace(old, mended)


def test_edits_beside_instances_of_fleets() -> None:
    fleet = """robot R {
  component Station(ns: string) {
    incoming message enter with identifier: ns + "/enter", type: none
    outgoing message done with identifier: ns + "/done", type: none
    outgoing message more with identifier: ns + "/more", type: none
    behaviour {
      initial marked state s {
        on response from done goto t
        on response from more if Cell[1].t goto t
      }
      state t { on response from done goto s }
    }
  }
  component Cell[1..2] is Station("/cell" + text(number))
  requirement { Cell[1].enter, Cell[2].enter } needs Cell[1].s
}
"""
    assert fixed(fleet.replace("{ Cell[1].enter, Cell[2].enter }", "Cell[1].enter, Cell[2].enter")) == fleet
    found = checked(fleet.replace("on response from more if Cell[1].t", "if Cell[1].t on response from more"))
    ways = [way for finding in found.findings for way in finding.alternatives if way.title == CONDITION]
    assert [found.reading.file.text.after(way.edits) for way in ways] == [fleet]


def test_an_arrow_is_no_implication_where_a_state_may_follow() -> None:
    content = ROBOT.replace("goto moving", "if true -> moving")
    (finding,) = [finding for finding in checked(content).findings if finding.rule == "syntax"]
    assert finding.hint == "write `goto`, or `=>` for an implication"
    assert fixed(content) == content


def test_an_edit_that_reveals_an_error_on_its_line_is_not_made() -> None:
    """The text `! moving = 3` negates only the first name."""
    content = ROBOT.replace("behaviour {", "behaviour { variable speed: integer(0..3) = 0").replace(
        "goto moving", "if not speed = 3 goto moving"
    )
    assert fixed(content) == content


@pytest.mark.parametrize("brace", ["}", "{"])
def test_no_brace_goes_behind_another_error(brace: str) -> None:
    """The brace may be surplus only because of that error."""
    content = ROBOT.replace("goto moving }", f"goto moving }} {brace}").replace("with type: none", "3")
    found = checked(content)
    surplus = [finding for finding in found.findings if "one too many" in finding.message]
    assert [finding.edits for finding in surplus] == [()] * len(surplus)
    assert {finding.hint for finding in surplus} <= {"correct the error in line 3 first"}
    assert Counter(fixed(content))[brace] == Counter(content)[brace]


def test_a_lone_brace_too_many_is_only_offered() -> None:
    """An earlier one may be the wrong one."""
    content = ROBOT.replace("goto moving }", "goto moving }\n    }\n   ")
    assert fixed(content) == content
    found = checked(content)
    (offered,) = found.findings[0].alternatives
    assert offered.title == "leave it out"
    assert found.reading.file.text.after(offered.edits) == ROBOT.replace("goto moving }", "goto moving }\n    \n   ")


def test_an_opening_brace_too_many_goes() -> None:
    assert fixed(ROBOT.replace("behaviour {", "behaviour { {")) == ROBOT.replace("behaviour {", "behaviour { ")


DOORS = """robot R {
  datatype enum Level from double to { value > 1.0 -> high default -> low }
  constant c: integer = 1
  component Door {
    action fold with request: none, response: none, feedback: none
    incoming message togo with type: none
    behaviour {
      variable n: integer(0..3)
      variable eager: boolean
      variable locked: boolean
      initial marked state idle { on request to togo do n := 2 goto idle }
    }
  }
  requirement togo needs Door.eager
}
"""


@pytest.mark.parametrize(
    ("old", "new", "keyword"),
    [
        ("action fold", "actionfold", "after `action`"),
        ("component Door", "componentDoor", "after `component`"),
        ("datatype enum", "datatypeenum", "after `datatype`"),
        ("initial marked", "initialmarked", "after `initial`"),
        ("request to togo", "requesttotogo", "after `request`"),
        ("goto idle", "gotos", "after `goto`"),
        ("feedback: none", "feedback0.5 none", "after `feedback`"),
        ("type: none\n    behaviour", "type: none nonebehaviour", "before `behaviour`"),
    ],
)
def test_no_keyword_takes_the_place_of_a_longer_word(old: str, new: str, keyword: str) -> None:
    content = DOORS.replace(old, new)
    assert content != DOORS
    assert f"is a space missing {keyword}?" in {finding.hint for finding in checked(content).findings}
    assert fixed(content) == content


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("= 1", "= ()"),
        ("= 1", "= 1.0*/"),
        ("eager: boolean", "eager:: boolean"),
        ("Door.eager", "Door.{"),
        (":= 2", ":= := 2"),
        ("locked: boolean", "locked: type = true"),
        ("-> high default", "default"),
        ("1.0 -> high default -> low", "1.0\n default -> low"),
        ("default -> low", "default"),
    ],
)
def test_nothing_is_written_before_what_is_no_name_or_value(old: str, new: str) -> None:
    content = DOORS.replace(old, new)
    assert content != DOORS
    syntax = [finding for finding in checked(content).findings if finding.rule == "syntax"]
    assert syntax
    assert not any(finding.edits for finding in syntax)
    assert fixed(content) == content


def test_the_name_of_a_type_that_is_a_keyword() -> None:
    content = DOORS.replace("Level", "^type").replace("locked: boolean", "locked: type = low")
    assert fixed(content) == content.replace("locked: type", "locked: ^type")


def test_a_syntax_error_that_becomes_another_one_stays() -> None:
    content = DOORS.replace("action fold", "actionfold")
    before = checked(content)
    (finding,) = [found for found in before.findings if found.rule == "syntax"]
    text, edits = before.reading.file.text, [at(content, "actionfold", "action")]
    why = objection(before, checked(text.after(edits)), {text.file: edits}, [finding])
    assert why == "line 5: found `request`, expected `with`"


def test_errors_of_one_item_of_which_one_hides_the_next() -> None:
    content = DOORS.replace("needs Door.eager", "needs Door.eager || Door.locked && Door.eager")
    assert fixed(content) == content.replace("||", "or").replace("&&", "and")
    hopeless = DOORS.replace("needs Door.eager", "needs Door.eager || Door.locked && Door.{")
    assert fixed(hopeless) == hopeless


def objected(content: str, *edits: Edit) -> str | None:
    before = checked(content)
    text = before.reading.file.text
    return objection(before, checked(text.after(edits)), {text.file: edits})


def at(content: str, old: str, new: str) -> Edit:
    start = content.index(old)
    return Edit(Text("", content).span(start, start + len(old)), new)


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        ("robot Cart", "robot Van", None),
        ("state idle", "statee idle", "line 6: "),
        ("goto idle", "goto moving", "line 7: no marked state"),
        ("state moving", "state idle", "line 6: "),
        ("robot", "/* robot */ robot", "a comment would change"),
        ("go with", 'go with identifier: "go", ', None),
        ("message go", "message went", "`go` would refer to something else"),
        ("    incoming", "    /* incoming */ incoming", "a comment would change"),
    ],
)
def test_what_is_worse(old: str, new: str, why: str | None) -> None:
    found = objected(ROBOT, at(ROBOT, old, new))
    assert (found is None) == (why is None), found
    assert why is None or found.startswith(why.split("`")[0])


def test_a_string_is_replaced_as_a_whole_or_not_at_all() -> None:
    content = ROBOT.replace("go with", 'go with identifier: "/go", ')
    assert objected(content, at(content, '"/go"', '"/stop"')) is None
    assert objected(content, at(content, "/go", "/stop")) == "a string would change"


@pytest.mark.parametrize(
    "line",
    [
        "variable max speed: boolean",
        "variable speed speed: integer(0..9)",
        "initial state off { } variable x : enum = 1",
    ],
)
def test_no_chain_of_guesses_that_ends_in_an_error(line: str) -> None:
    text = f"robot R {{ component C {{ outgoing message m with type: none behaviour {{\n{line}\n}} }} }}\n"
    assert fixed(text) == text


def test_no_guess_at_names_of_a_library_that_is_missing() -> None:
    text = """robot R {
      component Weigher from Nowhere import Scale
      component Base { incoming message stop with type: none }
      requirement stop needs Weigher.last = Weight.heavy
    }"""
    assert fixed(text) == text
    assert [finding.message for finding in checked(text).findings] == ["there is no library `Nowhere`"]


@pytest.mark.parametrize(
    "line",
    [
        "requirement go needs Gate.mode = 0 or 1",
        "datatype enum Door from integer to { 0 -> closed 1 -> open default -> unknown }",
        "assert Gate.locked",
        "constant version: string = 1.10",
        'datatype enum Order from string to { value[0] = "S" -> stop default -> drive }',
        "component Clock { behaviour { initial marked state s { every 3.0 s do t := 1 } variable t: integer(0..1) } }",
    ],
)
def test_an_edit_that_may_change_the_meaning_is_offered(line: str) -> None:
    content = f"""robot Gate {{
  component Gate {{
    incoming message go with type: none
    outgoing message set with type: integer(0..5)
    behaviour {{ variable mode: integer(0..5) initial marked state locked {{ on response from set do mode := value }} }}
  }}
  {line}
}}
"""
    assert any(finding.severity is Severity.ERROR for finding in checked(content).findings)
    assert fixed(content) == content
