"""Robots to run controllers against: one plane, seen from above, in which each of the scenarios takes place.

Pure Python and deterministic: the same commands at the same times give the same world. Lengths are metres, angles
radians counter-clockwise, times seconds; pixels are counted to the right of the image's centre.
"""
