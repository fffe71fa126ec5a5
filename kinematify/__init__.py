"""Kinematify: a shape goes in, a mechanism that works in simulation comes out."""

__version__ = "0.1.0"
