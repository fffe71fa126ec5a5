"""Text or a picture becomes an assembly of rigid parts."""
