"""The metamodels as Python: one module a package, one class an EClass.

`sct.Plant(name="message_stop")` makes an object; features are attributes; `isinstance` and `match` follow the
inheritance of the metamodel. This is the one place that knows pyecore.
"""
