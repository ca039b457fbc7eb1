"""The engine models of small robots, and their equivalence with the sct models."""

import sys
from collections.abc import Sequence
from contextlib import suppress
from random import Random

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import robosc
from robosc.analysis.supervise import supervise
from robosc.base.cache import cache_results
from robosc.base.diagnostics import ModelError
from robosc.engine import Engine
from robosc.m2m.sct_to_engine import transform
from robosc.m2m.sct_to_engine.collect_events import shorten
from robosc.model import engine, sct, xmi
from robosc.model import expression as ex
from robosc.model.reflection import tree
from robosc.synthesis import synthesize
from tests.language.cif.comparing import reading_of
from tests.language.cif.random_specifications import Specification
from tests.m2m.sct_to_engine import oracle
from tests.random_sct import sct_models
from tests.sct_models import disables, edge, model, needs, plant
from tests.searching import examples
from tests.small_stack import on_small_stack

_SYMBOLS = {
    ex.Equation: "==", ex.Inequation: "!=", ex.LessThan: "<", ex.LessOrEqual: "<=", ex.GreaterThan: ">",
    ex.GreaterOrEqual: ">=", ex.Addition: "+", ex.Subtraction: "-", ex.Multiplication: "*",
}  # fmt: skip


def text(node: ex.Expression | None) -> str:  # noqa: C901, PLR0912 - one case a class
    """Return an expression of an engine model, with every compound operand in parentheses."""
    match node:
        case None:
            return "true"
        case engine.And() | engine.Or():
            return f" {'and' if isinstance(node, engine.And) else 'or'} ".join(map(inner, node.operands))
        case ex.BinaryExpression():
            return f"{inner(node.left)} {_SYMBOLS[type(node)]} {inner(node.right)}"
        case ex.Negation():
            return f"not {inner(node.operand)}"
        case ex.UnaryMinus():
            return f"-{inner(node.operand)}"
        case engine.Saturation():
            return f"sat{node.bits}({text(node.operand)}, {node.minimum}, {node.maximum})"
        case engine.Conversion():
            return f"{'wide' if node.widens else ''}{'i' if node.signed else 'u'}{node.bits}({text(node.operand)})"
        case ex.Conditional():
            return f"{inner(node.then)} if {inner(node.condition)} else {inner(node.otherwise)}"
        case engine.VariableReference():
            return node.variable.name + ("'" if node.before else "")
        case engine.InputReference():
            return node.input.name
        case engine.ConditionReference():
            return node.condition.name
        case engine.LocationLiteral():
            return node.location.name
        case ex.EnumerationLiteralReference():
            return node.literal.name
    return str(node.value).lower()


def inner(node: ex.Expression) -> str:
    written = text(node)
    return f"({written})" if " " in written and not written.startswith("(") else written


def guard_of(made: engine.EngineModel, name: str) -> list[tuple[str, list[str]]]:
    event = next(event for event in made.events if event.name == name)
    return [(text(term.condition), [origin.name for origin in term.origins]) for term in event.guard.terms]


def effect_of(made: engine.EngineModel, name: str) -> list[str]:
    event = next(event for event in made.events if event.name == name)
    lines = []
    for step in event.effect.steps:
        if isinstance(step, engine.Assignment):
            lines.append(f"{step.variable.name} := {text(step.value)}")
        else:
            for case in step.cases:
                does = "; ".join(
                    f"{assignment.variable.name} := {text(assignment.value)}" for assignment in case.assignments
                )
                lines.append(f"{'else' if case.condition is None else text(case.condition)}: {does}")
    return lines


def machine(when: str | None = None, guards: object = (None, None), **do: str) -> sct.SupervisoryControlModel:
    """Return one plant with three locations, an event from the first, and variables of every type."""
    return model(
        [
            plant(
                "p",
                {"here": [edge("c_tau1", when=when, do=do)], "there": [], "far": []},
                controllable=["c_tau1"],
                variables={
                    "n": "0..9",
                    "m": "-5..5",
                    "w": "0..100000",
                    "v": "0..40000",
                    "b": "bool",
                    "c": "bool",
                    "e": "E",
                },
            ),
            plant("q", {"on": [], "off": []}),
            plant("r", {"only": []}),
        ],
        enumerations={"E": ["x", "y", "z"]},
        guards={"c_tau1": guards},
    )


