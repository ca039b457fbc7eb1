"""Access to files that users name, and to files that ship with the tool.

`reading` opens files that users name (regular ones, bounded in size). `writing` writes all files or none.
`json_reading` reads JSON with places. `search` finds files below folders. `resources` locates the files that ship with
the tool, and `templates` loads its templates.
"""
