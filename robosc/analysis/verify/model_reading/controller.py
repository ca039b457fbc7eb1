"""What a controller adds to plants and requirements, by the text: order, batches, groups, data, bounds and times."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.analysis.verify.model_reading.machine import EventName, Plant, Slot

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.analysis.verify.model_reading.machine import Machine, Timer, Value

    #: What an event does to times; those that go on are not in it.
    Effects = dict[EventName, str]

#: What an event does to a time.
STARTS, STOPS, GOES_ON = "starts anew", "stops", "goes on"
CANCEL, TRIGGER, SILENT, DATA, INCOMING, TIMEOUT = "cancel", "trigger", "silent", "data", "incoming", "timeout"
#: What the control loop does with an event, by its kind; all others come from the robot.
_ROLES = {"cancel": CANCEL, "trigger": TRIGGER, "tau": SILENT, "reset": SILENT, "data": DATA, "timeout": TIMEOUT}
#: A bound of 32 bits.
_LARGEST_BOUND = 2**32 - 1


class ControllerText:
    """The controller of a robot, by the reading of its text. All lists of events are in the order of the text."""

    def __init__(self, text: Machine) -> None:
        self.text = text
        self._place = {plant: place for place, plant in enumerate(text.order)}
        #: The events of each component's times.
        self.times: dict[Plant, list[EventName]] = {}
        for name in self.events(TIMEOUT):
            self.times.setdefault(name.plant, []).append(name)

    def role(self, name: EventName) -> str:
        """What the control loop does with an event."""
        return _ROLES.get(self.text.events[name].kind, INCOMING)

    def events(self, role: str) -> list[EventName]:
        """The events of a role, component by component."""
        names = [name for name in self.text.events if self.role(name) == role]
        return sorted(names, key=lambda name: self._place.get(name.plant, 0))

    def topic(self, plant: Plant) -> str:
        """The topic of a message. The node takes `/scan` and `scan` for one."""
        return self.text.topics[plant].removeprefix("/")

    # Batches and groups

    @property
    def sources(self) -> list[list[EventName]]:
        """What one count of reactions is for: a topic, a service, an action, the times of a component."""
        return [*self._together(INCOMING), *self._together(TIMEOUT)]

    @staticmethod
    def is_batch(source: Sequence[EventName]) -> bool:
        """Whether one message means all events of a source, with nothing in between."""
        return len(source) > 1 and source[0].plant.kind == "message"

    @property
    def rounds(self) -> list[list[EventName]]:
        """Messages that go to one topic: at most one of them is sent in a round."""
        return [names for names in self._together(TRIGGER) if self.is_batch(names)]

    @property
    def ticks(self) -> list[list[EventName]]:
        """Services and actions: each starts once in a tick."""
        return [names for names in self._together(TRIGGER) if names[0].plant.kind != "message"]

    def _together(self, role: str) -> list[list[EventName]]:
        """Messages by their topic, other events by their plant."""
        groups: dict[object, list[EventName]] = {}
        for name in self.events(role):
            key = self.topic(name.plant) if name.plant.kind == "message" else name.plant
            groups.setdefault(key, []).append(name)
        return list(groups.values())

    # Data and bounds

    @property
    def alternatives(self) -> dict[Plant, list[EventName]]:
        """For each choice of data its events: the statements that provide data, then no data."""
        choices: dict[Plant, list[EventName]] = {}
        for name in self.events(DATA):
            choices.setdefault(name.plant, []).append(name)
        return {plant: sorted(names, key=lambda name: name.name == "c_none") for plant, names in choices.items()}

    def choice(self, name: EventName) -> Plant | None:
        """The choice of the data that a trigger sends; None where there is none."""
        plant = Plant("data", name.plant.origin)
        return plant if self.role(name) == TRIGGER and plant in self.alternatives else None

    def bound(self, proved: int | None) -> int:
        """After how many silent events a livelock is reported: as many as are proved, else 2 for each event and 16."""
        return 2 * len(self.events(SILENT)) + 16 if proved is None else min(proved, _LARGEST_BOUND)

    # Times

    def timer(self, name: EventName) -> Timer:
        """The time whose end an event is."""
        timer = self.text.events[name].timer
        assert timer is not None
        return timer

    def runs_from_start(self, name: EventName) -> bool:
        """The initial state is entered at the start; a time outside of the states runs in all of them."""
        location = self.timer(name).location
        return location is None or location == self.text.initial[Slot(name.plant)]

    def concerns(self, name: EventName, component: Plant) -> bool:
        """Whether an event may start or stop a time of a component."""
        participants = self.text.events[name].participants
        return any(participant.component == component for participant in participants) or any(
            name in self.timer(timed).without for timed in self.times[component]
        )

    def reads(self, name: EventName, component: Plant) -> frozenset[Slot]:
        """What decides on that: where the component is, and what its transitions read."""
        participants = self.text.events[name].participants
        own = [participant.reads for participant in participants if participant.component == component]
        return frozenset({Slot(component)}).union(*own)

    def effects(
        self, name: EventName, component: Plant, state: Mapping[Slot, Value], inputs: Mapping[str, Value]
    ) -> Effects | None:
        """What an event does to the times of a component; None where the component does not let it happen.

        A time of a state starts when the state is entered, also by `goto` to the same state, and when one of its
        messages comes and the component stays. It stops when the state is left, and when it is up. A time outside of
        the states starts with each of its messages, whatever the state.
        """
        place = Slot(component)
        entered: Value | None = None
        for participant in self.text.events[name].participants:
            if participant.component == component:
                taken = participant.step(state, inputs)
                if taken is None:
                    return None
                entered = taken.writes.get(place)
        here = state[place] if entered is None else entered
        effects: Effects = {}
        for timed in self.times[component]:
            timer = self.timer(timed)
            if timed == name or (entered is not None and timer.location == state[place]):
                effects[timed] = STOPS
            heard = name in timer.without and timer.location in (None, here)
            if heard or (entered is not None and timer.location == entered):
                effects[timed] = STARTS
        return effects
