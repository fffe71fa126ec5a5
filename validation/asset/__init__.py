"""Meshes and declared physics."""
