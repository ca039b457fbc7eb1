"""RoboSC: describe what a robot may do, and get a controller that provably does only that.

From text to generated code, step by step, as on the command line:

    robot = robosc.load("line_follower.rscd")
    findings = robosc.check(robot)
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    models = robosc.Models(model, robosc.to_rosgraph(robot), robot)
    files = robosc.generate("ros2", models)

Each function imports its modules on its first call, so that `import robosc` is fast.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from os import PathLike

    from robosc.analysis.supervise import EmptySupervisorError
    from robosc.base.diagnostics import Diagnostic, ModelError
    from robosc.language.configuration import Configuration
    from robosc.m2m.trace import Trace
    from robosc.m2t.models import Models
    from robosc.model.engine import EngineModel
    from robosc.model.robosc import Base, Robot
    from robosc.model.rosgraph import RosGraph
    from robosc.model.sct import Supervisor, SupervisoryControlModel

__version__ = "0.1.0"

__all__ = [
    "Configuration",
    "Diagnostic",
    "EmptySupervisorError",
    "ModelError",
    "Models",
    "check",
    "generate",
    "load",
    "synthesize",
    "to_engine",
    "to_rosgraph",
    "to_sct",
]

_LOADED_WHEN_ASKED = {
    "Configuration": "robosc.language.configuration",
    "Diagnostic": "robosc.base.diagnostics",
    "EmptySupervisorError": "robosc.analysis.supervise",
    "ModelError": "robosc.base.diagnostics",
    "Models": "robosc.m2t.models",
}


def __getattr__(name: str) -> Any:
    if name not in _LOADED_WHEN_ASKED:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_LOADED_WHEN_ASKED[name]), name)


def __dir__() -> list[str]:
    return sorted([*__all__, "__version__"])


def load(
    path: str | PathLike[str] | None = None,
    library_paths: Sequence[str | PathLike[str]] = (),
    interface_paths: Sequence[str | PathLike[str]] = (),
    *,
    text: str | None = None,
    documents: Mapping[str | PathLike[str], str] | None = None,
) -> Robot:
    """Load the robot in a `.rscd` file, or in an `.xmi` file of the robosc metamodel, with resolved names.

    If `text` is given, it replaces the content of the file, which need not exist. Without a path, the text counts as a
    file in the working folder. `documents` are texts that replace other `.rscd` files, by their paths.

    Libraries are searched beside the file, then in `library_paths`, in ROBOSC_PATH and in the standard library. ROS
    types in place of objects (`type: geometry_msgs/Twist`) are searched as in `check`.

    Raises ModelError with all findings if the text or its names have errors, ValueError if the file holds no robot,
    OSError if it cannot be read, and TypeError without path and text. Does not run the rules; see `check`.
    """
    from robosc.base.diagnostics import ModelError, has_errors
    from robosc.model import robosc

    if path is None and text is None:
        raise TypeError("load needs a path or a text")
    path = "<text>" if path is None else str(path)
    if path.endswith(".xmi") and text is None:
        from robosc.model import validity

        base = validity.load(path)
    else:
        from robosc.base.ros_types import RosTypes
        from robosc.language.reading import read
        from robosc.language.text import Documents

        texts = {str(name): content for name, content in (documents or {}).items()} | (
            {} if text is None else {path: text}
        )
        reading = read(path, [str(folder) for folder in library_paths], RosTypes(interface_paths), Documents(texts))
        if reading.base is None or has_errors(reading.findings):
            raise ModelError(reading.findings)
        base = reading.base
    if not isinstance(base, robosc.Robot):
        raise ValueError(f"{path} has a {type(base).__name__}, not a Robot")  # noqa: TRY004  # the file is wrong
    return base


def check(robot: Base, interface_paths: Sequence[str | PathLike[str]] = ()) -> list[Diagnostic]:
    """Check a robot or library, and its imports, against the rules of the language (thesis 4.5). Return all findings.

    `interface_paths` are folders with ROS packages below them. Types of other packages are searched in the folders of
    ROBOSC_INTERFACE_PATH, in the ROS installation and among the standard types.
    """
    from robosc.base.ros_types import RosTypes
    from robosc.language.checks import check as checked

    return checked(robot, (), RosTypes(interface_paths))


def to_sct(robot: Robot) -> SupervisoryControlModel:
    """Return the plants and requirements of a robot without errors in `check` (thesis 5.2).

    Cached: the same robot gives the same model object. Raises ModelError if a computation over doubles is too large to
    tabulate.
    """
    return _plants(robot)[0]


def to_rosgraph(robot: Robot, interface_paths: Sequence[str | PathLike[str]] = ()) -> RosGraph:
    """Return the ROS side of a robot without errors in `check` (thesis 5.3). Its `model` is the result of `to_sct`.

    ROS types are searched as in `check`. The field of a basic value is the only field of its type, else `data`.
    """
    from robosc.base.ros_types import RosTypes
    from robosc.m2m import robosc_to_rosgraph

    return robosc_to_rosgraph.transform(_plants(robot)[1], RosTypes(interface_paths))


def _plants(robot: Robot) -> tuple[SupervisoryControlModel, Trace]:
    # Stored in the robot: both models share the plants and live as long as the robot.
    memory = vars(robot)
    if "_plants" not in memory:
        from robosc.m2m import robosc_to_sct

        memory["_plants"] = robosc_to_sct.transform(robot)
    plants: tuple[SupervisoryControlModel, Trace] = memory["_plants"]
    return plants


def synthesize(model: SupervisoryControlModel) -> Supervisor:
    """Synthesize the maximally permissive, controllable, nonblocking supervisor of a model. Store and return it.

    The supervisor becomes the model's `supervisor`. Raises EmptySupervisorError, a ModelError with the cause, if there
    is none; ModelError if an action would cancel itself; MemoryError if the decision diagrams exceed 4 GB. For warnings
    about the supervisor, use `robosc.analysis.supervise.supervise`.
    """
    from robosc.analysis.supervise import supervise
    from robosc.base.diagnostics import ModelError, has_errors

    supervision = supervise(model)
    if has_errors(supervision.findings):
        raise ModelError(supervision.findings)
    supervisor = supervision.synthesis.supervisor
    assert supervisor is not None
    return supervisor


def to_engine(model: SupervisoryControlModel) -> EngineModel:
    """Return the controller's program for a model with its supervisor: guards, effects and the order of events.

    `metamodel/engine.ecore` describes its classes. Raises ValueError if the model has no supervisor.
    """
    from robosc.m2m.sct_to_engine import transform

    return transform(model)


def generate(
    target: str,
    models: Models,
    configuration: Configuration | None = None,
    *,
    with_tests: bool = False,
    into: str | None = None,
) -> dict[str, str]:
    """Generate the files of a target: POSIX path in the target's folder to text.

    Targets are `cif`, `supervisor`, `ros1`, `ros2`, `ros2-layer`, `xmi`, and those of other installed packages.

    Without a configuration, all settings have their defaults. `with_tests` adds a test and a Dockerfile to the packages
    of `ros1` and `ros2`. `into` names your own package (for `supervisor`: your own CMake target) that includes the code
    through `fragment.cmake`. Raises ModelError if the models or the configuration violate the target's preconditions.
    Raises ValueError if the target is unknown or cannot be included, or if a model that it reads is missing.
    """
    from robosc.base.diagnostics import ModelError, has_errors
    from robosc.language.configuration import Configuration
    from robosc.m2t.targets import targets, together

    known = targets()
    if target not in known:
        raise ValueError(f"unknown target {target!r}, expected one of {', '.join(known)}")
    if models.sct.supervisor is None:
        raise ValueError("the sct model has no supervisor yet: call synthesize first")
    if known[target].needs_graph and models.rosgraph is None:
        raise ValueError(f"{target} needs the ROS graph")
    if into is not None and not known[target].can_be_included:
        raise ValueError(f"{target} is not code that can be part of {into}")
    configuration = configuration or Configuration()
    generator = known[target]
    with together():
        findings = generator.findings(models, configuration)
        if has_errors(findings):
            raise ModelError(findings)
        tests = None
        if with_tests:
            from robosc.run.node_tests.trace_test import trace_test_of

            tests = trace_test_of(generator, models, configuration)
        return generator.files(models, configuration, tests, into=into)
