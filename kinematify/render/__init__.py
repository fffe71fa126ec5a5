"""Pictures and films without OpenGL, a window or a graphics card: of models, of pieces, of runs and of environments."""