PLACE = ("p == here", ["plants"])


@pytest.mark.parametrize(
    ("when", "terms"),
    [
        ("n >= 0", []),
        ("n > 9", None),
        ("n < 3 and n > 5", None),
        ("n < 7 or n > 5", []),
        ("n < 3", ["p.n < 3"]),
        ("not (n < 3)", ["p.n >= 3"]),
        ("not (n < 3 and b)", ["(p.n >= 3) or (not p.b)"]),
        ("implies(b and c, n == 1)", ["(not p.b) or (not p.c) or (p.n == 1)"]),
        ("b and (c and (b and n == m))", ["p.b", "p.c", "widei16(p.n) == widei16(p.m)"]),
        ("q.on", ["q == on"]),
        ("not q.on", ["q == off"]),
        ("not p.there", ["p != there"]),
        ("p.there", None),
        ("r.only", []),
        ("e != x", ["p.e != x"]),
        ("not (e == x or e == y)", ["p.e != x", "p.e != y"]),
        ("e != x and e != y and e != z", None),
        ("b == true", ["p.b"]),
        ("b == (c or not c)", ["p.b"]),
        ("b != (b and true)", None),
        ("(n if b else n) < n", None),
        ("n + 1 != 1 + n", None),
        ("b == (n > 3)", ["p.b == (p.n > 3)"]),
        ("v < 39999", ["p.v < 39999"]),
        ("w < v", ["p.w < widei32(p.v)"]),
        ("n + m > 3", ["(widei16(p.n) + widei16(p.m)) > 3"]),
    ],
)
def test_guards_are_normalised(when: str, terms: list[str] | None) -> None:
    expected = ["false"] if terms is None else ["p == here", *terms]
    assert guard_of(transform(machine(when)), "p.c_tau1") == [(term, ["plants"]) for term in expected]


def test_each_term_says_who_asks_for_it() -> None:
    made = transform(machine("b", ("b and c", "n < 3 and c")))
    assert guard_of(made, "p.c_tau1") == [
        ("p == here", ["plants"]),
        ("p.b", ["plants", "requirement"]),
        ("p.c", ["requirement", "synthesis"]),
        ("p.n < 3", ["synthesis"]),
    ]
    (event,) = made.events
    parts = (event.guard.plants, event.guard.requirement, event.guard.synthesis)
    assert list(map(text, parts)) == ["(p == here) and p.b", "p.b and p.c", "(p.n < 3) and p.c"]


@pytest.mark.parametrize(
    ("do", "steps"),
    [
        ({"b": "c"}, ["p.b := p.c"]),
        ({"n": "n"}, []),
        ({"n": "12"}, ["p.n := 9"]),
        ({"n": "n + 1"}, ["p.n := u8(sat32(widei16(p.n) + 1, 0, 9))"]),
        ({"m": "n - 4"}, ["p.m := i8(widei16(p.n) - 4)"]),
        ({"n": "w"}, ["p.n := u8(sat32(p.w, 0, 9))"]),
        ({"w": "n"}, ["p.w := i32(p.n)"]),
        ({"n": "n if b else 3"}, ["p.n := u8(widei32(p.n) if p.b else widei32(3))"]),
        ({"b": "c", "c": "n < 3"}, ["p.b := p.c", "p.c := p.n < 3"]),
        ({"c": "n < 3", "b": "c"}, ["p.b := p.c", "p.c := p.n < 3"]),
        ({"b": "c", "c": "b"}, ["p.b := p.c", "p.c := p.b'"]),
        ({"e": "y if b else e"}, ["p.e := y if p.b else p.e"]),
    ],
)
def test_effects_are_simultaneous(do: dict[str, str], steps: list[str]) -> None:
    assert effect_of(transform(machine(**do)), "p.c_tau1") == steps


@pytest.mark.parametrize(
    ("edges", "steps"),
    [
        ({"x": "y", "y": "y"}, ["p := y"]),
        ({"x": "y", "y": "y", "z": "z"}, ["p == x: p := y"]),
        ({"x": "y", "y": "x", "z": "z"}, ["p == x: p := y", "p == y: p := x"]),
        ({"x": "y", "y": "y", "z": "x"}, ["p != z: p := y", "else: p := x"]),
        ({"x": "x", "y": "y", "z": "z"}, []),
    ],
)
def test_staying_is_going_to_the_same_location_where_that_takes_fewer_conditions(
    edges: dict[str, str], steps: list[str]
) -> None:
    p = plant("p", {place: [edge("c_tau1", to=to)] for place, to in edges.items()}, controllable=["c_tau1"])
    assert effect_of(transform(model([p], guards={})), "p.c_tau1") == steps


