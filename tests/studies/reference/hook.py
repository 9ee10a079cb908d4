"""MkDocs: the page on every command, made when the documentation is built."""

from __future__ import annotations

import importlib.util
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

HERE = Path(__file__).resolve().parent


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the page."""
    found = importlib.util.spec_from_file_location("reference_commands", HERE / "commands.py")
    assert found is not None and found.loader is not None
    module = importlib.util.module_from_spec(found)
    found.loader.exec_module(module)
    files.append(File.generated(config, "commands.md", content=module.page()))
    return files
