"""The command line of the simulator."""
# ruff: noqa: PLC0415  # loads only the requested one of the middlewares and robosc, which may be missing

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from .picture import picture
from .playing import NoControllerError, over, said
from .scenarios import SCENARIOS
from .simulation import Simulation


def main(arguments):
    """Play a scenario. Return the exit status: 0 if its goal was reached, 2 without a controller."""
    options = _parser().parse_args(arguments)
    if options.pictures:
        return _draw_all(Path(options.pictures))
    if options.guard:
        return _guard(options)
    simulation = Simulation(SCENARIOS[options.scenario], options.seed)
    until = over(simulation, options.until)
    try:
        if options.ros == "none":
            from .engine import play as play_without

            log = play_without(simulation, until)
            if options.log:
                _write_lines(options.log, log)
        else:
            _over_ros(simulation, options, until)
    except NoControllerError as error:
        said(f"error: {error}", sys.stderr)
        return 2
    except KeyboardInterrupt:
        pass
    finally:
        if options.record:
            _write_lines(options.record, simulation.record)
        if options.picture:
            Path(options.picture).write_text(picture(simulation), encoding="utf-8")
    said("the goal was " + (f"reached after {simulation.reached_at:.1f} s" if simulation.reached else "not reached"))
    return 0 if simulation.reached else 1


def _guard(options):
    from .guarding import guard_scenario, report

    trial = guard_scenario(options.scenario, options.seed)
    tally = trial.run(options.commands)
    if options.record:
        _write_lines(options.record, trial.world.record)
    if options.picture:
        Path(options.picture).write_text(picture(trial.world), encoding="utf-8")
    return report(options.scenario, tally)


def _draw_all(folder):
    from .engine import play as play_without

    folder.mkdir(parents=True, exist_ok=True)
    missed = []
    for name, scenario in SCENARIOS.items():
        said(name)
        simulation = Simulation(scenario)
        play_without(simulation, over(simulation))
        (folder / f"{name}.svg").write_text(picture(simulation), encoding="utf-8")
        if not simulation.reached:
            missed.append(name)
    said("goals not reached: " + ", ".join(missed) if missed else "all goals were reached")
    return 1 if missed else 0


def _parser():
    parser = argparse.ArgumentParser(
        prog="simulator", description="A world to run the controllers of the examples against."
    )
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--scenario", choices=SCENARIOS)
    what.add_argument(
        "--pictures", metavar="FOLDER", help="play all scenarios without ROS and draw them to this folder"
    )
    parser.add_argument("--ros", choices=["1", "2", "none"], default="none", help="none: with a controller of its own")
    parser.add_argument(
        "--guard",
        action="store_true",
        help="replace the controller by a random agent behind a guard, and the events of the scenario by random ones",
    )
    parser.add_argument(
        "--commands", type=_positive, default=10_000, help="with --guard: the number of the agent's commands"
    )
    parser.add_argument("--seed", type=int, default=0, help="of the sensors' errors, and of the random agent")
    parser.add_argument(
        "--speed",
        type=_positive,
        default=1.0,
        help="how many times as fast as real time; other than 1: the controller has to use /clock (use_sim_time)",
    )
    parser.add_argument(
        "--until", type=_end, default="end", help="goal, end (of what happens in the scenario), or seconds"
    )
    parser.add_argument("--picture", help="draw the run to this SVG file")
    parser.add_argument("--record", help="write what crossed the topics to this file, one JSON object a line")
    parser.add_argument("--log", help="without ROS: write the controller's event log to this file")
    return parser


def _positive(text):
    number = float(text)
    if not 0 < number < float("inf"):
        raise argparse.ArgumentTypeError(f"{text} is not above 0")
    return number


def _end(text):
    return text if text in ("goal", "end") else _positive(text)


def _over_ros(simulation, options, until):
    from .connection import UnknownTypeError
    from .playing import play

    try:
        if options.ros == "1":
            from .ros1 import Ros1 as Ros
        else:
            from .ros2 import Ros2 as Ros
        connection = Ros(simulation)
    except (ImportError, UnknownTypeError) as error:
        raise NoControllerError(f"ROS {options.ros} cannot be used: {error}") from None
    try:
        play(simulation, connection, options.speed, until)
    finally:
        connection.close()


def _write_lines(path, entries):
    Path(path).write_text("".join(json.dumps(entry) + "\n" for entry in entries), encoding="utf-8")
