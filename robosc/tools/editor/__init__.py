"""The language server: answers requests of the Language Server Protocol with `robosc.language`.

`project` holds the texts and their analyses, and `server` implements the protocol. Every other module answers one kind
of request about a `Snapshot` of the project. Knowledge of the language itself belongs into `robosc.language`.
"""
