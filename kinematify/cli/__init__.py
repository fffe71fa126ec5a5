"""Command line: one thin file per command."""

from kinematify.cli.app import main

__all__ = ["main"]
