"""Tests of generated nodes: traces to play against them, and the descriptions that the player needs of a node.

A trace is an event log (docs/ros-output.md). A `Tour` creates traces: it runs the controller in Python so that they
cover each transition of its components, and each guard true and false, in few steps.
"""
