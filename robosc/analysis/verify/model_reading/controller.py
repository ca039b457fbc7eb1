"""Meaning of a robot's text for the controller: order, batches, groups, data, bounds and timers."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.analysis.verify.model_reading.machine import EventName, Plant, Slot, choice_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.analysis.verify.model_reading.machine import Machine, Timer, Value

    #: Effects of an event on timers; timers that continue are left out.
    Effects = dict[EventName, str]

#: Effects of an event on a timer.
STARTS, STOPS, GOES_ON = "starts anew", "stops", "goes on"
CANCEL, TRIGGER, SILENT, DATA, INCOMING, TIMEOUT = "cancel", "trigger", "silent", "data", "incoming", "timeout"
#: Role of an event in the control loop, by its kind; all other events come from the robot.
_ROLES = {"cancel": CANCEL, "trigger": TRIGGER, "tau": SILENT, "reset": SILENT, "data": DATA, "timeout": TIMEOUT}
_ROLES |= dict.fromkeys(("reply", "replyFeedback", "replyError", "replyCanceled"), TRIGGER)
#: Largest bound in 32 bits.
_LARGEST_BOUND = 2**32 - 1


class ControllerText:
    """Controller of a robot, read from its text. All lists of events are in the order of the text."""

    def __init__(self, text: Machine) -> None:
        self.text = text
        self._place = {plant: place for place, plant in enumerate(text.order)}
        #: Timer events of each component.
        self.times: dict[Plant, list[EventName]] = {}
        for name in self.events(TIMEOUT):
            self.times.setdefault(name.plant, []).append(name)

    def role(self, name: EventName) -> str:
        """Return the role of an event in the control loop."""
        return _ROLES.get(self.text.events[name].kind, INCOMING)

    def events(self, role: str) -> list[EventName]:
        """Return the events of a role, component by component."""
        names = [name for name in self.text.events if self.role(name) == role]
        return sorted(names, key=lambda name: self._place.get(name.plant, 0))

    def topic(self, plant: Plant) -> str:
        """Return the topic of a message. The node treats `/scan` and `scan` as equal."""
        return self.text.topics[plant].removeprefix("/")

    # Batches and groups

    @property
    def sources(self) -> list[list[EventName]]:
        """Events that share one count of reactions: those of a topic, a service, an action, a component's timers."""
        return [*self._together(INCOMING), *self._together(TIMEOUT)]

    @staticmethod
    def is_batch(source: Sequence[EventName]) -> bool:
        """Return whether one message triggers all events of a source, with nothing in between."""
        return len(source) > 1 and source[0].plant.kind == "message"

    @property
    def rounds(self) -> list[list[EventName]]:
        """Messages that share a topic: at most one of them is sent in a round."""
        return [names for names in self._together(TRIGGER) if self.is_batch(names)]

    @property
    def ticks(self) -> list[list[EventName]]:
        """Events of services and actions: each starts once in a tick. Answers to clients are sent at once."""
        return [names for names in self._together(TRIGGER) if names[0].plant.kind in ("service", "action")]

    def _together(self, role: str) -> list[list[EventName]]:
        """Return messages grouped by topic, and other events grouped by plant."""
        groups: dict[object, list[EventName]] = {}
        for name in self.events(role):
            key = self.topic(name.plant) if name.plant.kind == "message" else name.plant
            groups.setdefault(key, []).append(name)
        return list(groups.values())

    # Data and bounds

    @property
    def alternatives(self) -> dict[Plant, list[EventName]]:
        """Events of each choice of data: the `provide` statements, then no data."""
        choices: dict[Plant, list[EventName]] = {}
        for name in self.events(DATA):
            choices.setdefault(name.plant, []).append(name)
        return {plant: sorted(names, key=lambda name: name.name == "c_none") for plant, names in choices.items()}

    def choice(self, name: EventName) -> Plant | None:
        """Return the choice of the data that a trigger sends; None if there is none."""
        plant = choice_of(name)
        return plant if self.role(name) == TRIGGER and plant in self.alternatives else None

    def bound(self, proved: int | None) -> int:
        """Return the number of silent events after which the loop reports a livelock.

        It is the proved bound. Without one, it is 2 for each silent event plus 16.
        """
        return 2 * len(self.events(SILENT)) + 16 if proved is None else min(proved, _LARGEST_BOUND)

    # Timers

    def timer(self, name: EventName) -> Timer:
        """Return the timer that expires with an event."""
        timer = self.text.events[name].timer
        assert timer is not None
        return timer

    def runs_from_start(self, name: EventName) -> bool:
        """Return whether a timer runs from the start: the initial state is entered then.

        A timer outside of the states runs in all of them.
        """
        location = self.timer(name).location
        return location is None or location == self.text.initial[Slot(name.plant)]

    def concerns(self, name: EventName, component: Plant) -> bool:
        """Return whether an event may start or stop a timer of a component."""
        participants = self.text.events[name].participants
        return any(participant.component == component for participant in participants) or any(
            name in self.timer(timed).without for timed in self.times[component]
        )

    def reads(self, name: EventName, component: Plant) -> frozenset[Slot]:
        """Return the slots that decide about it: the component's location, and the slots its transitions read."""
        participants = self.text.events[name].participants
        own = [participant.reads for participant in participants if participant.component == component]
        return frozenset({Slot(component)}).union(*own)

    def effects(
        self, name: EventName, component: Plant, state: Mapping[Slot, Value], inputs: Mapping[str, Value]
    ) -> Effects | None:
        """Return the effects of an event on a component's timers; None if the component refuses the event.

        A timer of a state starts when the state is entered, also by `goto` to the same state. It starts again when one
        of its messages arrives and the component stays. It stops when the state is left, and when it expires. A timer
        outside of the states starts with each of its messages, in any state.
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
