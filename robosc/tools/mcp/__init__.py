"""Server for assistants that write models, with the Model Context Protocol (`robosc mcp`).

`server` receives calls and answers them. `worker` runs them in processes that can be ended, and `tools` has the tools.
`folders` refuses files outside of the user's folders. `pages` has the documentation, and `search` searches it. `stdio`
and `arguments` know no tool: other servers can use them.
"""
