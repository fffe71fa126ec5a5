"""Behaviour in physics engines, each in its own process."""
