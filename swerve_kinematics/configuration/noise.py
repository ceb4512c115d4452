"""What the odometry expects of sensors and wheels, as parameters."""

from swerve_kinematics.configuration.declarations import Declaration, Values
from swerve_kinematics.core.odometry.uncertainty import OdometryNoise

PREFIX = 'odometry.'
_EXPECTED = OdometryNoise()


def _noise(name: str, description: str, unit: str, changeable: bool = True) -> Declaration:
    """Declare a figure of the noise, with the core's default."""
    return Declaration(PREFIX + name, float(getattr(_EXPECTED, name)), description, unit,
                       minimum=0.0, changeable=changeable)


NOISE_DECLARATIONS = (
    _noise('distance_noise', "Relative error of a module's distance", ''),
    _noise('steering_noise', "Error of a module's direction of travel", 'rad'),
    _noise('correlation_time', 'Time for which these two errors keep their value', 's', False),
    _noise('distance_resolution', 'Smallest step of a drive encoder at the rim', 'm'),
    _noise('gyro_noise', "Random walk of the gyro's yaw", 'rad/sqrt(s)'),
    _noise('gyro_bias_std', 'Standard deviation of the gyro bias at the start', 'rad/s',
           False),
    _noise('gyro_bias_drift', 'Random walk of the gyro bias', 'rad/s/sqrt(s)', False),
    _noise('slip_speed', 'Disagreement of the modules that does not yet count as slip', 'm/s'),
    _noise('slip_ratio', 'A module slips if the others agree this many times better without it',
           ''),
    _noise('max_module_speed', 'Anything faster is taken for a reset of the encoder', 'm/s'),
)


def noise_from(values: Values) -> OdometryNoise:
    """
    Return the noise that the parameters describe.

    Parameters
    ----------
    values : mapping
        Value by name, of NOISE_DECLARATIONS.

    Returns
    -------
    OdometryNoise

    """
    return OdometryNoise(**{noise.name.removeprefix(PREFIX): values[noise.name]
                            for noise in NOISE_DECLARATIONS})
