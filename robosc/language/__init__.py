"""From text to a linked robot model.

`read` reads a file, or a text in memory, with all that it imports; a `Reading` holds the model and the findings, and of
each `File` its `Text` (positions in code points and in UTF-16 units), its names (`Reference`) and what was skipped.
`robosc.language.formatting` lays texts out, `robosc.language.libraries` finds libraries.
"""

from robosc.language.reading import Reading, read
from robosc.language.scopes import File, Reference
from robosc.language.text import Documents, Text

__all__ = ["Documents", "File", "Reading", "Reference", "Text", "read"]
