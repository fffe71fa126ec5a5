"""Numbers about one hypothesis."""
