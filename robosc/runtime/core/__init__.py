"""Controller and layer without any ROS: what becomes of messages, when, and what is sent.

`controller` and `layer` are event handlers (`event_handler`), `node` is what a node does around them on any ROS. They
reach the middleware through `port`, call services and actions by `clients`, offer them by `proxies`, and do one thing
at a time in an `event_loop`. `times` and `monitors` watch the clock and the graph. What a node tells is made by
`reports`, `component_status`, `blocking` and `event_log`; who listens to it implements `listening`.
"""
