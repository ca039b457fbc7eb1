"""Syntax coloring of RoboSC without a parser: one table of rules, for Pygments and as a TextMate grammar.

Only the parser determines the kind of every word reliably. The rules are close enough that all models of the repository
are colored as they are parsed.
"""
