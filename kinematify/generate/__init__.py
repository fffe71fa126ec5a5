"""Text or a picture becomes an assembly of rigid parts; called as a function, the package writes a model."""
