"""Settings of the generated code: `controller-config.json` (thesis section 5.4), read, checked and located."""

import json
from collections.abc import Sequence
from dataclasses import replace
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeVar, get_origin

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, PrivateAttr, ValidationError
from pydantic.alias_generators import to_camel

from robosc.base.diagnostics import Diagnostic, ModelError, Severity, Span
from robosc.base.files import reading as files
from robosc.base.files.json_places import Key, duplicates, position, reason_of, span_of
from robosc.base.files.json_reading import JsonError, json_value
from robosc.model.semantics.naming import controller_name, layer_name, output_name, snake_case
from robosc.model.semantics.roles import assumptions

if TYPE_CHECKING:
    from robosc.model.expression import NamedElement
    from robosc.model.sct import SupervisoryControlModel

FILE_NAME = "controller-config.json"
RULE = "configuration"
#: Warnings of a node at its start that nothing stops its robot: when the node ends, when a topic falls silent, and when
#: the robot violates an assumption.
NO_STOP = "onShutdown names no message: when this node ends, the robot continues with its last command"
NO_STOP_ON_SILENCE = (
    "watchdog_stops holds commands back and does not stop the robot: onShutdown names no message, the robot continues"
    " with its last command"
)
NO_STOP_ON_VIOLATION = (
    "a violation of an assumption holds commands back and does not stop the robot: onShutdown names no message, the"
    " robot continues with its last command"
)
#: Warning of a node at its start that goes on after a violation.
REPORTS_VIOLATIONS = (
    "onViolation is report: after the first violation of an assumption, nothing about the robot is proved"
)
#: Warning of a node at its start: its namespace, and the names of the model outside of it.
ABSOLUTE_NAMES = 'the namespace %s does not apply to %s: see "absoluteNames" in the configuration'
#: Licenses whose text a package gets.
LICENSE_TEXTS = ("Apache-2.0", "BSD-3-Clause", "MIT")
#: Maximum depth of folders below the model in the search for a configuration.
SEARCH_DEPTH = 3

_Value = TypeVar("_Value")


def _by_topic(values: dict[str, _Value]) -> dict[str, _Value]:
    named: dict[str, _Value] = {}
    for topic, value in values.items():
        name = topic.removeprefix("/")
        if name in named:
            raise ValueError(f"names {name} twice, with and without a leading /")
        named[name] = value
    return named


#: One value for each topic, service or action. Keys lose their leading `/`.
ByTopic = Annotated[dict[str, _Value], AfterValidator(_by_topic)]
#: Messages of the model. An instance of a fleet has the name as in all output, such as `Cell2`.
Messages = Annotated[list[str], AfterValidator(lambda names: [output_name(name) for name in names])]
Milliseconds = Annotated[int, Field(ge=1, le=24 * 3600 * 1000)]
#: Limited because the C engine counts events of a tick in 16 bits.
Count = Annotated[int, Field(ge=0, le=0xFFFF)]


class _Settings(BaseModel):
    model_config = ConfigDict(alias_generator=to_camel, validate_by_name=True, extra="forbid", frozen=True, strict=True)


class Output(_Settings):
    """Folders that get a copy of a generated package: the package's own files, not a folder with its name.

    Relative paths start at the model's folder.
    """

    ros1_controller_node_location: str | None = Field(default=None, min_length=1)
    ros2_controller_node_location: str | None = Field(default=None, min_length=1)
    ros2_supervisor_node_location: str | None = Field(default=None, min_length=1)


#: Keys of the folders for copies in dotted notation, by their attributes.
LOCATIONS = {name: f"output.{field.alias}" for name, field in Output.model_fields.items()}


class Run(_Settings):
    """A node to start as the existing controller."""

    package_name: str
    executable: str
    name: str | None = None
    namespace: str | None = None


class Launch(_Settings):
    """A launch file that starts the existing controller."""

    package_name: str
    file: str


class ExistingController(_Settings):
    """Start of the controller behind the supervisory layer: by `run` or by `launch`."""

    run: Run | None = None
    launch: Launch | None = None


class Supervisor(_Settings):
    """The supervisory layer (thesis section 4.7)."""

    controller: ExistingController = ExistingController()


class ControlLoop(_Settings):
    """Timing of the controller."""

    period_ms: Milliseconds = Field(default=100, description="Period of ticks in milliseconds.")
    events_per_tick: Count = Field(default=0, description="Maximum number of events sent in a tick; 0: no limit.")
    react_immediately: bool = Field(
        default=True, description="Whether incoming data may start events at once, before the next tick."
    )
    reactions_per_tick: Count = Field(
        default=10,
        description="Maximum number of events that data of one topic, service or action starts between two ticks.",
    )