def test_of_edges_that_may_be_taken_together_one_is_chosen() -> None:
    p = plant(
        "p",
        {
            "x": [
                edge("u_response", to="y", when="n == 3", do={"n": "1"}),
                edge("u_response", to="z", when="n == 0", do={"n": "2"}),
                edge("u_response", to="y", when="n == 0 or n == 4", do={"n": "1"}),
            ],
            "y": [edge("u_response", when="n < 5"), edge("u_response", when="n < 7", do={"n": "1"})],
            "z": [],
        },
        uncontrollable={"u_response": ()},
        variables={"n": "0..9"},
    )
    assert effect_of(transform(model([p], guards={})), "p.u_response") == [
        "(p == x) and (p.n == 3): p.n := 1; p := y",
        "(p == x) and (p.n == 0): p.n := 2; p := z",
        "p == x: p.n := 1; p := y",
        "(p == y) and (p.n < 7) and (p.n >= 5): p.n := 1",
    ]


def test_a_case_does_not_say_again_what_the_cases_before_it_deny() -> None:
    p = plant(
        "p",
        {
            "x": [
                edge("c_tau1", when="m == 1", do={"n": "1"}),
                edge("c_tau1", when="not m == 1 and b and c", do={"n": "2"}),
                edge("c_tau1", "y", when="not m == 1 and not (b and c) and v > 3", do={"n": "3"}),
            ],
            "y": [
                edge("c_tau1", to="x", when="m == 1", do={"n": "1"}),
                edge("c_tau1", to="x", when="not m == 1", do={"n": "4"}),
            ],
            "z": [],
        },
        controllable=["c_tau1"],
        variables={"n": "0..9", "m": "0..9", "v": "0..9", "b": "bool", "c": "bool"},
    )
    assert effect_of(transform(model([p], guards={})), "p.c_tau1") == [
        "p.m == 1: p.n := 1",
        "(p == x) and p.b and p.c: p.n := 2",
        "p == x: p.n := 3",
        "else: p.n := 4",
        "(p == x) and (p.m == 1) or (p.b and p.c) or (p == y): p := x",
        "else: p := y",
    ]


def test_an_effect_that_depends_on_a_location_is_a_switch() -> None:
    p = plant(
        "p",
        {
            "a": [edge("c_tau1", to="b", do={"n": "1"})],
            "b": [edge("c_tau1", to="c", do={"n": "2"})],
            "c": [edge("c_tau1", to="a", do={"n": "2"})],
            "d": [],
        },
        controllable=["c_tau1"],
        variables={"n": "0..9"},
    )
    made = transform(model([p], guards={}))
    assert guard_of(made, "p.c_tau1") == [("p != d", ["plants"])]
    assert effect_of(made, "p.c_tau1") == [
        "p == a: p.n := 1",
        "else: p.n := 2",
        "p == a: p := b",
        "p == b: p := c",
        "else: p := a",
    ]


def test_what_guards_have_in_common_is_a_condition() -> None:
    events = ["c_one", "c_two", "c_three"]
    p = plant(
        "p", {"here": [edge(event) for event in events]}, controllable=events, variables={"n": "0..9", "b": "bool"}
    )
    guards = {
        "c_one": "n < 3 or b",
        "c_two": ("n > 5 and (b or n < 3)", "n != 7 and b"),
        "c_three": (None, "n != 7 and b"),
    }
    made = transform(model([p], guards=guards))
    conditions = {
        condition.name: (text(condition.value), [e.name for e in condition.events]) for condition in made.conditions
    }
    assert sorted(conditions.values()) == [
        ("(p.n != 7) and p.b", ["p.c_two", "p.c_three"]),
        ("(p.n < 3) or p.b", ["p.c_one", "p.c_two"]),
    ]
    names = {value[0]: name for name, value in conditions.items()}
    either, both = names["(p.n < 3) or p.b"], names["(p.n != 7) and p.b"]
    assert guard_of(made, "p.c_one") == [(either, ["requirement"])]
    assert guard_of(made, "p.c_two") == [("p.n > 5", ["requirement"]), (either, ["requirement"]), (both, ["synthesis"])]
    assert guard_of(made, "p.c_three") == [(both, ["synthesis"])]
    assert all(not condition.readers for condition in made.conditions)


