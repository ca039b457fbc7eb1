"""Jobs over many models, variants and seeds: their inputs, their work, and the file of their results."""
