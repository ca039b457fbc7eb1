"""The rules of the language, one file a rule or a small family of rules."""
