"""Values that the templates of ROS packages print."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.language.configuration import Configuration, Package
    from robosc.language.configuration.parameters import Parameter
    from robosc.m2t.models import TraceTest
    from robosc.m2t.ros.gates import Gate
    from robosc.m2t.ros.layer import LayerNode
    from robosc.m2t.ros.node import GeneratedNode, Variable
    from robosc.m2t.ros.statuses import Status
    from robosc.m2t.ros.typed_state import Field
    from robosc.model import rosgraph


@dataclass(frozen=True)
class NodeValues:
    """Values of a node's package that hold for every ROS version.

    `ros_package` is the package that contains the node: its own, or the user's. `included` are headers in `include`.
    `parameter_groups` are the parameters of the parameters file, `library` those that generate_parameter_library
    declares, as a tree. `typed` is the type of the typed state, None without one, and `typed_fields` are its fields.
    `remembers` is whether the node records which commands are withheld. `reports_violations` is the warning of a node
    that goes on after a violation, empty for other nodes. `absolute_warning` is the format of the warning of absolute
    names. `has_license` is whether the package has the text of its license. `described_reports` are the topics of the
    node's reports: name, type and content. `no_stop` and `turned` are the results of `packages`' functions of these
    names. `has_defaults` and `spelled` are functions of an interface, `frame` one of a topic.
    """

    kind: str
    node: GeneratedNode
    layer: LayerNode | None
    tests: TraceTest | None
    package: str
    ros_package: str
    has_own_types: bool
    player: str
    about: Package
    has_license: bool
    described_reports: Sequence[tuple[str, rosgraph.Interface, str]]
    spelled: Callable[[rosgraph.Interface], str]
    description: str
    included: Sequence[str]
    settings: Configuration
    parameters: Mapping[str, Parameter]
    has_parameters_file: bool
    library: Mapping[str, Any]
    parameter_groups: Mapping[str, Mapping[str, Parameter]]
    publishes_state: bool
    statuses: Sequence[Status]
    typed_fields: Sequence[Field]
    typed: rosgraph.Interface | None
    remembers: bool
    gates: Sequence[Gate]
    reports_blocked: bool
    writes_log: bool
    definition: str
    no_stop: Sequence[tuple[str, str]]
    reports_violations: str
    stops_on_violation: bool
    awaited: Sequence[str]
    turned: Sequence[tuple[Variable, str]]
    absolute_warning: str
    has_defaults: Callable[[rosgraph.Interface], bool]
    frame: Callable[[str], str]


@dataclass(frozen=True)
class BuildValues:
    """Values of a package that depend on the ROS version: its headers, its build files and its dependencies.

    `package_depends` are the packages of each kind of `<depend>`.
    """

    headers: Sequence[str]
    build_tool: str
    dependencies: Sequence[str]
    package_depends: Sequence[tuple[str, Sequence[str]]]
