"""The reader rejects what CIF rejects, with the position, and accepts what CIF accepts.

CIF's own parser, type checker and data-based synthesis (ESCET 5.0-dev) agree on all of these texts.
"""

import re

import pytest

from robosc.analysis.verify.cif_reading import CifError, Specification, read
from robosc.base.files.resources import locate
from robosc.m2t.cif.names import KEYWORDS
from robosc.model import expression as ex


def whole(
    before: str = "", members: str = "", first: str = "    edge c_a;", second: str = "  location b;", after: str = ""
) -> str:
    """Return a specification with additions; `first` extends its first location."""
    return (
        f"{before}\nenum E = red, blue;\nplant q:\n  uncontrollable u_r;\n  input int[0..9] i;\n"
        "  location: initial; marked; edge u_r;\nend\nplant p:\n  controllable c_a, c_b;\n  disc int[0..3] x = 0;\n"
        f"  disc bool v = false;\n  disc E e = red;\n{members}\n  location a:\n    initial; marked;\n"
        f"    edge c_b;\n    edge q.u_r;\n{first}\n{second}\nend\n{after}"
    )


def edge(text: str) -> str:
    return whole(first=f"    edge {text}")


def guard(text: str) -> str:
    return edge(f"c_a when {text};")


#: Texts that CIF rejects, with the reason and the position.
REFUSED = {
    # Its lexical syntax
    "an umlaut in a comment": (whole("// größer"), "line 1, column 6: '\\xf6' is not ASCII"),
    "a space that is none": (guard("\u00a0v"), "line 18, column 19: '\\xa0' is not ASCII"),
    "a form feed": (guard("\f v"), "line 18, column 19: Expected"),
    "a number that begins with 0": (guard("x = 02"), "line 18, column 24: Expected"),
    "a number beyond 32 bits": (guard("x < 2147483648"), "line 18, column 23: 2147483648 does not fit 32 bits"),
    "a keyword as a name": (whole(members="  disc bool edge = true;"), "line 13, column 13: Expected"),
    "another keyword as a name": (whole(members="  disc bool uniform = true;"), "line 13, column 13: Expected"),
    "an automaton called by a keyword": (
        whole(after="plant time: location: initial; end"),
        "line 21, column 7: Expected",
    ),
    "a literal called by a keyword": (whole("enum F = one, file;"), "line 1, column 15: Expected"),
    "a keyword in capitals": (whole(after="Plant r: location: initial; end"), "line 21, column 1: Expected"),
    "spaces in a name": (edge("q . u_r;"), "line 18, column 12: Expected"),
    "a name that begins with a digit": (whole(members="  disc bool 2x = true;"), "line 13, column 13: Expected"),
    "a comment without an end": (whole(after="/* and so on"), "line 21, column 1: Expected"),
    "a text without an end": (whole('@@doc("so)'), "line 1, column 7: Expected"),
    "a text with a backslash": (whole('@@doc("\\a")'), "line 1, column 7: Expected"),
    "a sign of two, apart": (edge("c_a do x : = 1;"), "line 18, column 19: Expected"),
    # Its grammar
    "an empty location with a colon": (whole(second="  location b:"), "line 20, column 1: Expected"),
    "a location without an end": (whole(second="  location b"), "line 20, column 1: Expected"),
    "no location": ("plant p: controllable c_a; end", "line 1, column 28: Expected"),
    "an edge without an end": (edge("c_a"), "line 19, column 3: Expected"),
    "an edge without an event, with a guard of nothing": (edge("when;"), "line 18, column 10: Expected"),
    "a marked without an end": (whole(second="  location b: marked edge c_a;"), "line 19, column 22: Expected"),
    "an event without an end": (whole(members="  controllable c_c"), "line 14, column 3: Expected"),
    "an automaton without an end": (whole().replace("end\n", "", 2), "line 7, column 1: Expected"),
    "an automaton with a semicolon": (whole(after=";"), "line 21, column 1: Expected"),
    "an automaton without a colon": (whole(after="plant r location: initial; end"), "line 21, column 9: Expected"),
    "an enumeration without literals": (whole("enum F = ;"), "line 1, column 10: Expected"),
    "an enumeration in braces": (whole("enum F = {one};"), "line 1, column 10: Expected"),
    "a comma too many": (whole(members="  controllable c_c,;"), "line 13, column 20: Expected"),
    "declarations after locations": (
        whole(second="  location b;\n  disc bool w = true;"),
        "line 20, column 3: Expected",
    ),
    "updates after the target": (edge("c_a goto b do x := 1;"), "line 18, column 21: Expected"),
    "the guard after the updates": (edge("c_a do x := 1 when v;"), "line 18, column 24: Expected"),
    "an assignment with =": (edge("c_a do x = 1;"), "line 18, column 19: Expected"),
    "a comparison with ==": (guard("x == 1"), "line 18, column 22: Expected"),
    "a negation with !": (guard("!v"), "line 18, column 19: Expected"),
    "a conjunction with &&": (guard("v && v"), "line 18, column 21: Expected"),
    "a chain of implications": (guard("v => v => v"), "line 18, column 26: Expected"),
    "an if without else": (guard("if v: v end"), "line 18, column 27: Expected"),
    "an if without end": (guard("if v: v else v"), "line 18, column 33: Expected"),
    "then in an if": (guard("if v then v else v end"), "line 18, column 24: Expected"),
    "an elseif": (guard("if v: v elseif v: v else v end"), "line 18, column 27: Expected"),
    "a target in another automaton": (edge("c_a goto q.b;"), "line 18, column 20: Expected"),
    "a range with one dot": (whole(members="  disc int[0.3] y = 0;"), "line 13, column 13: Expected"),
    "a requirement with both": (
        whole(after="requirement p.c_a needs v disables p.c_a;"),
        "line 21, column 27: Expected",
    ),
    "a requirement that enables": (whole(after="requirement p.v enables p.c_a;"), "line 21, column 17: Expected"),
    "a requirement without an end": (whole(after="requirement p.c_a needs p.v"), "line 21, column 28: Expected"),
    "an invariant between two words": (
        whole(after="invariant supervisor p.c_a needs p.v;"),
        "line 21, column 1: Expected",
    ),
    "one at sign before an edge": (whole(first='    @doc("so") edge c_a;'), "line 18, column 16: Expected"),
    "two at signs before a plant": (
        whole(after='@@doc("so") plant r: location: initial; end'),
        "line 21, column 1: Expected",
    ),
    # Names
    "two automata of one name": (
        whole(after="plant q: location: initial; end"),
        "line 21, column 7: the name 'q' is declared twice",
    ),
    "two variables of one name": (
        whole(members="  disc bool v = true;"),
        "line 13, column 13: the name 'v' is declared twice",
    ),
    "two events of one name": (
        whole(members="  controllable c_a;"),
        "line 13, column 16: the name 'c_a' is declared twice",
    ),
    "an event called like a location": (
        whole(members="  controllable b;"),
        "line 19, column 12: the name 'b' is declared twice",
    ),
    "two locations of one name": (whole(second="  location a;"), "line 19, column 12: the name 'a' is declared twice"),
    "a name with and without its dollar": (
        whole(members="  disc bool $v = true;"),
        "line 13, column 13: the name 'v' is declared twice",
    ),
    "two literals of one name": (whole("enum F = red;"), "line 2, column 10: the name 'red' is declared twice"),
    "a literal called like an automaton": (whole("enum F = q;"), "line 3, column 7: the name 'q' is declared twice"),
    "an undeclared event": (edge("c_c;"), "line 18, column 10: there is no 'c_c'"),
    "an undeclared event elsewhere": (edge("q.c_c;"), "line 18, column 10: there is no 'q.c_c'"),
    "an undeclared automaton": (edge("r.c_a;"), "line 18, column 10: there is no 'r.c_a'"),
    "an undeclared variable": (guard("w"), "line 18, column 19: there is no 'w'"),
    "an undeclared location": (edge("c_a goto c;"), "line 18, column 19: there is no 'c'"),
    "an undeclared enumeration": (whole(members="  disc F f = red;"), "line 13, column 8: there is no 'F'"),
    "a variable without its automaton": (
        whole(after="requirement v disables p.c_a;"),
        "line 21, column 13: there is no 'v'",
    ),
    "a literal of its enumeration": (guard("e = E.red"), "line 18, column 23: 'E' has no members, so no 'E.red'"),
    "something in a variable": (guard("v.v"), "line 18, column 19: 'v' has no members, so no 'v.v'"),
    "an automaton that a member hides": (
        whole(members="  controllable q;"),
        "line 17, column 10: 'q' has no members, so no 'q.u_r'",
    ),
    "a location for an event": (edge("a;"), "line 18, column 10: 'a' is not an event"),
    "a variable for a location": (edge("c_a goto x;"), "line 18, column 19: 'x' is not a location of 'p'"),
    "an automaton for a value": (guard("q"), "line 18, column 19: 'q' has no value"),
    "an event for a value": (guard("c_a"), "line 18, column 19: 'c_a' has no value"),
    "an enumeration for a value": (guard("e = E"), "line 18, column 23: 'E' has no value"),
    "a literal for a type": (whole(members="  disc red f = red;"), "line 13, column 8: 'red' is not an enumeration"),
    "a location without a name beside another": (
        whole(second="  location: edge c_a;"),
        "line 19, column 3: a location without a name is the only one",
    ),
    # Types
    "an integer for a condition": (guard("x"), "line 18, column 19: a condition is bool and this is int[0..3]"),
    "a literal for a condition": (guard("red"), "line 18, column 19: a condition is bool and this is E"),
    "an integer for a requirement": (
        whole(after="requirement p.c_a needs p.x;"),
        "line 21, column 25: a condition is bool and this is int[0..3]",
    ),
    "a chain of comparisons": (guard("0 < x < 3"), "line 18, column 27: `<` does not apply to bool and int[3..3]"),
    "a negation that binds closer": (guard("not x = 3"), "line 18, column 19: `not` does not apply to int[0..3]"),
    "a comparison that binds closer": (
        guard("x = 3 or 2"),
        "line 18, column 28: `or` does not apply to bool and int[2..2]",
    ),
    "an equation of two types": (guard("x = v"), "line 18, column 23: `=` does not apply to int[0..3] and bool"),
    "an order of booleans": (guard("v < v"), "line 18, column 23: `<` does not apply to bool and bool"),
    "an order of literals": (guard("e < blue"), "line 18, column 23: `<` does not apply to E and E"),
    "literals of two enumerations": (
        whole("enum F = one, two;", first="    edge c_a when e = one;"),
        "line 18, column 23: `=` does not apply to E and F",
    ),
    "a sum of booleans": (guard("v + v = 2"), "line 18, column 23: `+` does not apply to bool and bool"),
    "a sum that can overflow": (
        guard("x + 2147483647 > 0"),
        "line 18, column 23: `+` could overflow: its values are 2147483647 to 2147483650",
    ),
    "an implication of integers": (guard("x => v"), "line 18, column 24: `=>` does not apply to int[0..3] and bool"),
    "alternatives of two types": (
        edge("c_a do x := if v: 1 else false end;"),
        "line 18, column 22: the alternatives are int[1..1] and bool",
    ),
    "a choice by an integer": (
        edge("c_a do x := if x: 1 else 2 end;"),
        "line 18, column 25: a condition is bool and this is int[0..3]",
    ),
    "a range of nothing": (whole(members="  disc int[3..2] y = 3;"), "line 13, column 8: the range int[3..2] is empty"),
    "a start outside of the range": (
        whole(members="  disc int[0..3] y = 4;"),
        "line 13, column 18: 'y' is int[0..3] and its initial value int[4..4]",
    ),
    "a start of another type": (
        whole(members="  disc bool w = 1;"),
        "line 13, column 13: 'w' is bool and its initial value int[1..1]",
    ),
    "a start that is defined by itself": (
        whole(members="  disc bool w = w;"),
        "line 13, column 17: 'w' is not a constant",
    ),
    "an assigned value outside of the range": (
        edge("c_a do x := 4;"),
        "line 18, column 17: 'x' is int[0..3] and its new value int[4..4]",
    ),
    "an assigned value of another type": (
        edge("c_a do x := v;"),
        "line 18, column 17: 'x' is int[0..3] and its new value bool",
    ),
    "an assigned input": (
        whole(members="  input bool i;", first="    edge c_a do i := v;"),
        "line 18, column 17: 'i' is not a variable",
    ),
    "an assigned location": (edge("c_a do b := v;"), "line 18, column 17: 'b' is not a variable"),
    "an assigned variable of another automaton": (
        whole(after="plant r: location: initial; edge p.c_a do p.x := 1; end"),
        "line 21, column 43: 'p.x' is not a variable of 'r'",
    ),
    "a variable assigned twice": (edge("c_a do x := 1, x := 2;"), "line 18, column 25: 'x' is assigned twice"),
    # Alphabets, monitors, annotations
    "an edge outside of the alphabet": (
        whole(after="supervisor s: alphabet p.c_b; location: initial; marked; edge p.c_a; end"),
        "line 21, column 58: 'p.c_a' is not in the alphabet of 's'",
    ),
    "two alphabets": (
        whole(after="supervisor s: alphabet; alphabet; location: initial; marked; end"),
        "line 21, column 25: 's' has another alphabet before this one",
    ),
    "no event in the alphabet": (
        whole(after="supervisor s: alphabet p.x; location: initial; marked; end"),
        "line 21, column 24: 'p.x' is not an event",
    ),
    "a monitored event that is not an event of the automaton": (
        whole(after="plant r: monitor p.c_b; location: initial; edge p.c_a; end"),
        "line 21, column 1: 'c_b' is monitored and not in the alphabet of 'r'",
    ),
    "two monitors": (
        whole(members="  monitor c_a; monitor c_b;"),
        "line 13, column 16: 'p' has another monitor before this one",
    ),
    "documentation without a text": (whole("@@doc()"), "line 1, column 1: @@doc says nothing"),
}

