"""Random models of robots: sensors, components, messages on shared topics, services, actions, data."""

from hypothesis import assume
from hypothesis import strategies as st

from robosc.model import sct
from robosc.synthesis import synthesize
from tests.sct_models import disables, edge, model, needs, plant

_MOODS = {"Mood": ["calm", "alert", "lost"]}


@st.composite
def robots(draw: st.DrawFn) -> sct.SupervisoryControlModel:
    """Draw robots with supervisors: messages m0…, a service, an action, and data plants for some commands."""
    timed = draw(st.booleans())
    components = [_component(draw, f"C{number}", timed=timed) for number in range(draw(st.integers(1, 2)))]
    places = [f"component_C{number}.{place}" for number in range(len(components)) for place in ("a", "b")]
    messages = [f"m{number}" for number in range(draw(st.integers(1, 3)))]
    sent = [
        *messages,
        *(["service"] if draw(st.booleans()) else []),
        *(["action"] if draw(st.booleans()) else []),
    ]
    plants = [automaton for pair in components for automaton in pair]
    plants += [
        plant(
            f"message_{name}",
            {"ready": [edge("c_trigger")]},
            controllable=["c_trigger"],
            kind="message",
            topic=draw(st.sampled_from(("/cmd", "cmd", "/other"))),
            origin=f"Base.{name}",
        )
        for name in messages
    ]
    if "service" in sent:
        plants.append(_service())
    if "action" in sent:
        plants.append(_action())
    requirements = []
    for name in sent:
        owner = name if name in ("service", "action") else f"message_{name}"
        asked = [
            (draw(st.sampled_from((needs, disables))), _condition(draw, places)) for _ in range(draw(st.integers(0, 2)))
        ]
        requirements += [make(f"{owner}.c_trigger", condition) for make, condition in asked]
        if name == "action":
            broken = [f"not ({condition})" if make is needs else f"({condition})" for make, condition in asked]
            requirements.append(needs("action.c_cancel", " or ".join(broken) or "false"))
        if draw(st.booleans()):
            plants.append(_data(name, [_condition(draw, places) for _ in range(draw(st.integers(1, 3)))]))
    made = model(plants, requirements, _MOODS)
    _set_times(draw, made)
    made.supervisor = synthesize(made).supervisor
    assume(made.supervisor is not None)
    return made


def _condition(draw: st.DrawFn, places: list[str]) -> str:
    place, other = draw(st.sampled_from(places)), draw(st.sampled_from([*places, "true"]))
    return draw(
        st.sampled_from(
            (place, f"not {place}", f"{place} and {other}", f"{place} or {other}", f"implies({place}, {other})")
        )
    )


def _set_times(draw: st.DrawFn, made: sct.SupervisoryControlModel) -> None:
    """Give each timeout a short time, not necessarily unique; the last of a plant runs in all its locations."""
    messages = [event for plant in made.plants for event in plant.events if event.name == "u_response" and plant.topic]
    for automaton in made.plants:
        timeouts = [event for event in automaton.events if event.kind == sct.EventKind.timeout]
        for event in timeouts:
            location = next(x for x in automaton.locations if any(edge.event is event for edge in x.edges))
            everywhere = event is timeouts[-1]
            without = draw(st.lists(st.sampled_from(messages), min_size=everywhere, max_size=2, unique=True))
            edges = [edge for origin in automaton.locations for edge in origin.edges if edge.target is location]
            event.timer = sct.Timer(
                milliseconds=draw(st.sampled_from((1, 2, 20, 500, 500, 2000, 24 * 24 * 3600 * 1000))),
                location=None if everywhere else location,
                entries=[]
                if everywhere
                else [edge for edge in edges if edge.eContainer() is not location or draw(st.booleans())],
                without=without,
            )


def _component(draw: st.DrawFn, name: str, *, timed: bool):
    """Draw a sensor that reports an integer and a mood, and the automaton that receives its messages."""
    limit, rests = draw(st.integers(0, 3)), draw(st.booleans())
    sensor = plant(
        f"message_sensor{name}",
        {"ready": [edge("u_response")]},
        uncontrollable={"u_response": ["i_response_level", "i_response_mood"]},
        inputs={"i_response_level": "-2..300", "i_response_mood": "Mood"},
        kind="message",
        topic="/sensor",
        origin=f"{name}.sensor{name}",
    )
    heard = {
        "level": f"message_sensor{name}.i_response_level - {draw(st.integers(0, 9))}",
        "mood": f"message_sensor{name}.i_response_mood",
        "last": "level",
    }
    event = f"message_sensor{name}.u_response"
    back = "level <= last" if rests else "true"
    behaviour = plant(
        f"component_{name}",
        {
            "a": [
                *(edges for number in (1, 2, 4) if timed for edges in _timeout(draw, number)),
                edge(event, do=heard),
                edge("c_tau1", to="b", when=f"level > {limit} and mood != lost", do={"last": "level", "level": "last"}),
            ],
            "b": [
                *(edges for number in (3, 4) if timed for edges in _timeout(draw, number)),
                edge(event, to=draw(st.sampled_from(("a", "b"))), do=heard),
                edge("c_tau2", to="a", when=back, do={"level": "level - 1"}),
            ],
        },
        controllable=["c_tau1", "c_tau2"],
        uncontrollable=[f"u_after{number}" for number in (1, 2, 3, 4) if timed],
        variables={"level": "0..5", "last": "0..7 = 3", "mood": "Mood"},
        marked=["a", "b"],
        origin=name,
    )
    return sensor, behaviour


def _timeout(draw: st.DrawFn, number: int) -> list:
    return [edge(f"u_after{number}", to=draw(st.sampled_from((None, "a", "b"))), do={"level": "level + 1"})]


def _service():
    return plant(
        "service",
        {
            "idle": [edge("c_trigger", to="waiting")],
            "waiting": [edge("u_response", to="ready"), edge("u_error", to="error")],
            "ready": [edge("c_reset", to="idle")],
            "error": [edge("c_reset", to="idle")],
        },
        controllable=["c_trigger", "c_reset"],
        uncontrollable=["u_response", "u_error"],
        kind="service",
        topic="/service",
        origin="Base.service",
    )


def _action():
    return plant(
        "action",
        {
            "idle": [edge("c_trigger", to="executing")],
            "executing": [
                edge("u_feedback"),
                edge("u_response", to="ready"),
                edge("u_error", to="error"),
                edge("c_cancel", to="idle"),
            ],
            "ready": [edge("c_reset", to="idle")],
            "error": [edge("c_reset", to="idle")],
        },
        controllable=["c_trigger", "c_reset", "c_cancel"],
        uncontrollable=["u_feedback", "u_response", "u_error"],
        kind="action",
        topic="/action",
        origin="Base.action",
    )


def _data(name: str, conditions: list[str]):
    steps = [edge(f"c_d{number}", to=f"d{number}", when=condition) for number, condition in enumerate(conditions, 1)]
    steps.append(edge("c_none", to="none", when=" and ".join(f"not ({condition})" for condition in conditions)))
    locations = ["none", *(f"d{number}" for number, _ in enumerate(conditions, 1))]
    return plant(
        f"data_{name}",
        dict.fromkeys(locations, steps),
        controllable=[step.event for step in steps],
        marked=locations,
        kind="data",
        origin=f"Base.{name}",
    )
