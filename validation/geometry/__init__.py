"""Collision along the motion, by exact geometry."""
