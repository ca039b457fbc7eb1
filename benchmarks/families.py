"""Robots of any size, as RoboSC text, with their numbers of supervised states.

    python benchmarks/families.py philosophers 5

prints five arms at their round table.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from math import comb, perm
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    #: Lines of text.
    Lines = list[str]


@dataclass(frozen=True)
class Family:
    """Family of robots that differ only in a number: the text of each, and its supervised states."""

    name: str
    #: Displayed unit of the number `N`.
    title: str
    text: Callable[[int], str]
    #: Number of supervised states in closed form.
    states: Callable[[int], int]
    #: Numbers to measure, as far as time allows.
    sizes: tuple[int, ...]


def cells(number: int) -> str:
    """Return independent cells, each a line of one place."""
    comment = "Cells that know nothing of each other, each with a place and an inspection that sends back what is bad."
    return _robot("Cells", comment, *(text for i in _count(number) for text in _line(f"Cell{i}", 1)))


def cell_states(number: int) -> int:
    """Return the number of states: each cell is in any of its own."""
    return line_states(1) ** number


def line(number: int) -> str:
    """Return a chain of actions, each of which waits for an empty next place; its end waits for its beginning."""
    comment = "A line of conveyors: what is found bad goes back to the start, where there must be a place for it."
    return _robot("ProductionLine", comment, *_line("Line", number))


def line_states(number: int) -> int:
    """Return the number of states: full places, the inspection, and the state of each action.

    An action is idle or ready; from a full place to an empty one it may also run, or have failed. While it runs, its
    requirement holds, so it is never canceled. Synthesis removes states without an empty place while a tray is
    inspected or rejected.
    """

    def ways(*, first_full: bool, inspection_full: bool) -> int:
        here = {first_full: 1}
        for after in (*range(number - 1), None):
            following = (inspection_full,) if after is None else (False, True)
            here = {
                then: sum(count * (4 if full and not then else 2) for full, count in here.items()) for then in following
            }
        return here[inspection_full]

    waiting_ahead, waiting_behind = (ways(first_full=full, inspection_full=True) for full in (False, True))
    clear = sum(ways(first_full=full, inspection_full=False) for full in (False, True))
    return 2 * clear + (2 + 3) * (waiting_ahead + waiting_behind - 2**number) + waiting_ahead


def _line(name: str, number: int) -> list[Lines]:
    """Return a line of places with an inspection at its end."""
    following = [f"{name}Place{i + 1}" for i in range(1, number)] + [f"{name}Inspection"]
    arrivals = [f"response from {name}_move{i}" for i in range(number)]
    arrivals[0] = f"request to {name}_feed"
    back = f"{name}_return"
    return [
        *(
            _component(
                f"{name}Place{i}",
                [*([_incoming(f"{name}_feed")] if i == 1 else []), _action(f"{name}_move{i}")],
                {
                    "initial marked state empty": [
                        f"on {arrivals[i - 1]} goto full",
                        *(_tried_again(f"{name}_move{i - 1}") if i > 1 else []),
                        *([f"on response from {back} goto full", *_tried_again(back)] if i == 1 else []),
                    ],
                    "state full": [f"on response from {name}_move{i} goto empty", *_tried_again(f"{name}_move{i}")],
                },
            )
            for i in _count(number)
        ),
        _component(
            f"{name}Inspection",
            [_outgoing(f"{name}_good"), _outgoing(f"{name}_bad"), _action(back)],
            {
                "initial marked state empty": [
                    f"on response from {name}_move{number} goto inspecting",
                    *_tried_again(f"{name}_move{number}"),
                ],
                "state inspecting": [
                    f"on response from {name}_good goto empty",
                    f"on response from {name}_bad goto rejected",
                ],
                "state rejected": [f"on request to {back} goto returning"],
                "state returning": [
                    f"on response from {back} goto empty",
                    *(f"on {event} from {back} goto rejected" for event in ("error", "canceled")),
                ],
            },
        ),
        [
            f"requirement {name}_feed needs !{name}Inspection.returning",
            *(
                f"requirement {name}_move{i} needs {name}Place{i}.full and {after}.empty"
                for i, after in enumerate(following, start=1)
            ),
            f"requirement {back} needs {name}Place1.empty",
        ],
    ]


def _tried_again(action: str) -> Lines:
    """Return transitions for an action that fails or is canceled: nothing moves, and the action may start again."""
    return [f"on {event} from {action}" for event in ("error", "canceled")]


def sensors(number: int) -> str:
    """Return sensors around a drive; all of them limit its speed."""
    speeds = {
        "fast": " and ".join(f"Sonar{i}.distance = far" for i in _count(number)),
        "slow": " and ".join(f"Sonar{i}.distance != near" for i in _count(number)),
        "halt": " or ".join(f"Sonar{i}.distance != far" for i in _count(number)),
    }
    return _robot(
        "CautiousDrive",
        "A drive with sensors all around: it rushes where all is far, and stands where anything is near.",
        ["interface twist use Twist from geometry_msgs"],
        _block("datatype object Vector3", ["x: double"]),
        _block("datatype object Twist", ["linear: Vector3"]),
        _block(
            "datatype enum Distance from double to",
            ["value >= 2.0 -> far", "value >= 0.5 -> middle", "default -> near"],
        ),
        *(
            _component(
                f"Sonar{i}",
                [_outgoing(f"range{i}", "Distance")],
                {"initial marked state sensing": [f"on response from range{i} do distance := value"]},
                "variable distance: Distance = near",
            )
            for i in _count(number)
        ),
        _component(
            "Drive",
            [f'incoming message {speed} with identifier: "/cmd_vel", type: Twist links twist' for speed in speeds],
            {
                "initial marked state standing": ["on request to slow goto crawling"],
                "state crawling": ["on request to fast goto rushing", "on request to halt goto standing"],
                "state rushing": ["on request to slow goto crawling", "on request to halt goto standing"],
            },
        ),
        [
            f"provide {event} with {{ linear: {{ x: {speed} }} }}"
            for event, speed in zip(speeds, (1.0, 0.2, 0.0), strict=True)
        ],
        [f"requirement {event} needs {condition}" for event, condition in speeds.items()],
    )


def sensor_states(number: int) -> int:
    """Return the number of states: three distances per sensor, three speeds; for each speed, data or none yet."""
    return 3**number * 3 * 2**3


def philosophers(number: int) -> str:
    """Return arms around a table, with a tool between each two; each arm needs the tools on both of its sides."""
    comment = "Dining philosophers: arms round a table, a tool between two of them, and each needs both to weld."
    return _robot("RoundTable", comment, *(text for i in _count(number) for text in _arm(i, (i - 2) % number + 1)))


def _arm(this: int, before: int) -> list[Lines]:
    """Return an arm, and the tool between it and the previous one."""
    left, right, weld = f"take_left{this}", f"take_right{this}", f"weld{this}"
    return [
        _component(
            f"Arm{this}",
            [_incoming(left), _incoming(right), _action(weld)],
            {
                "initial marked state resting": [
                    f"on request to {left} goto has_left",
                    f"on request to {right} goto has_right",
                ],
                "state has_left": [f"on request to {right} goto has_both"],
                "state has_right": [f"on request to {left} goto has_both"],
                "state has_both": [f"on request to {weld} goto welding"],
                "state welding": [f"on {event} from {weld} goto resting" for event in ("response", "error")],
            },
        ),
        _component(
            f"Tool{this}",
            [],
            {
                "initial marked state free": [
                    f"on request to {left} goto taken",
                    f"on request to take_right{before} goto taken",
                ],
                "state taken": [
                    f"on {event} from weld{arm} goto free"
                    for arm in dict.fromkeys((this, before))
                    for event in ("response", "error")
                ],
            },
        ),
    ]


def philosopher_states(number: int) -> int:
    """Return the number of states. An action rests in one of three, or runs; states where all hold one side deadlock.

    `step` leads from whether the tool on an arm's left is its neighbor's to whether the one on its right is its own.
    """
    step = {(False, False): 3 + 3, (False, True): 3 + 4, (True, False): 3, (True, True): 3}
    whole = 0
    for start in (False, True):
        ways = {start: 1}
        for _ in range(number):
            ways = {
                after: sum(count * step[before, after] for before, count in ways.items()) for after in (False, True)
            }
        whole += ways[start]
    return whole - 2 * 3**number


def warehouse(number: int) -> str:
    """Return robots that share docks, one for each four robots, and the one aisle to and from them."""
    robots, docks = _count(number), _count(docks_for(number))
    comment = "Robots that share docks and the one aisle to and from them."
    return _robot(
        "Warehouse",
        comment,
        *(
            _component(
                f"Robot{i}",
                [_incoming(f"enter{i}"), *(_incoming(f"dock{i}_{dock}") for dock in docks), _action(f"leave{i}")],
                {
                    "initial marked state stored": [f"on request to enter{i} goto inbound"],
                    "state inbound": [f"on request to dock{i}_{dock} goto docked" for dock in docks],
                    "state docked": [f"on request to leave{i} goto outbound"],
                    "state outbound": [
                        f"on response from leave{i} goto stored",
                        f"on error from leave{i} goto docked",
                    ],
                },
            )
            for i in robots
        ),
        _component(
            "Aisle",
            [],
            {
                "initial marked state free": [
                    f"on request to {action}{i} goto taken" for i in robots for action in ("enter", "leave")
                ],
                "state taken": [
                    *(f"on request to dock{i}_{dock} goto free" for i in robots for dock in docks),
                    *(f"on {event} from leave{i} goto free" for i in robots for event in ("response", "error")),
                ],
            },
        ),
        *(
            _component(
                f"Dock{dock}",
                [],
                {"initial marked state free": [f"on request to dock{i}_{dock} goto holds{i}" for i in robots]}
                | {
                    f"state holds{i}": [f"on response from leave{i} goto free", f"on error from leave{i}"]
                    for i in robots
                },
            )
            for dock in docks
        ),
    )


def docks_for(robots: int) -> int:
    """Return the number of docks of a warehouse."""
    return (robots + 3) // 4


def warehouse_states(number: int) -> int:
    """Return the number of states: robots at docks; an empty aisle, or a robot in it, to a dock or from its own.

    Synthesis removes states with a robot on its way and no free dock.
    """
    docks = docks_for(number)
    others = sum(comb(number - 1, held) * perm(docks, held) * 3**held * 2 ** (number - held) for held in range(docks))
    held_docks = [(held, comb(number, held) * perm(docks, held) * 2 ** (number - held)) for held in range(docks + 1)]
    empty = sum(ways * 3**held for held, ways in held_docks)
    outbound = sum(ways * held * 3 ** (held - 1) for held, ways in held_docks if held)
    return empty + number * others + outbound


def services(number: int) -> str:
    """Return services that share a resource, which suffices for half of them."""
    calls = _count(number)
    most = jobs_for(number)
    return _robot(
        "Cameras",
        "Cameras whose detectors share a processor.",
        *(
            _block(
                f"component Camera{i}",
                [f'service detect{i} with identifier: "/detect{i}", request: none, response: none'],
            )
            for i in calls
        ),
        _component(
            "Processor",
            [],
            {
                "initial marked state counting": [
                    f"on {result} detect{i} do jobs := jobs {change} 1"
                    for i in calls
                    for result, change in (("request to", "+"), ("response from", "-"), ("error from", "-"))
                ]
            },
            f"variable jobs: integer(0..{most}) = 0",
        ),
        [f"requirement {{ {', '.join(f'detect{i}' for i in calls)} }} needs Processor.jobs < {most}"],
    )


def jobs_for(calls: int) -> int:
    """Return the maximum number of services that run at once."""
    return (calls + 1) // 2


def service_states(number: int) -> int:
    """Return the number of states: the running services, and one of three states for each other one."""
    return sum(comb(number, running) * 3 ** (number - running) for running in range(jobs_for(number) + 1))


def _count(number: int) -> range:
    return range(1, number + 1)


def _robot(name: str, comment: str, *parts: Lines) -> str:
    """Return the text of a robot; its actions have their own type."""
    used = any(ACTION in text for part in parts for text in part)
    declared = [["interface task use Task from factory_msgs"]] if used else []
    return "\n".join([f"// {comment}", *_block(f"robot {name}", *declared, *parts), ""])


def _component(name: str, communications: Lines, states: Mapping[str, Lines], variable: str = "") -> Lines:
    behaviour = _block(
        "behaviour",
        *([[variable]] if variable else []),
        *(_block(state, transitions) for state, transitions in states.items()),
    )
    return _block(f"component {name}", *([communications] if communications else []), behaviour)


def _block(heading: str, *parts: Lines) -> Lines:
    """Return a heading and parts in braces, separated by empty lines."""
    inside = [line for part in parts for line in ("", *(f"  {text}" if text else "" for text in part))]
    return [f"{heading} {{", *inside[1:], "}"]


def _incoming(name: str) -> str:
    return f'incoming message {name} with identifier: "/{name}", type: none'


def _outgoing(name: str, kind: str = "none") -> str:
    return f'outgoing message {name} with identifier: "/{name}", type: {kind}'


ACTION = "request: none, response: none, feedback: none links task"


def _action(name: str) -> str:
    return f'action {name} with identifier: "/{name}", {ACTION}'


FAMILIES = {
    family.name: family
    for family in (
        Family("cells", "N independent cells", cells, cell_states, (1, 2, 3, 4, 8, 16, 22, 32, 64, 128, 256)),
        Family("sensors", "N sensors gating one drive", sensors, sensor_states, (2, 4, 6, 8, 16, 32, 64, 128, 256)),
        Family("line", "a chain of N actions", line, line_states, (2, 3, 4, 5, 6, 8, 16, 32, 64, 128, 256)),
        Family(
            "philosophers",
            "N dining philosophers",
            philosophers,
            philosopher_states,
            (2, 3, 4, 5, 6, 10, 15, 20, 30, 40, 60, 80),
        ),
        Family(
            "warehouse", "N robots and N/4 docks", warehouse, warehouse_states, (2, 3, 4, 6, 8, 10, 12, 14, 16, 20, 24)
        ),
        Family(
            "services",
            "N services sharing a resource",
            services,
            service_states,
            (2, 4, 6, 8, 10, 16, 24, 32, 48, 64, 96),
        ),
    )
}


if __name__ == "__main__":
    print(FAMILIES[sys.argv[1]].text(int(sys.argv[2])), end="")
