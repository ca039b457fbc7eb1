"""Constructs of each format, and the findings of files with faults, with their places."""

from __future__ import annotations

from pathlib import Path

import pytest

from robosc.base.diagnostics import Severity
from robosc.language.des import read
from robosc.language.text import Documents
from robosc.synthesis import synthesize
from tests.language.des.writing import component, expression, module

_MODELS = Path(__file__).parent / "models"
_EVENTS = {"go": True, "back": True, "tick": False}


def counted(files: dict[str, str], name: str) -> int:
    """Return the number of controlled states of a system without findings."""
    reading = read(name, Documents(files))
    assert [str(finding) for finding in reading.findings] == []
    assert reading.model is not None
    synthesis = synthesize(reading.model)
    return 0 if synthesis.supervisor is None else synthesis.controlled_states


def faults(files: dict[str, str], name: str) -> list[tuple[str, int, int, str, str]]:
    """Return the file, line, column, rule and message of each finding."""
    return [
        (finding.file, finding.span.line, finding.span.column, finding.rule, finding.message)
        for finding in read(name, Documents(files)).findings
    ]


@pytest.mark.parametrize(
    ("name", "states"),
    [("small_factory.automata", 12), ("transfer_line.wmod", 28), ("cat_and_mouse.automata", 6)],
)
def test_models_have_their_published_count(name: str, states: int) -> None:
    reading = read(_MODELS / name)
    assert reading.findings == []
    assert reading.model is not None
    assert synthesize(reading.model).controlled_states == states


# Modules


def node(name: str, *propositions: str, initial: bool = False) -> str:
    inside = "".join(f'<SimpleIdentifier Name="{name}"/>' for name in propositions)
    start = ' Initial="true"' * initial
    return f'<SimpleNode Name="{name}"{start}><EventList>{inside}</EventList></SimpleNode>\n'


def step(source: str, target: str, event: str, guard: str = "", actions: str = "") -> str:
    label = event if event.startswith("<") else f'<SimpleIdentifier Name="{event}"/>'
    guards = f"<Guards>{guard}</Guards>" if guard else ""
    block = f"<GuardActionBlock>{guards}<Actions>{actions}</Actions></GuardActionBlock>"
    return f'<Edge Source="{source}" Target="{target}"><LabelBlock>{label}</LabelBlock>{block}</Edge>\n'


def variable(name: str, kind: str, initial: str) -> str:
    return (
        f'<VariableComponent Name="{name}"><VariableRange>{kind}</VariableRange>'
        f"<VariableInitial>{initial}</VariableInitial></VariableComponent>\n"
    )


def assign(name: str, value: str, operator: str = "=") -> str:
    return f'<BinaryExpression Operator="{operator}"><SimpleIdentifier Name="{name}"/>{value}</BinaryExpression>'


RANGE = '<BinaryExpression Operator="..">{}{}</BinaryExpression>'
NUMBER = '<IntConstant Value="{}"/>'
COLORS = '<EnumSetExpression><SimpleIdentifier Name="red"/><SimpleIdentifier Name="green"/></EnumSetExpression>'


def small(*parts: str, more: str = "", events: dict[str, bool] | None = None) -> dict[str, str]:
    return {"m.wmod": module(events or _EVENTS, "".join(parts), more)}


def count_of(*parts: str, **others: str) -> int:
    return counted(small(*parts, **others), "m.wmod")


def levels(last: int) -> str:
    return variable("n", RANGE.format(NUMBER.format(0), NUMBER.format(last)), expression("n == 0"))


def test_an_action_out_of_range_disables_an_uncontrollable_event() -> None:
    # CIF's synthesis would avoid n = 2, where `tick` leaves the range.
    edges = step("a", "a", "tick", actions=assign("n", expression("n + 1")))
    assert count_of(levels(2), component("A", "PLANT", node("a", initial=True), edges)) == 3