#: Texts that CIF's type checker accepts and its data-based synthesis rejects.
REFUSED_BY_SYNTHESIS = {
    "no plant": ("enum E = red;", "line 1, column 1: there is no plant"),
    "a difference in a condition": (
        guard("x - 1 = 2"),
        "line 18, column 23: CIF's synthesis takes a '-' at the top of an assignment only",
    ),
    "a difference in a choice": (
        edge("c_a do x := if x < 1: 0 else x - 1 end;"),
        "line 18, column 43: CIF's synthesis takes a '-' at the top of an assignment only",
    ),
    "two differences": (
        edge("c_a do x := x - 1 - 1;"),
        "line 18, column 26: CIF's synthesis takes a '-' at the top of an assignment only",
    ),
    "a difference in a sum": (
        edge("c_a do x := x - 1 + 1;"),
        "line 18, column 26: CIF's synthesis takes a '-' at the top of an assignment only",
    ),
    "a negative range": (whole(members="  disc int[-1..3] y = 0;"), "line 13, column 12: Expected"),
    "an integer without a range": (whole(members="  disc int y = 0;"), "line 13, column 12: Expected"),
    "a product": (guard("x * x = 2"), "line 18, column 21: Expected"),
    "a real number": (whole(members="  disc real y = 0.5;"), "line 13, column 8: Expected"),
    "an event without a kind": (whole(members="  event y;", first="    edge y;"), "line 13, column 3: Expected"),
    "an automaton without a kind": (whole(after="automaton r: location: initial; end"), "line 21, column 1: Expected"),
}

