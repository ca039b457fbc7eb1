"""Generators: models of a robot to texts.

`targets` lists the targets, `models` holds the input of a generator. `supervisor` and `cif` are targets; `ros` has the
targets that are ROS packages; `c` is shared by targets that contain C. `xmi` writes the models themselves.
"""
