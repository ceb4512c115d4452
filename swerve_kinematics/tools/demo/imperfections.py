"""What is imperfect about the simulated base of the demo."""

import numpy as np

# An ordinary robot: 12-bit encoders, a cheap gyro, a sample lost now and then.
FAULTS = {
    'encoder_resolution': 4096,
    'gyro_bias': round(np.radians(0.5), 6),
    'gyro_noise_density': 2.5e-4,
    'dropped_sample_probability': 0.02,
    'seed': 1,
}
IMPERFECTIONS = (
    'simulated imperfections: encoders with {encoder_resolution} counts per turn, a gyro\n'
    'with noise and a bias of {bias:.1f} deg/s, {lost:.0%} of the samples lost').format(
        **FAULTS, bias=np.degrees(FAULTS['gyro_bias']), lost=FAULTS['dropped_sample_probability'])
