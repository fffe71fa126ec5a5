"""Which hypothesis, which sign, how far."""