class Services(_Settings):
    """Service calls."""

    timeout_ms: Milliseconds = Field(
        default=5000, description="A call fails after this time without an answer, in milliseconds."
    )


class Actions(_Settings):
    """Action goals."""

    timeout_ms: Milliseconds = Field(
        default=5000, description="A goal fails after this time without acceptance, in milliseconds."
    )


class QualityOfService(_Settings):
    """ROS 2 quality of service of one communication. Absent settings keep the default of its kind."""

    reliability: Literal["reliable", "best_effort"] | None = None
    durability: Literal["volatile", "transient_local"] | None = None
    depth: int | None = Field(default=None, ge=1, le=100_000)


class Package(_Settings):
    """Metadata for `package.xml`."""

    name: str | None = Field(
        default=None,
        pattern=r"^[a-z][a-z0-9]*(_[a-z0-9]+)*$",
        min_length=2,
        description="Name of the package, node and executable. Default: derived from the robot's name.",
    )
    version: str = Field(default="0.1.0", pattern=r"^[0-9]+\.[0-9]+\.[0-9]+$")
    maintainer: str = Field(default="Unknown maintainer", min_length=1)
    email: str = Field(
        default="unknown@example.com",
        pattern=r"^[-a-zA-Z0-9_%+]+(\.[-a-zA-Z0-9_%+]+)*@([-a-zA-Z0-9%]+\.)+[a-zA-Z]{2,}$",
    )
    license: str = Field(
        default="Proprietary",
        min_length=1,
        description=f"SPDX identifier. The package gets the text of {', '.join(LICENSE_TEXTS)}.",
    )
    url: str | None = Field(default=None, pattern=r"^https?://\S+$", description="Website of the package.")
    description: str | None = Field(
        default=None, min_length=1, description="Default: a sentence with the robot's name."
    )


class Lifecycle(_Settings):
    """A managed node."""

    bond: bool = Field(
        default=False, description="Whether the active node has a bond, as nav2_lifecycle_manager expects it."
    )


def _lifecycle(value: Any) -> Any:
    if isinstance(value, bool):
        return {} if value else None
    if not isinstance(value, dict):
        raise ValueError('must be true, false or an object, such as {"bond": true}')  # noqa: TRY004  # pydantic reports it
    return value


