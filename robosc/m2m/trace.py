"""What became of each element of a robot model, and where each element of an sct model comes from."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from robosc.metamodel import sct

if TYPE_CHECKING:
    from robosc.m2m.enumerations import Enumerations
    from robosc.metamodel import expression as ex
    from robosc.metamodel import robosc
    from robosc.semantics.cone_of_influence import ConeOfInfluence, Data
    from robosc.semantics.instances import Instance, Instances, InstanceVariable, PortInstance


#: Table 5.1: the plant's event that a result type means.
EVENT_OF = {
    "request": sct.EventKind.trigger,
    "response": sct.EventKind.response,
    "error": sct.EventKind.error,
    "feedback": sct.EventKind.feedback,
    "cancel": sct.EventKind.cancel,
}


@dataclass
class Trace:
    """The links of one transformation; an element that the supervisor does not need has no target."""

    instances: Instances
    cone: ConeOfInfluence
    model: sct.SupervisoryControlModel
    enumerations: Enumerations
    plants: dict[PortInstance, sct.Plant] = field(default_factory=dict)
    events: dict[tuple[PortInstance, str], sct.Event] = field(default_factory=dict)
    inputs: dict[Data, sct.Input] = field(default_factory=dict)
    behaviours: dict[Instance, sct.Plant] = field(default_factory=dict)
    locations: dict[tuple[Instance, robosc.State], sct.Location] = field(default_factory=dict)
    taus: dict[tuple[Instance, robosc.TauTransition], sct.Event] = field(default_factory=dict)
    variables: dict[InstanceVariable, sct.DiscreteVariable] = field(default_factory=dict)
    provided: dict[robosc.ProvideStatement, sct.Location] = field(default_factory=dict)
    origins: dict[ex.Located, ex.Located] = field(default_factory=dict)

    def event(self, port: PortInstance, kind: sct.EventKind) -> sct.Event:
        """The event of that kind of a communication; KeyError where its kind of communication has none."""
        return self.events[port, kind.name]