@pytest.mark.parametrize(("operator", "value", "states"), [("+=", 2, 2), ("=", 3, 2), ("*=", 2, 1), ("-=", 1, 1)])
def test_actions_compute_values(operator: str, value: int, states: int) -> None:
    edges = step("a", "a", "go", actions=assign("n", NUMBER.format(value), operator))
    assert count_of(levels(3), component("A", "PLANT", node("a", initial=True), edges)) == states


def test_a_primed_guard_is_an_action() -> None:
    primed = '<UnaryExpression Operator="\'"><SimpleIdentifier Name="n"/></UnaryExpression>'
    guard = f'<BinaryExpression Operator="==">{primed}{expression("n + 2")}</BinaryExpression>'
    edges = step("a", "a", "go", guard)
    assert count_of(levels(4), component("A", "PLANT", node("a", initial=True), edges)) == 3


def test_writers_of_one_variable_agree() -> None:
    # `go` is possible while both values are equal: at n = 0 only.
    first = component(
        "A", "PLANT", node("a", initial=True), step("a", "a", "go", actions=assign("n", NUMBER.format(2)))
    )
    second = component(
        "B", "PLANT", node("b", initial=True), step("b", "b", "go", actions=assign("n", expression("n + 2")))
    )
    assert count_of(levels(4), first, second) == 2


def test_values_may_be_names() -> None:
    edges = step("a", "a", "go", expression("c == red"), assign("c", '<SimpleIdentifier Name="green"/>'))
    states = count_of(
        variable("c", COLORS, expression("c == red")), component("A", "PLANT", node("a", initial=True), edges)
    )
    assert states == 2


def test_a_guard_may_name_the_state_of_an_automaton() -> None:
    first = component("A", "PLANT", node("a", initial=True) + node("b"), step("a", "b", "go"))
    second = component("B", "PLANT", node("x", initial=True) + node("y"), step("x", "y", "tick", expression("A == b")))
    assert count_of(first, second) == 3


def test_a_forbidden_state_is_avoided() -> None:
    nodes = node("a", ":accepting", initial=True) + node("b") + node("c", ":forbidden")
    assert count_of(component("A", "PLANT", nodes, step("a", "b", "go") + step("b", "c", "tick"))) == 1


def test_an_edge_of_a_group_yields_to_one_of_its_state() -> None:
    inner = "".join(f'<SimpleIdentifier Name="{name}"/>' for name in "ab")
    group = f'<GroupNode Name="G"><ImmediateChildNodeList>{inner}</ImmediateChildNodeList></GroupNode>'
    nodes = node("a", initial=True) + node("b") + node("c") + node("d") + group
    edges = step("G", "c", "tick") + step("a", "b", "tick") + step("G", "d", "go")
    assert count_of(component("A", "PLANT", nodes, edges)) == 4  # `tick` leads from a to b, and from b to c.


def test_loops_and_arrays_are_expanded() -> None:
    bounds = f'{NUMBER.format(1)}<SimpleIdentifier Name="last"/>'
    constant = (
        f'<ConstantAliasList><ConstantAlias Name="last"><ConstantAliasExpression>{NUMBER.format(3)}'
        "</ConstantAliasExpression></ConstantAlias></ConstantAliasList>\n"
    )
    indexed = '<IndexedIdentifier Name="{}"><SimpleIdentifier Name="i"/></IndexedIdentifier>'
    machine = component("", "PLANT", node("a", initial=True) + node("b"), step("a", "b", indexed.format("start")))
    machine = machine.replace(' Name=""', "").replace("<Graph>", f"{indexed.format('M')}<Graph>")
    text = module(
        {},
        f'<ForeachComponent Name="i">{RANGE.format(bounds, "")}'
        f"<ComponentList>{machine}</ComponentList></ForeachComponent>",
        constant,
    )
    array = (
        f'<EventDecl Kind="CONTROLLABLE" Name="start"><RangeList>{RANGE.format(bounds, "")}</RangeList></EventDecl>\n'
    )
    assert counted({"m.wmod": text.replace("</EventDeclList>", f"{array}</EventDeclList>")}, "m.wmod") == 8


