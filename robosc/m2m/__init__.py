"""Transformations from model to model.

`robosc_to_sct` creates plants and requirements, `robosc_to_rosgraph` the ROS side, `sct_to_engine` the controller's
program, `sct_to_cif` a model that CIF can express. `trace` links each element to its source. The other modules are
parts of the first two.
"""
