"""Families of directed controller synthesis, chains of cluster tools and transfer lines, as plain automata and as CIF.

    python benchmarks/dcs_families.py FAMILY N [K]

prints one instance as CIF.

Six families come from the benchmark of directed controller synthesis: D. Ciolek and others, "Compositional supervisory
control via reactive synthesis and automated planning" (IEEE Transactions on Automatic Control, 2020), and D. Ciolek,
M. Duran, F. Zanollo, N. Pazos, J. Braier, V. Braberman, N. D'Ippolito and S. Uchitel, "On-the-fly informed search of
non-blocking directed controllers" (Automatica 147, 2023, doi 10.1016/j.automatica.2022.110731). The papers vary N and K
from 1 to 15. The controller must avoid the errors. A marked *event* must remain possible again and again. States are
marked here, so each instance has an observer `Goal`. It takes part in every event, and only its location after a marked
event is marked. In all other automata, each location is marked.

The families differ from the authors' models in two points, neither of which changes a count of controlled states.
Events that can never happen are left out, for example the return of a piece to any buffer but the first. An error is a
location without edges of one automaton; in the authors' tool MTSA, an error stops the whole composition.
"""

from __future__ import annotations

import re
import sys
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

#: Location that a requirement forbids.
ERROR = "Error"
#: The observer of marked events.
GOAL = "Goal"


@dataclass
class Automaton:
    """Automaton with its edges by their source location. Its alphabet are the events of its edges.

    `marked` None marks every location. A requirement must not disable an uncontrollable event of the plants.
    """

    name: str
    initial: str
    marked: frozenset[str] | None = None
    requirement: bool = False
    edges: dict[str, dict[str, str]] = field(default_factory=dict)

    def edge(self, source: str, event: str, target: str) -> None:
        """Add an edge; raise ValueError if the event has another target already."""
        if self.edges.setdefault(source, {}).setdefault(event, target) != target:
            raise ValueError(f"{self.name}: two targets of {event} from {source}")
        self.edges.setdefault(target, {})

    def is_marked(self, location: str) -> bool:
        """Return whether a location is marked."""
        return location != ERROR and (self.marked is None or location in self.marked)

    @property
    def alphabet(self) -> frozenset[str]:
        """Events of the edges."""
        return frozenset(event for edges in self.edges.values() for event in edges)


@dataclass(frozen=True)
class Instance:
    """Automata that synchronize on shared events. The supervisor must avoid `ERROR` in each of them."""

    automata: tuple[Automaton, ...]
    controllable: frozenset[str]

    @property
    def events(self) -> list[str]:
        """All events, in the order of the automata."""
        return list(dict.fromkeys(event for automaton in self.automata for event in _events(automaton)))

    @property
    def text(self) -> str:
        """The instance as CIF 3."""
        kinds = ("uncontrollable", "controllable")
        lines = [f"{kinds[event in self.controllable]} {event};" for event in self.events]
        for automaton in self.automata:
            lines += _automaton_lines(automaton)
        errors = [automaton.name for automaton in self.automata if ERROR in automaton.edges]
        return "\n".join([*lines, *(f"requirement invariant not {name}.{ERROR};" for name in errors)]) + "\n"


@dataclass(frozen=True)
class Family:
    """Instances of any size, with the title of the family and its two parameters."""

    title: str
    n: str
    k: str
    instance: Callable[[int, int], Instance]