def test_a_module_may_have_another_encoding(tmp_path: Path) -> None:
    text = module(_EVENTS, component("Tür", "PLANT", node("a", initial=True), step("a", "a", "go")))
    (tmp_path / "m.wmod").write_bytes(text.replace("UTF-8", "windows-1252").encode("windows-1252"))
    reading = read(tmp_path / "m.wmod")
    assert reading.findings == []
    assert reading.model is not None
    assert [plant.name for plant in reading.model.plants if plant.locations[0].edges] == ["T_r"]


def test_faults_of_a_module_are_all_found() -> None:
    nodes = node("a", initial=True) + node("b", initial=True)
    edges = step("a", "z", "go") + step("a", "b", "jump") + step("b", "a", "go", expression("m > 1"))
    files = small(component("A", "PLANT", nodes, edges))
    assert faults(files, "m.wmod") == [
        ("m.wmod", 15, 1, "initial-state", "`A` has several initial states"),
        ("m.wmod", 18, 18, "unresolved-reference", "there is no state `z`"),
        ("m.wmod", 19, 41, "unresolved-reference", "there is no event `jump`"),
        ("m.wmod", 20, 143, "unresolved-reference", "there is no variable, constant or value `m`"),
    ]


@pytest.mark.parametrize(
    ("parts", "rule", "message"),
    [
        ((component("A", "SPEC", node("a", initial=True), ""),), "automata-declaration", "there is no plant"),
        ((component("A", "PLANT", node("a"), ""),), "initial-state", "`A` has no initial state"),
        (('<Instance ModuleName="other" Name="o"/>',), "automata-construct", "instances of other modules"),
        (
            (variable("n", RANGE.format(NUMBER.format(0), NUMBER.format(3)), expression("n < 2")),),
            "initial-state",
            "2 values",
        ),
        ((variable("n", NUMBER.format(3), expression("n == 0")),), "type", "expected a range of numbers"),
    ],
)
def test_a_fault_of_a_module_has_its_rule(parts: tuple[str, ...], rule: str, message: str) -> None:
    assert any(message in fault[4] for fault in faults(small(*parts), "m.wmod") if fault[3] == rule)


def test_entities_are_rejected() -> None:
    text = '<!DOCTYPE Module [<!ENTITY a "aaaa">]>\n' + module(_EVENTS, "")
    assert faults({"m.wmod": text.replace('<?xml version="1.0" encoding="UTF-8"?>\n', "")}, "m.wmod") == [
        ("m.wmod", 1, 18, "syntax", "a document type declaration is not allowed in a model")
    ]


def test_what_synthesis_ignores_draws_a_warning() -> None:
    plant = component("A", "PLANT", node("a", initial=True), step("a", "a", "go"))
    reading = read("m.wmod", Documents(small(plant, component("P", "PROPERTY", node("a", initial=True), ""))))
    assert [(finding.severity, finding.message) for finding in reading.findings] == [
        (Severity.WARNING, "synthesis ignores the property `P`")
    ]
    assert reading.model is not None


# Modules whose expansion would not end


PLANT = component("A", "PLANT", node("a", initial=True), step("a", "a", "go"))


def product_of(name: str) -> str:
    return assign(name, f'<SimpleIdentifier Name="{name}"/>', "*")


def aliases(kind: str, contents: list[str]) -> str:
    body = "".join(
        f'<{kind} Name="c{index}"><{kind}Expression>{inside}</{kind}Expression></{kind}>\n'
        for index, inside in enumerate(contents)
    )
    return f"<{kind}List>{body}</{kind}List>\n"


def nested(start: str, inside: str, end: str, depth: int) -> str:
    return start * depth + inside + end * depth