def test_reasons_are_requirements_plants_and_what_synthesis_prevents() -> None:
    p = plant(
        "p",
        {
            "here": [edge("c_trigger", "there", when="n < 3"), edge("c_tau1")],
            "there": [edge("c_tau1", "far")],
            "far": [],
        },
        controllable=["c_trigger", "c_tau1"],
        variables={"n": "0..9"},
    )
    q = plant("q", {"on": [edge("p.c_trigger", when="b")]}, variables={"b": "bool"})
    requirements = [
        needs("p.c_trigger", "p.n > 5", "requirement one"),
        disables("p.c_trigger", "p.there and q.b"),
        needs("p.c_trigger", "p.n < 10", "which always holds"),
        needs("p.c_tau1", "p.n == 0", "requirement two"),
    ]
    made = model([p, q], requirements, guards={})
    guard = next(guard for guard in made.supervisor.guards if guard.event.name == "c_trigger")
    guard.explanation = "p stays far for ever"
    found = {
        event.name: [
            (reason.kind.name, text(reason.condition), reason.text, reason.location and reason.location.name)
            for reason in event.reasons
        ]
        for event in transform(made).events
    }
    assert found == {
        "p.c_tau1": [("requirement", "p.n > 0", "requirement two", None)],
        "p.c_trigger": [
            ("requirement", "p.n <= 5", "requirement one", None),
            ("requirement", "(p == there) and q.b", "a requirement", None),
            ("plants", "(p != here) or (p.n >= 3)", "p.", "p"),
            ("plants", "not q.b", "q.on", None),
            ("synthesis", "true", "p stays far for ever", None),
        ],
    }


@pytest.mark.parametrize(("steps", "kept"), [(1, 1), (4, 4), (30, 6)])
def test_an_explanation_has_as_many_of_its_last_steps_as_fit(steps: int, kept: int) -> None:
    trace = [f"request to `Base.number_{number:04} goes` " for number in range(steps)]
    text = f"after {', then '.join(trace)}, `requirement R` is violated"
    short = shorten(text)
    if kept == steps:
        assert short == text
        return
    assert short.startswith(f"after {steps - kept} steps, then {trace[steps - kept]}")
    assert short.endswith("`requirement R` is violated (`robosc explain` lists all steps)")
    assert len(short) < 400


def test_readers_are_those_of_what_an_event_writes() -> None:
    p = plant(
        "p",
        {"here": [edge("c_tau1", "there", do={"n": "n + 1"})], "there": [edge("c_tau2", "here", when="n < 3")]},
        controllable=["c_tau1", "c_tau2"],
        variables={"n": "0..9", "m": "0..9"},
    )
    q = plant("q", {"on": [edge("c_tau1", do={"k": "0"})]}, controllable=["c_tau1"], variables={"k": "0..1"})
    made = transform(model([p, q], guards={}), polled=0)
    assert made.incremental
    assert {event.name: [reader.name for reader in event.readers] for event in made.events} == {
        "p.c_tau1": ["p.c_tau1", "p.c_tau2"],
        "p.c_tau2": ["p.c_tau1", "p.c_tau2"],
        "q.c_tau1": [],
    }


def test_the_state_is_stored_as_small_as_it_can_be() -> None:
    made = transform(machine())
    assert [
        (variable.name, variable.bits, variable.signed, variable.minimum, variable.maximum)
        for variable in made.variables
    ] == [
        ("p", 8, False, 0, 2),
        ("p.n", 8, False, 0, 9),
        ("p.m", 8, True, -5, 5),
        ("p.w", 32, True, 0, 100000),
        ("p.v", 16, False, 0, 40000),
        ("p.b", 8, False, 0, 1),
        ("p.c", 8, False, 0, 1),
        ("p.e", 8, False, 0, 2),
        ("q", 8, False, 0, 1),
    ]


def _supervised(made: sct.SupervisoryControlModel) -> sct.SupervisoryControlModel:
    made.supervisor = synthesize(made).supervisor
    if made.supervisor is None:
        events = [event for plant in made.plants for event in plant.events if event.controllable]
        made.supervisor = sct.Supervisor(guards=[sct.EventGuard(event=event) for event in events])
    return made


