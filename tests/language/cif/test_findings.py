"""Faults in a specification are reported with their positions and hints, and all in one run."""

import random
import re
from pathlib import Path

import pytest

from robosc.base.diagnostics import ModelError
from robosc.language.cif import read
from robosc.language.cif.parsing import DEEPEST
from robosc.language.text import Documents
from robosc.synthesis import synthesize
from tests.language.cif.random_specifications import Specification
from tests.language.cif.test_language import COUNTS, reading
from tests.small_stack import on_small_stack

_P = "plant p: location a: initial; marked; edge c; end\n"


def findings(text: str) -> list[tuple[str, str, str | None]]:
    """Return the position, message and hint of all findings."""
    return [
        (f"{finding.span.line}:{finding.span.column}", finding.message, finding.hint)
        for finding in reading(main=text).findings
    ]


def test_a_channel_has_limited_pairs() -> None:
    parties = "".join(
        f"plant s{index}: location: initial; marked; edge c!; end\n"
        f"plant r{index}: location: initial; marked; edge c?; end\n"
        for index in range(101)
    )
    message = "the uncontrollable channel `c` has more than 10000 pairs of sender and receiver"
    assert findings(f"uncontrollable void c;\n{parties}") == [("1:21", message, "divide it into several channels")]


WRONG = {
    "a word": (
        "controllable c;\n" + _P.replace("edge", "egde"),
        [("2:39", "did you mean `edge`?")],
    ),
    "two faults of the text": (
        "controllable 5;\n" + _P.replace("edge c;", "edge c goto;") + "requirement not;\nplant q: location; end",
        [("1:14", None), ("2:50", None), ("3:16", None)],
    ),
    "a name": ("controllable close;\n" + _P.replace("edge c", "edge clos"), [("2:44", "did you mean `close`?")]),
    "a name in a group": (
        "group g: controllable close; end\n" + _P.replace("edge c", "edge g.clos"),
        [("2:44", "did you mean `g.close`?")],
    ),
    "a target": ("controllable c;\n" + _P.replace("edge c", "edge c goto b"), [("2:51", None)]),
    "types, all in one run": (
        "controllable c; const int n = true;\n"
        + _P.replace("edge c", "edge c when 1")
        + "requirement c needs p.a + 1;\n"
        "requirement p;",
        [("1:27", None), ("2:51", None), ("3:25", None), ("4:13", "name one of its locations")],
    ),
    "a variable whose range is its own value": (
        "plant p: controllable c; disc int[0..d] d; location: initial; marked; edge c; end",
        [("1:41", None)],
    ),
    "an input whose range is its own value": ("controllable c; input int[i..3] i;\n" + _P, [("1:33", None)]),
    "a range that reads a variable before and one after": (
        "controllable c; plant q: disc int[0..y] x; disc int[0..x] y; location: initial; end\n" + _P,
        [("1:38", None)],
    ),
    "a constant that is read within the range of what it is": (
        "controllable c; input int[0..n] i; const int n = i;\n" + _P,
        [("1:33", None)],
    ),
    "two of one name": ("controllable c;\ncontrollable c;\n" + _P, [("2:14", "rename one of them")]),
    "an event of no kind": ("event c;\n" + _P, [("2:44", "declare `c` as `controllable` or as `uncontrollable`")]),
    "a continuous variable": ("controllable c; cont x der 1;\n" + _P, [("1:17", None)]),
    "a function": (
        "controllable c; func int f(int x): if x > 1: x := 2; end return x; end\n"
        + _P.replace("edge c", "edge c when f(1) = 1"),
        [("2:51", None)],
    ),
    "an event that is no channel": (
        "controllable c;\n" + _P.replace("edge c", "edge c!3"),
        [("2:44", "leave out `!`, or write `void` after `event`")],
    ),
    "a channel of a requirement": (
        "controllable void c; controllable d;\n"
        + _P.replace("plant", "requirement").replace("c;", "c!;")
        + " plant q: location: initial; edge c?; end",
        [("2:50", "leave out `!`")],
    ),
    "a channel without its value, and a value without a place": (
        "controllable bool c; controllable void d;\n" + _P.replace("edge c", "edge c!, d!true"),
        [("2:44", "write it after `c!`")],
    ),
    "a value of another type": (
        "controllable int[0..3] c; controllable void d;\n" + _P.replace("edge c;", "edge c!4; edge d!1; edge c, d?;"),
        [("2:46", None), ("2:56", "leave it out"), ("2:59", "write two edges")],
    ),
    "an automaton that sends and receives": (
        "controllable int[0..3] c;\n" + _P.replace("edge c;", "edge c!1; edge c?;"),
        [("2:49", "use two automata")],
    ),
    "a value that is not received": (
        "controllable int[0..3] c; plant q: disc int[0..3] x; location: initial; edge c do x := ?; end\n" + _P,
        [("1:88", None)],
    ),
    "a received value of another type": (
        "controllable int[0..3] c;\n"
        + _P.replace("edge c", "edge c!1")
        + "plant q: disc bool b; location: initial; edge c? do b := ?; end",
        [("3:53", None)],
    ),
    "an operator before `else`": (
        "controllable c;\n" + _P.replace("edge c", "edge c when if true: true and else false end"),
        [("2:69", None)],
    ),
    "a static value that is too large": (
        "controllable c; const list int l0 = [1];"
        + "".join(f"const list int l{number + 1} = l{number} + l{number};" for number in range(40))
        + "\n"
        + _P.replace("edge c", "edge c when l40 = l39"),
        [("1:409", "split it into smaller constants")],
    ),
    "values that have no type of synthesis": (
        "controllable c; const real r = true; const list[2] int l = [1]; const int n = [1][2];\n"
        + _P.replace("edge c", "edge c when r + 1"),
        [("1:28", None), ("1:56", None), ("1:82", None)],
    ),
    "a list": ("controllable c; plant q: disc list int x; location: initial; end\n" + _P, [("1:31", None)]),
    "an int without range": ("controllable c; plant q: disc int x; location: initial; end\n" + _P, [("1:31", None)]),
    "an automaton of no kind": (
        "controllable c;\n" + _P.replace("plant p", "automaton p") + "plant q: location: initial; end",
        [("2:1", None)],
    ),
    "a supervisor without a plant": (
        _P.replace("plant p:", "supervisor p: controllable c;"),
        [("1:1", "write `plant` before at least one automaton")],
    ),
    "no plant": ("controllable c;\n", [("1:1", "write `plant` before at least one automaton")]),
    "nothing": ("// nothing", [("1:1", "write `plant` before at least one automaton")]),
    "no initial location": ("controllable c;\nplant p: location; end", [("2:1", "write `initial;` in one location")]),
    "the variable of another automaton": (
        "controllable c; plant q: disc bool b; location: initial; end\n"
        + _P.replace("edge c", "edge c do q.b := true"),
        [("2:49", None)],
    ),
    "a circle of algebraic variables": (
        "controllable c; alg bool a = b, b = a;\n" + _P + "requirement a;",
        [("1:26", None), ("1:33", None)],
    ),
    "a circle of definitions": (
        "group def A(): b: B(); end group def B(): a: A(); end\na: A(); controllable c;\n" + _P,
        [("1:43", None)],
    ),
    "a circle of types": ("controllable c; type A = B, B = A; input A x;\n" + _P, [("1:22", None)]),
    "arguments": ("controllable c; plant def D(event e): location: initial; end d: D();\n" + _P, [("1:62", None)]),
    "division by what changes": (
        "controllable c; input int[0..3] i;\n" + _P + "requirement i div i = 1;",
        [("3:15", None)],
    ),
    "a file that is not there": ('import "no.cif"; controllable c;\n' + _P, [("1:1", None)]),
    "a number": ("controllable c;\n" + _P + "requirement 99999999999 > 1;", [("3:13", None)]),
    "too deep statements of a function whose head is not closed": (
        "controllable c;\n" + _P + f"func int f([): {'while true: ' * 500}return 1; {'end ' * 500}end",
        [("1:1", "split the statements of its functions")],
    ),
    "too long": (
        "controllable c; alg bool a0 = p.a, "
        + ", ".join(f"a{n + 1} = a{n} and a{n}" for n in range(30))
        + ";\n"
        + _P
        + "requirement a30;",
        [("1:268", "move parts of it to automata with variables")],
    ),
    "too long by what is looked at": (
        "controllable c; alg int[0..2] a0 = 1, "
        + ", ".join(f"a{n + 1} = switch a{n}: case 0: a{n} else 1 end" for n in range(30))
        + ";\n"
        + _P
        + "requirement a30 = 1;",
        [("1:495", "move parts of it to automata with variables")],
    ),
    "too long all in all": (
        "controllable c; alg bool a0 = p.a, "
        + ", ".join(f"a{n + 1} = a{n} and a{n}" for n in range(10))
        + ";\n"
        + _P
        + "requirement a10;" * 60,
        [("3:749", "move parts of it to automata with variables")],
    ),
    "a plant invariant over too much": (
        "controllable c;\n"
        + "".join(
            f"plant p{n}: disc int[0..1] x; location: initial; edge c when x = 0 do x := 1; edge c when x = 1; end "
            for n in range(9)
        )
        + f"\nplant invariant {' and '.join(f'p{n % 9}.x < 1' for n in range(60))};",
        [("3:17", "write it as guards")],
    ),
}


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.slow] if name.startswith("too long") else []) for name in WRONG]
)
def test_a_fault_is_said_at_its_place(name: str) -> None:
    text, wanted = WRONG[name]
    found = findings(text)
    assert [place for place, _, _ in found] == [place for place, _ in wanted], found
    for (_, message, hint), (_, mend) in zip(found, wanted, strict=True):
        assert message
        assert mend is None or mend == hint


