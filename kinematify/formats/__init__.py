"""A URDF in the languages of other tools: MJCF, USD, SDFormat, glTF and SRDF."""
