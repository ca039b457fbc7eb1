"""Analyses of a supervised system: findings, explanations, proofs.

`system` is the supervised system on which all analyses build; `paths` computes shortest traces in it. `supervise` gives
a model its supervisor. `blocking` explains why a supervisor is empty and what it guards against. `observations`
collects what is suspicious about a supervisor, `causes` relates these observations, and `findings` reports them by the
rules of the language, with the shared `wording`. `explain` answers questions about events. `verify` proves properties
of the system and validates the artifacts that are generated from it.
"""