#: Nested constructs, one level per line: text before, opening, core, closing, text after, and the column of a level.
NESTED = {
    "parentheses": ("requirement\n", "(\n", "p.a", ")", ";", 1),
    "negations": ("requirement\n", "not(\n", "p.a", ")", ";", 4),
    "calls": ("requirement\n", "abs(\n", "1", ")", " = 1;", 4),
    "calls in an update": (
        "plant q: disc int[0..1] x; location: initial; edge c do x :=\n",
        "max(0,\n",
        "1",
        ")",
        "; end",
        4,
    ),
    "groups": ("", "group g:\n", "const int n = 1;", " end", "", 1),
    "groups, behind an automaton in each": (
        "",
        "group g: plant q: location a: initial; edge c; location b; end\n",
        "const int n = 1;",
        " end",
        "",
        1,
    ),
    "definitions of groups": ("", "group def G(event e; location l):\n", "const int n = 1;", " end", "", 12),
    "parentheses among flat words": ("requirement\n", "(if p.a:\n", "p.a", " else p.a end)", ";", 1),
}


@pytest.mark.parametrize("name", NESTED)
def test_what_is_nested_too_deep_is_found_at_its_place(name: str) -> None:
    """Nesting beyond the limit is reported at its position, on a stack of 512 KiB.

    Nesting at the limit has no finding.
    """
    before, opening, core, closing, after, column = NESTED[name]
    # The parentheses of the innermost definition are a level, too, and the first one beyond the limit.
    most = DEEPEST - ("definitions" in name)
    texts = [
        "controllable c;\n" + _P + before + opening * depth + core + closing * depth + after
        for depth in (most, most + 1, 5000)
    ]
    fine, *deep = on_small_stack(lambda: [findings(text) for text in texts])
    assert fine == []
    line = 3 + before.count("\n") + most
    assert [[place for place, _, _ in found] for found in deep] == [[f"{line}:{column}"]] * 2
    [(_, message, hint)] = deep[0]
    assert message == f"this is nested more than {DEEPEST} levels deep"
    assert hint