def air_traffic(planes: int, heights: int) -> Instance:
    """Return planes that request to land, hold at heights above the ground, and share a ramp.

    Controllable: `descend` to a height and `approach` the ramp. Two planes in one height or on the ramp may crash at
    any time. Each request is answered by a descent before anything but a landing happens. Marked: `control_all`, when
    all planes have landed or flown on. There is no controller if there are more planes than heights.
    """
    automata = []
    for p in range(planes):
        plane = Automaton(f"Plane_{p}", "Arriving")
        plane.edge("Arriving", f"request_{p}", "Requested")
        plane.edge("Arriving", f"extend_{p}", "Gone")
        for h in range(heights):
            plane.edge("Requested", f"descend_{p}_{h}", f"Hold_{h}")
            if h > 0:
                plane.edge(f"Hold_{h}", f"descend_{p}_{h - 1}", f"Hold_{h - 1}")
        plane.edge("Hold_0", f"approach_{p}", "OnRamp")
        plane.edge("OnRamp", f"land_{p}", "Gone")
        plane.edge("Gone", "control_all", "Arriving")
        automata.append(plane)
    automata += [_height(h, planes) for h in range(heights)]

    ramp = Automaton("Ramp", "Free")
    response = Automaton("Response", "Answered")
    for p in range(planes):
        ramp.edge("Free", f"approach_{p}", "Busy")
        ramp.edge("Busy", f"approach_{p}", "Conflict")
        ramp.edge("Busy", f"land_{p}", "Free")
        response.edge("Answered", f"request_{p}", f"Owed_{p}")
        response.edge("Answered", f"extend_{p}", "Answered")
        response.edge("Answered", f"approach_{p}", "Answered")
        for h in range(heights):
            response.edge("Answered", f"descend_{p}_{h}", "Answered")
            response.edge(f"Owed_{p}", f"descend_{p}_{h}", "Answered")
    ramp.edge("Conflict", "ramp_crash", ERROR)
    return _observed([*automata, ramp, response], ("descend", "approach"), ["control_all"])


def _height(height: int, planes: int) -> Automaton:
    """Return the monitor of a height: the plane there leaves by its descent, or from the lowest height by landing."""
    monitor = Automaton(f"Height_{height}", "Free")
    for p in range(planes):
        monitor.edge("Free", f"descend_{p}_{height}", f"Taken_{p}")
        for other in range(planes):
            if other != p:
                monitor.edge(f"Taken_{p}", f"descend_{other}_{height}", "Conflict")
            if height == 0:
                monitor.edge(f"Taken_{p}", f"land_{other}", "Free")
            else:
                monitor.edge("Free", f"descend_{other}_{height - 1}", "Free")
                after = "Free" if other == p else f"Taken_{p}"
                monitor.edge(f"Taken_{p}", f"descend_{other}_{height - 1}", after)
    if planes > 1:
        monitor.edge("Conflict", f"air_crash_{height}", ERROR)
    return monitor


def bidding_workflow(teams: int, steps: int) -> Instance:
    """Return a document that teams evaluate up to a number of times each, until all accept or one rejects finally.

    Controllable: `assign` to a team, `approve` and `refuse`. Errors: a decision before its time, or an assignment to a
    team that has accepted or has no evaluation left. Marked: both decisions.
    """
    automata = []
    document = Automaton("Document", "Accepted_0")
    for t in range(teams):
        team = Automaton(f"Team_{t}", "Waiting")
        team.edge("Waiting", f"assign_{t}", "Reads_1")
        team.edge("Waiting", "approve", ERROR)
        team.edge("Waiting", "refuse", ERROR)
        for s in range(1, steps + 1):
            team.edge(f"Reads_{s}", f"accept_{t}", "Accepts")
            team.edge(f"Reads_{s}", f"reject_{t}_{s}", f"Rejects_{s}")
            team.edge(f"Rejects_{s}", f"assign_{t}", f"Reads_{s + 1}" if s < steps else ERROR)
            team.edge(f"Rejects_{s}", "approve", ERROR)
            team.edge(f"Rejects_{s}", "refuse", "Waiting")
        team.edge("Accepts", f"assign_{t}", ERROR)
        team.edge("Accepts", "approve", "Waiting")
        team.edge("Accepts", "refuse", "Waiting")
        automata.append(team)
        for accepted in range(teams):
            document.edge(f"Accepted_{accepted}", f"accept_{t}", f"Accepted_{accepted + 1}")
            document.edge(f"Accepted_{accepted}", f"reject_{t}_{steps}", "Rejected")
        for location in (f"Accepted_{teams}", "Rejected"):
            document.edge(location, f"accept_{t}", location)
            document.edge(location, f"reject_{t}_{steps}", location)
    for accepted in range(teams):
        document.edge(f"Accepted_{accepted}", "approve", ERROR)
        document.edge(f"Accepted_{accepted}", "refuse", ERROR if accepted else "Accepted_0")
    document.edge(f"Accepted_{teams}", "approve", "Accepted_0")
    document.edge(f"Accepted_{teams}", "refuse", ERROR)
    document.edge("Rejected", "approve", ERROR)
    document.edge("Rejected", "refuse", "Accepted_0")
    return _observed([document, *automata], ("assign", "approve", "refuse"), ["approve", "refuse"])


