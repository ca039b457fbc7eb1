"""ROS 2 quality of service of each communication: the default of its kind, changed by the configuration."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum, auto
from typing import TYPE_CHECKING

from robosc.language.configuration import QualityOfService
from robosc.model.semantics.communication import is_sensor_data

if TYPE_CHECKING:
    from robosc.language.configuration import Configuration
    from robosc.model import rosgraph


class Profile(Enum):
    """Default quality of service: reliable with a queue of `QUEUE_DEPTH` messages, or one of ROS 2's own profiles."""

    QUEUE = auto()
    SENSOR_DATA = auto()
    SERVICES = auto()


@dataclass(frozen=True)
class Quality:
    """Quality of service of one communication: a profile, changed by settings."""

    profile: Profile
    settings: QualityOfService

    @property
    def latched(self) -> Quality:
        """The quality of a topic whose publishers store messages: transient-local, and reliable unless set."""
        reliability = self.settings.reliability or ("reliable" if self.profile is Profile.SENSOR_DATA else None)
        return self._changed(durability="transient_local", reliability=reliability)

    @property
    def volatile(self) -> Quality:
        """The quality of a topic whose publishers store no messages."""
        return self._changed(durability=None)

    def _changed(self, **settings: str | None) -> Quality:
        return replace(self, settings=self.settings.model_copy(update=settings))


def reception(interface: rosgraph.Interface, topic: str, configuration: Configuration) -> Quality:
    """Return the quality of the subscription to a topic."""
    profile = Profile.SENSOR_DATA if is_sensor_data(interface.package) else Profile.QUEUE
    return Quality(profile, settings(topic, configuration))


def transmission(topic: str, configuration: Configuration, *, on_change: bool) -> Quality:
    """Return the quality of the publisher of a topic. Messages sent on change are stored for late subscribers."""
    quality = Quality(Profile.QUEUE, settings(topic, configuration))
    return quality.latched if on_change and quality.settings.durability is None else quality


def forwarding(topic: str, configuration: Configuration) -> Quality:
    """Return the quality of the topic to which a layer forwards: reliable, whatever the received messages are."""
    return Quality(Profile.QUEUE, QualityOfService(depth=settings(topic, configuration).depth))


def service_calls(service: str, configuration: Configuration) -> Quality:
    """Return the quality of a service."""
    return Quality(Profile.SERVICES, settings(service, configuration))


def feedback(action: str, configuration: Configuration) -> Quality:
    """Return the quality of the feedback of an action."""
    return Quality(Profile.QUEUE, settings(action, configuration))


def settings(name: str, configuration: Configuration) -> QualityOfService:
    """Return the configured settings of a topic, service or action, by its name with or without a leading `/`."""
    return configuration.qos.get(name.removeprefix("/")) or QualityOfService()
