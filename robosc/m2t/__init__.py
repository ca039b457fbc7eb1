"""The generators: models of a robot to texts.

`targets` lists what can be generated, `models` is what a generator reads. `supervisor` and `cif` are targets, `ros` is
those that are ROS packages; `c` is what targets share that contain C. `xmi` writes the models themselves.
"""