def cat_and_mouse(animals: int, levels: int) -> Instance:
    """Return as many mice as cats in a corridor with levels on each side of its center; they move in turns.

    Controllable: the moves of mice. A mouse and a cat in one cell are an error, except in the center. A mouse in the
    center is safe together with all other mice only. Marked: `safe`.
    """
    cells = 2 * levels + 1
    mice = [_animal("mouse", "cat", m, animals, cells) for m in range(animals)]
    cats = [_animal("cat", "mouse", c, animals, cells) for c in range(animals)]
    return _observed([*mice, *cats], ("mouse_move",), ["safe"])


def _animal(own: str, other: str, number: int, animals: int, cells: int) -> Automaton:
    """Return a mouse or a cat: it watches the others, then waits for its turn, moves, and has moved."""
    center = cells // 2
    is_mouse = own == "mouse"
    animal = Automaton(f"{own.title()}_{number}", f"Watches_{cells - 1}" if is_mouse else "Moved_0")
    for cell in range(cells):
        animal.edge(f"Watches_{cell}", f"{own}_turn", f"Acts_{cell}")
        for target in {max(cell - 1, 0), cell, min(cell + 1, cells - 1)}:
            animal.edge(f"Acts_{cell}", f"{own}_move_{number}_{target}", f"Moved_{target}")
        moved = f"Moved_{cell}"
        if is_mouse and cell == center:
            animal.edge(moved, "safe", "Safe")
            moved = "Safe"
        animal.edge(moved, f"{other}_turn", f"Watches_{cell}")
        for entered in range(cells):
            after = ERROR if entered == cell != center else f"Watches_{cell}"
            for o in range(animals):
                animal.edge(f"Watches_{cell}", f"{other}_move_{o}_{entered}", after)
    return animal


def dining_philosophers(philosophers: int, steps: int) -> Instance:
    """Return philosophers who take their left fork, perform steps of etiquette, take their right fork and eat.

    Controllable: `take`. Marked: `eat_all`, when each has eaten since the last time. One philosopher alone has one fork
    for both sides and never eats.
    """
    automata = []
    for p in range(philosophers):
        left, right = p, (p + 1) % philosophers
        philosopher = Automaton(f"Philosopher_{p}", "Idle")
        philosopher.edge("Idle", f"think_{p}", "Hungry")
        philosopher.edge("Hungry", f"take_{p}_{left}", f"Steps_{steps}")
        for s in range(steps, 0, -1):
            philosopher.edge(f"Steps_{s}", f"step_{p}", f"Steps_{s - 1}")
        philosopher.edge("Steps_0", f"take_{p}_{right}", "Eating")
        philosopher.edge("Eating", f"eat_{p}", "Full")
        philosopher.edge("Full", f"release_{p}_{left}", "Leaving")
        philosopher.edge("Leaving", f"release_{p}_{right}", "Idle")
        fork = Automaton(f"Fork_{p}", "Free")
        for user in {p, (p - 1) % philosophers}:
            fork.edge("Free", f"take_{user}_{p}", "Taken")
            fork.edge("Taken", f"release_{user}_{p}", "Free")
        monitor = Automaton(f"Monitor_{p}", "Waiting")
        monitor.edge("Waiting", f"eat_{p}", "Eaten")
        monitor.edge("Eaten", f"eat_{p}", "Eaten")
        monitor.edge("Eaten", "eat_all", "Waiting")
        automata += [philosopher, fork, monitor]
    return _observed(automata, ("take",), ["eat_all"])


