"""Foundations without a model: files, findings, definitions of ROS types, recordings, extensions, interruption."""
