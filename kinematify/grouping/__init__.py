"""Pieces of a mesh that nobody segmented become rigid parts."""
