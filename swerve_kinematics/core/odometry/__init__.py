"""
Where the base is, from what its sensors say.

The state of the pose lives in SwerveOdometry, here and nowhere else.
"""
