"""Robots as files describe them: links, joints, their meshes, and where links stand."""
