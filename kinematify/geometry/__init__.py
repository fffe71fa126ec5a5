"""Surface samples, signed distance and OpenGL-free pictures."""
