"""CIF text: equal to the thesis' listings, readable by a CIF grammar, and equivalent to the model."""

import re
from pathlib import Path

import pytest
from hypothesis import given, settings

from robosc.analysis.verify.cif_reading import read as read_cif
from robosc.base.diagnostics import Severity, Span
from robosc.base.diagnostics.rules import page
from robosc.language.checks import check
from robosc.language.configuration import Configuration
from robosc.language.reading import read
from robosc.m2m import robosc_to_sct
from robosc.m2m.sct_to_cif import transform
from robosc.m2t import cif
from robosc.m2t.models import Models
from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.places import Place
from robosc.model.reflection import tree
from robosc.model.semantics.walks import copy_tree
from robosc.synthesis import synthesize
from tests.fuzz.valid import named_like
from tests.m2t.cif.differences import differences
from tests.m2t.cif.rebuilding import rebuild
from tests.random_sct import sct_models
from tests.sct_models import disables, edge, model, needs, plant
from tests.searching import examples

HERE = Path(__file__).parent


def generated(given: sct.SupervisoryControlModel) -> dict[str, str]:
    assert cif.preconditions(Models(given), Configuration()) == []
    return cif.generate(Models(given), Configuration())


def listings() -> sct.SupervisoryControlModel:
    """Return the plants, requirements and the enumeration of thesis 5.2, one instance of each."""
    none = "not component_X.state1 and not component_X.state2"
    provided = [
        edge("c_d1", "d1", when="component_X.state1"),
        edge("c_d2", "d2", when="component_X.state2"),
        edge("c_none", "none", when=none),
    ]
    return model(
        [
            plant(
                "message_sample",
                {"ready": [edge("u_response")]},
                kind="message",
                uncontrollable={"u_response": ["i_response_one", "i_response_two"]},
                inputs={"i_response_one": "bool", "i_response_two": "bool"},
            ),
            plant("message_sent", {"ready": [edge("c_trigger")]}, kind="message", controllable=["c_trigger"]),
            plant(
                "service_sample",
                {
                    "idle": [edge("c_trigger", "wait_for_response")],
                    "wait_for_response": [edge("u_response", "ready"), edge("u_error", "error")],
                    "ready": [edge("c_reset", "idle")],
                    "error": [edge("c_reset", "idle")],
                },
                kind="service",
                controllable=["c_trigger", "c_reset"],
                uncontrollable=["u_response", "u_error"],
            ),
            plant(
                "action_sample",
                {
                    "idle": [edge("c_trigger", "executing")],
                    "executing": [
                        edge("u_feedback"),
                        edge("u_response", "ready"),
                        edge("u_error", "error"),
                        edge("c_cancel", "idle"),
                    ],
                    "ready": [edge("c_reset", "idle")],
                    "error": [edge("c_reset", "idle")],
                },
                kind="action",
                controllable=["c_trigger", "c_reset", "c_cancel"],
                uncontrollable={"u_feedback": ["i_feedback_one"], "u_response": [], "u_error": []},
                inputs={"i_feedback_one": "0..20"},
            ),
            plant(
                "component_X",
                {
                    "state1": [edge("c_tau1", "state2", when="seen == two and count < 20")],
                    "state2": [
                        edge("message_sample.u_response", do={"mark": "message_sample.i_response_one"}),
                        edge("action_sample.u_feedback", "state1", do={"count": "action_sample.i_feedback_one"}),
                    ],
                },
                controllable=["c_tau1"],
                variables={"mark": "bool", "seen": "sample_enum = two", "count": "0..20"},
            ),
            plant(
                "data_sent",
                {"none": provided, "d1": provided, "d2": provided},
                kind="data",
                controllable=["c_d1", "c_d2", "c_none"],
                marked=["none", "d1", "d2"],
            ),
        ],
        [
            needs("message_sent.c_trigger", "component_X.state1", "message sent needs X.state1"),
            disables("message_sent.c_trigger", "not component_X.state1"),
        ],
        {"sample_enum": ["one", "two", "three"]},
        name="Listings",
    )


def test_the_listings_of_the_thesis(golden) -> None:
    golden(HERE / "golden" / "Listings.cif", generated(listings())["Listings.cif"])


