"""The parameters of a node, with their ranges and the defaults that the configuration gives them."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.configuration import Configuration
    from robosc.metamodel import rosgraph

Value: TypeAlias = bool | int | str


@dataclass(frozen=True)
class Parameter:
    """A parameter of a node; a number lies between its bounds."""

    name: str
    default: Value
    meaning: str
    bounds: tuple[int, int] | None = None


_DAY = 24 * 3600 * 1000
_COUNT = 0xFFFF


def controller_parameters(graph: rosgraph.RosGraph, configuration: Configuration, log: str) -> list[Parameter]:
    """The parameters of a controller; `log` is where its event log goes by default."""
    clients = [
        *_timeouts(graph, configuration),
        Parameter("retry_ms", configuration.retry_ms, "From a failure to the next try.", (1, _DAY)),
    ]
    watchdogs = configuration.watchdog_ms
    loop = configuration.control_loop
    return [
        Parameter("period_ms", loop.period_ms, "Time from one tick to the next.", (1, _DAY)),
        Parameter("events_per_tick", loop.events_per_tick, "Most events sent in a tick; 0: no limit.", (0, _COUNT)),
        Parameter(
            "reactions_per_tick",
            loop.reactions_per_tick,
            "Most events started by the data of one topic between two ticks.",
            (0, _COUNT),
        ),
        Parameter("react_immediately", loop.react_immediately, "Whether incoming data may start events at once."),
        *(clients if len(clients) > 1 else ()),
        Parameter("watchdog_stops", configuration.watchdog_stops, configuration.watchdog_meaning),
        *(
            Parameter(
                watchdog(subscription),
                watchdogs.get(subscription.topic.removeprefix("/"), 0),
                f"Longest silence of {subscription.topic}; 0: any.",
                (0, _DAY),
            )
            for subscription in graph.subscriptions
        ),
        _event_log(log),
    ]


def watchdog(subscription: rosgraph.Subscription) -> str:
    """The parameter that bounds a topic's silence."""
    return "watchdog_ms." + re.sub(r"[^A-Za-z0-9]+", "_", subscription.topic).strip("_")


def layer_parameters(graph: rosgraph.RosGraph, configuration: Configuration, log: str) -> list[Parameter]:
    """The parameters of a supervisory layer."""
    period = configuration.control_loop.period_ms
    return [
        Parameter("period_ms", period, "Time from one report of the state to the next.", (1, _DAY)),
        *_timeouts(graph, configuration),
        _event_log(log),
    ]


def _timeouts(graph: rosgraph.RosGraph, configuration: Configuration) -> list[Parameter]:
    services, actions = configuration.services.timeout_ms, configuration.actions.timeout_ms
    found = []
    if graph.serviceClients:
        meaning = "After this time without an answer a call has failed."
        found.append(Parameter("service_timeout_ms", services, meaning, (1, _DAY)))
    if graph.actionClients:
        meaning = "After this time without acceptance a goal has failed."
        found.append(Parameter("action_timeout_ms", actions, meaning, (1, _DAY)))
    return found


def _event_log(log: str) -> Parameter:
    return Parameter("event_log", log, "A file that gets a line of JSON for each event; empty: none.")


def check(parameter: Parameter, value: object) -> Value:
    """A value for the parameter. Raises ValueError, in words for the user, where it does not fit."""
    expected = type(parameter.default)
    if type(value) is not expected or not isinstance(value, (bool, int, str)):
        names = {bool: "true or false", int: "a whole number", str: "a text"}
        raise ValueError(f"{parameter.name} is {value!r}, not {names[expected]}")
    if parameter.bounds is not None and isinstance(value, int):
        low, high = parameter.bounds
        if not low <= value <= high:
            raise ValueError(f"{parameter.name} is {value}, not between {low} and {high}")
    return value


@dataclass(frozen=True)
class SafeMessages:
    """What goes out whatever is required of it: when the node stops the robot, and when a command can't be sent."""

    on_shutdown: Sequence[rosgraph.Sending] = ()
    on_withheld: Sequence[rosgraph.Sending] = ()


@dataclass(frozen=True)
class Settings:
    """How one node runs: the values of its parameters, and the configuration."""

    parameters: Mapping[str, Value]
    configuration: Configuration

    def number(self, name: str) -> int:
        """A parameter that is a whole number."""
        value = self.parameters[name]
        assert isinstance(value, int)
        return value

    def seconds(self, name: str) -> float:
        """A parameter that counts milliseconds, in seconds."""
        return self.number(name) / 1000
