"""The colours of RoboSC's text where no parser runs: one table of rules, for Pygments and as a TextMate grammar.

What a word is only the parser knows for sure; `rules` come so near to it that all models of the repository are coloured
as they are parsed.
"""
