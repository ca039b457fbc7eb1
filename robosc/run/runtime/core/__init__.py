"""Controller and layer, independent of ROS: handling of messages, timing, and sending.

`controller` and `layer` are event handlers (`event_handler`); `node` runs them on any ROS. They reach the middleware
through `port`, call services and actions by `clients`, offer them by `proxies`, and do one thing at a time in an
`event_loop`. `message_queues` orders arrived messages. `times` and `monitors` watch the clock and the graph.
`reports`, `component_status`, `blocking` and `event_log` make the reports of a node; subscribers to them implement
`subscriber`.
"""
