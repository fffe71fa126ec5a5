"""Meshes in world coordinates become an assembly of rigid parts."""
