"""The templates of exported files."""

from __future__ import annotations

from functools import cache

import jinja2


@cache
def template(language: str, name: str) -> jinja2.Template:
    """A template of ``exporters/LANGUAGE/templates``; each variable must be given."""
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("stribeck", f"exporters/{language}/templates"),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
    )
    return environment.get_template(name)