@pytest.mark.parametrize("statement", ["while true:", "if true: x := 1; elif false: x := 2; else"])
def test_statements_of_functions_that_are_nested_too_deep_are_found_at_their_place(statement: str) -> None:
    """Surrounding groups count as levels; earlier functions and types of functions do not."""
    before = "".join(
        f"type t{number} = func int(int a); "
        f"func int g{number}(int a): while true: x := if a = 1: 1 else 2 end; end end\n"
        for number in range(60)
    )
    texts = [
        f"controllable c;\n{_P}group a: func bool f(): return true; end group b: {before}\nfunc int f(int x):\n"
        + f"{statement}\n" * depth
        + "return 1; "
        + "end " * (depth + 3)
        for depth in (DEEPEST - 2, DEEPEST - 1, 5000)
    ]
    fine, *deep = on_small_stack(lambda: [findings(text) for text in texts])
    assert fine == []
    message, hint = f"this is nested more than {DEEPEST} levels deep", "split the statements of its functions"
    assert deep == [[(f"{3 + 60 + 2 + DEEPEST - 2}:1", message, hint)]] * 2


def test_what_is_not_closed_makes_nothing_deep() -> None:
    faults = "group g: requirement ((p.a; const int n = (if true: (1 else 2 end; end\n" * 60
    found = findings("controllable c;\n" + _P + faults)
    assert found
    assert not any("levels deep" in message for _, message, _ in found)