def test_an_atom_may_be_twice_in_a_set() -> None:
    kind = COLORS.replace("<SimpleIdentifier", '<SimpleIdentifier Name="red"/><SimpleIdentifier', 1)
    assert count_of(variable("c", kind, expression("c == red")), PLANT) == 1


def test_a_chain_of_constants_is_computed_once() -> None:
    contents = [NUMBER.format(1)] + [product_of(f"c{index}") for index in range(60)]
    limit = RANGE.format(NUMBER.format(0), '<SimpleIdentifier Name="c60"/>')
    edges = step("a", "a", "go", actions=assign("n", expression("n + 1")))
    assert (
        count_of(
            variable("n", limit, expression("n == 0")),
            component("A", "PLANT", node("a", initial=True), edges),
            more=aliases("ConstantAlias", contents),
        )
        == 2
    )


def test_a_constant_may_not_be_computed_from_itself() -> None:
    limit = RANGE.format(NUMBER.format(0), '<SimpleIdentifier Name="c0"/>')
    more = aliases("ConstantAlias", [product_of("c1"), product_of("c0")])
    found = faults(small(variable("n", limit, expression("n == 0")), PLANT, more=more), "m.wmod")
    assert [(rule, message) for _, _, _, rule, message in found] == [
        ("cyclic-definition", "`c0` is computed from itself")
    ]


def test_aliases_of_events_have_each_event_once() -> None:
    pair = '<EventList><SimpleIdentifier Name="{0}"/><SimpleIdentifier Name="{0}"/></EventList>'
    more = aliases("EventAlias", [pair.format(name) for name in ["go", *(f"c{index}" for index in range(40))]])
    text = component("A", "PLANT", node("a", initial=True) + node("b"), step("a", "b", "c40"))
    assert count_of(text, more=more) == 2


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        (
            (
                component(
                    "A",
                    "PLANT",
                    node("a", initial=True),
                    step("a", "a", "go", nested('<UnaryExpression Operator="!">', "", "</UnaryExpression>", 400)),
                ),
            ),
            "synthesis does not take more than 50 expressions inside each other",
        ),
        (
            (
                variable(
                    "n",
                    nested('<UnaryExpression Operator="-">', NUMBER.format(1), "</UnaryExpression>", 400),
                    expression("n == 0"),
                ),
                PLANT,
            ),
            "synthesis does not take more than 50 expressions inside each other",
        ),
        (
            (
                PLANT,
                nested(
                    '<ForeachComponent Name="i">'
                    + RANGE.format(NUMBER.format(1), NUMBER.format(1))
                    + "<ComponentList>",
                    "",
                    "</ComponentList></ForeachComponent>",
                    400,
                ),
            ),
            "synthesis does not take more than 50 loops inside each other",
        ),
        (
            (
                PLANT,
                nested(
                    '<ForeachComponent Name="i">'
                    + RANGE.format(NUMBER.format(1), NUMBER.format(10000))
                    + "<ComponentList>",
                    "",
                    "</ComponentList></ForeachComponent>",
                    3,
                ),
            ),
            "synthesis does not take a module whose expansion takes more than 2000000 steps",
        ),
    ],
    ids=["value", "constant", "loops", "iterations"],
)
def test_a_module_has_limits(parts: tuple[str, ...], message: str) -> None:
    [(_, line, _, rule, found)] = faults(small(*parts), "m.wmod")
    assert (rule, found) == ("automata-construct", message)
    assert line > 1


def test_variables_may_start_with_one_of_many_values() -> None:
    kind = RANGE.format(NUMBER.format(0), NUMBER.format(99_998))
    variables = [variable(f"n{index}", kind, expression(f"n{index} == 7")) for index in range(100)]
    assert faults(small(*variables, PLANT), "m.wmod") == []


