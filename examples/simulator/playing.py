"""Plays a simulation over a middleware: in real time, or faster with the world's own clock."""

from __future__ import annotations

import sys
import time

from .world import STEP

#: How long the world runs on without a command that is due, in its own time; how long it waits then, in real time.
ANSWER_WITHIN, PATIENCE = 0.25, 120.0
#: As long may the first answer take: a controller hears of the clock late, and counts its period from then.
FIRST_ANSWER_WITHIN = 2.0
#: How long it waits, in real time, for a controller that may have nothing to tell, before it takes a step; how many
#: seconds of its own it does so.
NUDGE, GIVEN_UP = 1.0, 3.0
SILENT = "the controller sends nothing any longer"
#: How long the time at the start is told, in real time, before the world goes on.
INTRODUCTION = 0.5


class NoControllerError(Exception):
    """Nobody listens, or nobody answers any longer."""


def play(simulation, connection, speed, until):
    """Lets the world take place until `until()` holds.

    With another speed than 1 it runs as many times as fast, on `/clock`, and waits for a controller that falls behind.
    Raises NoControllerError.
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
    """A condition: that a run is over. It ends at the `goal`, the `end` of what happens, or after so many seconds."""
    most = simulation.scenario.patience if until in ("goal", "end") else until
    return lambda: simulation.time >= most or simulation.ended or (until == "goal" and simulation.reached)


def tell(simulation, told):
    """Prints what has happened since so many happenings; how many that are now."""
    for happening in simulation.happenings[told:]:
        said(f"{happening.time:6.1f} s  {happening.words}")
    return len(simulation.happenings)


def said(text, stream=None):
    """Prints a line at once, also where the output is not a terminal."""
    print(text, file=stream or sys.stdout, flush=True)


def _keep_step(simulation, connection):
    """Waits for a controller that has fallen behind.

    One that tells its state does so where something has happened before its tick. What the world has said may come
    after that tick, and the next one comes with the time: so the world takes a step now and then.
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
    """Tells the time at the start until everyone can have heard it."""
    until = time.monotonic() + INTRODUCTION
    while time.monotonic() < until:
        connection.clock(connection.simulation.time)
        connection.receive(0.02)


def _wait(connection, condition, otherwise):
    """Waits for something to hold; the time, where it was not heard, is told again."""
    started = time.monotonic()
    while not condition():
        if time.monotonic() > started + PATIENCE:
            raise NoControllerError(otherwise.format(", ".join(connection.waits_for())) + f" ({PATIENCE:.0f} s)")
        connection.clock(connection.simulation.time)
        connection.receive(0.02)