@pytest.mark.slow
@settings(max_examples=examples(30), deadline=None, suppress_health_check=list(HealthCheck))
@given(sct_models(), st.randoms(use_true_random=False))
def test_an_engine_model_means_what_its_sct_model_does(made: sct.SupervisoryControlModel, random) -> None:
    _follow(_supervised(made), random)


@pytest.mark.slow
def test_of_several_edges_that_may_be_taken_one_is_with_all_that_it_changes() -> None:
    several = 0
    for seed in (68, 185, *range(examples(30))):
        made = reading_of(Specification(seed)).model
        if made is not None:
            with suppress(ModelError):  # no supervisor, or one that the engine cannot execute
                supervise(made)
                several += _follow(made, Random(seed))  # noqa: S311 - nothing is secret
    assert several


def _follow(made: sct.SupervisoryControlModel, random: Random) -> int:
    """Perform random events and compare with the definition; return how many events had several outcomes."""
    events, several = [event for plant in made.plants for event in plant.events], 0
    executed, state = Engine(made), oracle.started(made)
    names = dict(zip(events, executed.events, strict=True))
    for _ in range(30):
        for event, name in names.items():
            reason = executed.blocked_by(name)
            assert (None if reason is None else reason.value) == oracle.blocked(made, event, state)
            assert executed.failing_requirements(name) == oracle.failing(made, event, state)
            if event.kind in (sct.EventKind.cancel, sct.EventKind.trigger):
                assert _without_edge(executed, event) == oracle.without_edge(made, event, state)
        possible = [event for event in events if oracle.blocked(made, event, state) is None]
        if not possible:
            break
        event = random.choice(possible)
        inputs, data = {}, {}
        for declared in event.inputs:
            value = random.choice(oracle.values(declared.type))
            inputs[declared], data[declared.name] = value, _shown(value)
        assert executed.perform(names[event], data)
        reached: dict[object, object] = {owner: owner.locations[executed.location(owner)].name for owner in made.plants}
        reached |= {variable: executed.value(variable) for owner in made.plants for variable in owner.variables}
        after = oracle.after(made, event, state, inputs)
        shown = [{element: _shown(value) for element, value in state.items()} for state in after]
        assert reached == shown[0]
        state = after[0]
        several += any(other != reached for other in shown)
    return several


def _shown(value: object) -> object:
    return value.name if isinstance(value, ex.EnumerationLiteral | sct.Location) else value


def _without_edge(executed: Engine, event: sct.Event) -> list[tuple[str, str]]:
    """Return the plants that block an event now according to the engine model, each with its location."""
    (element,) = (element for element in executed.executed.events if element.event is event)
    found = []
    for reason in element.reasons:
        if reason.kind == engine.Origin.plants and executed.condition(reason.condition)():
            place = reason.location and reason.location.plant.locations[executed.cell(reason.location)].name
            plant, _, location = f"{reason.text}{place or ''}".rpartition(".")
            found.append((plant, location))
    return found


@pytest.mark.slow
@settings(max_examples=examples(12), deadline=None, suppress_health_check=list(HealthCheck))
@given(sct_models())
def test_engine_models_can_be_saved_and_are_the_same_each_time(made: sct.SupervisoryControlModel) -> None:
    _supervised(made)
    saved = [
        xmi.to_texts({"r.sct.xmi": made, "r.engine.xmi": transform(made, polled)})["r.engine.xmi"]
        for polled in (0, 0, 64)
    ]
    assert saved[0] == saved[1]
    assert ('incremental="true"' in saved[2]) is False


def test_a_model_is_transformed_once_while_it_is_remembered() -> None:
    made = machine()
    with cache_results():
        first = transform(made)
        with cache_results():
            assert transform(made) is first
        assert transform(made) is first
    assert transform(made) is not transform(made)


def test_a_model_needs_its_supervisor() -> None:
    made = machine()
    made.supervisor = None
    with pytest.raises(ValueError, match="synthesize it first"):
        robosc.to_engine(made)


