"""A contact graph with edge quality becomes ranked kinematic trees."""
