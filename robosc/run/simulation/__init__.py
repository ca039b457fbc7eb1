"""Simulation of the supervised robot: one event at a time, by script, by hand or at random, without ROS."""

from robosc.run.simulation.data import DataError, EventData
from robosc.run.simulation.script import ScriptStep, read_script, unfit_data
from robosc.run.simulation.simulation import LoopSimulation, RequestResult, Simulation

__all__ = [
    "DataError",
    "EventData",
    "LoopSimulation",
    "RequestResult",
    "ScriptStep",
    "Simulation",
    "read_script",
    "unfit_data",
]
