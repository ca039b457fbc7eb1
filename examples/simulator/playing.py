"""Simulation over a middleware: in real time, or faster with the world's own clock."""

from __future__ import annotations

import sys
import time

from .world import STEP

#: The longest time, in the world's time, to run on without a due command; then the longest wait in real time.
ANSWER_WITHIN, PATIENCE = 0.25, 120.0
#: The same for the first answer: a controller receives the clock late, and counts its period from then.
FIRST_ANSWER_WITHIN = 2.0
#: The wait, in real time, for a controller that may have nothing to report, before the next step; the longest duration
#: of such steps, in the world's time.
NUDGE, GIVEN_UP = 1.0, 3.0
SILENT = "the controller sends nothing any longer"
#: The duration, in real time, of publishing the start time before the world runs.
INTRODUCTION = 0.5


class NoControllerError(Exception):
    """A controller that is missing or no longer answers."""


def play(simulation, connection, speed, until):
    """Run the world until `until()` holds.

    At a speed other than 1, the world runs that many times as fast, on `/clock`, and waits for a controller that falls
    behind. Raises NoControllerError.
    """
    said("waiting for the controller on " + ", ".join(connection.waits_for()) + " ...")
    _wait(connection, lambda: not connection.waits_for(), "no controller listens to {}: is it started?")
    said("the controller is there: the world starts")
    if speed != 1:
        _introduce(connection)
    told, started = 0, time.monotonic()
    while not until():
        for message in simulation.advance():
            connection.send(message)
        connection.clock(simulation.time)
        told = tell(simulation, told)
        if speed != 1:
            connection.receive(STEP / speed)
            _keep_step(simulation, connection)
        else:
            connection.receive(max(0.0, started + simulation.time - time.monotonic()))


def over(simulation, until="end"):
    """Return a condition for the end of a run: at the `goal`, the `end` of the script, or after a number of seconds."""
    most = simulation.scenario.patience if until in ("goal", "end") else until
    return lambda: simulation.time >= most or simulation.ended or (until == "goal" and simulation.reached)


def tell(simulation, told):
    """Print the events after the first `told` ones. Return the number of events."""
    for happening in simulation.happenings[told:]:
        said(f"{happening.time:6.1f} s  {happening.words}")
    return len(simulation.happenings)


def said(text, stream=None):
    """Print a line at once, even if the output is not a terminal."""
    print(text, file=stream or sys.stdout, flush=True)


def _keep_step(simulation, connection):
    """Wait for a controller that has fallen behind.

    A controller that reports its state does so if something happened before its tick. The world's last messages may
    arrive after that tick, and the next tick needs a later time. So the world makes a step now and then.
    """
    if simulation.scenario.alive is None:
        _wait(connection, lambda: _in_step(simulation, connection), SILENT)
        return
    until = time.monotonic() + NUDGE
    while not _in_step(simulation, connection) and time.monotonic() < until:
        if simulation.time > connection.last_heard + GIVEN_UP:
            raise NoControllerError(SILENT)
        connection.clock(simulation.time)
        connection.receive(0.02)


def _in_step(simulation, connection):
    return simulation.time - connection.last_heard < (ANSWER_WITHIN if connection.answered else FIRST_ANSWER_WITHIN)


def _introduce(connection):
    """Publish the start time until all nodes can have received it."""
    until = time.monotonic() + INTRODUCTION
    while time.monotonic() < until:
        connection.clock(connection.simulation.time)
        connection.receive(0.02)


def _wait(connection, condition, otherwise):
    """Wait for a condition. Publish the time repeatedly, because nodes may have missed it."""
    started = time.monotonic()
    while not condition():
        if time.monotonic() > started + PATIENCE:
            raise NoControllerError(otherwise.format(", ".join(connection.waits_for())) + f" ({PATIENCE:.0f} s)")
        connection.clock(connection.simulation.time)
        connection.receive(0.02)
