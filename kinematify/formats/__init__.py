"""A URDF in the languages of other tools: MJCF, USD, SDFormat and glTF."""
