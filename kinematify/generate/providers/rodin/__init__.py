"""Hyper3D Rodin with BANG over HTTP: the generator that the paper starts from (section III-A)."""
