"""Each syntax error is found exactly once, and none hides other errors or correct parts."""

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from robosc.base.diagnostics import as_text
from robosc.language.reading import read
from robosc.model import robosc as rsc
from robosc.model.semantics.naming import ROBOSC_KEYWORDS
from tests.language.texts import places, reading, underlined

MODEL = """
robot Right {
  interface laser use LaserScan from sensor_msgs

  datatype object LaserScan {
    ranges: array(double)
    count: integer(0..10)
  }

  datatype enum Distance from LaserScan to {
    value.ranges[0] > 0.5 and value.ranges[90] <= 1.0 -> free
    default -> blocked
  }

  component Scanner {
    outgoing message scan with identifier: "/scan", type: Distance links laser

    behaviour {
      variable distance: Distance = blocked

      on response from scan do distance := value

      initial marked state waiting {
        transition if distance = free goto driving
      }

      state driving {
        transition if distance = blocked goto waiting
      }
    }
  }

  component Motor {
    incoming message move with identifier: "/move", type: LaserScan links laser
    service reset with request: none, response: boolean links laser
    action turn with request: none, response: none, feedback: double links laser
  }

  component EmergencyStop from EmergencyStopLibrary import EmergencyStop

  requirement {move, turn} needs EmergencyStop.in_service and Scanner.driving
  requirement Scanner.waiting disables reset

  provide move with { count: 3 } if Scanner.distance = free
}
"""


def changed(text: str, old: str, new: str) -> str:
    assert text.count(old) == 1, f"{old} is there {text.count(old)} times"
    return text.replace(old, new)


