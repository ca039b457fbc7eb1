"""Models at the limits of the C engine."""

from robosc.model import sct
from robosc.model.places import Place
from tests.sct_models import edge, model, plant


def _one(name: str, events: dict[str, str], **more):
    """Return a plant with two locations; each event leads from one to the other."""
    there_and_back = {
        "here": [edge(event, to="there") for event in events],
        "there": [edge(event, to="here") for event in events],
    }
    return plant(
        name,
        there_and_back,
        controllable=[event for event in events if event.startswith("c_")],
        uncontrollable=[event for event in events if event.startswith("u_")],
        **more,
    )


def _still(name: str, events: list[str], **more):
    return plant(
        name,
        {"only": [edge(event) for event in events]},
        controllable=[event for event in events if event.startswith("c_")],
        uncontrollable=[event for event in events if event.startswith("u_")],
        **more,
    )


def nothing() -> sct.SupervisoryControlModel:
    """Return a model without events and states."""
    return model([_still("p", [])], guards={}, name="Nothing")


def incoming() -> sct.SupervisoryControlModel:
    """Return a model without commands."""
    return model([_one("p", {"u_response": ""})], guards={}, name="Incoming")


def triggers() -> sct.SupervisoryControlModel:
    """Return triggers that share no topic and are always possible."""
    return model([_still("p", ["c_trigger"]), _still("q", ["c_trigger"])], guards={}, name="Triggers")


def one_trigger() -> sct.SupervisoryControlModel:
    """Return a single trigger, of a service."""
    return model([_one("p", {"c_trigger": ""}, kind="service")], guards={}, name="OneTrigger")


def cancels() -> sct.SupervisoryControlModel:
    """Return cancels without triggers."""
    return model([_one("p", {"c_cancel": ""}), _one("q", {"c_cancel": ""})], guards={}, name="Cancels")


def cancel_and_trigger() -> sct.SupervisoryControlModel:
    """Return a cancel and a trigger."""
    return model([_one("p", {"c_cancel": "", "c_trigger": ""}, kind="action")], guards={}, name="CancelAndTrigger")


def silent() -> sct.SupervisoryControlModel:
    """Return a silent event that never comes to rest."""
    return model([_one("p", {"c_tau1": ""})], guards={}, name="Silent")


def data() -> sct.SupervisoryControlModel:
    """Return data without a command."""
    steps = [edge("c_d1", to="d1", when="p.here"), edge("c_none", to="none", when="not p.here")]
    chosen = plant("data_p", {"none": steps, "d1": steps}, controllable=["c_d1", "c_none"], kind="data", origin="P.p")
    return model([_one("p", {"u_response": ""}), chosen], guards={}, name="Data")


def swap() -> sct.SupervisoryControlModel:
    """Return updates that need the old values, within a plant, between plants and by location."""
    return model(
        [
            plant(
                "a",
                {
                    "x": [edge("u_response", to="y", do={"v": "w", "w": "v", "t": "b.k + v"})],
                    "y": [edge("u_response", to="x", do={"w": "v", "v": "5 - w"})],
                },
                uncontrollable=["u_response"],
                variables={"v": "0..5 = 1", "w": "0..5 = 4", "t": "-3..7"},
            ),
            plant(
                "b",
                {"x": [edge("a.u_response", to="z", do={"k": "a.t - 1"})], "z": [edge("a.u_response", to="x")]},
                variables={"k": "-10..10"},
            ),
        ],
        guards={},
        name="Swap",
    )


def wide() -> sct.SupervisoryControlModel:
    """Return ranges and computations up to 64 bits."""
    biggest = 2**63 - 1
    return model(
        [
            plant(
                "p",
                {
                    "x": [
                        edge("u_response", do={"a": "a + i", "b": "b - a", "c": "a - 1", "d": "d + 1 - e", "e": "-f"}),
                        edge("u_error", do={"e": "e * f - d", "f": "f - 40000", "u": "u + 40000", "h": "h + 1"}),
                        edge("u_feedback", when="e - 1 < u and u * 2 > e", do={"g": "f if a > e else d", "u": "b - d"}),
                    ]
                },
                uncontrollable={"u_response": ["i"], "u_error": [], "u_feedback": []},
                inputs={"i": f"{-(2**31)}..{2**31 - 1}"},
                variables={
                    "a": f"{-(2**62)}..{2**62}",
                    "b": f"-{2**61}..{2**61}",
                    "c": f"{-biggest - 1}..{biggest} = {-biggest}",
                    "d": "-128..127",
                    "e": "-32768..32767 = 32767",
                    "f": "0..65535 = 65535",
                    "g": "-70000..70000",
                    "h": "5..5",
                    "u": f"0..{2**32 - 1}",
                },
            )
        ],
        guards={},
        name="Wide",
    )


