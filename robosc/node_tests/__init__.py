"""Tests of generated nodes: traces to play against them, and what the player must know of a node.

A trace is an event log (docs/ros-output.md). A `Tour` makes some by running the controller in Python, so that they
show each transition of its components, and each guard true and false, in few steps.
"""
