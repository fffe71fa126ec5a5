"""Pictures without OpenGL."""
