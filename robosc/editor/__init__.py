"""The language server: what editors ask by the Language Server Protocol, answered from `robosc.language`.

`project` holds the texts and what was read of them, `server` speaks the protocol, every other module answers one kind
of question about a `Snapshot` of the project. What knows the language stands in `robosc.language`.
"""
