"""Models as XMI files, which Eclipse's own EMF reads too.

pyecore's XMI says nothing of where a file is damaged, follows a reference to any address and writes features in the
order in which they were set; this one locates everything, stays in its folder and gives the same bytes for the same
model.
"""

from robosc.metamodel.xmi.reading import load
from robosc.metamodel.xmi.writing import to_texts

__all__ = ["load", "to_texts"]
