"""Models from the literature with known supervisors."""

from robosc.model import sct
from tests.sct_models import edge, model, needs, plant


def machine(number: int):
    """Return a machine that starts on command and finishes at any time."""
    start, done = f"start{number}", f"done{number}"
    return plant(
        f"M{number}",
        {"idle": [edge(start, to="busy")], "busy": [edge(done, to="idle")]},
        controllable=[start],
        uncontrollable=[done],
    )


def machine_buffer_machine() -> sct.SupervisoryControlModel:
    """Return Ramadge and Wonham's small factory: M1 must not finish while the buffer's only place is taken."""
    buffer = plant(
        "B",
        {
            "empty": [edge("done1", to="full")],
            "full": [edge("start2", to="empty"), edge("done1", to="overflow")],
            "overflow": [],
        },
    )
    return model([machine(1), machine(2), buffer])


def counting_buffer() -> sct.SupervisoryControlModel:
    """Return the same factory with a buffer of three places and a requirement; further parts are lost."""
    buffer = plant(
        "B",
        {"only": [edge("done1", do={"n": "n + 1"}), edge("start2", do={"n": "n - 1"})]},
        variables={"n": "0..3"},
    )
    return model([machine(1), machine(2), buffer], [needs("start2", "B.n > 0")])


def philosophers(number: int) -> sct.SupervisoryControlModel:
    """Return philosophers who take their forks in any order and put both down at once.

    Each fork is free or is held by its left or right philosopher, which determines the state of each philosopher:
    3^number states. Two of them are deadlocks: all philosophers have their left fork, or all have their right fork.
    """
    philosophers_ = [
        plant(
            f"P{i}",
            {
                "thinking": [edge(f"left{i}", to="has_left"), edge(f"right{i}", to="has_right")],
                "has_left": [edge(f"right{i}", to="eating")],
                "has_right": [edge(f"left{i}", to="eating")],
                "eating": [edge(f"put{i}", to="thinking")],
            },
            controllable=[f"left{i}", f"right{i}"],
            uncontrollable=[f"put{i}"],
        )
        for i in range(number)
    ]
    forks = [
        plant(
            f"F{i}",
            {
                "free": [edge(f"left{i}", to="taken"), edge(f"right{(i - 1) % number}", to="taken")],
                "taken": [edge(f"put{i}", to="free"), edge(f"put{(i - 1) % number}", to="free")],
            },
        )
        for i in range(number)
    ]
    return model([*philosophers_, *forks])
