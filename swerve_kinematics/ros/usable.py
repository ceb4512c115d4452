"""Which numbers of a sensor are of use."""

# No joint and no gyro gets this far [rad, rad/s]; beyond it, sums and products of numbers that
# are still finite overflow.
LARGEST = 1e12


def is_usable(value: float) -> bool:
    """Tell whether a value [rad or rad/s] is finite and within reason."""
    return -LARGEST <= value <= LARGEST  # false for NaN too
