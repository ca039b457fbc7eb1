"""The command line of the guards."""

from __future__ import annotations

import argparse
from pathlib import Path

from ..simulator.engine import config_beside, load
from ..simulator.guarding import Trial, report
from .gallery import GALLERY

FOLDER = Path(__file__).parent


def model_of(name):
    """Return the file with the model of a guard."""
    return FOLDER / name / f"{name}.rscd"


def trial_of(name, seed=0, models=None):
    """Return a random agent behind a guard in its small world; `models` replace those of the guard."""
    kind, judge = GALLERY[name]
    world, path = kind(seed), model_of(name)
    return Trial(world, judge(world.time), models or load(path), config_beside(path), seed)


def main(arguments):
    """Let random agents send commands. Return the exit status: 1 if a judge objects."""
    parser = argparse.ArgumentParser(prog="guards", description="Random agents behind the guards of the gallery.")
    parser.add_argument("--guard", choices=GALLERY, help="one guard; all of them without this option")
    parser.add_argument("--commands", type=int, default=10_000, help="the number of commands of the agent")
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args(arguments)
    names = [options.guard] if options.guard else [*GALLERY]
    return max([report(name, trial_of(name, options.seed).run(options.commands)) for name in names])
