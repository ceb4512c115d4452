"""
Angles, poses and arrays: what everything else computes with.

Knows nothing of wheels.
"""
