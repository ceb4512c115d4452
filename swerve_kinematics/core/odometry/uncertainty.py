"""How sure the odometry is: the noise it expects, the noise it sees, and what they add up to."""

from dataclasses import dataclass, fields
import math

import numpy as np

# Standard deviations beyond this [m], [rad], [m/s] say no more than "unknown", and their
# squares and products would not fit into a number.
LARGEST = 1e12


@dataclass(frozen=True)
class OdometryNoise:
    """
    What the sensors and wheels of a base are expected to do wrong.

    The defaults describe an ordinary base with 12-bit encoders, rubber tyres and a MEMS gyro.
    They are the least that the covariances say: modules that disagree by more than expected
    raise them. Of three plausible sets of the first three values this one brought the NEES
    nearest to 3, over 22 drives of a physics simulation and simulated noise taken together.

    Attributes
    ----------
    distance_noise : float
        Relative error of a module's distance, along the wheel: tyre creep, uneven floor,
        backlash. A few tenths of a per cent on a calibrated base.
    steering_noise : float
        Error of a module's direction of travel [rad], across the wheel: backlash, side slip.
        A quarter of a degree is usual for a geared steering.
    correlation_time : float
        How long those errors keep their value [s]. Both together make a random walk of the
        module, in x and in y, with a variance that grows by
        `correlation_time (distance_noise^2 + steering_noise^2) speed^2` [m^2/s], at any rate
        of the updates. Fresh errors in each step of dt do the same with a standard deviation
        of `sqrt(2 correlation_time / dt)` times these: 1 % and 0.8 degrees at 50 Hz.
    distance_resolution : float
        Smallest step of a drive encoder at the rim [m]: 2 pi / 4096 (12 bits) of a 50 mm
        wheel is 0.08 mm.
    gyro_noise : float
        Random walk of the gyro's yaw [rad/sqrt(s)]. Data sheets of MEMS gyros say 0.005 to
        0.01 deg/sqrt(s); 0.015 leaves room for vibration.
    gyro_bias_std : float
        Standard deviation of the gyro's constant error at the start [rad/s]. Data sheets of
        MEMS gyros say 0.5 to 1 deg/s.
    gyro_bias_drift : float
        Wander of that error [rad/s/sqrt(s)]: 0.001 deg/s after a second is 0.06 deg/s after
        an hour, a warm gyro's.
    slip_speed : float
        Spread of the modules' votes that is no slip yet [m/s]: the tyre creep of a gentle
        drive makes a few mm/s.
    slip_ratio : float
        A module slips if the others agree better by this factor without it.
    max_module_speed : float
        Faster than any module can move [m/s], infinity for no limit: such a step is an
        encoder that was reset. The fastest competition bases reach 6 m/s.

    Raises
    ------
    ValueError
        If a value is negative or NaN, or one other than max_module_speed is above 1e12.

    """

    distance_noise: float = 0.003
    steering_noise: float = math.radians(0.25)
    correlation_time: float = 0.1
    distance_resolution: float = 0.08e-3
    gyro_noise: float = math.radians(0.015)
    gyro_bias_std: float = math.radians(0.5)
    gyro_bias_drift: float = math.radians(0.001)
    slip_speed: float = 0.004
    slip_ratio: float = 3.0
    max_module_speed: float = 10.0

    def __post_init__(self):
        """Refuse what is no magnitude."""
        for field in fields(self):
            value = getattr(self, field.name)
            largest = math.inf if field.name == 'max_module_speed' else LARGEST
            if not 0.0 <= value <= largest:
                raise ValueError(
                    f'{field.name} must be from 0 to {largest:g}, got {value}')


class Disagreement:
    """
    How many times more the modules disagree than the noise model says, in variance.

    The reduced chi-square of the modules' errors, smoothed. An error that changes sign from
    one step to the next does not add up (an encoder's last bit is put right by the following
    step), and one that lasts adds up more than its size tells. So the errors are low-passed
    over the correlation time before they are squared: that is their part in a random walk.

    Parameters
    ----------
    module_count : int
        Number of modules of the base, in use or not.
    correlation_time : float
        Time constant of the low pass [s].

    """

    # The errors are compared with the model over so many correlation times: enough
    # independent samples for a ratio that is good to about 10 %.
    MEMORY = 50.0

    def __init__(self, module_count, correlation_time):
        """Start with nothing seen."""
        self._time = max(correlation_time, 1e-3)
        self._errors = [0j] * module_count
        self._seen = self._expected = 0.0

    @property
    def inflation(self):
        """Return the factor on the model's variance, 1 or more."""
        return min(max(1.0, self._seen / self._expected), LARGEST) if self._expected else 1.0

    def update(self, dt, used, errors, expected):
        """
        Take in one step.

        Parameters
        ----------
        dt : float
            Its duration [s].
        used : tuple of int (k,)
            Indices of the modules that took part.
        errors : list of complex (k,)
            Error of each used module [m/s], along the wheel (real) and across it.
        expected : float
            What the model expects of the sum of their squares [m^2/s^2].

        """
        # With this gain, fresh errors come out with the variance that the model expects of
        # them at any rate of the updates (down to one in two correlation times).
        gain = min(dt / (self._time + 0.5 * dt), 1.0)
        seen = 0.0
        for module, error in zip(used, errors):
            self._errors[module] += gain * (error - self._errors[module])
            seen += abs(self._errors[module]) ** 2
        gain = min(dt / (self.MEMORY * self._time), 1.0)
        self._seen += gain * (seen - self._seen)
        self._expected += gain * (expected - self._expected)


