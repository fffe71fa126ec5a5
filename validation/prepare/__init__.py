"""The file that engines are given: convex collision geometry, masses everywhere, one tag per line."""
