# Copyright 2026 swerve_kinematics maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