def test_an_encoding_has_one_table(tmp_path: Path) -> None:
    text = module(_EVENTS, PLANT)
    (tmp_path / "m.wmod").write_bytes(text.replace("UTF-8", "UTF-16").encode("utf-16"))
    assert read(tmp_path / "m.wmod").findings == []
    # In Punycode, the text would be another one.
    (tmp_path / "m.wmod").write_text(text.replace("UTF-8", "punycode"), encoding="utf-8")
    assert read(tmp_path / "m.wmod").findings == []


# Single automata and their lists

MACHINE = """<Generator>
"machine"
<Alphabet>
"go" +C+ "tick"
</Alphabet>
<States>
"a" "b"#7
</States>
<TransRel>
"a" "go" 7
"b" "tick" "a"
</TransRel>
<InitStates>
"a"
</InitStates>
<MarkedStates>
"a"
</MarkedStates>
</Generator>
"""


def test_states_have_numbers() -> None:
    assert counted({"m.gen": MACHINE}, "m.gen") == 2


def test_a_range_declares_states() -> None:
    text = MACHINE.replace('"a" "b"#7', "<Consecutive> 1 7 </Consecutive>").replace('"a"', "1").replace('"b"', "7")
    assert counted({"m.gen": text}, "m.gen") == 2


def test_attributes_may_be_in_the_style_of_xml() -> None:
    text = """<Generator name="machine" ftype="System">
<Alphabet> <Event name="go"> <Controllable/> </Event> <Event name="tick"/> </Alphabet>
<StateSet> <State id="1" name="a"> <Initial/> <Marked/> </State> <State id="2" name="b"/> </StateSet>
<TransRel> <Transition x1="1" event="go" x2="2"/> <Transition x1="b" event="tick" x2="1"/> </TransRel>
</Generator>
"""
    assert counted({"m.gen": text}, "m.gen") == 2
    # Without its way back, `b` is avoided: `go` is controllable.
    assert counted({"m.gen": text.replace('<Transition x1="b" event="tick" x2="1"/>', "")}, "m.gen") == 1


@pytest.mark.parametrize(
    ("before", "after", "fault"),
    [
        ('"tick" "a"', '"tack" "a"', (11, 5, "unresolved-reference", "the event `tack` is not in the alphabet")),
        ('"tick" "a"', '"tick" "c"', (11, 12, "unresolved-reference", "there is no state `c`")),
        ('"b" "tick" "a"', '"b" "tick"', (11, 5, "syntax", "a transition has a state, an event and a state")),
        ("</States>", "</State>", (8, 1, "syntax", "`</State>` ends no section that is open here")),
        ("</Generator>", "", (1, 1, "syntax", "`<Generator>` is not closed")),
        (
            "<InitStates>",
            "<Clocks> 1 </Clocks><InitStates>",
            (13, 1, "automata-construct", "synthesis does not take the section `Clocks`"),
        ),
        ('<InitStates>\n"a"', "<InitStates>", (1, 1, "initial-state", "`m` has no initial state")),
    ],
)
def test_a_fault_of_a_generator_has_its_place(before: str, after: str, fault: tuple[int, int, str, str]) -> None:
    assert before in MACHINE
    assert faults({"m.gen": MACHINE.replace(before, after)}, "m.gen") == [("m.gen", *fault)]


def test_an_event_is_controllable_if_a_plant_says_so() -> None:
    specification = MACHINE.replace(" +C+", "").replace('"a" "go" 7', '"a" "go" "a"')
    files = {"p.gen": MACHINE, "s.gen": specification, "all.automata": "requirement s.gen\nplant p.gen # last\n\n"}
    reading = read("all.automata", Documents(files))
    assert reading.model is not None
    events = {event.name: event.controllable for plant in reading.model.plants for event in plant.events}
    assert events == {"go": True, "tick": False}


