"""Studies, fits and what makes `results/`: beside the package, not in its wheel; `kinematify bench` and `fit` find it."""
