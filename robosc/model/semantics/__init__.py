"""Facts about models that all other packages share, each defined once.

Expressions: `operators`, `typing` and `domains`, `evaluation`, `printing`, `expansion` and `walks`; `cif_types` for
CIF. Instances of components: `instances`. Names in generated text: `naming`. Data that the supervisor needs:
`cone_of_influence`, `inputs` and `state_values`. Data of ROS: `communication` and `messages`. Events and the control
loop: `roles`, `edges`, `start` and `durations`. A node's reports on itself: `definition` and `component_parts`.
"""
