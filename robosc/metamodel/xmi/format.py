"""What writing and reading of XMI have to agree on."""

import re
from typing import Any

XMI = "http://www.omg.org/XMI"
XSI = "http://www.w3.org/2001/XMLSchema-instance"

#: Elements inside each other: as many as an expression of the language may have operators, and those around it.
DEEPEST = 6000
#: What XML 1.0 can't hold, not even escaped.
UNWRITABLE = re.compile("[^\t\n\r -\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def a(metaclass: Any) -> str:
    """The name of a class with its article."""
    return f"{'an' if metaclass.name[0] in 'AEIOU' else 'a'} {metaclass.name}"
