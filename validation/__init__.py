"""Proof of a model in simulation: checks, engines and reports (installed as `kinematify.validation`)."""