def test_the_supervised_system(golden) -> None:
    given = listings()
    given.supervisor = sct.Supervisor(
        uncontrolledStates=1234,
        controlledStates=567,
        bddNodes=1,
        guards=[
            sct.EventGuard(event=event, everEnabled=True)
            for automaton in given.plants
            for event in automaton.events
            if event.controllable
        ],
    )
    first, second, *_ = given.supervisor.guards
    first.requirement = sct.LocationReference(location=given.plants[4].locations[0])
    first.synthesis = ex.Negation(operand=sct.VariableReference(variable=given.plants[4].variables[0]))
    second.synthesis = ex.BooleanLiteral(value=False)
    files = generated(given)
    golden(HERE / "golden" / "Listings.supervised.cif", files["Listings.supervised.cif"])
    assert differences(given, rebuild(files["Listings.supervised.cif"])) == []


def test_without_a_supervisor_there_is_no_supervised_system() -> None:
    assert list(generated(listings())) == ["Listings.cif"]


def test_plain_models_come_back_as_they_were() -> None:
    given = listings()
    again = rebuild(generated(given)["Listings.cif"])
    assert differences(given, again, exact=True) == []
    assert [str(automaton.kind) for automaton in again.plants] == [str(automaton.kind) for automaton in given.plants]
    assert [[str(event.kind) for event in automaton.events] for automaton in again.plants] == [
        [str(event.kind) for event in automaton.events] for automaton in given.plants
    ]


@pytest.mark.slow
@settings(max_examples=examples(30), deadline=None)
@given(given=sct_models())
def test_every_model_keeps_its_meaning(given: sct.SupervisoryControlModel) -> None:
    text = generated(given)["robot.cif"]
    assert differences(given, rebuild(text)) == []
    # Synthesis supports no `*`, and `-` only between the two operands of an assigned value.
    plain = re.sub('".*"', "", text)
    assert "*" not in plain
    for value in re.findall(":= ([^,;]*-[^,;]*)", plain):
        left, *rest = value.split(" - ")
        assert (len(rest), "-" in rest[0]) == (1, False)
        assert left.count("(") == left.count(")")
        assert len(re.findall(r"\bif\b", left)) == len(re.findall(r"\bend\b", left))
    assert "-" not in re.sub(":= [^,;]*", "", plain)


ROOT = HERE.parents[2]
MODELS = [
    ROOT / "tests" / "model" / "warehouse.rscd",
    *sorted(path for path in (ROOT / "examples").glob("*/*.rscd") if path.parent.name != "fleet"),
]


@pytest.mark.parametrize("path", MODELS, ids=[path.stem for path in MODELS])
def test_whole_robots_keep_their_meaning(path: Path) -> None:
    given = robosc_to_sct.transform(read(path).base)[0]
    given.supervisor = synthesize(given).supervisor
    assert given.supervisor is not None
    lowered = transform(given).model
    for text in generated(given).values():
        assert differences(given, named_like(text, lowered)) == []


def expression(text: str, **kinds: str) -> sct.SupervisoryControlModel:
    """Return a model with one guard and the variables that it reads."""
    return model([plant("p", {"l": [edge("e", when=text)]}, controllable=["e"], variables=kinds)])


def updated(target: str, text: str, **kinds: str) -> sct.SupervisoryControlModel:
    """Return a model with one update of `t`, a variable of the type `target`."""
    return model([plant("p", {"l": [edge("e", do={"t": text})]}, controllable=["e"], variables={"t": target, **kinds})])


def said(given: sct.SupervisoryControlModel) -> str:
    """Return the text after the event of the only edge."""
    text = generated(given)["robot.cif"]
    assert differences(given, rebuild(text)) == []
    found = re.search(r"edge e(?: when| do t :=) (.*);", text)
    assert found
    return found.group(1)


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("a + b <= 3", "a + b <= 3"),
        ("a + (b + 1) == 3", "a + (b + 1) = 3"),
        ("a - b > 2", "a > b + 2"),
        ("a > -1", "a + 1 > 0"),
        ("-a < 0", "0 < a"),
        ("s < 0", "s < 3"),
        ("s == a", "s = a + 3"),
        ("2 * a != b", "a + a != b"),
        ("2 * 3 > 1 + 4 - 8", "true"),
        ("a * b == 2", "if a = 0: false elif a = 1: b = 2 else b + b = 2 end"),
        ("(a if c else 0 - b) < s", "if c: a + 3 < s else 3 < b + s end"),
        ("(a + 1) * b == 2", "if a = 0: b = 2 elif a = 1: b + b = 2 else b + b + b = 2 end"),
        ("10 * a > b", "if a = 0: 0 elif a = 1: 10 else 20 end > b"),
        ("implies(c, implies(c, d))", "c => (c => d)"),
        ("implies(implies(c, d), c)", "(c => d) => c"),
        ("not c and not (c or d)", "not c and not (c or d)"),
        ("c == (a < b)", "c = (a < b)"),
        ("not (c == d)", "not (c = d)"),
        ("(c if d else c or d) != c", "if d: c else c or d end != c"),
        ("abs(s) < 2", "if s < 3: 1 < s else s < 5 end"),
        ("min(a, b) < 1", "if b < a: b < 1 else a < 1 end"),
        ("max(a, min(b, 2)) == 1", "if if 2 < b: a > 2 else a > b end: a = 1 elif 2 < b: false else b = 1 end"),
    ],
)
def test_conditions(text: str, wanted: str) -> None:
    assert said(expression(text, a="0..2", b="0..5", c="bool", d="bool", s="-3..3")) == wanted


