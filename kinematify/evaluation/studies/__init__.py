"""Studies of accuracy, validation and speed."""
