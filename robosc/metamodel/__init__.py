"""The metamodels as Python: one module a package, one class an EClass.

`sct.Plant(name="message_stop")` makes an object; features are attributes; `isinstance` and `match` follow the
inheritance of the metamodel. This is the one place that knows pyecore.
"""

import sys

# Expressions are trees, some of them thousands of operators deep, that everything follows by recursion: some calls for
# each operator. Python's own calls need no more of the C stack for that.
sys.setrecursionlimit(max(sys.getrecursionlimit(), 100_000))