class Configuration(_Settings):
    """All settings of generated code. In JSON the names are in camelCase; each is optional."""

    publish_state_information: bool = Field(default=True, description="Whether the node publishes its state.")
    typed_state: bool = Field(
        default=False,
        description="Whether the node also publishes its state as a message. Generates a package with its type.",
    )
    write_events_to_log: bool = Field(default=False, description="Whether the node writes an event log.")
    diagnostics_ms: int = Field(
        default=1000,
        ge=0,
        le=24 * 3600 * 1000,
        description="Period of reports on /diagnostics in milliseconds; 0: the node does not publish this topic.",
    )
    output: Output = Output()
    supervisor: Supervisor = Supervisor()
    control_loop: ControlLoop = ControlLoop()
    services: Services = Services()
    actions: Actions = Actions()
    retry_ms: Milliseconds = Field(
        default=1000, description="Time from the failure of a service or action to its reset, in milliseconds."
    )
    absolute_names: bool = Field(
        default=True,
        description="Whether names of topics, services and actions keep their leading /. Without it, the namespace of"
        " the node applies to them. If absent, a node in a namespace warns of such names.",
    )
    frame_id: ByTopic[str] = Field(default={}, description="Frame of headers that the model leaves unset, by topic.")
    qos: ByTopic[QualityOfService] = Field(
        default={}, description="ROS 2 quality of service, by topic, service or action."
    )
    watchdog_ms: ByTopic[Milliseconds] = Field(
        default={}, description="Silence after which the node reports a topic, in milliseconds, by topic."
    )
    watchdog_stops: bool = Field(
        default=False,
        description="Whether such a silence holds all commands back, cancels actions and sends onShutdown.",
    )
    on_shutdown: Messages = Field(
        default=[],
        description="Messages of the model to send, in this order, when the node ends or a topic's silence stops it."
        " Without one, the robot continues with its last command.",
    )
    on_withheld: Messages = Field(
        default=[],
        description="Messages of the model to send, in this order, when a command's data cannot be sent."
        " Without one, the robot continues with its last command.",
    )
    on_blocked: Messages = Field(
        default=[],
        description="Messages of the model. A layer that blocks one after it forwarded one sends one itself, once."
        " Without one, the robot continues with its last command.",
    )
    wait_for: list[str] = Field(
        default=[],
        description="Topics from which a controller must receive a message each before it sends commands.",
    )
    on_violation: Literal["stop", "report"] = Field(
        default="stop",
        description="Reaction to an event from the robot that violates an assumption. stop: hold commands back, cancel"
        " actions and send onShutdown, a layer onBlocked, until the node is started again. report: go on.",
    )
    lifecycle: Annotated[Lifecycle | None, BeforeValidator(_lifecycle, json_schema_input_type=bool | Lifecycle)] = (
        Field(
            default=None,
            description="Whether the ROS 2 node is a managed (lifecycle) node. An object sets its details.",
            json_schema_extra={"default": False},
        )
    )
    parameters: Literal["node", "library"] = Field(
        default="node",
        description="Whether a ROS 2 node itself or generate_parameter_library declares its parameters.",
    )
    package: Package = Package()

    _file: str = PrivateAttr(FILE_NAME)
    _text: str = PrivateAttr("{}")

    def model_post_init(self, context: Any) -> None:
        """Store the file and text of the configuration, so that later findings can be located."""
        self._file, self._text = context or (FILE_NAME, "{}")

    @property
    def has_bond(self) -> bool:
        """Whether the node is managed and has a bond."""
        return self.lifecycle is not None and self.lifecycle.bond

    def package_name(self, robot: "NamedElement") -> str:
        """Return the name of a robot's package, node and executable."""
        return self.package.name or controller_name(robot)

    def interfaces_name(self, robot: "NamedElement") -> str:
        """Return the name of the package with the type of a robot's state."""
        return f"{self.package.name or snake_case(robot.name)}_msgs"

    def layer_name(self, robot: "NamedElement") -> str:
        """Return the name of the package, node and executable of a robot's supervisory layer."""
        return self.package.name or layer_name(robot)

    def error(self, key: Key, message: str, hint: str | None = None) -> Diagnostic:
        """Return an error at a key of the configuration file, such as `("onShutdown", 0)` or `("qos", "scan")`.

        If the file does not have the key, the error is at the innermost key around it.
        """
        return Diagnostic(self._file, span_of(self._text, key), Severity.ERROR, RULE, message, hint)

    def warning(self, key: Key, message: str, hint: str | None = None) -> Diagnostic:
        """Return a warning at a key of the configuration file."""
        return replace(self.error(key, message, hint), severity=Severity.WARNING)

    @property
    def says_how_to_stop(self) -> bool:
        """Whether the user has decided on the messages at the node's end, possibly none."""
        return "on_shutdown" in self.model_fields_set

    @property
    def warns_of_absolute_names(self) -> bool:
        """Whether a node in a namespace warns of absolute names: the user has not decided on them."""
        return "absolute_names" not in self.model_fields_set

    def stops_on_violation(self, model: "SupervisoryControlModel") -> bool:
        """Return whether the first violation of an assumption of the model stops the robot."""
        return self.on_violation == "stop" and bool(assumptions(model))

    def missing_license(self) -> list[Diagnostic]:
        """Return a warning about a license whose text the package does not get."""
        package = self.package
        if package.license in {*LICENSE_TEXTS, Package().license}:
            return []
        message = f'"package.license": the package gets no LICENSE file for {package.license}'
        hint = f"add the file yourself, or name one of {', '.join(LICENSE_TEXTS)}"
        return [self.warning(("package", "license"), message, hint)]

    @property
    def watchdog_meaning(self) -> str:
        """Description of the parameter `watchdog_stops` with these settings."""
        if not self.on_shutdown:
            stands = "It sends nothing: the robot continues with its last command."
            return f"Whether a silent topic holds commands back and cancels actions. {stands}"
        return f"Whether a silent topic holds commands back, cancels actions and sends {', '.join(self.on_shutdown)}."

    def unknown_names(self, topics: Sequence[str]) -> list[Diagnostic]:
        """Return warnings about settings for interfaces that the robot does not have.

        `topics` are its topics, services and actions without a leading `/`.
        """
        settings = (("frameId", self.frame_id), ("qos", self.qos), ("watchdogMs", self.watchdog_ms))
        return [
            self.warning(
                (setting, name), f'"{setting}": the robot has no {name}', _one_of(name, topics) if topics else None
            )
            for setting, values in settings
            for name in values
            if name not in topics
        ]


