"""The canonical layout, which never changes more than blanks and line breaks."""

import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from textwrap import dedent
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from robosc.language.formatting import format_text
from robosc.language.formatting.layout import CLAUSES
from robosc.language.grammar import words_of
from robosc.language.recovery import parse_file
from robosc.language.text import Text, decode
from robosc.language.tokens import Kind, Tokens
from tests.searching import examples

ROOT = Path(__file__).parent.parent.parent
FILES = [
    path
    for folder in ("examples", "robosc/stdlib", "tests/language/checks", "tests/supervision")
    for path in sorted((ROOT / folder).rglob("*.rscd"))
]
_STRING_OR_COMMENT = re.compile(r"""("(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)*')|//[^\n]*|/\*[\s\S]*?\*/""")
_NOISE = [
    *(" ", "  ", "\t", "\n", "\n\n", "\n\n\n\n", " \n\t ", " // noise\n", "\n// own line // still\n"),
    *(" /* in line */ ", "\n/* before */ ", " /* behind */\n", "\n/* over\n     two lines */\n", " /**/ // both\n"),
    *(
        "\n// one\n// two\n\n// three\n",
        " /* { */ /* } */ ",
        ' // a " quote, and much more than a line has room for' * 3 + "\n",
    ),
]


def formatted(text: str) -> str:
    result, findings = format_text(Text("model.rscd", text))
    assert (findings, result is None) == ([], False)
    assert result is not None
    return result


def body(text: str) -> str:
    """Return a robot with these definitions."""
    return f"robot R {{\n{text}\n}}\n"


def comments(text: str) -> list[list[str]]:
    """Return the comments of a text in order, each as its lines without surrounding blanks."""
    found = (match for match in _STRING_OR_COMMENT.finditer(text) if match[1] is None)
    return [[line.strip() for line in finding[0].split("\n")] for finding in found]


def model(text: str) -> tuple[Any, Any]:
    """Return the meaning of a text: its elements with all features except positions, and the names they refer to.

    Descriptions of parameters are left out: they are comments, which the tests compare separately.
    """
    parsed = parse_file(Text("model.rscd", text))
    assert parsed.findings == []

    def values(element: Any) -> tuple[Any, ...]:
        features = [
            feature
            for feature in element.eClass.eAllStructuralFeatures()
            if feature.name not in {"source", "description"}
        ]
        names = {feature: name.text for feature, name in parsed.references.get(element, {}).items()}
        contained = [feature for feature in features if getattr(feature, "containment", False)]
        plain = [
            (feature.name, getattr(element, feature.name))
            for feature in features
            if not hasattr(feature, "containment")
        ]
        inner = [
            (feature.name, [values(child) for child in _listed(getattr(element, feature.name))])
            for feature in contained
        ]
        return element.eClass.name, plain, names, inner

    return values(parsed.base)


def _listed(value: Any) -> list[Any]:
    if value is None:
        return []
    return [value] if hasattr(value, "eClass") else list(value)


@cache
def words(path: Path) -> list[tuple[str, str]]:
    """Return the words of a file, each with the text before it."""
    text = path.read_text(encoding="utf-8")
    tokens = list(Tokens(text))
    ends = [0, *(token.end for token in tokens)]
    return [(text[end : token.start], token.text) for end, token in zip(ends, tokens, strict=False)]


def signs(path: Path) -> Iterator[bool]:
    """Yield for each word whether it is the number after the sign of a bound: no comment may precede it."""
    texts = [word for _, word in words(path)]
    kinds = [token.kind for token in Tokens(path.read_text(encoding="utf-8"))]
    for index, kind in enumerate(kinds):
        yield kind is Kind.NUMBER and index > 1 and texts[index - 1] == "-" and texts[index - 2] in {"(", ".."}


@st.composite
def layouts(draw: st.DrawFn) -> tuple[str, str]:
    """Draw the text of a file and the same words in another layout, with comments anywhere."""
    path = draw(st.sampled_from(FILES))
    # The share of words with comments is random, too.
    rarely = draw(st.sampled_from([0.02, 0.2, 1.0]))
    random = draw(st.randoms(use_true_random=False))
    parts = []
    for (before, word), sign in zip(words(path), signs(path), strict=True):
        noise = random.choice(_NOISE) if random.random() < rarely else before
        parts += [" " if sign and noise.strip() else noise, word]
    parts.append(random.choice(["", "\n", " // end", "\n\n/* end */\n\n"]))
    return path.read_text(encoding="utf-8"), "".join(parts)


