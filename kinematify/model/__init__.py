"""A tree with joints becomes a kinematic model and its files."""
