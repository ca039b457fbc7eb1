"""Suffixes of model files."""

#: Automata of other tools for supervisory control, which are read by way of CIF.
AUTOMATA = (".wmod", ".xmd", ".gen", ".automata")
#: All files that a command accepts as a model.
MODELS = (".rscd", ".cif", ".xmi", *AUTOMATA)
