"""Other ways to build kinds of the library, which only the fit knows: as many people model the same thing."""
