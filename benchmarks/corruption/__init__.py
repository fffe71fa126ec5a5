"""Corrupted models for the robustness of `kinematify validate`."""