#: A chain of this many definitions exceeds the depth of Python's stack.
_MANY = 400


@pytest.mark.parametrize(
    "text",
    [
        "alg bool {} a0 = p.a; requirement a400;",
        "const int {} a0 = 1; requirement a400 = 1;",
        "type {} a0 = bool; input a400 i;",
    ],
)
def test_a_chain_of_definitions_may_be_long(text: str) -> None:
    chain = "".join(f"a{number + 1} = a{number}, " for number in reversed(range(_MANY)))
    assert findings("controllable c;\n" + _P + text.format(chain)) == []


def test_a_long_circle_is_said_of_each_definition_in_it() -> None:
    circle = ", ".join(f"a{number} = a{(number + 1) % _MANY}" for number in range(_MANY))
    assert len(findings(f"controllable c; alg bool {circle};\n{_P}")) == _MANY


@pytest.mark.parametrize(
    ("parameter", "use", "argument"),
    [
        ("event v", "plant q: location: initial; edge v; end", "c"),
        ("alg bool v", "requirement v;", "p.a"),
        ("H v", "requirement v.e needs true;", "h"),
    ],
)
def test_a_chain_of_instances_may_be_long(parameter: str, use: str, argument: str) -> None:
    definitions = [f"group def G{number + 1}({parameter}): a: G{number}(v); end" for number in range(_MANY)]
    start = f"group def H(): controllable e; end h: H(); group def G0({parameter}): {use} end"
    text = "\n".join([start, *definitions, f"x: G{_MANY}({argument});"])
    assert findings("controllable c;\n" + _P + text) == []


def test_a_namespace_and_an_automaton_do_not_share_a_name() -> None:
    root = "import 'leaf.cif'; namespace a; plant b: controllable e; location: initial; marked; edge e; end"
    found = reading(main=root.replace("'", '"'), leaf="namespace a.b.c; plant p: location: initial; end")
    assert [(finding.rule, finding.message) for finding in found.findings] == [
        ("cif-declaration", "the name `b` is declared twice")
    ]


@pytest.mark.parametrize(
    "declared",
    [
        "const int[0..{0}] {0} = 1;",
        "alg int[0..{0}] {0} = 1;",
        "type {0} = int[0..{0}];",
        "input int[0..{0}] {0};",
        "const int {0} = {0};",
        "alg bool {0} = {0};",
        "type {0} = {0};",
        "input {0} {0};",
        "enum {0} = {0};",
        "plant {0}: disc {0} {0} = {0}; location {0}: initial {0}; equation {0} = {0}; end",
        "{0}: {0}();",
        "{0}: G({0});",
        "group {0}: {0}: {0}(); end",
        "group def {0}({0} {0}; alg {0} {0}; location {0}): {0}: {0}({0}); end",
        "plant def {0}(alg bool {0}; event {0}): location: initial {0}; edge {0} when {0}; end",
        'import "main.cif";',
        "namespace {0}.{0};",
        "requirement {0}: {0};",
        "equation {0} = {0};",
        "controllable {0}, {0};",
        "event {0} {0};",
        "plant q: disc int[0..{0}] {0} in {{{0}}}; location: initial; edge c do {0} := {0}; edge {0} goto {0}; end",
    ],
)
@pytest.mark.parametrize("name", ["x", "p", "c", "G"])
def test_what_is_read_within_itself_or_named_like_something_ends_in_findings(declared: str, name: str) -> None:
    own = declared.format(name)
    for text in (own, own + own, f"group g: {own} end", f"group def G(alg bool x): {own} end a: G(x); b: G(true);"):
        if not text.startswith("group") or not own.startswith(("import", "namespace")):
            found = reading(main=f"controllable c; {text}\n{_P}")
            assert (found.model is None) == any(finding.severity.value == "error" for finding in found.findings)


