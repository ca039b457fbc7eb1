"""What all other packages agree on, each fact once.

Expressions: `operators`, `typing` and `domains`, `evaluation`, `printing`, `expansion` and `walks`; `cif_types` for
CIF. Components of a text: `instances`. Names in generated text: `naming`. What the supervisor is told of data:
`cone_of_influence` and `inputs`. Data of ROS: `communication` and `messages`. Events and the control loop: `roles`,
`edges`, `start` and `durations`. What a node reports of itself: `definition` and `component_parts`.
"""