#: One fault each: the original text, its replacement, the text at the finding, and the message or hint.
FAULTS = [
    ("robot Right", "robto Right", "robto", "expected `robot` or `library`"),
    ("robot Right", "robot", "{", "expected a name"),
    ("interface laser", "interfce laser", "interfce", "did you mean `interface`?"),
    ("laser use", "laser", "LaserScan", "expected `use`"),
    ("interface laser use", "interface use", "LaserScan", "is a name missing before `use`?"),
    ("object LaserScan {", "object LaserScan", "ranges", "expected `{`"),
    ("object LaserScan {", "objct LaserScan {", "objct", "did you mean `object`?"),
    ("ranges: array", "ranges array", "array", "expected `:`; write `:` before it"),
    ("array(double)", "array(double", "", "expected `)`"),
    ("0..10", "0...10", ".", "expected a whole number"),
    ("LaserScan to {", "LaserScan to", "value", "expected `{`"),
    ("value.ranges[0]", "value.ranges[", ">", "expected a whole number"),
    ("<= 1.0", "=< 1.0", "=<", "write `<=`"),
    (" and value", " && value", "&&", "write `and`"),
    ("-> free", "=> free", "", "expected an operator or `->`"),
    ("1.0 -> free", "1.0 > free", "", "found `default` in line 11, expected an operator or `->`; write `->`"),
    ("default -> blocked", "default blocked", "blocked", "expected `->`; write `->`"),
    ("default -> blocked", "default -> ", "", "expected a name"),
    ("outgoing message", "outgoing mesage", "mesage", "did you mean `message`?"),
    ("outgoing message", "message", "message", "expected `incoming`, `outgoing`"),
    ('"/scan"', '"/scan', '"/scan, type: Distance links laser', "this string is not closed"),
    ('"/scan", type', '"/scan" type', "type", "expected `,`; write `,` before it"),
    (
        '"/move", type: LaserScan',
        '"/move", send: change, type: LaserScan',
        "send",
        "write `send: change` after the type",
    ),
    (
        'identifier: "/move", type: LaserScan',
        'type: LaserScan, identifier: "/move"',
        "identifier",
        "before all other clauses",
    ),
    (
        "links laser\n    service",
        "links laser, send: change\n    service",
        ",",
        "write `links` after all other clauses",
    ),
    ("links laser\n    service", ", send: once links laser\n    service", "once", "write `send: change`, or leave"),
    ("links laser\n\n    behaviour", "link laser\n\n    behaviour", "link", "did you mean `links`?"),
    ("behaviour {", "behavior {", "behavior", "did you mean `behaviour`?"),
    ("Distance = blocked\n\n", "Distance := blocked\n\n", ":=", "write `=`"),
    ("do distance := value", "do distance = value", "=", "write `:=`"),
    ("do distance := value", "do distance := value;", ";", "leave it out"),
    ("initial marked state", "intial marked state", "intial", "did you mean `initial`?"),
    ("state driving {", "state driving", "transition", "expected `{`"),
    ("state driving {", "state driving { {", "{", "unexpected `"),
    ("behaviour {", "behaviour {\n      parameter p: double = 1.0", "parameter", "the robot, a library or a component"),
    ("behaviour {", "behaviour {\n      constant c: double = 1.0", "constant", "a definition in the robot"),
    ("goto driving\n      }", "goto driving\n", "state", "the `{` in line 22 is not closed"),
    ("goto waiting\n      }", "goto waiting\n      } }", "}", "unexpected `"),
    ("on response from scan", "on respons from scan", "respons", "did you mean `response`?"),
    ("from scan do", "from scan do near := true if true do", "if", "before `do` and `goto`"),
    ("goto driving", "goto", "", "expected a name"),
    ("and Scanner.driving", "and Scanner.on", "on", "found `on`, expected a name"),
    ("response: boolean", "respnse: boolean", "respnse", "did you mean `response`?"),
    ("feedback: double", "", "links", "expected `feedback`"),
    ("import EmergencyStop", "", "", "expected `import`"),
    ("{move, turn} needs", "{move, turn} when", "when", "write `needs`"),
    ("{move, turn} needs", "request to move needs", "needs", "without the word for its event"),
    ("disables reset", "disables request to reset", "request", "without the word for its event"),
    ("{move, turn} needs", "{move, turn needs", "needs", "expected `,` or `}`"),
    ("and Scanner.driving", "and", "", "expected an expression"),
    ("and Scanner.driving", "and (Scanner.driving", "", "expected an operator or `)`"),
    ("and Scanner.driving", "-> Scanner.driving", "->", "write `=>`"),
    ("and Scanner.driving", "and state", "state", "write `^state`"),
    ("disables reset", "disable reset", "disable", "did you mean `disables`?"),
    ("{ count: 3 }", "count: 3 }", ":", "write the properties of an object in braces"),
    ("{ count: 3 }", "{ count: 3, }", "}", "leave out the comma before it"),
    ("count: 3", "count = 3", "=", "write `:`"),
    ("count: 3", "count: 3.", ".", "digits on both sides"),
    (
        "count: 3",
        "co\N{LATIN SMALL LETTER U WITH DIAERESIS}nt: 3",
        "co\N{LATIN SMALL LETTER U WITH DIAERESIS}nt",
        "letters a to z",
    ),
    ("Scanner.distance = free\n}", "Scanner.distance = free\n", "", "the `{` in line 1 is not closed"),
    ("Scanner.distance = free\n}", "Scanner.distance = free\n} }", "}", "expected the end of the file"),
    ("Scanner.distance = free\n}", "Scanner.distance = free\n} robot X { }", "robot", "one robot or one library"),
    ("Scanner.distance = free\n}", "Scanner.distance = free\n} /* end", "/* end", "this comment is not closed"),
]


def test_the_model_has_no_fault(tmp_path: Path) -> None:
    assert reading(tmp_path, MODEL).findings == []


@pytest.mark.parametrize(("old", "new", "at", "says"), FAULTS, ids=[f"{old}->{new}" for old, new, *_ in FAULTS])
def test_one_fault_is_one_finding(tmp_path: Path, old: str, new: str, at: str, says: str) -> None:
    found = reading(tmp_path, changed(MODEL, old, new))
    assert underlined(found) == [("syntax", at)]
    (finding,) = found.findings
    assert says in f"{finding.message}; {finding.hint}"


