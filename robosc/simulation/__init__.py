"""Simulation of the supervised robot: one event at a time, by script, by hand or at random, without ROS."""

from robosc.simulation.data import DataError, EventData
from robosc.simulation.script import Step, read_script, unfit_data
from robosc.simulation.simulation import Happened, LoopSimulation, Simulation

__all__ = ["DataError", "EventData", "Happened", "LoopSimulation", "Simulation", "Step", "read_script", "unfit_data"]
