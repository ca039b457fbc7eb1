"""From plants and requirements to the supervisor, over decision diagrams."""
