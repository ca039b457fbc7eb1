"""The transformations from model to model."""