#: Texts that CIF accepts and no generated file contains.
NEVER_GENERATED = {
    "no initial location": ("plant p: location a: marked; end", "line 1, column 1: 'p' has no initial location"),
    "two initial locations": (
        "plant p: location a: initial; location b: initial; end",
        "line 1, column 31: 'p' has another initial location before this one",
    ),
    "a variable without a start": (whole(members="  disc bool w;"), "line 13, column 14: Expected"),
    "a start by another variable": (whole(members="  disc bool w = v;"), "line 13, column 17: 'v' is not a constant"),
    "an event that a plant blocks": (
        whole(after="plant r: alphabet p.c_a; location: initial; marked; end"),
        "line 21, column 1: an event in the alphabet of 'r' has no edge",
    ),
    "another annotation": (whole('@@note("so")'), "line 1, column 1: there is no annotation @@note"),
}

ACCEPTED = {
    "all places": whole(),
    "one empty location": "plant p: location a: initial; end",
    "a location without a name and with nothing": (
        "plant p: location: initial; end plant q: location l: initial; location m; end"
    ),
    "words in another order": whole(second="  location b: edge c_a; marked; edge c_b;"),
    "comments": whole("// one\n/* two\n three */ // four */", first="    edge /* so */ c_a // and so\n;"),
    "no spaces": whole(first="    edge c_a when(x<2)and v do x:=x+1,v:=false goto b;"),
    "a number and a word without a space": guard("if v:x=2else v end"),
    "names like keywords": whole(
        members="  controllable $edge; disc bool $while = true;",
        first="    edge $edge when $while and p.$while; edge p.edge;",
    ),
    "a dollar before any name": whole(first="    edge $c_a when $v; edge $q.$u_r;"),
    "a chain of equations of booleans": guard("v = v = false"),
    "a negation of a negation": guard("not not v"),
    "parentheses": guard("(v => v) => (v => v) and not (x = 3)"),
    "both ways": guard("v <=> x < 2"),
    "an implication of disjunctions": guard("v or v => v and v or v"),
    "a sum on both sides": guard("x + x + 1 != 2 + (x + x)"),
    "inputs and locations elsewhere": whole(after="requirement p.c_a needs q.i < 3 and p.b;"),
    "a chosen number": edge("c_a do x := if x > 1: 3 elif x = 1: 2 else x + 1 end;"),
    "a difference": edge("c_a do x := x - 1;"),
    "a chosen difference": edge("c_a do x := if x < 1: 1 else x end - if v: 0 else 1 end;"),
    "a difference of sums": edge("c_a do x := x + x - (x + 1);"),
    "a difference in parentheses": edge("c_a do x := (x - 1);"),
    "old values": edge("c_a do x := if e = red: 1 else 2 end, e := if x = 0: blue else e end;"),
    "what may leave the range": edge("c_a do x := x + 1;"),
    "the largest range": whole(members="  disc int[0..2147483646] y = 2147483646;"),
    "an enumeration of one": whole("enum F = one;", members="  disc F f = one;"),
    "all kinds of exclusions": whole(
        after=(
            "requirement p.c_a needs p.v; requirement p.v disables p.c_b;\n"
            "supervisor invariant p.c_a needs not p.v; requirement invariant p.c_a needs p.x = 2;"
        )
    ),
    "a supervisor": whole(
        after=(
            "supervisor automaton s: alphabet p.c_a, p.c_b;\n"
            "location: initial; marked; edge p.c_a when p.v; edge p.c_b; end"
        )
    ),
    "a supervisor of nothing": whole(after="supervisor automaton s: alphabet; location: initial; marked; end"),
    "a monitor": whole(members="  monitor c_a, q.u_r;"),
    "a monitor of all": whole(members="  monitor;"),
    "documentation": whole(
        '@@doc("all", "of " + "\\"it\\"\\n", )\n',
        members='  @doc("y") disc bool y = true; @doc("c") controllable c_c;',
        first='    @@doc("an edge") edge c_a; @@doc("one") @@doc("two") edge c_c;',
        second='  @doc("nothing leads here") location b;',
        after=(
            '@doc("so") requirement p.c_a needs p.y;\n@doc("r") plant r: @doc("i") input bool i; location: initial; end'
        ),
    ),
    "everything before what it speaks of": (
        "requirement p.c_a needs p.v;\nplant p: controllable c_a; disc E e = red; disc bool v = true;\n"
        "location a: initial; edge c_a when q.b goto c; location c; end\n"
        "plant q: location b: initial; end\nenum E = red, blue;"
    ),
}


