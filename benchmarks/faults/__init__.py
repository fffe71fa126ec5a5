"""Faulty copies of good models, to measure what `kinematify validate` finds."""
