"""
Which wiring, or which measure of a base, explains what its joints and its gyro reported.

Pure functions of recorded data.
"""
