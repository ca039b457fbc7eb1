"""Files that somebody names, read and written in one place, and those that ship with the tool."""
