"""From text to a linked robot model."""

from robosc.language.reading import Reading, read

__all__ = ["Reading", "read"]
