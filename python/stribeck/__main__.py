"""`python -m stribeck` is the command `stribeck`."""

from stribeck.cli import main

main()