def travel_agency(services: int, steps: int) -> Instance:
    """Return an agency that queries services one after the other, with up to so many steps, and sells a package.

    Controllable: `cancel`, `purchase`, `succeed` and `fail`. Errors: success without all purchases, or failure without
    an excuse: a query that failed, two uncommitted services, or one whose purchase failed. Marked: both results.
    The authors' files have two versions of a selection. Here the booking follows its last step at once, as in the files
    of the non-blocking benchmark. The other version has one more selection.
    """
    agency = Automaton("Agency", "Idle")
    agency.edge("Idle", "ask", "Working")
    excuse = Automaton("Excuse", "None_0")
    for result in ("succeed", "fail"):
        agency.edge("Working", result, "Idle")
        excuse.edge("Excused", result, "None_0")
    for n in range(2):
        excuse.edge(f"None_{n}", "succeed", "None_0")
        excuse.edge(f"None_{n}", "fail", ERROR)
    automata = [agency, excuse]
    for a in range(services):
        agency.edge("Working", f"query_{a}", "Working")
        excuse.edge("None_0", f"uncommitted_{a}", "None_1")
        excuse.edge("None_1", f"uncommitted_{a}", "Excused")
        excuse.edge("None_1", f"purchase_failed_{a}", "Excused")
        for n in range(2):
            excuse.edge(f"None_{n}", f"query_failed_{a}", "Excused")
        for event in (f"query_failed_{a}", f"uncommitted_{a}", f"purchase_failed_{a}"):
            excuse.edge("Excused", event, "Excused")
        automata += [_service(a, services, steps), _purchase(a)]
    return _observed(automata, ("cancel", "purchase", "succeed", "fail"), ["succeed", "fail"])


def _service(a: int, services: int, steps: int) -> Automaton:
    """Return a service: after its booking, it waits for the query to the next service, then for a purchase."""
    service = Automaton(f"Service_{a}", "Idle")
    service.edge("Idle", f"query_{a}", "Queried")
    service.edge("Queried", f"unavailable_{a}", "Unavailable")
    service.edge("Unavailable", f"query_failed_{a}", "Idle")
    service.edge("Queried", f"available_{a}", "Available")
    for s in range(steps):
        service.edge("Available", f"steps_{a}_{s}", f"Answers_{s}")
        service.edge(f"Answers_{s}", f"query_done_{a}", f"Selects_{s}")
        if s > 0:
            service.edge(f"Selects_{s}", f"select_{a}", f"Selects_{s - 1}")
    for kind in ("committed", "uncommitted"):
        if a < services - 1:
            service.edge("Selects_0", f"{kind}_{a}", f"Next_{kind}")
            service.edge(f"Next_{kind}", f"query_{a + 1}", f"Booked_{kind}")
        else:
            service.edge("Selects_0", f"{kind}_{a}", f"Booked_{kind}")
        service.edge(f"Booked_{kind}", f"cancel_{a}", "Idle")
        service.edge(f"Booked_{kind}", f"purchase_{a}", f"Buying_{kind}")
        service.edge(f"Buying_{kind}", f"purchase_done_{a}", "Idle")
        for location in ("Idle", f"Booked_{kind}"):
            for result in ("succeed", "fail"):
                service.edge(location, result, "Idle")
    service.edge("Buying_uncommitted", f"purchase_failed_{a}", "Idle")
    return service


def _purchase(a: int) -> Automaton:
    """Return the monitor of a service's purchase, which success of the agency requires."""
    monitor = Automaton(f"Purchase_{a}", "Open")
    monitor.edge("Open", f"query_{a}", "Queried")
    monitor.edge("Queried", f"query_done_{a}", "Offered")
    monitor.edge("Queried", f"query_failed_{a}", "Failed")
    monitor.edge("Offered", f"purchase_done_{a}", "Bought")
    monitor.edge("Offered", f"purchase_failed_{a}", "Failed")
    monitor.edge("Offered", f"cancel_{a}", "Failed")
    for location in ("Open", "Queried", "Offered", "Failed", "Bought"):
        monitor.edge(location, "succeed", "Open" if location == "Bought" else ERROR)
        monitor.edge(location, "fail", "Open")
    return monitor