def _long(operators: int, *, nested: bool) -> sct.SupervisoryControlModel:
    p = plant(
        "p", {"here": [edge("c_tau1", when="n == 0")]}, controllable=["c_tau1"], variables={"n": "0..9", "b": "bool"}
    )
    made = model([p], guards={})
    (loop,) = made.plants[0].locations[0].edges
    n = made.plants[0].variables[0]
    condition: ex.Expression = loop.guard
    for number in range(operators):
        more = ex.Inequation(left=sct.VariableReference(variable=n), right=ex.IntegerLiteral(value=number % 10))
        kind = ex.Implication if nested and number % 2 else ex.Disjunction if nested else ex.Conjunction
        condition = kind(left=condition, right=more)
    total: ex.Expression = ex.IntegerLiteral(value=0)
    for _ in range(operators):
        total = ex.Addition(left=total, right=sct.VariableReference(variable=n))
    loop.guard = condition
    loop.updates.append(sct.Update(variable=n, value=total))
    return made


@pytest.mark.slow
@pytest.mark.parametrize("nested", [False, True])
def test_long_expressions_need_no_deep_calls(nested: bool) -> None:
    """Runs in a thread with a stack of half a megabyte, under Python's default recursion limit."""
    made = _long(3000, nested=nested)
    on_small_stack(lambda: Engine(made).perform("p.c_tau1"))
    assert sys.getrecursionlimit() <= 3000


@pytest.mark.slow
def test_the_transformation_is_linear() -> None:
    """The test counts the elements that an expression produces instead of measuring time."""
    steps = (500, 2000)
    sizes = [sum(1 for _ in tree(transform(_long(count, nested=True)))) for count in steps]
    assert sizes[1] <= sizes[0] * (steps[1] / steps[0]) * 1.1


@pytest.mark.parametrize(
    "guards",
    [
        ("times >= 3", "value"),
        ("times <= 0", "value"),
        ("times != 3", "value"),
        ("3 > times", "times = 0 and value"),
        ("(if a then b else times >= 3) and value", "times != 0 and (if value then a else b)"),
        ("(times > 0 => (if b then a else !value)) and value", "a = b and value"),
        ("a or !(if value then false else value)", "value"),
        ("value and !value and a", "if value then value else true"),
        ("!(if value then value else true)", "if value then value else true"),
        ("a", "!a and (if b then value else !value)"),
        ("a", "!a and (a or value = b)"),
        ("a and value = b", "a or value = b"),
        ("a and value = b", "a and value != b"),
        ("(a or value = b) and value", "(a or value != b) and value"),
        ("times < 3 and (a or value)", "times < 2 and (b or value) or times < 1 and value = a"),
    ],
)
def test_transitions_that_are_tried_in_order_leave_nothing_open(guards: Sequence[str]) -> None:
    """A response is never blocked by conditions that read its data or by the bounds of a variable."""
    for most in (3, 3000):
        assert always_possible([guard.replace("= 3", f"= {most}") for guard in guards], most)


_CONDITIONS = st.recursive(
    st.sampled_from(["a", "b", "value", "value = a", "times = 0", "times < 2", "times > 1", "times >= 3", "false"]),
    lambda inner: st.one_of(
        inner.map("!({})".format),
        st.builds("({}) {} ({})".format, inner, st.sampled_from(["and", "or", "=>", "="]), inner),
        st.builds("(if {} then {} else {})".format, inner, inner, inner),
    ),
    max_leaves=5,
)


@given(guards=st.lists(_CONDITIONS, min_size=1, max_size=4))
@settings(max_examples=examples(20), suppress_health_check=[HealthCheck.too_slow])
def test_an_answer_is_never_blocked_by_its_data(guards: list[str]) -> None:
    assert always_possible(guards, 3)


def always_possible(guards: Sequence[str], most: int) -> bool:
    """Return whether a response with these guarded transitions and an unguarded one can always happen."""
    transitions = "\n".join(f"on response from gripped if {guard} do times := times + 1" for guard in guards)
    text = f"""robot R {{ component G {{
        outgoing message gripped with type: boolean
        behaviour {{
            variable times: integer(0..{most}) variable a: boolean variable b: boolean
            initial marked state on {{
                {transitions}
                on response from gripped do a := b, b := value
            }}
        }}
    }} }}"""
    model = robosc.to_sct(robosc.load(text=text))
    robosc.synthesize(model)
    (event,) = [event for event in transform(model).events if event.event.name == "u_response"]
    return not event.guard.terms
