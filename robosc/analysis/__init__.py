"""What is asked of a supervised system: its findings, why something can not happen, and proofs.

`system` is the supervised system on which all stand, `paths` finds shortest traces in it. `supervise` gives a model its
supervisor, `blocking` says why one is empty and what it guards against, `observations` what is doubtful about it, and
`findings` says that by the rules of the language, with the `wording` that all share. `explain` answers questions about
events, `verify` proves properties of the system and validates what is generated from it.
"""
