"""Objects of the built-in generator, validated with their true joints and with those that were inferred."""
