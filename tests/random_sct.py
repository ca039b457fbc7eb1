"""Random valid sct models, small enough to enumerate their states."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from hypothesis import strategies as st

from robosc.model import sct
from tests.sct_models import Reachable, disables, edge, model, needs, plant

_ENUMERATIONS = {"E": ["e0", "e1", "e2"], "F": ["f0"]}
_CONTROLLABLE = ("c_trigger", "c_cancel", "c_reset", "c_tau1")
_UNCONTROLLABLE = ("u_response", "u_error", "u_feedback")
_KINDS = ("message", "service", "action", "behaviour")


@dataclass(frozen=True)
class _Scope:
    """Names that expressions may read, by type: `bool`, `E`, `F` or a range."""

    locations: tuple[str, ...]
    values: tuple[tuple[str, str], ...]

    def of(self, kind: str) -> list[str]:
        return [name for name, range_ in self.values if (".." if ".." in range_ else range_) == kind]


@dataclass(frozen=True)
class _Sketch:
    """A plant before its edges."""

    name: str
    locations: tuple[str, ...]
    controllable: tuple[str, ...]
    uncontrollable: dict[str, tuple[str, ...]]
    variables: dict[str, str]
    inputs: dict[str, str]


@st.composite
def sct_models(
    draw: st.DrawFn, *, data: bool = True, requirements: bool = False, goals: bool = False
) -> sct.SupervisoryControlModel:
    """Return models without a supervisor: plants with shared events, guards, saturating updates, inputs, requirements.

    With `data`, some have plants like those of provide statements (semantics.md, point 4), which nothing reads. With
    `requirements`, some have invariants, requirement automata, and requirements on uncontrollable events and about
    reachable states; with `goals`, all have the last ones.
    """
    sketches = [draw(_sketches(f"p{index}")) for index in range(draw(st.integers(1, 3)))]
    scope = _Scope(
        tuple(f"{sketch.name}.{location}" for sketch in sketches for location in sketch.locations),
        tuple((f"{sketch.name}.{name}", kind) for sketch in sketches for name, kind in sketch.variables.items()),
    )
    plants = [_plant(draw, sketch, sketches, scope) for sketch in sketches]
    if data:
        plants += [_data_plant(draw, f"data_{index}", scope) for index in range(draw(st.integers(0, 1)))]
    events = [f"{sketch.name}.{event}" for sketch in sketches for event in sketch.controllable]
    if requirements and draw(st.booleans()):
        plants.append(_requirement_automaton(draw, sketches, scope))
        scope = replace(scope, locations=(*scope.locations, "watching.l0", "watching.l1"))
    if requirements:
        events += [f"{sketch.name}.{event}" for sketch in sketches for event in sketch.uncontrollable]
    restrictions = [
        draw(st.sampled_from((needs, disables)))(draw(st.sampled_from(events)), _boolean(draw, scope, 3))
        for _ in range(draw(st.integers(0, 3)) if events else 0)
    ]
    conditions = [_boolean(draw, scope, 3) for _ in range(draw(st.sampled_from((0, 1, 2))) if requirements else 0)]
    wanted = [
        Reachable(
            _boolean(draw, scope, 2),
            _boolean(draw, scope, 2) if draw(st.booleans()) else None,
            _boolean(draw, scope, 2) if draw(st.booleans()) else None,
            draw(st.sampled_from((None, None, 0, 1, 2, 3))),
        )
        for _ in range(draw(st.sampled_from((1, 1, 2) if goals else (0, 0, 1, 2))) if requirements else 0)
    ]
    return model(plants, restrictions, _ENUMERATIONS, invariants=conditions, reachable=wanted)


@st.composite
def _sketches(draw: st.DrawFn, name: str) -> _Sketch:
    inputs = {f"i{index}": draw(_types(3)) for index in range(draw(st.integers(0, 2)))}
    return _Sketch(
        name,
        tuple(f"l{index}" for index in range(draw(st.sampled_from((1, 2, 2, 3))))),
        tuple(draw(st.lists(st.sampled_from(_CONTROLLABLE), min_size=1, max_size=3, unique=True))),
        {
            event: tuple(input_ for input_ in inputs if draw(st.booleans()))
            for event in draw(st.lists(st.sampled_from(_UNCONTROLLABLE), max_size=2, unique=True))
        },
        {f"v{index}": draw(_types(5)) for index in range(draw(st.integers(0, 2)))},
        inputs,
    )


@st.composite
def _types(draw: st.DrawFn, size: int) -> str:
    minimum = draw(st.integers(-4, 3))
    numbers = f"{minimum}..{minimum + draw(st.integers(0, size - 1))}"
    return draw(st.sampled_from(("bool", "bool", "E", "E", "F", *[numbers] * 5)))


def _plant(draw: st.DrawFn, sketch: _Sketch, sketches: Sequence[_Sketch], scope: _Scope):
    own = [(sketch, event) for event in (*sketch.controllable, *sketch.uncontrollable)]
    others = [
        (drawn, event)
        for drawn in sketches
        if drawn is not sketch
        for event in (*drawn.controllable, *drawn.uncontrollable)
        if draw(st.integers(0, 4)) == 0
    ]
    initial, *rest = sketch.locations
    dead = [location for location in rest if draw(st.integers(0, 4)) == 4]
    edges = {
        location: [
            made
            for declaring, event in (() if location in dead else own + others)
            if draw(st.integers(0, 4)) < 4
            for made in _edges(draw, sketch, declaring, event, scope)
        ]
        for location in sketch.locations
    }
    used = {leaving.event for location in sketch.locations for leaving in edges[location]}
    edges[initial] += [edge(f"{sketch.name}.{event}") for _, event in own if f"{sketch.name}.{event}" not in used]
    return plant(
        sketch.name,
        edges,
        controllable=sketch.controllable,
        uncontrollable=sketch.uncontrollable,
        variables={name: f"{kind} = {_constant(draw, kind)}" for name, kind in sketch.variables.items()},
        inputs=sketch.inputs,
        initial=initial,
        marked=[location for location in sketch.locations if location not in dead and draw(st.integers(0, 3)) < 3],
        kind=draw(st.sampled_from(_KINDS)),
        topic=draw(st.sampled_from((sketch.name, "shared"))),
    )


def _edges(draw: st.DrawFn, sketch: _Sketch, declaring: _Sketch, event: str, scope: _Scope):
    """Return one edge, or several in order of preference, like the conditions of a robot.

    The first edge whose guard holds is taken. The guards may read the data of the event.
    """
    carried = declaring.uncontrollable.get(event, ())
    inputs = tuple((f"{declaring.name}.{name}", declaring.inputs[name]) for name in carried)
    with_inputs = replace(scope, values=scope.values + inputs)
    if draw(st.integers(0, 3)):
        guards = [_boolean(draw, scope, 2) if draw(st.integers(0, 2)) == 0 else None]
    else:
        conditions = [f"({_boolean(draw, with_inputs, 2)})" for _ in range(draw(st.integers(1, 2)))]
        denials = [f"not {condition}" for condition in conditions]
        guards = [" and ".join([*denials[:i], *conditions[i : i + 1]]) for i in range(len(conditions) + 1)]
    return [
        edge(
            f"{declaring.name}.{event}",
            to=draw(st.sampled_from(sketch.locations)),
            when=guard,
            do={
                name: _value(draw, kind, with_inputs, 2)
                for name, kind in sketch.variables.items()
                if draw(st.integers(0, 3)) < 3
            },
        )
        for guard in guards
    ]


def _data_plant(draw: st.DrawFn, name: str, scope: _Scope):
    conditions = [_boolean(draw, scope, 2) for _ in range(draw(st.integers(1, 2)))]
    locations = ["none", *(f"d{index}" for index, _ in enumerate(conditions, 1))]
    edges = [
        edge("c_none", to="none", when=" and ".join(f"not ({condition})" for condition in conditions)),
        *(edge(f"c_d{index}", to=f"d{index}", when=condition) for index, condition in enumerate(conditions, 1)),
    ]
    shared = draw(st.booleans())
    return plant(
        name,
        dict.fromkeys(locations, () if shared else edges),
        everywhere=edges if shared else (),
        controllable=[made.event for made in edges],
        marked=locations,
        kind="data",
    )


def _requirement_automaton(draw: st.DrawFn, sketches: Sequence[_Sketch], scope: _Scope):
    """Return an automaton that follows some events and blocks none."""
    events = [
        f"{sketch.name}.{event}" for sketch in sketches for event in (*sketch.controllable, *sketch.uncontrollable)
    ]
    followed = draw(st.lists(st.sampled_from(events), min_size=1, max_size=3, unique=True))
    locations = ("l0", "l1")
    return plant(
        "watching",
        {
            location: [
                edge(event, to=draw(st.sampled_from(locations)), do={"count": _number(draw, scope, 1)})
                for event in followed
            ]
            for location in locations
        },
        variables={"count": "0..2"},
        marked=locations,
        kind="requirement",
    )


def _constant(draw: st.DrawFn, kind: str) -> str:
    if ".." in kind:
        return str(draw(st.integers(*map(int, kind.split("..")))))
    return draw(st.sampled_from(_ENUMERATIONS.get(kind, ("true", "false"))))


def _value(draw: st.DrawFn, kind: str, scope: _Scope, depth: int) -> str:
    if kind == "bool":
        return _boolean(draw, scope, depth)
    return _number(draw, scope, depth) if ".." in kind else _literal(draw, kind, scope, depth)


def _boolean(draw: st.DrawFn, scope: _Scope, depth: int) -> str:
    def again() -> str:
        return _boolean(draw, scope, depth - 1)

    leaves = [*scope.locations, *scope.of("bool")]
    form = draw(st.integers(0, 9)) if depth else 0
    match form:
        case 1:
            return f"not ({again()})"
        case 2 | 3:
            return f"({again()} {draw(st.sampled_from(('and', 'or')))} {again()})"
        case 4:
            return f"implies({again()}, {again()})"
        case 5:
            return f"({again()} if {again()} else {again()})"
        case 6:
            return f"(({again()}) {draw(st.sampled_from(('==', '!=')))} ({again()}))"
        case 7 | 8:
            operator = draw(st.sampled_from(("==", "!=", "<", "<=", ">", ">=")))
            return f"({_number(draw, scope, depth - 1)} {operator} {_number(draw, scope, depth - 1)})"
        case 9:
            kind = draw(st.sampled_from(("E", "F")))
            operator = draw(st.sampled_from(("==", "!=")))
            return f"({_literal(draw, kind, scope, depth - 1)} {operator} {_literal(draw, kind, scope, depth - 1)})"
    return draw(st.sampled_from([*leaves, "true", "false"]))


def _number(draw: st.DrawFn, scope: _Scope, depth: int) -> str:
    def again() -> str:
        return _number(draw, scope, depth - 1)

    match draw(st.integers(0, 7)) if depth else 0:
        case 1 | 2 | 3:
            return f"({again()} {draw(st.sampled_from(('+', '-', '*')))} {again()})"
        case 4:
            return f"(-{again()})"
        case 5:
            return f"({again()} if {_boolean(draw, scope, depth - 1)} else {again()})"
        case 6:
            return f"abs({again()})"
        case 7:
            return f"{draw(st.sampled_from(('min', 'max')))}({again()}, {again()})"
    return draw(st.one_of(st.sampled_from([*scope.of(".."), "2"]), st.integers(-5, 5).map(str)))


def _literal(draw: st.DrawFn, kind: str, scope: _Scope, depth: int) -> str:
    if depth and draw(st.booleans()):
        then, otherwise = (_literal(draw, kind, scope, depth - 1) for _ in range(2))
        return f"({then} if {_boolean(draw, scope, depth - 1)} else {otherwise})"
    return draw(st.sampled_from([*scope.of(kind), *_ENUMERATIONS[kind]]))
