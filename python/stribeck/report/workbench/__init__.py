"""The local workbench: the loop as pages in a browser, on this computer alone.

`controller` has the state and the actions and imports no web library; long actions are functions of
`actions` that run in a process of their own (`work`, `exchange`). The files of `views` say what each
page shows, `figures` draws it, `server` serves it.
"""
