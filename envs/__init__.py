"""Gymnasium environments around a model (installed as `kinematify.envs`)."""
