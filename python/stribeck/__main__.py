"""`python -m stribeck` is the command `stribeck`."""

from stribeck.cli.main import main

main()
