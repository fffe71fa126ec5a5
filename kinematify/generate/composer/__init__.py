"""Objects that no family builds: mechanisms, each with its own bearing and limits, placed on the sides of a body."""
