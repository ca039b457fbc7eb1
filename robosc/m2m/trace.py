"""Links between the elements of a robot model and the elements of its sct model."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from robosc.model import robosc
from robosc.model.semantics.communication import event_of

if TYPE_CHECKING:
    from robosc.m2m.declarations import Declarations
    from robosc.model import expression as ex
    from robosc.model import sct
    from robosc.model.semantics.cone_of_influence import ConeOfInfluence
    from robosc.model.semantics.inputs import InputSource
    from robosc.model.semantics.instances import (
        Instance,
        InstanceParameter,
        Instances,
        InstanceVariable,
        PortInstance,
        Statement,
    )


@dataclass
class Trace:
    """Links of one transformation. An element that the supervisor does not need has no target."""

    instances: Instances
    cone: ConeOfInfluence
    model: sct.SupervisoryControlModel
    declarations: Declarations
    plants: dict[PortInstance, sct.Plant] = field(default_factory=dict)
    events: dict[tuple[PortInstance, str], sct.Event] = field(default_factory=dict)
    inputs: dict[InputSource, sct.Input] = field(default_factory=dict)
    goals: dict[sct.Input, sct.DiscreteVariable] = field(default_factory=dict)
    behaviours: dict[Instance, sct.Plant] = field(default_factory=dict)
    locations: dict[tuple[Instance, robosc.State], sct.Location] = field(default_factory=dict)
    own: dict[tuple[Instance, robosc.Transition], sct.Event] = field(default_factory=dict)
    requirement_locations: dict[tuple[Instance | None, robosc.RequirementState], sct.Location] = field(
        default_factory=dict
    )
    variables: dict[InstanceVariable, sct.DiscreteVariable] = field(default_factory=dict)
    durations: dict[tuple[InstanceParameter, int], sct.Duration] = field(default_factory=dict)
    provided: dict[Statement[robosc.ProvideStatement], sct.Location] = field(default_factory=dict)
    origins: dict[ex.Located, ex.Located] = field(default_factory=dict)

    def event(self, port: PortInstance, kind: sct.EventKind) -> sct.Event:
        """Return the event of a kind of a port. Raises KeyError if its communication has no such event."""
        return self.events[port, kind.name]

    def event_of(self, transition: robosc.Transition, instance: Instance) -> sct.Event:
        """Return the event that a transition reacts to (thesis table 5.1), or its own event."""
        if not isinstance(transition, robosc.ResultTransition):
            return self.own[instance, transition]
        port = self.instances.port(transition.communicationType, instance)
        named = event_of(transition.communicationType, transition.resultType)
        assert port is not None
        assert named is not None
        return self.event(port, named.kind)
