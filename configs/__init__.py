"""Shipped configurations (installed as `kinematify.configs`)."""
