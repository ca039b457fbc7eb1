"""Simulated robots for controllers: one plane, seen from above, in which each scenario takes place.

Pure Python and deterministic: the same commands at the same times result in the same world. Lengths are in meters,
angles in radians counter-clockwise, times in seconds. Pixels count to the right of the image's center.
"""
