"""
The simulated base as rigid bodies on tyres: MuJoCo in the place of pure rolling.

The one room that needs mujoco; importing it without fails with ImportError.
"""