@pytest.mark.parametrize(
    ("text", "message"), (cases := REFUSED | REFUSED_BY_SYNTHESIS | NEVER_GENERATED).values(), ids=cases
)
def test_what_is_refused(text: str, message: str) -> None:
    with pytest.raises(CifError) as caught:
        read(text)
    assert str(caught.value).startswith(message)


@pytest.mark.parametrize("text", ACCEPTED.values(), ids=ACCEPTED)
def test_what_is_read(text: str) -> None:
    assert isinstance(read(text), Specification)


def test_keywords_are_those_of_the_lexical_syntax() -> None:
    words = re.search(r"\(\?!\(\?:([a-z|0-9]+)\)", locate("grammar/generated_cif.tx").read_text())
    assert words is not None
    assert set(words.group(1).split("|")) == KEYWORDS
    assert len(KEYWORDS) == 132


def test_operators_bind_as_in_cif() -> None:
    text = guard("not v and x + 1 < 2 or v => v = (x = 1) and v")
    condition = read(text).model.plants[1].locations[0].edges[-1].guard
    assert isinstance(condition, ex.Implication)
    either, both = condition.left, condition.right
    assert isinstance(either, ex.Disjunction)
    assert isinstance(either.left, ex.Conjunction)
    assert isinstance(either.left.left, ex.Negation)
    assert isinstance(either.left.right, ex.LessThan)
    assert isinstance(either.left.right.left, ex.Addition)
    assert isinstance(both, ex.Conjunction)
    assert isinstance(both.left, ex.Equation)


def test_sums_and_comparisons_go_from_the_left() -> None:
    [update] = read(edge("c_a do x := x + 1 + x - 2;")).model.plants[1].locations[0].edges[-1].updates
    assert isinstance(update.value, ex.Subtraction)
    assert isinstance(update.value.left, ex.Addition)
    assert isinstance(update.value.left.left, ex.Addition)
    compared = read(guard("v = v != false")).model.plants[1].locations[0].edges[-1].guard
    assert isinstance(compared, ex.Inequation)
    assert isinstance(compared.left, ex.Equation)


def test_a_monitor_never_blocks() -> None:
    text = (
        "plant p: uncontrollable u_a, u_b; disc bool v = true; monitor u_a;\n"
        "location a: initial; edge u_a when v goto b; edge u_b; location b: edge u_b; location c: edge u_a; end"
    )
    first, second, third = read(text).model.plants[0].locations
    *_, loop = first.edges
    assert (loop.event.name, loop.target, len(first.edges)) == ("u_a", first, 3)
    assert isinstance(loop.guard, ex.Negation)
    *_, loop = second.edges
    assert (loop.event.name, loop.target, loop.guard, len(second.edges)) == ("u_a", second, None, 2)
    assert len(third.edges) == 1
