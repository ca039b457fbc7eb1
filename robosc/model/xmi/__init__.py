"""Models as XMI files that Eclipse's EMF reads too.

pyecore's XMI does not locate damage in a file, follows references to any address, and writes features in the order of
assignment. This package locates every error, stays in its folder and writes the same bytes for the same model.
"""

from robosc.model.xmi.reading import load
from robosc.model.xmi.writing import to_texts

__all__ = ["load", "to_texts"]
