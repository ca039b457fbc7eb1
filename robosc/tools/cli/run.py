"""Command `robosc run`."""

from __future__ import annotations

import gc
from typing import TYPE_CHECKING

import click

from robosc.m2t.targets import TARGETS
from robosc.tools.cli import CallError, interruption
from robosc.tools.cli.options import Paths, configuration, findings_format, model, over_ros, paths, synthesizer
from robosc.tools.cli.parameters import parameters, set_parameters
from robosc.tools.cli.reading import read_configuration, read_models, supervise_models
from robosc.tools.cli.report import Report

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from robosc.language.configuration import Configuration
    from robosc.m2t.models import Models
    from robosc.model import rosgraph
    from robosc.run.runtime.core.settings import SafeMessages


@click.command("run", context_settings={"ignore_unknown_options": True})
@model
@over_ros("Run as a ROS 2 node; this is the default.")
@click.option("--layer", is_flag=True, help="Run the supervisory layer between an existing controller and the robot.")
@configuration
@findings_format
@parameters
@synthesizer
@paths
@click.argument("arguments", nargs=-1, type=click.UNPROCESSED, metavar="[ROS ARGUMENTS]")
def command(
    model: str,
    layer: bool,
    chosen: str | None,
    form: str,
    parameter_texts: Sequence[str],
    paths: Paths,
    arguments: Sequence[str],
    live: bool,  # noqa: ARG001  # there is no other ROS
) -> None:
    """Run the controller of a robot as a ROS node, directly from the model.

    The node is equal to the one that `transform` generates. MODEL is a .rscd file with a robot, or a .rosgraph.xmi file
    written by `transform --to xmi`. ROS 2 need not be installed: pip install -e '.[ros2]' in robosc's repository is
    enough. Ctrl-C stops the robot as configured, and then the node.

    \b
    Examples:
      robosc run line_follower.rscd --ros2
      robosc run line_follower.rscd --ros2 --ros-args -p period_ms:=50 -r /cmd_vel:=/robot/cmd_vel
      robosc run supervised_line_follower.rscd --ros2 --layer

    Exit status: 0 interrupted, 1 errors in the model, 2 a wrong call, 3 no supervisor exists.
    """
    if "--ros1" in arguments:
        raise CallError("`run` starts a ROS 2 node: for ROS 1, generate a node with `transform --to ros1`")
    with Report(form) as report:
        models = read_models(model, paths, report)
        if models.rosgraph is None:
            raise CallError(f"{model} has no ROS graph: use its .rosgraph.xmi or .rscd")
        set_parameters(models.rosgraph, parameter_texts)
        settings = read_configuration(model, chosen, report)
        supervise_models(models, report)
        target = TARGETS["ros2-layer" if layer else "ros2"]
        report.add(target.findings(models, settings))
        if settings.lifecycle and not layer:
            report.add(
                [settings.warning(("lifecycle",), '"lifecycle" has no effect on `run`: its node is always active')]
            )
        report.stop_on_errors()

    def start(graph: rosgraph.RosGraph, safe: SafeMessages) -> None:
        from robosc.run.runtime.node import run_controller, run_layer

        (run_layer if layer else run_controller)(graph, settings, arguments, safe)

    run_node(models, settings, start)


def run_node(
    models: Models, configuration: Configuration, start: Callable[[rosgraph.RosGraph, SafeMessages], None]
) -> None:
    """Run the node of a robot: call `start` with its graph and the messages that the configuration names.

    Raises CallError if the node can't start.
    """
    from robosc.language.configuration.names import configured_names
    from robosc.model.semantics.messages import find_message
    from robosc.run.runtime.core.node import StartError
    from robosc.run.runtime.core.settings import SafeMessages

    graph = models.rosgraph
    assert graph is not None
    settings = (configuration.on_shutdown, configuration.on_withheld, configuration.on_blocked)
    safe = SafeMessages(
        *(
            [sending for name in names for sending in [find_message(graph, name)] if sending is not None]
            for names in settings
        )
    )
    interruption.check()
    interruption.leave()
    # The models live until the end. Objects from now on are collected normally.
    gc.freeze()
    gc.set_threshold(700, 10, 10)
    try:
        with configured_names(graph, configuration):
            start(graph, safe)
    except StartError as error:
        raise CallError(f"{error}\n  {error.hint}" if error.hint else str(error)) from error
