"""MkDocs: the pages on published measurements, where these lie beside the checkout.

They are made once for each state of the package, of this folder and of the data, below target/.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[2]
DATA = Path(os.environ.get("STRIBECK_DATA", ROOT.parent / "shared/data"))
KEPT = ROOT / "target/measured"
#: The data sets of the pages, and the pages with their titles.
NEEDED = ("emps", "ur10e")
PAGES = {"A cart on a screw": "measured/emps.md", "A robot arm": "measured/ur10e.md"}


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Name the pages in the navigation."""
    if present():
        assert config.nav is not None
        entry = {"Measured machines": [{title: path} for title, path in PAGES.items()]}
        names = [next(iter(row)) for row in config.nav]
        config.nav.insert(names.index("How good it is"), entry)
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages, their pictures and reports."""
    if present():
        for path in sorted(made().iterdir()):
            files.append(File.generated(config, f"measured/{path.name}", abs_src_path=str(path)))
    return files


def present() -> bool:
    """Whether the data sets are there."""
    return all((DATA / name).is_dir() for name in NEEDED)


def made() -> Path:
    """The folder with the pages, made now where it is out of date."""
    folder = KEPT / state()
    if not folder.is_dir():
        KEPT.mkdir(parents=True, exist_ok=True)
        new = Path(tempfile.mkdtemp(dir=KEPT, prefix="new-"))
        words = [sys.executable, str(HERE / "pages.py"), str(DATA), str(new)]
        subprocess.run(words, cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
        for old in KEPT.iterdir():
            if not old.name.startswith("new-") and old != folder:
                shutil.rmtree(old, ignore_errors=True)
        try:
            new.rename(folder)
        except OSError:
            # Another process has made the same pages by now.
            shutil.rmtree(new)
    return folder


def state() -> str:
    """A hash of what the pages follow from."""
    found = hashlib.sha256()
    package = ROOT / "python/stribeck"
    sources = [*package.rglob("*.py"), *package.rglob("*.html"), *package.glob("_core*")]
    data = [path for name in NEEDED for path in (DATA / name).glob("*.parquet")]
    for path in sorted([*sources, *HERE.glob("*.py"), *data]):
        found.update(path.read_bytes())
    return found.hexdigest()[:16]