def test_plants_agree_on_an_event() -> None:
    text = (_MODELS / "cat.xmd").read_text(encoding="utf-8")
    files = {
        "a.xmd": text,
        "b.xmd": text.replace("<controllable/>", "", 1),
        "all.automata": "plant a.xmd\nplant b.xmd\n",
    }
    [(file, line, _, rule, message)] = faults(files, "all.automata")
    assert (file, rule) == ("b.xmd", "automata-declaration")
    assert "`c3` is uncontrollable here" in message
    assert "<name>c3</name>" in text.splitlines()[line - 1]


@pytest.mark.parametrize(
    ("line", "rule", "message"),
    [
        (
            "plant nowhere.gen",
            "unresolved-reference",
            "the file `nowhere.gen` cannot be read: No such file or directory",
        ),
        ("plant m.cif", "automata-construct", "`m.cif` is not a file with one automaton"),
        ("spec m.gen", "syntax", "found `spec`, expected `plant` or `requirement` and a file"),
        ("plant", "syntax", "found `plant`, expected `plant` or `requirement` and a file"),
    ],
)
def test_a_wrong_line_of_a_list_is_found(line: str, rule: str, message: str) -> None:
    files = {"m.gen": MACHINE, "all.automata": f"plant m.gen\n{line}\n"}
    assert faults(files, "all.automata") == [("all.automata", 2, 1, rule, message)]


def test_a_transition_without_an_event_is_found() -> None:
    text = (_MODELS / "mouse.xmd").read_text(encoding="utf-8").replace(' event="0"', "", 1)
    [(_, _, _, rule, message)] = faults({"m.xmd": text}, "m.xmd")
    assert (rule, message) == ("automata-construct", "synthesis does not take transitions without an event")


def test_an_unobservable_event_draws_a_warning() -> None:
    text = (_MODELS / "mouse.xmd").read_text(encoding="utf-8").replace("<observable/>", "", 1)
    reading = read("m.xmd", Documents({"m.xmd": text}))
    assert [finding.severity for finding in reading.findings] == [Severity.WARNING]
    assert reading.model is not None


@pytest.mark.parametrize(
    ("before", "after", "fault"),
    [
        ("<Alphabet>", "<Alphabet>\n" * 60, (52, "syntax", "more than 50 sections are inside each other")),
        ("<Alphabet>", "<!-- >" * 60 + "<Alphabet>", (3, "syntax", "the comment has no end `-->`")),
        (
            '"a" "b"#7',
            "<Consecutive>\n" + "1 9999\n" * 20 + "</Consecutive>",
            (18, "automata-construct", "synthesis does not take more than 100000 states"),
        ),
    ],
)
def test_a_generator_has_limits(before: str, after: str, fault: tuple[int, str, str]) -> None:
    assert before in MACHINE
    _, line, _, rule, message = faults({"m.gen": MACHINE.replace(before, after, 1)}, "m.gen")[0]
    assert (line, rule, message) == fault


@pytest.mark.parametrize("again", ["m.gen", "other/../m.gen"])
def test_a_list_names_a_file_once(again: str) -> None:
    files = {"m.gen": MACHINE, "all.automata": f"plant m.gen\nrequirement {again}\n"}
    message = "the list names `m.gen` twice"
    assert faults(files, "all.automata") == [("all.automata", 2, 1, "automata-declaration", message)]


@pytest.mark.parametrize(("kind", "rule"), [("state", "unique-state"), ("event", "automata-declaration")])
def test_an_id_is_unique(kind: str, rule: str) -> None:
    text = (_MODELS / "mouse.xmd").read_text(encoding="utf-8").replace(f'<{kind} id="1"', f'<{kind} id="0"', 1)
    found = [fault for fault in faults({"m.xmd": text}, "m.xmd") if fault[3] == rule]
    assert [message for *_, message in found] == [f"there are two {kind}s with the id `0`"]
    assert f'<{kind} id="0"' in text.splitlines()[found[0][1] - 1]
