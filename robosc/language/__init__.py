"""From text to a linked robot model."""
