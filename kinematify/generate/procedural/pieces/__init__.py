"""Pieces that many families share: hinges, bearings, handles, carcasses."""
