"""From text to a linked robot model.

`read` reads a file, or a text in memory, and everything that the file imports. It returns a `Reading` with the model,
the findings and the files. Each `File` holds its `Text` (positions in code points and in UTF-16 units), its names
(`Reference`) and the ranges that were skipped.
`robosc.language.formatting` formats texts, `robosc.language.libraries` finds libraries.
"""

from robosc.language.reading import Reading, read
from robosc.language.scopes import File, Reference
from robosc.language.text import Documents, Text

__all__ = ["Documents", "File", "Reading", "Reference", "Text", "read"]
