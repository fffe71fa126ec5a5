"""What only `--config paper` runs."""
