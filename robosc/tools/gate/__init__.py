"""`robosc gate`: the commands of a robot as tools of the Model Context Protocol, behind its supervisor.

`commands` finds the commands, `shapes` describes their data. `gate` answers calls, within the limits of `admission`,
and passes commands to the layer in the thread of its node. `server` connects clients. `dry` is a node without ROS.
"""