def transfer_line(machines: int, places: int) -> Instance:
    """Return machines that hold pieces, with a buffer after each, and a test unit that returns pieces to the first.

    Controllable: `get`, which takes a piece out of a buffer. Errors: a piece from an empty buffer, or to a full one.
    Marked: `accept` and `reject`. The number of places is that of each buffer and of each machine.
    """
    automata = []
    for m in range(machines):
        machine = Automaton(f"Machine_{m}", "Holds_0")
        buffer = Automaton(f"Buffer_{m + 1}", "Holds_0")
        arrivals = [f"put_{m + 1}", *(["return_1"] if m == 0 else [])]
        for c in range(places):
            machine.edge(f"Holds_{c}", f"get_{m}", f"Holds_{c + 1}")
            machine.edge(f"Holds_{c + 1}", f"put_{m + 1}", f"Holds_{c}")
            buffer.edge(f"Holds_{c + 1}", f"get_{m + 1}", f"Holds_{c}")
            for arrival in arrivals:
                buffer.edge(f"Holds_{c}", arrival, f"Holds_{c + 1}")
        buffer.edge("Holds_0", f"get_{m + 1}", ERROR)
        for arrival in arrivals:
            buffer.edge(f"Holds_{places}", arrival, ERROR)
        automata += [machine, buffer]
    test = Automaton("Test", "Idle")
    test.edge("Idle", f"get_{machines}", "Testing")
    test.edge("Testing", "accept", "Idle")
    test.edge("Testing", "return_1", "Returned")
    test.edge("Returned", "reject", "Idle")
    return _observed([*automata, test], ("get",), ["accept", "reject"])


def cluster_tools(tools: int, _: int = 1) -> Instance:
    """Return a chain of cluster tools, each with a robot and a chamber, and with a buffer between neighbors.

    The robot of a tool carries a wafer from the buffer before it to the chamber, from the chamber to the buffer behind
    it, and from there back. The last robot carries wafers from its chamber back. Controllable: the start of each move
    and of the process. Requirements: each place holds one wafer. The chain is an example of UltraDES
    (https://github.com/lacsed/UltraDES).
    """
    robots, chambers, places = [], [], []
    rest = frozenset({"Idle"})
    for t in range(1, tools + 1):
        robot = Automaton(f"Robot_{t}", "Idle", rest)
        robot.edge("Idle", f"take_in_{t}", "Loads")
        robot.edge("Loads", f"load_{t}", "Idle")
        robot.edge("Idle", f"unload_{t}", "Unloads")
        if t < tools:
            robot.edge("Unloads", f"pass_{t}", "Idle")
            robot.edge("Idle", f"take_back_{t}", "Returns")
            robot.edge("Returns", f"give_back_{t}", "Idle")
        else:
            robot.edge("Unloads", f"give_back_{t}", "Idle")
        chamber = Automaton(f"Chamber_{t}", "Idle", rest)
        chamber.edge("Idle", f"start_{t}", "Works")
        chamber.edge("Works", f"finish_{t}", "Idle")
        robots.append(robot)
        chambers.append(chamber)
        places.append(_place(f"Place_{t}", (f"load_{t}", f"start_{t}"), (f"finish_{t}", f"unload_{t}")))
    between = [
        _place(f"Between_{t}", (f"pass_{t}", f"take_in_{t + 1}"), (f"give_back_{t + 1}", f"take_back_{t}"))
        for t in range(1, tools)
    ]
    automata = [part for pair in zip(robots, chambers, strict=True) for part in pair] + places + between
    return Instance(tuple(automata), _named(automata, ("take_in", "take_back", "unload", "start")))


def _place(name: str, *passages: tuple[str, str]) -> Automaton:
    """Return a place for one wafer: each passage is the event that brings it and the event that takes it."""
    place = Automaton(name, "Empty", frozenset({"Empty"}), requirement=True)
    for number, (brings, takes) in enumerate(passages):
        place.edge("Empty", brings, f"Full_{number}")
        place.edge(f"Full_{number}", takes, "Empty")
    return place