@pytest.mark.parametrize(
    ("target", "text", "wanted"),
    [
        ("0..9", "a + 1", "a + 1"),
        ("0..2", "a + 1", "if a > 1: 2 else a + 1 end"),
        ("2..3", "a", "2"),
        ("2..7", "b", "if b < 2: 2 else b end"),
        ("1..2", "b", "if b > 2: 2 elif b < 1: 1 else b end"),
        ("0..2", "7", "2"),
        ("0..2", "-7", "0"),
        ("3..4", "-a", "3"),
        ("0..2", "a - 1", "if a < 1: 1 else a end - 1"),
        ("0..1999", "t - 1", "if t < 1: 1 else t end - 1"),
        ("0..5", "b - a", "if b < a: a else b end - a"),
        ("-2..5", "b - a", "(b + 2) - a"),
        ("0..9", "9 - a", "9 - a"),
        ("0..3", "b - a", "if b > a + 3: a + 3 elif b < a: a else b end - a"),
        ("0..5", "b - a if c else b", "if c: if b < a: a else b end else b end - if c: a else 0 end"),
        ("0..5", "b - a if c else 0 - a", "if c: if b < a: a else b end else 0 end - if c: a else 0 end"),
        ("0..9", "b - (1 if c else 2)", "if c: if b < 1: 1 else b end elif b < 2: 2 else b end - if c: 1 else 2 end"),
        ("-1..1", "a", "if a > 1: 2 else a + 1 end"),
        ("-3..3", "s", "s"),
        ("-3..3", "s + 0", "s"),
        ("0..6", "s", "if s < 3: 3 else s end - 3"),
        ("0..9", "a * b", "if a = 0: 0 elif a = 1: b elif b + b > 9: 9 else b + b end"),
        ("0..9", "max(a, 1)", "if 1 > a: 1 else a end"),
        ("-3..3", "abs(s)", "if s < 3: 6 else s end - if s < 3: s else 0 end"),
        ("bool", "a > b", "a > b"),
    ],
)
def test_updates(target: str, text: str, wanted: str) -> None:
    assert said(updated(target, text, a="0..2", b="0..5", c="bool", s="-3..3")) == wanted


def test_a_negative_range_is_shifted_and_says_so() -> None:
    text = generated(updated("-5..100 = -2", "t"))["robot.cif"]
    assert '  @doc("t + 5, with t in -5..100")\n  disc int[0..105] t = 3;\n' in text


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (expression("a * b > c", a="0..99", b="0..99", c="0..2"), None),
        (
            expression("a * b * c > 0", a="0..99", b="0..99", c="0..99"),
            "it needs 10000 cases; the maximum is 1024",
        ),
        (updated("0..5000", "a - 1", a="0..5000"), None),
        (
            updated("0..5000", "a * b", a="0..5000", b="0..5000"),
            "it needs 5001 cases; the maximum is 1024",
        ),
        (expression("a + a > 3", a="0..2147483646"), None),
        (expression("a - 3 + a > 3", a="0..2147483646"), "its numbers do not fit 32 bits"),
        (expression("(a + a) * b > 3", a="2147483600..2147483646", b="0..200"), "its numbers do not fit 32 bits"),
        (expression("c", c="bool", a="-1..2147483646"), "its range does not fit 32 bits"),
        (expression("c", a="0..2147483647", c="bool"), "its range does not fit 32 bits"),
    ],
)
def test_what_cannot_be_said_is_an_error_at_its_place(given: sct.SupervisoryControlModel, message: str | None) -> None:
    location = given.plants[0].locations[0]
    location.edges[0].source = Place.parse("robot.rscd:7:5-8:9")
    for variable in given.plants[0].variables:
        variable.source = Place.parse("robot.rscd:7:5-8:9")
    found = cif.preconditions(Models(given), Configuration())
    if message is None:
        assert found == []
        return
    [finding] = found
    assert (finding.file, finding.span, finding.rule) == ("robot.rscd", Span(7, 5, 8, 9), "cif")
    assert (finding.severity, finding.message) == (Severity.ERROR, f"CIF cannot express this: {message}")


