"""The transformations from model to model.

`robosc_to_sct` makes plants and requirements, `robosc_to_rosgraph` the ROS side, `sct_to_engine` what a controller
executes, `sct_to_cif` what CIF can spell. `trace` says what became of each element. The others are parts of the first
two.
"""
