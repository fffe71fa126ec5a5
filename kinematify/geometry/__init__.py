"""Surfaces, samples, distances, sweeps, solids and convex pieces."""
