"""`python -m stribeck` and the command `stribeck`."""

from __future__ import annotations


def start() -> None:
    """Run the command; Ctrl-C is answered in one line from here to the end of the process."""
    from stribeck.cli import interrupts

    interrupts.while_starting()
    from stribeck.cli.main import main

    try:
        main()
    finally:
        interrupts.while_ending()


if __name__ == "__main__":
    start()
