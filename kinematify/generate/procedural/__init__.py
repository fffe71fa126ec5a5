"""Objects built from parameters, with joints that are known exactly."""
