"""Parameters of a node, run or generated, with their ranges and their defaults from the configuration."""

from __future__ import annotations

import re
from dataclasses import dataclass
from itertools import chain, count
from typing import TYPE_CHECKING, TypeAlias

from robosc.model import expression as ex
from robosc.model.semantics.expansion import constant_value

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robosc.language.configuration import Configuration
    from robosc.model import rosgraph

Value: TypeAlias = bool | int | float | str
Topic: TypeAlias = "rosgraph.Subscription | rosgraph.Publisher"


@dataclass(frozen=True)
class Parameter:
    """A parameter of a node. A number lies between its bounds. `changes`: it can be set while the node runs."""

    name: str
    default: Value
    meaning: str
    bounds: tuple[float, float] | None = None
    changes: bool = False

    @property
    def type_name(self) -> str:
        """Name of the type in ROS."""
        return {bool: "bool", int: "integer", float: "double", str: "string"}[type(self.default)]


_DAY = 24 * 3600 * 1000
_COUNT = 0xFFFF


def controller_parameters(graph: rosgraph.RosGraph, configuration: Configuration, log: str) -> list[Parameter]:
    """Return the parameters of a controller. `log` is the default file of its event log."""
    clients = [
        *_timeouts(graph, configuration),
        Parameter(
            "retry_ms", configuration.retry_ms, "Time from the failure of a service or action to its reset.", (1, _DAY)
        ),
    ]
    watchdogs, words = configuration.watchdog_ms, topic_words(graph)
    loop = configuration.control_loop
    return [
        Parameter("period_ms", loop.period_ms, "Period of ticks.", (1, _DAY)),
        Parameter(
            "events_per_tick",
            loop.events_per_tick,
            "Maximum number of events sent in a tick; 0: no limit.",
            (0, _COUNT),
        ),
        Parameter(
            "reactions_per_tick",
            loop.reactions_per_tick,
            "Maximum number of events that data of one topic starts between two ticks.",
            (0, _COUNT),
        ),
        Parameter(
            "react_immediately",
            loop.react_immediately,
            "Whether incoming data may start events at once, before the next tick.",
        ),
        *(clients if len(clients) > 1 else ()),
        Parameter("watchdog_stops", configuration.watchdog_stops, configuration.watchdog_meaning),
        *(
            Parameter(
                watchdog(words, subscription),
                watchdogs.get(subscription.topic.removeprefix("/"), 0),
                f"Longest silence of {subscription.topic}; 0: no limit.",
                (0, _DAY),
            )
            for subscription in graph.subscriptions
        ),
        *_diagnostics(configuration),
        _event_log(log),
        *model_parameters(graph).values(),
    ]


def model_parameters(graph: rosgraph.RosGraph) -> dict[rosgraph.Parameter, Parameter]:
    """Return the parameters that the model declares. Those of a component have its name as prefix."""
    parameters = {}
    for declared in graph.parameters:
        name = declared.name if declared.component is None else f"{declared.component}.{declared.name}"
        low, high = declared.lowest, declared.highest
        if isinstance(declared.type, ex.IntegerType):
            low, high = declared.type.minimum, declared.type.maximum
        bounds = None if low is None or high is None else (low, high)
        default = constant_value(declared.initial)
        assert isinstance(default, (bool, int, float, str))
        parameters[declared] = Parameter(name, default, declared.description or "", bounds, changes=True)
    return parameters


def watchdog(words: Mapping[Topic, str], topic: rosgraph.Subscription) -> str:
    """Return the parameter that limits the silence of a topic; `words` are those of `topic_words`."""
    return f"watchdog_ms.{words[topic]}"


def topic_words(graph: rosgraph.RosGraph) -> dict[Topic, str]:
    """Return a unique word for each subscription and publisher: its topic's name in letters, digits and underscores."""
    words: dict[Topic, str] = {}
    taken: set[str] = set()
    topics: list[Topic] = [*graph.subscriptions, *graph.publishers]
    for topic in topics:
        word = re.sub(r"[^A-Za-z0-9]+", "_", topic.topic).strip("_") or "topic"
        numbered = (f"{word}_{number}" for number in count(2))
        words[topic] = next(name for name in chain([word], numbered) if name not in taken)
        taken.add(words[topic])
    return words


def layer_parameters(graph: rosgraph.RosGraph, configuration: Configuration, log: str) -> list[Parameter]:
    """Return the parameters of a supervisory layer."""
    period = configuration.control_loop.period_ms
    return [
        Parameter("period_ms", period, "Period of reports of the state.", (1, _DAY)),
        *_timeouts(graph, configuration),
        *_diagnostics(configuration),
        _event_log(log),
        *model_parameters(graph).values(),
    ]


def _timeouts(graph: rosgraph.RosGraph, configuration: Configuration) -> list[Parameter]:
    services, actions = configuration.services.timeout_ms, configuration.actions.timeout_ms
    parameters = []
    if graph.serviceClients:
        meaning = "A call fails after this time without an answer."
        parameters.append(Parameter("service_timeout_ms", services, meaning, (1, _DAY)))
    if graph.actionClients:
        meaning = "A goal fails after this time without acceptance."
        parameters.append(Parameter("action_timeout_ms", actions, meaning, (1, _DAY)))
    return parameters


def _diagnostics(configuration: Configuration) -> list[Parameter]:
    meaning = "Period of reports on /diagnostics; 0: none."
    period = configuration.diagnostics_ms
    return [Parameter("diagnostics_ms", period, meaning, (0, _DAY))] if period else []


def _event_log(log: str) -> Parameter:
    return Parameter("event_log", log, "File for the event log, with a line of JSON for each event; empty: none.")
