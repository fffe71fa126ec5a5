"""Kinds of objects: modules of functions that draw them, by theme, and a YAML file for each that a blueprint lists."""
