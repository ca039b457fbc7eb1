"""Running a model: simulation, ROS nodes, scenarios, tests of generated packages, the verification report."""
