"""Lines about which a contact turns and along which it slides, fitted to both parts."""