def test_ten_faults_are_ten_findings(tmp_path: Path) -> None:
    text = MODEL
    faults = (
        *(("laser use", "laser used"), ("count: integer(0..10)", "count: integer(0,10)"), (" and value", " && value")),
        *(("outgoing message scan", "outgoing message"), ("do distance := value", "do distance = value")),
        *(("distance = free goto", "distance = fre goto"), ("service reset with", "service reset")),
        *(("in_service and", "in_servce and"), ("disables reset", "disable reset"), ("{ count: 3 }", "{ count 3 }")),
    )
    for old, new in faults:
        text = changed(text, old, new)
    found = reading(tmp_path, text)
    assert [(line, rule) for _, line, rule in places(found)] == [
        *((2, "syntax"), (6, "syntax"), (10, "syntax"), (15, "syntax"), (20, "syntax")),
        *((23, "unresolved-reference"), (34, "syntax"), (40, "unresolved-reference"), (41, "syntax"), (43, "syntax")),
    ]


def test_what_has_no_fault_is_read(tmp_path: Path) -> None:
    text = changed(MODEL, "and Scanner.driving", "and (Scanner.driving")
    text = changed(text, "service reset with request", "service reset with rquest")
    base = reading(tmp_path, changed(text, "distance = free goto", "distance == free goto")).base
    assert isinstance(base, rsc.Robot)
    kinds = [definition.eClass.name for definition in base.definitions]
    assert kinds == [
        *("Interface", "ObjectDataType", "EnumDataType", "Component", "Component", "Component"),
        *("DisablesRequirement", "ProvideStatement"),
    ]
    motor = base.definitions[4].type
    assert [definition.name for definition in motor.definitions] == ["move", "turn"]
    states = [element for element in base.eAllContents() if isinstance(element, rsc.State)]
    assert [(state.name, len(state.transitions)) for state in states[:2]] == [("waiting", 0), ("driving", 1)]


def test_a_missing_brace_keeps_definitions_in_their_places(tmp_path: Path) -> None:
    text = changed(MODEL, "goto waiting\n      }\n    }\n  }", "goto waiting\n      }\n    }")
    found = reading(tmp_path, text)
    assert underlined(found) == [("syntax", "component")]
    assert found.base is not None
    assert [definition.name for definition in found.base.definitions if isinstance(definition, rsc.Component)] == [
        *("Scanner", "Motor", "EmergencyStop"),
    ]


def test_a_name_that_is_missing_is_not_taken_from_the_next_line(tmp_path: Path) -> None:
    text = changed(changed(MODEL, "1.0 -> free", "1.0 ->"), "goto waiting", "goto\n        on response from scan")
    found = reading(tmp_path, text)
    assert places(found) == [("model.rscd", 10, "syntax"), ("model.rscd", 27, "syntax")]
    assert {finding.message.rpartition(", ")[2] for finding in found.findings} == {"expected a name"}


def test_without_a_first_line_the_definitions_are_still_checked(tmp_path: Path) -> None:
    text = changed(changed(MODEL, "robot Right {", "robot {"), "Scanner.waiting", "Scanner.waitng")
    found = reading(tmp_path, text)
    assert underlined(found) == [("syntax", "{"), ("unresolved-reference", "waitng")]


@pytest.mark.parametrize("statement", ["requirement m needs true", "provide m with 1"])
def test_a_library_holds_no_statements(tmp_path: Path, statement: str) -> None:
    found = reading(
        tmp_path,
        f"library L {{ component C {{ incoming message m with type: none }} {statement} interface i use T of p }}",
    )
    assert underlined(found) == [("syntax", statement.split(maxsplit=1)[0]), ("syntax", "of")]
    assert found.findings[0].message == f"a library has no {statement.split(maxsplit=1)[0]} statements"


@pytest.mark.parametrize("text", ["", " \n", "// nothing\n", "/* nothing */"])
def test_an_empty_file_is_one_finding(tmp_path: Path, text: str) -> None:
    found = reading(tmp_path, text)
    assert [finding.message for finding in found.findings] == [
        "found the end of the file, expected `robot` or `library`"
    ]
    assert found.base is None


@pytest.mark.parametrize(
    ("statement", "at"),
    [
        (f"requirement m needs {'(' * 5000}true{')' * 5000}", "("),
        (f"requirement m needs {'!' * 5000}true", "!"),
        (f"provide m with {'{a:' * 5000}1{'}' * 5000}", "{"),
        (f"datatype object O {{ p: {'array(' * 5000}none{')' * 5000} }}", "("),
    ],
)
def test_what_is_nested_too_deep_is_a_finding(tmp_path: Path, statement: str, at: str) -> None:
    found = reading(tmp_path, f"robot R {{ component C {{ incoming message m with type: none }} {statement} }}")
    assert underlined(found) == [("syntax", at)]


