"""The generators, one folder a target."""