def test_what_cannot_be_said_in_a_guard_stands_at_its_event() -> None:
    given = model(
        [plant("p", {"l": [edge("e")]}, controllable=["e"], variables={"a": "0..2147483646"})],
        [needs("e", "a - 3 + a > 3")],
    )
    given.plants[0].events[0].source = Place.parse("robot.rscd:7:5-8:9")
    given.requirements[0].source = Place.parse("robot.rscd:9:5-9:9")
    condition = copy_tree(given.requirements[0].condition)
    guard = sct.EventGuard(event=given.plants[0].events[0], requirement=condition)
    given.supervisor = sct.Supervisor(guards=[guard])
    found = cif.preconditions(Models(given), Configuration())
    assert [finding.span for finding in found] == [Span(9, 5, 9, 9), Span(7, 5, 8, 9)]


def test_expressions_of_too_large_a_number_draw_nothing_further() -> None:
    given = expression("a + 3 > 3", a="-2..2147483646")
    assert [precondition.message for precondition in cif.preconditions(Models(given), Configuration())] == [
        "CIF cannot express this: its range does not fit 32 bits"
    ]


def test_a_location_without_anything_ends_with_a_semicolon() -> None:
    given = model([plant("p", {"a": [edge("e", "b")], "b": [], "c": []}, controllable=["e"], marked=["a", "c"])])
    text = generated(given)["robot.cif"]
    assert "\n  location b;\n  location c:\n    marked;\nend\n" in text
    assert differences(given, rebuild(text)) == []


def test_a_robot_without_a_plant_is_no_cif(tmp_path: Path) -> None:
    (tmp_path / "model.rscd").write_text("\nrobot R { }")
    models = Models(robosc_to_sct.transform(read(tmp_path / "model.rscd").base)[0])
    [finding] = cif.preconditions(models, Configuration())
    assert (finding.rule, finding.span, finding.severity) == ("cif", Span(2, 1, 2, 12), Severity.ERROR)
    assert "CIF takes no specification without a plant" in finding.message


def provided(*conditions: str) -> sct.SupervisoryControlModel:
    """Return a data plant with the event `c_none` under the last condition."""
    names = [f"c_d{number}" for number, _ in enumerate(conditions[:-1], 1)] + ["c_none"]
    edges = [edge(name, name[2:], when=condition) for name, condition in zip(names, conditions, strict=True)]
    locations = ["none", *(name[2:] for name in names[:-1])]
    return model(
        [
            plant("data_x", dict.fromkeys(locations, edges), controllable=names, kind="data", marked=locations),
            plant("p", {"l": [edge("e")]}, controllable=["e"], variables={"b": "bool"}),
        ],
        guards={},
    )


def test_an_event_that_can_never_happen_is_left_out() -> None:
    given = provided("True", "False")
    given.supervisor = synthesize(given).supervisor
    for text in generated(given).values():
        assert "c_none" not in text
        assert "  location none:\n    initial; marked;\n    edge c_d1 when true goto d1;\n  location d1:\n" in text
        assert differences(given, rebuild(text)) == []
    assert "c_none" in generated(provided("p.b", "not p.b"))["robot.cif"]