def test_nothing_stands_behind_the_end_of_a_text(tmp_path: Path) -> None:
    found = reading(tmp_path, "robot R { component C { behaviour { initial marked state s { }")
    assert str(found.base.definitions[0].source) == "model.rscd:1:11-1:63"


def test_forty_levels_are_not_too_deep(tmp_path: Path) -> None:
    nested = f"{'(!' * 20}true{')' * 20}"
    text = f"robot R {{ component C {{ incoming message m with type: none }} requirement m needs {nested} }}"
    assert reading(tmp_path, text).findings == []


SYMBOLS = "{ } ( ) [ ] . , : := = => -> - + * / ! != < <= > >= .. ; ^ ' \" // /* */ @"
WORDS = [*sorted(ROBOSC_KEYWORDS), *SYMBOLS.split()]
WORDS += ["name", "Other", "0", "1.5", '"text"', "\n", "\u00e9", "\0", "^state"]


@settings(deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(words=st.lists(st.sampled_from(WORDS), max_size=40), framed=st.booleans())
def test_no_words_are_too_strange(tmp_path: Path, words: list[str], framed: bool) -> None:
    text = " ".join(words)
    path = tmp_path / "soup.rscd"
    path.write_text(f"robot R {{ {text} }}" if framed else text)
    found = read(path)
    assert found.base is not None or found.findings
    as_text.render(found.findings, found.texts)


PIECES = MODEL.replace("\n", " \n ").split(" ")


@pytest.mark.slow
@settings(deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.lists(
        st.tuples(st.integers(0, len(PIECES) - 1), st.sampled_from([None, *WORDS]) | st.text(max_size=3)),
        min_size=1,
        max_size=4,
    )
)
def test_no_damage_is_too_bad(tmp_path: Path, damages: list[tuple[int, str | None]]) -> None:
    pieces = list(PIECES)
    for index, word in damages:
        pieces[index] = "" if word is None else word
    path = tmp_path / "damaged.rscd"
    path.write_bytes(" ".join(pieces).encode("utf-8", "surrogatepass"))
    found = read(path)
    last = found.texts[str(path)].count("\n") + 1
    assert all(1 <= finding.span.line <= finding.span.end_line <= last for finding in found.findings)
    # The remaining model conforms to the metamodel: each element is in a feature of its type.
    for element in found.base.eAllContents() if found.base else ():
        assert element.source is not None


@pytest.mark.parametrize(
    ("broken", "hidden"),
    [
        ("component C { behaviour { initial marked state } }", False),
        ("component C { behaviour { variable : integer } }", False),
        ("component C { incoming message with type: none }", False),
        ("datatype object P { : integer }", False),
        ("component C from L import", False),
        # If a brace is missing, the variable may belong to `A`.
        ("component C { behaviour { variable : integer }", True),
    ],
)
def test_a_nameless_declaration_hides_nothing_in_other_definitions(tmp_path: Path, broken: str, hidden: bool) -> None:
    text = f"""
        robot R {{
          datatype object O {{ a: integer }}
          component A {{
            incoming message go with type: O
            behaviour {{ initial marked state s {{ on request to go }} }}
          }}
          {broken}
          requirement A.gone needs A.lost
          provide A.go with {{ b: 1 }}
        }}
    """
    missing = [text for rule, text in underlined(reading(tmp_path, text)) if rule == "unresolved-reference"]
    assert missing == (["gone", "b"] if hidden else ["gone", "lost", "b"])


def test_a_nameless_declaration_may_be_the_missing_one_of_its_definition(tmp_path: Path) -> None:
    text = """
        robot R {
          datatype object O { : integer }
          component A {
            incoming message go with type: O
            outgoing message with type: none
            behaviour { variable : integer initial marked state s { on request to go goto t } }
          }
          requirement A.gone needs A.lost
          provide A.go with { b: 1 }
        }
    """
    assert {finding.rule for finding in reading(tmp_path, text).findings} == {"syntax"}


#: Words of other languages, and misplaced words of this one, with the hint.
FOREIGN = [
    ("robot R { const speed: double = 0.5 }", "write `constant name: type = value`"),
    ("robot R { component C { behaviour { initial marked state s { timeout 3.0 goto s } } } }", "write `after 3.0 s"),
    ("robot R { component C { behaviour { initial marked state s { after 3s goto s } } } }", "a number, a space and a"),
    ("robot R { component C { behaviour { initial marked state s { after 3 goto s } } } }", "a number, a space and a"),
    ("robot R { component C { behaviour { initial marked state s { after 3 s if true } } } }", "has no condition"),
    ("robot R { func f(d: double): double = d }", "write `function name(parameter: type): type = expression`"),
    ("robot R { component C { incoming message m with type: none } provide m with mode(1) }", "did you mean `mod`?"),
    ("robot R { component C { behaviour { initial marked state s { transition when true } } } }", "write `if`"),
    ("robot R { component C { incoming message m with type: int } }", "write `integer`"),
    ("robot R { component C { incoming message m with type: float64 } }", "write `double`"),
    ("robot R { never true }", "write `requirement never condition`"),
    ("robot R { invariant true }", "write `requirement never condition`"),
    (
        "robot R { component C { behaviour { initial marked state s { never true } } } }",
        "write `requirement never condition`",
    ),
    ("robot R { reachable true }", "write `property reachable condition`"),
    ("robot R { property P: always reachable C.s }", "write `property reachable condition`"),
    ("robot R { automaton T { } }", "write `requirement name: automaton { … }`"),
    ("robot R { requirement T automaton { } }", "write `:` before it"),
    (
        "robot R { requirement T: automaton { state s { on request to m do x := 1 } } }",
        "has only states with `on … if … goto …`",
    ),
    ("robot R { requirement T: automaton { variable x: boolean } }", "has only states with `on … if … goto …`"),
    ("robot R { requirement m before n }", "write `requirement b after a`"),
    ("robot R { requirement m after every n }", "write `requirement b after a`"),
    ("robot R { requirement at least 3 m since n }", "write `requirement at most 3 b since a`"),
    ("robot R { requirement at most m since n }", "write `requirement at most 3 b since a`"),
    ('robot R { requirement "text" m needs C.s }', "write `:` before it"),
    ('robot R { requirement N: "text" m needs C.s }', "the text before the colon"),
    ("robot R { template B(x: integer) { } }", "write `component name(parameter: type)"),
    ("robot R { component B = A() }", "`component other is name(argument)`"),
    ("robot R { component B extends A { } }", "`component other is name(argument)`"),
    ("robot R { function f(x: integer): integer { x } }", "one expression instead of braces"),
    (
        "robot R { component C { behaviour { initial marked state s { transition if forall r in x: r } } } }",
        "write `all`, `any`",
    ),
    (
        "robot R { component C { behaviour { initial marked state s { transition if all A A.s } } } }",
        "write `all`, `any`",
    ),
    (
        "robot R { constant not: boolean = true component C { behaviour { state s { transition if not x } } } }",
        "write `!` for `not`",
    ),
    (
        "robot R { component C { behaviour { initial marked state s { transition if x % 2 = 0 } } } }",
        "write `mod(a, b)`",
    ),
    (
        "robot R { component C { behaviour { variable x: boolean = true ? true : false } } }",
        "write `if condition then value",
    ),
    (
        "robot R { component C { behaviour { variable x: boolean = if true 1 else 2 } } }",
        "write `if condition then value",
    ),
    ("robot R { provide m with { x: 1 } if C.s else { x: 2 } }", "write `if condition then value"),
    ("robot R { provide m with if C.s then { x: 1 } }", "write `if condition then value"),
    (
        "robot R { component C { behaviour { initial marked state s { on error from m else goto s } } } }",
        "a transition for each case",
    ),
    ("robot R { component C { behaviour { initial marked state s { every 3 s do x := 1 } } } }", "write `after 3.0 s"),
]


@pytest.mark.parametrize(("text", "says"), FOREIGN)
def test_what_other_languages_write_is_told_in_words_of_this_one(tmp_path: Path, text: str, says: str) -> None:
    (finding, *_) = reading(tmp_path, text).findings
    assert says in str(finding.hint)
