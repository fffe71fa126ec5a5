"""Code that only `--config paper` runs."""