def chosen(number: int) -> sct.SupervisoryControlModel:
    """Return a data plant with this number of choices, each under a different value."""
    names = [f"d{index}" for index in range(1, number + 1)]
    edges = [edge(f"c_{name}", name, when=f"p.n == {at}") for at, name in enumerate(names, 1)]
    edges.append(edge("c_none", "none", when=" and ".join(f"not (p.n == {at})" for at in range(1, number + 1))))
    locations = ["none", *names]
    given = model(
        [
            plant("message_x", {"ready": [edge("c_trigger")]}, kind="message", controllable=["c_trigger"]),
            plant(
                "data_x",
                dict.fromkeys(locations, ()),
                everywhere=edges,
                controllable=[made.event for made in edges],
                kind="data",
                marked=locations,
            ),
            plant(
                "p",
                {"l": [edge("e", when=f"n < {number}", do={"n": "n + 1"})]},
                controllable=["e"],
                variables={"n": f"0..{number}"},
            ),
        ],
        [needs("message_x.c_trigger", "not data_x.d1")],
    )
    given.supervisor = synthesize(given).supervisor
    return given


def test_a_variable_holds_the_number_of_the_choice() -> None:
    given = chosen(3)
    for text in generated(given).values():
        assert (
            '  @doc("The number of the provide statement that is chosen, 0 for none.")\n'
            "  disc int[0..3] choice = 0;\n\n  location:\n    initial; marked;\n"
            "    edge c_d1 when p.n = 1 do choice := 1;\n"
        ) in text
        assert " message_x.c_trigger needs not (data_x.choice = 1);" in text
        assert differences(given, rebuild(text)) == []
    # It has as many states as with locations.
    read_back, synthesis = synthesize(read_cif(generated(given)["robot.cif"]).model), synthesize(given)
    counts = synthesis.uncontrolled_states, synthesis.controlled_states
    assert (read_back.uncontrolled_states, read_back.controlled_states) == counts


def test_choices_are_written_once() -> None:
    few, many = (sum(map(len, generated(chosen(number)).values())) for number in (10, 80))
    assert many < 9 * few


@pytest.mark.parametrize("how", ["asked for", "elsewhere"])
def test_an_impossible_event_that_others_speak_of_stays(how: str) -> None:
    first = plant("p", {"l": [edge("e", when="False"), edge("f")]}, controllable=["e", "f"])
    second = plant("q", {"l": [edge("p.e" if how == "elsewhere" else "p.f", when="False")]})
    given = model([first, second], [needs("p.e", "p.l")] if how == "asked for" else [])
    text = generated(given)["robot.cif"]
    assert "edge e when false;" in text
    assert differences(given, rebuild(text)) == []


def test_what_is_asked_twice_stands_there_once_with_all_its_words() -> None:
    asked = [needs("e", "p.b", "one"), needs("f", "p.b", "other"), needs("e", "p.b", "two"), needs("e", "p.b", "one")]
    asked += [disables("e", "p.b", "three"), needs("e", "not p.b")]
    given = model([plant("p", {"l": [edge("e"), edge("f")]}, controllable=["e", "f"], variables={"b": "bool"})], asked)
    text = generated(given)["robot.cif"]
    assert re.findall("requirement .*", text) == [
        "requirement p.e needs p.b;",
        "requirement p.f needs p.b;",
        "requirement p.b disables p.e;",
        "requirement p.e needs not p.b;",
    ]
    assert (text.count('"one"'), text.count('"other"')) == (1, 1)
    assert text.index("one") < text.index("two") < text.index("requirement p.e") < text.index("three")
    assert differences(given, rebuild(text)) == []


def test_names_that_clash_are_told_apart(golden) -> None:
    given = model(
        [
            plant("P", {"a": [edge("e", "b")], "b": [edge("Q.e")]}, controllable=["e"]),
            plant(
                "Q",
                {"a": [edge("e", "b", when="P.b and v", do={"v": "not v"})], "b": []},
                controllable=["e"],
                variables={"v": "bool", "w": "C"},
            ),
        ],
        [needs("Q.e", "Q.b and Q.w == C.red")],
        {"C": ["red", "blue"], "D": ["green"]},
        guards={},
    )
    first, second = given.plants
    first.name, first.events[0].name = "sup", "edge"
    second.name, second.events[0].name, second.variables[0].name = "x", "when", "goto"
    for location, name in zip([*first.locations, *second.locations], ["event", "plant", "when", "goto"], strict=True):
        location.name = name
    given.enumerations[0].literals[1].name = given.enumerations[1].literals[0].name = "x"
    second.variables[1].name = "red"
    files = generated(given)
    golden(HERE / "golden" / "names.supervised.cif", files["robot.supervised.cif"])
    again = rebuild(files["robot.cif"])
    guard = again.plants[1].locations[0].edges[0].guard
    assert guard.left.location is again.plants[0].locations[1]
    assert guard.right.variable is again.plants[1].variables[0]
    red = again.requirements[0].condition.right
    assert red.left.variable is again.plants[1].variables[1]
    assert red.right.literal is again.enumerations[0].literals[0]


