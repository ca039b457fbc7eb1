"""Files that users name, read and written in one place, and those that ship with the tool.

`reading` opens files that users name (regular ones, bounded in size), `writing` writes all or none, `json_reading`
reads JSON with places, `finding` searches folders, `resources` finds what ships with the tool, `templates`
loads its templates.
"""
