"""`python -m kinematify` is the `kinematify` command."""

from kinematify.cli import main

main()