@pytest.mark.parametrize(
    ("name", "before"),
    [
        ("@requirement:of_tomorrow", "plant p"),
        ("@requirement:of_tomorrow", "location a"),
        ("@requirement:reachable", "location a"),
        ("@requirement:reachable:soon", "plant p"),
    ],
)
def test_a_requirement_in_an_annotation_is_refused(name: str, before: str) -> None:
    text = "controllable c;\n" + _P.replace(before, f"{name}(a)\n{before}")
    [finding] = reading(main=text).findings
    assert (finding.rule, finding.severity.value) == ("cif-construct", "error")
    assert finding.message == f"synthesis does not take the requirement `{name}`"
    assert reading(main=text).model is None


def test_an_unknown_annotation_is_warned_about() -> None:
    known = '@@controller:properties(confluence: true)\n@doc("x") controllable c;\n'
    found = reading(main=known + _P.replace("edge c", "@state(x: 1) @own:one edge c"))
    assert [(finding.span.line, finding.severity.value, finding.rule) for finding in found.findings] == [
        (3, "warning", "cif-construct")
    ]
    assert "`@own:one`" in found.findings[0].message
    assert found.model is not None


_STATIC = "write constants"
_LIST = "a variable for each element"
_TYPES = "synthesis takes `bool`, ranges of `int` and `enum`"
_COMPUTED = "write an algebraic variable"
#: Constructs outside of CIF's synthesis: the text (`{}` of the plant: a declaration or a part of its edge), the
#: construct's name, and the hint, with CIF's own transformation if there is one.
OUTSIDE = [
    ("cont x der 1.0; {}", "continuous variables", "use them only in simulation"),
    ("cont x; {location a: equation x' = 1.0;}", "continuous variables", "use them only in simulation"),
    ("{} requirement p.a';", "derivatives", _COMPUTED),
    ("{edge c when time > 1}", "time", "by events"),
    ("func int f(int x): while x > 1: x := x - 1; end return x; end {} requirement f(1) = 1;", "functions", _COMPUTED),
    (
        'func tuple(int a; int b) f(tuple(int a; int b) x): "java:f"; {} requirement f(1)[0] = 1;',
        "functions",
        _COMPUTED,
    ),
    ("{disc int[0..2] x;} requirement sqrt(p.x) = 1.0;", "arguments of `sqrt` that depend on the state", _STATIC),
    ("{disc list int x;}", "the type `list`", _TYPES),
    ("{disc list[3] tuple(int a; bool b) x;}", "the type `list`", _TYPES),
    ("{disc set int x;}", "the type `set`", _TYPES),
    ("{disc dict(int:tuple(int a; int b)) x;}", "the type `dict`", _TYPES),
    ("{disc tuple(int a; int b) x;}", "the type `tuple`", _TYPES),
    ("{disc dist bool x;}", "the type `dist`", _TYPES),
    ("{} requirement 1.5 + <real>p.a > 1;", "casts of values that depend on the state", _STATIC),
    ("{disc int[0..2] x;} requirement p.x > 1.5;", "reals that depend on the state", _STATIC),
    ('{} requirement (if p.a: "a" else "b" end) = "b";', "conditions between values of these types", _STATIC),
    ("{disc int[0..2] x;} requirement p.x in [1];", "lists that depend on the state", _STATIC),
    ("{disc int[0..2] x;} requirement [1, 2][p.x] = 1;", "elements of lists and tuples", _STATIC),
    ("{disc int[0..2] x;} requirement p.x / 2 = 1.0;", "operands of `/` that depend on the state", _STATIC),
    ("{disc int[0..2] x;} requirement (p.x, 1)[0] = 1;", "tuples that depend on the state", _STATIC),
    ("controllable real d; {}", "the type `real`", _TYPES),
    ("{edge c do x[0] := 1}", "updates of tuples and lists", _LIST),
    ("{edge c do (x, y) := z}", "updates of tuples and lists", _LIST),
    (
        "{disc bool x; edge c do if x: x := false else x := true end}",
        "conditional updates",
        "cif2cif -t elim-if-updates",
    ),
    ("{disc bool x; edge c do x := sample x}", "distributions", "a value of the required type"),
    ("{edge tau}", "edges without an event", "cif2cif -t elim-tau-event"),
    ("{edge when true goto a}", "edges without an event", "cif2cif -t elim-tau-event"),
    ("{} automaton q: location: initial; end", "automata of no kind", "write `plant` or `requirement`"),
    ("{} invariant c needs true;", "invariants of no kind", "write `requirement`"),
    ("event e; {edge e}", "neither controllable nor", "declare `e` as"),
    ("{disc int x;}", "an int without range", "int[lowest..highest]"),
]