def machine_line(machines: int, places: int | Sequence[int]) -> Instance:
    """Return Wonham's transfer line: machines with a buffer behind each, and a test unit that returns bad pieces.

    `places` is the size of each buffer, or a sequence of one size each. The test unit takes a piece out of the last
    buffer, and accepts it or puts it back into the first. Controllable: the start of each machine and of a test.
    Requirements: no buffer overflows or is taken from while it is empty. Marked: all is idle and empty. W. M. Wonham
    and K. Cai, "Supervisory Control of Discrete-Event Systems" (Springer, 2019), section 4.6.
    """
    sizes = [places] * machines if isinstance(places, int) else list(places)
    automata, rest = [], frozenset({"Idle"})
    for m in range(1, machines + 1):
        machine = Automaton(f"Machine_{m}", "Idle", rest)
        machine.edge("Idle", f"start_{m}", "Busy")
        machine.edge("Busy", f"finish_{m}", "Idle")
        buffer = Automaton(f"Buffer_{m}", "Holds_0", frozenset({"Holds_0"}), requirement=True)
        for c in range(sizes[m - 1]):
            for arrival in (f"finish_{m}", *(["reject"] if m == 1 else [])):
                buffer.edge(f"Holds_{c}", arrival, f"Holds_{c + 1}")
            buffer.edge(f"Holds_{c + 1}", f"start_{m + 1}", f"Holds_{c}")
        automata += [machine, buffer]
    test = Automaton("Test", "Idle", rest)
    test.edge("Idle", f"start_{machines + 1}", "Busy")
    test.edge("Busy", "accept", "Idle")
    test.edge("Busy", "reject", "Idle")
    automata.append(test)
    return Instance(tuple(automata), _named(automata, ("start",)))


#: The benchmark of directed controller synthesis.
DCS = {
    "AT": Family("air traffic", "planes", "heights", air_traffic),
    "BW": Family("bidding workflow", "teams", "evaluations", bidding_workflow),
    "CM": Family("cat and mouse", "cats, and as many mice", "cells on each side of the center", cat_and_mouse),
    "DP": Family("dining philosophers", "philosophers", "steps of etiquette", dining_philosophers),
    "TA": Family("travel agency", "services", "steps of a query", travel_agency),
    "TL": Family("transfer line", "machines", "places", transfer_line),
}
#: Chains beside it.
CHAINS = {
    "CLUSTER": Family("chain of cluster tools", "tools", "-", cluster_tools),
    "LINE": Family("line of machines", "machines", "places of a buffer", machine_line),
}
FAMILIES = DCS | CHAINS


def _observed(automata: Sequence[Automaton], controllable: tuple[str, ...], marked: Sequence[str]) -> Instance:
    """Return an instance with the observer of its marked events, and the names of its controllable events."""
    goal = Automaton(GOAL, "Other", frozenset({"Reached"}))
    for event in dict.fromkeys(event for automaton in automata for event in _events(automaton)):
        for location in ("Other", "Reached"):
            goal.edge(location, event, "Reached" if event in marked else "Other")
    return Instance((*automata, goal), _named(automata, controllable))


def _named(automata: Sequence[Automaton], names: tuple[str, ...]) -> frozenset[str]:
    """Return the events with one of some names, whatever numbers follow the name."""
    events = (event for automaton in automata for event in automaton.alphabet)
    return frozenset(event for event in events if re.sub(r"(_\d+)+$", "", event) in names)


def _events(automaton: Automaton) -> list[str]:
    """Return the events of an automaton, in the order of its edges."""
    return list(dict.fromkeys(event for edges in automaton.edges.values() for event in edges))


def _automaton_lines(automaton: Automaton) -> list[str]:
    """Return an automaton as lines of CIF."""
    lines = [f"{'requirement' if automaton.requirement else 'plant'} automaton {automaton.name}:"]
    for location, edges in automaton.edges.items():
        parts = ["initial"] * (location == automaton.initial) + ["marked"] * automaton.is_marked(location)
        targets: dict[str, list[str]] = {}
        for event, target in edges.items():
            targets.setdefault(target, []).append(event)
        parts += [f"edge {', '.join(events)} goto {target}" for target, events in targets.items()]
        lines.append(f"  location {location}" + (": " + "; ".join(parts) if parts else "") + ";")
    return [*lines, "end"]


if __name__ == "__main__":
    family, *numbers = sys.argv[1:]
    print(FAMILIES[family].instance(*[*map(int, numbers), 1][:2]).text, end="")
