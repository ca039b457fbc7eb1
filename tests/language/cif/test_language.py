"""Constructs of CIF specifications, each with its number of controlled states.

The numbers are those of CIF's data-based synthesis (ESCET 5.0-dev, forward reachability), unless a comment says that
CIF's own tool rejects the construct.
"""
# ruff: noqa: E501, ISC004 - specifications are easier to read in one piece

from pathlib import Path

import pytest

from robosc.language.cif import read
from robosc.language.text import Documents
from robosc.synthesis import synthesize

_ROOM = (
    "plant p: disc int[0..3] x; location l: initial; marked; edge c when x < 3 do x := x + 1; edge d do x := 0; end\n"
)
_EVENTS = "controllable c, d; uncontrollable u, v;\n"

COUNTS = {
    "a plant": (_EVENTS + _ROOM, 4),
    "a requirement on a controllable event": (_EVENTS + _ROOM + "requirement c needs p.x < 2;", 3),
    "one that disables": (_EVENTS + _ROOM + "requirement invariant p.x = 1 disables c;", 2),
    "of several events, with a name": (_EVENTS + _ROOM + "requirement r: p.x = 0; requirement {c, d} needs true;", 1),
    "in an automaton": (_EVENTS + _ROOM.replace("location l:", "requirement invariant x != 2; location l:"), 2),
    "in a location": (_EVENTS + _ROOM.replace("marked;", "marked; requirement x != 2;"), 2),
    "of an event on no edge": (_EVENTS + _ROOM + "requirement v needs false;", 4),
    "a requirement automaton": (
        _EVENTS + _ROOM + "requirement r: location a: initial; marked; edge c goto b; location b: edge d goto a; end",
        2,
    ),
    "one that watches": (
        _EVENTS
        + _ROOM
        + "requirement r: monitor c; location a: initial; marked; edge c goto b; location b: edge d goto a; end",
        4,
    ),
    "a plant that watches": (
        _EVENTS
        + _ROOM
        + "plant q: monitor; location a: initial; marked; edge c goto b; location b: edge d goto a; end",
        4,
    ),
    "an alphabet": (_EVENTS + _ROOM + "plant q: alphabet c; location: initial; marked; end", 1),
    "an uncontrollable event that must not happen": (
        _EVENTS + "plant p: location a: initial; marked; edge c goto b; location b: marked; edge u goto a; end\n"
        "requirement u needs p.a;",
        1,
    ),
    "an update out of range of a controllable event": (
        _EVENTS + "plant p: disc int[0..3] x; location: initial; marked; edge c do x := x + 2; end",
        2,
    ),
    "an update out of range of an uncontrollable event": (
        _EVENTS
        + "plant p: disc int[0..3] x; location: initial; marked; edge u when x > 1 do x := x + 2; edge c do x := 1 - x;"
        "edge d when x = 1 do x := 3; end",
        2,
    ),
    "several edges of one event": (
        _EVENTS
        + "plant p: location a: initial; marked; edge u goto a; edge u goto b; location b: marked; edge c goto a; end",
        2,
    ),
    "groups, names and parameters": (
        "group g: controllable c; group h: uncontrollable u; end end\n"
        "plant def P(event e, f; alg bool wide; location other):\n"
        "  location a: initial; marked; edge e when wide goto b; location b: edge f when not other goto a; end\n"
        "plant lone: location in1: initial; marked; edge g.c goto in2; location in2: edge .g.h.u goto in1; end\n"
        "one: P(g.c, g.h.u, 1 < 2, two.a); two: P(g.c, ^g.h.u, true, lone.in1);",
        2,
    ),
    "names from the root of a definition, and of the file": (
        "const int n = 0; controllable c;\n"
        "plant def P(): const int n = 2; disc int[0..3] v = .n;\n"
        "  location: initial; marked; edge c when v > ^n do v := v - 1; end\n"
        "p: P();",
        3,
    ),
    "a definition of a group": (
        "group def G(int_ p; controllable c): invariants: plant_(c); requirement c needs p.here; end\n"
        "plant def plant_(event e): location: initial; marked; edge e; end\n"
        "plant def int_(): controllable go; location here: initial; marked; edge go goto there; location there: marked; end\n"
        "controllable c; a: int_(); g: G(a, c);",
        2,
    ),
    "algebraic variables": (
        _EVENTS + _ROOM + "alg bool small = low < two, wide; alg int[0..3] low = p.x; const int two = 2;\n"
        "equation wide = not small; requirement c needs small;",
        3,
    ),
    "an equation in each location": (
        _EVENTS + "plant p: alg int[1..2] n; location a: initial; marked; equation n = 1; edge c goto b;\n"
        "location b: equation n = 2; edge d when n = 1 goto a; edge u goto a; end requirement p.n = 2 disables u;",
        1,
    ),
    "an equation beside an input": (
        "input bool i; alg bool a; equation a = not i; controllable c;\n"
        + _ROOM.replace("edge c when", "edge c when a and")
        + "controllable d;",
        8,
    ),
    "enumerations and types": (
        "type T = E; enum E = red, green; controllable c; plant p: disc T x = red; location: initial; marked x = red;"
        "edge c do x := if x = red: green else red end; end",
        2,
    ),
    "switch": (
        _EVENTS
        + "plant p: disc int[0..3] x; location a: initial; marked; edge c do x := switch x: case 0: 2 case 2: 3 else 0 end;"
        "end requirement (switch p.x: case 3: false else true end) disables d; requirement p.x != 3;",
        2,
    ),
    "switch over an automaton": (
        _EVENTS
        + "plant p: location a: initial; marked; edge c goto b; location b: marked; edge c when switch self: case a: true "
        "case b: false end goto a; end",
        2,
    ),
    "several initial values": (
        "controllable c; plant p: disc int[0..5] x in {1, 3}, y = x, z in any; location: initial; marked; end",
        12,
    ),
    "several initial locations": (
        "controllable c; plant p: disc bool b in any; location a: initial b; marked; location d: initial not b, true; marked; end",
        2,
    ),
    "predicates of what is initial and marked": (
        "controllable c; plant p: disc int[0..5] x in any; initial x > 1; marked x = 5; location: initial; marked;\n"
        "edge c when x < 5 do x := x + 1; end marked p.x != 9; initial p.x != 4;",
        4,
    ),
    "no value: the default": (
        "plant p: disc bool b; disc int[2..3] n; location: initial; marked not b and n = 2; end",
        1,
    ),
    "inputs": (
        _EVENTS + "input bool i; group g: input int[0..2] k; end\n"
        "plant p: location a: initial; marked; edge c when i goto b; location b: edge u when g.k = 2 goto a; end",
        12,
    ),
    "plant invariants": (
        _EVENTS + _ROOM + "plant invariant p.x != 2; plant c needs p.x != 9; plant p.x = 3 disables d;",
        2,
    ),
    "a plant invariant over two automata": (
        _EVENTS + "plant p: location a: initial; marked; edge c goto b; location b: marked; edge c goto a; end\n"
        "plant q: location a: initial; marked; edge c goto b; edge d goto b; location b: marked; edge d goto a; end\n"
        "plant not(p.b and q.b);",
        2,
    ),
    "div, mod and precedence": (
        _EVENTS + "plant p: disc int[0..9] x; location: initial; marked;"
        "edge c do x := (x + 3) mod 10; edge d when x div 3 = 2 or x > 8 and not false do x := 0; end",
        10,
    ),
    "a requirement in a namespace of two parts": (
        "namespace a.b;" + _EVENTS + _ROOM + "initial p.x = 0; requirement p.x != 2;",
        2,
    ),
    "a channel without data": (
        "controllable void c; uncontrollable void u;\n"
        "plant s: location a: initial; marked; edge c! goto b; location b: marked; edge u! goto a; end\n"
        "plant r: location a: initial; marked; edge c? goto b; location b: edge u? goto a; end",
        2,
    ),
    "a channel with several values, a range and a monitor": (
        "controllable int[0..9] c; controllable e;\n"
        "plant s: disc int[0..9] n; location: initial; marked; edge c!n; edge e when n < 9 do n := n + 1; end\n"
        "plant r: disc int[0..3] v; location: initial; marked; edge c? do v := ?; end\n"
        "plant m: alphabet c; monitor c; location: initial; marked; end",
        34,
    ),
    "several senders and receivers of a controllable channel": (
        "controllable int e; plant cnt: controllable next; disc int[0..3] c = 0; location: initial; marked;"
        "edge next when c < 3 do c := c + 1; end\n"
        "plant snd1: location: initial; marked; edge e!1 when cnt.c = 1; end\n"
        "plant snd2: location: initial; marked; edge e!2 when cnt.c = 2; end\n"
        "plant rcv1: disc int[0..3] x; location: initial; marked; edge e? when cnt.c = 1 do x := ?; end\n"
        "plant rcv2: disc int[0..3] x; location: initial; marked; edge e? when cnt.c = 2 do x := ?; end\n"
        "requirement e needs rcv1.x = 0 or rcv2.x = 1;",
        9,
    ),
    "several senders and receivers of an uncontrollable channel": (
        "uncontrollable int u; controllable c;\n"
        "plant s1: location: initial; marked; edge u!1; edge u!2; end\n"
        "plant s2: disc bool b; location: initial; marked; edge c do b := not b; edge u!3 when b; end\n"
        "plant r1: disc int[0..5] v; location: initial; marked; edge u? do v := ?; end\n"
        "plant r2: disc int[0..5] v; location: initial; marked; edge u? do v := ? + 1; end\n"
        "plant y: monitor u; disc int[0..1] k; location: initial; marked; edge u when k = 0 do k := 1; end\n"
        "requirement r1.v != 3;",
        9,
    ),
    "a channel that nobody receives from": (
        "controllable void d;"
        + _EVENTS.replace(", d", "")
        + _ROOM.replace("edge d", "edge d!")
        + "requirement d needs false;",
        4,
    ),
    "a channel as a parameter": (
        "uncontrollable int[0..4] u; controllable c;\n"
        "plant def S(event int[0..4] e!; alg int[0..4] v): location: initial; marked; edge e!v when r.v < 3; end\n"
        "a: S(u, 1); plant r: disc int[0..4] v; location: initial; marked; edge u? do v := ? + v; edge c do v := 0; end",
        4,
    ),
    "urgent locations and edges": (
        _EVENTS
        + _ROOM.replace("edge d", "edge d now").replace("marked;", "marked; urgent;")
        + "requirement c needs p.x < 2;",
        3,
    ),
    "static values of all types": (
        _EVENTS
        + _ROOM
        + 'const list real l = [1.5, 2.5]; const dict(string: tuple(int a; bool b)) t = {"x": (1, true)};\n'
        "type S = set int; const S s = {1, 2}; const int two = round(l[0]); const bool odd = -7 mod 2 = -1 and pow(2, 3) = 8;\n"
        'const bool all = size(s) = two and {1} sub s and 2 in s and not empty(l) and l[1:] = [2.5] and <string>1.5 = "1.5";\n'
        'alg real unused = p.x * 1.5; requirement c needs p.x < floor(l[1]) and odd and all and t["x"][b] or p.x = sign(-2.0);',
        3,
    ),
    "a function outside of synthesis": (
        _EVENTS + _ROOM + "func int f(int x): return x; end alg int y = f(p.x);",
        4,
    ),
    # CIF's synthesis rejects the rest.
    "min, max, abs and products": (
        _EVENTS + "plant p: disc int[-2..9] x; location: initial; marked;"
        "edge c do x := min(x + 2, 4); edge d do x := max(abs(x) * -1, -1); end",
        6,
    ),
    "what draws and what tells": (
        _EVENTS
        + '@doc("of ""it")\nplant p: @doc("x")\nlocation: initial; marked; @@doc("e", "f")\nedge c; '
        'svgout id "a" text value true; print "b" file "c"; end svgfile "x.svg"; printfile "y;z";'.replace('""', "'"),
        1,
    ),
    "names that are keywords": ("controllable $end; plant $plant: location $if: initial; marked; edge $end; end", 1),
}


def reading(**texts: str):  # type: ignore[no-untyped-def]
    """Read `main` with other files in its folder."""
    paths = {name: Path(f"{name}.cif").resolve() for name in texts}
    return read(paths["main"], Documents({str(paths[name]): text for name, text in texts.items()}))


@pytest.mark.parametrize("name", COUNTS)
def test_a_construct_has_the_states_that_it_has_in_cif(name: str) -> None:
    text, states = COUNTS[name]
    found = reading(main=text)
    assert found.findings == []
    assert synthesize(found.model).controlled_states == states


def test_files_import_each_other() -> None:
    found = reading(
        main='import "events.cif"; plant p: location: initial; marked; edge g.c; end group g: uncontrollable u; end',
        events='import "main.cif", "space.cif"; group g: controllable c; end',
        space="namespace a.b; plant q: location x: initial; marked; edge g.u goto y; location y; end",
    )
    assert [finding.message for finding in found.findings] == []
    assert [(plant.name, plant.origin) for plant in found.model.plants] == [("p", "p"), ("g", "g"), ("a_b_q", "a.b.q")]