def find(folder: Path) -> Path | None:
    """Return the `controller-config.json` in a model's folder, else in a folder below it. None if there is none.

    The nearest one counts. Skips hidden folders. Raises ModelError if two are equally near.
    """
    level = [folder]
    for _ in range(SEARCH_DEPTH + 1):
        # `read` reports a pipe or device.
        candidates = [folder / FILE_NAME for folder in level if _is_there(folder / FILE_NAME)]
        if len(candidates) > 1:
            names = " and ".join(f"{file.relative_to(folder)}" for file in candidates[:2])
            names += f" and {len(candidates) - 2} more" if len(candidates) > 2 else ""
            message = f"the model's folder has several configurations: {names}"
            raise ModelError([_error(str(candidates[1]), message, hint="choose one with --config")])
        if candidates:
            return candidates[0]
        level = [below for folder in level for below in _folders(folder)]
    return None


def _is_there(file: Path) -> bool:
    return file.exists() and not file.is_dir()


def read(file: Path) -> Configuration:
    """Return the configuration in a file. Raises ModelError with all its errors, and OSError."""
    name = str(file)
    try:
        text = files.read(file).decode("utf-8")
        values = json_value(text)
    except UnicodeDecodeError as error:
        raise ModelError([_error(name, f"not UTF-8: {error.reason} at byte {error.start}")]) from error
    except JsonError as error:
        line, column = position(text, error.position)
        raise ModelError([_error(name, str(error), Span(line, column, line, column + 1), error.hint)]) from error
    findings = [_error(name, f'the key "{key}" occurs twice', span) for key, span in duplicates(text)]
    try:
        configuration = Configuration.model_validate(values, context=(name, text), by_alias=True, by_name=False)
    except ValidationError as error:
        findings += [_explained(name, text, fault) for fault in error.errors()]
    if findings:
        raise ModelError(findings)
    return configuration


def schema() -> str:
    """Return the JSON Schema of the configuration file, as in `robosc/schemas`."""
    document = {"$schema": "https://json-schema.org/draft/2020-12/schema", **Configuration.model_json_schema()}
    return json.dumps(document, indent=2) + "\n"


def _folders(folder: Path) -> list[Path]:
    try:
        return sorted(
            path for path in folder.iterdir() if path.is_dir() and not path.is_symlink() and path.name[0] != "."
        )
    except OSError:
        return []


def _error(file: str, message: str, span: Span | None = None, hint: str | None = None) -> Diagnostic:
    return Diagnostic(file, span or Span(1, 1, 1, 1), Severity.ERROR, RULE, message, hint)


def _explained(file: str, text: str, fault: Any) -> Diagnostic:
    """Return an error of pydantic as a finding that names the key."""
    key: Key = fault["loc"]
    hint = _repair(key) if fault["type"] == "extra_forbidden" else None
    return _error(file, reason_of(fault), span_of(text, key), hint)


def _one_of(name: str, known: Sequence[str]) -> str:
    close = get_close_matches(name, sorted(known), n=1)
    return f'did you mean "{close[0]}"?' if close else f"known here: {', '.join(known)}"


def _repair(key: Key) -> str:
    """Suggest a similar known key: beside the unknown one, else anywhere. If there is none, list all keys beside it."""
    name, known = str(key[-1]), _keys_at(key[:-1])
    elsewhere = {below: f"{outer}.{below}" for outer in _keys_at(()) for below in _keys_below(outer)}
    close = get_close_matches(name, sorted(elsewhere), n=1, cutoff=0.8)
    if close and not get_close_matches(name, known, n=1):
        outer, _, below = elsewhere[close[0]].partition(".")
        return f'did you mean "{outer}.{below}", which is written {{"{outer}": {{"{below}": …}}}}?'
    return _one_of(name, known)


def _keys_below(outer: str) -> list[str]:
    """Return the keys of the object at a top-level key of the configuration. Empty if it has no object."""
    field = next(entry for entry in Configuration.model_fields.values() if entry.alias == outer)
    by_topic = get_origin(field.annotation) is dict
    return _keys_at((outer,)) if _settings_in(field.annotation) and not by_topic else []


def _keys_at(key: Key) -> list[str]:
    """Return the keys that an object of the configuration may have."""
    model: type[BaseModel] = Configuration
    for name in key:
        field = next((entry for entry in model.model_fields.values() if entry.alias == name), None)
        below = _settings_in(field.annotation) if field else None
        model = below or model
    return [str(field.alias) for field in model.model_fields.values()]


def _settings_in(annotation: Any) -> type[BaseModel] | None:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    return next((settings for settings in map(_settings_in, getattr(annotation, "__args__", ())) if settings), None)