def names() -> sct.SupervisoryControlModel:
    """Return names that are keywords or macros of C and C++, clash with other names or the engine, or are not ASCII."""
    return model(
        [
            plant("int", {"if": [edge("u_response", to="else")], "else": []}, uncontrollable=["u_response"]),
            plant("a", {"b": [edge("int.u_response")]}, variables={"b_c": "0..3", "class": "bool"}),
            plant("a_b", {"x": [], "d": []}, variables={"c": "0..9"}),
            plant("a_b_c", {"bool": [], "NULL": []}),
            plant("event", {"name": [], "ünïcode": []}, variables={"名": "0..3"}),
            _one("init", {"u_error": ""}),
            _one("self", {"c_trigger": ""}, variables={"state": "bool"}),
            _one("state", {"c_tau1": ""}),
            *(_one(name, {"u_response": ""}) for name in ("EVENTS", "errno", "UINT32_MAX", "_Bool")),
        ],
        enumerations={"event": ["name", "count"], "a_b": ["c", "x"], "settings": ["hooks"]},
        guards={"self.c_trigger": "self.state or state.here"},
        name="Class",
    )


def texts() -> sct.SupervisoryControlModel:
    """Return texts that try to end the comment around them."""
    evil = 'needs */ int main; /* ??/\n// \\ \u202e\u2066 "%s" /*/ */*/ ??) ' + "x" * 200
    made = model(
        [
            _still("p", ["c_trigger", "c_tau1"], kind="message", topic=evil, origin=evil),
            _one("q", {"u_response": ""}, origin="*/\\", topic="\\"),
        ],
        guards={"c_trigger": "q.here", "c_tau1": ("q.here", "q.there")},
        name="Texts",
    )
    condition = sct.LocationReference(location=made.plants[1].locations[0])
    made.requirements.append(
        sct.Requirement(
            event=made.plants[0].events[0],
            kind=sct.RequirementKind.needs,
            condition=condition,
            text=evil,
            source=Place.parse("*/evil*/.rscd:1:1-1:2"),
        )
    )
    return made


def shared() -> sct.SupervisoryControlModel:
    """Return guards with common conditions (whole, nested, negated) and comparisons that many guards share."""
    steps = {
        "u_response": {"n": "n + 1", "m": "m - 1"},
        "u_error": {"n": "n - 2", "m": "m + 3"},
    }
    store = plant(
        "store",
        {
            "here": [edge(event, to="there", do=do) for event, do in steps.items()],
            "there": [edge("u_error", to="here")],
        },
        uncontrollable=list(steps),
        variables={"n": "0..9 = 5", "m": "0..9"},
    )
    either = "(store.n > 3 or store.m > 6 and store.here)"
    guards = {
        "p0.c_trigger": (f"{either} and store.n < 7", "store.m < 9"),
        "p1.c_trigger": (f"not {either}", "store.m < 9"),
        "p2.c_trigger": (either, "store.m < 9 and store.n < 7"),
        "p3.c_trigger": ("store.n < 7 and store.m < 9", f"store.there or {either}"),
        "p4.c_trigger": ("store.m < 9", None),
        "p5.c_tau1": (f"store.there and {either}", "store.m < 9"),
    }
    others = [_still(name, [event]) for name, event in (guard.split(".") for guard in list(guards)[:-1])]
    return model([store, *others, _one("p5", {"c_tau1": ""})], guards=guards, name="Shared")


def large() -> sct.SupervisoryControlModel:
    """Return a large model: event sets need a second level of words, and all features of the control loop occur."""
    counts = [edge("a0.u_error", do={"n": "n + 30"}), edge("a1.u_error", do={"n": "n - 25"})]
    plants = [plant("hub", {"only": counts}, variables={"n": "0..99"})]
    for number in range(180):
        there_and_back = {
            "idle": [edge("c_trigger", to="busy"), edge("u_error", to="idle")],
            "busy": [edge("c_cancel", to="idle"), edge("u_response", to="idle"), edge("c_tau1", to="idle")],
        }
        plants.append(
            plant(
                f"a{number}",
                there_and_back,
                controllable=["c_trigger", "c_cancel", "c_tau1"],
                uncontrollable=["u_response", "u_error"],
                kind="action" if number % 3 else "message",
                topic=f"/t{number % 7}",
                origin=f"A.a{number}",
            )
        )
        if number % 5 == 0:
            chosen = [edge("c_d1", to="d1", when=f"a{number}.busy"), edge("c_none", to="none")]
            plants.append(
                plant(
                    f"data_a{number}",
                    {"none": chosen, "d1": chosen},
                    controllable=["c_d1", "c_none"],
                    kind="data",
                    origin=f"A.a{number}",
                )
            )
    return model(
        plants,
        guards={
            f"a{number}.{event}": f"a{(7 * number + 3) % 180}.{location}" if number % 4 else "hub.n < 50"
            for number in range(180)
            for event, location in (("c_trigger", "idle"), ("c_tau1", "busy"), ("c_cancel", "idle"))
        },
        name="Large",
    )


ALL = (
    nothing, incoming, triggers, one_trigger, cancels, cancel_and_trigger, silent, data, swap, wide, names, texts,
    shared
)  # fmt: skip