HOSTILE = [
    "x; end plant y: location: initial; end //",
    "two\nlines: plant y: location: initial; end",
    "\r\u2028end\x07",
    "größer",
    '"); end plant y: location: initial; end @doc("',
    "\\",
    '\\"',
    "a " * 200,
    "a-" * 100,
    '"' * 200,
]


def test_long_lines_are_folded_between_words() -> None:
    words = " and ".join(["p.b"] * 40)
    given = expression(" and ".join(["b"] * 40), b="bool")
    event = given.plants[0].events[0]
    condition = copy_tree(given.plants[0].locations[0].edges[0].guard)
    kind = sct.RequirementKind.needs
    given.requirements.append(sct.Requirement(event=event, kind=kind, condition=condition, text=f'"{words}\\"'))
    text = generated(given)["robot.cif"]
    assert max(map(len, text.splitlines())) <= 120
    assert differences(given, rebuild(text)) == []
    said = re.findall(r'"((?:[^"\\]|\\.)*)"', text[text.rindex("@doc") :])
    assert "".join(said).replace("\\\\", "\\").replace('\\"', '"') == f'"{words}\\"'


def test_a_transition_says_what_it_does() -> None:
    given = model(
        [
            plant(
                "component_X",
                {"a": [edge("c_tau1", "b"), edge("c_tau2")], "b": [edge("c_tau2"), edge("c_tau1", "a")]},
                controllable=["c_tau1", "c_tau2"],
                origin="X",
            )
        ]
    )
    given.plants[0].events[0].kind = given.plants[0].events[1].kind = sct.EventKind.tau
    text = generated(given)["robot.cif"]
    assert (
        '  @doc("A transition of X from a to b, from b to a.")\n  controllable c_tau1;\n'
        '  @doc("A transition of X in a, in b.")\n  controllable c_tau2;\n'
    ) in text


def test_the_head_says_how_cif_counts() -> None:
    given = listings()
    given.supervisor = sct.Supervisor(uncontrolledStates=10, controlledStates=3, bddNodes=1)
    head = generated(given)["Listings.supervised.cif"].splitlines()[1]
    assert head == '@@doc("CIF counts 252 of 840: each of them with the 84 values of the inputs.")'
    given.supervisor = sct.Supervisor(uncontrolledStates=10**5000, controlledStates=10**4999, bddNodes=1)
    zeros = "".join(generated(given)["Listings.supervised.cif"].partition("\nplant")[0]).count("0")
    assert zeros == 2 * (4999 + 5000)
    given.supervisor = sct.Supervisor()
    head, below, *_ = generated(given)["Listings.supervised.cif"].splitlines()
    assert (head, below) == ('@@doc("The plants of Listings under their supervisor.")', "")


@pytest.mark.parametrize("text", HOSTILE)
def test_nothing_breaks_out_of_its_place(text: str) -> None:
    quoting = model(
        [plant("p", {"l": [edge("e")]}, controllable=["e"], topic=text, origin=text)], [needs("e", "p.l", text)]
    )
    files = generated(quoting)
    assert differences(quoting, rebuild(files["robot.cif"])) == []
    assert all(character.isprintable() and character.isascii() for character in files["robot.cif"].replace("\n", ""))
    named = model([plant("p", {"l": [edge("e")]}, controllable=["e"])])
    for _, element in tree(named):
        if isinstance(element, ex.NamedElement):
            element.name = text
    assert len(cif.preconditions(Models(named), Configuration())) == 4


@pytest.mark.parametrize(("heading", "rules"), [("Wrong", ["cif"]), ("Right", [])])
def test_the_page_of_the_rule(heading: str, rules: list[str], tmp_path: Path) -> None:
    text = page("cif")
    assert text is not None
    found = re.search(rf"^## {heading}\n\n```robosc\n(.*?)^```$", text, flags=re.MULTILINE | re.DOTALL)
    assert found
    (tmp_path / "model.rscd").write_text(found.group(1))
    robot = read(tmp_path / "model.rscd").base
    assert check(robot) == []
    models = Models(robosc_to_sct.transform(robot)[0])
    assert [precondition.rule for precondition in cif.preconditions(models, Configuration())] == rules