@pytest.mark.slow
@settings(max_examples=examples(60), deadline=None, suppress_health_check=list(HealthCheck))
@given(layouts())
def test_whatever_the_layout(texts: tuple[str, str]) -> None:
    original, noisy = texts
    result = formatted(noisy)
    assert formatted(result) == result
    assert comments(result) == comments(noisy)
    assert model(result) == model(original)
    assert result.endswith("\n")
    assert not result.endswith("\n\n")
    assert [line for line in result.split("\n") if line != line.rstrip()] == []
    assert re.search(r"\n\n\n|\{\n\n|\n\n *\}", result) is None


@pytest.mark.slow
@pytest.mark.parametrize("path", FILES, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_blanks_between_words_decide_nothing(path: Path) -> None:
    text = " ".join(word for _, word in words(path))
    lines = "\n".join(word for _, word in words(path))
    assert formatted(text) == formatted(lines)


def test_the_models_of_the_manual_have_the_layout() -> None:
    manual = (ROOT / "docs/format.md").read_text(encoding="utf-8")
    models = re.findall(r"^```robosc\n(.*?)^```$", manual, flags=re.MULTILINE | re.DOTALL)
    assert len(models) == 2
    assert [formatted(path) for path in models] == models


def test_items_and_words() -> None:
    text = """
        robot R{interface a use b from c
        parameter p:double(- 0.5 .. 5.0)=0.0
        component C{outgoing message m with identifier:'/m',type:integer(- 5 .. 5)links a
        behaviour{variable ^x :integer=- ( 1+2 )*3 variable y:boolean=!true
        on response from m do x:=value . a [ 0 ].b,y:=! ( x<-1 )initial marked state s{}
        state t{transition if x=1 goto s on response from C . m goto t}}}
        datatype object O{state:none type : array ( double )}
        datatype enum E from double to{value>0.5->big default->small}
        component D from L import C with{m:"/d/m",n:"/d/n"}
        requirement{m,C.m}needs x=>y
        requirement C.s disables m
        provide m with{a:{},b:{c:1}}if C.s}
        """
    assert formatted(text) == dedent("""\
        robot R {
          interface a use b from c
          parameter p: double(-0.5..5.0) = 0.0
          component C {
            outgoing message m with identifier: '/m', type: integer(-5..5) links a
            behaviour {
              variable ^x: integer = -(1 + 2) * 3
              variable y: boolean = !true
              on response from m do x := value.a[0].b, y := !(x < -1)
              initial marked state s {}
              state t {
                transition if x = 1 goto s
                on response from C.m goto t
              }
            }
          }
          datatype object O {
            state: none
            type: array(double)
          }
          datatype enum E from double to {
            value > 0.5 -> big
            default -> small
          }
          component D from L import C with { m: "/d/m", n: "/d/n" }
          requirement { m, C.m } needs x => y
          requirement C.s disables m
          provide m with { a: {}, b: { c: 1 } } if C.s
        }
        """)


def test_empty_lines_between_items_stay_one_of_several() -> None:
    text = """
        library L {


          // about A

          component A {

          }
          component B {}



          // about nothing

        }
        """
    assert formatted(dedent(text)) == dedent("""\
        library L {
          // about A

          component A {}
          component B {}

          // about nothing
        }
        """)


def test_comments_stay_where_they_are() -> None:
    text = """
        /* a
           head */

        robot R // named
        { // opened
          // own line
          /* before */ requirement { a // first
            , /* two */ b } /* set */ needs // why
            c /* in line */ and d // because

            /* own line */ or e   // end
          provide a with { x: 1 /* last */
            // really
          }
        } // closed
        """
    assert formatted(dedent(text)) == dedent("""\
        /* a
           head */

        robot R { // named
          // opened
          // own line
          /* before */ requirement {
            a, // first
            /* two */ b
          } /* set */ needs // why
            c /* in line */ and d // because
            /* own line */ or e // end
          provide a with {
            x: 1 /* last */
            // really
          }
        } // closed
        """)


def test_a_comment_of_several_lines_moves_as_a_whole() -> None:
    text = "robot R {\n        /* one\n\n             two\n      three   \n*/ component A {}\n}"
    assert formatted(text) == "robot R {\n  /* one\n\n       two\nthree\n*/ component A {}\n}\n"


def test_what_is_too_long_breaks_from_the_outside_in() -> None:
    name = "a_name_of_thirty_characters_xx"
    text = """
        robot R {
          component A {
            outgoing message N with identifier: "/N", type: N links N
            action a with request: N, response: N, feedback: N links N
            behaviour {
              variable v: boolean = N + N * N + N > 0 and N
              on response from N do v := value.N goto N
              on response from N do N := value.N, N := value.N goto N
              transition if N and N or N and N and N and N do N := 1 goto N
            }
          }
          component N from N import A with { N: "/N", M: "/N" }
          datatype enum E from N to {
            value.N[0] > 0.5 and value.N[0] < 0.7 -> N
            N or N and N -> N
          }
          requirement s needs N and N
          requirement s needs N and N and N
          requirement s needs N and (N or N or N or N) and !(N and N and N and N)
          requirement { N, N, N, N } needs N and N
          requirement N and N disables { N, a }
          provide N with { x: 1, y: N } if N and N
          provide N with { x: N + N, y: { z: N, w: N + N + N + N } } if N
        }
        """
    assert formatted(dedent(text).replace("N", name)).replace(name, "N") == dedent("""\
        robot R {
          component A {
            outgoing message N with
              identifier: "/N",
              type: N links N
            action a with
              request: N,
              response: N,
              feedback: N links N
            behaviour {
              variable v: boolean = N
                    + N * N
                    + N
                  > 0
                and N
              on response from N
                do v := value.N
                goto N
              on response from N
                do
                  N := value.N,
                  N := value.N
                goto N
              transition
                if N and N
                  or N
                    and N
                    and N
                    and N
                do N := 1
                goto N
            }
          }
          component N from N import A with {
            N: "/N",
            M: "/N"
          }
          datatype enum E from N to {
            value.N[0] > 0.5 and value.N[0] < 0.7
              -> N
            N
              or N and N
              -> N
          }
          requirement s needs N and N
          requirement s needs
            N
            and N
            and N
          requirement s needs
            N
            and (
              N
              or N
              or N
              or N
            )
            and !(
              N
              and N
              and N
              and N
            )
          requirement {
            N,
            N,
            N,
            N
          } needs N and N
          requirement N and N
            disables { N, a }
          provide N with { x: 1, y: N }
            if N and N
          provide N with {
            x: N + N,
            y: {
              z: N,
              w: N
                + N
                + N
                + N
            }
          } if N
        }
        """)


def test_a_line_has_room_for_a_hundred_columns() -> None:
    name = "n" * (100 - len("  requirement  needs a"))
    assert formatted(body(f"  requirement {name} needs a")) == body(f"  requirement {name} needs a")
    assert formatted(body(f"  requirement {name}n needs a")) == body(f"  requirement {name}n needs\n    a")


def test_a_comment_at_the_end_of_a_line_takes_no_room() -> None:
    item = f"  requirement a needs b // {'long ' * 20}".rstrip()
    assert formatted(body(item)) == body(item)


def test_line_breaks_of_all_systems() -> None:
    text, findings = decode("model.rscd", b"\xef\xbb\xbfrobot R {\r\n\r\r  // a\r\n}")
    assert (format_text(text), findings) == (("robot R {\n  // a\n}\n", []), [])


@pytest.mark.parametrize(
    "text",
    [
        "robot R {",
        "robot R { requirement a need b }",
        "robot R { component C { behaviour { variable a: integer = 99999999999999999999 } } }",
        "robot R { requirement a needs " + "(" * 60 + "b" + ")" * 60 + " }",
        "robot R {} /* open",
        "// nothing",
    ],
)
def test_a_text_with_syntax_errors_has_no_layout(text: str) -> None:
    result, findings = format_text(Text("model.rscd", text))
    assert result is None
    assert {finding.rule for finding in findings} == {"syntax"}


@pytest.mark.slow
def test_deep_and_long_expressions() -> None:
    deep = "(" * 45 + "a" + ")" * 45
    text = formatted(body(f"requirement b needs {deep}\nrequirement b needs {' or '.join(['a and c'] * 1000)}"))
    assert formatted(text) == text
    assert text.count("\n    or a and c") == 999


@pytest.mark.parametrize("rule", CLAUSES)
def test_lines_break_at_words_of_the_grammar(rule: str) -> None:
    before, behind = CLAUSES[rule]
    assert before | behind <= words_of(rule)
