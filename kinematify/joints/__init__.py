"""A contact edge becomes ranked joint candidates, and the best becomes a joint."""
