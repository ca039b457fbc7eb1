"""Proves or refutes that a supervised system keeps its promises, and that its outputs are what it is."""
