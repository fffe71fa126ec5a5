"""Does the geometry of two links explain the joint between them?"""
