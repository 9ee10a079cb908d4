"""Debian's packages, installed where a program is missing."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Callable


class Unavailable(Exception):
    """What is missing on this machine, in one sentence."""


def install(packages: tuple[str, ...], missing: Callable[[], list[str]]) -> None:
    """Install packages if `missing` names anything; Unavailable where that cannot be."""
    if not missing():
        return
    if shutil.which("apt-get") is None or os.geteuid() != 0:
        raise Unavailable(f"{missing()[0]} is missing and apt-get cannot install it here")
    # A mirror that does not answer would be waited for.
    apt = ["timeout", "600", "apt-get", "--yes", "--quiet"]
    install = [*apt, "install", "--no-install-recommends", *packages]
    environment = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
    for commands in ([install], [[*apt, "update"], install]):
        for command in commands:
            subprocess.run(
                command, env=environment, stdin=subprocess.DEVNULL, capture_output=True, check=False
            )
        if not missing():
            return
    raise Unavailable(f"apt-get could not install {' '.join(packages)}: {missing()[0]} is missing")
