"""A sentence becomes a family with parameters; what was not understood is said."""
