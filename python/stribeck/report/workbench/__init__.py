"""The local workbench: the loop as pages in a browser, on this computer alone.

`controller` has the state and the actions and imports no web library; long actions are functions
of `actions` that run in a process of their own (`work`, `exchange`). `forms` reads what a page
sends, `views` says what it shows, `figures` draws it, `server` serves it.
"""
