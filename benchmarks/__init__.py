"""Studies, fits and what makes `results/`: beside the package, not in its wheel."""

KINEMATIFY_VERSION = "0.2.0"
"""Version of the package that this folder belongs to; the command line refuses another one."""
