"""
What the modules do when the base moves, and back.

Constant geometry, no state.
"""
