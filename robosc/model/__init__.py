"""The metamodels as Python: one module for each package, one class for each EClass.

`sct.Plant(name="message_stop")` creates an object. Features are attributes. `isinstance` and `match` follow the
inheritance of the metamodel. Only this package depends on pyecore.
"""