def _outside(statement: str) -> str:
    """Return a specification with a statement; its plant contains the text in braces."""
    before, inner, after = re.fullmatch(r"([^{]*)\{(.*)\}([^}]*)", statement).groups()  # type: ignore[union-attr]
    edge = inner[inner.index("edge ") :] if "edge " in inner else "edge c"
    location = inner if inner.startswith("location") else "location a:"
    declared = "" if inner.startswith(("location", "edge")) else inner.removesuffix(edge)
    return f"controllable c;\n{before} plant p: {declared} {location} initial; marked; {edge}; end {after}"


@pytest.mark.parametrize(("statement", "name", "mend"), OUTSIDE)
def test_what_is_outside_is_named_with_what_takes_it_out(statement: str, name: str, mend: str) -> None:
    text = _outside(statement)
    found = [finding for finding in reading(main=text).findings if name in finding.message]
    assert found, [finding.message for finding in reading(main=text).findings]
    assert found[0].span.line == 2
    assert mend in (found[0].hint or "")
    assert not any(finding.rule == "syntax" for finding in reading(main=text).findings)


def test_two_edges_of_a_controllable_event_exclude_each_other() -> None:
    model = reading(
        main="controllable c;\n" + _P.replace("edge c;", "edge c; edge c when not p.a;\nedge c when p.a;")
    ).model
    with pytest.raises(ModelError) as caught:
        synthesize(model)
    assert [(finding.rule, finding.span.line) for finding in caught.value.diagnostics] == [("nondeterminism", 3)]


def damaged(text: str, some: random.Random) -> str:
    """Remove, duplicate or move a piece of the text."""
    start = some.randrange(len(text))
    end = min(len(text), start + some.choice([1, 1, 2, 5, 20, 60]))
    piece, rest = text[start:end], text[:start] + text[end:]
    match some.randrange(4):
        case 0:
            return rest
        case 1:
            return text[:end] + piece + text[end:]
        case 2:
            place = some.randrange(len(rest) + 1)
            return rest[:place] + piece + rest[place:]
    return text[:start] + some.choice(";:(){}[]=.,$^@\"'/*0eé\n") + text[end:]


@pytest.mark.slow
@pytest.mark.parametrize("start", range(0, 200, 100))
def test_damaged_specifications_end_in_findings(start: int) -> None:
    texts = [text for text, _ in COUNTS.values()]
    for seed in range(start, start + 100):
        some = random.Random(seed)  # noqa: S311 - models, no secrets
        text = damaged(some.choice([*texts, Specification(seed).text]), some)
        path = Path("main.cif").resolve()
        found = read(path, Documents({str(path): text}))
        assert (found.model is None) == bool(found.findings)


@pytest.mark.parametrize(
    ("annotation", "message"),
    [
        ("@requirement:reachable(a, until: a)", "synthesis does not take the argument `until`"),
        ("@requirement:reachable(a, bound: -1)", "a bound is an integer constant from 0"),
        ("@requirement:reachable(a, bound: true)", "a bound is an integer constant from 0"),
        ("@requirement:reachable(a, bound: 1, bound: 1)", "has this argument twice"),
        ("@requirement:reachable(a, stay: 1)", "a condition is bool"),
        ("@requirement:reachable(a, avoid: b)", "there is no `b` here"),
        ("@requirement:reachable(a, a)", "has this argument twice"),
        ("@requirement:reachable(from: a)", "has no condition"),
        ("@requirement:reachable(1)", "a condition is bool"),
        ("@requirement:reachable(b)", "there is no `b` here"),
        ("@@requirement:reachable(a)", "stands in a wrong place"),
        ("@requirement:reachable", "synthesis does not take the requirement"),
        ("@requirement:reachable()", "synthesis does not take the requirement"),
    ],
)
def test_a_requirement_about_reachable_states_is_wrong(annotation: str, message: str) -> None:
    [finding] = reading(main=f"controllable c;\n{annotation}\n{_P}").findings
    assert (finding.rule in ("cif-construct", "type", "unresolved-reference"), finding.span.line) == (True, 2)
    assert message in finding.message
