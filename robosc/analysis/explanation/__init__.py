"""Says why an event can't happen, or never, or why nothing can, in the words of its model, and what would help."""
