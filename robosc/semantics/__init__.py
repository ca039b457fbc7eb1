"""What all other rooms agree on, each fact once: types, values, texts of expressions, names, events and their data."""
