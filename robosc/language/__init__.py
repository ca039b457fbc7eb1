"""From text to a linked robot model, and back to text.

`read` reads a file, or a text in memory, and everything that the file imports. It returns a `Reading` with the model,
the findings and the files. Each `File` holds its `Text` (positions in code points and in UTF-16 units), its names and
the ranges that were skipped.
`formatting` formats texts, `libraries` finds libraries, `checks` holds the rules for models, `cif` reads CIF,
`highlighting` colors text without parsing it, `configuration` reads the settings of generated code.
"""
