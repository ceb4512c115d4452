"""
What the modules are told, from the twist that is commanded.

The state of the motion lives in SwerveController, here and nowhere else.
"""
