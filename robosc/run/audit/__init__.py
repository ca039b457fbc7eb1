"""Audit of a recording: what the supervisor would have forbidden, and what the model does not expect.

A `Judge` follows the run on the model. `topics` turns the messages of a bag or an MCAP file into its events and
commands, `event_logs` the lines of a node's event log. `findings` has the result.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from robosc.base.recordings import Recording
from robosc.language.configuration.names import configured_names
from robosc.language.configuration.parameters import layer_parameters
from robosc.run.audit.event_logs import LogError, LogJudge
from robosc.run.audit.findings import Audit, Finding, Kind
from robosc.run.audit.judge import Judge
from robosc.run.audit.port import RecordingPort
from robosc.run.audit.topics import Topics
from robosc.run.runtime.core.settings import Settings

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from robosc.base.recordings import Channel
    from robosc.base.ros_types import RosTypes
    from robosc.engine import Engine
    from robosc.engine.state import Value
    from robosc.engine.timers import Timers
    from robosc.language.configuration import Configuration
    from robosc.model import rosgraph, sct
    from robosc.run.audit.judge import Watch

__all__ = ["Audit", "AuditOptions", "Finding", "Judge", "Kind", "LogError", "LogJudge", "RecordingJudge"]


@dataclass(frozen=True)
class AuditOptions:
    """Options of an audit.

    `state` has the values of the state at the start that differ from the initial state. `tolerance` is in nanoseconds.
    `namespace` and `remappings` are those of the robot's controller. `watch` is called after each event with its name,
    and for each finding with the name of its event and the finding.
    """

    state: Mapping[sct.Plant | sct.DiscreteVariable, Value] = field(default_factory=dict)
    tolerance: int = 0
    namespace: str = ""
    remappings: Mapping[str, str] = field(default_factory=dict)
    watch: Watch | None = None


class RecordingJudge:
    """Audit of a bag or an MCAP file with a robot's graph, whose model has a supervisor."""

    def __init__(
        self,
        graph: rosgraph.RosGraph,
        configuration: Configuration,
        types: RosTypes,
        path: str,
        options: AuditOptions | None = None,
    ) -> None:
        self.path = path
        self._options = options or AuditOptions()
        self._recording = Recording(path, types)
        self._ros = 1 if path.endswith(".bag") else 2
        values = {
            parameter.name: parameter.default
            for parameter in layer_parameters(graph, configuration, "")
            if parameter.name != "diagnostics_ms"
        }
        port = RecordingPort(types.distribution(self._ros))
        settings = Settings(values, configuration)
        self.judge = Judge(graph, settings, port, self._options.tolerance, self._options.watch)
        with configured_names(graph, configuration):
            timeout = configuration.services.timeout_ms / 1000
            self._topics = Topics(self.judge, port, graph, self._resolve, timeout)

    def _resolve(self, name: str) -> str:
        """Return the name of a topic, service or action in the ROS graph."""
        options = self._options
        if name in options.remappings or f"/{name}" in options.remappings:
            name = options.remappings.get(name) or options.remappings[f"/{name}"]
        return name if name.startswith("/") else f"{options.namespace.rstrip('/')}/{name}"

    @property
    def audit(self) -> Audit:
        """The result so far."""
        return self.judge.audit

    @property
    def engine(self) -> Engine:
        """The engine, in the present state of the robot."""
        return self.judge.engine

    @property
    def timers(self) -> Timers | None:
        """The timers of the model."""
        return self.judge.timers

    def run(self) -> Audit:
        """Judge the whole recording. Raises RecordingError, and OSError."""
        judge, recording, topics = self.judge, self._recording, self._topics
        handlers: dict[Channel, Callable[[bytes], None] | None] = {}
        for time, channel, data in recording.messages(lambda topic, _: topic in topics.names):
            if channel not in handlers:
                if not handlers:
                    assert recording.start is not None
                    self._ros = channel.ros
                    judge.begin(min(recording.start, time), self._options.state)
                handlers[channel] = topics.handler(channel)
            judge.advance(time)
            handle = handlers[channel]
            if handle is not None:
                handle(data)
        judge.decide()
        self.audit.unseen = topics.unseen(self._ros)
        return self.audit
