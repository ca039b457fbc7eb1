"""Option `--param`: parameters on the robot, for commands that run a model."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import click

from robosc.base.files.json_reading import JsonError, json_value
from robosc.language.configuration.parameters import model_parameters
from robosc.language.syntax_messages import did_you_mean
from robosc.model.semantics.durations import set_milliseconds
from robosc.model.semantics.evaluation import literal
from robosc.run.runtime.core.settings import check
from robosc.tools.cli import CallError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.model import rosgraph

parameters = click.option(
    "--param",
    "parameter_texts",
    multiple=True,
    metavar="NAME=VALUE",
    help="Set a parameter of the model; repeatable.",
)


def set_parameters(graph: rosgraph.RosGraph | None, texts: Sequence[str]) -> None:
    """Set parameters of a graph to values from the call. Raises CallError for an invalid one."""
    known = (
        {}
        if graph is None
        else {parameter.name: (place, parameter) for place, parameter in model_parameters(graph).items()}
    )
    for text in texts:
        name, _, value = text.partition("=")
        if name not in known:
            repair = did_you_mean(name, known, cutoff=0.6)
            known_parameter = f"the model has no parameter {name}"
            raise CallError(
                f"--param {text}: {known_parameter}; {repair.hint}" if repair else f"--param {text}: {known_parameter}"
            )
        place, parameter = known[name]
        try:
            parsed = value if isinstance(parameter.default, str) else json_value(value)
            fitting = check(parameter, parsed)
            place.initial = literal(fitting)
            for duration in place.durations:
                duration.milliseconds = set_milliseconds(float(fitting), duration.unit)
        except JsonError:
            raise CallError(
                f"--param {text}: write {name}=VALUE, such as {name}={json.dumps(parameter.default)}"
            ) from None
        except ValueError as error:
            raise CallError(f"--param {text}: {error}") from None
