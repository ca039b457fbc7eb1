"""Models that the literature knows the supervisors of."""

from robosc.model import sct
from tests.sct_models import edge, model, needs, plant


def machine(number: int):
    """A machine that starts when told and is done when it likes."""
    start, done = f"start{number}", f"done{number}"
    return plant(
        f"M{number}",
        {"idle": [edge(start, to="busy")], "busy": [edge(done, to="idle")]},
        controllable=[start],
        uncontrollable=[done],
    )


def machine_buffer_machine() -> sct.SupervisoryControlModel:
    """Ramadge and Wonham's small factory: M1 must not be done while the one place of the buffer is taken."""
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
    """The same with three places and a requirement; what comes in beyond is lost."""
    buffer = plant(
        "B",
        {"only": [edge("done1", do={"n": "n + 1"}), edge("start2", do={"n": "n - 1"})]},
        variables={"n": "0..3"},
    )
    return model([machine(1), machine(2), buffer], [needs("start2", "B.n > 0")])


def philosophers(number: int) -> sct.SupervisoryControlModel:
    """Philosophers who take their forks in any order and put both down at once.

    Each fork is free, with its left or with its right philosopher, and that tells what each philosopher does: 3^number
    states. Two of them are deadlocks: all have their left, or all their right fork.
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