class PoseCovariance:
    """
    Covariance of pose and gyro bias together, `[x, y, yaw, bias]`.

    The bias is a state here for its error turns the heading steadily, step after step, which
    no noise that is fresh in every step can describe.

    Parameters
    ----------
    pose_covariance : array_like (3, 3)
        [m^2, m rad, rad^2]. Standard deviations above 1e12 are taken for that.
    bias_variance : float
        [(rad/s)^2].

    """

    def __init__(self, pose_covariance, bias_variance):
        """Start without correlation between pose and bias."""
        covariance = np.asarray(pose_covariance, dtype=float)
        # Rows and columns of the same factor keep it positive, and the correlations.
        scale = np.minimum(1.0, LARGEST / np.sqrt(np.maximum(np.diag(covariance), 1.0)))
        covariance = scale[:, np.newaxis] * covariance * scale
        (xx, xy, x_yaw), (yx, yy, y_yaw), (yaw_x, yaw_y, yaw) = covariance.tolist()
        self._xx, self._xy, self._yy = xx, 0.5 * (xy + yx), yy
        # Of the position x + iy with a real number: of x with it, plus i times that of y.
        self._with_yaw, self._with_bias = 0.5 * complex(x_yaw + yaw_x, y_yaw + yaw_y), 0j
        self._yaw, self._yaw_bias, self._bias = yaw, 0.0, bias_variance

    @property
    def pose(self):
        """Return the covariance of the pose, row by row: 9 floats."""
        x_yaw, y_yaw = self._with_yaw.real, self._with_yaw.imag
        return (self._xx, self._xy, x_yaw,
                self._xy, self._yy, y_yaw,
                x_yaw, y_yaw, self._yaw)

    def propagate(self, displacement, lever, position_variance, turn_variance, bias_time):
        """
        Add the noise of one step: `P <- F P F' + Q`.

        Parameters
        ----------
        displacement : complex
            Of base_link in the odom frame [m]: what an error of the heading turns.
        lever : complex
            How an error of the step's turn moves base_link [m/rad].
        position_variance : float
            Of the displacement of the modules' centroid, in x and in y [m^2].
        turn_variance : float
            Of the step's turn, without the bias [rad^2].
        bias_time : float
            How long the bias turned the heading in this step [s].

        """
        # An error of the yaw moves the position by `turned`; one of the bias moves it by
        # `drifted`, and the yaw by -bias_time.
        turned, drifted, spread = 1j * displacement, -bias_time * lever, turn_variance * lever
        with_yaw = self._with_yaw + turned * self._yaw + drifted * self._yaw_bias
        with_bias = self._with_bias + turned * self._yaw_bias + drifted * self._bias
        yaw_sum, bias_sum = self._with_yaw + with_yaw, self._with_bias + with_bias
        self._xx += (turned.real * yaw_sum.real + drifted.real * bias_sum.real
                     + spread.real * lever.real + position_variance)
        self._yy += (turned.imag * yaw_sum.imag + drifted.imag * bias_sum.imag
                     + spread.imag * lever.imag + position_variance)
        self._xy += (0.5 * (turned * yaw_sum + drifted * bias_sum).imag
                     + spread.real * lever.imag)
        yaw_bias = self._yaw_bias - bias_time * self._bias
        self._yaw += turn_variance - bias_time * (self._yaw_bias + yaw_bias)
        self._with_yaw = with_yaw - bias_time * with_bias + spread
        self._with_bias, self._yaw_bias = with_bias, yaw_bias

    def correct_bias(self, gain, variance):
        """Follow a correction of the bias estimate with this gain, to its new variance."""
        self._with_bias *= 1.0 - gain
        self._yaw_bias *= 1.0 - gain
        self._bias = variance

    def grow(self, distance, turn):
        """Add independent errors of the position, in x and in y [m], and the heading [rad]."""
        self._xx += distance ** 2
        self._yy += distance ** 2
        self._yaw += turn ** 2
