"""The groups of checks that run in a process each; what they measure with is imported when they run."""
