"""Tools for people: command line, language server, debugger, browser view, diagrams, new models."""
