"""The reference engine: executes an sct model with its supervisor."""
