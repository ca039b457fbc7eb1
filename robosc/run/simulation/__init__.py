"""Simulation of the supervised robot: one event at a time, by script, by hand or at random, without ROS."""

from robosc.run.simulation.data import DataError, EventData
from robosc.run.simulation.script import Step, read_script, unfit_data
from robosc.run.simulation.simulation import Happened, LoopSimulation, Simulation

__all__ = ["DataError", "EventData", "Happened", "LoopSimulation", "Simulation", "Step", "read_script", "unfit_data"]
